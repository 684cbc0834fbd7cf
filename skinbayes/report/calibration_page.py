"""The page about a calibration: the verdict, the pictures that show it, and the numbers."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from skinbayes.calibration import OddsCalibration
from skinbayes.phrases import number
from skinbayes.plot.calibration import plot_coverage, plot_ecdf, plot_odds, plot_ranks, plot_recovery
from skinbayes.report.drawings import Drawing
from skinbayes.report.figures import drawn
from skinbayes.report.rendering import rendered, write_whole

if TYPE_CHECKING:
    from skinbayes.calibration import Calibration

RANKS = (
    Drawing(
        "ecdf", plot_ecdf, "Distribution of the ranks less the uniform one",
        "A panel for each parameter and one for the likelihood of all data: a curve about zero, with a shaded band.",
        "If the pipeline is calibrated, the whole curve keeps to the shaded band with probability 95 % (Säilynoja, Bürkner and "
        "Vehtari 2022, 10.1007/s11222-022-10090-6). Above zero in the left half and below in the right: the posterior is too "
        "narrow; the other way round: too wide; all above: true values are lower than the posterior says; all below: higher. A "
        "dashed curve leaves out fits that did not converge.",
    ),
    Drawing(
        "ranks", plot_ranks, "Ranks of the truth",
        "A histogram for each parameter and one for the likelihood of all data.",
        "Bars are level if the truth is a draw of the posterior like any other; 99 % of single bars then end in the shaded band. "
        "High in the middle: posterior too wide; high at both ends: too narrow; a slope: off to one side.",
    ),
    Drawing(
        "coverage", plot_coverage, "Do intervals hold the truth?",
        "A panel for 50 % and one for 90 % intervals, with a dot for each parameter and its level as a line.",
        "Share of the central intervals of the results that hold the value which the data were made with; bars are binomial 95 % "
        "intervals.",
    ),
    Drawing(
        "recovery", plot_recovery, "What was learnt, and how far off it was",
        "A panel for each parameter with a dot for each simulation.",
        "Upwards the posterior mean less the truth over the posterior standard deviation: mostly within ±2, and about zero. "
        "To the right how much of the prior variance the data removed: near 0 they say nothing about the parameter, near 1 all. "
        "Parameters on the scale where they have no bounds.",
    ),
)  # fmt: skip

ODDS = (
    Drawing(
        "odds", plot_odds, "Probability against frequency",
        "Dots with bars beside a diagonal line.",
        "Data were drawn from both models, as often from one as from the other. Each dot holds the simulations with about the "
        "same probability of the second model, and how often that had made the data; on the line it is right as often as it "
        "says. Bars are binomial 95 % intervals; numbers are those of simulations.",
    ),
)  # fmt: skip


def write_calibration(calibration: Calibration | OddsCalibration, path: Path) -> Path:
    """Write one self-contained HTML page about a calibration.

    Parameters
    ----------
    calibration : from :func:`skinbayes.calibrate`
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
    context = _odds(calibration) if isinstance(calibration, OddsCalibration) else _ranks(calibration)
    shared = {
        "converged": True,
        "passed": calibration.passed(),
        "answer": calibration.sentence(),
        "failed": calibration.failed,
        "count": len(calibration.simulations),
        "seed": calibration.seed,
    }
    return write_whole(Path(path), rendered("calibration.html", context | shared))


def _ranks(calibration: Calibration) -> dict[str, Any]:
    ended = any(one.ranks for one in calibration.simulations)
    return {
        "title": f"Is {calibration.name} calibrated?",
        "question": "Is the truth a draw of the posterior like any other, when data are made from the model itself?",
        "pictures": [drawn(calibration, drawing) for drawing in RANKS] if ended else [],
        "headers": HEADERS,
        "rows": table_rows(calibration),
        "remarks": remarks(calibration),
    }


def _odds(calibration: OddsCalibration) -> dict[str, Any]:
    first, second = calibration.models
    return {
        "title": f"Are the probabilities of {first} and {second} right?",
        "question": "Is each of two models right as often as its posterior probability says?",
        "pictures": [drawn(calibration, drawing) for drawing in ODDS],
        "headers": ODDS_HEADERS,
        "rows": odds_rows(calibration),
        "remarks": [ODDS_EXPLAINED, *_p_sentences(calibration)],
    }


HEADERS = (
    "quantity",
    "p",
    "p, converged only",
    "50 % interval",
    "90 % interval",
    "mean z",
    "sd of z",
    "contraction",
)
ODDS_HEADERS = ("mean probability", "frequency", "right", "of", "p")

EXPLAINED = (
    "p is the probability that the ranks of a calibrated pipeline stray as far somewhere; the verdict takes the smallest of them "
    "times their number, so that one calibrated model in twenty is doubted. Columns of intervals are the shares of simulations "
    "whose interval holds the truth."
)
ODDS_EXPLAINED = (
    "Three tests. count: the model preferred made the data as often as its probabilities add up to. size: odds are neither too "
    "bold nor too shy. average: over data of both models the mean probability is that before the data, one half "
    "(10.1037/met0000472)."
)


def table_rows(calibration: Calibration) -> list[list[str]]:
    """The table of all quantities that are ranked, as text."""
    shown = [
        "p", "p_converged", "coverage_50", "coverage_90", "z_mean", "z_sd", "contraction",
    ]  # fmt: skip
    table = calibration.summary().reindex(columns=shown)
    rows = []
    for name, values in table.iterrows():
        p, sure, half, most, *others = (float(value) for value in values)
        rows.append(
            [
                str(name),
                *(_p(x) for x in (p, sure)),
                *(_share(x) for x in (half, most)),
                *(_plain(x) for x in others),
            ]
        )
    return rows


def odds_rows(calibration: OddsCalibration) -> list[list[str]]:
    """The table of bins, as text."""
    return [
        [f"{probability:.3f}", f"{frequency:.3f}", str(hits), str(count), _p(p)]
        for probability, frequency, hits, count, p in calibration.bins()
    ]


def remarks(calibration: Calibration) -> list[str]:
    """What is to be said beside the table: how to read it, ln Z, errors, draws that could not be predicted."""
    said = [EXPLAINED]
    scores = calibration.evidence_scores()
    if len(scores):
        said.append(
            f"ln Z: of {len(scores)} simulations it was compared with the mean likelihood of 20,000 draws of the prior; the "
            f"difference over both standard errors has mean {_plain(float(scores.mean()))} and standard deviation "
            f"{_plain(float(scores.std()))}, 0 and 1 being right (p {_p(calibration.evidence_p_value())})."
        )
    said += [f"{count} fits ended in: {error}" for error, count in calibration.errors.items()]
    again = sum(one.again for one in calibration.simulations)
    if again:
        share = again / (again + len(calibration.simulations))
        said.append(
            f"For {100 * share:.0f} % of the draws of the prior the forward model cannot predict the data; the posterior gives "
            "them no weight, and no data were made with them."
        )
    return said


def _p_sentences(calibration: OddsCalibration) -> list[str]:
    return [f"{name}: p {_p(value)}" for name, value in calibration.p_values().items()]


def _p(value: float) -> str:
    return "" if value != value else "< 0.0001" if value < 1e-4 else number(value, 2)


def _share(value: float) -> str:
    return "" if value != value else f"{value:.3f}"


def _plain(value: float) -> str:
    return "" if value != value else f"{value:.2f}".replace("-", "−")
