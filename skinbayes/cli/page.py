"""Write the page of a run, with the baseline models that its model names."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from skinbayes.errors import InputError

if TYPE_CHECKING:
    from skinbayes.comparison import AgainstBaselines
    from skinbayes.fit import Fit, JointFit
    from skinbayes.fit.left_out import LeftOutExperiment


MARK = b'<meta name="generator" content="skinbayes">'
"""By which a page of skinbayes is known, near its beginning."""


def refuse_other_files(page: Path) -> None:
    """InputError if there is no folder for a page, or something else than a page of skinbayes stands in its place."""
    if not page.parent.is_dir():
        raise InputError(f"{page}: there is no folder {page.parent}; expected one to write the page into")
    if page.is_dir():
        raise InputError(f"{page}: a folder; expected the name of a page to write, such as report.html")
    if (
        page.is_file() and page.stat().st_size
    ):  # without a size it holds nothing, or is of those that never end
        with page.open("rb") as file:
            if MARK in file.read(1000):
                return
    if page.exists() or page.is_symlink():
        raise InputError(f"{page}: exists already and is no page of skinbayes; choose another name")


def write_page(
    fit: Fit | JointFit,
    page: Path,
    run: Path | None,
    with_baselines: bool = True,
    left_out: Sequence[LeftOutExperiment] | None = None,
) -> AgainstBaselines | None:
    """Write the page of a fit; models without theory that its model file names are fitted before, unless that was done.

    Parameters
    ----------
    fit : the fit
    page : the file to write
    run : the run directory, in which the fits of baseline models are kept; None keeps nothing
    with_baselines : False leaves them out
    left_out : of several experiments, what leaving out each found

    Returns
    -------
    Baseline models or None
        The fit beside its baseline models, if it has any

    Raises
    ------
    InputError
        Something else stands under the name of the page.
    """
    from skinbayes.cli.progress import named_progress
    from skinbayes.comparison import against_baselines
    from skinbayes.fit import Fit
    from skinbayes.report import write_report

    refuse_other_files(page)
    baseline_models = None
    if with_baselines and isinstance(fit, Fit) and fit.problem and fit.problem.spec.baseline_models:
        with named_progress("baseline model") as progress:
            baseline_models = against_baselines(fit, run, progress)
    write_report(fit, page, baseline_models, left_out)
    return baseline_models
