"""The contact area of a rough elastic half-space solved with boundary elements (tamaas), against both theories."""

import numpy as np
import pytest
from named_fields import surface_from

from skinbayes.contact import LayeredSkin, persson_contact_area, relative_contact_area, twice_stress_variance
from skinbayes.roughness import rms_slope

POINTS, ROLL_OFF, CUT_OFF, HURST = 512, 4, 64, 0.8


def surface_of_unit_slope(tamaas, seed):
    """Periodic self-affine heights on the unit square, wavenumbers from the roll-off to eight points a wavelength."""
    generator = tamaas.SurfaceGeneratorFilter2D([POINTS, POINTS])
    spectrum = tamaas.Isopowerlaw2D()
    spectrum.q0, spectrum.q1, spectrum.q2, spectrum.hurst = ROLL_OFF, ROLL_OFF, CUT_OFF, HURST
    generator.spectrum, generator.random_seed = spectrum, seed
    heights = generator.buildSurface()
    q = 2 * np.pi * np.fft.fftfreq(POINTS, 1 / POINTS)
    amplitudes = np.abs(np.fft.fft2(heights)) / POINTS**2
    return heights / np.sqrt(np.sum((q[:, None] ** 2 + q[None, :] ** 2) * amplitudes**2))


def solved_area(tamaas, heights, pressure):
    """Contact area for E* = 1, corrected for the pixels along its rim (Yastrebov et al. 2017)."""
    model = tamaas.ModelFactory.createModel(tamaas.model_type.basic_2d, [1.0, 1.0], [POINTS, POINTS])
    model.E, model.nu = 1.0, 0.0
    solver = tamaas.PolonskyKeerRey(model, heights, 3e-6)
    solver.max_iter = 20_000
    assert solver.solve(pressure) < 3e-6
    touching = np.asarray(model.traction).reshape(POINTS, POINTS) > 0
    rim = sum(np.count_nonzero(touching != np.roll(touching, 1, axis)) for axis in (0, 1))
    return touching.mean() - (np.pi - 1 + np.log(2)) / 24 * rim / POINTS**2


@pytest.mark.slow
@pytest.mark.parametrize("pressure", [0.03, 0.1])
def test_theories_against_boundary_elements(pressure):
    tamaas = pytest.importorskip("tamaas")
    tamaas.set_log_level(tamaas.LogLevel.error)
    exact = np.mean([solved_area(tamaas, surface_of_unit_slope(tamaas, seed), pressure) for seed in (1, 2)])
    q_r, q_1 = 2 * np.pi * ROLL_OFF, 2 * np.pi * CUT_OFF
    unit = rms_slope(surface_from((1.0, HURST, q_r, q_r, q_1)))
    twice_variance = twice_stress_variance(
        surface_from((1 / unit, HURST, q_r, q_r, q_1)),
        LayeredSkin(
            young_modulus_layer=1.0,
            young_modulus_bulk=1.0,
            poisson_ratio_layer=0,
            poisson_ratio_bulk=0,
            layer_thickness=1.0,
        ),
    )
    plain = persson_contact_area(pressure, twice_variance) / exact - 1
    corrected = relative_contact_area(pressure, twice_variance) / exact - 1
    # plain theory 28 to 11 % too small, the corrected one 3 to 17 % too large; two surfaces scatter by a few per cent
    assert -0.30 < plain < -0.10
    assert 0.0 < corrected < 0.20
