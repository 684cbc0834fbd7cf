"""What evidence and posterior owe to the priors: the table and the sentences of page and terminal."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from skinbayes.fit import Fit, JointFit
    from skinbayes.fit.prior_sensitivity import ChangedPrior, PriorSensitivity

HEADERS = (
    "prior of",
    "ln evidence, half",
    "twice",
    "median moves, half",
    "twice",
    "interval, half",
    "twice",
    "prior, likelihood",
    "speaks",
)

TOGETHER = "all together"

EXPLAINED = (
    "half, twice: with a prior half and twice as wide, ± standard error. ln evidence: its change. median moves, interval: the "
    "median of the same parameter moves by so many posterior standard deviations, and its 90 % interval is so many times as "
    "wide (of all together: what changes most). prior, likelihood: how much the posterior changes as all priors, or the "
    "likelihood, are raised to a power near 1; from 0.05 on that counts. –: these draws cannot tell. *: sampled anew."
)


def sensitivity_rows(found: PriorSensitivity) -> list[list[str]]:
    """Rows of the table below :data:`HEADERS`, parameters by their names; all priors together at the end."""
    informed = {entry.name: entry for entry in found.informed}
    rows = []
    for labels in dict.fromkeys(entry.labels for entry in found.changed):
        pair = [found.of(labels, factor) for factor in (0.5, 2.0)]
        own = informed[labels[0]] if len(labels) == 1 else None
        rows.append(
            [
                labels[0] if own else TOGETHER,
                *(_change(entry) for entry in pair),
                *(_shown(entry, entry.shifts, entry.furthest, "{:+.2f} ± {:.2f}") for entry in pair),
                *(_shown(entry, entry.width_ratios, entry.stretched, "× {:.2f} ± {:.2f}") for entry in pair),
                *((f"{own.prior:.2f}, {own.likelihood:.2f}", own.speaks) if own else ("", "")),
            ]
        )
    return rows


def page_sensitivity(fit: Fit | JointFit) -> tuple[list[list[str]], list[str]]:
    """Table and sentences of a fit without anything sampled anew; empty if its model or data are gone."""
    if fit.problem is None:
        return [], []
    found = fit.prior_sensitivity()
    return sensitivity_rows(found), found.sentences()


def brief_sensitivity(fit: Fit | JointFit) -> dict[str, Any] | None:
    """The same for machines, without what the prior of one parameter does to others; None if model or data are gone."""
    if fit.problem is None:
        return None
    found = fit.prior_sensitivity()
    informed = {entry.name: entry for entry in found.informed}
    document: dict[str, Any] = {}
    for entry in found.changed:
        alone = len(entry.labels) == 1
        name = entry.labels[0] if alone else TOGETHER
        part = document.setdefault(name, {})
        values = {"log_evidence_change": entry.log_evidence_change, "error": entry.error}
        if alone:
            values |= (
                {"shift": entry.shifts[name][0], "width_ratio": entry.width_ratios[name][0]}
                if entry.reliable
                else {}
            )
            part |= {key: getattr(informed[name], key) for key in ("speaks", "prior", "likelihood")}
        part["half" if entry.factor < 1 else "twice"] = values if entry.reliable else None
    return document


def _change(entry: ChangedPrior) -> str:
    if not entry.reliable:
        return "–"
    star = "*" if entry.refitted else ""
    return f"{entry.log_evidence_change:+.2f} ± {entry.error:.2f}{star}"


def _shown(
    entry: ChangedPrior, changes: dict[str, tuple[float, float]], most: tuple[str, float, float], form: str
) -> str:
    """A change of the parameter whose prior was changed, or the largest, if all priors were."""
    if not entry.reliable:
        return "–"
    return form.format(*(changes[entry.labels[0]] if len(entry.labels) == 1 else most[1:]))
