"""``check``: what can be said before sampling."""

from __future__ import annotations

import click

from skinbayes.cli.output import json_option, print_json, print_sentences, say


@click.command()
@click.argument("model")
@click.option("--data", metavar="FILE.csv", help="Your own data instead of the model's.")
@json_option
def check(model: str, data: str | None, as_json: bool) -> None:
    """Check a model before sampling: priors, and what the data tell.

    In words: units, priors, predictions, and which data identify which parameters.
    """
    from skinbayes.problem import load_problem

    result = load_problem(model, data=data).check()
    if as_json:
        print_json(result.to_dict())
        return
    for title, sentences in result.sections():
        print_sentences(sentences, title)
        say()
