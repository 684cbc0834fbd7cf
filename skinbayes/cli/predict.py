"""``predict``: the forward model at given parameters."""

from __future__ import annotations

from typing import Any

import click

from skinbayes.cli.output import json_option, print_json, print_table
from skinbayes.errors import InputError


def parse_settings(pairs: tuple[str, ...]) -> dict[str, str]:
    """Split ``NAME=VALUE`` pairs; :class:`InputError` for a pair without ``=`` or a name set twice."""
    settings: dict[str, str] = {}
    for pair in pairs:
        name, equals, value = pair.partition("=")
        if not equals or not name.strip() or not value.strip():
            raise InputError(f'--set {pair}: expected NAME=VALUE, for example --set yield_stress="50 MPa"')
        if name.strip() in settings:
            raise InputError(f"--set {name.strip()}: set twice")
        settings[name.strip()] = value.strip()
    return settings


@click.command()
@click.argument("model")
@click.option(
    "--set", "pairs", multiple=True, metavar="NAME=VALUE", help="Fix a parameter or condition, with its unit."
)
@click.option("--conditions", metavar="FILE.csv", help="Rows to predict instead of the model's own.")
@json_option
def predict(model: str, pairs: tuple[str, ...], conditions: str | None, as_json: bool) -> None:
    """Evaluate the forward model at given parameters; free ones that are not set stand at their prior median."""
    from skinbayes.problem import load_problem
    from skinbayes.problem.possible import has_value

    settings = parse_settings(pairs)
    problem = load_problem(model, settings=settings, conditions=conditions)
    theta = problem.prior_medians()
    prediction = problem.predict(theta)
    sound = {name: has_value(name, values) for name, values in prediction.items()}
    bad = [name for name, values in sound.items() if not values.all()]
    if bad:
        row = int((~sound[bad[0]]).nonzero()[0][0]) + 1
        why = " ".join(problem.explain(theta)) or "these inputs lie outside the forward model's range"
        raise InputError(f"{model}: {bad[0]} has no finite value at row {row}: {why}")
    for note in problem.explain(theta):
        click.echo(f"note: {note}", err=True)
    parameters: dict[str, Any] = dict(zip(problem.names, theta.tolist(), strict=True))
    for p in problem.fixed:
        given_as_none = settings.get(p.name, "").lower() == "none"
        parameters[p.label] = None if given_as_none else p.value
    columns: dict[str, Any] = {**problem.conditions.values, **problem.conditions.labels}
    if as_json:
        print_json({
            "model": problem.name, "parameters": parameters, "conditions": columns, "prediction": prediction,
        })  # fmt: skip
        return
    _print(problem, theta, columns, prediction)


def _print(problem: Any, theta: Any, columns: dict[str, Any], prediction: dict[str, Any]) -> None:
    from skinbayes.units import format_quantity
    from skinbayes.vocabulary import QUANTITIES

    def text(name: str, value: Any) -> str:
        quantity = QUANTITIES.get(name)
        return (
            str(value)
            if isinstance(value, str)
            else format_quantity(float(value), quantity.unit if quantity else "1")
        )

    values = [(p.label, text(p.name, v), "prior median") for p, v in zip(problem.free, theta, strict=True)]
    values += [(p.label, text(p.name, p.value), p.source) for p in problem.fixed]
    print_table(("input", "value", "from"), values)
    headers = [*columns, *prediction]
    cells = [
        [text(name, values[i]) for name, values in (*columns.items(), *prediction.items())]
        for i in range(problem.conditions.n_rows)
    ]
    print_table(headers, cells, right=range(len(columns), len(headers)))
