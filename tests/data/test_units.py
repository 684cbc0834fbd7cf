"""Text with a unit to SI and back, against values that follow from the definition of the units."""

from math import inf, isclose, pi

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from skinbayes.errors import InputError
from skinbayes.units import convert_array, format_quantity, parse_quantity, split_header
from skinbayes.vocabulary import QUANTITIES


@pytest.mark.parametrize(
    ("text", "unit", "expected"),
    [
        ("15 MPa", "Pa", 15e6),
        ("15MPa", "Pa", 15e6),
        ("1e3 1/m", "1/m", 1e3),
        ("2 1/um", "1/m", 2e6),
        ("3 m^-1", "1/m", 3.0),
        ("20 um", "m", 2e-5),
        ("20 µm", "m", 2e-5),  # micro sign
        ("20 μm", "m", 2e-5),  # Greek letter
        ("20 degC", "K", 293.15),
        ("20 °C", "K", 293.15),
        ("180 deg", "rad", pi),
        ("0.5 mPa s", "Pa s", 5e-4),
        ("0.83 cP", "Pa s", 8.3e-4),
        ("5 kg/(m s)", "Pa s", 5.0),
        ("72.8 mN/m", "N/m", 0.0728),
        ("8 mm/s", "m/s", 0.008),
        ("50 %", "1", 0.5),
        ("0.3", "1", 0.3),
        (0.3, "1", 0.3),
        (2, "1", 2.0),
        ("-0.2 1", "1", -0.2),
        ("1 um^4", "m^4", 1e-24),
        ("30 min", "s", 1800.0),
        ("inf", "Pa", inf),
        ("inf Pa", "Pa", inf),
        (inf, "Pa", inf),
        ("+Infinity MPa", "Pa", inf),
        (np.float64(0.25), "1", 0.25),
    ],
)
def test_reads_what_people_write(text: str | float, unit: str, expected: float) -> None:
    assert parse_quantity(text, unit, where="x") == pytest.approx(expected, rel=1e-15)


def test_powers_of_ten_round_once() -> None:
    # 20 * 1e-6 is 1.9999999999999998e-05: a prefix below one has to divide
    for number in range(1, 1000):
        assert parse_quantity(f"{number} um", "m", where="x") == float(f"{number}e-6")
        assert parse_quantity(f"{number} GPa", "Pa", where="x") == float(f"{number}e9")


@pytest.mark.parametrize(
    ("value", "unit", "found", "expected"),
    [
        (15, "Pa", "15 has no unit", "a pressure in Pa, for example '15 MPa'"),
        ("15", "Pa", "15 has no unit", "a pressure in Pa"),
        (0.5, "N", "0.5 has no unit", "a force in N"),
        ("15 m", "Pa", "'15 m' has the wrong dimension", "Pa"),
        ("15 deg", "1", "'15 deg' has the wrong dimension", "without dimension"),
        ("0.3 1", "rad", "wrong dimension", "an angle in rad"),
        ("5 %", "rad", "wrong dimension", "an angle in rad"),
        ("15 mpa", "Pa", "'15 mpa' has an unknown unit", "Pa"),
        ("15 quux", "m/s", "has an unknown unit", "a speed in m/s"),
        ("nan Pa", "Pa", "not a number", "Pa"),
        (float("nan"), "1", "not a number", "without dimension"),
        (-inf, "Pa", "not a number that can be used", "Pa"),
        ("-inf Pa", "Pa", "not a number that can be used", "Pa"),
        ("1e999 Pa", "Pa", "not a number that can be used", "Pa"),
        ("1e308 GPa", "Pa", "too large", "Pa"),
        (10**400, "1", "not a number that can be used", "without dimension"),
        ("0,5 mPa s", "Pa s", "decimal comma", "Pa s"),
        ("", "Pa", "not a number", "Pa"),
        ("MPa", "Pa", "not a number", "Pa"),
        ("inf m", "Pa", "wrong dimension", "Pa"),
        (True, "1", "True is not a number", "without dimension"),
        (None, "1", "None is not a number", "without dimension"),
        (["15 MPa"], "Pa", "is not a number", "Pa"),
        ("5 m^9^9^9^9", "m", "has an unknown unit", "a length in m"),
        ("5 m**9**9**9", "m", "has an unknown unit", "m"),
        ("5 /m", "1/m", "has an unknown unit", "1/m"),
        ("5 (((", "m", "has an unknown unit", "m"),
        ("5 degC/s", "K", "wrong dimension", "K"),
        ("5 __import__('os')", "m", "has an unknown unit", "m"),
        ("5 " + "m" * 10_000, "m", "has an unknown unit", "m"),
    ],
)
def test_refuses_and_says_why(value: object, unit: str, found: str, expected: str) -> None:
    with pytest.raises(InputError) as caught:
        parse_quantity(value, unit, where="model.toml, parameters.yield_stress")  # type: ignore[arg-type]
    message = str(caught.value)
    assert message.startswith("model.toml, parameters.yield_stress: ")
    assert found in message
    assert "expected" in message and expected in message
    assert len(message) < 300


