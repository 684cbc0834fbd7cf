"""Ridges from maps against the ridges that the maps were made of."""

from __future__ import annotations

import numpy as np
import pytest

from skinbayes.errors import InputError
from skinbayes.roughness import SelfAffineSpectrum
from skinbayes.topography import HeightMap, Ridges, measure_ridges, random_surface

ROUGH = SelfAffineSpectrum(
    rms_height=5e-6, hurst_exponent=0.8, wavevector_min=2e3, wavevector_rolloff=4e4, wavevector_max=1e9
)


@pytest.mark.parametrize(("angle", "width"), [(0.0, 0.3e-3), (0.4, 0.2e-3), (-1.1, 0.35e-3)])
def test_spacing_height_and_width_come_back(angle: float, width: float) -> None:
    ridges = Ridges(0.47e-3, 60e-6, width, angle=angle)
    surface = random_surface(ROUGH, shape=(240, 240), pixel_size=18e-6, seed=2, ridges=ridges)
    found = measure_ridges(surface)
    assert found.spacing == pytest.approx(0.47e-3, abs=5 * found.spacing_standard_error)
    assert found.spacing == pytest.approx(0.47e-3, rel=2e-3)
    # a profile of sixty parts averages over its flanks
    assert found.height == pytest.approx(60e-6, rel=0.03)
    assert found.width == pytest.approx(width, rel=0.02)
    assert found.angle == pytest.approx(angle, abs=3e-3)
    assert found.explained > 0.9
    assert 0 < found.height_standard_error < 2e-6
    assert 0 < found.width_standard_error < 1e-5


def test_undefined_pixels_are_left_out() -> None:
    surface = random_surface(
        ROUGH, shape=(200, 200), pixel_size=18e-6, seed=2, ridges=Ridges(0.47e-3, 60e-6, 0.25e-3)
    )
    holes = surface.height.copy()
    holes[np.random.default_rng(1).random(holes.shape) < 0.1] = np.nan
    whole = measure_ridges(surface)
    found = measure_ridges(HeightMap(holes, pixel_size_x=18e-6, pixel_size_y=18e-6))
    assert found.spacing == pytest.approx(whole.spacing, rel=1e-3)
    assert found.area_share == pytest.approx(whole.area_share, rel=0.01)


def test_roughness_alone_has_no_ridges() -> None:
    surface = random_surface(ROUGH, shape=(160, 160), pixel_size=18e-6, seed=2)
    with pytest.raises(InputError, match="of the variance of heights; expected at least 10%"):
        measure_ridges(surface)


def test_a_map_of_three_ridges_is_too_small() -> None:
    with pytest.raises(InputError, match="too small for 4 ridges"):
        measure_ridges(
            HeightMap(np.random.default_rng(1).normal(size=(16, 16)), pixel_size_x=1e-5, pixel_size_y=1e-5)
        )
