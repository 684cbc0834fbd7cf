"""What a model does with the columns of its data: labels of any name, forces, spreads, missing values, columns of Python."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from small_models import write_model
from small_runs import small_run

from skinbayes.errors import InputError
from skinbayes.files import Dataset, load_dataset
from skinbayes.fit import load_fit
from skinbayes.problem import Problem, load_problem
from skinbayes.problem.rows import data_notes

MODEL = """
title = "Columns"
forward = "friction"
[data]
observable = "OBSERVABLE"
MORE
[surface]
name = "paper_reference"
[parameters]
frictional_shear_stress = { lognormal = ["10 MPa", 1.0] }
young_modulus_layer = LAYER
young_modulus_bulk = "20 kPa"
layer_thickness = "20 um"
[noise]
family = "lognormal"
noise_scale = 0.2
"""
TEXT = (
    "session,group,nominal_pressure [kPa],friction_coefficient [1]\n"
    "1,control,1,0.5\n1,treated,2,0.6\n2,control,3,0.7\n2,treated,4,0.4\n"
)


def bound(
    folder: Path,
    text: object,
    layer: str = '"7 MPa"',
    more: str = "",
    observable: str = "friction_coefficient",
    after: str = "",
) -> Problem:
    model = MODEL.replace("LAYER", layer).replace("MORE", more).replace("OBSERVABLE", observable) + after
    if isinstance(text, str):
        (folder / "mine.csv").write_text(text, encoding="utf-8")
        text = folder / "mine.csv"
    return load_problem(write_model(folder, model), data=text)  # type: ignore[arg-type]


def test_labels_of_any_name_group_and_part_parameters(tmp_path: Path) -> None:
    problem = bound(
        tmp_path, TEXT, '{ by = "group", control = { lognormal = ["7 MPa", 0.1] }, treated = { lognormal = ["3 MPa", 0.1] } }',
        after='[groups.session]\nscale = { half_normal = 0.3 }\n[groups.group]\nscale = { half_normal = 0.3 }\n',
    )  # fmt: skip
    assert problem.names == (
        "frictional_shear_stress", "young_modulus_layer[control]", "young_modulus_layer[treated]", "group_scale[session]",
        "group_scale[group]",
    )  # fmt: skip
    theta = problem.prior_medians()
    assert_array_equal(problem.inputs(theta[np.newaxis])["young_modulus_layer"], [[7e6, 3e6, 7e6, 3e6]])
    assert problem.groups is not None and problem.groups.levels == (("1", "2"), ("control", "treated"))
    assert np.isfinite(problem.log_likelihood(theta))
    fit = small_run(problem, tmp_path / "run")
    again = load_fit(tmp_path / "run")
    assert again.problem is not None
    assert_array_equal(again.theta(), fit.theta())
    from skinbayes.plot.rows import label_columns, telling_columns

    assert label_columns(again) == ["session", "group"] and set(telling_columns(again)) == {
        "session",
        "group",
    }


@pytest.mark.parametrize(
    ("layer", "fragments"),
    [
        ('{ by = "sesion", 1 = "7 MPa", 2 = "3 MPa" }', ("no column 'sesion'", "Did you mean 'session'?")),
        ('{ by = "nominal_pressure", 1 = "7 MPa" }', ("'nominal_pressure'", "expected a label column")),
        ('{ by = "draw", 1 = "7 MPa" }', ("'draw' cannot stand in results",)),
        ('{ by = "left/right", 1 = "7 MPa" }', ("'left/right' cannot stand in results",)),
    ],
)
def test_columns_that_part_no_parameter(layer: str, fragments: tuple[str, ...], tmp_path: Path) -> None:
    with pytest.raises(InputError) as caught:
        bound(tmp_path, TEXT, layer)
    for fragment in fragments:
        assert fragment in str(caught.value)


def test_labels_whose_names_cannot_stand_in_results_are_left_aside(tmp_path: Path) -> None:
    text = TEXT.replace("session", "row").replace("group", "left/right")
    assert dict(bound(tmp_path, text).conditions.labels) == {}


def test_a_missing_input_is_looked_for_among_the_others(tmp_path: Path) -> None:
    with pytest.raises(
        InputError, match=r"needs nominal_pressure.*column 'nominal_presure': did you mean 'nominal_pressure'"
    ):
        bound(tmp_path, TEXT.replace("pressure", "presure"))
    with pytest.raises(
        InputError,
        match=r"no column 'friction_coefficient.*column 'COF': did you mean 'friction_coefficient'",
    ):
        bound(tmp_path, TEXT.replace("friction_coefficient", "COF"))


def test_columns_that_are_not_used_are_listed_once(tmp_path: Path) -> None:
    text = TEXT.replace("group,", "group,run [1],sebum [ug/cm^2],layer_thicknes [um],skin_hydration [1],")
    text = text.replace("control,", "control,31,1,20,40,").replace("treated,", "treated,32,2,21,50,")
    problem = bound(tmp_path, text)
    (note,) = data_notes(problem)
    assert note == (
        "Columns of the data that the model does not use: run [1], sebum [ug/cm^2], layer_thicknes [um] (Did you mean "
        "'layer_thickness'?), skin_hydration [1]."
    )
    assert problem.check().sentences().count(note) == 1
    assert problem.log_likelihood([1e7]) == bound(tmp_path, TEXT).log_likelihood([1e7])
    assert data_notes(bound(tmp_path, TEXT)) == []


@pytest.mark.parametrize("observable", ["friction_coefficient", "friction_force"])
def test_a_force_is_as_good_as_a_coefficient(observable: str, tmp_path: Path) -> None:
    table = "normal_force [N],nominal_contact_area [mm^2],"
    force = bound(tmp_path, table + "friction_force [mN]\n0.5,10,250\n0.25,10,200\n", observable=observable)
    ratio = bound(tmp_path, table + "friction_coefficient [1]\n0.5,10,0.5\n0.25,10,0.8\n")
    assert force.log_likelihood([1e7]) == ratio.log_likelihood([1e7])
    assert data_notes(force) == []
    with pytest.raises(InputError, match="needs a column 'normal_force' beside it"):
        bound(tmp_path, "nominal_pressure [Pa],friction_force [N]\n1000,1\n")


def test_a_standard_error_is_the_standard_deviation_of_a_mean(tmp_path: Path) -> None:
    table = "nominal_pressure [Pa],friction_coefficient [1],friction_coefficient_standard_{} [1]{}\n1000,0.5,0.05{}\n"
    deviation = bound(tmp_path, table.format("deviation", "", ""), more='spread = "use"')
    for count in (("", ""), (",n", ",9")):
        error = bound(tmp_path, table.format("error", *count), more='spread = "use"')
        assert error.log_likelihood([1e7]) == deviation.log_likelihood([1e7])
        assert data_notes(error) == []
    with pytest.raises(InputError, match='spread = "use" or spread = "ignore"'):
        bound(tmp_path, table.format("error", "", ""))
    names = (
        "friction_coefficient",
        "friction_coefficient_standard_error",
        "friction_coefficient_standard_deviation",
    )
    both = "nominal_pressure [Pa]," + ",".join(f"{name} [1]" for name in names)
    used = bound(tmp_path, f"{both},n\n1000,0.5,0.05,0.15,9\n", more='spread = "use"')
    assert used.log_likelihood([1e7]) == deviation.log_likelihood([1e7])
    with pytest.raises(InputError, match=r"line 3, friction_coefficient_standard_error: found 2 times"):
        bound(tmp_path, f"{both},n\n1000,0.5,0.05,0.15,9\n1000,0.5,0.1,0.15,9\n", more='spread = "use"')
    with pytest.raises(InputError, match="a column 'n'"):
        bound(tmp_path, f"{both}\n1000,0.5,0.05,0.15\n", more='spread = "use"')


def test_repeats_in_rows_are_data_of_their_own(tmp_path: Path) -> None:
    once = bound(tmp_path, "nominal_pressure [Pa],friction_coefficient [1]\n1000,0.5\n")
    thrice = bound(tmp_path, "nominal_pressure [Pa],friction_coefficient [1]\n" + "1000,0.5\n" * 3)
    assert_allclose(thrice.log_likelihood([1e7]), 3 * once.log_likelihood([1e7]), rtol=1e-14)


GAPS = (
    "session,note,nominal_pressure [kPa],skin_hydration [1],friction_coefficient [1]\n"
    "1,,1,,0.5\n1,a,,3,0.6\n2,b,3,4,NA\n,c,4,4,0.4\n2,d,4,-,0.3\n"
)


def test_rows_without_a_value_are_dropped_only_if_asked(tmp_path: Path) -> None:
    with pytest.raises(
        InputError,
        match=r'2 problems(.|\n)*line 3, column .nominal_pressure(.|\n)*line 4(.|\n)*missing = "drop"',
    ):
        bound(tmp_path, GAPS)
    problem = bound(tmp_path, GAPS, more='missing = "drop"')
    assert problem.observed is not None
    assert_array_equal(problem.observed, [0.5, 0.4, 0.3])
    assert (
        data_notes(problem)[0]
        == "2 rows were left out, without a value in a column that the model uses: lines 3, 4."
    )
    parted = bound(tmp_path, GAPS, '{ by = "session", 1 = "7 MPa", 2 = "3 MPa" }', more='missing = "drop"')
    assert parted.dataset is not None and parted.dataset.dropped == (3, 4, 5)
    with pytest.raises(InputError, match="found no value"):
        bound(
            tmp_path,
            GAPS.replace(",c,", ",c,").replace("NA", "1").replace("a,,", "a,1,"),
            '{ by = "session", 1 = "7 MPa", 2 = "3 MPa" }',
        )
    chosen = bound(tmp_path, GAPS, more='missing = "drop"\nrows = { session = ["2"] }')
    assert chosen.dataset is not None and chosen.dataset.dropped == (4, 5) and chosen.conditions.n_rows == 1


def test_a_run_of_dropped_rows_is_read_again(tmp_path: Path) -> None:
    problem = bound(tmp_path, GAPS, more='missing = "drop"')
    small_run(problem, tmp_path / "run")
    again = load_fit(tmp_path / "run").problem
    assert again is not None and again.fingerprint == problem.fingerprint


def test_columns_of_python_make_the_problem_that_a_file_makes(tmp_path: Path) -> None:
    columns = {
        "session": [1, 1, 2],
        "nominal_pressure [kPa]": [1, 2, 3],
        "friction_coefficient": [0.5, 0.6, 0.7],
    }
    file = bound(tmp_path, Dataset.from_columns(columns).to_csv())
    for data in (columns, pd.DataFrame(columns), Dataset.from_columns(columns, name="mine")):
        assert bound(tmp_path, data).log_likelihood([1e7]) == file.log_likelihood([1e7])
        assert bound(tmp_path, data).fingerprint == file.fingerprint
    given = bound(tmp_path, columns | {"friction_coefficient": [0.5, None, 0.7]}, more='missing = "drop"')
    assert data_notes(given)[0].endswith("uses: row 2.")
    fit = small_run(given, tmp_path / "run")
    again = load_fit(tmp_path / "run")
    assert again.problem is not None and again.problem.fingerprint == given.fingerprint
    assert_array_equal(again.theta(), fit.theta())
    assert load_dataset(tmp_path / "run" / "data" / "columns.csv").n_rows == 2