@given(
    st.one_of(
        st.text(max_size=30), st.floats(), st.integers(), st.booleans(), st.none(), st.binary(max_size=5)
    )
)
def test_any_value_is_read_or_refused(value: object) -> None:
    try:
        assert isinstance(parse_quantity(value, "Pa", where="x"), float)  # type: ignore[arg-type]
    except InputError as error:
        assert str(error).startswith("x: ")


@given(st.text(alphabet="mPasN/1*^()-²³⁻°%µ rdegCk", min_size=1, max_size=20))
def test_any_unit_text_is_converted_or_refused(unit: str) -> None:
    try:
        assert np.isfinite(convert_array(1.0, unit, "Pa", "x"))
    except InputError as error:
        assert str(error).startswith("x: ")


@given(
    st.floats(min_value=1e-11, max_value=1e11),
    st.sampled_from(sorted({quantity.unit for quantity in QUANTITIES.values()} | {"m^4", "m^3"})),
)
def test_formatted_values_can_be_read_again(value: float, unit: str) -> None:
    assert isclose(parse_quantity(format_quantity(value, unit), unit, where="x"), value, rel_tol=6e-4)


@pytest.mark.parametrize(
    ("value", "unit", "text"),
    [
        (15e6, "Pa", "15 MPa"),
        (6830.0, "Pa", "6.83 kPa"),
        (999.96, "Pa", "1 kPa"),
        (-2e9, "Pa", "-2 GPa"),
        (2.24e-5, "m", "22.4 µm"),
        (0.5, "N", "0.5 N"),
        (8.3e-4, "Pa s", "830 µPa s"),
        (0.0728, "N/m", "72.8 mN/m"),
        (3.81e-4, "m^2", "381 mm^2"),
        (0.42, "1", "0.42"),
        (6.48e-4, "1", "0.000648"),
        (1e9, "1/m", "1e9 1/m"),
        (293.15, "K", "293.15 K"),
        (0.0, "Pa", "0 Pa"),
        (inf, "Pa", "inf"),
    ],
)
def test_formats_for_people(value: float, unit: str, text: str) -> None:
    assert format_quantity(value, unit) == text


def test_spread_of_a_temperature_has_no_offset() -> None:
    assert convert_array([0.0, 1.5], "degC", "K", "x", difference=True).tolist() == [0.0, 1.5]
    assert convert_array([0.0, 1.5], "degC", "K", "x").tolist() == [273.15, 274.65]
    assert convert_array([1.8], "delta_degF", "K", "x", difference=True) == pytest.approx([1.0])


def test_every_unit_of_the_vocabulary_converts_to_itself() -> None:
    for unit in {quantity.unit for quantity in QUANTITIES.values()}:
        values = np.array([0.1, 3.0, 1e-7])
        assert convert_array(values, unit, unit, "x").tolist() == values.tolist()


@pytest.mark.parametrize(
    ("header", "name", "unit"),
    [
        ("normal_force [N]", "normal_force", "N"),
        ("  viscosity [Pa s] ", "viscosity", "Pa s"),
        ("person", "person", None),
        ("normal_force []", "normal_force", ""),
        ("normal_force (N)", "normal_force (N)", None),
        ("normal_force [N", "normal_force [N", None),
        ("a [N] b", "a [N] b", None),
    ],
)
def test_splits_headers(header: str, name: str, unit: str | None) -> None:
    assert split_header(header) == (name, unit)
