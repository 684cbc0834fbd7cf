"""Random damage to good model files: read, or refused with an InputError; nothing else."""

from __future__ import annotations

import random
import re
import tomllib
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from skinbayes.errors import InputError
from skinbayes.files.locate import shipped_folder, shipped_names
from skinbayes.problem import load_problem

TOKEN = re.compile(r'"[^"\n]*"|[A-Za-z_0-9.+-]+|[^\w\s]|\s+')
STRANGE = (
    '""', '"', "'", "nan", "inf", "-inf", "-1", "0", "1e999", "[]", "{}", "[", "}", "=", "true", "2020-01-01", '"nan"',
    '"inf MPa"', '"-5 MPa"', '"5 um"', '"water"', '"none"', "\n", "[parameters]", "[x]", "by", "fixed", "source",
    "uniform", "beta", "gamma", "student_t", "\u00e9", "\\u0000", '"10 MPa"', "1.0", "rms_height", "wavevector", "#",
    '["1 MPa", "2 MPa"]', '{ fixed = "3 MPa" }', "9" * 400, '"' + "x" * 300 + '"', "-0.0", "5e-324", "1e308",
)  # fmt: skip
SHIPPED = {name: (shipped_folder("models") / f"{name}.toml").read_text() for name in shipped_names("models")}


def damage(text: str, chooser: random.Random) -> str:
    tokens = TOKEN.findall(text)
    for _ in range(chooser.randint(1, 4)):
        at = chooser.randrange(len(tokens))
        match chooser.randrange(5):
            case 0:
                del tokens[at]
            case 1:
                tokens.insert(at, tokens[chooser.randrange(len(tokens))])
            case 2:
                tokens[at] = chooser.choice(STRANGE)
            case 3:
                other = chooser.randrange(len(tokens))
                tokens[at], tokens[other] = tokens[other], tokens[at]
            case _:
                word = tokens[at]
                place = chooser.randrange(len(word) + 1)
                tokens[at] = word[:place] + chooser.choice("x9-.\"' _\n") + word[place + 1 :]
        if not tokens:
            return ""
    return "".join(tokens)


ANY = {"name": st.sampled_from(sorted(SHIPPED)), "seed": st.integers(0, 2**32)}


@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(**ANY)
def test_damaged_models_are_read_or_refused(name: str, seed: int, tmp_path: Path) -> None:
    read_or_refused(name, seed, tmp_path, tables=False)


@pytest.mark.slow
@settings(max_examples=400, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(**ANY)
def test_many_damaged_models_are_read_or_refused(name: str, seed: int, tmp_path: Path) -> None:
    read_or_refused(name, seed, tmp_path, tables=True)


def read_or_refused(name: str, seed: int, tmp_path: Path, tables: bool) -> None:
    """``tables``: also evaluate models that build a table first, which takes up to half a minute each."""
    text = damage(SHIPPED[name], random.Random(seed))
    path = tmp_path / "mine.toml"
    path.write_bytes(text.encode("utf-8", "surrogatepass"))
    try:
        problem = load_problem(path)
    except InputError as error:
        message = str(error)
        assert message and len(message) < 2000 + len(str(path))
        return
    # what was accepted can be used: finite or impossible, never NaN, no exception
    tomllib.loads(text)
    if problem.expensive and not tables:
        return
    theta = problem.draw_prior(np.random.default_rng(0), 3) if problem.dimension else np.empty((3, 0))
    with np.errstate(all="raise"):
        problem.predict(theta)
        if problem.observed is not None and problem.dimension:
            value = problem.log_posterior(theta)
            assert not np.isnan(value).any() and not (value == np.inf).any()
