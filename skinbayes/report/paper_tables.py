"""Tables of a fit for a paper: parameters, derived quantities, fixed values and predictions as CSV, LaTeX and Markdown."""

from __future__ import annotations

import csv
import io
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from skinbayes.errors import InputError
from skinbayes.fit.joint_fit import JointFit
from skinbayes.fit.predicted import observables, observed_values
from skinbayes.phrases import number
from skinbayes.plot.numbers import prefix_of
from skinbayes.plot.predictive import datum_names, predictive_quantiles
from skinbayes.plot.style import NOT_CONVERGED
from skinbayes.plot.symbols import spoken_name
from skinbayes.report import tables
from skinbayes.report.latex import latex_symbol, latex_text, markdown_text
from skinbayes.vocabulary import lookup, suggestions

if TYPE_CHECKING:
    from skinbayes.fit import Fit

TABLES = {
    "parameters": "free parameters with symbol, unit, prior, median and 90 % interval",
    "derived": "quantities that follow from them, and what is known of each person",
    "fixed": "values that were not inferred, with their sources",
    "predictions": "each datum beside what the fitted model predicts of it, scatter included",
}
"""Tables of a fit, and what is in them."""

FORMATS = ("csv", "latex", "markdown")


@dataclass(frozen=True)
class PaperTable:
    """One table.

    Attributes
    ----------
    headers, cells : as people read them, numbers rounded and in a unit that suits them
    right : columns of numbers
    symbols : columns of symbols
    columns, values : as programs read them, SI and not rounded
    note : what a reader must know, such as that the fit has not converged
    """

    headers: Sequence[str]
    cells: list[list[str]]
    right: tuple[int, ...]
    symbols: tuple[int, ...]
    columns: Sequence[str]
    values: list[list[object]]
    note: str = ""

    def text(self, form: str) -> str:
        """The table in one of :data:`FORMATS`."""
        return {"csv": self._csv, "latex": self._latex, "markdown": self._markdown}[form]()

    def _csv(self) -> str:
        buffer = io.StringIO()
        writer = csv.writer(buffer, lineterminator="\n")
        writer.writerow(self.columns)
        writer.writerows([repr(v) if isinstance(v, float) else v for v in row] for row in self.values)
        return buffer.getvalue()

    def _markdown(self) -> str:
        rule = ["---:" if i in self.right else "---" for i in range(len(self.headers))]
        rows = [[markdown_text(cell) for cell in row] for row in [list(self.headers), *self.cells]]
        lines = [f"| {' | '.join(row)} |" for row in [rows[0], rule, *rows[1:]]]
        return "\n".join([*([f"**{markdown_text(self.note)}**", ""] if self.note else []), *lines, ""])

    def _latex(self) -> str:
        def line(row: Sequence[str]) -> str:
            cells = [latex_symbol(c) if i in self.symbols else latex_text(c) for i, c in enumerate(row)]
            # a row that begins with a bracket would be read as an argument of the line break before it
            return rf"  {'{}' if cells[0][:1] in ('[', '*') else ''}{' & '.join(cells)} \\"

        kinds = "".join("r" if i in self.right else "l" for i in range(len(self.headers)))
        lines = [
            "% needs \\usepackage{booktabs}", rf"\begin{{tabular}}{{@{{}}{kinds}@{{}}}}", r"  \toprule",
            line(self.headers), r"  \midrule", *map(line, self.cells), r"  \bottomrule", r"\end{tabular}",
        ]  # fmt: skip
        if self.note:
            lines.append(rf"\par\textbf{{{latex_text(self.note)}}}")
        return "\n".join([*lines, ""])


def paper_table(fit: Fit, name: str) -> PaperTable:
    """A table of a fit by its name, one of :data:`TABLES`."""
    makers: dict[str, Callable[[Fit], PaperTable]] = {
        "parameters": _parameters, "derived": _derived, "fixed": _fixed, "predictions": _predictions,
    }  # fmt: skip
    return makers[name](fit)


def _note(fit: Fit) -> str:
    return "" if fit.converged else f"{NOT_CONVERGED}: these numbers are not final."


def _shown(low: float, median: float, high: float, unit: str) -> tuple[str, str, str]:
    """Unit, median and interval in that unit."""
    factor, name = prefix_of(median, unit)
    if not high - low > 1e-6 * max(abs(low), abs(high)):
        return name, number(median / factor), "hardly varies"
    return name, number(median / factor), f"{number(low / factor)} to {number(high / factor)}"


