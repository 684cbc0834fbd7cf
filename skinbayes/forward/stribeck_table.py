"""Stribeck curves from a table of films that is built once for the ranges of the priors and kept on disk."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

import numpy as np

from skinbayes.arrays import BoolArray, FloatArray
from skinbayes.emulation import Progress, kept_table
from skinbayes.forward.base import ForwardModel, Inputs, Ranges, Tables
from skinbayes.forward.contact_inputs import GOES_WITH, spectrum_of
from skinbayes.forward.pad import AREA_DEFAULTS, PAD, check_one_inlet, film_counts, film_ranges, with_ball
from skinbayes.forward.stribeck_direct import (
    BALL,
    FIELDS,
    FLAGS,
    Theory,
    counted,
    film_flags,
    limit_of,
    speed_viscosity_product_of,
)
from skinbayes.lubrication import (
    FILM_PARAMETERS,
    HOMOGENEOUS_PARAMETERS,
    LARGE_STRAIN,
    LARGEST_STRAIN,
    NOTABLE_STRAIN,
    POINT,
    FilmTable,
    FilmTablePlan,
    FlowCurve,
    LiquidRows,
    LubricatedBalls,
    build_film_table,
    liquid_rows,
    tabulated_friction,
    tabulated_friction_of_liquids,
)
from skinbayes.lubrication.viscoelastic_correction import RememberingTissue
from skinbayes.roughness import rms_height

AFTERWARDS = (
    "frictional_shear_stress", "velocity_shift_factor", "additive_friction", "speed_viscosity_product", "viscosity",
    "sliding_speed", "inlet_film_limit",
)  # fmt: skip
"""Inputs that enter exactly, whatever the table."""

AREA = ("nominal_contact_area", *AREA_DEFAULTS)
"""Inputs that say how wide a pad touches."""

_MISSING = "the table of films ends before"

HELD = (*FILM_PARAMETERS, *HOMOGENEOUS_PARAMETERS[:1])
"""Inputs that are axes of the table, if they vary."""


@dataclass(frozen=True, eq=False)
class TabulatedStribeck:
    """Evaluation of the forward model from a table of films; picklable.

    Attributes
    ----------
    table : films for all inputs that vary
    names : inputs of the forward model
    pad : the ball is that of the contact area
    """

    table: FilmTable
    names: tuple[str, ...]
    pad: bool
    fields = FIELDS  # observables and the fields of the friction they are

    def skin(self, inputs: Inputs) -> tuple[Inputs, RememberingTissue | None]:
        """Inputs with the moduli that the contact meets, and the memory of the tissue; None if it is elastic."""
        return inputs, None

    def evaluate(self, inputs: Inputs, tables: Tables) -> dict[str, FloatArray]:
        """Observables ``(B, N)``; nan for what the table does not hold, which is next to nothing of the prior."""
        found, _ = self._friction(*self.skin(inputs), tables)
        return {name: found[name] for name in self.fields}

    def flags(self, inputs: Inputs, tables: Tables) -> dict[str, BoolArray]:
        """The flags of `FLAGS`, each ``(B, N)``."""
        inputs, tissue = self.skin(inputs)
        found, products = self._friction(inputs, tissue, tables)
        shape, strain = products.shape, found["strain"]
        return {
            "strained": strain > NOTABLE_STRAIN,
            "largely_strained": strain > LARGE_STRAIN,
            "strained_beyond_ball": strain > LARGEST_STRAIN,
            **{name: np.broadcast_to(flag, shape) for name, flag in film_flags(inputs, products).items()},
            "shear_rate_unmeasured": found["shear_rate_unmeasured"] > 0,
        }

    def explain(self, inputs: Inputs, tables: Tables) -> list[str]:
        """What the flags say, counted, and how many points the table does not hold: no film is solved for it."""
        missing = ~np.isfinite(self.evaluate(inputs, tables)["friction_coefficient"])
        return counted({"missing": missing, **self.flags(inputs, tables)}, {"missing": _MISSING, **FLAGS})

    def abscissa(self, inputs: Inputs, tables: Tables) -> FloatArray:
        """Speed times the viscosity in the film, N/m, ``(B, N)``."""
        return self._friction(*self.skin(inputs), tables)[1]

    def _friction(
        self, inputs: Inputs, tissue: RememberingTissue | None, tables: Tables
    ) -> tuple[dict[str, FloatArray], FloatArray]:
        if self.pad:
            inputs = with_ball(inputs)
        parameters = {name: inputs[name] for name in HELD if name in inputs}
        if "rms_height" not in parameters and tables.spectrum is not None:
            parameters["rms_height"] = np.asarray(rms_height(tables.spectrum))
        balls = LubricatedBalls(
            parameters=parameters,
            frictional_shear_stress=inputs["frictional_shear_stress"],
            velocity_shift_factor=inputs["velocity_shift_factor"],
            everything=True,
            thickest_film=np.inf if self.pad else limit_of(inputs, "inlet_film_limit"),
            largest_strain=limit_of(inputs, "strain_limit"),
            tissue=tissue,
        )
        if tables.flow_curves is None:
            products = speed_viscosity_product_of(inputs)
            friction = tabulated_friction(self.table, products, balls=balls)
            unmeasured = np.zeros(friction.friction_coefficient.shape)
        else:
            friction, liquid = tabulated_friction_of_liquids(
                self.table, inputs["sliding_speed"], balls=balls, liquids=_liquids(tables.flow_curves)
            )
            products = inputs["sliding_speed"] * liquid.viscosity
            unmeasured = liquid.unmeasured.astype(float)
        found = {name: np.array(getattr(friction, field)) for name, field in self.fields.items()}
        found |= {"strain": friction.strain, "shear_rate_unmeasured": unmeasured}
        products = np.array(np.broadcast_to(products, unmeasured.shape))
        found["friction_coefficient"] = found["friction_coefficient"] + inputs.get("additive_friction", 0.0)
        return found, products


@lru_cache(maxsize=4)
def _liquids(flow_curves: tuple[FlowCurve, ...]) -> LiquidRows:
    """The tabulated flow curves of rows; the same at every evaluation of a likelihood."""
    return liquid_rows(flow_curves)


def film_plan(held: Ranges, ranges: Ranges, tables: Tables, theory: Theory) -> FilmTablePlan:
    """Plan of the table for the ranges of `FILM_PARAMETERS` in ``held`` and whatever else is fixed."""
    fixed = {name: np.array(low) for name, (low, _) in ranges.items()}
    spectrum = spectrum_of(fixed, tables)
    numbers: Any = {
        name: float(fixed["poisson_ratio" if "young_modulus" in fixed and name in GOES_WITH else name])
        for name in ("poisson_ratio_layer", "poisson_ratio_bulk", "area_correction")
    }
    held = {"rms_height": (float(np.asarray(rms_height(spectrum))),) * 2, **held}
    of_contact: Any = {"contact": theory.contact}
    if theory.contact == PAD:
        held = film_ranges(held, numbers["poisson_ratio_bulk"])
        of_contact = {
            "contact": POINT,
            "counts": film_counts(held),
            "inlet_length": float(fixed["inlet_length"]),
        }
    return FilmTablePlan(
        held,
        spectrum=spectrum,
        largest_strain=float(fixed["strain_limit"]),
        flow_factors=theory.flow_factors,
        **of_contact,
        **numbers,
    )


def kept_films(plan: FilmTablePlan, progress: Progress | None, cores: int) -> FilmTable:
    """The table of a plan, from disk if it was built before."""
    table = kept_table(
        "stribeck",
        plan.key(),
        FilmTable,
        lambda unfinished: build_film_table(plan, processes=cores, progress=progress, kept=unfinished),
    )
    assert table is not None
    return table


def prepare(
    model: ForwardModel,
    ranges: Ranges,
    tables: Tables,
    progress: Progress | None,
    cores: int,
    theory: Theory = BALL,
) -> ForwardModel:
    """The forward model with a table of films for the ranges, from disk if it was built before.

    Inputs of `FILM_PARAMETERS` may vary, those of `AFTERWARDS` may do what they like; where anything else varies the film solver
    itself is used, which is slow.
    """
    names = model.input_names()
    check_one_inlet(ranges)
    if "young_modulus_dermis" in ranges or "young_modulus_fat" in ranges:
        return replace(
            model,
            accuracy="Each curve is solved by itself, which is slow: tables of films hold skin of one layer.",
        )
    varying = [
        name
        for name, (low, high) in ranges.items()
        if low != high and name in names and name not in (*HELD, *AFTERWARDS, *AREA)
    ]
    if varying:
        return replace(
            model,
            accuracy=f"Each curve is solved by itself, which is slow: a table of films cannot be used while "
            f"{' and '.join(varying)} {'varies' if len(varying) == 1 else 'vary'}.",
        )
    held = {name: ranges[name] for name in (*HELD, *AREA) if name in ranges}
    plan = film_plan(held, ranges, tables, theory)
    table = kept_films(plan, progress, cores)
    tabulated = TabulatedStribeck(table, names, theory.contact == PAD)
    middle, far, worst = (100 * float(error) for error in table.held_out)
    return replace(
        model,
        evaluate=tabulated.evaluate,
        flags=tabulated.flags,
        explain=tabulated.explain,
        abscissa=tabulated.abscissa,
        accuracy=f"Friction is read from a table of films of a {theory.contact} contact; at {table.held_out_count} places that "
        f"it was not made from it differs from the film solver by {middle:.2g} % in the median, {far:.2g} % at the 99th "
        f"percentile and {worst:.2g} % at worst. Beyond the table"
        + ("" if theory.contact == PAD else ", which holds each prior but for 0.001 % on either side,")
        + " parameters count as impossible.",
    )
