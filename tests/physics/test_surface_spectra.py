"""Spectra of maps and lines against surfaces of known spectrum, closed forms, and Parseval's theorem.

Seeds are fixed. A test on a sum of n squared deviations in standard errors allows five standard deviations of a χ² of n degrees
of freedom, which chance alone exceeds with a probability below 1e-5.
"""

import numpy as np
import pytest
from synthetic_maps import cut, deviations, periodic_map, power

from skinbayes.errors import InputError
from skinbayes.roughness import SelfAffineSpectrum, TabulatedSpectrum
from skinbayes.topography import (
    HeightMap,
    LineProfile,
    MeasuredSpectrum,
    ProfileSpectrum,
    analyse_surface,
    area_spectrum,
    directional_spectrum,
    isotropic_spectrum,
    line_spectrum,
    merge_spectra,
)
from skinbayes.topography.area_spectrum import spectrum_numbers
from skinbayes.topography.findings import surface_findings
from skinbayes.topography.periodogram import map_periodogram


def test_parseval() -> None:
    surface = periodic_map(1, (120, 81), (1e-6, 1.5e-6))
    found = spectrum_numbers(map_periodogram(surface, "none"))
    assert found.rms_height == pytest.approx(np.std(surface.height), rel=1e-12)
    # the slope by the derivatives of the plane waves, one by one
    q_y, q_x = (2 * np.pi * np.fft.fftfreq(n, d) for n, d in zip((120, 81), (1.5e-6, 1e-6), strict=True))
    waves = np.fft.fft2(surface.height)
    slopes = (np.fft.ifft2(1j * q * waves) for q in (q_y[:, None], q_x))
    assert found.rms_slope == pytest.approx(np.sqrt(sum(np.mean(np.abs(s) ** 2) for s in slopes)), rel=1e-10)
    # a window keeps the variance on average: it weighs the middle
    windowed = spectrum_numbers(map_periodogram(surface, "hann"))
    assert windowed.rms_height == pytest.approx(found.rms_height, rel=0.2)


def test_a_sinusoid_has_its_power_at_its_wavevector() -> None:
    n, d = 256, 2e-6
    x = np.arange(n) * d
    for window, periodic in (("none", True), ("hann", False)):
        wave = HeightMap(1e-6 * np.cos(2 * np.pi * 32 * x / (n * d)) * np.ones((n, 1)), pixel_size_x=d, pixel_size_y=d,
                         periodic=periodic)  # fmt: skip
        periodogram = map_periodogram(wave, window)
        q = 2 * np.pi * 32 / (n * d)
        inside = spectrum_numbers(periodogram, wavevector_min=0.9 * q, wavevector_max=1.1 * q)
        assert inside.rms_height == pytest.approx(1e-6 / np.sqrt(2), rel=1e-3)
        assert inside.rms_slope == pytest.approx(1e-6 / np.sqrt(2) * q, rel=3e-3)


@pytest.mark.parametrize("shape", [(256, 256), (150, 333)])
@pytest.mark.parametrize("pixel", [(1e-6, 1e-6), (0.7e-6, 1.6e-6)])
@pytest.mark.parametrize("kind", ["periodic", "cut", "tilted and curved", "with holes"])
def test_the_spectrum_comes_back(shape: tuple[int, int], pixel: tuple[float, float], kind: str) -> None:
    whole = periodic_map(11, (2 * shape[0], 2 * shape[1]), pixel)
    surface = whole if kind == "periodic" else cut(whole, *shape)
    height = surface.height.copy()
    if kind == "tilted and curved":
        y, x = np.mgrid[: shape[0], : shape[1]] / 100
        height += height.std() * (20 * x - 10 * y + 3 * x**2 + x * y)
    if kind == "with holes":
        rng = np.random.default_rng(5)
        for i, j in rng.integers(0, min(shape) - 6, (60, 2)):
            height[i : i + 4, j : j + 5] = np.nan
    found = analyse_surface(
        HeightMap(height, pixel_size_x=pixel[0], pixel_size_y=pixel[1], periodic=surface.periodic)
    )
    away = deviations(found.spectrum)
    n = away.size
    assert n >= 10
    if kind == "with holes":
        # the share of holes lacks at short waves, where bins are known to a per cent
        lacking = found.spectrum.power_spectral_density / power(found.spectrum.wavevector)
        used = found.spectrum.reliable
        least = 1 - found.undefined - 4 * found.spectrum.relative_standard_error
        assert np.all((lacking > least)[used][-3:])
        away = away[found.spectrum.relative_standard_error[used] > found.undefined]
        n = away.size
    assert np.sum(away**2) < n + 5 * np.sqrt(2 * n)
    # no bin is claimed to be known better than it is
    assert np.abs(away).max() < 4.5


