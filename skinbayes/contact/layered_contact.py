"""Contact of a ball or a cylinder as a whole with a stack of layers: Hertz's contact where the layers are felt."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from skinbayes.arrays import ArrayLike, FloatArray
from skinbayes.contact.layer_stack import CYLINDER, SPHERE, LayerStack

_PLACES = np.sin(np.linspace(0.0, np.pi / 2, 101))  # r/a of the pressures, close to each other at the edge
_PLACES[-1] = 1.0


class LayeredSphere(NamedTuple):
    """Contacts of a ball with a stack of layers at K forces.

    Attributes
    ----------
    position : r, from the centre to the edge, m, shape ``(K, 101)``
    pressure : p(r), Pa, shape ``(K, 101)``
    contact_radius : a, m, shape ``(K,)``
    mean_pressure : load over contact area, Pa, shape ``(K,)``
    maximum_pressure : largest pressure, at the centre on a soft surface, Pa, shape ``(K,)``
    indentation : δ, approach of distant points, m, shape ``(K,)``
    equivalent_modulus : E* of the half-space with the same a under the same ball and load, 3 F_N R/(4a³), Pa, shape ``(K,)``
    equivalent_radius : of the ball that has the same a on the half-space below the layers under the same load, m, shape ``(K,)``
    """

    position: FloatArray
    pressure: FloatArray
    contact_radius: FloatArray
    mean_pressure: FloatArray
    maximum_pressure: FloatArray
    indentation: FloatArray
    equivalent_modulus: FloatArray
    equivalent_radius: FloatArray


class LayeredLine(NamedTuple):
    """Contacts of a cylinder with a stack of layers at K loads; how deep it sinks has no limit in two dimensions.

    Attributes
    ----------
    position : x, from the middle to the edge, m, shape ``(K, 101)``
    pressure : p(x), Pa, shape ``(K, 101)``
    half_width : b, m, shape ``(K,)``
    mean_pressure : load over width, Pa, shape ``(K,)``
    maximum_pressure : largest pressure, Pa, shape ``(K,)``
    equivalent_modulus : E* of the half-space with the same b under the same cylinder and load, 4 f_N Rc/(πb²), Pa, shape ``(K,)``
    equivalent_radius : of the cylinder that has the same b on the half-space below the layers, m, shape ``(K,)``
    """

    position: FloatArray
    pressure: FloatArray
    half_width: FloatArray
    mean_pressure: FloatArray
    maximum_pressure: FloatArray
    equivalent_modulus: FloatArray
    equivalent_radius: FloatArray


def layered_sphere_contact(
    normal_force: ArrayLike,
    sphere_radius: float,
    *,
    moduli: Sequence[float],
    poisson_ratios: Sequence[float],
    thicknesses: Sequence[float],
) -> LayeredSphere:
    """Smooth contact of a rigid ball with bonded elastic layers on a half-space: `sphere_contact` where the layers are felt.

    Parameters
    ----------
    normal_force : F_N, N, > 0, shape ``(K,)`` or a scalar
    sphere_radius : R, m, > 0
    moduli : Young's moduli from the surface down, the half-space last, Pa, > 0
    poisson_ratios : ν of each, dimensionless, −1 < ν ≤ 0.5
    thicknesses : d of each but the half-space, m, > 0

    Returns
    -------
    contact : `LayeredSphere`; nan where a force is not positive

    Raises
    ------
    InputError
        if a number cannot be, or the numbers of layers do not fit

    Notes
    -----
    Frictionless; the ball is a paraboloid. With `equivalent_modulus` in place of E* all formulas of Hertz give the contact radius
    for this load. Between a = d/30 and 2000 d of the uppermost layer, and for E0/E1 from 1e-3 to 1e6, twice as many functions
    change the equivalent modulus by less than 1e-4.

    References
    ----------
    Johnson, Contact Mechanics (1985), Sect. 5.8, doi 10.1017/CBO9781139171731.
    Sneddon, International Journal of Engineering Science 3 (1965) 47, doi 10.1016/0020-7225(65)90019-4.

    Examples
    --------
    >>> contact = layered_sphere_contact(0.2, 8e-3, moduli=[7e6, 20e3], poisson_ratios=[0.5, 0.5], thicknesses=[20e-6])
    >>> print((contact.contact_radius * 1e3).round(2), "mm", contact.maximum_pressure.round(), "Pa")
    [3.48] mm [7548.] Pa
    """
    stack = LayerStack(moduli, poisson_ratios, thicknesses, "sphere_radius", sphere_radius)
    rows = []
    for force, size, amounts, sinking in stack.contacts(normal_force, sphere_radius, SPHERE):
        slopes = 2 * stack.surface * size / (3 * np.pi * sphere_radius) * amounts
        pressure = _pressure_of_ball(slopes)
        depth = 2 * size / stack.surface * (slopes @ sinking)
        mean = force / (np.pi * size * size)
        equivalent = stack.surface * amounts[0] / 3
        rows.append(
            (size * _PLACES, pressure, size, mean, pressure.max(), depth, equivalent,
             sphere_radius * stack.deepest / equivalent)
        )  # fmt: skip
    return LayeredSphere(*(np.array(part) for part in zip(*rows, strict=True)))


def layered_line_contact(
    load_per_length: ArrayLike,
    cylinder_radius: float,
    *,
    moduli: Sequence[float],
    poisson_ratios: Sequence[float],
    thicknesses: Sequence[float],
) -> LayeredLine:
    """Smooth contact of a rigid cylinder with bonded elastic layers on a half-space: `line_contact` where the layers are felt.

    Parameters
    ----------
    load_per_length : f_N, N/m, > 0, shape ``(K,)`` or a scalar
    cylinder_radius : Rc, m, > 0
    moduli : Young's moduli from the surface down, the half-space last, Pa, > 0
    poisson_ratios : ν of each, dimensionless, −1 < ν ≤ 0.5
    thicknesses : d of each but the half-space, m, > 0

    Returns
    -------
    contact : `LayeredLine`; nan where a load is not positive

    Raises
    ------
    InputError
        if a number cannot be, or the numbers of layers do not fit

    References
    ----------
    Johnson, Contact Mechanics (1985), Sect. 5.8, doi 10.1017/CBO9781139171731.

    Examples
    --------
    >>> contact = layered_line_contact(21.92, 4.533e-3, moduli=[7e6, 20e3], poisson_ratios=[0.5, 0.5], thicknesses=[20e-6])
    >>> print((contact.half_width * 1e3).round(2), "mm", contact.maximum_pressure.round(), "Pa")
    [2.1] mm [6406.] Pa
    """
    stack = LayerStack(moduli, poisson_ratios, thicknesses, "cylinder_radius", cylinder_radius)
    rows = []
    for load, size, amounts, _ in stack.contacts(load_per_length, cylinder_radius, CYLINDER):
        pressure = _pressure_of_cylinder(stack.surface * size / (4 * cylinder_radius) * amounts)
        equivalent = stack.surface * amounts[0] / 2
        rows.append(
            (size * _PLACES, pressure, size, load / (2 * size), pressure.max(), equivalent,
             cylinder_radius * stack.deepest / equivalent)
        )  # fmt: skip
    return LayeredLine(*(np.array(part) for part in zip(*rows, strict=True)))


def _pressure_of_ball(slopes: FloatArray) -> FloatArray:
    """``∫_r^a Σ(−1)^n g_n P_(2n+1)(t/a) dt/√(t² − r²)`` at all places, Pa."""
    nodes, weights = np.polynomial.legendre.leggauss(slopes.size + 1)
    turned = np.zeros(2 * slopes.size)
    turned[1::2] = slopes * (-1.0) ** np.arange(slopes.size)
    square = 1 - np.square(_PLACES)
    t = np.sqrt(np.square(_PLACES)[:, None] + square[:, None] * np.square((nodes + 1) / 2))
    return np.asarray(np.sqrt(square) * ((np.polynomial.legendre.legval(t, turned) / t) @ (weights / 2)))


def _pressure_of_cylinder(parts: FloatArray) -> FloatArray:
    """``Σ(−1)^n g_n/(2n + 1) √(1 − ξ²) U_2n(ξ)`` at all places, Pa."""
    odd = 2 * np.arange(parts.size) + 1
    return np.asarray(
        np.sin(np.arccos(_PLACES)[:, None] * odd) @ (parts * (-1.0) ** np.arange(parts.size) / odd)
    )
