"""What has to be said beside the numbers of a fit, in the words of its page."""

from __future__ import annotations

from typing import TYPE_CHECKING

from skinbayes.phrases import and_list
from skinbayes.plot.updates import fit_updates
from skinbayes.report import quality, sentences
from skinbayes.report.opening import is_scatter
from skinbayes.report.people import people_sentences

if TYPE_CHECKING:
    from skinbayes.fit import Fit


def remarks(fit: Fit) -> list[str]:
    """Whether the model fits, where data and prior disagree, about what only the prior speaks, and how sampling went.

    Parameters
    ----------
    fit : any fit

    Returns
    -------
    sentences, parameters by their names
    """
    silent = [
        label
        for label, update in fit_updates(fit).items()
        if update.verdict == "not updated" and not is_scatter(label)
    ]
    said = [" ".join(quality.verdict(fit)), *people_sentences(fit), *sentences.disagreements(fit)]
    if silent:
        said.append(f"Only the prior speaks about {and_list(silent)}.")
    said += sentences.open_ends(fit)
    said.append(str(fit.provenance["sampling"]["verdict"]))
    if note := quality.more_than_kept(fit):
        said.append(note)
    return said
