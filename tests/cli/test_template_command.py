"""``skinbayes template``: the header that a model's data need, and that data under it serve the model."""

from __future__ import annotations

from pathlib import Path

import pytest
from command_line import run

from skinbayes.errors import InputError
from skinbayes.files import load_dataset, shipped_names
from skinbayes.files.modelfile import load_model
from skinbayes.problem import load_problem
from skinbayes.problem.template import data_template
from skinbayes.vocabulary import LABELS

BALL = """
title = "A ball"
forward = "stribeck"
[data]
file = "digitised.csv"
observable = "friction_coefficient"
spread = "use"
{more}
[surface]
name = "paper_reference"
[parameters]
frictional_shear_stress = {{ loguniform = ["0.5 MPa", "500 MPa"] }}
sphere_radius = "8 mm"
young_modulus_layer = "7 MPa"
young_modulus_bulk = "20 kPa"
layer_thickness = "20 um"
{parameters}
[noise]
family = "lognormal"
[noise.noise_scale]
by = "person"
young = 0.1
old = 0.2
"""


def ball(folder: Path, parameters: str = 'normal_force = "0.2 N"', more: str = "") -> Path:
    path = folder / "ball.toml"
    path.write_text(BALL.format(parameters=parameters, more=more))
    return path


def test_a_model_whose_data_are_not_there_yet(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    model = ball(tmp_path)
    done = run(capsys, "template", model)
    assert done.status == 0
    assert done.output == (
        "person,speed_viscosity_product [N/m],friction_coefficient [1],friction_coefficient_standard_deviation [1]\n"
    )
    assert "viscosity times sliding speed" in done.errors and "[N/m]" in done.errors
    assert "noise_scale differs by it: young, old" in done.errors
    assert "Instead of speed_viscosity_product: viscosity and sliding_speed" in done.errors
    # rows under this header are data of the model
    (tmp_path / "digitised.csv").write_text(done.output + "young,1e-3,0.5,0.01\nold,1e-2,0.4,0.01\n")
    assert load_problem(model).conditions.n_rows == 2


def test_what_parameters_give_is_no_column(tmp_path: Path) -> None:
    assert "sliding_speed [m/s]" in data_template(ball(tmp_path, 'viscosity = "1 Pa s"')).header
    header = data_template(ball(tmp_path, 'viscosity = "1 Pa s"')).header
    assert "normal_force [N]" in header and "speed_viscosity_product" not in header


def test_spreads_of_inputs_are_asked_for_if_they_are_used(tmp_path: Path) -> None:
    columns = data_template(ball(tmp_path, more='input_spread = "use"')).columns
    (spread,) = [column for column in columns if column.name == "speed_viscosity_product_standard_deviation"]
    assert spread.unit == "N/m"


def test_a_digitised_figure_has_what_the_template_asks_for(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    model = ball(tmp_path, more='input_spread = "use"')
    # a straight line on axes that do not exist
    points = "".join(f"{10.0**-k!r},{0.2 + 0.1 * k!r}\n" for k in range(2, 6))
    (tmp_path / "young.csv").write_text(points)
    done = run(
        capsys, "digitised", tmp_path / "young.csv", "--abscissa", "speed_viscosity_product [N/m]",
        "--ordinate", "friction_coefficient [1]", "--abscissa-error", "3 %", "--ordinate-error", "0.01",
        "--label-column", "person", "-o", tmp_path / "digitised.csv",
    )  # fmt: skip
    assert done.status == 0
    asked = {column.header for column in data_template(model).columns}
    assert asked == set((tmp_path / "digitised.csv").read_text().splitlines()[0].split(","))
    problem = load_problem(model)
    assert problem.conditions.n_rows == 4
    assert (tmp_path / "digitised.provenance.toml").exists()


@pytest.mark.parametrize("model", shipped_names("models"))
def test_shipped_models_take_data_under_their_template(model: str, tmp_path: Path) -> None:
    found = data_template(model)
    spec = load_model(model)
    names = [column.name for column in found.columns]
    assert len(set(names)) == len(names)
    for column in found.columns:
        assert column.meaning and column.why
        assert (column.unit is None) == (column.name in LABELS)
    if spec.dataset is None:
        # without its last column, the observable, it is the header of conditions
        inputs = [column for column in found.columns if column.name in spec.conditions]
        assert [column.name for column in inputs] == list(spec.conditions)
        return
    # the shipped data have these columns, and the model is satisfied with no other
    data = load_dataset(spec.dataset)
    lines = [found.header]
    for row in range(data.n_rows):
        lines.append(",".join(str(data.columns[name][row]) for name in names))
    path = tmp_path / "mine.csv"
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    assert load_problem(model, data=path).conditions.n_rows == load_problem(model).conditions.n_rows


def test_a_file_is_written_once(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "series.csv"
    assert run(capsys, "template", "drying", "-o", path).status == 0
    assert path.read_text() == "time [s],friction_coefficient [1]\n"
    with pytest.raises(InputError, match="no rows of data below the header"):
        load_dataset(path)
    path.write_text("precious\n")
    refused = run(capsys, "template", "drying", "-o", path)
    assert refused.status == 2 and "exists already" in refused.errors and path.read_text() == "precious\n"
    assert run(capsys, "template", "drying", "-o", path, "--overwrite").status == 0
    assert path.read_text().startswith("time [s]")


def test_the_document(capsys: pytest.CaptureFixture[str]) -> None:
    document = run(capsys, "template", "forearm-glass", "--json").document()
    assert document["model"] == "forearm-glass" and document["file"] is None
    assert document["columns"][0]["name"] == "state" and document["columns"][0]["unit"] is None
    assert document["header"].endswith("friction_coefficient [1]")
    missing = run(capsys, "template", "no-such-model")
    assert missing.status == 2 and "no model 'no-such-model'" in missing.errors
