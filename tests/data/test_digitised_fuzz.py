"""Whatever an export holds, it is read or refused with one message; no other exception comes out."""

from __future__ import annotations

import contextlib
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import synthetic_figure as figure
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from skinbayes.errors import InputError
from skinbayes.files.digitised import read_digitised

SEEDS = [json.dumps(figure.project()).encode(), figure.all_sets_csv((5, 3)).encode(), b"0,1;2,5\n3;4e-3\n"]
QUIET = settings(
    max_examples=150, deadline=None, derandomize=True, suppress_health_check=[HealthCheck.function_scoped_fixture]
)  # fmt: skip


@QUIET
@given(st.sampled_from(SEEDS), st.floats(0, 1), st.floats(0, 0.1), st.binary(max_size=6))
def test_damaged_bytes(tmp_path: Path, seed: bytes, start: float, length: float, put: bytes) -> None:
    first = int(start * len(seed))
    path = tmp_path / "damaged"
    path.write_bytes(seed[:first] + put + seed[first + int(length * len(seed)) :])
    with contextlib.suppress(InputError):
        assert all(np.isfinite(one.values).all() for one in read_digitised(path).sets)


def nodes(item: Any, path: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    below = item.items() if isinstance(item, dict) else enumerate(item) if isinstance(item, list) else ()
    return [path, *(found for key, value in below for found in nodes(value, (*path, key)))]


@pytest.mark.parametrize(
    "value", [None, [], {}, "x", -1, 1e308, True, 10**400], ids=lambda value: repr(value)[:8]
)
def test_every_entry_of_a_project_replaced(value: Any, tmp_path: Path) -> None:
    for number, (*way, last) in enumerate(nodes(figure.old_project())[1:]):
        content: Any = figure.old_project()
        item = content
        for key in way:
            item = item[key]
        item[last] = value
        path = figure.write_json(tmp_path / f"{number}.json", content)
        with contextlib.suppress(InputError):
            read_digitised(path)
