"""What an identifiability check found: plain frozen records and their sentences."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

from skinbayes.diagnose.formulas import product
from skinbayes.diagnose.rule import verdict
from skinbayes.phrases import and_list, percent, row_count

SIGN = 0.05
"""An exponent beyond this on both sides of zero changes sign over the prior."""


@dataclass(frozen=True)
class Combination:
    """A combination of parameters that predictions determine.

    Attributes
    ----------
    text : the combination as a product of powers, ``"a / (b · c^2)"``
    exponents : power of each parameter or derived quantity in it; for parameters that are not positive by nature the
        derivative of ln of the combination
    ranges : 5 % and 95 % quantiles of the exponents over the prior
    exact : True if the exponents are as written, within 0.005, and nothing weak was left out
    constant : True if the exponents are the same over the prior (within 0.05)
    weak : parameters that enter with less than 5 % of the largest effect and are left out
    spread_ratio : posterior over prior standard deviation in the linearised problem, median over the prior
    """

    text: str
    exponents: dict[str, float]
    ranges: dict[str, tuple[float, float]]
    exact: bool
    constant: bool
    weak: tuple[str, ...]
    spread_ratio: float

    @property
    def nameable(self) -> bool:
        """Whether it can be written as a product of powers: exponents that change sign make no combination."""
        return not any(low < -SIGN and high > SIGN for low, high in self.ranges.values())

    def phrase(self) -> str:
        """The combination with what has to be known about it."""
        if not self.constant and len(self.exponents) > 1:
            return f"a combination of {and_list(list(self.exponents))} (its exponents vary over the prior)"
        return self.text if self.exact else f"{self.text} (approximately)"


@dataclass(frozen=True)
class RowGroup:
    """What one group of rows determines.

    Attributes
    ----------
    label, rows : name and number of rows
    directions : number of directions of parameter space that the rows inform, median over the prior
    directions_range : smallest and largest number over the prior
    spread_ratios : posterior over prior standard deviation along these directions, best informed first
    combinations : the same directions as combinations; those whose exponents change sign over the prior are none
    silent : parameters of which one prior standard deviation moves the predictions less than their noise
    """

    label: str
    rows: int
    directions: int
    directions_range: tuple[int, int]
    spread_ratios: tuple[float, ...]
    combinations: tuple[Combination, ...]
    silent: tuple[str, ...]

    def sentences(self) -> list[str]:
        """One to three sentences."""
        start = f"{self.label} ({row_count(self.rows)})"
        if not self.directions:
            return [f"{start}: tells next to nothing beyond the priors."]
        phrases = [combination.phrase() for combination in self.combinations]
        fractions = [percent(combination.spread_ratio) for combination in self.combinations]
        if not phrases:
            informed = "1 direction is" if self.directions == 1 else f"{self.directions} directions are"
            lines = [f"{start}: {informed} informed, with no simple names."]
        elif len(phrases) == 1:
            only = "only " if self.directions == 1 else ""
            simple = self.combinations[0].constant and len(self.combinations[0].exponents) > 1
            lines = [
                f"{start}: {only}{'the combination ' if simple else ''}{phrases[0]} is determined; "
                f"its spread shrinks to {fractions[0]} of the prior's."
            ]
        else:
            each = "; ".join(
                f"{p}, spread {s} of the prior's" for p, s in zip(phrases, fractions, strict=True)
            )
            alone = all(len(combination.exponents) == 1 for combination in self.combinations)
            lines = [
                f"{start}: {len(phrases)} {'parameters' if alone else 'combinations'} are determined: {each}."
            ]
        weak = sorted({name for combination in self.combinations for name in combination.weak})
        if weak:
            lines.append(
                f"{self.label}: {and_list(weak)} {'plays' if len(weak) == 1 else 'play'} a small part as well."
            )
        low, high = self.directions_range
        if low != high:
            lines.append(
                f"{self.label}: between {low} and {high} combinations are determined, depending on where in the "
                "prior the truth lies."
            )
        return lines


@dataclass(frozen=True)
class Freedom:
    """A change of parameters that the data do not notice.

    Attributes
    ----------
    changes : relative change of each parameter (absolute for parameters not positive by nature), SI
    text : the change in words; without amounts if they vary over the prior
    exact : True if no prediction changes at all (to first order), False if it changes less than the noise
    constant : True if the same proportions hold over the whole prior
    """

    changes: dict[str, float]
    text: str
    exact: bool
    constant: bool

    def sentence(self) -> str:
        """The change and its consequence."""
        effect = "changes no prediction" if self.exact else "changes the predictions less than their noise"
        return f"{self.text} {effect}: the data cannot tell {and_list(list(self.changes))} apart."


@dataclass(frozen=True)
class Equivalent:
    """A derived quantity that depends on a single free parameter, as a power of it.

    Attributes
    ----------
    derived, parameter : their names
    power : derived ∝ parameter^power
    reads : the combinations with that parameter, written with the derived quantity instead
    """

    derived: str
    parameter: str
    power: float
    reads: tuple[str, ...]

    def sentence(self) -> str:
        """The relation in words."""
        relation = product({self.parameter: (self.power, self.power, self.power, self.power)})
        return (
            f"Of all free parameters only {self.parameter} moves {self.derived}, which is proportional to {relation}: "
            f"the data may as well be said to determine {and_list(self.reads)}."
        )


@dataclass(frozen=True)
class Identifiability:
    """What data can tell about parameters, from the linearised problem at many points of the prior.

    Attributes
    ----------
    names : D parameters
    points, failed_points : number of prior draws that were used, and that had no finite prediction
    groups : one entry for each group of rows, the last one is all rows
    freedoms : independent changes that all rows together do not notice
    only_prior : parameters whose effect on all rows together is below their noise
    absent : those of them that enter no prediction at all
    spread_ratios : posterior over prior standard deviation of each parameter by itself
    equivalents : derived quantities that follow a single parameter of the combinations above
    """

    names: tuple[str, ...]
    points: int
    failed_points: int
    groups: tuple[RowGroup, ...]
    freedoms: tuple[Freedom, ...]
    only_prior: tuple[str, ...]
    absent: tuple[str, ...]
    spread_ratios: dict[str, float]
    equivalents: tuple[Equivalent, ...] = ()

    @property
    def joint(self) -> RowGroup:
        """The finding for all rows together."""
        return self.groups[-1]

    def as_dict(self) -> dict[str, Any]:
        """Everything as plain containers, for JSON."""
        return asdict(self)

    def sentences(self) -> list[str]:
        """The findings in plain English, most important first within each group of rows."""
        lines = [line for group in self.groups for line in group.sentences()]
        count, total = self.joint.directions, len(self.names)
        if count == total:
            lines.append(f"Together the data inform all {total} parameters.")
        else:
            lines.append(
                f"Together the data inform {count} of {total} independent directions of the parameters; "
                f"along the other {total - count} the posterior will hardly differ from the prior."
            )
        lines += [equivalent.sentence() for equivalent in self.equivalents]
        lines += [freedom.sentence() for freedom in self.freedoms]
        present = [name for name in self.only_prior if name not in self.absent]
        if present:
            whose = "its" if len(present) == 1 else "their"
            lines.append(
                f"Only the prior will speak about {and_list(present)}, as far as can be said before sampling: {whose} effect is "
                "below the noise of the data."
            )
        together = [
            name
            for name, ratio in self.spread_ratios.items()
            if verdict(ratio) == "not updated" and name not in self.only_prior
        ]
        if together:
            one = len(together) == 1
            lines.append(
                f"By {'itself' if one else 'themselves'}, {and_list(together)} will hardly differ from the "
                f"prior{'' if one else 's'}: the data know {'it' if one else 'them'} only together with others."
            )
        if self.absent:
            verb = "enters" if len(self.absent) == 1 else "enter"
            lines.append(
                f"Only the prior speaks about {and_list(list(self.absent))}, which {verb} no prediction."
            )
        if self.failed_points:
            lines.append(
                f"{self.failed_points} of {self.points + self.failed_points} prior draws had no finite prediction."
            )
        return lines
