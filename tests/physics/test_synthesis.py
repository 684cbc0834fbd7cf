"""Synthetic surfaces against the moments of their spectra, the statistics of periodograms, and geometry."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from skinbayes.errors import InputError
from skinbayes.roughness import SelfAffineSpectrum, rms_height, rms_slope
from skinbayes.topography import Anisotropy, HeightMap, Ridges, random_surface

FIRST = 5e4


def spectrum_on(size: int, waves: int) -> tuple[SelfAffineSpectrum, float]:
    """A spectrum with so many of its longest waves on a map, cut off at a quarter of what its pixels resolve."""
    pixel = waves * 2 * np.pi / FIRST / size
    last = np.pi / pixel / 4
    ends = {"wavevector_min": FIRST, "wavevector_rolloff": min(3 * FIRST, last / 1.3), "wavevector_max": last}
    return SelfAffineSpectrum(rms_height=5e-6, hurst_exponent=0.8, **ends), pixel


def gradients(surface: HeightMap) -> tuple[float, float]:
    """Mean squares of both parts of the gradient of a periodic map, exact for plane waves."""
    transform = np.fft.fft2(surface.height)
    qx, qy = (2 * np.pi * np.fft.fftfreq(n, surface.pixel_size_x) for n in surface.height.shape[::-1])
    parts = (np.fft.ifft2(1j * q * transform).real for q in (qx, qy[:, None]))
    along_x, along_y = (float(np.square(part).mean()) for part in parts)
    return along_x, along_y


def test_exact_amplitudes_have_the_moments_of_the_spectrum() -> None:
    # sums over waves against integrals: 1.1e-3 and 9e-5 with eight of the longest waves, less with more of them
    errors = []
    for waves in (4, 8, 16):
        spectrum, pixel = spectrum_on(1024, waves)
        surface = random_surface(spectrum, shape=(1024, 1024), pixel_size=pixel, seed=1, amplitudes="exact")
        slope = np.sqrt(sum(gradients(surface)))
        assert slope == pytest.approx(float(rms_slope(spectrum)), rel=3e-4)
        errors.append(abs(surface.height.std() / float(rms_height(spectrum)) - 1))
    assert errors[0] < 4e-3
    assert errors[2] < errors[1] < errors[0]
    assert surface.height.mean() == pytest.approx(0.0, abs=1e-12)


def test_exact_amplitudes_have_the_same_moments_for_every_seed() -> None:
    spectrum, pixel = spectrum_on(64, 4)
    heights = [
        random_surface(spectrum, shape=(64, 96), pixel_size=pixel, seed=seed, amplitudes="exact").height
        for seed in (1, 2)
    ]
    assert heights[0].std() == pytest.approx(heights[1].std(), rel=1e-12)
    assert abs(np.corrcoef(heights[0].ravel(), heights[1].ravel())[0, 1]) < 0.5


def test_ordinates_of_the_periodogram_are_exponential_about_the_spectrum() -> None:
    spectrum, pixel = spectrum_on(256, 8)
    surface = random_surface(spectrum, shape=(256, 256), pixel_size=pixel, seed=4)
    area = (256 * pixel) ** 2
    ordinate = np.abs(np.fft.rfft2(surface.height) * pixel**2) ** 2 / ((2 * np.pi) ** 2 * area)
    qx = 2 * np.pi * np.fft.rfftfreq(256, pixel)
    q = np.hypot(qx, 2 * np.pi * np.fft.fftfreq(256, pixel)[:, None])
    expected = spectrum.power(q)
    # without the columns whose two halves repeat each other
    inside = (expected > 0) & (qx > 0) & (qx < qx[-1])
    ratio = ordinate[inside] / expected[inside]
    assert len(ratio) > 500
    assert stats.kstest(ratio, "expon").pvalue > 1e-3
    outside = ordinate[(expected == 0) & (q < np.pi / pixel)]
    assert outside.max() < 1e-20 * ordinate.max()


def test_stretched_roughness_keeps_its_height_and_turns() -> None:
    spectrum, pixel = spectrum_on(512, 8)
    made = {"shape": (512, 512), "pixel_size": pixel, "seed": 1, "amplitudes": "exact"}
    plain = random_surface(spectrum, **made)
    along = random_surface(spectrum, **made, anisotropy=Anisotropy(3.0))
    turned = random_surface(spectrum, **made, anisotropy=Anisotropy(3.0, np.pi / 2))
    assert along.height.std() == pytest.approx(plain.height.std(), rel=0.01)
    # wavelengths three times longer along x: gradients along x a third of those across
    along_x, along_y = gradients(along)
    assert along_y / along_x == pytest.approx(9.0, rel=0.02)
    along_x, along_y = gradients(turned)
    assert along_x / along_y == pytest.approx(9.0, rel=0.02)


def test_ridges_have_their_height_width_and_spacing() -> None:
    spectrum = SelfAffineSpectrum(
        rms_height=1e-9, hurst_exponent=0.8, wavevector_min=2e4, wavevector_rolloff=4e4, wavevector_max=1e9
    )
    ridges = Ridges(0.5e-3, 50e-6, 0.2e-3)
    surface = random_surface(spectrum, shape=(500, 32), pixel_size=10e-6, seed=1, ridges=ridges)
    profile = surface.height[:, 0]
    assert np.ptp(profile) == pytest.approx(50e-6, rel=1e-3)
    assert np.mean(profile > (profile.max() + profile.min()) / 2) == pytest.approx(0.4, abs=0.03)
    assert profile[:450] == pytest.approx(profile[50:], abs=1e-8)
    assert surface.periodic
    assert not random_surface(spectrum, shape=(510, 32), pixel_size=10e-6, seed=1, ridges=ridges).periodic


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        ({"shape": (1, 4)}, "at least 2 each"),
        ({"pixel_size": -1.0}, "finite number > 0 m"),
        ({"pixel_size": 1e-12}, "no wave of the spectrum"),
        ({"anisotropy": Anisotropy(0.0)}, "anisotropy.ratio is 0"),
        ({"ridges": Ridges(1e-3, 1e-5, 2e-3)}, "less than the spacing"),
        ({"ridges": Ridges(1e-3, -1e-5, 2e-4)}, "ridges.height is -1e-05 m"),
        ({"ridges": Ridges(1e-3, 1e-5, 2e-4, flank=1e-3)}, "ridges.flank is 0.001 m"),
    ],
)
def test_what_cannot_be_is_refused_in_words(changed: dict[str, object], words: str) -> None:
    spectrum, pixel = spectrum_on(64, 4)
    with pytest.raises(InputError, match=words):
        random_surface(spectrum, **{"shape": (64, 64), "pixel_size": pixel, "seed": 1, **changed})
