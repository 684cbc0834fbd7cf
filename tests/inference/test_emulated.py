"""Forward models that ask for an emulator: against closed forms, and evaluated themselves where there is none."""

from __future__ import annotations

import pickle
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from skinbayes.errors import InputError
from skinbayes.forward import ForwardModel, Tables, emulated
from skinbayes.forward.base import TiedRanges
from skinbayes.forward.emulated_model import Emulated

RANGES = {
    "time": (1.0, 100.0),
    "wetting_time": (30.0, 90.0),
    "temperature": (290.0, 310.0),
    "area_correction": (0.4, 0.4),
}
EVALUATED: list[int] = []


def fading(inputs, tables):
    """Friction that fades in an oscillation, which crosses zero, beside a positive area."""
    EVALUATED.append(np.broadcast(*inputs.values()).size)
    ratio = inputs["time"] / inputs["wetting_time"]
    warmth = 1 + (inputs["temperature"] - 300.0) / 50.0
    return {
        "friction_coefficient": np.cos(ratio) * warmth,
        "relative_contact_area": inputs["area_correction"] * warmth * np.exp(-ratio),
    }


MODEL = ForwardModel(
    name="fading", summary="test", observables=("friction_coefficient", "relative_contact_area"), required=tuple(RANGES),
    evaluate=fading, uses_surface=False, prepare=emulated(tolerance=1e-4),
)  # fmt: skip


def prepared(model=MODEL, ranges=RANGES, cores=1, **options):
    make = emulated(**{"tolerance": 1e-4, **options})
    return make(model, ranges, Tables(), None, cores)


def inputs_of(vectors: int, rows: int = 7):
    rng = np.random.default_rng(3)
    drawn = {
        name: np.exp(rng.uniform(*np.log(RANGES[name]), (vectors, 1)))
        for name in ("wetting_time", "temperature")
    }
    return {**drawn, "time": rng.uniform(*RANGES["time"], (1, rows)), "area_correction": np.array([[0.4]])}


def test_an_emulator_is_as_exact_as_asked_and_evaluates_no_more():
    fast, inputs = prepared(), inputs_of(200)
    EVALUATED.clear()
    found = fast.evaluate(inputs, Tables())
    assert not EVALUATED and fast.prepare is None and "% at most" in fast.accuracy
    exact = fading(inputs, Tables())
    # friction crosses zero: relative to its largest value of 1.2; twice the tolerance is room beyond the places it was held to
    assert np.abs(found["friction_coefficient"] - exact["friction_coefficient"]).max() < 2e-4 * 1.2
    assert np.abs(found["relative_contact_area"] / exact["relative_contact_area"] - 1).max() < 2e-4


def test_inputs_that_are_multiples_are_one_axis():
    low, high = RANGES["temperature"]
    ranges = TiedRanges(
        {**RANGES, "wetting_time": (low / 10, high / 10)}, {"wetting_time": ("temperature", 0.1)}
    )
    fast, inputs = prepared(ranges=ranges), inputs_of(200)
    assert "wetting_time" not in fast.evaluate.__self__.found.counts
    for factor, beyond in ((0.1, False), (0.1001, True)):
        inputs["wetting_time"] = factor * inputs["temperature"]
        EVALUATED.clear()
        found = fast.evaluate(inputs, Tables())
        assert bool(EVALUATED) == beyond
        for name, exact in fading(inputs, Tables()).items():
            assert found[name] == pytest.approx(exact, abs=1e-4 * np.abs(exact).max())


def test_vectors_one_by_one_and_after_a_journey_are_the_same_to_the_last_bit():
    fast, inputs = pickle.loads(pickle.dumps(prepared())), inputs_of(40)
    found = fast.evaluate(inputs, Tables())
    for i in range(40):
        one = fast.evaluate({n: x[i : i + 1] if len(x) > 1 else x for n, x in inputs.items()}, Tables())
        assert all(np.array_equal(one[name][0], found[name][i]) for name in found)


@pytest.mark.parametrize("change", [{"wetting_time": 29.0}, {"area_correction": 0.5}, {"time": np.nan}])
def test_beyond_the_box_the_model_itself_is_evaluated(change):
    fast, inputs = prepared(), inputs_of(3)
    ((name, value),) = change.items()
    inputs[name] = np.array(np.broadcast_to(inputs[name], (3, inputs[name].shape[1])))
    inputs[name][1] = value
    found, exact = fast.evaluate(inputs, Tables()), fading(inputs, Tables())
    for each in found:
        assert np.array_equal(found[each][1], exact[each][1], equal_nan=True)
        assert not np.array_equal(found[each][0], exact[each][0])


def step(inputs, tables):
    return {**fading(inputs, tables), "friction_coefficient": np.where(inputs["time"] > 50.0, 1.0, 2.0)}


@pytest.mark.parametrize(("evaluate", "options", "why"), [
    (step, {}, "does not come to 0.0001 on 2000 nodes"),
    (fading, {"most": 20}, "does not come to 0.0001 on 20 nodes"),
    (fading, {"over": ("time", "temperature")}, "wetting_time may vary, too"),
])  # fmt: skip
def test_what_cannot_be_emulated_is_evaluated_and_says_so(evaluate, options, why):
    model = replace(MODEL, evaluate=evaluate)
    found = prepared(model, **options)
    assert found.evaluate is evaluate and found.prepare is None and why in found.accuracy


def test_an_input_that_the_model_does_not_take_is_named():
    with pytest.raises(InputError, match="over speed, which it does not take"):
        prepared(over=("speed",))


def test_a_version_is_kept_on_disk_and_a_stopped_build_goes_on(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setenv("SKINBAYES_CACHE", str(tmp_path))
    whole = prepared().evaluate(inputs_of(5), Tables())

    def impatient(inputs, tables):
        if len(EVALUATED) == 150:
            raise KeyboardInterrupt
        return fading(inputs, tables)

    EVALUATED.clear()
    with monkeypatch.context() as often, pytest.raises(KeyboardInterrupt):
        often.setattr("skinbayes.emulation.tasks._SAVED_EVERY", 0.0)
        prepared(replace(MODEL, evaluate=impatient), version="1")
    EVALUATED.clear()
    prepared()
    needed = len(EVALUATED)
    EVALUATED.clear()
    found = prepared(version="1").evaluate(inputs_of(5), Tables())
    assert len(EVALUATED) == needed - 150
    assert all(np.array_equal(found[name], whole[name]) for name in whole)
    EVALUATED.clear()
    prepared(version="1")
    assert not EVALUATED
    prepared(version="2")
    assert len(EVALUATED) == needed


def test_processes_give_the_same_numbers():
    inputs = inputs_of(5)
    one, two = (prepared(cores=cores).evaluate(inputs, Tables()) for cores in (1, 2))
    assert all(np.array_equal(one[name], two[name]) for name in one)
    # a function that other processes cannot find is evaluated here
    local = replace(MODEL, evaluate=lambda inputs, tables: fading(inputs, tables))
    three = prepared(local, cores=2)
    assert isinstance(three.evaluate.__self__, Emulated)
    assert all(np.array_equal(one[name], three.evaluate(inputs, Tables())[name]) for name in one)
