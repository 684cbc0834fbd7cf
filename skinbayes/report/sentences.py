"""What a fit says, in sentences. Plain text; nothing here knows HTML."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import numpy as np

from skinbayes.diagnose.rule import MUCH, SOMETHING, UNCHANGED
from skinbayes.phrases import number, percent
from skinbayes.plot.numbers import fraction, interval, quantity
from skinbayes.plot.symbols import spoken_name
from skinbayes.plot.updates import fit_updates
from skinbayes.report.opening import is_scatter
from skinbayes.report.tables import labels_by_name
from skinbayes.vocabulary import QUANTITIES

if TYPE_CHECKING:
    from skinbayes.diagnose import PriorUpdate
    from skinbayes.fit import Fit


STRAINED = 0.05
"""A posterior median in this tail of the prior is said to pull against it."""


def title_name(fit: Fit, label: str) -> str:
    """Name and symbol of a parameter or derived quantity, for the start of a sentence: ``"Yield stress (dry), σ_Y (dry)"``."""
    spoken, symbol = spoken_name(label), fit.symbol(label)
    spoken = spoken[:1].upper() + spoken[1:]
    of = re.search(r" (\(.*\))$", spoken) if "[" in label else None
    plain = symbol.partition(" (")[0] if of else symbol
    if plain in (label, spoken):
        return spoken
    return f"{spoken.removesuffix(of.group())} {plain} {of.group(1)}" if of else f"{spoken} {plain}"


def with_symbols(fit: Fit, text: str) -> str:
    """Replace parameter labels by symbols, and other names of the vocabulary by words."""
    known = {label: fit.symbol(label) for label in (*fit.names, *named_products(fit))}
    known |= {name: spoken_name(name) for name in QUANTITIES if "_" in name and name not in known}
    pattern = "|".join(re.escape(name) for name in sorted(known, key=len, reverse=True))
    return re.sub(rf"(?<!\w)(?:{pattern})(?![\w\[])", lambda m: known[m.group()], text)


def named_products(fit: Fit) -> tuple[str, ...]:
    """Labels of the derived quantities that the model file names itself."""
    return tuple(label for label in fit.derived_labels() if label.partition("[")[0] not in QUANTITIES)


def value_sentence(fit: Fit, label: str) -> str:
    """Median and 90 % interval: ``"14.8 MPa; with 90 % probability between 7.81 and 28.3 MPa"``."""
    low, middle, high = (float(q) for q in fit.quantiles(label))
    unit = fit.unit(label)
    return (
        f"{quantity(middle, unit)}; with 90 % probability "
        f"between {interval(low, high, unit, typical=middle, joint=' and ')}"
    )


def narrowing_sentence(fit: Fit, label: str) -> str:
    """How much narrower the 90 % interval is than the prior's, as factors where all values are positive."""
    after = fit.quantiles(label, [0.05, 0.95])
    before = fit.quantiles(label, [0.05, 0.95], "prior")
    unit = fit.unit(label)
    if before[0] > 0.0 and after[0] > 0.0:
        return (
            f"The upper end of this interval is {number(after[1] / after[0], 2)} times the lower one; "
            f"before the data it was {number(before[1] / before[0], 2)} times."
        )
    return (
        f"This interval is {quantity(after[1] - after[0], unit, 2)} wide; "
        f"before the data it was {quantity(before[1] - before[0], unit, 2)}."
    )


def learnt(fit: Fit) -> list[str]:
    """One entry for each parameter that the data updated, most informed first, then the model's named products."""
    updates = [u for u in fit_updates(fit).values() if u.verdict != "not updated" and not is_scatter(u.name)]
    updates.sort(key=lambda update: -update.contraction)
    said = []
    for update in updates:
        said.append(
            f"{title_name(fit, update.name)}: {value_sentence(fit, update.name)}. {_strength(update)} "
            f"{narrowing_sentence(fit, update.name)}"
        )
        if update.verdict == "contradicted":
            said[-1] += " The data contradict the prior here, see below."
    return said