def test_magnifications_are_stitched() -> None:
    """Three maps of one kind of surface, a factor of 5 apart: one spectrum over all wavevectors, without scatter."""
    spectra = []
    for seed, pixel in enumerate((5e-6, 1e-6, 0.2e-6)):
        surface = cut(periodic_map(20 + seed, (512, 512), (pixel, pixel), rolloff=3e4), 256, 256)
        spectra.append(analyse_surface(surface).spectrum)
    merged = merge_spectra(spectra)
    assert merged.spectrum.wavevector[-1] / merged.spectrum.wavevector[0] > 300
    away = deviations(merged.spectrum, lambda q: power(q, rolloff=3e4))
    assert np.sum(away**2) < away.size + 5 * np.sqrt(2 * away.size)
    assert merged.scatter < 0.15
    # parameters by weighted least squares of logarithms, as a reader would
    q, c, n = (
        merged.spectrum.wavevector,
        merged.spectrum.power_spectral_density,
        merged.spectrum.independent_modes,
    )
    steep = q > 1e5
    slope, error = np.polyfit(np.log(q[steep]), np.log(c[steep]), 1, w=np.sqrt(n[steep]), cov="unscaled")
    assert slope[0] == pytest.approx(-3.6, abs=4 * np.sqrt(error[0, 0]))
    assert np.sqrt(error[0, 0]) < 0.02


def test_places_that_differ_widen_the_errors() -> None:
    """Five places whose C(q) differ by factors with a standard deviation of 0.5 in ln C."""
    rng = np.random.default_rng(6)
    spectra = []
    for seed, level in enumerate(np.exp(0.5 * rng.standard_normal(12))):
        surface = periodic_map(40 + seed, (128, 128))
        scaled = HeightMap(
            surface.height * np.sqrt(level), pixel_size_x=1e-6, pixel_size_y=1e-6, periodic=True
        )
        spectra.append(area_spectrum(scaled))
    merged = merge_spectra(spectra)
    assert merged.scatter == pytest.approx(0.5, rel=0.5)  # of 12 places: a standard error of 20 %
    assert merged.spectrum.independent_modes.max() < 1.1 * 12 / merged.scatter**2
    assert np.isnan(merge_spectra(spectra[:1]).scatter)
    one = merge_spectra(spectra[:1]).spectrum
    inside = spectra[0].reliable
    assert one.power_spectral_density == pytest.approx(spectra[0].power_spectral_density[inside], rel=1e-9)


def test_a_stretched_surface_has_its_degree_and_direction() -> None:
    """Waves along 30° are shorter by 1.5 and those across longer by 1.5: principal slopes differ by 1.5² = 2.25."""
    surface = periodic_map(30, (512, 512), stretch=1.5, angle=np.radians(30))
    found = directional_spectrum(surface, wavevector_max=1e6)
    # ∫ q² C over the disc, numerically
    angle = np.linspace(0, 2 * np.pi, 721)[:-1]
    q = np.linspace(1e4, 1e6, 2000)[:, None]
    along, across = q * np.cos(angle) / 1.5, q * np.sin(angle) * 1.5
    weight = q**3 * power(np.hypot(along, across))
    s_along, s_across = np.sum(weight * np.cos(angle) ** 2), np.sum(weight * np.sin(angle) ** 2)
    assert found.slope_degree == pytest.approx((s_along - s_across) / (s_along + s_across), abs=0.02)
    assert np.degrees(found.slope_direction) == pytest.approx(30, abs=1)
    steep = (found.wavevector > 3e5) & (found.wavevector < 1e6)
    assert np.degrees(found.direction[steep]) == pytest.approx(30, abs=6)
    ratio = found.power_spectral_density[steep][-1]
    assert np.degrees(found.angle[np.nanargmax(ratio)]) == pytest.approx(30, abs=8)
    assert np.nanmax(ratio) / np.nanmin(ratio) == pytest.approx(1.5**7.2, rel=0.4)  # (1.5²)^3.6
    assert any("not isotropic: the slope along 30°" in s for s in surface_findings(analyse_surface(surface)))


def test_an_isotropic_surface_exceeds_the_chance_level_in_one_map_of_twenty() -> None:
    above = []
    for seed in range(40):
        surface = cut(periodic_map(100 + seed, (128, 192)), 64, 128)  # a field that is not square
        found = directional_spectrum(surface)
        used = found.wavevector > 3 * 2 * np.pi / 64e-6
        above.append(found.degree[used] > found.degree_by_chance[used])
    share, n = np.mean(above), np.size(above)
    assert 0.02 < share < 0.05 + 5 * np.sqrt(0.05 * 0.95 / n)


