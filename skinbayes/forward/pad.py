"""A finger pad, pressed flat: its nominal contact is given by an area, not by a ball.

Under the pressure of Hertz a contact of radius a leaves around it the gap of the ball of radius ``R = 4 E1* a³/(3 F_N)``,
whatever bone and shape of the finger made it so wide. With this R for each row the film is that of a ball; but the liquid ends
at the ``inlet_length``, beyond which the finger curves away.
"""

from __future__ import annotations

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.contact import reduced_modulus, sphere_of_contact
from skinbayes.errors import InputError
from skinbayes.forward.base import Inputs, Ranges, Tables
from skinbayes.forward.contact_inputs import skin_of, validate_contact

PAD = "pad"
"""A contact whose nominal area is given."""

REFERENCE_LOAD = 1.0
"""Load at which the nominal contact area is ``nominal_area_ratio`` times the area given, N."""

_ROUGHEST = 2.0  # h R/a², the roughness over the height of the ball's edge, in a table

_NODES_PER_LOGARITHM = {"young_modulus_layer": 0.65, "rms_height": 0.85, "sphere_radius": 0.7}

AREA_DEFAULTS = {"nominal_area_ratio": 1.0, "nominal_area_load_exponent": 0.0}
"""The area given is the nominal contact area under the load of its row."""


def contact_radius_of(inputs: Inputs) -> FloatArray:
    """Radius a of the nominal contact, m: ``π a² = c_A A0 (F_N/1 N)^m_A``."""
    load = inputs["normal_force"] / REFERENCE_LOAD
    with np.errstate(all="ignore"):
        area = (
            inputs["nominal_area_ratio"]
            * inputs["nominal_contact_area"]
            * load ** inputs["nominal_area_load_exponent"]
        )
        return np.asarray(np.sqrt(area / np.pi))


def validate_pad(inputs: Inputs, tables: Tables) -> None:
    """Raise InputError naming the input of spectrum, solid or inlet, m, that cannot be."""
    validate_contact(inputs, tables)
    lengths = np.asarray(inputs["inlet_length"])
    check_one_inlet({"inlet_length": (float(lengths.min()), float(lengths.max()))})


def with_ball(inputs: Inputs) -> dict[str, FloatArray]:
    """The inputs with the ``sphere_radius`` of the ball that has the contact of the pad, m."""
    modulus = skin_of(inputs).contact_modulus
    radius = sphere_of_contact(inputs["normal_force"], contact_radius_of(inputs), reduced_modulus=modulus)
    left = {
        name: value for name, value in inputs.items() if name not in ("nominal_contact_area", *AREA_DEFAULTS)
    }
    return left | {"sphere_radius": radius}


def check_one_inlet(ranges: Ranges) -> None:
    """Raise InputError if the inlet length is not the same everywhere, m: it shapes the grid of the films, or their table."""
    low, high = ranges.get("inlet_length", (1.0, 1.0))
    if low != high:
        raise InputError(
            f"inlet_length goes from {low:.3g} to {high:.3g} m, but has to be one fixed length; vary it from one fit to the next"
        )


def film_counts(ranges: Ranges) -> dict[str, int]:
    """Numbers of nodes of the axes of a table of films, for the `film_ranges`, SI."""
    return {
        name: 4 + int(np.ceil(density * np.log(ranges[name][1] / ranges[name][0])))
        for name, density in _NODES_PER_LOGARITHM.items()
        if name in ranges
    }


def film_ranges(ranges: Ranges, poisson_ratio: float) -> dict[str, tuple[float, float]]:
    """Ranges of similar balls under one load on tissue of one modulus, for a table of films.

    Films depend on E1/E0, F R/E1 ∝ a³ and h R, or h E1/F in its place. In these the area given, the modulus and the load of a
    pad enter once each; a box of its balls, whose radii go with all of them, would be far too large.

    Parameters
    ----------
    ranges : of the inputs of a pad, SI
    poisson_ratio : of the tissue

    Returns
    -------
    dict
        Ranges of the parameters of a table of films, SI.
    """
    logs = {name: np.log(np.array(both)) for name, both in ranges.items() if both[0] > 0}
    bulk_name = "young_modulus" if "young_modulus" in ranges else "young_modulus_bulk"
    bulk, load = logs[bulk_name], logs["normal_force"]
    one_bulk, one_load = bulk.mean(), load.mean()
    growth = np.multiply.outer(np.array(ranges["nominal_area_load_exponent"]), load - np.log(REFERENCE_LOAD))
    area = logs["nominal_contact_area"] + logs["nominal_area_ratio"] + np.array([growth.min(), growth.max()])
    per_cube = sphere_of_contact(
        np.exp(one_load), 1.0, reduced_modulus=reduced_modulus(np.exp(one_bulk), poisson_ratio)
    )
    found = {
        "sphere_radius": np.log(per_cube) + 1.5 * (area - np.log(np.pi)),
        "rms_height": logs["rms_height"] + (bulk - one_bulk) - (load[::-1] - one_load),
        "normal_force": np.array([one_load, one_load]),
        bulk_name: np.array([one_bulk, one_bulk]),
    }
    # a pad that is flat in comparison with its roughness touches up to the end of the liquid
    flattest = np.log(_ROUGHEST) + 2 * (area[1] - np.log(np.pi)) / 2 - found["sphere_radius"][1]
    found["rms_height"][1] = max(min(found["rms_height"][1], flattest), found["rms_height"][0] + 1e-3)
    if "young_modulus_layer" in logs:
        found["young_modulus_layer"] = logs["young_modulus_layer"] - (bulk[::-1] - one_bulk)
        found["layer_thickness"] = logs["layer_thickness"]
    return {name: (float(np.exp(low)), float(np.exp(high))) for name, (low, high) in found.items()}
