"""Files are opened only if they are files, and their size is known before they are read."""

from __future__ import annotations

import os
import resource
import socket
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from skinbayes.errors import InputError
from skinbayes.files.dataset import load_dataset
from skinbayes.files.digitised import read_digitised
from skinbayes.files.locate import shipped_folder
from skinbayes.files.spectrum import read_spectrum
from skinbayes.files.toml_text import read_toml
from skinbayes.problem import load_problem

READERS: dict[str, Callable[[Path], object]] = {
    "model": load_problem,
    "data": load_dataset,
    "data of a model": lambda path: load_problem("forearm-glass", data=path),
    "conditions": lambda path: load_problem("contact-area", conditions=path),
    "rheology": lambda path: load_problem("finger-stribeck", rheology=path),
    "spectrum": read_spectrum,
    "surface": lambda path: load_problem("contact-area", settings={"surface": str(path)}),
    "digitised": read_digitised,
    "provenance": lambda path: read_toml(path),
}
ENDING = {"model": ".toml", "provenance": ".toml"}


def _pipe(path: Path) -> None:
    os.mkfifo(path)


def _socket(path: Path) -> None:
    with socket.socket(socket.AF_UNIX) as made:
        made.bind(str(path))


def _sparse(path: Path) -> None:
    with path.open("wb") as stream:
        stream.truncate(3_000_000_000)


KINDS: dict[str, tuple[Callable[[Path], None], str]] = {
    "pipe": (_pipe, "pipe"),
    "socket": (_socket, "socket"),
    "device": (lambda path: path.symlink_to("/dev/zero"), "device"),
    "terminal": (lambda path: path.symlink_to("/dev/tty"), "device|cannot be read"),
    "sparse": (_sparse, "3,000,000,000 bytes"),
}


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes with a name")
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("reader", READERS)
def test_what_is_no_file_or_too_large_is_refused(
    reader: str, kind: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)  # names of sockets are short
    path = Path(f"mine{ENDING.get(reader, '.csv')}")
    make, said = KINDS[kind]
    make(path)
    before, began = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss, time.process_time()
    with pytest.raises(InputError, match=said) as caught:
        READERS[reader](path)
    assert path.name in str(caught.value) and "expected" in str(caught.value)
    assert time.process_time() - began < 5
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 400_000  # kB


HEAD = 'title = "a"\nforward = "friction"\n'
GOOD = (shipped_folder("models") / "forearm-glass.toml").read_text(encoding="utf-8")
MODELS = {
    "a key of 200,000 parts": "a." * 200_000 + "a = 1\n",
    "a quoted key of 150,000 parts": '"a"' + ' . "a"' * 150_000 + " = 1\n",
    "a heading of 200,000 parts": "[" + "a." * 200_000 + "a]\n",
    "60,000 dotted keys": HEAD + "".join(f"a.b{i} = 1\n" for i in range(60_000)),
    "30,000 lists": "x = " + "[" * 30_000 + "]" * 30_000,
    "30,000 tables": "x = " + "{ a = " * 30_000 + "1" + "}" * 30_000,
    "an integer of 900,000 digits": HEAD + "x = " + "9" * 900_000,
    "a hexadecimal integer of 900,000 digits": HEAD + "x = 0x" + "f" * 900_000,
    "an exponent of 900,000 digits": HEAD + "[parameters]\nrms_height = { fixed = 1e" + "9" * 900_000 + " }",
    "a quantity of 900,000 digits": HEAD + "[parameters]\nrms_height = { fixed = '" + "9" * 900_000 + " m' }",
    "a unit of 900,000 letters": HEAD + "[parameters]\nrms_height = { fixed = '1 " + "m*" * 450_000 + "' }",
    "a name of 900,000 letters": HEAD + "[parameters]\n" + "x" * 900_000 + " = 1",
    "a forward model of 900,000 letters": 'title = "a"\nforward = "' + "x" * 900_000 + '"\n[parameters]',
    "80,000 parameters": HEAD + "[parameters]\n" + "".join(f"k{i} = 1\n" for i in range(80_000)),
    "80,000 observables": GOOD.replace(
        'observable = "friction_coefficient"', "observables = [" + ",".join(f"'a{i}'" for i in range(80_000)) + "]"
    ),
    "a million quotation marks": '"' * 990_000,
    "a million backslashes": 'x = """' + "\\\\" * 490_000,
}  # fmt: skip