def learnt_products(fit: Fit) -> list[str]:
    """One entry for each combination that the model file names, also where it differs from row to row."""
    said = []
    for name, labels in labels_by_name(named_products(fit)).items():
        meaning = str(fit.groups["posterior"][name].attrs.get("long_name", ""))
        explained = f" It is {meaning}." if meaning else ""
        if len(labels) == 1:
            (label,) = labels
            said.append(
                f"{title_name(fit, label)}: {value_sentence(fit, label)}. {narrowing_sentence(fit, label)}{explained}"
            )
            continue
        found = np.array([fit.quantiles(label) for label in labels])
        unit, low, high = fit.unit(name), float(found[:, 0].min()), float(found[:, 2].max())
        medians = float(found[:, 1].min()), float(found[:, 1].max())
        middle = (
            f"{quantity(medians[0], unit)} in all {len(labels)} rows"
            if medians[1] - medians[0] <= 1e-3 * abs(medians[1])
            else f"{interval(*medians, unit)} from row to row ({len(labels)} rows)"
        )
        said.append(
            f"{title_name(fit, name)}: {middle}; the 90 % intervals lie between {interval(low, high, unit, joint=' and ')}."
            f"{explained}"
        )
    return said


def scatter(fit: Fit) -> list[str]:
    """One entry for each parameter of noise and group effects that was fitted: what is not explained is no knowledge of skin."""
    return [
        f"{title_name(fit, label)}: {value_sentence(fit, label)}."
        for label in fit.shown_names
        if is_scatter(label)
    ]


def _strength(update: PriorUpdate) -> str:
    if update.ratio >= UNCHANGED:
        return "The data move it away from the middle of the prior but do not narrow it."
    if update.ratio < MUCH:
        return "The data say much about it."
    if update.ratio < SOMETHING:
        return "The data say something about it."
    return "The data narrow it a little; most of this is still the prior."


def disagreements(fit: Fit) -> list[str]:
    """One entry for each parameter whose posterior median lies beyond the 5–95 % range of its prior."""
    said = []
    for update in fit_updates(fit).values():
        tail = min(update.prior_quantile, 1.0 - update.prior_quantile)
        if tail >= STRAINED and update.verdict != "contradicted":
            continue
        side = "below" if update.prior_quantile < 0.5 else "above"
        before = fit.draws(update.name, "prior")
        low, high = np.quantile(before, [0.05, 0.95])
        beyond = fraction(round(tail * len(before)), len(before))
        beyond = beyond if beyond.startswith("less") else f"only {beyond}"
        said.append(
            f"{title_name(fit, update.name)}: half of the posterior lies {side} "
            f"{quantity(float(fit.quantiles(update.name, 0.5)), fit.unit(update.name))}, but {beyond} of the prior "
            f"(90 % of it between {interval(low, high, fit.unit(update.name), joint=' and ')}). "
            + (
                "The data contradict the prior: question the prior, the model or the data before using the number."
                if update.verdict == "contradicted"
                else "Prior and data pull against each other."
            )
        )
    return said


def not_learnt(fit: Fit) -> list[str]:
    """One entry for each parameter about which only the prior speaks."""
    return [
        f"{title_name(fit, update.name)}: only the prior speaks. {value_sentence(fit, update.name)}, as before the data."
        for update in fit_updates(fit).values()
        if update.verdict == "not updated" and not is_scatter(update.name)
    ]


def open_ends(fit: Fit) -> list[str]:
    """One entry for each parameter that effects of groups, added to the data, let run to the lower end of its prior."""
    problem, said = fit.problem, []
    if problem is None or problem.groups is None or problem.noise_is_logarithmic.all():
        return []
    updates = fit_updates(fit)
    for label, prior in ((p.label, p.prior) for p in problem.free):
        if prior is None or is_scatter(label) or updates[label].verdict == "not updated":
            continue
        draws, ends = fit.draws(label), [float(prior.quantile(part)) for part in (0.02, 0.1)]
        nearest, near = (float((draws < end).mean()) for end in ends)
        # flat up to the end: a fifth of what lies in the lowest 10 % of the prior lies in the lowest 2 %
        if prior.support[0] > 0.0 and near > 0.02 and nearest > 0.1 * near:
            columns = " and ".join(problem.groups.columns)
            said.append(
                f"{title_name(fit, label)}: the data do not bound it from below. {percent(near)} of the posterior lies below "
                f"{quantity(ends[1], fit.unit(label))}, down to the end of the prior: there effects of {columns}, added "
                f"to the data, stand for all that it predicts. A tighter prior on the scale of the groups of {columns} would "
                "bound it; else the lower end of its interval is that of the prior."
            )
    return said
