"""``predict``: the forward model at given parameters."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from skinbayes.cli.new_file import refuse_existing, write_columns
from skinbayes.cli.options import json_option, number_option, overwrite_option, set_option, settings_of
from skinbayes.cli.output import (
    EXIT_BAD_INPUT,
    EXIT_DONE,
    MOST_ROWS,
    print_json,
    print_table,
    quantity_text,
    say,
)
from skinbayes.defaults import SEED
from skinbayes.errors import InputError


@click.command()
@click.argument("model", required=False)
@set_option
@click.option("--conditions", metavar="FILE.csv", help="Rows to predict instead of the model's own.")
@click.option("--run", metavar="RUN", help="Predict with the posterior of this run instead of with a model.")
@click.option(
    "--probability",
    "statement",
    metavar="STATEMENT",
    help="With --run: how probable 'friction_coefficient < 0.4' is.",
)
@click.option(
    "--along",
    metavar="COLUMN",
    help="With --probability: from where to where along this column of the rows it holds.",
)
@click.option(
    "--confidence",
    default=0.95,
    show_default=True,
    type=click.FloatRange(0.0, 1.0, True, True),
    help="With --along: how surely.",
)
@number_option("--seed", SEED, 0, "With --run: seed of scatter and of effects of new people.")
@click.option("-o", "--output", metavar="FILE.csv", help="Write rows and predictions, SI.")
@overwrite_option
@json_option
def predict(
    model: str | None,
    pairs: tuple[str, ...],
    conditions: str | None,
    run: str | None,
    statement: str | None,
    along: str | None,
    confidence: float,
    seed: int,
    output: str | None,
    overwrite: bool,
    as_json: bool,
) -> int:
    """Predict with a model at given parameters, or with a run.

    Without --run the forward model is evaluated, with it at the draws of a posterior.

    Free parameters of a MODEL that are not set stand at their prior median. With --run, predictions are medians and 90 %
    intervals at the rows of --conditions, of the model and of one measurement more.

    A row without a prediction is empty (null in JSON), named on standard error with the reason, and makes the exit status 2.
    """
    if (model is None) == (run is None):
        raise InputError(
            "predict: "
            + ("found a model and --run" if run else "found neither a model nor --run")
            + "; expected one of them"
        )
    if output is not None:
        refuse_existing([Path(output)], overwrite)
    if run is not None:
        from skinbayes.cli.predict_run import predict_run

        if pairs:
            raise InputError(
                "--set: parameters of a run are its posterior draws; expected it with a model only"
            )
        return predict_run(run, conditions, statement, along, confidence, seed, output, as_json)
    if statement is not None or along is not None:
        raise InputError(
            "--probability, --along: a model alone has no probabilities; expected them with --run"
        )
    return _predict_model(str(model), pairs, conditions, output, as_json)


def _predict_model(
    model: str, pairs: tuple[str, ...], conditions: str | None, output: str | None, as_json: bool
) -> int:
    from skinbayes.files.joint_model import is_joint
    from skinbayes.problem.load import load_joint_problem, load_problem

    settings = settings_of(pairs)
    if not is_joint(model):
        problem = load_problem(model, settings=settings, conditions=conditions)
        document, missing = _predicted(problem, settings, model, as_json)
    else:
        if conditions is not None:
            raise InputError(
                f"--conditions: '{model}' is of several experiments; predictions are for the rows of their data"
            )
        joint = load_joint_problem(model, settings=settings)
        each, missing = {}, []
        for name, one in joint.experiments.items():
            each[name], lacking = _predicted(one, settings, f"{model}: {name}", as_json)
            missing += [f"{name}: {sentence}" for sentence in lacking]
        document = {"model": joint.name, "experiments": each}
    if output is not None:
        for name, one in document.get("experiments", {"": document}).items():
            file = Path(output).with_stem(f"{Path(output).stem}-{name}") if name else Path(output)
            write_columns(file, {**one["conditions"], **one["prediction"]})
            say(f"predictions: {file}", err=as_json)
    if as_json:
        print_json(document)
    for sentence in missing[:_MOST_SENTENCES]:
        say(f"skinbayes: {model}: {sentence}", err=True)
    if len(missing) > _MOST_SENTENCES:
        say(f"skinbayes: {model}: {len(missing)} rows in all have no prediction", err=True)
    return EXIT_BAD_INPUT if missing else EXIT_DONE


def _predicted(
    problem: Any, settings: dict[str, str], model: str, quiet: bool
) -> tuple[dict[str, Any], list[str]]:
    """Predictions of one experiment, printed unless quiet, and a sentence for each row that lacks one."""
    theta = problem.prior_medians()
    prediction = problem.predict(theta)
    missing = _without_value(problem, theta, prediction)
    if len(missing) == problem.conditions.n_rows:
        raise InputError(f"{model}: no row has a prediction; {missing[0]}")
    if problem.free:
        say(
            f"note: this is no result of a fit: {', '.join(problem.names)} at the median of the prior",
            err=True,
        )
    for note in problem.explain(theta):
        say(f"note: {note}", err=True)
    parameters: dict[str, Any] = dict(zip(problem.names, theta.tolist(), strict=True))
    for p in problem.fixed:
        given_as_none = settings.get(p.name, "").lower() == "none"
        parameters[p.label] = None if given_as_none else p.value
    parameters |= {p.label: parameters[str(p.same_as)] * p.times for p in problem.tied}
    columns: dict[str, Any] = {**problem.conditions.values, **problem.conditions.labels}
    if not quiet:
        _print(problem, theta, columns, prediction)
    return {
        "model": problem.name, "parameters": parameters, "conditions": columns, "prediction": prediction,
    }, missing  # fmt: skip


_MOST_SENTENCES = 10


def _without_value(problem: Any, theta: Any, prediction: dict[str, Any]) -> list[str]:
    """A sentence for each row that lacks a prediction: which, and why."""
    from skinbayes.problem.possible import has_value

    sound = {name: has_value(name, values) for name, values in prediction.items()}
    nowhere = not any(values.any() for values in sound.values())
    said: list[str] = []
    for row in range(problem.conditions.n_rows):
        lacking = [name for name, values in sound.items() if not values[row]]
        if lacking:
            # reasons take an evaluation each, and only the first ones are shown
            why = problem.explain(theta, row) if len(said) < (1 if nowhere else _MOST_SENTENCES) else []
            because = " ".join(why) or "these inputs lie outside the forward model's range"
            others = f" (nor have {len(lacking) - 1} others)" if len(lacking) > 1 else ""
            said.append(f"{lacking[0]} has no finite value at row {row + 1}{others}: {because}")
    return said


def _print(problem: Any, theta: Any, columns: dict[str, Any], prediction: dict[str, Any]) -> None:
    values = [
        (p.label, quantity_text(p.name, v, 4, p.prior_text), "prior median")
        for p, v in zip(problem.free, theta, strict=True)
    ]
    values += [(p.label, quantity_text(p.name, p.value, 4, p.prior_text), p.source) for p in problem.fixed]
    values += [(p.label, p.prior_text, p.source) for p in problem.tied]
    print_table(("input", "value", "from"), values)
    headers = [*columns, *prediction]
    cells = [
        [quantity_text(name, values[i], 4) for name, values in (*columns.items(), *prediction.items())]
        for i in range(min(MOST_ROWS, problem.conditions.n_rows))
    ]
    print_table(headers, cells, right=range(len(columns), len(headers)))
    if left := problem.conditions.n_rows - len(cells):
        say(f"{left} further rows; --json gives all")
