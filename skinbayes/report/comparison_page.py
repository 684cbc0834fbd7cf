"""The page about a comparison: which model is ahead and by what, and each beside the data."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from skinbayes.comparison.tables import EXPLAINED, comparison_tables
from skinbayes.comparison.verdicts import AHEAD
from skinbayes.fit.joint_fit import JointFit
from skinbayes.phrases import and_list
from skinbayes.plot.comparison import plot_comparison
from skinbayes.report import opening, quality
from skinbayes.report.drawings import Drawing, drawings
from skinbayes.report.figures import picture
from skinbayes.report.origin import data_origin
from skinbayes.report.rendering import rendered, write_whole

if TYPE_CHECKING:
    from skinbayes.comparison import Comparison
    from skinbayes.fit import Fit

SHOWN = ("data", "predictive", "discrepancy", "residuals")
"""Keys of the figures that show a model beside its data; the second only without the first."""

BEHIND = Drawing(
    "ahead", plot_comparison, "How far each model is behind the best one",
    "A panel for each measure, with a dot for each model at its difference to the best.",
    "Differences of ln densities; 0 is the best model of a panel, and a model at −1 gives what happened a probability e times "
    "smaller. Bars are one standard error either way: from the sampler for the evidence, from datum to datum or group to group "
    "for predictions. Panels ask different questions and need not agree.",
)  # fmt: skip


def write_comparison(comparison: Comparison, fits: Sequence[Fit | JointFit], path: Path) -> Path:
    """Write one self-contained HTML page about a comparison.

    Parameters
    ----------
    comparison : of the fits
    fits : what was compared, in any order
    path : the file to write

    Returns
    -------
    Path
        The file written.

    Raises
    ------
    InputError
        The folder does not exist or cannot be written.
    MachineError
        The disk is full.
    """
    return write_whole(Path(path), rendered("comparison.html", _context(comparison, fits)))


def _context(comparison: Comparison, fits: Sequence[Fit | JointFit]) -> dict[str, Any]:
    left, ordered = list(fits), []
    for model in comparison.models:  # two may have one name
        ordered.append(left.pop([fit.name for fit in left].index(model.name)))
    first = ordered[0]
    data = [
        data_origin(one) for one in (first.experiments.values() if isinstance(first, JointFit) else [first])
    ]
    said = comparison.statements()
    return {
        "title": f"{and_list([fit.name for fit in ordered]) if len(ordered) < 4 else f'{len(ordered)} models'} compared",
        "converged": comparison.converged,
        "unfinished": [model.name for model in comparison.models if not model.converged],
        "question": f"Which of {len(ordered)} models do these {comparison.rows} data prefer?",
        "answers": [one.text for one in said if one.kind == AHEAD],
        "cautions": [one.text for one in said if one.kind != AHEAD],
        "tables": comparison_tables(comparison),
        "explained": EXPLAINED,
        "ahead": picture(comparison, BEHIND),
        "models": [_model(fit) for fit in ordered],
        "data": data,
        "references": list(dict.fromkeys(reference for fit in ordered for reference in fit.cite())),
    }


def _model(fit: Fit | JointFit) -> dict[str, Any]:
    """A model by itself: what it says, whether it fits, and its figures beside the data."""
    whole = fit.together if isinstance(fit, JointFit) else fit
    parts = list(fit.experiments.items()) if isinstance(fit, JointFit) else [("", fit)]
    fits = [f"{name}: {' '.join(quality.verdict(one))}".removeprefix(": ") for name, one in parts]
    figures = []
    for name, one in parts:
        drawn = {drawing.key: drawing for drawing in drawings(one) if drawing.key in SHOWN}
        if "data" in drawn:
            del drawn["predictive"]
        figures += [
            picture(one, drawing) | {"key": "-".join(filter(None, (fit.name, name, drawing.key)))}
            for drawing in drawn.values()
        ]
    return {
        "name": fit.name,
        "title": str(fit.provenance["title"]),
        "description": str(fit.provenance["description"]),
        "answer": opening.answer(whole).partition("; ")[0].removesuffix(".") + ".",
        "fits": fits,
        "misfit": any(quality.misfit(one) for _, one in parts),
        "sampling": quality.sampling(whole),
        "pictures": figures,
        "model_text": str(fit.provenance["model_text"]),
    }
