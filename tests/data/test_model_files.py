"""Model files: what is read, and one clear message for each way to get one wrong."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from skinbayes.errors import InputError
from skinbayes.files.locate import shipped_names
from skinbayes.files.modelfile import find_model, load_model
from skinbayes.problem import load_problem

GOOD = """\
format = 1
title = "Fingers"
forward = "friction"

[data]
dataset = "fehlberg2025-finger-stribeck"
observable = "friction_coefficient"
rows = { liquid = ["water"] }

[surface]
name = "paper_reference"

[parameters]
frictional_shear_stress = { lognormal = ["10 MPa", 1.0], source = "a guess" }
young_modulus_layer = { fixed = "7 MPa" }
young_modulus_bulk = "20 kPa"
layer_thickness = { uniform = ["100 um", "250 um"] }
yield_stress = "inf"
area_correction = "none"

[noise]
family = "lognormal"
noise_scale = { half_normal = 0.5 }
"""


def test_the_good_file_is_read(tmp_path: Path) -> None:
    path = tmp_path / "good.toml"
    path.write_text(GOOD)
    spec = load_model(path)
    assert (spec.name, spec.title, spec.forward, spec.observables) == (
        "good", "Fingers", "friction", ("friction_coefficient",),
    )  # fmt: skip
    values = {p.label: p.value for p in spec.parameters}
    assert values["young_modulus_layer"] == 7e6 and values["young_modulus_bulk"] == 2e4
    assert values["yield_stress"] == np.inf and values["area_correction"] == 1.0
    priors = {p.label: p.prior for p in spec.parameters if p.prior}
    assert priors["frictional_shear_stress"].median == pytest.approx(1e7, rel=1e-12)
    assert priors["layer_thickness"].support == pytest.approx((1e-4, 2.5e-4), rel=1e-12)
    problem = load_problem(path)
    assert problem.names == ("frictional_shear_stress", "layer_thickness", "noise_scale")
    assert np.isfinite(problem.log_posterior(problem.prior_medians()))


@pytest.mark.parametrize("edit", ["crlf", "bom", "no final newline", "trailing blank"])
def test_how_editors_save(edit: str, tmp_path: Path) -> None:
    content = {
        "crlf": GOOD.replace("\n", "\r\n").encode(),
        "bom": b"\xef\xbb\xbf" + GOOD.encode(),
        "no final newline": GOOD.rstrip().encode(),
        "trailing blank": GOOD.replace("\n", "  \n").encode(),
    }[edit]
    path = tmp_path / "good.toml"
    path.write_bytes(content)
    (tmp_path / "plain.toml").write_text(GOOD)
    assert load_problem(path).fingerprint == load_problem(tmp_path / "plain.toml").fingerprint


def test_every_shipped_model_has_sources_for_what_it_assumes() -> None:
    for name in shipped_names("models"):
        spec = load_model(name)
        assert spec.title and spec.description
        for parameter in (*spec.parameters, *spec.noise_parameters):
            assert len(parameter.source) > 10, f"{name}: {parameter.label} has no source"


def test_shipped_name_or_path() -> None:
    assert find_model("forearm-glass").name == "forearm-glass.toml"
    with pytest.raises(InputError, match=r"no model 'forearm-glas'. Did you mean 'forearm-glass'"):
        find_model("forearm-glas")
    for name in ("", " ", "\0", "x" * 5000, "a\nb"):
        with pytest.raises(InputError):
            load_model(name)


def edited(old: str, new: str) -> str:
    assert GOOD.count(old) == 1, f"{old!r} is there {GOOD.count(old)} times"
    return GOOD.replace(old, new)


def line_of(fragment: str, text: str = GOOD) -> str:
    """``line N`` of the first line with this text."""
    return f"line {text[: text.index(fragment)].count(chr(10)) + 1}"


SHEAR = 'frictional_shear_stress = { lognormal = ["10 MPa", 1.0], source = "a guess" }'
SHEAR_LINE = line_of(SHEAR)
NOISE_LINE = line_of("noise_scale")

# name of the case: content, and what the message has to contain
CORPUS: dict[str, tuple[str | bytes, tuple[str, ...]]] = {
    # the file as a whole
    "empty": ("", ("empty", "TOML file")),
    "white space": (" \n\n\t\n", ("empty",)),
    "only a comment": ("# nothing\n", ("title", "is missing")),
    "binary": (bytes(range(256)) * 4, ("binary data at byte 0",)),
    "image": (b"\x89PNG\r\n\x1a\n\x01\x02", ("line 1", "0x89", "not UTF-8")),
    "latin-1": (GOOD.encode() + '# Jörg\n'.encode("latin-1"), ("0xf6", "not UTF-8", line_of("noise_scale")[:4])),
    "utf-16": (GOOD.encode("utf-16"), ("binary data",)),
    "a million lines": ("# x\n" * 1_000_000, ("4,000,000 bytes", "at most 1,000,000")),
    "a csv": ("person,normal_force [N]\nA,1\n", ("line 1", "not valid TOML")),
    "json": ('{"title": "x"}', ("line 1", "not valid TOML")),
    "deep nesting": ("x = " + "[" * 5000 + "]" * 5000 + "\n", ("nested too deeply",)),
    "deep tables": ("x = " + "{ a = " * 3000 + "1" + " }" * 3000 + "\n", ("nested too deeply",)),
    "deep headers": ("[" + ".".join("a" * 3000) + "]\n", ("line 1", "nested too deeply")),
    # syntax
    "quote not closed": (edited('title = "Fingers"', 'title = "Fingers'), ("line 2", "not valid TOML")),
    "bracket not closed": (edited('["10 MPa", 1.0]', '["10 MPa", 1.0'), (SHEAR_LINE, "not valid TOML")),
    "no quotes about a unit": (edited('"20 kPa"', "20 kPa"), (line_of("young_modulus_bulk"), "not valid TOML")),
    "key twice": (edited("[noise]", 'young_modulus_bulk = "1 kPa"\n[noise]'), ("line 21", "second time")),
    "table twice": (GOOD + "[surface]\n", ("not valid TOML", "second time")),
    "inline key twice": (edited("half_normal = 0.5", "half_normal = 0.5, half_normal = 0.5"), (NOISE_LINE, "Duplicate")),
    "nul escape": (edited('"Fingers"', '"Fin\\u0000gers"'), ("title", "printable")),
    "bare nan": (edited('"20 kPa"', "nan"), ("young_modulus_bulk", "not a number", "Pa")),
    # keys
    "unknown key at the top": (edited("format = 1", "format = 1\nforwards = 3"), ("line 2", "forwards", "'forward'")),
    "unknown table": (GOOD + "[nose]\nx = 1\n", ("nose", "unknown key", "'noise'")),
    "unknown key in data": (edited("rows =", "row ="), (line_of("rows ="), "data.row", "unknown key")),
    "unknown parameter": (
        edited("young_modulus_bulk", "young_modulus_bulkk"),
        (line_of("young_modulus_bulk"), "unknown parameter 'young_modulus_bulkk'", "'young_modulus_bulk'"),
    ),
    "parameter of another model": (
        edited("[noise]", 'surface_tension = "0.07 N/m"\n[noise]'),
        ("surface_tension", "'friction' has no such input"),
    ),
    "noise parameter among the parameters": (edited("[noise]", "noise_scale = 0.3\n[noise]"), ("belongs into [noise]",)),
    "unknown noise parameter": (edited("noise_scale =", "noise_scal ="), (NOISE_LINE, "noise_scal", "noise_scale")),
    "unknown key in a prior": (edited(', source = "a guess"', ', sauce = "a guess"'), (SHEAR_LINE, "sauce", "source")),
    "empty key": (edited("young_modulus_bulk", '""'), ("unknown parameter",)),
    "title missing": (edited('title = "Fingers"\n', ""), ("title", "is missing")),
    "forward missing": (edited('forward = "friction"\n', ""), ("forward", "is missing")),
    "parameters missing": ("title = 'x'\nforward = 'friction'\n", ("parameters", "is missing")),
    "observable missing": (edited('observable = "friction_coefficient"\n', ""), ("observable", "or 'observables'")),
    "noise missing": (GOOD[: GOOD.index("[noise]")], ("[noise] is missing",)),
    "data missing": (
        GOOD[: GOOD.index("[data]")] + GOOD[GOOD.index("[surface]") :], ("[data] is missing",),
    ),
    "required input missing": (
        edited("young_modulus_bulk = \"20 kPa\"\n", ""), ("'friction' needs", "Not given: young_modulus_bulk"),
    ),
    "surface missing": (edited('[surface]\nname = "paper_reference"\n', ""), ("roughness is incomplete", "rms_height")),
    "future format": (edited("format = 1", "format = 2"), ("line 1", "format", "found 2")),
    # types
    "title a number": (edited('"Fingers"', "3"), ("line 2", "title", "found 3")),
    "title an array": (edited('"Fingers"', '["a"]'), ("line 2", "title", "found ['a']")),
    "parameters a number": (
        GOOD[: GOOD.index("[parameters]")].replace("format", "parameters", 1) + GOOD[GOOD.index("[noise]") :],
        ("line 1", "parameters", "found 1"),
    ),
    "rows not a list": (edited('["water"]', '"water"'), (line_of("rows ="), "data.rows.liquid", "found 'water'")),
    "rows of numbers": (edited('["water"]', "[1]"), (line_of("rows ="), "data.rows.liquid", "found 1")),
    "rows empty": (edited('["water"]', "[]"), ("data.rows", "liquid")),
    "a parameter a list": (edited('"20 kPa"', '["20 kPa"]'), ("young_modulus_bulk", "expected a value with unit")),
    "a parameter a truth": (edited('"20 kPa"', "true"), ("young_modulus_bulk", "found True")),
    "a parameter a date": (edited('"20 kPa"', "2020-01-01"), ("young_modulus_bulk", "expected a value with unit")),
    "a source a number": (edited('"a guess"', "3"), (SHEAR_LINE, "source", "expected a sentence")),
    "an empty table": (edited('"20 kPa"', "{}"), ("young_modulus_bulk", "expected exactly one")),
    "only a source": (edited('"20 kPa"', '{ source = "x" }'), ("young_modulus_bulk", "expected exactly one")),
    "two priors": (
        edited('lognormal = ["10 MPa", 1.0]', 'lognormal = ["10 MPa", 1.0], uniform = ["1 MPa", "2 MPa"]'),
        (SHEAR_LINE, "lognormal, uniform", "exactly one"),
    ),
    # units and numbers
    "missing unit": (edited('"20 kPa"', "20000"), (line_of("young_modulus_bulk"), "no unit", "pressure in Pa")),
    "missing unit in a prior": (edited('"10 MPa", 1.0', "10e6, 1.0"), (SHEAR_LINE, "lognormal", "median", "no unit", "Pa")),
    "wrong unit": (edited('"20 kPa"', '"20 um"'), (line_of("young_modulus_bulk"), "wrong dimension", "Pa")),
    "wrong unit in a prior": (edited('"10 MPa", 1.0', '"10 N", 1.0'), (SHEAR_LINE, "median", "'10 N'", "Pa")),
    "unknown unit": (edited('"20 kPa"', '"20 kPascals_"'), (line_of("young_modulus_bulk"), "unknown unit")),
    "unit on a pure number": (edited("1.0]", '"1 Pa"]'), (SHEAR_LINE, "sd of ln", "wrong dimension")),
    "nan": (edited('"20 kPa"', '"nan kPa"'), (line_of("young_modulus_bulk"), "'nan kPa'", "Pa")),
    "nan in a prior": (edited('"10 MPa", 1.0', '"10 MPa", nan'), (SHEAR_LINE, "nan")),
    "infinite modulus": (edited('"20 kPa"', '"inf kPa"'), (line_of("young_modulus_bulk"), "> 0 Pa")),
    "infinite median": (edited('"10 MPa", 1.0', '"inf MPa", 1.0'), (SHEAR_LINE, "finite")),
    "too large": (edited('"20 kPa"', '"1e400 kPa"'), ("young_modulus_bulk", "1e400 kPa")),
    "negative": (edited('"20 kPa"', '"-20 kPa"'), (line_of("young_modulus_bulk"), "found -20 kPa", "> 0 Pa")),
    "zero": (edited('"20 kPa"', '"0 kPa"'), ("young_modulus_bulk", "> 0 Pa")),
    "decimal comma": (edited('"20 kPa"', '"20,5 kPa"'), ("young_modulus_bulk", "decimal comma")),
    "words": (edited('"20 kPa"', '"soft"'), ("young_modulus_bulk", "'soft'", "not a number")),
    "none where it means nothing": (edited('"20 kPa"', '"none"'), ("young_modulus_bulk", "'none'")),
    "a Poisson ratio of one": (edited("[noise]", "poisson_ratio_layer = 1.0\n[noise]"), ("between -1", "0.5")),
    "a long number": (edited('"20 kPa"', "1" + "0" * 400), ("young_modulus_bulk",)),
    "a huge number in a prior": (edited("1.0]", "1" + "0" * 400 + "]"), (SHEAR_LINE,)),
    # priors
    "unknown family": (edited("lognormal =", "lognorml ="), (SHEAR_LINE, "lognorml", "'lognormal'")),
    "too few arguments": (edited('["10 MPa", 1.0]', '["10 MPa"]'), (SHEAR_LINE, "1 arguments", "[median, sd of ln]")),
    "too many arguments": (edited('["10 MPa", 1.0]', '["10 MPa", 1.0, 2]'), (SHEAR_LINE, "3 arguments")),
    "no arguments": (edited('["10 MPa", 1.0]', "[]"), (SHEAR_LINE, "0 arguments")),
    "nested arguments": (edited('["10 MPa", 1.0]', '[["10 MPa"], 1.0]'), (SHEAR_LINE, "median")),
    "negative width": (edited('["10 MPa", 1.0]', '["10 MPa", -1.0]'), (SHEAR_LINE, "sd of ln", "> 0")),
    "zero width": (edited('["10 MPa", 1.0]', '["10 MPa", 0]'), (SHEAR_LINE, "sd of ln", "> 0")),
    "no mass: upside down": (
        edited('lognormal = ["10 MPa", 1.0]', 'uniform = ["50 MPa", "1 MPa"]'), (SHEAR_LINE, "no mass"),
    ),
    "no mass: a point": (
        edited('lognormal = ["10 MPa", 1.0]', 'uniform = ["5 MPa", "5 MPa"]'), (SHEAR_LINE, "no mass"),
    ),
    "no mass: below zero": (
        edited('lognormal = ["10 MPa", 1.0]', 'uniform = ["-50 MPa", "-1 MPa"]'),
        (SHEAR_LINE, "no mass", "must be > 0 Pa"),
    ),
    "no mass: far below zero": (
        edited('lognormal = ["10 MPa", 1.0]', 'normal = ["-500 MPa", "1 MPa"]'), (SHEAR_LINE, "no mass", "> 0 Pa"),
    ),
    "no mass: cut away": (
        edited('lognormal = ["10 MPa", 1.0]', 'truncated_normal = ["1 MPa", "1 Pa", "5 MPa", "6 MPa"]'),
        (SHEAR_LINE, "no mass"),
    ),
    "infinite bounds": (
        edited('lognormal = ["10 MPa", 1.0]', 'uniform = ["1 MPa", "inf"]'), (SHEAR_LINE, "finite"),
    ),
    "beta for a pressure": (edited('lognormal = ["10 MPa", 1.0]', "beta = [2, 3]"), (SHEAR_LINE, "beta", "dimensionless")),
    # forward model, data, surface
    "unknown forward model": (edited('"friction"\n', '"fricton"\n'), ("no forward model 'fricton'", "friction")),
    "unknown data set": (
        edited("fehlberg2025-finger-stribeck", "fehlberg2025-finger-stribek"),
        ("fehlberg2025-finger-stribek", "Did you mean 'fehlberg2025-finger-stribeck'"),
    ),
    "a reference table": (
        edited("fehlberg2025-finger-stribeck", "stratum-corneum-modulus"), ("reference table", "cannot be fitted"),
    ),
    "no such file": (
        edited('dataset = "fehlberg2025-finger-stribeck"', 'file = "no such.csv"'), ("no such.csv", "existing file"),
    ),
    "data twice": (
        edited('dataset = "fehlberg2025-finger-stribeck"', 'dataset = "x"\nfile = "y.csv"'), ("not both",),
    ),
    "no data": (edited('dataset = "fehlberg2025-finger-stribeck"\n', ""), ("--data", "template")),
    "unknown observable": (
        edited('"friction_coefficient"', '"friction_coeficient"'), ("friction_coeficient", "'friction_coefficient'"),
    ),
    "observable not predicted": (
        edited('"friction_coefficient"', '"sliding_speed"'), ("sliding_speed", "not predicted", "friction_coefficient"),
    ),
    "unknown column in rows": (edited("liquid =", "lquid ="), ("data.rows", "lquid", "liquid")),
    "unknown label in rows": (edited('["water"]', '["wine"]'), ("data.rows", "wine", "water")),
    "spread misspelt": (edited("rows =", 'spread = "yes"\nrows ='), ("data.spread", "found 'yes'", "'use'")),
    "unknown surface": (edited("paper_reference", "paper_refrence"), ("surface.name", "paper_refrence", "paper_reference")),
    "surface twice": (edited('"paper_reference"', '"x"\nfile = "y.csv"'), ("either 'name'",)),
    "surface file missing": (edited('name = "paper_reference"', 'file = "y.csv"'), ("y.csv", "cannot be read")),
    # noise
    "unknown noise": (edited('"lognormal"', '"lognorml"'), (line_of("family"), "lognorml", "'lognormal'")),
    "noise family missing": (edited('family = "lognormal"\n', ""), ("noise.family", "found None")),
    "noise family a list": (edited('"lognormal"', '["lognormal"]'), ("noise.family", "found ['lognormal']")),
    "noise scale missing": (edited("noise_scale = { half_normal = 0.5 }\n", ""), (line_of("[noise]"), "needs noise_scale")),
    "tails missing": (edited('"lognormal"', '"log_student_t"'), ("needs degrees_of_freedom",)),
    "tails too many": (GOOD + "degrees_of_freedom = 4\n", ("degrees_of_freedom", "has no degrees of freedom")),
    "negative scale": (edited("{ half_normal = 0.5 }", "-0.5"), (NOISE_LINE, "-0.5", ">= 0")),
    "zero scale": (edited("{ half_normal = 0.5 }", "0"), ("noise_scale is 0", "known spread")),
    "scale with a unit": (edited("{ half_normal = 0.5 }", '"0.1 N"'), (NOISE_LINE, "wrong dimension")),
    # levels
    "by an unknown column": (
        edited('"20 kPa"', '{ by = "hand", left = "20 kPa" }'), ("young_modulus_bulk", "no column 'hand'"),
    ),
    "by a number": (edited('"20 kPa"', '{ by = 3, left = "20 kPa" }'), ("young_modulus_bulk", "by")),
    "by without levels": (edited('"20 kPa"', '{ by = "liquid" }'), ("young_modulus_bulk", "no level")),
    "by with a missing level": (
        edited('"20 kPa"', '{ by = "liquid", wine = "20 kPa" }'), ("young_modulus_bulk", "wine", "water"),
    ),
    "by with an unusable level": (
        edited('"20 kPa"', '{ by = "liquid", water = "20 m" }'), ("young_modulus_bulk.water", "wrong dimension"),
    ),
    "noise by a missing level": (
        edited("{ half_normal = 0.5 }", '{ by = "liquid", wine = 0.3 }'), ("noise_scale", "wine", "water"),
    ),
    # derived quantities and conditions
    "derived without product": (GOOD + "[derived.x]\nmeaning = 'y'\n", ("derived.x.product", "is missing")),
    "derived of nothing": (GOOD + "[derived.x]\nproduct = {}\n", ("derived.x", "at least 1 item")),
    "derived of something unknown": (
        GOOD + "[derived.x]\nproduct = { yield_stres = 1 }\n", ("derived.x", "yield_stres", "'yield_stress'"),
    ),
    "derived power a word": (GOOD + "[derived.x]\nproduct = { yield_stress = 'two' }\n", ("derived.x", "'two'")),
    "derived power nan": (GOOD + "[derived.x]\nproduct = { yield_stress = nan }\n", ("derived.x", "found nan", "-100")),
    "derived rows unknown": (
        GOOD + "[derived.x]\nproduct = { yield_stress = 1 }\nrows = { liquid = ['wine'] }\n", ("derived.x.rows", "wine"),
    ),
    "derived with the name of a parameter": (
        GOOD + "[derived.yield_stress]\nproduct = { layer_thickness = 1 }\n", ("derived.yield_stress", "name"),
    ),
    "conditions unknown": (GOOD + "[conditions]\nwavevektor = { values = [1] }\n", ("wavevektor", "'wavevector'")),
    "conditions empty": (GOOD + "[conditions]\nwavevector = { values = [] }\n", ("conditions.wavevector", "is empty")),
    "conditions without unit": (
        GOOD + "[conditions]\nwavevector = { values = [1e5] }\n", ("conditions.wavevector", "no unit", "1/m"),
    ),
    "conditions of three ends": (
        GOOD + "[conditions]\nwavevector = { logspace = ['1 1/m','2 1/m','3 1/m'], points = 3 }\n", ("two values",),
    ),
    "conditions without points": (
        GOOD + "[conditions]\nwavevector = { logspace = ['1 1/m','2 1/m'] }\n", ("needs 'points'",),
    ),
    "conditions of one point": (
        GOOD + "[conditions]\nwavevector = { logspace = ['1 1/m','2 1/m'], points = 1 }\n", ("points", "found 1"),
    ),
    "conditions infinite": (
        GOOD + "[conditions]\nwavevector = { linspace = ['1 1/m','inf 1/m'], points = 3 }\n", ("conditions.wavevector",),
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", CORPUS)
def test_one_clear_message(case: str, tmp_path: Path) -> None:
    content, fragments = CORPUS[case]
    path = tmp_path / "mine.toml"
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    with pytest.raises(InputError) as caught:
        load_problem(path)
    message = str(caught.value)
    for fragment in fragments:
        assert fragment in message, f"{fragment!r} is not in {message!r}"
    assert "\n" not in message and len(message) < len(str(path)) + 1000
    assert str(tmp_path) in message or "data set" in message or "forward" in message


def test_missing_file_and_folder(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="cannot be read"):
        load_model(tmp_path / "no.toml")
    (tmp_path / "folder.toml").mkdir()
    with pytest.raises(InputError, match="folder"):
        load_model(tmp_path / "folder.toml")


def test_several_problems_are_counted(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    path.write_text(edited("format = 1", "format = 1\none = 1\ntwo = 2\nthree = 3"))
    with pytest.raises(InputError, match=r"one: unknown key.*and 2 more problems"):
        load_model(path)
