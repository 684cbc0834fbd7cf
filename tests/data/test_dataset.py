"""A data set is immutable, picklable, and selects rows by label."""

import pickle
from pathlib import Path

import numpy as np
import pytest

from skinbayes.errors import InputError
from skinbayes.files import Dataset, load_dataset

TEXT = "person,liquid,normal_force [N]\nB,water,1\nA,honey,2\nB,honey,3\nA,water,4\n"


@pytest.fixture
def data(tmp_path: Path) -> Dataset:
    path = tmp_path / "small.csv"
    path.write_text(TEXT)
    return load_dataset(path)


def test_what_it_holds(data: Dataset) -> None:
    assert (data.key, data.n_rows, data.kind, data.provenance) == ("small", 4, "measurements", None)
    assert dict(data.units) == {"normal_force": "N"}
    assert list(data.columns) == ["person", "liquid", "normal_force"]


def test_labels_in_order_of_appearance(data: Dataset) -> None:
    assert data.labels("person") == ("B", "A")


@pytest.mark.parametrize(
    ("rows", "forces"),
    [
        ({}, [1, 2, 3, 4]),
        ({"liquid": ["water"]}, [1, 4]),
        ({"liquid": "water"}, [1, 4]),
        ({"liquid": ["water", "honey"]}, [1, 2, 3, 4]),
        ({"liquid": ["water"], "person": ["A"]}, [4]),
    ],
)
def test_select(data: Dataset, rows: dict[str, list[str]], forces: list[float]) -> None:
    chosen = data.select(rows)
    assert chosen.columns["normal_force"].tolist() == forces
    assert chosen.sha256 == data.sha256
    assert set(chosen.selection) == set(rows)
    assert (chosen.fingerprint == data.fingerprint) == (len(forces) == 4)


@pytest.mark.parametrize(
    ("rows", "fragments"),
    [
        ({"liquid": ["watre"]}, ("'liquid'", "'watre'", "'water', 'honey'", "Did you mean 'water'?")),
        ({"liqud": ["water"]}, ("'liqud'", "person", "Did you mean 'liquid'?")),
        ({"normal_force": ["1"]}, ("no label column 'normal_force'", "'person', 'liquid'")),
        ({"liquid": []}, ("no row has", "at least one row")),
        ({"liquid": [1]}, ("'liquid'", "'1'")),
    ],
)
def test_select_refuses(data: Dataset, rows: dict[str, list[str]], fragments: tuple[str, ...]) -> None:
    with pytest.raises(InputError) as caught:
        data.select(rows)
    for fragment in ("small", *fragments):
        assert fragment in str(caught.value)


def test_select_without_a_common_row(data: Dataset) -> None:
    only_b = data.select({"person": ["B"], "liquid": ["water"]})
    with pytest.raises(InputError, match="no row is labelled 'honey'"):
        only_b.select({"liquid": ["honey"]})
    one_each = data.select({"liquid": ["water"]}).select({"person": ["A"]})
    assert one_each.n_rows == 1 and dict(one_each.selection) == {"liquid": ("water",), "person": ("A",)}


def test_immutable(data: Dataset) -> None:
    with pytest.raises(ValueError, match="read-only"):
        data.columns["normal_force"][0] = 9.0
    with pytest.raises(TypeError):
        data.columns["normal_force"] = np.zeros(4)  # type: ignore[index]
    with pytest.raises(AttributeError):
        data.key = "other"  # type: ignore[misc]


def test_later_changes_of_the_given_arrays_do_not_reach_it(data: Dataset) -> None:
    forces = np.array([1.0, 2.0])
    other = Dataset("k", data.path, {"normal_force": forces}, {"normal_force": "N"}, None, data.sha256)
    forces[0] = 5.0
    assert other.columns["normal_force"].tolist() == [1.0, 2.0]


def test_pickled_and_back(data: Dataset) -> None:
    chosen = data.select({"person": ["A"]})
    again = pickle.loads(pickle.dumps(chosen))
    assert again.fingerprint == chosen.fingerprint
    assert again.selection == chosen.selection and again.sha256 == chosen.sha256
    assert not again.columns["normal_force"].flags.writeable


def test_fingerprint_sees_every_part(data: Dataset, tmp_path: Path) -> None:
    seen = {data.fingerprint}
    for old, new in (
        ("B,water,1", "B,water,1.5"),
        ("B,honey", "B,glycerin"),
        ("[N]", "[mN]"),
        ("person", "state"),
    ):
        path = tmp_path / "other.csv"
        path.write_text(TEXT.replace(old, new))
        seen.add(load_dataset(path).fingerprint)
    assert len(seen) == 5


def test_shipped_data_keep_their_provenance_when_pickled() -> None:
    data = load_dataset("fehlberg2025-finger-stribeck").select({"liquid": ["water"]})
    again = pickle.loads(pickle.dumps(data))
    assert again.provenance == data.provenance and again.fingerprint == data.fingerprint
