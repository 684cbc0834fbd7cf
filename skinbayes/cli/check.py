"""``check``: what can be said before sampling."""

from __future__ import annotations

import click

from skinbayes.cli.options import data_option, json_option, model_argument
from skinbayes.cli.output import print_json, print_sentences, say


@click.command()
@model_argument
@data_option
@json_option
def check(model: str, data: str | None, as_json: bool) -> None:
    """Check a model, and what its data can tell, before sampling.

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
