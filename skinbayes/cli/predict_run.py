"""``predict --run``: the posterior at new rows, the probability of a statement, and where it holds."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from skinbayes.cli.new_file import write_columns
from skinbayes.cli.output import (
    EXIT_BAD_INPUT,
    EXIT_DONE,
    MOST_ROWS,
    print_json,
    print_sentences,
    print_table,
    quantity_text,
    say,
)
from skinbayes.errors import InputError

if TYPE_CHECKING:
    from skinbayes.fit import Fit
    from skinbayes.fit.prediction import Prediction


def predict_run(
    run: str,
    conditions: str | None,
    statement: str | None,
    along: str | None,
    confidence: float,
    seed: int,
    output: str | None,
    as_json: bool,
) -> int:
    """Print posterior predictions; the options are those of ``predict``."""
    import numpy as np

    from skinbayes.cli.progress import counted_progress

    if conditions is None:
        raise InputError(f"--run {run}: expected rows to predict too, --conditions FILE.csv")
    if along is not None and statement is None:
        raise InputError(
            "--along: expected a statement too, such as --probability 'friction_coefficient < 0.4'"
        )
    fit, file = _fit(run, conditions)
    with counted_progress(f"{fit.name}: table") as count:
        prediction = fit.predict(file, seed, count)
    probability = None if statement is None else prediction.probability(statement)
    held = [] if along is None else _held(prediction, str(statement), along, confidence)
    empty = [
        row + 1
        for row in range(prediction.n_rows)
        if any(np.isnan(values[:, row]).any() for values in prediction.of_model.values())
    ]
    if output is not None:
        table = prediction.to_frame(statement)
        write_columns(Path(output), {str(name): table[name] for name in table})
    if as_json:
        print_json(
            {
                "run": run,
                "model": fit.name,
                "conditions": dict(prediction.columns),
                "prediction": _intervals(prediction, measured=False),
                "prediction_with_noise": _intervals(prediction, measured=True),
                "statement": statement,
                "probability": probability,
                "holds": [{"conditions": at, "along": along, "intervals": where} for at, where in held],
                "notes": list(prediction.notes),
            }
        )
    else:
        _print(prediction, statement, probability)
        print_sentences(
            _sentence(statement, along, confidence, at, where, len(held) > 1) for at, where in held
        )
    if not fit.converged:
        say(f"note: {run} has not converged", err=True)
    for note in prediction.notes:
        say(f"note: {note}", err=True)
    if output is not None:
        say(f"predictions: {output}", err=as_json)
    if empty:
        listed = ", ".join(str(row) for row in empty[:10]) + (" and more" if len(empty) > 10 else "")
        say(
            f"skinbayes: {conditions}: the model has no answer in some or all of the draws at row {listed}; their numbers "
            "are left empty",
            err=True,
        )
    return EXIT_BAD_INPUT if empty else EXIT_DONE


def _fit(run: str, conditions: str) -> tuple[Fit, str]:
    """The fit that predicts, and the file of rows; of several experiments the one that ``conditions`` names."""
    from skinbayes.fit.joint_fit import JointFit
    from skinbayes.fit.storage import load_any_fit

    fit = load_any_fit(run)
    if not isinstance(fit, JointFit):
        return fit, conditions
    name, _, file = conditions.partition("=")
    if name not in fit.experiments or not file:
        expected = " or ".join(f"--conditions {one}=FILE.csv" for one in fit.experiments)
        raise InputError(f"--conditions {conditions}: the run is of several experiments; expected {expected}")
    return fit.experiments[name], file


def _held(
    prediction: Prediction, statement: str, along: str, confidence: float
) -> list[tuple[dict[str, Any], list[tuple[float, float]]]]:
    try:
        return prediction.holds(statement, along, confidence)
    except InputError as error:
        raise InputError(f"--along {along}: {error}") from None


def _intervals(prediction: Prediction, measured: bool) -> dict[str, Any]:
    return {
        name: dict(zip(("q05", "median", "q95"), prediction.quantiles(name, measured=measured), strict=True))
        for name in prediction.of_model
    }


def _print(prediction: Prediction, statement: str | None, probability: Any) -> None:
    headers = list(prediction.columns)
    cells = [
        [quantity_text(name, values[i].item()) for name, values in prediction.columns.items()]
        for i in range(prediction.n_rows)
    ]
    for name in prediction.of_model:
        for measured, what in ((False, "model"), (True, "measurement")):
            headers.append(f"{name}, {what}")
            low, middle, high = prediction.quantiles(name, measured=measured)
            for i, row in enumerate(cells):
                row.append(
                    "–" if middle[i] != middle[i]
                    else f"{quantity_text(name, middle[i])} ({quantity_text(name, low[i])} to {quantity_text(name, high[i])})"
                )  # fmt: skip
    if statement is not None:
        headers.append(statement)
        for i, row in enumerate(cells):
            row.append(f"{probability[i]:.1%}".replace("%", " %"))
    print_table(headers, cells[:MOST_ROWS], right=range(len(prediction.columns), len(headers)))
    if (left := prediction.n_rows - MOST_ROWS) > 0:
        say(f"{left} further rows; -o FILE.csv or --json gives all")
    print_sentences(
        [
            "Medians, with 90 % intervals. The model: what it predicts with the parameters of the posterior. A measurement: one "
            "more, with its scatter."
        ]
    )


def _sentence(
    statement: str | None,
    along: str | None,
    confidence: float,
    at: dict[str, Any],
    where: list[tuple[float, float]],
    several: bool,
) -> str:
    name = str(along)
    place = (
        f" at {', '.join(f'{key} {quantity_text(key, value)}' for key, value in at.items())}"
        if several and at
        else ""
    )
    if not where:
        return f"'{statement}' does not hold with {confidence:.0%} probability at any {name} of the rows{place}.".replace(
            "%", " %"
        )
    spans = " and ".join(
        f"from {quantity_text(name, low)} to {quantity_text(name, high)}" for low, high in where
    )
    return (
        f"'{statement}' holds with at least {confidence:.0%} probability for {name} {spans}{place}, within the rows given."
    ).replace("%", " %")
