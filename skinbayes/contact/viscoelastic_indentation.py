"""A ball pressed into a viscoelastic half-space and drawn back: force, depth, loss and set; creep under a load, relaxation."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.special import betainc, dawsn, gamma

from skinbayes.arrays import ArrayLike, FloatArray
from skinbayes.contact.constant_loss import ConstantLossMaterial
from skinbayes.contact.solid import plane_strain
from skinbayes.contact.viscoelastic import ViscoelasticMaterial
from skinbayes.errors import InputError

_HALVINGS = 54  # of a bracket: down to rounding
_POINTS = 400  # of each half of a cycle
_SMALL = 1e-2  # t/τ below which a power series takes the place of Dawson's integral


@dataclass(frozen=True, eq=False, kw_only=True)
class IndentationCycle:
    """A ball pressed in at a constant rate to a depth and drawn back at the same rate until it leaves the surface.

    Attributes
    ----------
    time : t, s, shape ``(N,)``
    depth : δ(t), m, shape ``(N,)``
    force : F(t), N, shape ``(N,)``; 0 at the end
    contact_radius : a(t), m, shape ``(N,)``
    loss_fraction : work that is not given back over the work of pressing in, dimensionless
    residual_depth : δ at which the ball leaves the surface, m
    """

    time: FloatArray
    depth: FloatArray
    force: FloatArray
    contact_radius: FloatArray
    loss_fraction: float
    residual_depth: float


def indentation_cycle(
    rate: float,
    depth: float,
    *,
    sphere_radius: float,
    material: ViscoelasticMaterial | ConstantLossMaterial,
) -> IndentationCycle:
    """Press a rigid ball into a viscoelastic half-space and draw it back (the experiment quoted in Sect. 6.2 of the paper).

    While the contact grows ``F = (4√R/3) ∫ E*(t − s) d(δ^(3/2))`` with ``a² = R δ`` (Lee and Radok). While it shrinks the
    contact at t is that of an earlier time t1 with ``∫_(t1)^t E*(t − s) dδ = 0``, and the integral for F ends at t1 (Ting).
    Loss and residual depth over depth do not depend on the ball.

    Parameters
    ----------
    rate : dδ/dt, m/s, > 0
    depth : largest δ, m, > 0
    sphere_radius : R, m, > 0
    material : of the half-space, one material, moduli in Pa

    Returns
    -------
    cycle : `IndentationCycle`

    Raises
    ------
    InputError
        if a number is not positive or the material impossible

    Notes
    -----
    Parabola of Hertz, valid for a much smaller than R; without adhesion; Poisson ratio constant.

    References
    ----------
    Lee & Radok, J. Appl. Mech. 27 (1960) 438.
    Ting, J. Appl. Mech. 33 (1966) 845.
    Johnson, Contact Mechanics (1985), Sect. 6.5, doi 10.1017/CBO9781139171731.

    Examples
    --------
    >>> from skinbayes.contact import constant_loss_solid
    >>> tissue = constant_loss_solid(20e3, 0.1423, angular_frequency=1.0, lowest_frequency=1e-3, highest_frequency=1e4)
    >>> cycle = indentation_cycle(2.5e-3, 5e-3, sphere_radius=8e-3, material=tissue)
    >>> print(f"{cycle.loss_fraction:.3f}, {cycle.residual_depth * 1e3:.2f} mm")
    0.227, 0.62 mm
    """
    for name, value, unit in (
        ("rate", rate, "m/s"),
        ("depth", depth, "m"),
        ("sphere_radius", sphere_radius, "m"),
    ):
        if not 0 < value < np.inf:
            raise InputError(f"{name} is {value:g} {unit}, but must be a finite number > 0 {unit}.")
    if not np.isfinite(abs(material.complex_modulus(rate / depth))):
        raise InputError("The material of an indentation is impossible; validate_solid says why.")
    turn = depth / rate

    def balance(earlier: FloatArray, time: FloatArray) -> FloatArray:
        return np.asarray(_impulse(material, time - earlier) - 2 * _impulse(material, time - turn))

    end = _halved(lambda time: balance(np.zeros(1), time), np.array([turn]), np.array([2 * turn])).item()
    # the contact shrinks ever faster: points by the fall of its depth
    back = turn + (end - turn) * np.sin(np.linspace(0, np.pi / 2, _POINTS + 1))[1:]
    grown = _halved(
        lambda earlier: balance(earlier, back[:-1]), np.zeros(_POINTS - 1), np.full(_POINTS - 1, turn)
    )
    loading = turn * np.linspace(0, 1, _POINTS + 1)
    time = np.concatenate([loading, back])
    until = np.concatenate([loading, grown, [0.0]])
    force = (
        4 / 3 * np.sqrt(sphere_radius) * float(plane_strain(1.0, material.poisson_ratio)) * rate**1.5
    ) * _loaded(material, until, time)
    depths = rate * np.where(time <= turn, time, 2 * turn - time)
    pressing = np.trapezoid(force[: _POINTS + 1], depths[: _POINTS + 1])
    given_back = -np.trapezoid(force[_POINTS:], depths[_POINTS:])
    return IndentationCycle(
        time=time,
        depth=depths,
        force=force,
        contact_radius=np.sqrt(sphere_radius * rate * until),
        loss_fraction=float(1 - given_back / pressing),
        residual_depth=float(depths[-1]),
    )


def indentation_creep(
    time: ArrayLike, normal_force: ArrayLike, *, sphere_radius: ArrayLike, material: ViscoelasticMaterial
) -> FloatArray:
    """Depth of a ball under a load that is put on at once and held, ``δ^(3/2) = 3 F J*(t)/(4√R)`` (Lee and Radok).

    Parameters
    ----------
    time : t since the load, s, ≥ 0, shape ``(K,)`` or a scalar
    normal_force : F, N, ≥ 0, broadcasts with ``time``
    sphere_radius : R, m, > 0, broadcasts with ``time``
    material : of the half-space, one material, moduli in Pa

    Returns
    -------
    depth : δ, m, broadcast shape; nan where an argument is impossible

    References
    ----------
    Lee & Radok, J. Appl. Mech. 27 (1960) 438.
    Johnson, Contact Mechanics (1985), Sect. 6.5, doi 10.1017/CBO9781139171731.

    Examples
    --------
    >>> from skinbayes.contact import standard_linear_solid
    >>> tissue = standard_linear_solid(20e3, 28e3, relaxation_time=0.1)
    >>> print(indentation_creep([0.0, 10.0], 0.2, sphere_radius=8e-3, material=tissue).round(5))
    [0.00126 0.00158]
    """
    force, radius = (np.asarray(x, dtype=np.float64) for x in (normal_force, sphere_radius))
    compliance = material.creep_compliance(time) / plane_strain(1.0, material.poisson_ratio)
    with np.errstate(all="ignore"):
        force = np.where((force >= 0) & (radius > 0), force, np.nan)
        return np.asarray((0.75 * force * compliance / np.sqrt(radius)) ** (2 / 3))[()]


def indentation_relaxation(
    time: ArrayLike, depth: ArrayLike, *, sphere_radius: ArrayLike, material: ViscoelasticMaterial
) -> FloatArray:
    """Force on a ball that is pressed in at once and held, ``F = (4/3) E*(t) √R δ^(3/2)``.

    Parameters
    ----------
    time : t since the step, s, ≥ 0, shape ``(K,)`` or a scalar
    depth : δ, m, ≥ 0, broadcasts with ``time``
    sphere_radius : R, m, > 0, broadcasts with ``time``
    material : of the half-space, one material, moduli in Pa

    Returns
    -------
    force : F, N, broadcast shape; nan where an argument is impossible

    References
    ----------
    Lee & Radok, J. Appl. Mech. 27 (1960) 438.
    Johnson, Contact Mechanics (1985), Sect. 6.5, doi 10.1017/CBO9781139171731.

    Examples
    --------
    >>> from skinbayes.contact import standard_linear_solid
    >>> tissue = standard_linear_solid(20e3, 28e3, relaxation_time=0.1)
    >>> print(indentation_relaxation([0.0, 10.0], 1e-3, sphere_radius=8e-3, material=tissue).round(4))
    [0.1408 0.1006]
    """
    pressed, radius = (np.asarray(x, dtype=np.float64) for x in (depth, sphere_radius))
    modulus = material.relaxation_modulus(time) * plane_strain(1.0, material.poisson_ratio)
    with np.errstate(all="ignore"):
        pressed = np.where((pressed >= 0) & (radius > 0), pressed, np.nan)
        return np.asarray(4 / 3 * modulus * np.sqrt(radius) * pressed**1.5)[()]


def _halved(function: Callable[[FloatArray], FloatArray], low: FloatArray, high: FloatArray) -> FloatArray:
    """Zeros of a falling function between low and high, to rounding."""
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        above = function(middle) > 0
        low, high = np.where(above, middle, low), np.where(above, high, middle)
    return (low + high) / 2


def _impulse(material: ViscoelasticMaterial | ConstantLossMaterial, time: FloatArray) -> FloatArray:
    """∫E dt from 0, Pa s."""
    if isinstance(material, ConstantLossMaterial):
        power, reference = float(material.power), float(material.reference_frequency)
        return np.asarray(
            float(material.modulus) * reference**-power * time ** (1 - power) / gamma(2 - power)
        )
    times = np.asarray(material.relaxation_times)
    moduli = np.asarray(material.relaxing_moduli)
    relaxed = (moduli * times * -np.expm1(-time[..., None] / times)).sum(axis=-1)
    return np.asarray(material.equilibrium_modulus * time + relaxed)


def _loaded(
    material: ViscoelasticMaterial | ConstantLossMaterial, until: FloatArray, time: FloatArray
) -> FloatArray:
    """``∫₀^until E(time − s) (3/2) √s ds``, Pa s^(3/2)."""
    if isinstance(material, ConstantLossMaterial):
        # E(t) = |E| (ω_r t)^−n/Γ(1 − n)
        power, reference = float(material.power), float(material.reference_frequency)
        share = betainc(1.5, 1 - power, until / np.where(time > 0, time, 1.0))
        whole = 1.5 * gamma(1.5) / gamma(2.5 - power) * time ** (1.5 - power)
        return np.asarray(float(material.modulus) * reference**-power * whole * share)
    times, moduli = np.asarray(material.relaxation_times), np.asarray(material.relaxing_moduli)
    x = until[:, None] / times
    root = np.sqrt(x)
    # ∫₀^x exp(y − x) √y dy = √x − D(√x)
    series = 2 / 3 * x * root * (1 - 2 / 5 * x * (1 - 2 / 7 * x * (1 - 2 / 9 * x * (1 - 2 / 11 * x))))
    relaxing = np.where(x < _SMALL, series, root - dawsn(root)) * np.exp(-(time - until)[:, None] / times)
    return np.asarray(
        material.equilibrium_modulus * until**1.5 + 1.5 * (moduli * times**1.5 * relaxing).sum(axis=-1)
    )
