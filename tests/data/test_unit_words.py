"""The words that units are made of: those that are listed, as people spell them, and no others."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from skinbayes.errors import InputError
from skinbayes.units import convert_array, format_quantity, parse_quantity
from skinbayes.units.unit_words import UNIT_WORDS

PAGE = Path(__file__).parents[2] / "docs" / "data.md"

SPELLINGS = {
    "Pa s": {
        1e-3: "mPa.s|mPa s|mPa·s|mPa⋅s|mPa∙s|mPa•s|mPa×s|mPa*s|mPa-s|mPas|mPa\u00a0s|mN s/m^2|mN.s.m-2|mNs/m²|cP|cps|"
        "centipoise|g/(m s)|g m-1 s-1|milliPascal second|millipascal seconds|㎩ ms",
        1.0: "Pa.s|Pa s|N s m^-2|N·s/m²|kg m⁻¹ s⁻¹|kg/m/s|Pas|Pascal-second",
        0.1: "P|poise|g/(cm s)|dyn s/cm^2",
    },
    "N/m": {1.0: "N m-1|N m^-1|N m**-1|N·m⁻¹|N m^(-1)|N/m|J/m2|J m-2", 1e-3: "mN/m|dyn/cm|mJ/m²|erg/cm^2"},
    "m": {1e-6: "um|µm|μm|micron|microns|micrometre|Micrometers|㎛", 1e-10: "Å|\u212b|angstrom", 0.0254: "in|inch", 0.01: "cm"},
    "1/m": {1e6: "1/um|µm^-1|μm-1|um⁻¹|1/µm|rad/um", 100.0: "1/cm|cm-1"},
    "N": {1e-3: "mN|millinewton|millinewtons", 9.80665e-3: "gf", 9.80665: "kgf|kp", 4.4482216152605: "lbf", 1e-5: "dyn"},
    "Pa": {
        1e6: "MPa|N/mm2|N mm-2|megapascal", 1e3: "kPa", 1e9: "GPa", 1e5: "bar", 100.0: "mbar|hPa",
        133.322387415: "mmHg", 101325 / 760: "Torr", 6894.757293168361: "psi", 98066.5: "kgf/cm^2",
    },
    "m/s": {1e-3: "mm/s|mm s-1|mm per s|mm·s⁻¹|mm s^-1", 1e-2 / 60: "cm/min", 1 / 3600: "m/h"},
    "1/s": {1.0: "1/s|s-1|s⁻¹|s^-1|sec-1", 1 / 60: "1/min"},
    "1": {0.01: "%|percent", 1.0: "1|-|–", 1e-3: "‰"},
    "rad": {0.017453292519943295: "deg|°|º|degrees", 1.0: "rad", 1e-3: "mrad"},
    "m^3": {1e-9: "ul|µL|µl|microlitre|mm^3|mm³", 1e-6: "mL|ml|cm3"},
    "s": {1e-3: "ms", 60.0: "min|minutes", 3600.0: "h|hr|hours", 86400.0: "d|days", 1.0: "sec|seconds"},
}  # fmt: skip


@pytest.mark.parametrize(
    ("spelling", "unit", "factor"),
    [
        (spelling, unit, factor)
        for unit, factors in SPELLINGS.items()
        for factor, spellings in factors.items()
        for spelling in spellings.split("|")
    ],
)
def test_as_people_spell_it(spelling: str, unit: str, factor: float) -> None:
    assert convert_array(1.0, spelling, unit, "x") == pytest.approx(factor, rel=4e-15)


@pytest.mark.parametrize(
    ("text", "kelvin"),
    [
        ("20 °C", 293.15), ("20 ºC", 293.15), ("20 ˚C", 293.15), ("20 degC", 293.15), ("20 deg C", 293.15), ("20 C", 293.15),
        ("20 ℃", 293.15), ("20 Celsius", 293.15), ("20 degrees Celsius", 293.15), ("293.15 K", 293.15), ("293.15 kelvin", 293.15),
        ("68 °F", 293.15), ("68 degF", 293.15), ("-40 °F", 233.15), ("-40 degC", 233.15), ("212 F", 373.15),
        ("212 deg F", 373.15), ("293 deg K", 293.0), ("293 °K", 293.0), ("293 degrees Kelvin", 293.0),
    ],
)  # fmt: skip
def test_scales_of_temperature(text: str, kelvin: float) -> None:
    assert parse_quantity(text, "K", where="x") == pytest.approx(kelvin, abs=1e-9)


@pytest.mark.parametrize(
    ("text", "unit"),
    [("5 deg m", "m"), ("5 rad Pa", "Pa"), ("5 m/rad", "m"), ("5 N/deg", "N"), ("5 rad2/m", "1/m"), ("5 1/deg", "1"),
     ("5 °", "1"), ("5 deg", "K"), ("5 m/m", "rad")],
)  # fmt: skip
def test_an_angle_is_no_number(text: str, unit: str) -> None:
    with pytest.raises(InputError, match="wrong dimension"):
        parse_quantity(text, unit, where="x")


def test_an_angle_per_length_or_time_is_a_wavevector_or_a_rate() -> None:
    assert parse_quantity("5 rad/um", "1/m", where="x") == pytest.approx(5e6)
    assert parse_quantity("180 deg/s", "1/s", where="x") == pytest.approx(3.141592653589793)


@pytest.mark.parametrize("blanks", [160, 300, 100_000])
def test_nothing_after_many_blanks_is_overlooked(blanks: int) -> None:
    with pytest.raises(InputError, match="unknown unit"):
        parse_quantity(f"5 m{' ' * blanks}/s", "m", where="x")
    with pytest.raises(InputError, match="unknown"):
        convert_array([5.0], f"m{' ' * blanks}/s", "m", "x")


def test_differences_of_temperature() -> None:
    assert convert_array([1.8], "degF", "K", "x", difference=True) == pytest.approx([1.0])
    assert convert_array([1.5], "delta_degC", "K", "x", difference=True).tolist() == [1.5]
    with pytest.raises(InputError, match="is a difference"):
        parse_quantity("20 delta_degC", "K", where="x")


# what a registry of all units reads, and nobody who measures friction means
OTHERS = {
    "1/m": "1/px 1/pixel 1/dot 1/ppi ppi dpi 1/point 1/pica 1/css_pixel 1/hand 1/smoot cycles/m 1/ly",
    "m": "px pixel dot point pica css_pixel smoot hand league fathom furlong parsec ly Mm Gm pt a0 mil thou yard nmi",
    "m^2": "barn acre are hectare a ha b",
    "N": "kip MN GN sthene ounce_force oz tonf n S",
    "Pa": "ksi at mpa MPA Mpa kpa PA barye cmH2O kip/ft^2 water",
    "1/s": "Hz rpm Bq kBq Ci baud revolutions_per_minute counts_per_second",
    "s": "dog_year year yr month fortnight eon week shake a jiffy",
    "m^3": "gallon pint bushel barrel cup drop lambda",
    "1": "ppm ppb dozen bit byte count USD mol %RH dB decade",
    "rad": "turn grad gon arcmin revolution cycle",
    "K": "degR Ra delta_degF eV",
    "kg": "slug stone",
}
"""Units of Pint (or not) that are unknown here."""


@pytest.mark.parametrize(
    ("word", "unit"), [(word, unit) for unit, words in OTHERS.items() for word in words.split()]
)
def test_no_other_word_is_a_unit(word: str, unit: str) -> None:
    with pytest.raises(InputError) as caught:
        parse_quantity(f"3 {word}", unit, where="x")
    assert "unknown unit" in str(caught.value) or "is a difference" in str(caught.value)


@pytest.mark.parametrize(
    ("text", "unit", "advice"),
    [
        ("15 mpa", "Pa", "did you mean 'MPa' or 'mPa'?"),
        ("15 kpa", "Pa", "'kPa'"),
        ("15 Mpa", "Pa", "'MPa'"),
        ("3 MM", "m", "'mm'"),
        ("3 Mm/s", "m/s", "'mm/s'"),
        ("3 newtom", "N", "'newton'"),
        ("0.5 n", "N", "'N'"),
        ("3 mPa*S", "Pa s", "'mPa*s'"),
        ("50 %RH", "1", "relative humidity is a fraction"),
        ("50 % RH", "1", "relative humidity is a fraction"),
        ("3 1/px", "1/m", "a pixel has no size of its own"),
        ("100 rpm", "m/s", "radius"),
        ("50 g", "N", "wrong dimension (a mass)"),
        ("50 cSt", "Pa s", "wrong dimension (a kinematic viscosity"),
        ("50 MPa", "N", "wrong dimension (a pressure)"),
        ("3 quux/m", "1/m", "no word 'quux' is known"),
    ],
)
def test_says_what_may_have_been_meant(text: str, unit: str, advice: str) -> None:
    with pytest.raises(InputError) as caught:
        parse_quantity(text, unit, where="x")
    assert advice in str(caught.value) and "expected" in str(caught.value)
    assert len(str(caught.value)) < 300


@pytest.mark.parametrize(
    ("number", "advice"),
    [
        ("1,000", "write 1.000 if it is decimal, 1000 if it is a thousand's"),
        ("-12,500", "write -12.500 if it is decimal, -12500 if it is a thousand's"),
        ("0,500", "a decimal comma; write 0.500"),
        ("0,5", "a decimal comma; write 0.5"),
        ("1234,5", "a decimal comma; write 1234.5"),
        ("1,5e3", "a decimal comma; write 1.5e3"),
        ("1,000,000", "separated thousands; write 1000000"),
        ("1 000", "separated thousands; write 1000"),
        ("1'000", "separated thousands; write 1000"),
        ("1.000,5", "separated thousands; write 1000.5"),
        ("1,000.5", "separated thousands; write 1000.5"),
        ("1.234.567,8", "separated thousands; write 1234567.8"),
        ("1.234.567", "separated thousands; write 1234567"),
        ("1 234,5", "separated thousands; write 1234.5"),
    ],
)
@pytest.mark.parametrize("blank", [" ", ""])
def test_commas_and_thousands(number: str, advice: str, blank: str) -> None:
    with pytest.raises(InputError) as caught:
        parse_quantity(f"{number}{blank}mN", "N", where="x")
    assert advice in str(caught.value)


def unit_table() -> list[tuple[str, str, str]]:
    return [
        (
            ", ".join(f"`{symbol}`" for symbol in unit.symbols),
            " ".join(unit.prefixes),
            ", ".join(unit.names),
        )
        for unit in UNIT_WORDS
    ]


def test_the_page_lists_every_unit() -> None:
    section = PAGE.read_text(encoding="utf-8").split("\n### Units\n")[1].split("\n### ")[0]
    shown = re.findall(r"^\|(.*)\|(.*)\|(.*)\|$", section, re.MULTILINE)[2:]
    assert [tuple(cell.strip() for cell in row) for row in shown] == unit_table()
    for symbols, _, names in unit_table():
        assert symbols or names


@pytest.mark.parametrize(
    ("value", "unit", "written", "shown"),
    [
        (1.3962634015954636, "rad", "80 deg", "80 deg"),
        (1.3962634015954636, "rad", "fixed at 80°", "80 °"),
        (1.2, "rad", "1.2 rad", "1.2 rad"),
        (1.3962634015954636, "rad", None, "80 deg"),
        (293.15, "K", "20 degC", "20 degC"),
        (293.15, "K", "lognormal(20 °C, 0.1)", "20 °C"),
        (293.15, "K", "68 degF", "68 degF"),
        (293.15, "K", "293.15 K", "293.15 K"),
        (293.15, "K", None, "293.15 K"),
        (2e-5, "m", "20 um", "20 µm"),
    ],
)
def test_angles_and_temperatures_in_the_unit_they_were_typed_in(
    value: float, unit: str, written: str | None, shown: str
) -> None:
    assert format_quantity(value, unit, written=written) == shown
