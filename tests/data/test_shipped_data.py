"""What is shipped: complete, unchanged, spot-checked against the numbers in the sources."""

import hashlib
import re
from pathlib import Path

import numpy as np
import pytest

from skinbayes.errors import InputError
from skinbayes.files import load_dataset, load_reference, shipped_folder, shipped_names
from skinbayes.files.provenance import load_provenance
from skinbayes.units import convert_array

NAMES = shipped_names("datasets")
MEASUREMENTS = {
    "adams2007-forearm-glass": 2,
    "fehlberg2025-finger-stribeck": 165,
    "fehlberg2025-rheology": 306,
    "persson2013-drying-summary": 1,
    "tortos2024-pla-on-silicone": 140,
}
REFERENCE = {
    "buchholz1988-palmar-friction": 10,
    "contact-angles": 7,
    "fehlberg2025-powerlaw-fit": 15,
    "frictional-shear-stress-estimates": 4,
    "persson2013-reported-values": 54,
    "persson2013-statements": 212,
    "skin-friction-relative-effects": 22,
    "skin-friction-summaries": 12,
    "sources": 34,
    "stratum-corneum-humidity": 7,
    "stratum-corneum-modulus": 18,
    "stratum-corneum-thickness": 9,
}


def folder(name: str) -> Path:
    return shipped_folder("datasets") / name


def test_everything_is_known_here() -> None:
    assert set(NAMES) == {*MEASUREMENTS, *REFERENCE}


@pytest.mark.parametrize("name", MEASUREMENTS)
def test_measurements_load(name: str) -> None:
    data = load_dataset(name)
    assert data.n_rows == MEASUREMENTS[name]
    assert data.provenance is not None and data.provenance.kind == "measurements"
    with pytest.raises(InputError, match="holds measurements"):
        load_reference(name)


@pytest.mark.parametrize("name", REFERENCE)
def test_reference_tables_load_and_cannot_be_fitted(name: str) -> None:
    table = load_reference(name)
    assert len(table.rows) == REFERENCE[name]
    assert set(table.provenance.columns) == set(table.columns)
    assert len(table.to_pandas()) == REFERENCE[name]
    with pytest.raises(InputError, match="reference table: published values"):
        load_dataset(name)


@pytest.mark.parametrize("name", NAMES)
def test_checksum_is_of_the_file(name: str) -> None:
    content = (folder(name) / "data.csv").read_bytes()
    assert load_provenance(folder(name) / "provenance.toml").sha256 == hashlib.sha256(content).hexdigest()
    assert b"\r" not in content


@pytest.mark.parametrize("name", NAMES)
def test_no_row_stands_twice(name: str) -> None:
    rows = (folder(name) / "data.csv").read_text(encoding="utf-8").splitlines()[1:]
    assert len(rows) == len(set(rows))


@pytest.mark.parametrize("name", NAMES)
def test_provenance_says_where_from(name: str) -> None:
    provenance = load_provenance(folder(name) / "provenance.toml")
    assert all(re.fullmatch(r"10\.\d{4,9}/\S+", doi) for doi in provenance.doi)
    assert provenance.caveats
    if "CC BY" in provenance.licence:
        assert provenance.attribution is not None
        for needed in (
            "Zenodo 15365365",
            "CC BY 4.0",
            "Changed:",
            *(author.split()[-1] for author in provenance.authors),
        ):
            assert needed in provenance.attribution


@pytest.mark.parametrize("name", REFERENCE)
def test_every_source_and_grade_is_explained(name: str) -> None:
    known = {row["source"] for row in load_reference("sources").rows}
    table = load_reference(name)
    for row in table.rows:
        assert row.get("source", "PERSSON2013") in known
        if "grade" in table.columns:
            assert row["grade"] in table.provenance.grades


@pytest.mark.parametrize("name", REFERENCE)
def test_every_stated_unit_is_a_unit(name: str) -> None:
    table = load_reference(name)
    for row in table.rows:
        unit = row.get("unit")
        if isinstance(unit, str) and unit != "Pa s^0.2":  # the constant of a power law
            assert convert_array(1.0, unit, unit, name) == 1.0


@pytest.mark.parametrize("name", REFERENCE)
def test_ranges_are_ordered(name: str) -> None:
    for row in load_reference(name).rows:
        low, high = row.get("value_low"), row.get("value_high")
        if isinstance(low, float) and isinstance(high, float):
            assert low <= high


def test_forearm_on_glass() -> None:
    data = load_dataset("adams2007-forearm-glass")
    assert data.labels("state") == ("dry", "wet")
    assert data.columns["friction_coefficient"].tolist() == [0.3, 1.4]
    assert data.columns["normal_force"].tolist() == [0.5, 0.5]
    assert data.columns["sphere_radius"].tolist() == [0.008, 0.008]
    assert data.columns["sliding_speed"].tolist() == [0.008, 0.008]
    assert not any(name.endswith("_standard_deviation") for name in data.columns)
    assert "nominal_pressure" not in data.columns


