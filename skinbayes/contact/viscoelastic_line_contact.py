"""A rigid cylinder that slides without friction over a viscoelastic half-space: pressure, edges and what hysteresis costs."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from skinbayes.arrays import ArrayLike, FloatArray
from skinbayes.contact.constant_loss import ConstantLossMaterial
from skinbayes.contact.line_contact import line_contact
from skinbayes.contact.moving_kernel import MovingKernel, moving_kernel, power_law_kernel
from skinbayes.contact.viscoelastic import ViscoelasticMaterial
from skinbayes.errors import InputError

NODES = 240
"""Nodes across the contact unless told otherwise; friction is then within 2e-4 of that in the closed form for weak loss."""

_LOAD = np.pi / 2  # ∫P dX
_PLACES = np.linspace(-3.0, 3.0, 160)  # for a first look at where the contact is
_ROUNDS, _MARGIN = 200, 0.06


class ViscoelasticLine(NamedTuple):
    """Contacts of a cylinder at K speeds; x = 0 is its middle, and the solid passes towards positive x.

    Attributes
    ----------
    position : x, m, shape ``(K, N)``
    pressure : p(x), Pa, shape ``(K, N)``
    leading_edge : x at which the solid meets the cylinder, < 0, m, shape ``(K,)``
    trailing_edge : x at which it leaves it, m, shape ``(K,)``
    hysteresis : friction coefficient ``∫p (dw/dx) dx/f_N`` of the depth w, dimensionless, shape ``(K,)``
    reference_modulus : |E*| at the frequency v/b, b of the line contact with it, Pa, shape ``(K,)``
    """

    position: FloatArray
    pressure: FloatArray
    leading_edge: FloatArray
    trailing_edge: FloatArray
    hysteresis: FloatArray
    reference_modulus: FloatArray


class Passage(NamedTuple):
    """A material that passes a contact: what scales lengths and pressures, and the kernel of a line contact in these units.

    Attributes
    ----------
    modulus : |E*| at v/b, Pa
    half_width : b of the line contact of that modulus, or radius of the point contact, m
    instantaneous : J_0 times the modulus, dimensionless
    compliance : J_k times the modulus, dimensionless, shape ``(M,)``
    length : vθ_k/b, dimensionless, shape ``(M,)``
    """

    modulus: float
    half_width: float
    instantaneous: float
    compliance: FloatArray
    length: FloatArray

    def kernel(self, position: FloatArray) -> MovingKernel:
        """Kernel at nodes X = x/b, dimensionless."""
        return moving_kernel(
            position, instantaneous=self.instantaneous, compliance=self.compliance, length=self.length
        )


class PowerLawPassage(NamedTuple):
    """A material of constant loss angle that passes a line contact.

    Attributes
    ----------
    modulus : |E*| at v/b, Pa
    half_width : b of the line contact of that modulus, m
    power : n of ``E ∝ (iω)^n``, dimensionless
    """

    modulus: float
    half_width: float
    power: float

    def kernel(self, position: FloatArray) -> MovingKernel:
        """Kernel at nodes X = x/b, dimensionless."""
        return power_law_kernel(position, self.power)


AnyMaterial = ViscoelasticMaterial | ConstantLossMaterial
AnyPassage = Passage | PowerLawPassage


def passage(
    material: AnyMaterial, speed: float, *, load_per_length: float, cylinder_radius: float
) -> AnyPassage:
    """Scales of a contact at v, m/s, under f_N, N/m, with Rc, m; modulus and half-width belong to each other."""
    return passage_of(
        material,
        speed,
        lambda modulus: float(
            line_contact(load_per_length, cylinder_radius, reduced_modulus=modulus).half_width
        ),
    )


def passage_of(material: AnyMaterial, speed: float, half_width_of: Callable[[float], float]) -> AnyPassage:
    """Scales of a contact at v, m/s, whose half-width or radius, m, is a function of the plane-strain modulus, Pa."""
    modulus, width = modulus_in_contact(material, speed, half_width_of)
    if isinstance(material, ConstantLossMaterial):
        return PowerLawPassage(modulus, width, float(material.power))
    creep = material.creep
    scale = modulus * (1 - float(material.poisson_ratio) ** 2)
    return Passage(
        modulus,
        width,
        float(creep.instantaneous * scale),
        creep.compliance * scale,
        speed * creep.retardation_time / width,
    )


def modulus_in_contact(
    material: AnyMaterial, speed: float, half_width_of: Callable[[float], float]
) -> tuple[float, float]:
    """|E*| at v/b, Pa, at v, m/s, and b, m, which depends on it; nan if it has no such modulus."""
    start = 0.0
    if isinstance(material, ConstantLossMaterial):
        if not speed > 0 and float(material.power) > 0:
            return np.nan, np.nan  # given time enough, it gives way without end
        start = float(np.asarray(material.reference_frequency))
    modulus = float(abs(material.reduced_modulus(start)))
    for _ in range(60):
        half_width = half_width_of(modulus)
        last, modulus = modulus, float(abs(material.reduced_modulus(speed / half_width)))
        if not abs(modulus / last - 1) > 1e-12:
            break
    return modulus, half_width


def viscoelastic_line_contact(
    speed: ArrayLike,
    *,
    load_per_length: float,
    cylinder_radius: float,
    material: AnyMaterial,
    nodes: int = NODES,
) -> ViscoelasticLine:
    """Smooth contact of a rigid cylinder that slides over a viscoelastic half-space (line contact of Hertz at v = 0).

    ``w(q) = 2 p(q)/(|q| E*(qv))``, which follows the cylinder where p > 0. The horizontal force of the pressure on the
    deflected surface, ``∫p (dw/dx) dx``, is what the solid dissipates over the speed.

    Parameters
    ----------
    speed : v, m/s, ≥ 0, shape ``(K,)`` or a scalar
    load_per_length : f_N, N/m, > 0
    cylinder_radius : Rc, m, > 0
    material : of the half-space, one material, moduli in Pa
    nodes : number of places across the contact, dimensionless, ≥ 16

    Returns
    -------
    contact : `ViscoelasticLine`; nan where an argument is impossible

    Raises
    ------
    InputError
        if there are fewer than sixteen nodes

    Notes
    -----
    Quasi-static: v is far below the speed of sound. For weak loss, tan δ the same at all frequencies, the friction coefficient is
    ``(8/3π) sin δ b/Rc``.

    References
    ----------
    Hunter, J. Appl. Mech. 28 (1961) 611.
    Johnson, Contact Mechanics (1985), Sect. 9.4, doi 10.1017/CBO9781139171731.

    Examples
    --------
    >>> from skinbayes.contact import standard_linear_solid
    >>> tissue = standard_linear_solid(20e3, 28e3, relaxation_time=0.1)
    >>> contact = viscoelastic_line_contact([1e-5, 1e-2, 10.0], load_per_length=21.92, cylinder_radius=4.533e-3, material=tissue)
    >>> print(contact.hysteresis.round(3), (contact.trailing_edge * 1e3).round(2), "mm")
    [0.    0.045 0.001] [2.18 1.86 1.84] mm
    """
    speeds = np.atleast_1d(np.asarray(speed, dtype=np.float64))
    if nodes < 16:
        raise InputError(f"nodes is {nodes}, but must be at least 16.")
    rows = [_one(value, load_per_length, cylinder_radius, material, nodes) for value in speeds.tolist()]
    return ViscoelasticLine(*(np.array(part) for part in zip(*rows, strict=True)))


def _one(
    speed: float, load: float, radius: float, material: AnyMaterial, nodes: int
) -> tuple[FloatArray | float, ...]:
    missing = np.full(nodes, np.nan)
    scales = passage(material, speed, load_per_length=load, cylinder_radius=radius)
    if not (
        0 <= speed < np.inf and 0 < load < np.inf and np.isfinite(scales.half_width) and scales.half_width > 0
    ):
        return (missing, missing, np.nan, np.nan, np.nan, np.nan)
    lead, trail = edges(scales)
    if not np.isfinite(trail - lead):
        return (missing, missing, np.nan, np.nan, np.nan, np.nan)
    middle, half = (trail + lead) / 2, (trail - lead) / 2 * (1 + _MARGIN)
    position = middle - half * np.cos(np.linspace(0, np.pi, nodes))
    kernel = scales.kernel(position)
    pressure = _pressure(position, kernel)
    lead, trail = ends_of_contact(position, pressure)
    b = scales.half_width
    return (
        position * b,
        pressure * scales.modulus * b / (2 * radius),
        lead * b,
        trail * b,
        float(b / radius / _LOAD * hysteresis_integral(position, pressure, kernel)),
        scales.modulus,
    )


def edges(scales: AnyPassage) -> tuple[float, float]:
    """X at which smooth dry contact begins and ends, dimensionless, to about 0.02; −1 and 1 where the solid is elastic."""
    found = ends_of_contact(_PLACES, _pressure(_PLACES, scales.kernel(_PLACES)))
    elastic = _elastic_edges()
    # the error of the coarse nodes is nearly the same for both
    return found[0] - elastic[0] - 1, found[1] - elastic[1] + 1


@lru_cache(maxsize=1)
def _elastic_edges() -> tuple[float, float]:
    none = np.zeros(0)
    return ends_of_contact(_PLACES, _pressure(_PLACES, Passage(1.0, 1.0, 1.0, none, none).kernel(_PLACES)))


def hysteresis_integral(position: FloatArray, pressure: FloatArray, kernel: MovingKernel) -> FloatArray:
    """``∫P (dW/dX) dX`` with the depth W, dimensionless, of pressures ``(..., N)``: by parts, exact for piecewise linear ones."""
    slope = np.diff(pressure, axis=-1) / np.diff(position)
    depth = -(kernel.deflection @ pressure[..., None])[..., 0]
    ends = pressure[..., -1] * depth[..., -1] - pressure[..., 0] * depth[..., 0]
    return np.asarray(ends + (slope * (kernel.cells @ pressure[..., None])[..., 0]).sum(axis=-1))


def _pressure(position: FloatArray, kernel: MovingKernel) -> FloatArray:
    """P ≥ 0 with no gap ``H0 + X²/2 − K P`` where P > 0 and none below 0 elsewhere, ∫P dX = π/2; nan if none was found."""
    parabola = np.square(position) / 2
    spacing = np.diff(position)
    weight = (np.concatenate([[0.0], spacing]) + np.concatenate([spacing, [0.0]])) / 2
    touching = np.abs(position - position.mean()) < 1.2
    for _ in range(_ROUNDS):
        count = np.count_nonzero(touching)
        matrix = np.zeros((count + 1, count + 1))
        matrix[:count, :count] = kernel.deflection[np.ix_(touching, touching)]
        matrix[:count, count] = -1
        matrix[count, :count] = weight[touching]
        found = np.linalg.solve(matrix, np.concatenate([parabola[touching], [_LOAD]]))
        pressure = np.zeros_like(position)
        pressure[touching] = found[:count]
        gap = found[count] + parabola - kernel.deflection @ pressure
        now = np.where(touching, pressure > 0, gap < 0)
        if (now == touching).all():
            return pressure
        touching = now
    return np.full_like(position, np.nan)


def ends_of_contact(position: FloatArray, pressure: FloatArray) -> tuple[float, float]:
    """Ends of the contact, where a parabola, p² against x, comes to zero, between the last node that touches and the next."""
    touching = np.flatnonzero(pressure > 0)
    if touching.size < 4 or touching[0] == 0 or touching[-1] == position.size - 1:
        return np.nan, np.nan
    ends = []
    for last, outer, inner, step in (*touching[[0, 1, 3]], -1), (*touching[[-1, -2, -4]], 1):
        fall = pressure[inner] ** 2 / pressure[outer] ** 2 - 1
        zero = position[outer] + (position[outer] - position[inner]) / fall
        ends.append(float(np.clip(zero, *sorted((position[last], position[last + step])))))
    return ends[0], ends[1]