def _parameters(fit: Fit) -> PaperTable:
    cells, values = [], []
    summary = fit.summary()
    extra = [name for name in ("ess_bulk", "r_hat") if name in summary.columns]
    for index, row in summary.iterrows():
        label, unit = str(index), str(row["unit"])
        prior = fit.provenance["priors"][label]
        low, median, high = (float(row[key]) for key in ("q05", "median", "q95"))
        shown, middle, ends = _shown(low, median, high, unit)
        symbol = fit.symbol(label)
        cells.append([spoken_name(label), symbol, shown, str(prior["text"]), middle, ends])
        values.append(
            [label, symbol, unit, str(prior["text"]), str(prior["source"]), median, low, high]
            + [float(row[key]) for key in extra]
        )  # fmt: skip
    return PaperTable(
        ("Parameter", "Symbol", "Unit", "Prior", "Median", "90 % interval"), cells, (4, 5), (1,),
        ("parameter", "symbol", "unit", "prior", "prior_source", "median", "q05", "q95", *extra), values, _note(fit),
    )  # fmt: skip


def _derived(fit: Fit) -> PaperTable:
    cells: list[list[str]] = []
    values: list[list[object]] = []
    for label in (*fit.people_labels(), *fit.derived_labels()):
        low, median, high = (float(q) for q in fit.quantiles(label))
        unit, symbol = fit.unit(label), fit.symbol(label)
        shown, middle, ends = _shown(low, median, high, unit)
        cells.append([spoken_name(label), symbol, shown, middle, ends])
        values.append([label, symbol, unit, median, low, high])
    return PaperTable(
        ("Quantity", "Symbol", "Unit", "Median", "90 % interval"), cells, (3, 4), (1,),
        ("quantity", "symbol", "unit", "median", "q05", "q95"), values, _note(fit),
    )  # fmt: skip


def _fixed(fit: Fit) -> PaperTable:
    cells = [[row["name"], row["symbol"], row["value"], row["source"]] for row in tables.fixed_rows(fit)]
    values: list[list[object]] = []
    for label, entry in (fit.provenance["fixed"] | fit.provenance.get("tied", {})).items():
        known = lookup(label.partition("[")[0])
        value: object = str(entry["text"]) if "text" in entry else float(entry["value"])
        values.append(
            [
                label,
                known.symbol if known else label,
                known.unit if known else "1",
                value,
                str(entry["source"]),
            ]
        )
    return PaperTable(
        ("Quantity", "Symbol", "Value", "Source"), cells, (2,), (1,), ("quantity", "symbol", "unit", "value", "source"), values
    )  # fmt: skip


def _predictions(fit: Fit) -> PaperTable:
    names = observables(fit)
    observed, expected = observed_values(fit), predictive_quantiles(fit)[[0, 2, 4]]
    rows = len(observed) // len(names)
    cells: list[list[str]] = []
    values: list[list[object]] = []
    for i, (datum, value) in enumerate(zip(datum_names(fit), observed.tolist(), strict=True)):
        known = lookup(names[i // rows])
        unit = known.unit if known else "1"
        low, median, high = (float(q) for q in expected[:, i])
        shown, middle, ends = _shown(low, median, high, unit)
        factor = prefix_of(median, unit)[0] if np.isfinite(median) else 1.0
        cells.append([datum, shown, number(value / factor), middle, ends])
        values.append([datum, names[i // rows], unit, value, median, low, high])
    return PaperTable(
        ("Datum", "Unit", "Observed", "Predicted", "90 % interval"), cells, (2, 3, 4), (),
        ("datum", "observable", "unit", "observed", "median", "q05", "q95"), values, _note(fit),
    )  # fmt: skip


def chosen_table(fit: Fit | JointFit, name: str) -> PaperTable:
    """A table by its name; of one of several experiments ``EXPERIMENT.NAME``.

    Raises
    ------
    InputError
        There is no such table.
    """
    fits: dict[str, tuple[Fit, str]] = {}
    if isinstance(fit, JointFit):
        fits = {kind: (fit.together, kind) for kind in ("parameters", "fixed")}
        for experiment, one in fit.experiments.items():
            fits |= {f"{experiment}.{kind}": (one, kind) for kind in ("derived", "fixed", "predictions")}
    else:
        fits = {kind: (fit, kind) for kind in TABLES}
    if name not in fits:
        raise InputError(
            f"no table {name[:80]!r} of this run.{suggestions(name[:80], list(fits))} It has: {', '.join(fits)}"
        )
    return paper_table(*fits[name])
