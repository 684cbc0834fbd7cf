"""The paper's numbers for contact area and friction (Sect. 4, Fig. 6) through the command line, and others besides."""

from __future__ import annotations

import numpy as np
import pytest
from command_line import run
from plain_contact import PlainContact
from scipy.optimize import brentq

DRY = ("young_modulus_layer=1 GPa", "yield_stress=50 MPa")


@pytest.fixture
def predict(capsys):
    def at(*pairs: str, model: str = "contact-area") -> dict[str, list[float]]:
        words = [word for pair in pairs for word in ("--set", pair)]
        outcome = run(capsys, "predict", model, "--json", *words)
        # medians of a prior are no result, which is said where there are free parameters
        assert outcome.status == 0 and (outcome.errors == "" or "no result of a fit" in outcome.errors)
        return outcome.document()["prediction"]

    return at


def area(prediction) -> float:
    return prediction["relative_contact_area"][-1]


def test_wet_skin(predict):
    # to the digits printed; 6.59e-4 is the paper's value
    assert area(predict()) == pytest.approx(6.48e-4, rel=1e-3)
    assert area(predict("area_correction=0.406")) == pytest.approx(6.59e-4, rel=1e-3)
    assert area(predict("area_correction=none")) == pytest.approx(4.20e-4, rel=1e-3)


def test_dry_skin(predict):
    dry = predict(*DRY)
    # fully plastic: A/A0 = p0/σ_Y, whatever the roughness
    assert area(dry) == pytest.approx(6.83e3 / 50e6, rel=1e-6)
    assert area(dry) == pytest.approx(1.366e-4, rel=1e-3)
    assert dry["plastic_fraction"][-1] == pytest.approx(1.0, abs=1e-6)
    elastic = predict(
        "young_modulus_layer=1 GPa", "area_correction=none"
    )  # fmt: skip
    assert area(elastic) == pytest.approx(2.9e-6, rel=0.02)


@pytest.mark.parametrize(
    ("correction", "wavevectors"),
    [("none", (7.1e4, 8.3e4, 1.1e5)), ("0.42", (8.4e4, 1.0e5, 1.4e5))],
)
def test_where_dry_skin_yields(predict, correction, wavevectors):
    def fraction(log_q: float) -> float:
        settings = (*DRY, f"area_correction={correction}", f"wavevector={float(np.exp(log_q))!r} 1/m")
        return predict(*settings)["plastic_fraction"][0]

    for wanted, expected in zip((0.10, 0.50, 0.99), wavevectors, strict=True):
        found = np.exp(brentq(lambda u, w=wanted: fraction(u) - w, np.log(3e4), np.log(1e6), xtol=1e-3))
        assert found == pytest.approx(expected, rel=0.05)  # two digits are given


def test_layer_response(predict):
    # S(0) = E0*/E1* and S(∞) = 1
    wide = predict("surface=paper_reference", "wavevector_min=1e-3 1/m", "wavevector=1e-2 1/m")
    assert wide["surface_response"][0] == pytest.approx(7e6 / 20e3, rel=1e-4)
    fine = predict("wavevector=1e9 1/m")
    assert fine["surface_response"][0] == pytest.approx(1.0, rel=1e-6)
    assert fine["effective_modulus"][0] == pytest.approx(7e6 / 0.75, rel=1e-6)
    unequal = predict(
        "wavevector_min=1e-3 1/m", "wavevector=1e-2 1/m", "poisson_ratio_layer=0.3", "poisson_ratio_bulk=0.45"
    )
    assert unequal["surface_response"][0] == pytest.approx(7e6 / 0.91 / (20e3 / 0.7975), rel=1e-4)


def test_friction_of_dry_and_wet_skin(predict):
    settings = (
        "frictional_shear_stress=15 MPa", "young_modulus_layer[dry]=1 GPa", "young_modulus_layer[wet]=7 MPa",
        "yield_stress[dry]=50 MPa", "young_modulus_bulk=20 kPa", "layer_thickness=20 um", "rms_height=22.4 um",
    )  # fmt: skip
    dry, wet = predict(*settings, model="forearm-glass")["friction_coefficient"]
    assert dry == pytest.approx(0.300, abs=5e-4)
    assert wet == pytest.approx(1.42, abs=5e-3)
    # the load itself instead of the Hertz pressure it gives
    dry, wet = predict(*settings, "nominal_pressure=6.83 kPa", model="forearm-glass")["friction_coefficient"]
    assert dry == pytest.approx(0.300, abs=5e-4)
    assert wet == pytest.approx(1.42, abs=5e-3)


