"""What the effects of groups say: how people differ, and how far the theory misses from liquid to liquid."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.fit.predicted import is_logarithmic, observables
from skinbayes.phrases import and_list, number, percent, plural
from skinbayes.plot.numbers import interval, quantity
from skinbayes.plot.rows import effect_draws, group_columns
from skinbayes.vocabulary import lookup

if TYPE_CHECKING:
    from skinbayes.fit import Fit

NOISE_DRAWS = 100
"""Posterior draws for which the width of the noise is averaged over the rows."""

HEADINGS = {"person": "How people differ"}
"""What the effects of a grouping column are; other columns: how their levels differ."""

MISFIT = "The theory's misfit from liquid to liquid"

MISFIT_EXPLAINED = (
    "The model knows how liquids differ, so that a theory that is right would leave nothing of this."
)

LIQUID_INPUTS = {"viscosity", "speed_viscosity_product"}
"""Columns by which a model knows liquids, if it does not take their flow curves."""

Triple = tuple[float, float, float]


@dataclass(frozen=True)
class GroupFinding:
    """The effects of one grouping column.

    Attributes
    ----------
    column : the column
    logarithmic : True if effects are those of ln of the observable, dimensionless; else they have its unit
    scale : 5, 50 and 95 % quantiles of the standard deviation of the effects; three times the value if it is fixed
    effects : level to the same quantiles of its effect
    over_noise : the same quantiles of the scale over the width of the noise; None if that is not at hand
    variance_fraction : fraction of the variance that the theory leaves, posterior mean; None if the noise is not at hand
    mean : the same quantiles of the mean of the effects of all levels, which should be near 0
    """

    column: str
    logarithmic: bool
    scale: Triple
    effects: dict[str, Triple]
    over_noise: Triple | None
    variance_fraction: float | None
    mean: Triple

    @property
    def lopsided(self) -> bool:
        """Whether the mean is further from 0 than two standard deviations of a mean of so many effects."""
        return abs(self.mean[1]) > 2.0 * self.scale[1] / np.sqrt(len(self.effects))

    def to_dict(self) -> dict[str, Any]:
        """Everything as plain types, SI."""
        keys = ("q05", "median", "q95")
        return {
            "logarithmic": self.logarithmic,
            "scale": dict(zip(keys, self.scale, strict=True)),
            "scale_over_noise": self.over_noise and dict(zip(keys, self.over_noise, strict=True)),
            "variance_fraction": self.variance_fraction,
            "mean": dict(zip(keys, self.mean, strict=True)),
            "effects": {level: dict(zip(keys, found, strict=True)) for level, found in self.effects.items()},
        }


def group_findings(fit: Fit) -> list[GroupFinding]:
    """What is known about the effects of each grouping column."""
    columns = group_columns(fit)
    if not columns:
        return []
    noise = _noise(fit)
    scales = {column: _scale_draws(fit, column) for column in columns}
    logarithmic = is_logarithmic(fit, observables(fit)[0])
    found = []
    for column in columns:
        label = f"group_scale[{column}]"
        levels, draws = effect_draws(fit, column)
        over_noise = fraction = None
        if noise is not None:
            chosen, width = noise
            over_noise = _triple(scales[column][chosen] / width)
            whole = width**2 + sum(scales[other][chosen] ** 2 for other in columns)
            fraction = float(np.mean(scales[column][chosen] ** 2 / whole))
        found.append(
            GroupFinding(
                column,
                logarithmic,
                _triple(scales[column]) if label not in fit.names else _three(fit.quantiles(label)),
                {level: _triple(draws[:, i]) for i, level in enumerate(levels)},
                over_noise,
                fraction,
                _triple(draws.mean(axis=1)),
            )
        )
    return found


def group_sentences(fit: Fit) -> list[str]:
    """The size of each column's effects in words, and beside the scatter of single data."""
    findings = group_findings(fit)
    said = [_sentence(fit, finding) for finding in findings]
    noise = _noise(fit)
    if noise is None or not findings:
        return said
    low, middle, high = _triple(noise[1])
    times = [number(finding.over_noise[1], 2) for finding in findings if finding.over_noise]
    many = [plural(finding.column) for finding in findings]
    others = [f"those of {name} {factor} times" for name, factor in zip(many[1:], times[1:], strict=True)]
    compared = and_list([f"The effects of {many[0]} are {times[0]} times as wide as that", *others])
    fractions = [finding.variance_fraction or 0.0 for finding in findings]
    parts = [f"{percent(fraction)} between {name}" for name, fraction in zip(many, fractions, strict=True)]
    logarithmic = findings[0].logarithmic
    said.append(
        f"Beside the noise: single values scatter about all this by {_size(fit, middle, logarithmic)} "
        f"(90 %: {_sizes(fit, low, high, logarithmic)}). {compared}. Of the variance that the model leaves there lies "
        f"{and_list([*parts, f'{percent(1.0 - sum(fractions))} in single values'])}."
    )
    return said


