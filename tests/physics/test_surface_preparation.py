"""Each step between a map as it was read and its spectrum, against closed forms, other solvers and known damage."""

import re
from dataclasses import replace

import numpy as np
import pytest
from scipy.sparse import coo_array
from scipy.sparse.linalg import spsolve
from synthetic_maps import cut, periodic_map

from skinbayes.errors import InputError
from skinbayes.topography import (
    HeightMap,
    LineProfile,
    analyse_surface,
    fill_undefined,
    find_plateaus,
    find_spikes,
    invert_replica,
    largest_defined_rectangle,
    reliable_band,
    remove_spikes,
    remove_trend,
    surface_numbers,
)
from skinbayes.topography.findings import surface_findings
from skinbayes.topography.trend import trend_share
from skinbayes.topography.undefined import largest_defined_part


def a_map(height, pixel_x=1e-6, pixel_y=1e-6):
    return HeightMap(height, pixel_size_x=pixel_x, pixel_size_y=pixel_y)


@pytest.mark.parametrize("trend", ["tilt", "curvature"])
@pytest.mark.parametrize("holes", [False, True])
def test_the_trend_is_that_of_least_squares(trend: str, holes: bool) -> None:
    rng = np.random.default_rng(1)
    height = rng.standard_normal((40, 55))
    y, x = np.mgrid[:40, :55].astype(float)
    height += 3 * x - 0.5 * y + 0.01 * x * y - 0.02 * y**2
    if holes:
        height[rng.random(height.shape) < 0.2] = np.nan
    found = remove_trend(a_map(height), trend)
    columns = [np.ones_like(x), x, y] + ([x**2, x * y, y**2] if trend == "curvature" else [])
    defined = ~np.isnan(height)
    matrix = np.stack([column[defined] for column in columns], axis=1)
    left = height[defined] - matrix @ np.linalg.lstsq(matrix, height[defined], rcond=None)[0]
    assert found.height[defined] == pytest.approx(left, abs=1e-9)
    assert np.isnan(found.height[~defined]).all()
    share = 1 - np.var(left) / np.var(height[defined])
    assert f"{100 * share:.3g} % of the variance" in found.steps[0]


def test_what_a_trend_takes_of_a_wave() -> None:
    """Against removing it from waves of random direction and phase."""
    rng = np.random.default_rng(2)
    rows, columns = 200, 300
    y, x = (np.mgrid[:rows, :columns] + 0.5) * 1.0
    for trend in ("tilt", "curvature"):
        for _ in range(4):
            q_x, q_y = rng.uniform(-3, 3, 2) * 2 * np.pi / np.array([columns, rows])
            taken = []
            for phase in (0.0, np.pi / 2):  # both together have the power 1 everywhere
                wave = np.cos(q_x * x + q_y * y + phase)
                left = remove_trend(a_map(wave), trend).height
                taken.append((np.sum(np.square(wave - wave.mean())) - np.sum(np.square(left))) / wave.size)
            expected = trend_share(q_x, q_y, size_x=columns, size_y=rows, trend=trend)
            assert sum(taken) == pytest.approx(np.squeeze(expected), abs=2e-4)


def test_holes_are_filled_by_the_harmonic_function() -> None:
    """x² − y² solves the equation on a grid of squares exactly; a sparse direct solver gives the rest."""
    y, x = np.mgrid[:30, :40].astype(float)
    harmonic = x**2 - y**2
    rng = np.random.default_rng(3)
    hole = np.zeros(harmonic.shape, dtype=bool)
    hole[8:15, 10:20] = hole[20:22, 30] = True
    filled = fill_undefined(a_map(np.where(hole, np.nan, harmonic)))
    assert filled.height == pytest.approx(harmonic, abs=1e-3)  # heights to 1521
    assert "72 undefined pixels (6 %) filled smoothly" in filled.steps[0]
    height = rng.standard_normal((12, 15))
    hole = np.zeros(height.shape, dtype=bool)
    hole[3:7, 5:8] = hole[0, 2] = True  # one touches the edge
    found = fill_undefined(a_map(np.where(hole, np.nan, height), 1.0, 2.0)).height
    # five-point stencils with the distances of neighbours, the direct way
    places = {tuple(p): n for n, p in enumerate(np.argwhere(hole))}
    entries, right = [], np.zeros(len(places))
    for (i, j), n in places.items():
        for di, dj, weight in ((0, 1, 1.0), (0, -1, 1.0), (1, 0, 0.25), (-1, 0, 0.25)):
            other = i + di, j + dj
            if not (0 <= other[0] < 12 and 0 <= other[1] < 15):
                continue
            entries.append((n, n, weight))
            if other in places:
                entries.append((n, places[other], -weight))
            else:
                right[n] += weight * height[other]
    i, j, v = (np.array(a) for a in zip(*entries, strict=True))
    assert found[hole] == pytest.approx(spsolve(coo_array((v, (i, j))).tocsc(), right), abs=1e-6)