def test_silicone_under_rising_load() -> None:
    data = load_dataset("tortos2024-pla-on-silicone")
    load, friction = data.columns["normal_force"], data.columns["friction_coefficient"]
    np.testing.assert_allclose(data.columns["nominal_pressure"], load / (4e-3) ** 2, rtol=1e-12)
    spots = {("Dragon Skin 10", 0.04): 2.85945, ("Dragon Skin 10", 0.5): 1.441, ("Sil 950", 0.01): 1.07653}
    elastomer, first = data.columns["elastomer"], data.columns["instrument"] == "nanotribometer"
    for (name, force), expected in spots.items():
        assert friction[(elastomer == name) & first & np.isclose(load, force)].tolist() == [expected]
    for name in data.labels("elastomer"):
        for instrument in data.labels("instrument"):
            assert (
                np.diff(load[(elastomer == name) & (first == (instrument == "nanotribometer"))]) > 0
            ).all()
    licence = (folder("tortos2024-pla-on-silicone") / "LICENSE").read_text(encoding="utf-8")
    assert "Copyright (c) 2024 tolstoys19" in licence and "shall be included in all" in licence


def test_finger_pad_design() -> None:
    data = load_dataset("fehlberg2025-finger-stribeck")
    pairs = set(zip(data.columns["person"].tolist(), data.columns["liquid"].tolist(), strict=True))
    assert len(data.labels("person")) == 11 and len(data.labels("liquid")) == 15 and len(pairs) == 165
    for name in ("nominal_contact_area", "skin_hydration"):  # one value for each person
        assert len(set(zip(data.columns["person"].tolist(), data.columns[name].tolist(), strict=True))) == 11


@pytest.mark.parametrize(
    ("column", "lowest", "highest"),
    [
        ("sliding_speed", 0.024, 0.129),
        ("normal_force", 0.17, 4.05),
        ("friction_coefficient", 0.084, 1.97),
        ("viscosity", 0.00083, 31.4),
        ("nominal_contact_area", 2.648e-4, 6.18e-4),
        ("skin_hydration", 25.0, 80.0),
    ],
)
def test_finger_pad_ranges(column: str, lowest: float, highest: float) -> None:
    values = load_dataset("fehlberg2025-finger-stribeck").columns[column]
    assert values.min() == pytest.approx(lowest, rel=0.03)
    assert values.max() == pytest.approx(highest, rel=0.005)


def test_first_row_of_the_deposit() -> None:
    data = load_dataset("fehlberg2025-finger-stribeck")
    first = {name: values[0].item() for name, values in data.columns.items()}
    assert first == {
        "person": "ID01",
        "liquid": "water",
        "friction_coefficient": 1.00804219497543,
        "normal_force": 0.302520235,
        "sliding_speed": 0.035744513027492,
        "viscosity": 8.3e-4,
        "nominal_contact_area": 3.333e-4,
        "skin_hydration": 50.0,
    }


def test_water_rows() -> None:
    water = load_dataset("fehlberg2025-finger-stribeck").select({"liquid": ["water"]})
    assert water.n_rows == 11 and len(water.labels("person")) == 11
    friction = water.columns["friction_coefficient"]
    assert friction.min() == pytest.approx(0.525, abs=5e-4) and friction.max() == pytest.approx(
        1.113, abs=5e-4
    )


def test_liquids_have_the_same_names_everywhere() -> None:
    friction = load_dataset("fehlberg2025-finger-stribeck")
    rheology = load_dataset("fehlberg2025-rheology")
    fit = load_reference("fehlberg2025-powerlaw-fit")
    assert (
        set(friction.labels("liquid"))
        == set(rheology.labels("liquid"))
        == {row["liquid"] for row in fit.rows}
    )


def test_power_law_gives_the_viscosity_of_the_friction_table() -> None:
    """The consistency is in Pa s^n, whatever the deposited header says."""
    friction = load_dataset("fehlberg2025-finger-stribeck")
    for row in load_reference("fehlberg2025-powerlaw-fit").rows:
        consistency, exponent = row["consistency [Pa s^n]"], row["exponent [1]"]
        assert isinstance(consistency, float) and isinstance(exponent, float)
        viscosity = friction.select({"liquid": [str(row["liquid"])]}).columns["viscosity"]
        np.testing.assert_allclose(viscosity, consistency * 500.0**exponent, rtol=1e-12)


def test_flow_curves() -> None:
    data = load_dataset("fehlberg2025-rheology")
    for liquid in data.labels("liquid"):
        curve = data.select({"liquid": [liquid]})
        rate = curve.columns["shear_rate"]
        assert np.all(np.diff(rate) > 0)
        assert (rate[0], rate[-1]) == (10.0, 126.0 if liquid == "honey + 6 g starch" else 1000.0)
    honey = data.select({"liquid": ["honey"]})
    assert honey.columns["viscosity"][[0, -1]].tolist() == [7.184, 5.9174]


def test_estimates_of_shear_stress_are_called_model_outputs() -> None:
    table = load_reference("frictional-shear-stress-estimates")
    assert [row["frictional_shear_stress [Pa]"] for row in table.rows] == [15e6, 15e6, 13e6, 5e6]
    assert all(str(row["grade"]).startswith("model-derived") for row in table.rows)
    assert "not measurements" in table.provenance.caveats[0]


def test_contact_angles_in_radians() -> None:
    for row in load_reference("contact-angles").rows:
        if row["unit"] == "rad":
            degrees = re.findall(r"[0-9.]+", str(row["as_printed"]))
            expected = np.radians(float(degrees[0]))
            assert row["value_low"] == pytest.approx(expected, abs=1e-6)
