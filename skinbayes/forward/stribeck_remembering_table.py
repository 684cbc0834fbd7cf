"""Stribeck curves on skin that is not elastic from a table of films and a correction of it, both kept on disk."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import product

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.emulation import Progress, kept_table
from skinbayes.forward.base import ForwardModel, Inputs, Ranges, Tables
from skinbayes.forward.stribeck_direct import Theory
from skinbayes.forward.stribeck_remembering import FIELDS, at_frequency, tissue_of, with_profile
from skinbayes.forward.stribeck_table import (
    AFTERWARDS,
    HELD,
    TabulatedStribeck,
    film_plan,
    kept_films,
)
from skinbayes.lubrication.contact_films import POINT
from skinbayes.lubrication.film_table import FilmTable
from skinbayes.lubrication.viscoelastic_correction import MemoryCorrection, RememberingTissue
from skinbayes.lubrication.viscoelastic_memory import RELAXATION_PARAMETERS, STANDARD_LINEAR_SOLID
from skinbayes.lubrication.viscoelastic_table import MemoryPlan, build_memory_correction

_WEAKEST = 1e-3  # strength up to which a correction reaches at least
_SPARE = 1e-6  # of ln, beyond the corners of the ranges
_STIFFENED = ("young_modulus_layer", "young_modulus_bulk")
_FIRST = 1e-9  # Δ in place of none, where a Deborah number is looked for


@dataclass(frozen=True, eq=False)
class RememberingStribeck(TabulatedStribeck):
    """`TabulatedStribeck` with the correction for tissue that is not elastic.

    Attributes
    ----------
    correction : what memory adds to the table
    terms : see `RememberingTissue`, where rows share the moduli of their skin
    """

    correction: MemoryCorrection
    terms: int
    fields = FIELDS

    def skin(self, inputs: Inputs) -> tuple[Inputs, RememberingTissue | None]:
        """Inputs with moduli at v/b, and the memory of the tissue."""
        tissue = tissue_of(inputs, self.correction.substrate)
        memory = {name: getattr(tissue, name) for name in ("strength", "place", "loss")}
        alike = all(np.shape(inputs[name])[-1:] in ((), (1,)) for name in _STIFFENED)
        return at_frequency(inputs, tissue), RememberingTissue(
            correction=self.correction, terms=self.terms if alike else None, **memory
        )


def prepare(
    model: ForwardModel,
    ranges: Ranges,
    tables: Tables,
    progress: Progress | None,
    cores: int,
    theory: Theory,
) -> ForwardModel:
    """The forward model with a table of films for the moduli at v/b and its correction, from disk if they were built before.

    Inputs of the films, of the material and those of `AFTERWARDS` may vary; where anything else does, each row is solved.
    """
    names = model.input_names()
    relaxing = RELAXATION_PARAMETERS[theory.substrate]
    slow = "Each row is solved by itself, which is slow: "
    if theory.flow_factors != "none":
        return replace(model, accuracy=f"{slow}tables of films hold no flow factors.")
    if not ranges["sliding_speed"][0] > 0:
        return replace(model, accuracy=f"{slow}there are rows that do not slide.")
    if varying := [
        name
        for name, (low, high) in ranges.items()
        if low != high and name in names and name not in (*HELD, *AFTERWARDS, *relaxing)
    ]:
        return replace(
            model,
            accuracy=f"{slow}a table of films cannot be used while {' and '.join(varying)} "
            f"{'varies' if len(varying) == 1 else 'vary'}.",
        )
    held, growth, strength, places = _at_corners(ranges, theory.substrate)
    films = film_plan(held, ranges, tables, theory)
    table = kept_films(films, progress, cores)
    of_ball = (
        theory.contact == POINT
    )  # the correction is that of its cylinder, which cannot be held against balls
    plan = MemoryPlan(films, substrate=theory.substrate, largest_strength=strength, places=places)
    plan = replace(plan, checked=0) if of_ball else plan
    correction = kept_table(
        "stribeck-memory",
        plan.key(),
        MemoryCorrection,
        lambda unfinished: build_memory_correction(
            plan, table, processes=cores, progress=progress, kept=unfinished
        ),
    )
    assert correction is not None
    tabulated = RememberingStribeck(table, names, False, correction, _terms(table, growth))
    middle, far, worst = (100 * float(error) for error in (table if of_ball else correction).held_out)
    said = (
        f"the table of elastic balls differs from the film solver by {middle:.2g} % in the median, {far:.2g} % at the 99th "
        f"percentile and {worst:.2g} % at worst of {table.held_out_count} places; what memory adds is taken from the cylinder of "
        "the ball, which was within 4 % in friction for a loss of 25 % and 7 % for 60 %"
        if of_ball
        else f"at {correction.held_out_count} places that they were not made from it differs from the film solver by "
        f"{middle:.2g} % in the median, {far:.2g} % at the 99th percentile and {worst:.2g} % at worst"
    )
    fast = replace(
        model,
        evaluate=tabulated.evaluate,
        flags=tabulated.flags,
        explain=tabulated.explain,
        abscissa=tabulated.abscissa,
        accuracy=f"Friction is read from a table of films of a {theory.contact} contact at the moduli of the frequency v/b, with "
        f"a correction for the memory of the tissue; {said}. Beyond the table, which holds all but the tails of the priors, "
        "parameters count as impossible.",
    )
    return with_profile(fast)


def _at_corners(
    ranges: Ranges, substrate: str
) -> tuple[dict[str, tuple[float, float]], list[float], float, tuple[float, float]]:
    """Ranges of the parameters of the films with moduli at v/b, by how much each of the two rises (ln), and the ranges of memory.

    Moduli at v/b, strength and Deborah number are monotonic in each input, so that they are largest and smallest at corners.
    """
    enter = (
        "sliding_speed", "normal_force", "sphere_radius", "young_modulus_layer", "young_modulus_bulk",
        *RELAXATION_PARAMETERS[substrate],
    )  # fmt: skip
    ends = dict(ranges)
    if substrate == STANDARD_LINEAR_SOLID:
        low, high = ends["relaxation_strength_bulk"]
        ends["relaxation_strength_bulk"] = (max(low, _FIRST), max(high, _FIRST))
    corners = np.array([*product(*(ends[name] for name in enter))]).T
    fixed = {"poisson_ratio_bulk": np.asarray(ranges["poisson_ratio_bulk"][0])}
    tissue = tissue_of({**dict(zip(enter, corners, strict=True)), **fixed}, substrate)
    held = {name: ranges[name] for name in HELD if name in ranges}
    rise = []
    for name, found in zip(_STIFFENED, (tissue.log_modulus_layer, tissue.log_modulus_bulk), strict=True):
        growth = found - np.log(corners[enter.index(name)])
        held[name] = _stiffened(ranges[name], growth)
        rise.append(float(np.ptp(growth)))
    largest = max(float(tissue.strength.max()), _WEAKEST)
    if substrate != STANDARD_LINEAR_SOLID:
        return held, rise, largest, (0.0, 0.0)
    return held, rise, largest, (float(tissue.place.min()) - _SPARE, float(tissue.place.max()) + _SPARE)


def _stiffened(given: tuple[float, float], growth: FloatArray) -> tuple[float, float]:
    """Range of a modulus at v/b, Pa, from its own range and ln of what it is multiplied by there.

    The tail of the prior and the fastest, most relaxing contact hardly meet: beyond the middle of the range an end reaches as
    far as the root of the sum of the squares of the two, which is both together where one of them does not vary.
    """
    low, high = np.log(given)
    middle, half = (low + high) / 2, (high - low) / 2
    least, most = float(growth.min()), float(growth.max())
    down = float(np.hypot(half, least)) if least < 0 else half - least
    up = float(np.hypot(half, most)) if most > 0 else half + most
    spare = _SPARE if most > least else 0.0
    return float(np.exp(middle - down - spare)), float(np.exp(middle + up + spare))


def _terms(table: FilmTable, growth: list[float]) -> int:
    """Terms that suffice, to 1e-4 of ln of the films, along the axis whose rows differ by no more than moduli rise."""
    if not table.axes.names:
        return 1
    half = sum(
        abs(factor) * rise / 2 for factor, rise in zip(table.axes.combination[0, :2], growth, strict=True)
    )
    return 3 + int(np.ceil(15 * half))
