"""Spectra and numbers of maps and lines against those of SurfaceTopography, after its convention.

Its window is another one, and its bins are others: on a periodic map neither matters, and the same modes are averaged.
"""

import numpy as np
import pytest
from synthetic_maps import cut, periodic_map

from skinbayes.roughness import CONVENTIONS
from skinbayes.topography import (
    LineProfile,
    area_spectrum,
    line_spectrum,
    reliable_band,
    remove_trend,
    surface_numbers,
)
from skinbayes.topography.bins import area_bins
from skinbayes.topography.periodogram import map_periodogram

program = pytest.importorskip("SurfaceTopography", reason="it is what spectra are compared with")


def theirs(surface):
    """There the first axis is x."""
    sizes = (surface.size_x, surface.size_y)
    return program.Topography(surface.height.T.copy(), sizes, periodic=surface.periodic, unit="m")


@pytest.mark.parametrize(("shape", "pixel"), [((256, 256), (1e-6, 1e-6)), ((150, 201), (1e-6, 1.4e-6))])
def test_the_spectrum_of_a_periodic_map_bin_by_bin(
    shape: tuple[int, int], pixel: tuple[float, float]
) -> None:
    surface = periodic_map(1, shape, pixel)
    bins = area_bins(map_periodogram(surface, "none"), 16)
    edges = 10 ** (np.append(bins.number, bins.number[-1] + 1) / 16)
    whole = np.flatnonzero(np.diff(bins.number) == 1)[3:-1]  # bins whose neighbour is the next one
    for k in whole:
        _, found = theirs(surface).power_spectrum_from_area(collocation=edges[[k, k + 1]], reliable=False)[:2]
        assert float(found[0]) / CONVENTIONS["contact.engineering"].times == pytest.approx(
            bins.power[k], rel=1e-9
        )


def test_the_spectrum_of_a_map_with_edges() -> None:
    """Windows differ, so that the same map gives numbers that scatter by the modes they do not share."""
    surface = remove_trend(cut(periodic_map(2, (600, 600)), 300, 300))
    found = area_spectrum(surface)
    q, power = theirs(surface).power_spectrum_from_area(nb_points_per_decade=16)[:2]
    good = ~np.ma.getmaskarray(q) & (np.ma.filled(q, 0) > 2e5) & (np.ma.filled(q, 0) < found.wavevector_max)
    ours = np.interp(np.log(q[good]), np.log(found.wavevector), np.log(found.power_spectral_density))
    away = np.log(power[good] / CONVENTIONS["contact.engineering"].times) - ours
    modes = np.interp(np.log(q[good]), np.log(found.wavevector), found.independent_modes)
    assert np.abs(away * np.sqrt(modes)).max() < 4
    assert abs(np.mean(away[q[good] > 4e5])) < 0.03


def test_lines() -> None:
    surface = periodic_map(3, (64, 4096))
    line = LineProfile(surface.height[0], pixel_size=1e-6, periodic=True)
    found = line_spectrum(line, bins_per_decade=10)
    other = program.UniformLineScan(line.height, line.size, periodic=True, unit="m")
    q, power = other.power_spectrum_from_profile(resampling_method=None, reliable=False)
    power = power / CONVENTIONS["contact.engineering 1-D"].times
    for k in range(12, 20):
        low = 10 ** (np.floor(np.log10(found.wavevector[k]) * 10 + 1e-9) / 10)
        inside = (q >= low) & (q < low * 10**0.1)
        assert np.mean(power[inside]) == pytest.approx(found.power[k], rel=1e-6)


def test_numbers_of_the_map() -> None:
    surface = remove_trend(cut(periodic_map(4), 200, 240))
    other, own = theirs(surface), surface_numbers(surface)
    assert own.rms_height == pytest.approx(other.Sq(), rel=1e-9)
    # differences of neighbours there too, over the squares between pixels
    assert own.rms_slope == pytest.approx(other.rms_gradient(), rel=0.01)


def test_the_rule_of_the_tip() -> None:
    """The shortest stencil on which valleys are less curved than half the tip, along x."""
    line = LineProfile(periodic_map(5, (64, 4096)).height[3], pixel_size=1e-6)
    radius = 1e-4
    other = program.UniformLineScan(line.height, line.size, unit="m").scanning_probe_reliability_cutoff(
        radius
    )
    found = reliable_band(line, tip_radius=radius)
    assert found.upper.startswith("tip")
    # stencils are whole pixels here: steps of 2 µm
    assert 2 * np.pi / found.wavevector_max == pytest.approx(other, abs=2e-6)
