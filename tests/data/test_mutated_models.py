"""Model files with strange values: used, or refused with one message; nothing else."""

from __future__ import annotations

import contextlib
import io
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest
from mutated_models import SHIPPED, mutated, to_toml

from skinbayes.cli.main import cli
from skinbayes.errors import InputError
from skinbayes.forward import stribeck_remembering_table, stribeck_table
from skinbayes.lubrication import FilmTable, FilmTablePlan, build_film_table
from skinbayes.lubrication.viscoelastic_correction import MemoryCorrection
from skinbayes.lubrication.viscoelastic_table import MemoryPlan, build_memory_correction
from skinbayes.roughness import named_surface

COMMANDS = (["show"], ["template"], ["predict"], ["prior", "--draws", "100"], ["check"])


def refused(*command: str) -> str | None:
    """The message of a command that is refused, None if it worked; everything else is raised."""
    try:
        with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
            cli.main(args=list(command), prog_name="skinbayes", standalone_mode=False)
    except InputError as error:
        return str(error)
    return None


@pytest.fixture
def one_film_table(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """One small table of films, and a correction of it, instead of those of each prior, which would take minutes each."""
    ball = {
        "young_modulus_layer": 7e6, "young_modulus_bulk": 2e4, "rms_height": 22.4e-6, "sphere_radius": 1e-2, "normal_force": 1.0,
        "layer_thickness": 173e-6,
    }  # fmt: skip
    ranges = {name: (value, value) for name, value in ball.items()}
    films = FilmTablePlan(ranges, spectrum=named_surface("paper_reference"), speeds=8, nodes=32, checked=0)
    table: FilmTable = build_film_table(films)

    def correction(plan: MemoryPlan, *a: object, **k: object) -> MemoryCorrection:
        return build_memory_correction(replace(plan, films=films, counts=(2, 1), checked=0), table)

    monkeypatch.setattr(stribeck_table, "build_film_table", lambda *a, **k: table)
    monkeypatch.setattr(stribeck_remembering_table, "build_memory_correction", correction)
    monkeypatch.setenv("SKINBAYES_CACHE", "")
    yield


@pytest.mark.slow
@pytest.mark.parametrize("name", sorted(SHIPPED))
def test_mutated_models_are_used_or_refused(name: str, tmp_path: Path, one_film_table: None) -> None:
    path = tmp_path / "mine.toml"
    for seed in range(25):
        path.write_bytes(mutated(name, seed).encode("utf-8", "surrogatepass"))
        for command in COMMANDS:
            message = refused(command[0], str(path), *command[1:])
            assert message is None or 0 < len(message) < 3000
            if message is not None and command[0] == "show":
                break


@pytest.mark.slow
@pytest.mark.parametrize("name", ["forearm-glass", "forearm-glass-separate", "finger-null", "finger-water"])
def test_mutated_models_are_fitted_or_refused(name: str, tmp_path: Path) -> None:
    path, fitted = tmp_path / "mine.toml", 0
    for seed in range(2000, 2020):
        path.write_bytes(mutated(name, seed).encode("utf-8", "surrogatepass"))
        message = refused("fit", str(path), "--max-steps", "100", "-o", str(tmp_path / str(seed)))
        assert message is None or 0 < len(message) < 3000
        fitted += message is None
    assert fitted  # not all are refused


@pytest.mark.parametrize("name", ["forearm-glass", "contact-area", "humid-air", "finger-null"])
def test_mutated_models_are_read_or_refused(name: str, tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    for seed in range(1000, 1030):
        path.write_bytes(mutated(name, seed).encode("utf-8", "surrogatepass"))
        for command in ("show", "template", "predict"):
            message = refused(command, str(path))
            assert message is None or 0 < len(message) < 3000


TINY = "noise_scale = { half_normal = 0.5"
CASES: dict[str, tuple[str, str, str, str]] = {
    "by a list": ("forearm-glass", 'by = "state"', "by = []", "parameters.young_modulus_layer.by: found []"),
    "by a table": ("forearm-glass", 'by = "state"', "by = { a = 1 }", "expected a label column"),
    "by a number": ("forearm-glass", 'by = "state"', "by = 3", "found 3"),
    "groups without data": ("contact-area", "[conditions]", "[groups.person]\nscale = 1\n[conditions]", "need data"),
    "label of no kind": ("drying-timing", 'counterface = [', 'counerface = [', "Did you mean 'counterface'"),
    "noise without size": ("finger-null", TINY, "noise_scale = { half_normal = 1e-308", "noise_scale between 1e-30"),
    "noise next to nothing": ("finger-null", TINY, "noise_scale = { half_normal = 1e-12", "noise is so small beside"),
    "wide prior": ("forearm-glass", '["0.5 MPa", "500 MPa"]', '["1e-300 Pa", "1e300 Pa"]', "98 % of this prior lies between"),
    "tiny value": ("contact-area", '"8 mm"', '"1e-200 m"', "a sphere_radius between 1e-30"),
}  # fmt: skip


@pytest.mark.parametrize("case", CASES)
def test_one_clear_message(case: str, tmp_path: Path) -> None:
    name, old, new, said = CASES[case]
    path = tmp_path / "mine.toml"
    assert old in SHIPPED[name]
    path.write_text(SHIPPED[name].replace(old, new, 1), encoding="utf-8")
    commands = (
        [["check"]] if case == "noise next to nothing" else [["template"], ["check"], ["predict"], ["show"]]
    )
    for command in commands:
        message = refused(command[0], str(path), *command[1:])
        assert message is not None and str(path) in message and said in message, command


def test_the_writer_of_mutations_writes_what_was_read() -> None:
    import tomllib

    for text in SHIPPED.values():
        assert tomllib.loads(to_toml(tomllib.loads(text))) == tomllib.loads(text)
