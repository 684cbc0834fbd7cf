"""The methods paragraph of a paper, from what a fit stores: nothing in it that is not so of this fit."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from skinbayes.fit.joint_fit import JointFit
from skinbayes.fit.predicted import observables, observed_values
from skinbayes.fit.references import METHODS
from skinbayes.phrases import and_list, plural, row_count
from skinbayes.plot.discrepancy import curves_of
from skinbayes.plot.rows import group_columns
from skinbayes.plot.style import NOT_CONVERGED
from skinbayes.plot.symbols import spoken_name
from skinbayes.report import quality, tables
from skinbayes.report.latex import latex_text, markdown_text
from skinbayes.report.opening import data_name

if TYPE_CHECKING:
    from skinbayes.fit import Fit

FORMATS = ("text", "markdown", "latex", "bibtex")


@dataclass(frozen=True)
class Cited:
    """Works cited at a place of the text, by their keys."""

    keys: tuple[str, ...]


Paragraph: TypeAlias = tuple[str, list[str | Cited]]
"""Its name and its pieces."""


def methods_text(fit: Fit | JointFit, form: str = "text") -> str:
    """The methods of a fit as a text for a paper.

    Parameters
    ----------
    fit : a fit of one experiment or several
    form : ``"text"`` with numbered references, ``"markdown"`` with pandoc's citations, ``"latex"`` with ``\\cite``, or
        ``"bibtex"``: the entries that these refer to
    """
    if form == "bibtex":
        return "\n\n".join(fit.cite("bibtex")) + "\n"
    order = [str(entry["key"]) for entry in fit.provenance["references"]]
    paragraphs = list(_paragraphs(fit, order))
    if form == "latex":
        return "".join(
            rf"\paragraph{{{name}}} {_joined(pieces, latex_text, _latex_cite)}" + "\n\n"
            for name, pieces in paragraphs
        )
    if form == "markdown":
        told = [
            f"**{name}.** {_joined(pieces, markdown_text, _markdown_cite)}" for name, pieces in paragraphs
        ]
        return "\n\n".join(told) + "\n"

    def numbered(cited: Cited) -> str:
        return f" [{', '.join(str(order.index(key) + 1) for key in cited.keys)}]"

    told = [
        f"{name}. {_joined(pieces, lambda text: ' '.join(text.split()), numbered)}"
        for name, pieces in paragraphs
    ]
    listed = [f"[{i}] {' '.join(text.split())}" for i, text in enumerate(fit.cite(), 1)]
    return "\n\n".join([*told, "References", "\n".join(listed)]) + "\n"


def _joined(pieces: Sequence[str | Cited], written: Any, cite: Any) -> str:
    parts = [cite(piece) if isinstance(piece, Cited) else _spaced(piece, written) for piece in pieces]
    return "".join(parts).strip()


def _spaced(text: str, written: Any) -> str:
    """Text as the format writes it, with the blanks at its ends."""
    return (
        f"{' ' if text[:1] == ' ' else ''}{written(text)}{' ' if text[-1:] == ' ' and text.strip() else ''}"
    )


def _latex_cite(cited: Cited) -> str:
    return rf"~\cite{{{','.join(cited.keys)}}}"


def _markdown_cite(cited: Cited) -> str:
    return f" [{'; '.join(f'@{key}' for key in cited.keys)}]"


def _paragraphs(fit: Fit | JointFit, order: list[str]) -> Iterator[Paragraph]:
    whole = fit.together if isinstance(fit, JointFit) else fit
    experiments = list(fit.experiments.items()) if isinstance(fit, JointFit) else [("", fit)]
    if not fit.converged:
        yield NOT_CONVERGED, ["The sampler has not converged; what follows is not to be published."]
    for name, one in experiments:
        yield (f"Data ({name})" if name else "Data"), _data(one, order)
    for name, one in experiments:
        yield (f"Model ({name})" if name else "Model"), _model(one)
    yield "Theory", _theory(fit, order)
    yield "Priors", _priors(whole)
    for name, one in experiments:
        yield (f"Scatter ({name})" if name else "Scatter"), _scatter(one)
    yield "Sampling", _sampling(whole, order)
    for name, one in experiments:
        yield (f"Agreement ({name})" if name else "Agreement"), [" ".join(quality.verdict(one))]
    yield "Software", _software(fit, order)


def _cited(order: Sequence[str], wanted: Sequence[str]) -> list[str | Cited]:
    keys = tuple(key for key in wanted if key in order)
    return [Cited(keys)] if keys else []


def _data(fit: Fit, order: list[str]) -> list[str | Cited]:
    count, rows = len(observed_values(fit)), fit.groups["observed_data"].sizes["row"]
    listed = and_list([spoken_name(name) for name in observables(fit)])
    said = f"The data are {'one value' if count == 1 else f'{count} values'} of {listed} in {row_count(rows)}"
    name, known = data_name(fit), fit.provenance["data"]
    said += f" of {name}" if name else ""
    title = str(known.get("origin", {}).get("title") or "")
    pieces: list[str | Cited] = [said + (f" ({title})" if title else "")]
    key = _data_key(fit, order)
    pieces += [Cited((key,))] if key else []
    labels = [
        f"{len(set(np.asarray(column.values).astype(str).tolist()))} {spoken_name(plural(str(column_name)))}"
        for column_name, column in fit.groups.get("constant_data", {}).items()
        if column.dtype.kind not in "fiub" and str(column_name) != "row_label" and column.size > 1
        if len(set(np.asarray(column.values).astype(str).tolist())) > 1
    ]
    pieces.append(f", of {and_list(labels)}" if labels else "")
    sha = str(known.get("sha256", ""))
    pieces.append(f". The sha256 of the file begins with {sha[:12]}." if sha else ".")
    return pieces


def _data_key(fit: Fit, order: list[str]) -> str:
    """Key of the source of the data of an experiment; empty if none is cited."""
    from pathlib import PurePath

    from skinbayes.fit.bibliography import key_of

    key = f"data-{key_of(PurePath(str(fit.provenance['data'].get('key', ''))).stem)}"
    return key if key in order else ""


def _model(fit: Fit) -> list[str | Cited]:
    said = f"The model is '{fit.provenance['model']}'"
    if title := str(fit.provenance.get("title", "")):
        said += f" ({title})"
    if fit.problem is not None:
        said += f", whose forward model is '{fit.problem.model.name}'"
    if options := fit.provenance.get("options"):
        said += f", evaluated with {and_list([f'{key} = {value}' for key, value in options.items()])}"
    said += "."
    if accuracy := str(fit.provenance.get("accuracy") or ""):
        said += f" {accuracy[:1].upper()}{accuracy[1:]}".removesuffix(".") + "."
    return [said]


def _theory(fit: Fit | JointFit, order: list[str]) -> list[str | Cited]:
    """The works whose equations enter, each with what it was used for."""
    methods = {key for keys in METHODS.values() for key in keys} | {"kumar2019arviz", "skinbayes"}
    works = [
        entry
        for entry in fit.provenance["references"]
        if entry["key"] in order and entry["key"] not in methods and not str(entry["key"]).startswith("data-")
    ]
    if not works:
        return ["The model has no contact mechanics."]
    pieces: list[str | Cited] = ["The equations are those of "]
    for i, entry in enumerate(works):
        if i:
            pieces.append(" and " if i == len(works) - 1 else ", ")
        pieces += [str(entry["use"]), Cited((str(entry["key"]),))]
    return [*pieces, "."]


def _priors(fit: Fit) -> list[str | Cited]:
    free = []
    for label in fit.shown_names:
        prior, symbol = fit.provenance["priors"][label], fit.symbol(label)
        name = (
            spoken_name(label) if symbol in (label, spoken_name(label)) else f"{spoken_name(label)} {symbol}"
        )
        free.append(f"{name}: {prior['text']} ({_trimmed(prior['source'])})")
    said = f"{len(free)} parameter{' was' if len(free) == 1 else 's were'} inferred, with the priors: {'; '.join(free)}."
    fixed = [f"{row['name']} {row['value']} ({_trimmed(row['source'])})" for row in tables.fixed_rows(fit)]
    return [f"{said} Not inferred: {'; '.join(fixed)}." if fixed else said]


def _trimmed(source: object) -> str:
    return " ".join(str(source).split()).rstrip(". ") or "no source stated"


def _scatter(fit: Fit) -> list[str | Cited]:
    noise = fit.provenance.get("noise", {})
    said = [
        f"The scatter of {spoken_name(str(name))} about the model is taken to be "
        f"{str(family).replace('_', ' ')}."
        for name, family in noise.items()
    ]
    if columns := group_columns(fit):
        told = and_list([f"the same {spoken_name(column)}" for column in columns])
        said.append(
            f"Rows of {told} share an effect, normally distributed and integrated out in the likelihood."
        )
    if curves := curves_of(fit):
        along = and_list([spoken_name(curve.column) for curve in curves])
        said.append(f"A smooth curve along {along} that the theory misses was inferred with the parameters.")
    if fit.people_labels():
        names = list(dict.fromkeys(spoken_name(label.partition("[")[0]) for label in fit.people_labels()))
        said.append(f"Values of single people ({and_list(names)}) were drawn from populations, inferred too.")
    return [" ".join(said)]


def _sampling(fit: Fit, order: list[str]) -> list[str | Cited]:
    run = fit.provenance["sampling"]
    engine = str(run.get("engine", ""))
    pieces: list[str | Cited] = []
    if engine in METHODS:
        pieces = [
            f"The posterior was sampled with the engine {engine} of skinbayes",
            *_cited(order, METHODS[engine]),
            ". ",
        ]
    said = " ".join(re.sub(r"\s+", " ", one) for one in quality.convergence(fit))
    return [
        *pieces,
        f"{said} Values are posterior medians with 90 % intervals, from the 5 to the 95 % quantile.",
    ]


def _software(fit: Fit | JointFit, order: list[str]) -> list[str | Cited]:
    versions = {str(name): str(found) for name, found in fit.provenance["versions"].items()}
    own = versions.pop("skinbayes", "")
    others = and_list([f"{name} {found}" for name, found in versions.items()])
    pieces: list[str | Cited] = [f"Computed with skinbayes {own}".rstrip(), *_cited(order, ["skinbayes"])]
    pieces += [f", with {others}" if others else "", *_cited(order, ["kumar2019arviz"])]
    seed = fit.provenance["sampling"].get("seed")
    said = "" if seed is None else f" The seed was {seed}."
    return [
        *pieces,
        f".{said} The fingerprint of model, data and priors begins with {str(fit.provenance['fingerprint'])[:12]}.",
    ]
