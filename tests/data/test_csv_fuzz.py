"""Random files are read or refused with an InputError; nothing else ever escapes."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from skinbayes.errors import InputError
from skinbayes.files import Dataset, load_dataset
from skinbayes.files.spectrum import read_spectrum
from skinbayes.vocabulary import LABELS, QUANTITIES

quickly = settings(
    max_examples=150, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)

names = st.sampled_from([*QUANTITIES, *LABELS, "friction_coefficient_standard_deviation", "nonsense", ""])
units = st.sampled_from(
    ["N", "1", "%", "Pa", "1/m", "m", "degC", "K", "mPa s", "rad", "quux", "", "m^9^9", "("]
)
headers = st.one_of(
    names, st.builds(lambda name, unit: f"{name} [{unit}]", names, units), st.text(max_size=12)
)
cells = st.one_of(
    st.floats(min_value=1e-3, max_value=0.9).map(repr),
    st.floats().map(repr),
    st.sampled_from(["", "nan", "-1", "inf", "0,5", '"', "water", "1e999", "#", "\x00", "\r"]),
    st.text(max_size=8),
)
tables = st.builds(
    lambda top, body, separator: "\n".join(separator.join(row) for row in [top, *body]),
    st.lists(headers, max_size=4),
    st.lists(st.lists(cells, max_size=4), max_size=4),
    st.sampled_from([",", ",", ",", ";", "\t"]),
)


def load_or_refuse(path: Path) -> Dataset | None:
    try:
        return load_dataset(path)
    except InputError as error:
        assert str(error).startswith(str(path))
        return None


@quickly
@given(st.one_of(st.binary(max_size=200), tables.map(lambda text: text.encode("utf-8", "surrogatepass"))))
def test_random_files(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "fuzz.csv"
    path.write_bytes(content)
    load_or_refuse(path)


@quickly
@given(st.sampled_from([*QUANTITIES.values()]), st.lists(cells, min_size=1, max_size=4))
def test_what_is_read_is_physical(tmp_path: Path, quantity: object, column: list[str]) -> None:
    name, unit = quantity.name, quantity.unit  # type: ignore[attr-defined]
    path = tmp_path / "fuzz.csv"
    path.write_bytes("\n".join([f"{name} [{unit}]", *column]).encode("utf-8", "surrogatepass"))
    data = load_or_refuse(path)
    if data is not None:
        assert all(quantity.admits(value) for value in data.columns[name].tolist())  # type: ignore[attr-defined]
        # two lines of a quotation mark each are one quoted cell without anything in it
        kept = [cell.replace('"', "") for cell in column if not cell.lstrip().startswith("#")]
        written = [float(cell) for cell in kept if cell.strip()]
        assert data.columns[name].tolist() == pytest.approx(written, rel=1e-15)


@quickly
@given(
    st.sampled_from(
        [
            "# convention: paper\nwavevector [1/m],power_spectrum_2d [m^4]",
            "# convention: one-sided 1-D\nwavevector [1/um],power_spectrum_1d [m^3]",
        ]
    ),
    st.lists(st.tuples(cells, cells), max_size=4),
)
def test_random_spectra(tmp_path: Path, header: str, rows: list[tuple[str, str]]) -> None:
    path = tmp_path / "fuzz.csv"
    text = "\n".join([header, *(",".join(row) for row in rows)])
    path.write_bytes(text.encode("utf-8", "surrogatepass"))
    try:
        spectrum = read_spectrum(path)
    except InputError as error:
        assert str(error).startswith(str(path))
    else:
        assert np.all(np.isfinite(spectrum.node_power)) and np.all(spectrum.node_power > 0)
