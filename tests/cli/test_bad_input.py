"""What cannot be used ends with exit status 2 and one clear message on standard error, never with a traceback."""

from __future__ import annotations

import errno

import pytest
from command_line import Outcome, run, run_process

from skinbayes.files.locate import shipped_folder


def refused(outcome: Outcome, *fragments: str) -> None:
    assert outcome.status == 2, outcome
    assert outcome.output == ""
    assert "Traceback" not in outcome.errors
    for fragment in fragments:
        assert fragment in outcome.errors, f"{fragment!r} is not in {outcome.errors!r}"


def message(outcome: Outcome, *fragments: str) -> None:
    """As :func:`refused`; and the message is one line."""
    refused(outcome, *fragments)
    assert outcome.errors.startswith("skinbayes: ") and outcome.errors.count("\n") == 1


WITH_MODEL = (["show"], ["check"], ["predict"], ["prior"], ["fit"])


@pytest.mark.parametrize("json", [[], ["--json"]], ids=["text", "json"])
@pytest.mark.parametrize("command", WITH_MODEL, ids=lambda words: words[0])
def test_unknown_model(command, json, capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    message(run(capsys, *command, "forearm-glas", *json), "'forearm-glas'", "Did you mean 'forearm-glass'")
    message(run(capsys, *command, "mine.toml", *json), "mine.toml", "cannot be read")
    for name in ("", "\x1b[31m", "a\nb", "x" * 3000):
        message(run(capsys, *command, name, *json))
    assert list(tmp_path.iterdir()) == []


BAD_TOML: dict[str, tuple[bytes, tuple[str, ...]]] = {
    "empty": (b"", ("mine.toml", "empty")),
    "binary": (bytes(range(256)), ("mine.toml", "binary")),
    "latin-1": ("title = 'Jörg'".encode("latin-1"), ("mine.toml, line 1", "UTF-8")),
    "syntax": (b"title = \n", ("mine.toml, line 1", "not valid TOML")),
    "million lines": (b"#\n" * 1_000_000, ("mine.toml", "2,000,000 bytes")),
    "unknown key": (b"title='x'\nforward='friction'\nfoo=1\n[parameters]\n", ("line 3", "foo", "unknown key")),
    "no unit": (
        b"title='x'\nforward='friction'\n[parameters]\nyield_stress = 3\n", ("line 4", "yield_stress", "no unit", "Pa"),
    ),
    "no mass": (
        b"title='x'\nforward='friction'\n[parameters]\nyield_stress = { uniform = ['2 Pa', '1 Pa'] }\n",
        ("line 4", "yield_stress", "no mass"),
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", BAD_TOML)
@pytest.mark.parametrize("command", WITH_MODEL, ids=lambda words: words[0])
def test_bad_model_file(command, case, capsys, tmp_path):
    content, fragments = BAD_TOML[case]
    path = tmp_path / "mine.toml"
    path.write_bytes(content)
    message(run(capsys, *command, path), *fragments)


HEADER = "state,normal_force [N],sphere_radius [m],friction_coefficient [1]\n"
BAD_CSV: dict[str, tuple[bytes, tuple[str, ...]]] = {
    "empty": (b"", ("mine.csv", "empty")),
    "binary": (bytes(range(256)) * 3, ("mine.csv", "line 3", "0x80")),
    "latin-1": (HEADER.encode() + b"dr\xff,0.5,0.008,0.3\n", ("mine.csv, line 2", "0xff", "UTF-8")),
    "missing unit": (HEADER.replace(" [N]", "").encode() + b"dry,0.5,0.008,0.3\n", ("line 1", "normal_force", "N")),
    "wrong unit": (HEADER.replace("[N]", "[Pa]").encode() + b"dry,0.5,0.008,0.3\n", ("line 1", "normal_force", "'Pa'")),
    "unknown column": (HEADER.replace("sphere", "spere").encode() + b"dry,1,1,1\n", ("needs", "did you mean 'sphere_radius'?")),
    "nan": (HEADER.encode() + b"dry,nan,0.008,0.3\n", ("line 2", "normal_force", "nan")),
    "negative force": (HEADER.encode() + b"dry,-0.5,0.008,0.3\n", ("line 2", "normal_force", "-0.5 N", "> 0 N")),
    "zero friction": (HEADER.encode() + b"dry,0.5,0.008,0\n", ("mine.csv", "friction_coefficient", "Row 1", "> 0")),
    "no rows": (HEADER.encode(), ("mine.csv", "no rows")),
    "decimal comma": (HEADER.replace(",", ";").encode() + b"dry;0,5;0.008;0,3\n", ("'0,5' (line 2)", "one decimal separator")),
    "ragged": (HEADER.encode() + b"dry,0.5\n", ("line 2", "2 cells")),
    "unknown level": (HEADER.encode() + b"damp,0.5,0.008,0.3\n", ("damp", "has values for")),
    "no state": (b"normal_force [N],sphere_radius [m],friction_coefficient [1]\n1,1,1\n", ("no column 'state'",)),
    "no friction": (b"state,normal_force [N],sphere_radius [m]\ndry,1,1\n", ("mine.csv", "no column 'friction_coefficient")),
    "no load": (b"state,friction_coefficient [1]\ndry,1\n", ("needs nominal_pressure", "normal_force and sphere_radius")),
    "parameter as column": (
        HEADER.replace("\n", ",young_modulus_bulk [kPa]\n").encode() + b"dry,0.5,0.008,0.3,20\n",
        ("'young_modulus_bulk' is given twice",),
    ),
    "million rows": (HEADER.encode() + b"dry,0.5,0.008,0.3\n" * 1_000_000, ("mine.csv", "more than")),
}  # fmt: skip


@pytest.mark.parametrize("case", BAD_CSV)
@pytest.mark.parametrize("command", ["fit", "check", "prior"])
def test_bad_data(command, case, capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    content, fragments = BAD_CSV[case]
    path = tmp_path / "mine.csv"
    path.write_bytes(content)
    message(run(capsys, command, "forearm-glass", "--data", path), *fragments)
    assert [item.name for item in tmp_path.iterdir()] == ["mine.csv"]  # nothing was begun


@pytest.mark.parametrize("command", ["fit", "check", "prior"])
def test_data_that_are_none(command, capsys, tmp_path):
    message(run(capsys, command, "forearm-glass", "--data", tmp_path / "no.csv"), "no.csv", "existing file")
    message(run(capsys, command, "forearm-glass", "--data", tmp_path), "data.csv", "cannot be read")
    message(run(capsys, command, "forearm-glass", "--data", "stratum-corneum-modulus"), "reference table")
    message(run(capsys, command, "forearm-glass", "--data", ""), "data set ''")
    source = shipped_folder("models") / "forearm-glass.toml"
    message(run(capsys, command, "forearm-glass", "--data", source), "forearm-glass.toml, line ")


def test_models_without_data(capsys):
    message(run(capsys, "fit", "contact-area"), "contact-area", "[data]")
    message(run(capsys, "prior", "contact-area"), "contact-area", "no data")
    message(run(capsys, "fit", "contact-area", "--data", "adams2007-forearm-glass"), "no [data] block")


@pytest.mark.parametrize(
    ("pairs", "fragments"),
    [
        (["yield_stress"], ("--set yield_stress", "NAME=VALUE")),
        (["=3"], ("NAME=VALUE",)),
        (["yield_stress="], ("NAME=VALUE",)),
        (["yield_stress=50"], ("yield_stress", "no unit", "Pa")),
        (["yield_stress=50 um"], ("yield_stress", "'50 um'", "wrong dimension", "Pa")),
        (["yield_stress=50 MPaa"], ("yield_stress", "unknown unit")),
        (["yield_stress=-50 MPa"], ("yield_stress", "> 0 Pa")),
        (["yield_stress=nan"], ("yield_stress",)),
        (["yield_stress=__import__('os')"], ("yield_stress", "not a number")),
        (["yield_stress=1 MPa", "yield_stress=2 MPa"], ("yield_stress", "twice")),
        (["yield_stres=1 MPa"], ("yield_stres", "'yield_stress'")),
        (["poisson_ratio_layer=0.6"], ("poisson_ratio_layer", "between -1")),
        (["hurst_exponent=1"], ("hurst_exponent", "between 0")),
        (["area_correction=1.2"], ("area_correction", "between 0")),
        (["area_correction=0"], ("area_correction", "between 0")),
        (["magnification=0.5"], ("magnification", ">= 1")),
        (["surface=paper_refrence"], ("paper_refrence", "paper_reference")),
        (["surface=no.csv"], ("no.csv", "cannot be read")),
        (["surface=."], (".",)),
        (["surface="], ("NAME=VALUE",)),
        (["normal_force=1 N", "nominal_pressure=1 kPa"], ("exclude each other",)),
        (["wavevector=1e5 1/m", "magnification=10"], ("exclude each other",)),
        (["young_modulus_layer[wet]=1 MPa"], ("young_modulus_layer", "wet")),
        (["frictional_shear_stress=1 MPa"], ("frictional_shear_stress", "no input")),
        (["noise_scale=0.1"], ("noise_scale", "no input")),
        (["wavevector_rolloff=1e2 1/m"], ("wavevector_rolloff", "must lie between")),
        (["wavevector_max=1e2 1/m"], ("wavevector_max", "must be larger")),
        (["\x1b[31m=3"], ()),
    ],
)
def test_bad_settings(pairs, fragments, capsys, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    words = [word for pair in pairs for word in ("--set", pair)]
    outcome = run(capsys, "predict", "contact-area", *words, "--json")
    message(outcome, *fragments)
    assert "\x1b" not in outcome.errors


@pytest.mark.parametrize(
    ("content", "fragments"),
    [
        ("", ("rows.csv", "empty")),
        ("wavevector\n1\n", ("rows.csv, line 1", "no unit")),
        ("wavevector [1/m]\n-1\n", ("rows.csv, line 2", "wavevector", "> 0 1/m")),
        ("person\nA\n", ("rows.csv", "no quantity")),
        ("wavevector [1/m],magnification [1]\n1e5,100\n", ("exclude each other",)),
        ("normal_force [N],nominal_pressure [Pa]\n1,1\n", ("exclude each other",)),
        ("friction_coefficient [1]\n0.3\n", ("rows.csv", "none of its columns is an input")),
    ],
)
def test_bad_conditions(content, fragments, capsys, tmp_path):
    path = tmp_path / "rows.csv"
    path.write_text(content)
    message(run(capsys, "predict", "contact-area", "--conditions", path), *fragments)


@pytest.mark.parametrize(
    ("words", "fragments"),
    [
        (["no-such-command"], ("no-such-command",)),
        (["fit"], ("MODEL",)),
        (["fit", "forearm-glass", "--sed", "3"], ("--sed",)),
        (["fit", "forearm-glass", "--seed", "x"], ("--seed", "'x'")),
        (["fit", "forearm-glass", "--seed", "-1"], ("--seed", "-1")),
        (["fit", "forearm-glass", "--seed", "1.5"], ("--seed", "1.5")),
        (["fit", "forearm-glass", "--ess", "0"], ("--ess",)),
        (["fit", "forearm-glass", "--ess", "nan"], ("--ess",)),
        (["fit", "forearm-glass", "--cores", "0"], ("--cores",)),
        (["fit", "forearm-glass", "--max-steps", "3"], ("--max-steps",)),
        (["fit", "forearm-glass", "finger-water"], ("finger-water",)),
        (["prior", "forearm-glass", "--draws", "1"], ("--draws",)),
        (["compare"], ("RUN",)),
        (["models", "x"], ("x",)),
        (["predict", "contact-area", "--conditions"], ("--conditions",)),
        (["--json"], ("--json",)),
    ],
)
def test_bad_options(words, fragments, capsys):
    refused(run(capsys, *words), *fragments)


def test_show_of_nothing(capsys, tmp_path):
    message(run(capsys, "show", "adams2007-forearm"), "adams2007-forearm-glass")
    message(run(capsys, "show", tmp_path / "no.csv"), "no.csv")
    message(run(capsys, "show", "nothing"), "skinbayes models")


@pytest.mark.parametrize("command", ["compare", "report"])
def test_runs_that_are_none(command, capsys, tmp_path):
    twice = 2 if command == "compare" else 1
    missing = "neither a run nor a model" if command == "compare" else "no result found"
    message(run(capsys, command, *[tmp_path / "no"] * twice), missing)
    message(run(capsys, command, *[tmp_path] * twice), "no result found")
    (tmp_path / "steps").mkdir()
    message(run(capsys, command, *[tmp_path] * twice), "not finished", "--resume")
    for content in (b"", b"not netcdf", bytes(range(256)) * 100):
        (tmp_path / "result.nc").write_bytes(content)
        message(run(capsys, command, *[tmp_path] * twice), "result.nc", "not a result written by skinbayes")


def test_a_foreign_netcdf_file(capsys, tmp_path):
    import xarray

    xarray.Dataset({"x": ("y", [1.0, 2.0])}).to_netcdf(
        tmp_path / "result.nc", group="posterior", engine="h5netcdf"
    )
    message(run(capsys, "report", tmp_path), "not a result written by skinbayes")
    xarray.Dataset({"x": ("y", [1.0, 2.0])}).to_netcdf(tmp_path / "flat.nc", engine="h5netcdf")
    message(run(capsys, "report", tmp_path / "flat.nc"), "not a result written by skinbayes")


def test_places_that_cannot_be_written(capsys, tmp_path):
    (tmp_path / "file").write_text("x")
    message(run(capsys, "fit", "forearm-glass", "-o", tmp_path / "file"), "file", "cannot be used for a run")
    message(
        run(capsys, "fit", "forearm-glass", "-o", tmp_path / "file" / "below"), "cannot be used for a run"
    )
    message(run(capsys, "fit", "forearm-glass", "-o", tmp_path / ("x" * 300)), "cannot be used for a run")
    message(run(capsys, "fit", "forearm-glass", "-o", "/proc/nowhere"), "cannot be used for a run")
    message(run(capsys, "fit", "forearm-glass", "-o", "a\0b"), "cannot be used for a run")
    assert (tmp_path / "file").read_text() == "x"


def test_a_file_that_cannot_be_written_has_its_own_name(capsys, tmp_path, monkeypatch):
    def full(*_):
        raise OSError(errno.ENOSPC, "No space left on device", str(tmp_path / ".0f.partial"))

    monkeypatch.setattr("skinbayes.cli.new_file.write_atomically", full)
    outcome = run(capsys, "new", "forearm-glass", "-o", tmp_path / "mine.toml")
    assert outcome.status == 4
    assert "mine.toml: No space left" in outcome.errors and "partial" not in outcome.errors


def test_as_a_process(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_bytes(b"\xff\xfe\x00")
    message(run_process("fit", path, cwd=tmp_path), "mine.toml", "binary")
    message(run_process("predict", "contact-area", "--set", "yield_stress=50", cwd=tmp_path), "no unit")
    refused(run_process("fit", "forearm-glass", "--ess", "many", cwd=tmp_path), "--ess")
    assert [item.name for item in tmp_path.iterdir()] == ["mine.toml"]
