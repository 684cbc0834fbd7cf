"""Forward model ``humid-air``: contact and friction of skin in equilibrium with humid air (Appendix A, Figs. 16 and 17).

Bridges of a few nanometres pull the skin together, and the modulus of the layer follows the humidity. The capillary pressure is
that of elastic gaps. The contact area is then elastoplastic under load and capillary pressure together, as in ``drying``: dry
stiff skin yields, and without that the friction of dry skin would come out a hundred times too small. Where contacts have
yielded the gaps beside them are not the elastic ones, but there the capillary pressure is a few percent of the load. With an
infinite yield stress, the default, the area is the elastic one of Fig. 16.
"""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np

from skinbayes.arrays import BoolArray, FloatArray
from skinbayes.contact import total_contact_area, twice_stress_variance
from skinbayes.forward.base import ROUGHNESS_INPUTS, ForwardModel, Inputs, Profile, Tables, profiles_against
from skinbayes.forward.capillary_film import CLOSURES, Closure
from skinbayes.forward.contact_inputs import (
    GOES_WITH,
    PRESSURE_AND_SLOPE,
    SOLID_INPUTS,
    nominal_pressure_of,
    one_layer_skin_of,
    spectrum_of,
)
from skinbayes.forward.deduplicated_rows import along_rows
from skinbayes.forward.humid_air_inputs import (
    AIR_INPUTS,
    CURVE_INPUTS,
    HUMID_AIR_DEFAULTS,
    HUMID_AIR_INPUTS,
    MODULUS_ALTERNATIVES,
    bridges_form,
    kelvin_gap_of,
    kelvin_radius_of,
    validate_humid_air,
    with_modulus,
)
from skinbayes.forward.humid_air_table import TabulatedBridges, prepared_humid_air
from skinbayes.forward.small_contact import SMALL_CONTACT, small_contact_flags
from skinbayes.friction import friction_coefficient
from skinbayes.wetting import MOLECULE_DIAMETER, capillary_state_in_humid_air, is_below_molecule

OBSERVABLES = ("friction_coefficient", "relative_contact_area", "kelvin_radius", "capillary_pressure")

STRONG_BRIDGES = 0.5
"""Capillary pressure over load from which the two closures of the gaps differ by more than about 20 % in the contact area."""

FLAGS = {
    "strong_bridges": f"bridges pull with more than {STRONG_BRIDGES:g} of the load; how hard hangs on the closure of the gaps "
    "(the option closure), so rely neither on the value nor on the humidity at which contact is lost",
    "below_molecule": f"bridges span less than {MOLECULE_DIAMETER * 1e9:g} nm, the size of a water molecule, and are no more "
    "than a figure of speech",
    **SMALL_CONTACT,
}
"""Flags and what they say."""

_PRESSES = {
    *AIR_INPUTS,
    *ROUGHNESS_INPUTS,
    *SOLID_INPUTS,
    "area_correction",
    "nominal_pressure",
}
"""What the capillary pressure depends on."""


def _with_pressing(inputs: Inputs) -> dict[str, FloatArray]:
    """The inputs with the modulus of the layer and the nominal pressure, however they were given."""
    return {**with_modulus(inputs), "nominal_pressure": nominal_pressure_of(inputs)}


def _solved(inputs: Inputs, humidity: FloatArray, tables: Tables, closure: Closure) -> dict[str, FloatArray]:
    water: Any = {
        name: inputs[name] for name in ("contact_angle_skin", "contact_angle_counterface", "area_correction")
    }
    state = capillary_state_in_humid_air(
        humidity,
        inputs["temperature"],
        nominal_pressure=inputs["nominal_pressure"],
        spectrum=spectrum_of(inputs, tables),
        skin=one_layer_skin_of(inputs),
        closure=closure,
        count=False,
        **water,
    )
    return {"capillary_pressure": np.asarray(state.capillary_pressure)}


def _capillary_pressure(
    known: Inputs, tables: Tables, closure: Closure, table: TabulatedBridges | None
) -> FloatArray:
    """Capillary pressure of the bridges [Pa], shape ``(B, N)``, of inputs with the modulus of each row."""

    def solved(inputs: Inputs) -> FloatArray:
        pressing = {name: value for name, value in inputs.items() if name in _PRESSES}
        found = along_rows(pressing, "relative_humidity", partial(_solved, tables=tables, closure=closure))
        return found["capillary_pressure"]

    return solved(known) if table is None else table.capillary_pressure(known, tables, solved)


