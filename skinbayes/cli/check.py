"""``check``: what can be said before sampling."""

from __future__ import annotations

import click

from skinbayes.cli.options import data_of, data_option, json_option, model_argument
from skinbayes.cli.output import print_json, print_sentences, say


@click.command()
@model_argument
@data_option
@json_option
def check(model: str, given: tuple[str, ...], as_json: bool) -> None:
    """Check a model, and what its data can tell, before sampling.

    In words: units, priors, predictions, and which data identify which parameters.
    """
    from skinbayes.problem.load import load_any_problem

    result = load_any_problem(model, data_of(model, given)).check()
    if as_json:
        print_json(result.to_dict())
        return
    for title, sentences in result.sections():
        print_sentences(sentences, title)
        say()
