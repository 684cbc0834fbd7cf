"""What tables of films under the ball itself have beside those of its cylinder: smooth films, and where the drag ends."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.contact.hertz import sphere_contact
from skinbayes.contact.solid import reduced_modulus
from skinbayes.emulation.chebyshev import grid_coefficients, zeros
from skinbayes.lubrication._uniform_spline import spline_coefficients
from skinbayes.lubrication.film_axes import film_scales, unit_contact
from skinbayes.lubrication.film_reference import HIGHEST, HIGHEST_WITH_END, LOWEST, STEP, SmoothFilms
from skinbayes.lubrication.film_table import REFERENCE
from skinbayes.lubrication.point_drag import point_drag_integrals
from skinbayes.lubrication.point_film import point_sweeps
from skinbayes.lubrication.transport import no_asperities, transport_of

TERMS = 6
"""Polynomials of the end of the drag."""

_SKIPPED = 12  # of the slowest speeds of a smooth cylinder: thinner than cells resolve; each output is a power of λ there
_CELLS, _CELLS_WITH_END = 800, 500  # with an end the films of each of the ends are solved
_PART = 4  # speeds that share a grid: none holds the edges of thin and of thick films


def log_end(
    log_parameters: Sequence[FloatArray], poisson_ratio_bulk: float, inlet_length: float | None = None
) -> FloatArray:
    """ln of the radius at which the drag of a ball ends over that of its contact, for ln of the parameters, SI.

    It ends where the ball does, or at the ``inlet_length``, m, from the contact, where the liquid does.
    """
    hertz = sphere_contact(1.0, 1.0, reduced_modulus=1.0)
    if inlet_length is not None:
        _, bulk, _, radius, force, _ = log_parameters
        modulus = bulk + np.log(reduced_modulus(1.0, poisson_ratio_bulk))
        log_radius = np.log(hertz.contact_radius) + (force + radius - modulus) / 3
        return np.asarray(np.log1p(inlet_length * np.exp(-log_radius)))
    half_width, cylinder = unit_contact(0.0)
    strain = film_scales(log_parameters, poisson_ratio_bulk).strain
    # unit_contact has E* = 1 for ν = 0; both a/R and b/Rc go as (F/(E* R²))^(1/3)
    slope = strain + (np.log(float(hertz.contact_radius)) - half_width + cylinder)
    return np.asarray(np.logaddexp(0.0, -4 * slope) / 4)


def log_number_ratio() -> float:
    """ln of λ of a ball over that of its cylinder, whatever the ball."""
    hertz = sphere_contact(1.0, 1.0, reduced_modulus=1.0)
    half_width, cylinder = unit_contact(0.0)
    line = np.log(12.0) + 3 * cylinder - 4 * half_width
    return float(np.log(6 / (hertz.contact_radius**3 * hertz.maximum_pressure)) - line)


def smooth_point_films(low: float, high: float, *, endless: bool = True) -> SmoothFilms:
    """Films under a smooth ball in the units of its cylinder; ln of the end of the drag is from ``low`` to ``high``.

    Unless the liquid is ``endless`` it ends there too, so that all outputs depend on the end.
    """
    highest = HIGHEST if endless else HIGHEST_WITH_END
    log_number = LOWEST + STEP * np.arange(_SKIPPED, round((highest - LOWEST) / STEP) + 1)
    number = np.exp(log_number + log_number_ratio())
    hertz = sphere_contact(1.0, 1.0, reduced_modulus=1.0)
    half_width, cylinder = (float(np.exp(x)) for x in unit_contact(0.0))
    slope, line_slope = float(hertz.contact_radius), half_width / cylinder
    height = slope**2 / (half_width**2 / cylinder)
    ends = np.exp(low + (high - low) * (zeros(TERMS) + 1) / 2)
    found = np.empty((4, TERMS, number.size))
    smooth = transport_of(None, None, 1.0, 1.0)
    for group in [ends] if endless else np.split(ends, TERMS):
        sweeps = (
            (part[rows], grid, film, pressure)
            for part in np.array_split(np.arange(number.size), number.size // _PART)
            for rows, grid, film, pressure in point_sweeps(
                number[part], number[part] > 0, no_asperities, smooth, rough=0.0, tail=0.0, end=float(group.max()),
                cells=_CELLS if endless else _CELLS_WITH_END, endless=endless,
            )
        )  # fmt: skip
        for rows, grid, film, pressure in sweeps:
            for end in group.tolist():
                place = int(np.flatnonzero(ends == end)[0])
                drag = point_drag_integrals(grid, film, pressure, number[rows], end=end, height=1.0)
                couette = number[rows] * slope / (4 * np.pi) * drag.couette
                whole = couette + 3 * slope / (4 * np.pi) * drag.pressure_flow
                found[:, place, rows] = np.array(
                    [
                        film[:, : grid.rays].mean(axis=1) * height,
                        couette * 3 * np.pi / line_slope / np.exp(log_number[rows]),
                        whole * np.pi / line_slope,
                        film.min(axis=1) * height,
                    ]
                )
    logs = np.log(found)
    series = [grid_coefficients(part, ends=False) for part in logs]
    if endless:  # only the drag depends on its end
        series[0], series[3] = logs[0, :1], logs[3, :1]
    return SmoothFilms(spline_coefficients(np.concatenate(series)), float(log_number[0]), STEP, not endless)


def end_coordinate(log_ends: FloatArray, low: float, high: float) -> FloatArray:
    """ln of the end of the drag, −1 … 1 between ``low`` and ``high``."""
    return np.asarray((2 * log_ends - low - high) / (high - low))


def relative_outputs(
    outputs: FloatArray, log_number: FloatArray, smooth: SmoothFilms, end: FloatArray | None = None
) -> FloatArray:
    """Outputs of shape ``(M, 6, S)`` over those of the smooth ball, but for the boundary term and the load fraction."""
    found = outputs.copy()
    parts = smooth(log_number, range(4), end=None if end is None else end[:, None])
    for output, reference in REFERENCE.items():
        found[:, output] -= parts[reference]
    return found