def _evaluate(
    inputs: Inputs, tables: Tables, closure: Closure, table: TabulatedBridges | None = None
) -> dict[str, FloatArray]:
    known = _with_pressing(inputs)
    load, capillary_pressure = known["nominal_pressure"], _capillary_pressure(known, tables, closure, table)
    twice_variance = twice_stress_variance(spectrum_of(known, tables), one_layer_skin_of(known))
    area = total_contact_area(
        load + capillary_pressure,
        twice_variance,
        yield_stress=known["yield_stress"],
        area_correction=known["area_correction"],
    )
    return {
        "friction_coefficient": np.asarray(
            friction_coefficient(known["frictional_shear_stress"], area, nominal_pressure=load)
        ),
        "relative_contact_area": area,
        "kelvin_radius": kelvin_radius_of(known),
        "capillary_pressure": capillary_pressure,
    }


def _flags(
    inputs: Inputs, tables: Tables, closure: Closure, table: TabulatedBridges | None = None
) -> dict[str, BoolArray]:
    known = _with_pressing(inputs)
    capillary_pressure, gap = _capillary_pressure(known, tables, closure, table), kelvin_gap_of(known)
    below = (is_below_molecule(gap) > 0) & bridges_form(known)
    return {
        "strong_bridges": capillary_pressure > STRONG_BRIDGES * known["nominal_pressure"],
        "below_molecule": np.broadcast_to(below, capillary_pressure.shape),
        **small_contact_flags(inputs, tables),
    }


def _explain(inputs: Inputs, tables: Tables, closure: Closure) -> list[str]:
    """Where predictions are doubtful."""
    found = _flags(inputs, tables, closure)
    counts = {name: (int(np.count_nonzero(marked)), marked.size) for name, marked in found.items()}
    return [f"{n} of {total} rows: {FLAGS[name]}." for name, (n, total) in counts.items() if n]


def _grid(inputs: Inputs, tables: Tables) -> FloatArray:
    """Crowded towards saturated air, where the bridges grow from nanometres to flood the gap."""
    return np.concatenate([np.linspace(0.04, 0.96, 47), [0.97, 0.98, 0.985, 0.99, 0.995, 0.998, 1.0]])


def _profile(
    inputs: Inputs, tables: Tables, humidity: FloatArray, observable: str, closure: Closure
) -> FloatArray:
    column = {name: np.asarray(value)[..., np.newaxis] for name, value in inputs.items()}
    return _evaluate({**column, "relative_humidity": humidity[np.newaxis]}, tables, closure)[observable]


def _modulus(inputs: Inputs, tables: Tables, humidity: FloatArray) -> FloatArray:
    column = {name: np.asarray(value)[..., np.newaxis] for name, value in inputs.items()}
    return with_modulus({**column, "relative_humidity": humidity})["young_modulus_layer"]


def _profiles(closure: Closure) -> tuple[Profile, ...]:
    """Friction, contact area (Fig. 16) and modulus (Fig. 17) against humidity, one below the other."""
    titles = {
        "friction_coefficient": "Friction against relative humidity",
        "relative_contact_area": "Contact area against relative humidity",
    }
    predicted = profiles_against(
        "relative_humidity",
        titles,
        _grid,
        partial(_profile, closure=closure),
        called="humidity",
        uniform=("young_modulus_layer",),
    )
    modulus = Profile(
        name="young_modulus_against_humidity",
        title="Modulus of the stratum corneum against relative humidity",
        abscissa="relative_humidity",
        ordinate="young_modulus_layer",
        grid=_grid,
        evaluate=_modulus,
        needs=CURVE_INPUTS,
    )
    return (*predicted, modulus)


def humid_air_model(closure: Closure = "gaussian") -> ForwardModel:
    """Return the forward model with one of the closures of the gap distribution."""
    return ForwardModel(
        name="humid-air",
        summary="contact and friction of skin in humid air, drawn together by bridges of nanometres, against humidity",
        observables=OBSERVABLES,
        options=CLOSURES,
        variant=humid_air_model,
        chosen={"closure": closure},
        required=HUMID_AIR_INPUTS,
        exclusive=(MODULUS_ALTERNATIVES,),
        goes_with=GOES_WITH,
        optional=HUMID_AIR_DEFAULTS,
        expensive=True,
        prepare=prepared_humid_air if closure == "gaussian" else None,
        evaluate=partial(_evaluate, closure=closure),
        validate=validate_humid_air,
        explain=partial(_explain, closure=closure),
        flags=partial(_flags, closure=closure),
        flag_meanings=FLAGS,
        **PRESSURE_AND_SLOPE,
        profiles=_profiles(closure),
    )


MODEL = humid_air_model()