@pytest.mark.parametrize("kind", MODELS)
def test_a_megabyte_is_refused_at_once(kind: str, tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    path.write_text(MODELS[kind])
    assert path.stat().st_size < 1_000_000
    began = time.process_time()
    with pytest.raises(InputError) as caught:
        load_problem(path)
    assert time.process_time() - began < 10
    assert len(str(caught.value)) < 2000 + len(str(path))


def test_40_000_levels_are_read_at_once(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    levels = "".join(f"l{i} = '1 MPa'\n" for i in range(40_000))
    path.write_text(GOOD.replace('by = "state"', 'by = "state"\n' + levels, 1))
    began = time.process_time()
    load_problem(path)
    assert time.process_time() - began < 10


AXES = '"axesColl": [{"name": "XY", "type": "XYAxes", "calibrationPoints": []}]'
EMPTY = ",".join(["{}"] * 300_000)
PROJECTS = {
    "empty data sets": '{"version": [4, 2], ' + AXES + ', "datasetColl": [' + EMPTY + "]}",
    "axes": '{"version": [4, 2], "axesColl": [' + EMPTY + '], "datasetColl": []}',
    "data sets of version 3": '{"wpd": {"version": [3, 1], "axesType": "XYAxes", "axesParameters": {}, "calibration": [], '
    '"dataSeries": [' + EMPTY + "]}}",
    "points": '{"version": [4, 2], ' + AXES + ', "datasetColl": [{"name": "a", "axesName": "XY", "data": [' + EMPTY + "]}]}",
    "levels": "[" * 400_000,
    "digits": '{"version": [' + "9" * 900_000 + "]}",
}  # fmt: skip


@pytest.mark.parametrize("kind", PROJECTS)
def test_a_project_of_a_megabyte_is_refused_at_once(kind: str, tmp_path: Path) -> None:
    path = tmp_path / "wpd.json"
    path.write_text(PROJECTS[kind])
    assert path.stat().st_size < 1_000_000
    began = time.process_time()
    with pytest.raises(InputError) as caught:
        read_digitised(path)
    assert time.process_time() - began < 10
    assert len(str(caught.value)) < 2000 + len(str(path))


TABLES = {
    "49,000 columns": "a," * 49_000 + "a\n" + "1," * 49_000 + "1\n",
    "100,000 columns": ",".join(f"c{i}" for i in range(100_000)) + "\n1\n",
    "a row of a million cells": "normal_force [N],friction_coefficient [1]\n" + "1," * 490_000 + "1\n",
    "a name of 90,000 letters": "x" * 90_000 + "\n1\n",
    "a number of 90,000 digits": "normal_force [N],friction_coefficient [1]\n1e" + "9" * 90_000 + ",1\n",
    "450,000 comments": "#\n" * 450_000,
    "900,000 empty lines": "\n" * 900_000,
}


@pytest.mark.parametrize("reader", [load_dataset, read_spectrum, read_digitised])
@pytest.mark.parametrize("kind", TABLES)
def test_a_table_of_a_megabyte_is_refused_at_once(
    kind: str, reader: Callable[[Path], object], tmp_path: Path
) -> None:
    path = tmp_path / "data.csv"
    path.write_text(TABLES[kind])
    assert path.stat().st_size < 1_000_000
    began = time.process_time()
    with pytest.raises(InputError) as caught:
        reader(path)
    assert time.process_time() - began < 10
    assert len(str(caught.value)) < 2000 + len(str(path))
