"""Looking at a problem before sampling: priors, finite predictions, and what the data can tell apart."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from skinbayes.arrays import FloatArray
from skinbayes.diagnose.directions import INFORMED
from skinbayes.diagnose.findings import Identifiability
from skinbayes.diagnose.identifiability import identify
from skinbayes.errors import InputError
from skinbayes.files.noise_block import noise_parameter_names
from skinbayes.files.population_block import DEVIATE, POPULATION_PARAMETERS
from skinbayes.files.scatter_block import SCATTER_PARAMETERS
from skinbayes.phrases import row_count
from skinbayes.problem.failures import explained
from skinbayes.problem.load_powers import load_powers
from skinbayes.problem.pieces import PIECE, named_in_pieces
from skinbayes.problem.populations import both_ways
from skinbayes.problem.possible import has_value, predicted_everywhere
from skinbayes.problem.posterior import Posterior
from skinbayes.problem.rows import data_notes
from skinbayes.problem.statistical_model import StatisticalModel
from skinbayes.problem.surface_numbers import surface_sentence
from skinbayes.units import format_quantity

FEW_PEOPLE = 5
"""Levels below which the prior of the standard deviation between them decides (Gelman 2006, doi 10.1214/06-BA117A)."""

DRAWS = 1000
"""Prior draws that are tried."""

PREDICTIONS = 2_000_000
"""Predictions that are made of them at most: with more than 2,000 rows fewer draws are tried."""

FEWEST_DRAWS = 200
"""Prior draws that are tried with any number of rows, and of models that solve their physics anew for each."""

POINTS, FEW_POINTS = 48, 16
"""Prior draws about which predictions are differentiated, and about which those of models that solve their physics anew."""

MOST_LEVELS = 5
"""Grouping columns with more levels than this (people) are not looked at level by level."""


@dataclass(frozen=True)
class CheckReport:
    """What can be said about a problem before sampling.

    Attributes
    ----------
    model : name
    setup, priors, predictions : sentences
    identifiability : which combinations of parameters the data determine; None without data
    """

    model: str
    setup: tuple[str, ...]
    priors: tuple[str, ...]
    predictions: tuple[str, ...]
    identifiability: Identifiability | None

    def sections(self) -> list[tuple[str, list[str]]]:
        """Titles with their sentences."""
        found = [] if self.identifiability is None else self.identifiability.sentences()
        sections = [
            ("Model and data", list(self.setup)),
            ("Priors", list(self.priors)),
            ("Predictions over the prior", list(self.predictions)),
            ("What these data can tell", found),
        ]
        return [(title, sentences) for title, sentences in sections if sentences]

    def sentences(self) -> list[str]:
        """All sentences."""
        return [sentence for _, sentences in self.sections() for sentence in sentences]

    def to_dict(self) -> dict[str, Any]:
        """Everything as plain types."""
        found = None if self.identifiability is None else self.identifiability.as_dict()
        return {"model": self.model, "sections": dict(self.sections()), "identifiability": found}


def check_problem(problem: StatisticalModel, seed: int = 1) -> CheckReport:
    """Check a problem before sampling.

    Parameters
    ----------
    problem : any problem
    seed : seed of the prior draws

    Raises
    ------
    InputError
        No prior draw gives a finite prediction.
    """
    most = FEWEST_DRAWS if solved_anew(problem) else DRAWS
    count = max(FEWEST_DRAWS, min(most, PREDICTIONS // problem.conditions.n_rows))
    draws = problem.draw_prior(np.random.default_rng([seed, 3]), count) if problem.free else np.zeros((1, 0))
    predictions, usable, positive = predictions_over(problem, draws)
    identifiability = None
    if problem.observed is not None and problem.free:
        with explained(problem.spec.path, "what the data can tell cannot be computed"):
            identifiability = _identify(problem, draws[usable], positive)
    with explained(problem.spec.path, "how the prediction goes with the load cannot be computed"):
        predictions += load_powers(problem)
    return CheckReport(problem.name, setup(problem), prior_sentences(problem), predictions, identifiability)


def solved_anew(problem: StatisticalModel) -> bool:
    """Whether a prediction takes hundredths of a second because the model has no table."""
    return problem.forward.expensive and problem.forward.prepare is None


def setup(problem: StatisticalModel) -> tuple[str, ...]:
    """What the problem is made of, in sentences."""
    free, fixed = len(problem.free), len(problem.fixed)
    tied = f", and {len(problem.tied)} tied to others" if problem.tied else ""
    said = [
        f"'{problem.name}' has {free} free and {fixed} fixed inputs{tied}; every value has a unit and lies in its physical range."
    ]
    if problem.dataset is not None:
        rows = problem.conditions.n_rows
        observed = "; ".join(f"{o.name}, noise {o.noise.name}" for o in problem.observations)
        said.append(f"{row_count(rows)} of {problem.dataset.shown}: {observed}.")
        said += data_notes(problem)
        if free > rows:
            said.append(
                f"There are more free parameters ({free}) than data ({rows}): the priors decide what remains open."
            )
    else:
        said.append(
            "It has no data here: give yours with --data FILE.csv."
            if problem.spec.observables
            else "It has no data: it serves 'predict' only."
        )
    if problem.surface_prior is not None:
        said.append(problem.surface_prior.sentence())
    said += surface_sentence(problem, problem.prior_medians(), " at the prior medians" if free else "")
    said += people_sentences(problem)
    return tuple(said)


def people_sentences(problem: StatisticalModel) -> list[str]:
    """Of how many people the data can tell each parameter that has a population, at the prior medians."""
    found = problem.populations
    if found is None:
        return []
    said, centre = [], problem.prior_medians()
    step = 0.1
    places = [i for i, p in enumerate(problem.free) if p.name == DEVIATE]
    moved = np.tile(centre, (len(places) + 1, 1))
    moved[range(1, len(moved)), places] += step
    with np.errstate(all="ignore"):
        positive = problem.predict_data(centre) > 0
        at = scattered(problem, centre, np.asarray(positive))(moved)
    size = np.linalg.norm((at[1:] - at[0]) / step, axis=1)
    names = [problem.names[i] for i in places]
    for spec, parts in found.at(problem.conditions):
        for number, part in enumerate(parts):
            told = [size[names.index(label)] for label in part.deviates]
            if not told:
                continue
            known = sum(1.0 / np.sqrt(1.0 + s * s) < INFORMED for s in told)
            what = (
                f"of {len(told)} levels of {spec.by}"
                if not number
                else f"of {len(told)} levels of {spec.within} within {spec.by}"
                if part.location is None
                else f"and what {part.location.rpartition(', ')[2].removesuffix(']')} does to it, of {len(told)} levels of "
                f"{spec.by}"
            )
            said.append(
                f"{spec.name} has a population {what}. At the prior medians the data tell {known} of them apart from the "
                f"others{'' if known == len(told) else '; of the rest the population speaks'}."
            )
        labels = problem.conditions.labels
        levels = len(set(labels[spec.by].tolist()))
        if levels < FEW_PEOPLE and spec.scale.value is None:
            said.append(
                f"{levels} levels of {spec.by} hardly tell how far others differ: {spec.scale.label} will rest on its prior; "
                "state it with its source."
            )
        if any(group.level == spec.by for group in problem.spec.groups):
            said.append(
                f"{spec.by} is in [groups] and has a population of {spec.name}: if both act on the same rows alike, only "
                "their sum is known; drop one of them."
            )
        for treatment, both in both_ways(spec, labels).items():
            rests = (
                "the contrast rests on these"
                if both
                else f"the contrast compares different levels of {spec.by}, and is no better known than how they differ anyway"
            )
            assert spec.contrast is not None
            said.append(
                f"{both} of {levels} levels of {spec.by} were measured with and without the treatment '{treatment}', "
                f"which acts on {spec.name}; {rests}."
            )
    if problem.shared is not None:
        said.append(
            "People are not independent of each other where effects, curves or noise are shared by rows: all parameters are then "
            f"moved together, which takes far longer in {problem.dimension} dimensions than person by person."
        )
    return said


def prior_sentences(problem: Posterior) -> tuple[str, ...]:
    """A sentence on each free parameter and each that is tied."""
    said = []
    for p in problem.free:
        if p.name == DEVIATE:  # one for each person, all the same
            continue
        interval = p.prior.interval(0.9) if p.prior else ()
        ends = " and ".join(format_quantity(end, p.unit, 3, p.prior_text) for end in interval)
        source = "" if p.source else " No source is given."
        said.append(f"{p.label}: {p.prior_text}; 90 % between {ends}.{source}")
    said += [f"{p.label} {p.prior_text}, and is not free." for p in problem.tied]
    return tuple(said)


def predictions_over(
    problem: StatisticalModel, draws: FloatArray
) -> tuple[tuple[str, ...], NDArray[np.bool_], NDArray[np.bool_]]:
    """Sentences about finite predictions, which of the draws have them, and which data are predicted > 0 by all of those."""
    finite, positive = np.ones(len(draws), dtype=bool), np.ones(0, dtype=bool)
    impossible = 0
    step = max(1, PIECE // (problem.likelihood.size if problem.observations else problem.conditions.n_rows))
    for start in range(0, len(draws), step):  # nothing is kept but what the sentences need
        predicted = problem.predict(draws[start : start + step])
        names = problem.observables if problem.observations else tuple(predicted)
        found = np.all([has_value(name, predicted[name]).all(axis=-1) for name in names], axis=0)
        finite[start : start + step] = found
        if problem.observations:
            above = [(predicted[name][found] > 0).all(axis=0) for name in problem.observables]
            positive = np.concatenate(above) & (positive if start else True)
            with np.errstate(all="ignore"):
                density = problem.likelihood.given(draws[start : start + step], predicted)[found]
            impossible += int((~np.isfinite(density)).sum())
    if not finite.any():
        _, missing = predicted_everywhere(problem, draws[:FEWEST_DRAWS])
        raise InputError(
            f"{problem.spec.path}: none of {len(draws)} prior draws gives a finite prediction; {missing}"
        )
    if not problem.free:
        return ("The prediction is finite at all conditions.",), finite, positive
    if finite.all():
        said = [f"All of {len(draws)} prior draws give finite predictions."]
    else:
        first = draws[~finite][0]
        where = ", ".join(f"{name} = {value:.4g}" for name, value in zip(problem.names, first, strict=True))
        said = [
            f"{(~finite).sum()} of {len(draws)} prior draws give no finite prediction (taken as impossible); first at {where}."
        ]
    if impossible:
        said.append(f"{impossible} of them give the data no probability at all.")
    return tuple(said), finite, positive


def entering(problem: Posterior) -> list[int]:
    """Places of the free parameters that enter predictions, not scatter alone."""
    scatter = (*noise_parameter_names(), *SCATTER_PARAMETERS, *POPULATION_PARAMETERS)
    return [i for i, parameter in enumerate(problem.free) if parameter.name not in scatter]


def with_others(centre: FloatArray, places: list[int]) -> Callable[[FloatArray], FloatArray]:
    """What completes vectors of some parameters ``(B, K)`` to vectors of all ``(B, D)``, the others at ``centre``."""

    def full(theta: FloatArray) -> FloatArray:
        vectors = np.tile(centre, (len(theta), 1))
        vectors[:, places] = theta
        return vectors

    return full


def scattered(
    problem: StatisticalModel, centre: FloatArray, positive: NDArray[np.bool_]
) -> Callable[[FloatArray], FloatArray]:
    """Predictions of all data at vectors ``(B, D)`` as numbers that scatter independently with width 1, ``(B, M + G)``.

    Parameters
    ----------
    problem : with data
    centre : parameter vector whose noise is taken, shape ``(D,)``
    positive : which data are predicted > 0 over all of the prior, shape ``(M,)``
    """
    typical = problem.predict_data(centre)
    if not np.isfinite(problem.independent_scatter(centre, np.zeros((1, len(typical))))).all():
        raise InputError(
            f"{problem.spec.path}: noise: at the prior medians the noise is so small beside the effects of groups "
            f"({problem.noise_width(centre).min():.2g}) that data of one group could not differ; expected a larger noise_scale"
        )
    logarithmic = (typical > 0) & positive
    # what scatters is taken on the scale of the predictions
    scale = np.where(logarithmic & ~problem.noise_is_logarithmic, 1 / typical, 1.0)

    def predict(theta: FloatArray) -> FloatArray:
        predicted = problem.predict_data(theta)
        with np.errstate(all="ignore"):
            values = np.where(logarithmic, np.log(predicted), predicted)
            # group effects make data scatter together: what only shifts a whole group is not taken for information
            return problem.independent_scatter(centre, values / scale)

    return predict


def _identify(
    problem: StatisticalModel, draws: FloatArray, positive: NDArray[np.bool_]
) -> Identifiability | None:
    places = entering(problem)
    if not places:
        return None
    centre = problem.prior_medians()
    full, predict = with_others(centre, places), scattered(problem, centre, positive)

    def blocks(theta: FloatArray) -> dict[str, FloatArray]:
        # the quantity of each parameter vector; a block that the parameters leave alone comes once for all
        found = problem.forward.derived(problem.inputs(full(theta)), problem.tables)
        shape = (len(theta), problem.conditions.n_rows)
        repeats = len(problem.observations)
        return {
            name: np.tile(np.broadcast_to(found[name], shape), repeats) for name in problem.forward.blocks
        }

    def derived(theta: FloatArray) -> dict[str, FloatArray]:
        return named_in_pieces(blocks, theta, problem.conditions.n_rows)

    return identify(
        [problem.names[i] for i in places],
        lambda theta: predict(full(theta)),
        draws[:, places],
        1.0,
        rows=len(positive),
        groups=_groups(problem),
        derived=derived,
        maximum_draws=FEW_POINTS if solved_anew(problem) else POINTS,
    )


def _groups(problem: StatisticalModel) -> dict[str, NDArray[np.intp]]:
    groups: dict[str, NDArray[np.intp]] = {}
    if problem.shared is not None:  # rows scatter together, so that none of them stands by itself
        return groups
    several, rows = len(problem.observations), problem.conditions.n_rows
    if several > 1:
        groups |= {o.name: np.arange(rows) + i * rows for i, o in enumerate(problem.observations)}
    for values in problem.conditions.labels.values():
        levels = list(dict.fromkeys(values))
        if 2 <= len(levels) <= MOST_LEVELS:
            groups |= {str(level): np.flatnonzero(np.tile(values == level, several)) for level in levels}
    return groups