def test_too_many_holes_are_cut_away_or_refused() -> None:
    height = np.random.default_rng(4).standard_normal((50, 70))
    height[:, :20] = np.nan
    height[10, 60] = np.nan
    with pytest.raises(
        InputError, match=r"40\.\d? ?.*% of the pixels are undefined|2[89]\.\d % of the pixels are undefined"
    ):
        fill_undefined(a_map(height))
    found = largest_defined_rectangle(a_map(height))
    # by trying all of them
    best = 0
    hole = np.isnan(height)
    count = np.pad(np.cumsum(np.cumsum(hole, 0), 1), ((1, 0), (1, 0)))
    for top in range(50):
        for bottom in range(top + 1, 51):
            inside = count[bottom] - count[top]  # holes left of each column
            for left in range(20, 70):
                right = int(np.searchsorted(inside, inside[left], side="right")) - 1
                best = max(best, (bottom - top) * (right - left))
    assert found.height.size == best
    assert not np.isnan(found.height).any()
    with pytest.raises(InputError, match="no rectangle of 8 × 8"):
        largest_defined_rectangle(a_map(np.where(np.indices(height.shape).sum(0) % 5, height, np.nan)))


def test_a_large_map_is_cut_in_blocks() -> None:
    height = np.zeros((900, 1300))
    height[:100] = np.nan
    found = largest_defined_rectangle(a_map(height))
    assert 800 - 4 <= found.height.shape[0] <= 800 and found.height.shape[1] > 1300 - 4


def test_spikes_are_found_and_a_rough_surface_has_none() -> None:
    surface = periodic_map(5, (300, 300))
    assert not find_spikes(surface).any()
    height = surface.height.copy()
    places = [(10, 20), (100, 7), (299, 0), (150, 150), (150, 151)]
    for place in places:
        height[place] += 40 * np.std(np.diff(height, axis=0))
    spiky = a_map(height)
    assert {tuple(p) for p in np.argwhere(find_spikes(spiky))} == set(places)
    cleaned = remove_spikes(spiky)
    assert cleaned.steps == ("5 spikes made undefined",)
    restored = fill_undefined(cleaned).height
    assert np.max(np.abs(restored - surface.height)) < 3 * np.std(np.diff(surface.height, axis=0))
    noisy = np.where(np.random.default_rng(1).random(height.shape) < 0.01, 1e-3, height)
    with pytest.raises(InputError, match=r"expected at most 0\.1 % spikes"):
        remove_spikes(a_map(noisy))


def test_saturated_areas_are_told_from_coarse_counts() -> None:
    surface = periodic_map(6)
    rms = surface.height.std()
    coarse = np.round(surface.height / (0.1 * rms))
    assert find_plateaus(surface) == () and find_plateaus(a_map(coarse)) == ()
    clipped = a_map(np.clip(coarse, -20, 15))
    high, low = find_plateaus(clipped)
    assert high.highest and high.height == 15.0 and not low.highest and low.height == -20.0
    assert high.share == pytest.approx(np.mean(coarse >= 15))
    said = surface_findings(analyse_surface(a_map(np.minimum(surface.height, rms))))
    assert any("exactly the largest height" in sentence for sentence in said)


def test_a_negative_replica_has_the_spectrum_of_the_skin_and_the_other_skewness() -> None:
    surface = periodic_map(7, (128, 128))
    furrowed = a_map(-np.exp(surface.height / surface.height.std()))
    skin, replica = (analyse_surface(furrowed, negative_replica=flag) for flag in (False, True))
    assert skin.own.skewness < -0.5
    assert replica.own.skewness == pytest.approx(-skin.own.skewness)
    assert replica.spectrum.power_spectral_density == pytest.approx(
        skin.spectrum.power_spectral_density, rel=1e-9
    )
    assert replica.surface.steps[0] == "negative replica inverted"
    assert invert_replica(furrowed).height.max() > 0


def test_numbers_of_a_wave_are_those_of_the_integrals() -> None:
    """64 pixels a wave: differences lose (qΔ)²/24 = 4e-4 of the slope."""
    rows, columns = 128, 256
    x = np.arange(columns)
    steep = a_map(np.ones((rows, 1)) * 20.0 * np.sin(2 * np.pi * x / 64), 1.0, 1.0)
    found = surface_numbers(steep)
    slope = 20 * 2 * np.pi / 64
    assert found.rms_height == pytest.approx(20 / np.sqrt(2), rel=1e-12)
    assert found.rms_slope == pytest.approx(slope / np.sqrt(2), rel=5e-3)
    angle = np.linspace(0, 2 * np.pi, 10001)[:-1]
    assert found.total_area_ratio == pytest.approx(
        np.mean(np.sqrt(1 + slope**2 * np.cos(angle) ** 2)), rel=5e-3
    )
    assert found.kurtosis == pytest.approx(1.5, rel=1e-9)