NAMES = {
    "layer": ("young_modulus_layer", "Pa"),
    "bulk": ("young_modulus_bulk", "Pa"),
    "nu_layer": ("poisson_ratio_layer", ""),
    "nu_bulk": ("poisson_ratio_bulk", ""),
    "thickness": ("layer_thickness", "m"),
    "height": ("rms_height", "m"),
    "hurst": ("hurst_exponent", ""),
    "low": ("wavevector_min", "1/m"),
    "rolloff": ("wavevector_rolloff", "1/m"),
    "high": ("wavevector_max", "1/m"),
}
CASES = {
    "paper, wet": ({}, {"pressure": 6.83e3}),
    "paper, dry": ({"layer": 1e9}, {"pressure": 6.83e3, "yield_stress": 50e6}),
    "paper, dry, half yielded": ({"layer": 1e9}, {"pressure": 6.83e3, "yield_stress": 50e6, "q": 1e5}),
    "plain, soft and thick": (
        {"layer": 2e6, "bulk": 8e3, "thickness": 120e-6, "hurst": 0.6, "height": 10e-6},
        {"pressure": 2e4, "correction": 1.0},
    ),
    "other Poisson ratios": (
        {"layer": 3e7, "nu_layer": 0.3, "nu_bulk": 0.45, "thickness": 50e-6, "hurst": 0.9},
        {"pressure": 5e4, "correction": 0.6, "q": 3e6},
    ),
    "near full contact": ({"layer": 5e4, "height": 2e-6}, {"pressure": 2e4, "q": 2e4}),
    "soft plastic": (
        {"layer": 2e8, "high": 1e7, "rolloff": 1e3}, {"pressure": 3e5, "yield_stress": 2e6, "correction": 0.42},
    ),
    "hard, thin layer": (
        {"layer": 3e9, "bulk": 5e3, "thickness": 5e-6}, {"pressure": 1e3, "yield_stress": 1e8, "q": 5e4},
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", CASES)
def test_against_independent_code(predict, case):
    skin, contact = CASES[case]
    settings = [f"{NAMES[key][0]}={value!r} {NAMES[key][1]}".strip() for key, value in skin.items()]
    settings.append(f"nominal_pressure={contact['pressure']!r} Pa")
    settings.append(f"area_correction={contact.get('correction', 0.42)!r}")
    settings.append(f"wavevector={contact.get('q', skin.get('high', 1e9))!r} 1/m")
    if "yield_stress" in contact:
        settings.append(f"yield_stress={contact['yield_stress']!r} Pa")
    predicted = predict(*settings)
    plain = PlainContact(**skin)
    elastic, plastic = plain.area(**contact)
    assert predicted["relative_contact_area_elastic"][0] == pytest.approx(elastic, rel=1e-4, abs=1e-12)
    assert predicted["relative_contact_area_plastic"][0] == pytest.approx(plastic, rel=1e-4, abs=1e-12)
    assert predicted["relative_contact_area"][0] == pytest.approx(elastic + plastic, rel=1e-4)
    q = contact.get("q", skin.get("high", 1e9))
    assert predicted["surface_response"][0] == pytest.approx(plain.response(q), rel=1e-6)


@pytest.mark.parametrize("q", [2e3, 2e4, 1e5, 3e5, 2e6])
def test_response_of_the_layer_against_an_elastic_solution(predict, q):
    skin = {"layer": 4e8, "bulk": 1.5e4, "nu_layer": 0.35, "nu_bulk": 0.48, "thickness": 30e-6}
    settings = [f"{NAMES[key][0]}={value!r} {NAMES[key][1]}".strip() for key, value in skin.items()]
    found = predict(*settings, f"wavevector={q!r} 1/m")["surface_response"][0]
    assert found == pytest.approx(PlainContact(**skin).response(q), rel=1e-7)


def test_friction_against_independent_code(predict):
    settings = (
        "frictional_shear_stress=8 MPa", "young_modulus_layer=12 MPa", "layer_thickness=150 um", "rms_height=30 um",
    )  # fmt: skip
    friction = predict(*settings, model="finger-water")["friction_coefficient"]
    plain = PlainContact(layer=12e6, thickness=150e-6, height=30e-6)
    for row, (load, pad) in ((0, (0.302520235, 3.333e-4)), (6, (1.6948841, 4.582e-4))):
        pressure = load / pad
        elastic, _ = plain.area(pressure)
        assert friction[row] == pytest.approx(8e6 * elastic / pressure, rel=1e-4)
