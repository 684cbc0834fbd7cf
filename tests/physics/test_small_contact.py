"""How much the mean height over a contact scatters, against surfaces made at random, and the mark on small contacts."""

import numpy as np
import pytest
from scipy.special import j1

from skinbayes.contact import reduced_modulus, sphere_contact
from skinbayes.forward import forward_model
from skinbayes.forward.base import Tables
from skinbayes.forward.small_contact import ENOUGH_WAVELENGTHS
from skinbayes.roughness import named_surface

SURFACE = named_surface("paper_reference")
MODULUS = reduced_modulus(20e3, 0.5)


def scatter_of_mean_height(radius):
    """Standard deviation of the mean height over a disc, ``2π ∫ q C (2 J1(qa)/qa)² dq``."""
    q = np.geomspace(1e3, 1e8, 200_001)
    filtered = q**2 * SURFACE.power(q) * np.square(2 * j1(q * radius) / (q * radius))
    return np.sqrt(2 * np.pi * np.trapezoid(filtered, np.log(q)))


def test_mean_height_under_a_small_ball_scatters_by_micrometres():
    small = sphere_contact(0.02, 1e-3, reduced_modulus=MODULUS).contact_radius
    assert scatter_of_mean_height(small) == pytest.approx(4.9e-6, rel=0.02)
    assert scatter_of_mean_height(sphere_contact(0.5, 8e-3, reduced_modulus=MODULUS).contact_radius) < 0.5e-6
    edge = ENOUGH_WAVELENGTHS * np.pi / 6.345e3
    assert 0.03 < scatter_of_mean_height(edge) / 22.4e-6 < 0.05


def test_mean_height_over_a_disc_of_random_surfaces():
    # a plateau and its decay on a periodic patch of 24 mm, 64 surfaces with random phases
    rng, n, length = np.random.default_rng(2), 256, 0.024
    wave = 2 * np.pi * np.fft.fftfreq(n, length / n)
    q = np.hypot(wave[:, None], wave[None, :])
    amplitude = np.sqrt(SURFACE.power(q.reshape(-1)).reshape(q.shape)) * 2 * np.pi / length
    radius = 8.25e-4
    place = (np.arange(n) - n // 2) * length / n
    disc = np.hypot(place[:, None], place[None, :]) < radius
    means = []
    for _ in range(64):
        phases = np.fft.fft2(rng.standard_normal((n, n))) / n
        height = np.fft.ifft2(amplitude * phases).real * n**2
        means += [height[disc].mean(), np.roll(height, (n // 2, n // 2), (0, 1))[disc].mean()]
    # 128 means: 6 % standard error, and the grid of the disc
    assert np.std(means) == pytest.approx(scatter_of_mean_height(radius), rel=0.25)


@pytest.mark.parametrize("name", ["friction", "humid-air", "drying", "drying-features", "capillary-film"])
def test_small_contacts_are_marked(name):
    model = forward_model(name)
    assert "small_contact" in model.flag_meanings
    common = {
        "young_modulus_layer": 7e6, "young_modulus_bulk": 20e3, "layer_thickness": 2e-5, "temperature": 293.15,
        "relative_humidity": 0.5, "contact_angle_skin": 1.4, "contact_angle_counterface": 0.0, **model.optional,
        "rms_height": 22.4e-6, "hurst_exponent": 0.78, "wavevector_min": 1e3, "wavevector_rolloff": 6.345e3,
        "wavevector_max": 1e9,
    }  # fmt: skip

    def marked(**given):
        inputs = {name: np.full((1, 1), value) for name, value in (common | given).items()}
        return np.asarray(model.flags(inputs, Tables())["small_contact"]).reshape(-1)

    assert marked(normal_force=0.02, sphere_radius=1e-3).all()
    assert not marked(normal_force=0.5, sphere_radius=8e-3).any()
    assert marked(normal_force=0.5, nominal_contact_area=1e-6).all()
    assert not marked(normal_force=0.5, nominal_contact_area=1e-4).any()
    assert not marked(nominal_pressure=6830.0).any()