def effect_rows(fit: Fit) -> list[tuple[str, str, str, str]]:
    """Column, level, median and 90 % interval of each effect, as text; factors where the noise is logarithmic."""
    rows = []
    unit = _unit(fit)
    for finding in group_findings(fit):
        for level, (low, middle, high) in sorted(finding.effects.items(), key=lambda item: -item[1][1]):
            if finding.logarithmic:
                texts = (
                    f"× {number(np.exp(middle))}",
                    f"× {interval(float(np.exp(low)), float(np.exp(high)), '1')}",
                )
            else:
                texts = (quantity(middle, unit), interval(low, high, unit, typical=middle))
            rows.append((finding.column.replace("_", " "), level, *texts))
    return rows


def _sentence(fit: Fit, finding: GroupFinding) -> str:
    many = plural(finding.column)
    misfit = finding.column == "liquid" and _knows_liquids(fit)
    heading = MISFIT if misfit else HEADINGS.get(finding.column, f"How {many} differ")
    low, middle, high = finding.scale
    size = f"{heading}: {_size(fit, middle, finding.logarithmic)} (standard deviation"
    if high > low:
        size += f"; 90 %: {_sizes(fit, low, high, finding.logarithmic)}"
    if finding.logarithmic:
        size += f"), typically a factor of {number(float(np.exp(middle)), 3)} up or down."
    else:
        size += ")."
    said = [size] + ([MISFIT_EXPLAINED] if misfit else [])
    apart = sum(1 for q05, _, q95 in finding.effects.values() if q05 > 0.0 or q95 < 0.0)
    said.append(
        f"{apart or 'None'} of {len(finding.effects)} {many} {'lies' if apart <= 1 else 'lie'} off the middle "
        "with more than 90 % probability."
    )
    ordered = sorted(finding.effects, key=lambda level: finding.effects[level][1])
    lowest, highest = (
        f"{level} ({_shown(fit, finding, finding.effects[level][1])})" for level in (ordered[0], ordered[-1])
    )
    said.append(f"Highest: {highest}; lowest: {lowest}.")
    if finding.lopsided:
        shared = "theory" if misfit else "model"
        said.append(
            f"Together they lie on one side, at {_shown(fit, finding, finding.mean[1])} on the average, too far for chance: the "
            f"effects take up what the {shared} misses of all {many} alike, against its priors."
        )
    return " ".join(said)


def _knows_liquids(fit: Fit) -> bool:
    """Whether what differs between liquids enters the model."""
    return bool(LIQUID_INPUTS & set(fit.groups["constant_data"].data_vars)) or "[rheology]" in str(
        fit.provenance["model_text"]
    )


def _shown(fit: Fit, finding: GroupFinding, value: float) -> str:
    """An effect: a factor where it is one of ln."""
    return f"×\u00a0{number(float(np.exp(value)), 3)}" if finding.logarithmic else quantity(value, _unit(fit))


def _size(fit: Fit, value: float, logarithmic: bool) -> str:
    """A standard deviation: in percent of the observable where it is one of ln."""
    if not logarithmic:
        return quantity(value, _unit(fit))
    known = lookup(observables(fit)[0])
    return f"{percent(value)} of {known.symbol if known else observables(fit)[0]}"


def _sizes(fit: Fit, low: float, high: float, logarithmic: bool) -> str:
    return (
        f"{percent(low).removesuffix(' %')} to {percent(high)}"
        if logarithmic
        else interval(low, high, _unit(fit))
    )


def _unit(fit: Fit) -> str:
    known = lookup(observables(fit)[0])
    return known.unit if known else "1"


def _triple(draws: FloatArray) -> Triple:
    return _three(np.quantile(draws, [0.05, 0.5, 0.95]))


def _three(quantiles: FloatArray) -> Triple:
    low, middle, high = (float(q) for q in quantiles)
    return low, middle, high


def _scale_draws(fit: Fit, column: str) -> FloatArray:
    label = f"group_scale[{column}]"
    if label in fit.names:
        return fit.draws(label)
    return np.full(len(fit.theta()), float(fit.provenance["fixed"][label]["value"]))


def _noise(fit: Fit) -> tuple[Any, FloatArray] | None:
    """Which draws were looked at, and the root mean square width of the noise over the rows in each; None if not at hand."""
    theta = fit.theta()
    if fit.problem is not None:
        chosen = np.arange(0, len(theta), max(1, len(theta) // NOISE_DRAWS))
        widths = [float(np.sqrt(np.mean(fit.problem.noise_width(vector) ** 2))) for vector in theta[chosen]]
        return chosen, np.array(widths)
    if "noise_scale" in fit.names:
        return slice(None), fit.draws("noise_scale")
    return None
