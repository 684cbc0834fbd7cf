"""Viscoelastic materials of a few numbers or of a measured table, as sums of relaxing moduli."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import PchipInterpolator
from scipy.optimize import nnls

from skinbayes.arrays import ArrayLike, ComplexArray, FloatArray
from skinbayes.contact.viscoelastic import ViscoelasticMaterial
from skinbayes.errors import InputError

_PER_DECADE = 3  # elements: the sum over them then is the integral over relaxation times to 5e-6
_BEYOND = 3  # decades of relaxation times beyond the band, on both sides
_POINTS_PER_DECADE = 12  # at which a table is fitted


def standard_linear_solid(
    equilibrium_modulus: ArrayLike,
    instantaneous_modulus: ArrayLike,
    *,
    relaxation_time: ArrayLike,
    poisson_ratio: ArrayLike = 0.5,
) -> ViscoelasticMaterial:
    """Material with one relaxation time (Zener), ``E(t) = E∞ + (E_g − E∞) exp(−t/τ)``.

    tan δ is largest at ``ω = √(E∞/E_g)/τ``, where it is ``(E_g − E∞)/(2√(E_g E∞))``.

    Parameters
    ----------
    equilibrium_modulus : E∞, Young's modulus of slow deformation, Pa, > 0, batch shape
    instantaneous_modulus : E_g, Young's modulus of fast deformation, Pa, > E∞, batch shape
    relaxation_time : τ, at constant strain, s, > 0, batch shape
    poisson_ratio : ν, dimensionless, −1 < ν ≤ 0.5, batch shape; incompressible if not given

    Returns
    -------
    material : `ViscoelasticMaterial`; what it computes is nan where an argument is impossible

    References
    ----------
    Mainardi, Fractional Calculus and Waves in Linear Viscoelasticity (2010), Chap. 2, doi 10.1142/p614.

    Examples
    --------
    >>> tissue = standard_linear_solid(20e3, 27.8e3, relaxation_time=0.1)
    >>> print(f"{tissue.loss_tangent((20 / 27.8) ** 0.5 / 0.1):.4f}")
    0.1654
    """
    slow, fast, time = np.broadcast_arrays(
        *(
            np.asarray(x, dtype=np.float64)
            for x in (equilibrium_modulus, instantaneous_modulus, relaxation_time)
        )
    )
    return ViscoelasticMaterial(
        equilibrium_modulus=slow,
        relaxing_moduli=(fast - slow)[..., None],
        relaxation_times=time[..., None],
        poisson_ratio=np.asarray(poisson_ratio, dtype=np.float64),
    )


def constant_loss_solid(
    modulus: float,
    loss_tangent: float,
    *,
    angular_frequency: float,
    lowest_frequency: float,
    highest_frequency: float,
    poisson_ratio: float = 0.5,
) -> ViscoelasticMaterial:
    """Material whose tan δ is the same at all frequencies of a band (spring-pot, fractional element).

    ``E(ω) = |E| (iω/ω_r)^n``, ``tan δ = tan(nπ/2)``: a modulus that rises as a weak power of frequency, as that of soft tissue
    does. Its relaxation times are spread evenly over ln τ with weights ``(|E| sin nπ/π) (ω_r τ)^(−n)``, three to a decade.

    Parameters
    ----------
    modulus : |E| at ω_r, Young's modulus, Pa, > 0
    loss_tangent : tan δ, dimensionless, > 0
    angular_frequency : ω_r, 1/s (rad/s), > 0
    lowest_frequency : lower end of the band, 1/s (rad/s), > 0
    highest_frequency : upper end of the band, 1/s (rad/s), > the lower end
    poisson_ratio : ν, dimensionless, −1 < ν ≤ 0.5; incompressible if not given

    Returns
    -------
    material : `ViscoelasticMaterial`, elastic far below and above the band; within it the modulus is that of the equation
        to 1e-4, tan δ to 4e-4 of itself

    Raises
    ------
    InputError
        if a number is not positive or the band is empty

    References
    ----------
    Mainardi, Fractional Calculus and Waves in Linear Viscoelasticity (2010), Chap. 3, doi 10.1142/p614.

    Examples
    --------
    >>> tissue = constant_loss_solid(20e3, 0.1423, angular_frequency=1.0, lowest_frequency=0.01, highest_frequency=100.0)
    >>> print(tissue.loss_tangent([0.01, 1.0, 100.0]).round(3), f"{abs(tissue.complex_modulus(100.0)):.0f} Pa")
    [0.142 0.142 0.142] 30269 Pa
    """
    given = {
        "modulus": (modulus, "Pa"),
        "loss_tangent": (loss_tangent, ""),
        "angular_frequency": (angular_frequency, "1/s"),
        "lowest_frequency": (lowest_frequency, "1/s"),
    }
    for name, (value, unit) in given.items():
        if not 0 < value < np.inf:
            raise InputError(
                f"{name} is {value:g} {unit}".rstrip() + f", but must be a finite number > 0 {unit}."
            )
    if not lowest_frequency < highest_frequency < np.inf:
        raise InputError(
            f"highest_frequency is {highest_frequency:g} 1/s, but must be above lowest_frequency, {lowest_frequency:g} 1/s."
        )
    power = 2 / np.pi * np.arctan(loss_tangent)
    times = _times(lowest_frequency, highest_frequency, _BEYOND)
    step = np.log(10) / _PER_DECADE
    moduli = modulus * np.sin(power * np.pi) / np.pi * step * (angular_frequency * times) ** -power
    # all slower elements, which never relax within the band, are a geometric series
    slower = moduli[-1] / np.expm1(power * step)
    # and all faster ones together, which are dashpots there, weigh on the first as another one
    moduli[0] /= -np.expm1((power - 1) * step)
    return ViscoelasticMaterial(
        equilibrium_modulus=slower,
        relaxing_moduli=moduli,
        relaxation_times=times,
        poisson_ratio=poisson_ratio,
    )


def material_of_dynamic_moduli(
    angular_frequency: ArrayLike,
    *,
    storage_modulus: ArrayLike,
    loss_modulus: ArrayLike,
    tolerance: float = 0.05,
    poisson_ratio: float = 0.5,
) -> ViscoelasticMaterial:
    """Material of a measured table of storage and loss modulus.

    The table is interpolated in logarithms by monotone cubics, and a sum of relaxing moduli with relaxation times over the
    measured band and a decade beyond is fitted to it, none of them negative (non-negative least squares of the
    differences over |E|).

    Parameters
    ----------
    angular_frequency : ω, 1/s (rad/s), rising, > 0, shape ``(K,)``, K ≥ 2
    storage_modulus : E′, Pa, > 0, shape ``(K,)``
    loss_modulus : E″, Pa, > 0, shape ``(K,)``
    tolerance : largest difference between table and sum over |E|, dimensionless
    poisson_ratio : ν, dimensionless, −1 < ν ≤ 0.5; incompressible if not given

    Returns
    -------
    material : `ViscoelasticMaterial`

    Raises
    ------
    InputError
        if the table is not one, or if no sum comes within the tolerance: E′ and E″ then do not belong to one linear
        material (relations of Kramers and Kronig), or change faster than relaxation lets them

    Notes
    -----
    Outside the measured band the material is an extrapolation: elastic from a decade beyond.

    References
    ----------
    Lawson & Hanson, Solving Least Squares Problems (1995), Chap. 23, doi 10.1137/1.9781611971217.

    Examples
    --------
    >>> frequency = np.array([0.1, 1.0, 10.0, 100.0])
    >>> tissue = material_of_dynamic_moduli(
    ...     frequency, storage_modulus=20e3 * frequency**0.1, loss_modulus=3.17e3 * frequency**0.1
    ... )
    >>> print(f"{tissue.complex_modulus(10.0):.0f}")
    25179+3990j
    """
    frequency, storage, loss = (
        np.asarray(x, dtype=np.float64) for x in (angular_frequency, storage_modulus, loss_modulus)
    )
    if not (frequency.ndim == 1 and frequency.shape == storage.shape == loss.shape and frequency.size > 1):
        raise InputError(
            "A table of dynamic moduli needs frequency, storage and loss modulus at the same two or more points."
        )
    table = np.array([frequency, storage, loss])
    if not (np.isfinite(table).all() and (table > 0).all() and (np.diff(frequency) > 0).all()):
        raise InputError(
            "A table of dynamic moduli needs frequencies (1/s) that rise and are > 0, and moduli (Pa) that are > 0."
        )
    decades = np.log10(frequency[-1] / frequency[0])
    dense = np.geomspace(
        frequency[0], frequency[-1], max(frequency.size, int(_POINTS_PER_DECADE * decades) + 2)
    )
    curves = PchipInterpolator(np.log(frequency), np.log(table[1:]), axis=1)(np.log(dense))
    measured = np.exp(curves[0]) + 1j * np.exp(curves[1])
    times = _times(frequency[0], frequency[-1], 1)
    turn = 1j * dense[:, None] * times
    design = np.concatenate([np.ones((dense.size, 1)), turn / (1 + turn)], axis=1)
    scale = np.abs(measured)
    found, _ = nnls(_stacked(design / scale[:, None]), _stacked(measured / scale))
    miss = np.abs(design @ found - measured) / scale
    if miss.max() > tolerance:
        worst = int(np.argmax(miss))
        raise InputError(
            f"Storage and loss modulus are not those of one linear viscoelastic material: at {dense[worst]:.3g} 1/s the nearest "
            f"is {miss[worst]:.1%} of |E| away, but at most {tolerance:.1%} is allowed."
        )
    kept = found[1:] > 0
    # an element slower than the table looks like a spring, and a half-space needs one
    spring = max(found[0], 1e-6 * scale.min())
    return ViscoelasticMaterial(
        equilibrium_modulus=spring,
        relaxing_moduli=found[1:][kept],
        relaxation_times=times[kept],
        poisson_ratio=poisson_ratio,
    )


def _times(lowest: float, highest: float, beyond: int) -> FloatArray:
    """Relaxation times, s, rising, from ``beyond`` decades below 1/highest to as many above 1/lowest frequency."""
    decades = np.log10(highest / lowest) + 2 * beyond
    start = -np.log10(highest) - beyond
    return np.asarray(10.0 ** (start + np.arange(int(np.ceil(decades * _PER_DECADE)) + 1) / _PER_DECADE))


def _stacked(values: ComplexArray) -> FloatArray:
    """Real and imaginary parts one after the other along the first axis."""
    return np.concatenate([values.real, values.imag])
