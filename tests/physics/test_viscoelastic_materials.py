"""Materials that relax: closed forms, Kramers and Kronig, time against frequency by quadrature, layers by recursion."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import quad

from skinbayes.contact import (
    LayeredSkin,
    ViscoelasticMaterial,
    ViscoelasticSkin,
    constant_loss_solid,
    effective_modulus,
    layered_modulus,
    material_of_dynamic_moduli,
    standard_linear_solid,
    validate_solid,
)
from skinbayes.errors import InputError

ZENER = standard_linear_solid(20e3, 28e3, relaxation_time=0.05)
BROAD = constant_loss_solid(
    20e3, 0.2, angular_frequency=1.0, lowest_frequency=1e-2, highest_frequency=1e2, poisson_ratio=0.4
)
PRONY = ViscoelasticMaterial(
    equilibrium_modulus=1e4, relaxing_moduli=[5e3, 2e2, 3e4], relaxation_times=[1e-3, 0.02, 4.0]
)
ELASTIC = ViscoelasticMaterial(equilibrium_modulus=2e4)
MATERIALS = [ZENER, BROAD, PRONY, ELASTIC]


def test_the_standard_linear_solid_has_its_closed_forms() -> None:
    t = np.array([0.0, 0.01, 0.3])
    assert ZENER.relaxation_modulus(t) == pytest.approx(20e3 + 8e3 * np.exp(-t / 0.05), rel=1e-14)
    retardation = 0.05 * 28 / 20
    creep = 1 / 20e3 - (1 / 20e3 - 1 / 28e3) * np.exp(-t / retardation)
    assert ZENER.creep_compliance(t) == pytest.approx(creep, rel=1e-13)
    assert ZENER.loss_tangent(np.sqrt(20 / 28) / 0.05) == pytest.approx(8 / (2 * np.sqrt(20 * 28)), rel=1e-14)
    omega, phase = 7.0, np.linspace(0, 2 * np.pi, 2001)
    modulus = ZENER.complex_modulus(omega)
    stress = modulus.real * np.sin(phase) + modulus.imag * np.cos(phase)
    loop = np.trapezoid(stress * 0.1 * 0.1 * np.cos(phase), phase)
    assert ZENER.hysteresis_loss(omega, strain_amplitude=0.1) == pytest.approx(loop, rel=1e-6)


@pytest.mark.parametrize("material", MATERIALS)
def test_modulus_is_the_transform_of_relaxation(material: ViscoelasticMaterial) -> None:
    for omega in (0.3, 20.0):
        slow = material.equilibrium_modulus

        def relaxing(log_time: float, slow: float = slow) -> float:
            return material.relaxation_modulus(np.exp(log_time)) - slow

        # E(ω) = E∞ + iω ∫ (E(t) − E∞) exp(−iωt) dt, turned by 45° into the complex plane: no oscillation is left
        def turned(log_time: float, omega: float = omega) -> complex:
            time = np.exp(log_time) * np.exp(-0.25j * np.pi)
            late = (material.relaxing_moduli * np.exp(-time / material.relaxation_times)).sum()
            return 1j * omega * late * np.exp(-1j * omega * time) * time

        span = {"limit": 400, "epsabs": 1e-6, "epsrel": 1e-10}
        parts = [
            quad(lambda x, p=part: getattr(turned(x), p), -25, 8, **span)[0] for part in ("real", "imag")
        ]
        assert complex(*parts) + slow == pytest.approx(material.complex_modulus(omega), rel=1e-7)
        assert relaxing(-30.0) == pytest.approx(material.instantaneous_modulus - slow, rel=1e-6, abs=1e-6)


@pytest.mark.parametrize("material", MATERIALS)
def test_storage_follows_from_loss_by_kramers_and_kronig(material: ViscoelasticMaterial) -> None:
    # E′(ω) − E∞ = (2ω²/π) ∫ [E″(x)/x − E″(ω)/ω] / (ω² − x²) dx: the term taken off integrates to nothing
    log_x = np.linspace(-25, 25, 100_001) + 1e-5
    x = np.exp(log_x)
    for omega in (0.1, 3.0):
        loss = material.complex_modulus(x).imag / x - material.complex_modulus(omega).imag / omega
        storage = 2 * omega**2 / np.pi * np.trapezoid(loss / (omega**2 - x**2) * x, log_x)
        expected = material.complex_modulus(omega).real - material.equilibrium_modulus
        assert storage == pytest.approx(expected, rel=2e-5, abs=1e-9)


@pytest.mark.parametrize("material", MATERIALS)
def test_creep_undoes_relaxation(material: ViscoelasticMaterial) -> None:
    # ∫ E(t − s) dJ(s) = 1, by quadrature over s in ln s and in ln(t − s)
    for time in (1e-3, 0.4, 30.0):
        early = np.exp(np.linspace(np.log(time) - 30, np.log(time / 2), 20001))
        late = time - early[::-1]
        s = np.concatenate([[0.0], early, late[1:], [time]])
        rise = np.diff(material.creep_compliance(s))
        relaxed = material.relaxation_modulus(time - (s[1:] + s[:-1]) / 2)
        whole = material.relaxation_modulus(time) * material.creep_compliance(0.0) + relaxed @ rise
        assert whole == pytest.approx(1.0, rel=1e-6)
    creep = material.creep
    compliance = creep.instantaneous + (creep.compliance / (1 + 3j * creep.retardation_time)).sum()
    assert compliance * material.complex_modulus(3.0) == pytest.approx(1.0, rel=1e-13)


@pytest.mark.parametrize("loss_tangent", [0.03, 0.1423, 0.6, 2.0])
def test_the_loss_angle_is_constant(loss_tangent: float) -> None:
    omega = np.geomspace(1e-2, 1e3, 200)
    material = constant_loss_solid(
        5e4, loss_tangent, angular_frequency=2.0, lowest_frequency=1e-2, highest_frequency=1e3
    )
    power = 2 / np.pi * np.arctan(loss_tangent)
    expected = 5e4 * (1j * omega / 2.0) ** power
    np.testing.assert_allclose(material.complex_modulus(omega), expected, rtol=1.5e-4)
    np.testing.assert_allclose(material.loss_tangent(omega), loss_tangent, rtol=5e-4)


def test_a_table_gives_back_its_material() -> None:
    omega = np.geomspace(1e-2, 1e2, 25)
    measured = BROAD.complex_modulus(omega)
    found = material_of_dynamic_moduli(
        omega, storage_modulus=measured.real, loss_modulus=measured.imag, poisson_ratio=0.4
    )
    between = np.geomspace(2e-2, 50, 77)
    np.testing.assert_allclose(found.complex_modulus(between), BROAD.complex_modulus(between), rtol=2e-3)
    time = np.geomspace(0.02, 50, 20)
    np.testing.assert_allclose(found.relaxation_modulus(time), BROAD.relaxation_modulus(time), rtol=3e-3)
    # a loss modulus without the rise of the storage modulus that belongs to it
    with pytest.raises(InputError, match="not those of one linear viscoelastic material"):
        material_of_dynamic_moduli(omega, storage_modulus=np.full(25, 2e4), loss_modulus=np.full(25, 1e4))
    with pytest.raises(InputError, match="rise"):
        material_of_dynamic_moduli(omega[::-1], storage_modulus=measured.real, loss_modulus=measured.imag)
    with pytest.raises(InputError, match="same two or more"):
        material_of_dynamic_moduli(omega, storage_modulus=measured.real, loss_modulus=measured.imag[1:])


def test_a_batch_and_its_rows_agree() -> None:
    moduli = np.array([[5e3, 3e4], [1e3, 2e3], [7.0, 1e5]])
    batch = ViscoelasticMaterial(
        equilibrium_modulus=[1e4, 2e4, 3e4],
        relaxing_moduli=moduli,
        relaxation_times=[0.01, 1.0],
        poisson_ratio=0.4,
    )
    omega = np.geomspace(0.1, 1e3, 7)
    for row in range(3):
        one = ViscoelasticMaterial(
            equilibrium_modulus=[1e4, 2e4, 3e4][row], relaxing_moduli=moduli[row],
            relaxation_times=[0.01, 1.0], poisson_ratio=0.4,
        )  # fmt: skip
        assert (batch.reduced_modulus(omega)[row] == one.reduced_modulus(omega)).all()
        assert (batch.relaxation_modulus(omega)[row] == one.relaxation_modulus(omega)).all()
        assert (batch.creep_compliance(omega)[row] == one.creep_compliance(omega)).all()
        assert batch.complex_modulus(3.0)[row] == one.complex_modulus(3.0)


def test_impossible_materials_are_nan_and_are_named() -> None:
    bad = ViscoelasticMaterial(
        equilibrium_modulus=2e4, relaxing_moduli=[1.0, -2.0], relaxation_times=[1.0, 2.0]
    )
    assert np.isnan(bad.complex_modulus(1.0))
    assert np.isnan(bad.creep_compliance([0.0, 1.0])).all()
    with pytest.raises(InputError, match="relaxing_moduli is -2 Pa"):
        validate_solid(bad)
    back = ViscoelasticMaterial(
        equilibrium_modulus=2e4, relaxing_moduli=[1.0, 2.0], relaxation_times=[2.0, 1.0]
    )
    with pytest.raises(InputError, match=r"relaxation_times is .* must rise"):
        validate_solid(back)
    with pytest.raises(InputError, match="layer: relaxation_times is 0 s, but must be a finite number > 0 s"):
        validate_solid(
            ViscoelasticSkin(
                layer=standard_linear_solid(1.0, 2.0, relaxation_time=0.0), bulk=ZENER, layer_thickness=1e-5
            )
        )
    with pytest.raises(InputError, match="loss_tangent is -1, but"):
        constant_loss_solid(1.0, -1.0, angular_frequency=1.0, lowest_frequency=1.0, highest_frequency=2.0)
    with pytest.raises(InputError, match="highest_frequency"):
        constant_loss_solid(1.0, 1.0, angular_frequency=1.0, lowest_frequency=2.0, highest_frequency=2.0)
    assert np.isnan(ZENER.relaxation_modulus(-1.0))


@pytest.mark.parametrize(
    ("material", "error"),
    [((7e6, 20e3, 0.5, 0.5), 1e-12), ((3e4, 2e4, 0.1, 0.4), 1e-12), ((2e4, 7e6, 0.4, 0.3), 1e-12),
     ((1e9, 2e4, 0.5, 0.3), 1e-9), ((2e11, 2e4, 0.45, 0.2), 2e-8)],
)  # fmt: skip
def test_layers_are_those_of_eq_4(material: tuple[float, ...], error: float) -> None:
    q = np.geomspace(1e-2, 1e8, 60)
    skin = LayeredSkin(
        young_modulus_layer=material[0], young_modulus_bulk=material[1], poisson_ratio_layer=material[2],
        poisson_ratio_bulk=material[3], layer_thickness=20e-6,
    )  # fmt: skip
    expected = effective_modulus(skin, q)
    one = layered_modulus(q, moduli=material[:2], poisson_ratios=material[2:], thicknesses=[20e-6])
    np.testing.assert_allclose(one, expected, rtol=error)
    # the layer cut in two and the uppermost millimetre of the half-space as a layer of its own
    more = layered_modulus(
        q,
        moduli=np.repeat(material[:2], 2),
        poisson_ratios=np.repeat(material[2:], 2),
        thicknesses=[5e-6, 15e-6, 1e-3],
    )
    np.testing.assert_allclose(more, expected, rtol=2 * error)


def test_complex_moduli_go_through_eq_4() -> None:
    q = np.geomspace(1e1, 1e7, 50)
    skin = ViscoelasticSkin(layer=BROAD, bulk=PRONY, layer_thickness=20e-6)
    for omega in (0.5, 300.0):
        expected = layered_modulus(
            q, moduli=[BROAD.complex_modulus(omega), PRONY.complex_modulus(omega)], poisson_ratios=[0.4, 0.5],
            thicknesses=[20e-6],
        )  # fmt: skip
        np.testing.assert_allclose(
            skin.complex_effective_modulus(q, angular_frequency=omega), expected, rtol=1e-11
        )
    # the frequencies of a rough countersurface that slides at 1 mm/s
    sliding = skin.complex_effective_modulus(q, angular_frequency=1e-3 * q)
    assert sliding[7] == skin.complex_effective_modulus(q[7], angular_frequency=1e-3 * q[7])
    assert (sliding.imag > 0).all()


def test_magnitudes_stand_for_complex_moduli() -> None:
    q = np.geomspace(1e1, 1e7, 200)
    for layer, bulk, bound in [(0.3, 0.3, 1e-10), (0.001, 0.3, 0.011), (0.3, 0.001, 0.011)]:
        parts = [
            constant_loss_solid(
                modulus, loss, angular_frequency=1.0, lowest_frequency=0.1, highest_frequency=10.0
            )
            for modulus, loss in ((7e6, layer), (20e3, bulk))
        ]
        skin = ViscoelasticSkin(layer=parts[0], bulk=parts[1], layer_thickness=20e-6)
        exact = np.abs(skin.complex_effective_modulus(q, angular_frequency=2.0))
        assert np.abs(effective_modulus(skin.at_frequency(2.0), q) / exact - 1).max() < bound
