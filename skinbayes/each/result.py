"""What many fits of one model say, each of its own data."""

from __future__ import annotations

import io
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.errors import InputError

if TYPE_CHECKING:
    import pandas

DRAWS = "draws"
"""Folder of the posterior draws inside the folder of the fits."""

TABLE = "results.csv"
"""File of the result table there."""

RUNS = "runs"
"""Folder of run directories there."""

ENDS = ("", "_q05", "_q95")
"""What follows the name of a quantity in the table: its median, and the ends of the 90 % interval."""


@dataclass(frozen=True)
class OneFit:
    """What became of one of the fits.

    Attributes
    ----------
    name : of the data: label, file or line
    fingerprint : of the problem; data or priors that were changed are fitted again
    rows : how many there are
    seed : of this fit alone: with it :func:`skinbayes.sample` gives the same draws
    converged : whether the stopping rule was met
    verdict : the sentence on it
    failure : the error that it ended with, empty if there was none
    quantities : label to 5 %, 50 % and 95 % quantile, SI; parameters, and derived quantities that all rows share
    units : label to SI unit
    log_evidence : ln Z with its standard error, None if it is not known
    ess_bulk, r_hat : the smallest effective sample size and the largest R-hat of the parameters, None if not known
    evaluations : of the likelihood
    seconds : of one processor
    file : name, without ending, under which draws and run directory are kept
    """

    name: str
    fingerprint: str
    rows: int
    seed: int
    converged: bool = False
    verdict: str = ""
    failure: str = ""
    quantities: dict[str, list[float]] = field(default_factory=dict)
    units: dict[str, str] = field(default_factory=dict)
    log_evidence: list[float] | None = None
    ess_bulk: float | None = None
    r_hat: float | None = None
    evaluations: int | None = None
    seconds: float = 0.0
    file: str = ""

    def to_dict(self) -> dict[str, Any]:
        """What JSON can hold."""
        return asdict(self)

    @classmethod
    def from_dict(cls, entry: Mapping[str, Any]) -> OneFit:
        """The inverse of :meth:`to_dict`."""
        return cls(**entry)


@dataclass(frozen=True, repr=False)
class EachFit:
    """Many fits of one model.

    Attributes
    ----------
    model : its name
    fits : what became of each, in the order of the data
    directory : where they are kept, or None
    kept : draws by name, where there is no directory

    Examples
    --------
    Examples of methods go on from this one.

    >>> import skinbayes as sb
    >>> data = {"person": ["A", "A", "B", "B"], "friction_coefficient": [0.4, 0.5, 0.8, 0.9]}
    >>> problem = sb.build_problem(
    ...     "constant", data, parameters={"typical_friction_coefficient": {"uniform": [0, 2]}},
    ...     noise={"family": "gaussian", "noise_scale": 0.1},
    ... )  # fmt: skip
    >>> fits = sb.fit_each(sb.problems_of_each(problem, column="person"), ess=400)
    """

    model: str
    fits: tuple[OneFit, ...]
    directory: Path | None = None
    kept: Mapping[str, Mapping[str, FloatArray]] = field(default_factory=dict)

    def __repr__(self) -> str:
        return f"<{self.model}: {self.sentence()}>"

    @property
    def converged(self) -> bool:
        """Whether all of them met their stopping rule."""
        return all(one.converged for one in self.fits)

    def sentence(self) -> str:
        """How many converged, and what became of the others.

        Examples
        --------
        >>> fits.sentence()
        '2 fits: all converged.'
        """
        failed = sum(bool(one.failure) for one in self.fits)
        open_ = sum(not one.converged and not one.failure for one in self.fits)
        count = f"{len(self.fits):,} fit{'s' if len(self.fits) > 1 else ''}"
        if not failed and not open_:
            return f"{count}: all converged."
        parts = [f"{len(self.fits) - failed - open_} converged"]
        parts += [f"{open_} did not converge"] if open_ else []
        parts += [f"{failed} ended in an error"] if failed else []
        return f"{count}: {', '.join(parts)}."

    def table(self) -> pandas.DataFrame:
        """The result table: a line for each fit.

        Returns
        -------
        pandas.DataFrame
            Index: name. Columns: ``rows``, ``converged``, ``failure``; of each parameter and derived quantity the median under
            its name, and the ends of its 90 % interval under the name with ``_q05`` and ``_q95`` (SI); ``log_evidence``,
            ``log_evidence_error``, ``ess_bulk``, ``r_hat``, ``evaluations``, ``seconds``, ``seed``, ``verdict``. What a
            fit does not have is nan.

        Examples
        --------
        >>> fits.table().loc["B", "typical_friction_coefficient"].round(1).item()
        0.8
        """
        import pandas

        units = self.units()
        lines = {}
        for one in self.fits:
            line: dict[str, Any] = {"rows": one.rows, "converged": one.converged, "failure": one.failure}
            for label in units:
                low, middle, high = one.quantities.get(label, (np.nan,) * 3)
                line |= dict(zip((label + end for end in ENDS), (middle, low, high), strict=True))
            value, error = one.log_evidence or (np.nan, np.nan)
            line |= {"log_evidence": value, "log_evidence_error": error}
            line |= {
                key: np.nan if found is None else found
                for key, found in (
                    ("ess_bulk", one.ess_bulk),
                    ("r_hat", one.r_hat),
                    ("evaluations", one.evaluations),
                )
            }
            lines[one.name] = line | {"seconds": one.seconds, "seed": one.seed, "verdict": one.verdict}
        return pandas.DataFrame.from_dict(lines, orient="index").rename_axis("name")

    def units(self) -> dict[str, str]:
        """SI unit of each quantity of the table.

        Examples
        --------
        >>> fits.units()
        {'typical_friction_coefficient': '1'}
        """
        return {label: unit for one in self.fits for label, unit in one.units.items()}

    def to_csv(self) -> str:
        """The table as CSV, with units in the header.

        Examples
        --------
        >>> fits.to_csv().splitlines()[0][:64]
        'name,rows,converged,failure,typical_friction_coefficient [1],typ'
        """
        table, units = self.table(), self.units()
        headers = {label + end: f"{label}{end} [{unit}]" for label, unit in units.items() for end in ENDS}
        text = io.StringIO()
        table.rename(columns=headers).to_csv(text, lineterminator="\n", float_format="%.8g")
        return text.getvalue()

    def draws(self, name: str) -> dict[str, FloatArray]:
        """Posterior draws of one of the fits.

        Parameters
        ----------
        name : of its data

        Returns
        -------
        dict
            Parameter to draws of equal weight, SI.

        Raises
        ------
        InputError
            There is no such fit, it ended in an error, or its draws were not kept.

        Examples
        --------
        >>> fits.draws("A")["typical_friction_coefficient"].shape
        (1000,)
        """
        one = next((one for one in self.fits if one.name == name), None)
        if one is None:
            raise InputError(
                f"no fit of {name!r}; there are those of {', '.join(one.name for one in self.fits[:20])}"
            )
        if one.failure:
            raise InputError(f"{name}: the fit ended in an error: {one.failure}")
        if name in self.kept:
            return dict(self.kept[name])
        file = None if self.directory is None else self.directory / DRAWS / f"{one.file}.npz"
        if file is None or not file.is_file():
            raise InputError(f"{name}: no draws were kept of this fit")
        with np.load(file, allow_pickle=False) as stored:
            return dict(stored)
