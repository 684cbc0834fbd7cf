"""Whether the evidence would prefer another model if priors were narrower or wider, and models that differ in nothing else."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import combinations, pairwise
from math import exp, hypot, log
from typing import TYPE_CHECKING, Any, Literal

from scipy.optimize import brentq

from skinbayes.comparison.verdicts import AHEAD, Statement
from skinbayes.fit.other_priors import OtherPriors
from skinbayes.phrases import and_list, number
from skinbayes.problem.other_priors import priors_of, with_priors
from skinbayes.statistics.priors import Prior
from skinbayes.statistics.widening import FROM_ZERO, LOGARITHMIC, width_ratio

if TYPE_CHECKING:
    from skinbayes.fit import Fit, JointFit

REACH = (2.0, 3.0, 5.0, 10.0, 20.0, 50.0, 100.0)
"""How many times further priors are made to reach, see :func:`skinbayes.statistics.widening.factor_of_reach`."""

NARROWED = (0.5, 0.3, 0.2, 0.1)
"""Parts of their width to which priors are narrowed."""

SAMPLED = (100.0, 10.0, 3.0)
"""Where a model is sampled anew, the first that succeeds: from there on its draws tell about what lies between."""

FADES = 0.5
"""A preference that narrower priors leave less of than this is said to fade."""

ALL = "all priors"

Kind = Literal["larger or smaller", "larger", "wider"]


@dataclass(frozen=True)
class WidthScan:
    """What the evidence says of two models as the priors of one quantity become narrower or wider, in both if both have it.

    Attributes
    ----------
    quantity : name of a parameter, all its levels together, or ``"all priors"``
    kind : of its priors: of logarithms (``"larger or smaller"``), beginning at zero (``"larger"``), or others (``"wider"``)
    preferred, other : the models; the evidence prefers the first as their priors are
    log_bayes_factor, error : ln of the ratio of their evidences, and its standard error
    narrower, wider : the same with priors half and twice as wide; None if that is not known
    turns_at : how many times further the priors reach where the preference turns, in the sense of ``kind``; None if it does not
        as far as is known
    turns_at_width : part of their width to which priors are narrowed where it turns; None if it does not down to a tenth
    weakest : smallest ln of the ratio with narrower priors, and the part of their width at which that is
    known_to : largest factor up to which the draws tell
    held : what cannot be made as wide, in words
    """

    quantity: str
    kind: Kind
    preferred: str
    other: str
    log_bayes_factor: float
    error: float
    narrower: float | None
    wider: float | None
    turns_at: float | None
    turns_at_width: float | None
    weakest: tuple[float, float]
    known_to: float
    held: tuple[str, ...]

    def may(self, reach: float) -> str:
        """What is so many times further, in words: ``"layer_thickness may be 10 times larger or smaller"``."""
        times = f"{number(reach, 2)} times"
        if self.quantity == ALL:
            return f"all priors reach {times} further"
        if self.kind == "wider":
            return f"the prior of {self.quantity} is {times} as wide"
        return f"{self.quantity} may be {times} {self.kind}"

    def narrowed(self, part: float) -> str:
        """Narrower priors in words."""
        which = "all priors are" if self.quantity == ALL else f"the prior of {self.quantity} is"
        return f"{which} {number(part, 2)} times as wide"


@dataclass(frozen=True)
class PriorWidths:
    """What the evidence of a comparison owes to the width of priors.

    Attributes
    ----------
    scans : the model that the evidence prefers against each other one, quantity by quantity
    same_model : pairs of models that differ in their priors only: names, parameters, whether only in the width of the priors
    """

    scans: tuple[WidthScan, ...] = ()
    same_model: tuple[tuple[str, str, tuple[str, ...], bool], ...] = ()

    def sentences(self) -> list[str]:
        """The findings in words."""
        return [statement.text for statement in self.statements()]

    def statements(self) -> list[Statement]:
        """The sentences, each with what it does."""
        said = [Statement(self._warning(*entry)) for entry in self.same_model]
        pairs = dict.fromkeys((scan.preferred, scan.other) for scan in self.scans)
        return said + [statement for pair in pairs for statement in self._on_pair(*pair)]

    def to_dict(self) -> dict[str, Any]:
        """Everything as plain types."""
        keys = ("first", "second", "parameters", "only_widths")
        same = [dict(zip(keys, entry, strict=True)) for entry in self.same_model]
        return {"scans": [vars(scan) for scan in self.scans], "same_model": same}

    @staticmethod
    def _warning(first: str, second: str, labels: tuple[str, ...], only_widths: bool) -> str:
        what = f"'{first}' and '{second}' are the same model with other priors of {and_list(labels)}"
        if not only_widths:
            return f"{what}: their Bayes factor judges these priors, not the physics."
        return (
            f"WARNING: {what}, which differ in their width only. Their Bayes factor is a choice of the prior and says nothing "
            "about the data: make a prior wide enough, and its model loses against any other."
        )

    def _on_pair(self, preferred: str, other: str) -> list[Statement]:
        scans = [scan for scan in self.scans if (scan.preferred, scan.other) == (preferred, other)]
        if scans[0].log_bayes_factor < 2 * scans[0].error:
            return []
        start = f"The preference of the evidence for '{preferred}' over '{other}'"
        said: list[Statement] = []
        turning = [scan.may(scan.turns_at) for scan in scans if scan.turns_at]
        turning += [scan.narrowed(scan.turns_at_width) for scan in scans if scan.turns_at_width]
        if turning:
            said.append(Statement(f"{start} turns if {', or if '.join(turning)}.", AHEAD))
        staying = [scan for scan in scans if not scan.turns_at and scan.known_to > 1]
        if staying:
            said.append(Statement(f"{'It' if turning else start} stays if {_one_of(staying)}.", AHEAD))
        for scan in scans:
            value, part = scan.weakest
            if not scan.turns_at_width and value < FADES * scan.log_bayes_factor:
                said.append(
                    Statement(f"ln of their Bayes factor fades to {value:.2f} if {scan.narrowed(part)}.")
                )
        short = [scan for scan in scans if not scan.turns_at and scan.known_to < REACH[-1]]
        if nothing := [scan.quantity for scan in short if scan.known_to == 1]:
            said.append(
                Statement(
                    f"Whether it stays with much wider priors of {and_list(nothing)} these draws cannot tell (--sensitivity "
                    "samples anew)."
                )
            )
        if held := dict.fromkeys(text for scan in scans for text in scan.held):
            text = f"What was not made as wide, because it cannot be: {and_list(list(held))}."
            said.append(Statement(text))
        return said


def _one_of(scans: Sequence[WidthScan]) -> str:
    """How far the priors of each of several quantities can be widened, those alike together."""
    alike: dict[tuple[Kind, float, bool], list[WidthScan]] = {}
    for scan in scans:
        alike.setdefault((scan.kind, scan.known_to, scan.quantity == ALL), []).append(scan)
    parts = []
    for (kind, reach, _), some in alike.items():
        if len(some) == 1:
            parts.append(some[0].may(reach))
            continue
        names, times = and_list([scan.quantity for scan in some]), f"{number(reach, 2)} times"
        parts.append(
            f"one of the priors of {names} is {times} as wide"
            if kind == "wider"
            else f"one of {names} may be {times} {kind}"
        )
    return ", or if ".join(parts)


def prior_widths(
    fits: Sequence[Fit | JointFit], refit: bool = False, progress: Callable[[int, int], None] | None = None
) -> PriorWidths:
    """Scan widths of priors of fits of the same data.

    Parameters
    ----------
    fits : two or more; those whose model or data are gone are left out, and without the evidence of all others there are no scans
    refit : sample a model anew where its draws cannot tell
    progress : called with the number of quantities done and their total
    """
    at_hand = [fit for fit in fits if fit.problem is not None]
    same = [found for pair in combinations(at_hand, 2) if (found := _same_model(*pair))]
    evidence = [fit.provenance["sampling"].get("log_evidence") for fit in at_hand]
    if len(at_hand) < 2 or not all(evidence):
        return PriorWidths((), tuple(same))
    order = sorted(range(len(at_hand)), key=lambda i: -evidence[i][0])
    others = [OtherPriors(at_hand[i], refit) for i in order]
    wanted = [
        (j, quantity)
        for j in range(1, len(order))
        for quantity in (
            *dict.fromkeys(n.partition("[")[0] for o in (others[0], others[j]) for n in o.names),
            ALL,
        )
    ]
    scans = []
    for done, (j, quantity) in enumerate(wanted):
        if progress is not None:
            progress(done, len(wanted))
        pair = (order[0], order[j])
        names = [at_hand[i].name for i in pair]
        (first, its_error), (second, error) = (evidence[i] for i in pair)
        scans.append(_scan(quantity, names, (others[0], others[j]), first - second, hypot(its_error, error)))
    if progress is not None:
        progress(len(wanted), len(wanted))
    return PriorWidths(tuple(scans), tuple(same))


def _scan(
    quantity: str, names: list[str], pair: tuple[OtherPriors, OtherPriors], gap: float, error: float
) -> WidthScan:
    labels = [[n for n in other.names if quantity in (ALL, n.partition("[")[0])] for other in pair]
    held: dict[str, None] = {}

    def with_factors(factors: list[dict[str, float]], refit: bool) -> float | None:
        """ln of the Bayes factor with priors so many times as wide in the one and the other model."""
        value = gap
        for sign, other, changed in zip((1, -1), pair, factors, strict=True):
            if changed:
                found = other.under(changed, refit)
                if not found.reliable:
                    return None
                held.update(dict.fromkeys(found.held))
                value += sign * found.change
        return value

    def reaching(reach: float, refit: bool = False) -> float | None:
        return with_factors([o.factors(some, reach) for o, some in zip(pair, labels, strict=True)], refit)

    def as_wide(factor: float, refit: bool = False) -> float | None:
        return with_factors([dict.fromkeys(some, factor) for some in labels], refit)

    wider = as_wide(2.0, refit=True)
    any(reaching(reach, refit=True) is not None for reach in SAMPLED)
    further, closer = _along(reaching, gap, REACH), _along(as_wide, gap, NARROWED)
    priors = [other.prior(label) for other, some in zip(pair, labels, strict=True) for label in some]
    return WidthScan(
        quantity, _kind(priors), names[0], names[1], gap, error, closer.get(0.5), wider, _turn(reaching, further),
        _turn(as_wide, closer), min((value, part) for part, value in closer.items()), max(further), tuple(held),
    )  # fmt: skip


def _along(
    value_at: Callable[[float], float | None], gap: float, factors: Sequence[float]
) -> dict[float, float]:
    """ln of the Bayes factor at 1 and at the factors up to the first at which it is not known."""
    values = {1.0: gap}
    for factor in factors:
        if (value := value_at(factor)) is None:
            break
        values[factor] = value
    return values


def _turn(value_at: Callable[[float], float | None], values: dict[float, float]) -> float | None:
    """The factor closest to 1 at which the preference turns."""
    for low, high in pairwise(values):
        if values[low] > 0 >= values[high]:
            return _root(value_at, low, high, values)
    return None


def _root(
    value_at: Callable[[float], float | None], low: float, high: float, values: dict[float, float]
) -> float:
    """Where the preference turns, between two factors, in the logarithm of which it is nearly straight."""

    def at(logarithm: float) -> float:
        part = (logarithm - log(low)) / (log(high) - log(low))
        found = value_at(exp(logarithm)) if 0.0 < part < 1.0 else None
        return values[low] + part * (values[high] - values[low]) if found is None else found

    return exp(brentq(at, *sorted((log(low), log(high))), xtol=0.01))


def _kind(priors: Sequence[Prior]) -> Kind:
    if all(prior.family in LOGARITHMIC for prior in priors):
        return "larger or smaller"
    return "larger" if all(prior.family in FROM_ZERO for prior in priors) else "wider"


def _same_model(
    first: Fit | JointFit, second: Fit | JointFit
) -> tuple[str, str, tuple[str, ...], bool] | None:
    """Names, parameters whose priors differ, and whether only in width, if two fits differ in nothing else."""
    one, two = first.problem, second.problem
    if one is None or two is None or one.names != two.names or one.fingerprint == two.fingerprint:
        return None
    priors = priors_of(two)
    if with_priors(one, priors).fingerprint != two.fingerprint:
        return None
    differing = [
        (name, width_ratio(old, new))
        for name, old, new in zip(one.names, priors_of(one), priors, strict=True)
        if old != new
    ]
    only_widths = all(ratio is not None for _, ratio in differing)
    return first.name, second.name, tuple(name for name, _ in differing), only_widths