def test_lines_have_the_abel_transform_of_the_spectrum() -> None:
    """And back: all rows of a map as lines give the spectrum of the map."""
    surface = periodic_map(50, (512, 1024))
    rows = [LineProfile(row, pixel_size=1e-6, periodic=True) for row in surface.height[::32]]
    found = line_spectrum(rows)
    nodes = np.geomspace(2e3, 8e6, 400)
    expected = TabulatedSpectrum(nodes, power(nodes)).profile_power(found.wavevector)
    used = (found.wavevector > found.wavevector_min) & (found.wavevector < found.wavevector_max)
    away = ((found.power / expected - 1) * np.sqrt(found.independent_modes))[used]
    assert np.sum(away**2) < away.size + 5 * np.sqrt(2 * away.size)
    # a single line cut out, tilted, too; neighbouring errors go together, so that single ones are what is looked at
    one = LineProfile(surface.height[7, :700] + 1e-9 * np.arange(700), pixel_size=1e-6)
    for area in (isotropic_spectrum(found), analyse_surface(one).spectrum):
        away = np.log(area.power_spectral_density / power(area.wavevector)) / area.relative_standard_error
        assert away.size >= 8
        assert np.abs(away).max() < 4
        assert np.mean(away**2) < 3
    assert (
        area.wavevector_min > 1e5 > isotropic_spectrum(found).wavevector_min
    )  # what a single line does not tell


def test_the_transform_of_lines_is_exact_without_noise() -> None:
    """Between C1D of a self-affine surface, by the trapezoidal rule, and C(q) at the same wavevectors."""
    surface = SelfAffineSpectrum(
        rms_height=1e-6, hurst_exponent=0.8, wavevector_min=1e3, wavevector_rolloff=1e4, wavevector_max=1e8
    )
    q = np.geomspace(3e3, 1e6, 40)
    s = np.linspace(0, 12, 20001)
    lines = np.array([2 * np.trapezoid(k * np.cosh(s) * surface.power(k * np.cosh(s)), s) for k in q])
    found = isotropic_spectrum(ProfileSpectrum(q, lines, np.full(40, 1e4), 3e3, 1e6)).power_spectral_density
    assert found[q > 3e4] == pytest.approx(surface.power(q[q > 3e4]), rel=0.01)
    assert found[q < 1e4] == pytest.approx(
        surface.power(q[q < 1e4]), rel=0.2
    )  # near the bend the curve is rounded off


def test_what_cannot_be_a_spectrum_is_refused() -> None:
    good = {
        "power_spectral_density": [1.0, 1.0],
        "independent_modes": [1.0, 1.0],
        "wavevector_min": 1.0,
        "wavevector_max": 2.0,
    }
    with pytest.raises(InputError, match="does not increase"):
        MeasuredSpectrum([2.0, 1.0], **good)
    with pytest.raises(InputError, match="power_spectral_density holds a value"):
        MeasuredSpectrum([1.0, 2.0], **good | {"power_spectral_density": [0.0, 1.0]})
    with pytest.raises(InputError, match="no bin lies in the reliable band"):
        merge_spectra([MeasuredSpectrum([5.0, 6.0], **good)])
    with pytest.raises(InputError, match="window: found 'flat'"):
        area_spectrum(periodic_map(1, (32, 32)), window="flat")
    lines = ProfileSpectrum(np.geomspace(1, 10, 9), np.geomspace(1, 10, 9) ** 2, np.full(9, 1e3), 1, 10)
    with pytest.raises(InputError, match="no isotropic surface"):
        isotropic_spectrum(lines)


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["map", "map without plateau", "line"])
def test_errors_are_as_large_as_they_are_said(kind: str) -> None:
    """120 maps: mean and variance of each bin, and how many lie within one standard error.

    The mean of n maps is known to 1/sqrt(120 n_modes), five of which are allowed beside 10 % of systematic error at the worst.
    """
    ratios, modes = [], None
    rolloff = 1e4 if kind == "map without plateau" else 1e5
    for seed in range(120):
        if kind == "line":
            height = periodic_map(1000 + seed, (64, 2048)).height[0, :1024]
            spectrum = analyse_surface(LineProfile(height, pixel_size=1e-6)).spectrum
        else:
            spectrum = analyse_surface(
                cut(periodic_map(1000 + seed, (512, 512), rolloff=rolloff), 128, 128)
            ).spectrum
        used = slice(*np.flatnonzero(spectrum.reliable)[[0, -1]])
        expected = power(spectrum.wavevector[used], rolloff=rolloff)
        ratios.append(spectrum.power_spectral_density[used] / expected)
        modes = spectrum.independent_modes[used]
    smallest = min(map(len, ratios))
    ratio, modes = np.array([r[:smallest] for r in ratios]), modes[:smallest]
    bias = ratio.mean(0) - 1
    print(kind, "bias", np.round(bias, 3), "variance × modes", np.round(ratio.var(0) * modes, 2))
    assert np.all(np.abs(bias) < 5 / np.sqrt(120 * modes) + 0.1)
    # variance of a gamma variable of n modes, known to sqrt((2 + 6/n)/120)
    tolerance = 5 * np.sqrt((2 + 6 / modes) / 120)
    scaled = ratio.var(0) * modes
    assert np.all(scaled < 1 + tolerance)
    assert np.all(scaled > (0.3 if kind == "line" else 1 - 0.5 * tolerance))
    inside = np.mean(np.abs(ratio - 1) < 1 / np.sqrt(modes))
    assert 0.64 < inside < 0.85
