"""Friction of recordings whose friction is known."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from synthetic_recordings import GERMAN, TABS, recipe, synthetic, without_strokes, write_german, write_tabs

import skinbayes as sb
from skinbayes.errors import InputError
from skinbayes.recordings import Recording, Rules, reduce_recording
from skinbayes.recordings.averages import averaged, paired

BOTH = Rules(tangential_zero="both directions")
QUIET = {"noise": 0.0, "memory": 0.0}


def friction(found) -> np.ndarray:
    return np.array([row.friction_coefficient for row in found.used])


@pytest.mark.parametrize("source", ["position", "sliding_speed", "tangential_force"])
def test_strokes_and_their_friction_whatever_tells_them(source: str) -> None:
    made = synthetic(1, **QUIET)
    if source == "sliding_speed":
        made = replace(made, position=None, sliding_speed=np.gradient(made.position, made.time))
    elif source == "tangential_force":
        made = replace(made, position=None)
    found = reduce_recording(made, BOTH)
    assert [row.direction for row in found.used] == [1, -1] * 5
    assert friction(found) == pytest.approx(0.5, rel=2e-3)
    assert found.tangential_zero.value == pytest.approx(0.05, abs=5e-4)
    if source != "tangential_force":
        assert [row.sliding_speed for row in found.used] == pytest.approx([0.02 / 3.6] * 10, rel=0.01)
    assert all(
        0.53 < row.static_friction_coefficient < 0.58 for row in found.used
    )  # a peak of 0.575, 40 ms wide


def test_an_unsigned_speed_tells_strokes_by_its_stops() -> None:
    made = synthetic(1, **QUIET, zero=0.0)
    speed = np.abs(np.gradient(made.position, made.time))
    one_way = replace(
        made, position=None, sliding_speed=speed, tangential_force=np.abs(made.tangential_force)
    )
    found = reduce_recording(one_way, Rules())
    assert len(found.used) == 10 and friction(found) == pytest.approx(0.5, rel=2e-3)


def test_the_share_of_a_stroke_is_taken_by_distance() -> None:
    made = synthetic(1, **QUIET)
    row = reduce_recording(made, replace(BOTH, share=0.5)).used[2]
    places = made.position[row.begin : row.end]
    assert places.min() == pytest.approx(0.005, abs=2e-4) and places.max() == pytest.approx(0.015, abs=2e-4)


def test_change_points_cut_the_beginning_off() -> None:
    made = synthetic(1, noise=0.01, memory=0.0, static=0.6)
    found = reduce_recording(made, replace(BOTH, steady="change points"))
    taken = [(row.end - row.begin) / (row.stop - row.start) for row in found.used]
    # now and then a change is seen in noise, which costs data but no truth
    assert 0.6 < np.median(taken) < 0.95 and min(taken) > 0.3
    assert friction(found) == pytest.approx(0.5, rel=0.01)


def test_a_zero_at_rest() -> None:
    made = synthetic(1, **QUIET)
    rest = np.random.default_rng(2).normal(scale=1e-3, size=(2, 200))
    join = np.concatenate
    longer = Recording(
        "rest first",
        np.arange(made.time.size + 200) * 0.01,
        join((0.05 + rest[0], made.tangential_force)),
        join((0.02 + rest[1], made.normal_force + 0.02)),
        position=join((np.zeros(200), made.position)),
    )
    rules = Rules(tangential_zero="rest", normal_zero="rest", rest=(0.0, 1.9))
    found = reduce_recording(longer, rules)
    assert found.tangential_zero.value == pytest.approx(0.05, abs=4 * found.tangential_zero.standard_error)
    assert found.normal_zero.value == pytest.approx(0.02, abs=4 * found.normal_zero.standard_error)
    assert friction(found) == pytest.approx(0.5, rel=2e-3)


def test_pairs_know_no_zero() -> None:
    found = reduce_recording(synthetic(1), Rules(tangential_zero="as recorded"))
    assert abs(friction(found)[0] - friction(found)[1]) > 0.15  # the zero that is off
    pairs = paired(found.used)
    assert len(pairs) == 5 and all(pair.direction == 0 for pair in pairs)
    assert [pair.friction_coefficient for pair in pairs] == pytest.approx([0.5] * 5, abs=0.015)


def test_the_zero_of_both_directions_is_in_the_errors_and_cancels_in_a_mean_of_both() -> None:
    found = reduce_recording(synthetic(1), BOTH)
    assert found.used[0].zero_error == pytest.approx(found.tangential_zero.standard_error / 0.5, rel=0.05)
    both = averaged(found.used, [0] * 10)
    one_way = averaged([row for row in found.used if row.direction > 0], [0] * 5)
    assert both.zero_error < 0.05 * found.used[0].zero_error < one_way.zero_error
    assert both.strokes == 10 and both.own_error < found.used[0].own_error


def test_running_in_and_drift_are_told() -> None:
    found = reduce_recording(synthetic(1, running_in=0.4, strokes=20), BOTH)
    assert found.trend.kind == "running in" and found.trend.half == pytest.approx(3.0, rel=0.3)
    assert (found.trend.first, found.trend.last) == pytest.approx((0.7, 0.5), abs=0.02)
    along = reduce_recording(synthetic(1, drift=0.2), BOTH)
    # 0.2 along the whole stroke, of which 60 % of the way in 54 % of the time are taken
    assert np.mean([row.change for row in along.used]) == pytest.approx(0.54 * 0.2 * 0.5, rel=0.2)
    assert reduce_recording(synthetic(1), BOTH).trend.kind == "constant"


def test_stick_and_slip_is_seen_and_noise_is_not() -> None:
    assert reduce_recording(synthetic(1, slip=0.3), BOTH).period == pytest.approx(0.15, abs=0.04)
    assert np.isnan(reduce_recording(synthetic(1), BOTH).period)


def test_a_load_ramp_is_cut_into_bins() -> None:
    time = np.arange(4000) * 0.01
    load = 0.1 + 0.9 * time / 40
    noise = np.random.default_rng(1).normal(scale=0.002, size=4000)
    made = Recording("ramp", time, 0.4 * load ** (2 / 3) * (1 + noise), load + noise)
    rules = Rules(strokes_from="whole", share=1.0, ramp_edges=(0.1, 0.2, 0.4, 0.6, 0.8, 1.0))
    found = reduce_recording(made, rules)
    assert [row.load_bin for row in found.used] == [1, 2, 3, 4, 5]
    loads = np.array([row.normal_force for row in found.used])
    assert loads == pytest.approx([0.15, 0.3, 0.5, 0.7, 0.9], rel=0.02)
    # F ~ N^(2/3) is concave, so that the ratio of means lies a little below that at the mean load
    assert friction(found) == pytest.approx(0.4 * loads ** (-1 / 3), rel=0.01)


def test_strokes_without_load_are_left_out_with_the_reason() -> None:
    found = reduce_recording(
        without_strokes(synthetic(1), 4.0, (3, 4, 7)), replace(BOTH, tangential_zero="as recorded")
    )
    assert [row.stroke for row in found.faulty] == [4, 5, 8]
    assert all("normal force near zero" in row.left_out for row in found.faulty)
    assert len(found.used) == 7


def test_two_instruments_tell_the_same(tmp_path: Path) -> None:
    made = synthetic(5)
    first = sb.reduce_recordings(
        write_german(made, tmp_path / "A-1.txt"), recipe(GERMAN, zero={"tangential_force": "both directions"})
    )
    second = sb.reduce_recordings(
        write_tabs(made, tmp_path / "A-1.tsv"),
        recipe(TABS, zero={"tangential_force": "both directions"}, file={"sampling_rate": "100 1/s"}),
    )
    exact = reduce_recording(made, BOTH)
    for found in (first, second):
        values = found.dataset.columns
        assert values["friction_coefficient"] == pytest.approx(friction(exact), rel=2e-4)
        assert values["normal_force"] == pytest.approx([row.normal_force for row in exact.used], rel=1e-4)
        errors = [row.standard_error for row in exact.used]
        assert values["friction_coefficient_standard_error"] == pytest.approx(errors, rel=0.02)


def test_the_folder_is_a_data_set_and_the_recipe_comes_back(tmp_path: Path) -> None:
    made = recipe(
        GERMAN | {"sphere_radius": {"value": "8 mm"}, "relative_humidity": {"value": "45 %"}},
        labels={"file_name": "{person}-{session}", "counterface": "glass"},
        zero={"tangential_force": "both directions"},
    )
    files = [
        write_german(synthetic(i, strokes=4), tmp_path / f"{name}.txt")
        for i, name in enumerate(("A-1", "A-2", "B-1"))
    ]
    reduced = sb.reduce_recordings(files, made)
    reduced.save(tmp_path / "set")
    data = sb.load_dataset(tmp_path / "set")
    assert data.n_rows == 12 and data.labels("person") == ("A", "B") and data.labels("session") == ("1", "2")
    assert set(data.columns["sphere_radius"]) == {0.008} and set(data.columns["relative_humidity"]) == {0.45}
    (tmp_path / "again.toml").write_text(data.provenance.recipe.replace("\r\n", "\n"))
    again = sb.reduce_recordings(files, tmp_path / "again.toml")
    assert again.dataset.fingerprint == reduced.dataset.fingerprint == data.fingerprint
    assert len(data.provenance.recordings["B-1.txt"]) == 64

    per = sb.reduce_recordings(files, made | {"rows": {"each": ["person"]}})
    assert per.dataset.n_rows == 2 and per.dataset.columns["number_of_measurements"].tolist() == [8, 4]
    assert per.dataset.columns["friction_coefficient"] == pytest.approx([0.5, 0.5], abs=0.02)
    assert sb.reduce_recordings(files, made | {"rows": {"each": "pair"}}).dataset.n_rows == 6
    assert sb.reduce_recordings(files, made | {"rows": {"each": "recording"}}).dataset.n_rows == 3


def test_time_counts_from_the_wetting(tmp_path: Path) -> None:
    made = synthetic(1)
    frame = pd.DataFrame(
        {"t": made.time, "F": made.tangential_force, "N": made.normal_force, "x": made.position}
    )
    columns = {
        "time": {"name": "t", "unit": "s"},
        "tangential_force": {"name": "F", "unit": "N"},
        "normal_force": {"name": "N", "unit": "N"},
        "position": {"name": "x", "unit": "m"},
    }
    plan = recipe(columns, rows={"time_zero": "11 s"}, zero={"tangential_force": "both directions"})
    found = sb.reduce_recordings({"drying": frame}, plan)
    assert found.before_zero == 3  # middles at 2, 6 and 10 s
    assert found.dataset.columns["time"] == pytest.approx(np.arange(14, 40, 4) - 11.0, abs=0.02)
    whole = sb.reduce_recordings({"drying": frame.assign(state=np.where(made.time < 20, "wet", "dry"))},
                                 plan | {"labels": {"state": {"name": "state"}}, "rows": {}})  # fmt: skip
    assert whole.dataset.columns["state"].tolist() == ["wet"] * 5 + ["dry"] * 5


def test_strokes_none_of_which_can_be_used_say_why() -> None:
    """Not that the zero of the force lacks directions, which is what follows from it."""
    made = synthetic(1, **QUIET)
    swapped = replace(made, tangential_force=made.normal_force, normal_force=made.tangential_force)
    with pytest.raises(
        InputError, match=r"no forward stroke beside .* Left out were: \d+ strokes, a normal force near zero"
    ):
        reduce_recording(swapped, BOTH)