def test_the_band_has_the_rule_that_is_said() -> None:
    surface = cut(periodic_map(8), 200, 100)
    band = reliable_band(surface)
    assert band.wavevector_min == pytest.approx(3 * 2 * np.pi / 100e-6)
    assert band.wavevector_max == pytest.approx(np.pi / 2e-6)
    assert reliable_band(periodic_map(8)).wavevector_min == pytest.approx(2 * np.pi / 256e-6)
    assert reliable_band(surface, resolution=10e-6).upper == "resolution of the instrument"
    with pytest.raises(InputError, match="no reliable wavevector"):
        reliable_band(surface, resolution=50e-6)


def test_a_tip_limits_the_band_where_valleys_are_too_sharp() -> None:
    """A wave of amplitude a has the curvature a q²: twice that of half a tip on short stencils."""
    x = np.arange(4000) * 1e-8
    q = 2 * np.pi / 2e-6
    line = LineProfile(1e-7 * np.cos(q * x), pixel_size=1e-8)
    sharpest = 1e-7 * q**2
    assert reliable_band(line, tip_radius=0.4 / sharpest).upper == "4 pixels a wave"
    radius = 1.0 / sharpest
    found = reliable_band(line, tip_radius=radius)
    assert found.upper.startswith("tip")
    # stencils of half length d see sharpest · (sin(qd/2)/(qd/2))², which is half of it at qd/2 = 1.3916
    assert found.wavevector_max == pytest.approx(2 * np.pi / (2 * 2 * 1.39156 / q), rel=0.1)


@pytest.mark.parametrize(
    ("height", "said"),
    [
        (np.full((20, 20), np.nan), "none of the 400 pixels"),
        (np.zeros((20, 20)), "all heights are the same"),
        (np.arange(400.0).reshape(20, 20), "nothing is left when the trend is gone"),
        (np.ones((5, 20)), "the shape 5 × 20; expected 2 axes of at least 8 pixels"),
        (np.full((20, 20), np.inf), "hold infinities"),
    ],
)
def test_what_is_no_rough_surface_is_refused(height: np.ndarray, said: str) -> None:
    with pytest.raises(InputError, match=said):
        analyse_surface(a_map(height))


def test_steps_leave_the_map_as_it_was() -> None:
    surface = cut(periodic_map(9, (64, 64)), 64, 64)
    before = surface.height.copy()
    analyse_surface(surface)
    assert np.array_equal(surface.height, before) and surface.steps == ()
    with pytest.raises(ValueError, match="read-only"):
        surface.height[0, 0] = 1.0


def test_a_mark_of_undefined_pixels_is_no_height() -> None:
    surface = cut(periodic_map(3, (96, 96)), 96, 96)
    height = surface.height.copy()
    height[20:26, 30:36] = -9999e-6
    marked = replace(surface, height=height)
    with pytest.raises(InputError, match=r"exactly the height -9999 um.*--undefined-height '-9999 um'"):
        analyse_surface(marked)
    found = analyse_surface(marked, undefined_height=-9999e-6)
    assert found.undefined == 36 / 96**2 and "36 pixels of the height -9999" in found.surface.steps[0]
    height[20:26, 30:36] = np.nan
    assert np.array_equal(
        found.surface.height, analyse_surface(replace(surface, height=height)).surface.height
    )
    with pytest.raises(InputError, match="no pixel has the height -32768 um"):
        analyse_surface(marked, undefined_height=-32768e-6)
    # a range that ran out is a plateau, but no mark
    assert analyse_surface(replace(surface, height=np.minimum(surface.height, surface.height.std()))).plateaus


def test_what_no_surface_has_is_said() -> None:
    surface = cut(periodic_map(3, (96, 96)), 96, 96)
    plain = " ".join(surface_findings(analyse_surface(surface)))
    height = surface.height.copy()
    height[50, 50] += 100 * height.std()
    open_edges = replace(surface, height=np.cumsum(surface.height, axis=1), periodic=True)
    growing = replace(surface, height=surface.height * (1 + 9 * np.exp(-(((np.arange(96) - 48) / 8) ** 2))))
    for changed, said in (
        (replace(surface, height=surface.height * 1e4), "An rms slope of .* is that of no surface"),
        (replace(surface, pixel_size_x=0.02, pixel_size_y=0.02), r"The field is 1\.92 m long"),
        (replace(surface, height=height), r"1 pixel .* like spikes, with \d\d % of the mean square slope"),
        (open_edges, "times as much across the edges of the field as between neighbours"),
        (growing, "Under the window the rms height is"),
    ):
        assert re.search(said, " ".join(surface_findings(analyse_surface(changed)))), said
        assert not re.search(said, plain), said


def test_the_longest_part_of_a_line_is_kept() -> None:
    height = np.random.default_rng(4).standard_normal(400)
    height[[0, 30, 31, 250]] = np.nan
    found = largest_defined_part(LineProfile(height, pixel_size=1e-6))
    assert np.array_equal(found.height, height[32:250])
    assert found.steps == ("cut to the longest part without undefined pixels: 218 of 400",)
    with pytest.raises(InputError, match="no 8 in a row are defined"):
        largest_defined_part(LineProfile(np.where(np.arange(400) % 5, height, np.nan), pixel_size=1e-6))
