"""Capillary pressure of bridges in humid air, interpolated in the fraction of the gaps that they span.

Air sets the Laplace pressure and the largest gap d_K that is wet; the skin answers with the fraction F of its area whose gaps are
narrower. F varies smoothly and scales: a surface k times as high under k times the load has gaps k times as wide, and moduli
scale with loads. What is left are the load and the gap over height and modulus of the tissue, the stiffness of the layer over
that of the tissue, and the thickness of the layer. On a grid of these F is computed once; a state is then the root of one
equation in ln p.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import prod

import numpy as np
from scipy.ndimage import map_coordinates, spline_filter
from scipy.special import ndtr

from skinbayes.arrays import BoolArray, FloatArray
from skinbayes.emulation import Box, Places, Progress, Tasks
from skinbayes.roughness import TabulatedSpectrum, rms_height
from skinbayes.roughness.spectrum import PowerSpectrum, SelfAffineSpectrum
from skinbayes.wetting._falling import falling_root
from skinbayes.wetting._gaps import GapSource
from skinbayes.wetting._solids import Solid, scale_modulus, shape_groups, solid_of_groups

_STEPS = {"load": 0.15, "gap": 0.25, "stiffness": 0.2, "layer_thickness": 0.3}
_ROOM = 3  # nodes beyond the ends of an axis, where a spline is poor
_RUNG = 0.12  # of the ladder of ln p on which roots are told apart, as in the solution without a table
_FIRST_RUNGS = 3
_CLOSE = 1e-12  # of ln p
_LITTLE = 1e-12  # of the area, added to F so that its logarithm has a floor
_ONE = "skin"  # number of a skin, the only thing that tells homogeneous ones apart
_BLOCK = 64  # skins at a time
_BULK, _HEIGHT = 2e4, 2e-5  # Pa and m; any would do


@dataclass(frozen=True, eq=False, kw_only=True)
class HumidTable:
    """Fraction of the area that bridges can span, for skins in a box of dimensionless groups.

    Attributes
    ----------
    box : of the groups of `humid_groups`, dimensionless or ln of SI values; its loads reach to those with the whole Laplace
        pressure
    axes : group to its first node and number of nodes, for those groups that vary, dimensionless
    coefficients : of the cubic spline of ln F on the grid of ``axes``, dimensionless

    References
    ----------
    Persson, Kovalev & Gorb, Tribol. Lett. 50 (2013) 17, doi 10.1007/s11249-012-0053-2 (Appendix A).
    """

    box: Box
    axes: Mapping[str, tuple[float, int]]
    coefficients: FloatArray

    def covers(self, groups: Places, strength: FloatArray) -> BoolArray:
        """Tell which members of a flat batch lie in the box up to the Laplace pressure p_K/p0 = ``strength``, shape ``(M,)``."""
        return self.box.covers(groups, {**groups, "load": groups["load"] + np.log1p(strength)})

    def fraction(self, groups: Places) -> FloatArray:
        """F, dimensionless, of the shape of the groups; whatever the spline has outside the box."""
        places = [(groups[name] - start) / _STEPS[name] for name, (start, _) in self.axes.items()]
        shape = np.broadcast_shapes(*(np.shape(x) for x in places))
        found = map_coordinates(
            self.coefficients,
            np.stack([np.broadcast_to(x, shape).reshape(-1) for x in places]),
            order=3,
            prefilter=False,
            mode="nearest",
        )
        return np.asarray(np.exp(found.reshape(shape)) - _LITTLE)

    def log_pressure_ratio(self, groups: Places, strength: FloatArray) -> FloatArray:
        """Smallest root of ``p = p0 + p_K F(d_K; p)`` as ln p/p0, dimensionless.

        Parameters
        ----------
        groups : those of p0 and d_K, shape ``(M,)``
        strength : p_K/p0, dimensionless, shape ``(M,)``

        Returns
        -------
        rise : ln p/p0, dimensionless, shape ``(M,)``
        """

        def excess(x: FloatArray, at: Places, strength: FloatArray) -> FloatArray:
            return np.asarray(x - np.log1p(strength * self.fraction({**at, "load": at["load"] + x})))

        low = np.full(strength.shape, np.nan)
        rows = np.flatnonzero(np.isfinite(strength + sum(groups.values())))
        end, first, span = np.log1p(strength), 0, _FIRST_RUNGS
        while rows.size:
            rungs: FloatArray = _RUNG * np.arange(first + 1, first + span + 1, dtype=np.float64)
            at = {name: value[rows, None] for name, value in groups.items()}
            # from the whole Laplace pressure on there is no root left to find
            above = (excess(rungs, at, strength[rows, None]) > 0) | (rungs >= end[rows, None])
            now = above.any(axis=1)
            low[rows[now]] = _RUNG * (first + above[now].argmax(axis=1))
            rows = rows[~now]
            first, span = first + span, 2 * span
        return falling_root(lambda x: -excess(x, groups, strength), low, low + _RUNG, _CLOSE)


def humid_groups(
    pressure: FloatArray, gap: FloatArray, *, height: FloatArray, skin: Solid
) -> dict[str, FloatArray]:
    """Groups of parameters on which the fraction of bridged gaps depends, up to scale (from Eqs. 3 to 7 of the paper).

    ``load = ln[p0/(E1 h_rms)]``, ``gap = ln(d_K/h_rms)``, ``stiffness = ln(E0/E1)``, ``layer_thickness = ln d``; lengths in m. A
    homogeneous solid has the first two. Poisson ratios, γ and the shape of the spectrum are those of the table.

    Parameters
    ----------
    pressure : p0, Pa, > 0, shape ``(M,)``
    gap : d_K, m, > 0, shape ``(M,)``
    height : h_rms, m, > 0, shape ``(M,)``
    skin : moduli in Pa, thickness in m, each scalar or of shape ``(M,)``

    Returns
    -------
    groups : name to values, dimensionless or ln of SI values, each of shape ``(M,)``

    References
    ----------
    Persson, Kovalev & Gorb, Tribol. Lett. 50 (2013) 17, doi 10.1007/s11249-012-0053-2 (Appendix A).

    Examples
    --------
    >>> from skinbayes.contact import LayeredSkin
    >>> skin = LayeredSkin(young_modulus_layer=7e6, young_modulus_bulk=20e3, layer_thickness=20e-6)
    >>> groups = humid_groups(np.array([6830.0]), np.array([1e-9]), height=np.array([22.4e-6]), skin=skin)
    >>> print({name: float(value[0].round(3)) for name, value in groups.items()})
    {'load': 9.632, 'gap': -10.017, 'stiffness': 5.858, 'layer_thickness': -10.82}
    """
    groups = {
        "load": np.log(pressure / (scale_modulus(skin) * height)),
        "gap": np.log(gap / height),
        **{name: value for name, value in shape_groups(skin).items() if name in _STEPS},
    }
    return {name: np.broadcast_to(value, pressure.shape) for name, value in groups.items()}


def humid_table(
    box: Box,
    *,
    spectrum: PowerSpectrum,
    skin: Solid,
    area_correction: FloatArray,
    most: int = 250_000,
    progress: Progress | None = None,
) -> HumidTable | None:
    """Compute the fraction of bridged gaps on a grid of groups, to be interpolated for many skins (Eq. 7, App. A of the paper).

    Parameters
    ----------
    box : of the groups of `humid_groups`, dimensionless or ln of SI values, the upper end of ``load`` with the capillary
        pressure added
    spectrum : power spectrum, C in m^4, scalar; its height does not matter
    skin : Poisson ratios, dimensionless, scalar; moduli in Pa and thickness in m do not matter
    area_correction : γ, dimensionless, 0 < γ ≤ 1, scalar
    most : loads of skins to compute at most, dimensionless
    progress : called with the number of parts done and their total

    Returns
    -------
    table : `HumidTable`; None if it needs more than ``most``

    Notes
    -----
    The gaps have the Gaussian closure. Where bridges pull with less than half of the load, pressures of the table are within 3e-3
    of those of `capillary_state_in_humid_air`, 4e-4 in the root mean square; beyond within 2 %, 2e-3 in the root mean square,
    worst where skin is about to be pulled into complete contact.

    References
    ----------
    Persson, Kovalev & Gorb, Tribol. Lett. 50 (2013) 17, doi 10.1007/s11249-012-0053-2 (Appendix A).

    Examples
    --------
    >>> from skinbayes.contact import LayeredSkin
    >>> from skinbayes.emulation import Box
    >>> from skinbayes.roughness import named_surface
    >>> skin = LayeredSkin(young_modulus_layer=7e6, young_modulus_bulk=20e3, layer_thickness=20e-6)
    >>> groups = humid_groups(np.array([6830.0]), np.array([1e-9]), height=np.array([22.4e-6]), skin=skin)
    >>> ends = {name: (value[0], value[0] + (name in ("load", "gap"))) for name, value in groups.items()}
    >>> table = humid_table(Box(ends), spectrum=named_surface("paper_reference"), skin=skin,
    ...     area_correction=np.array(0.42))
    >>> print(table.axes["load"][1], f"{table.fraction(groups)[0]:.3e}")
    14 1.428e-04
    """
    nodes = {}
    for name, step in ((name, step) for name, step in _STEPS.items() if name in box.ends):
        low, high = box.ends[name]
        count = int(np.ceil((high - low) / step - 1e-9)) + 1
        room = 0 if count == 1 else _ROOM
        nodes[name] = low + step * np.arange(-room, count + room)
    shape = {name: x.size for name, x in nodes.items() if name in shape_groups(skin)}
    grids = np.meshgrid(*(nodes[name] for name in shape), indexing="ij")
    skins = {name: x.reshape(-1) for name, x in zip(shape, grids, strict=True)}
    total = prod(shape.values())
    if total * nodes["load"].size > most:
        return None
    surface: PowerSpectrum
    if isinstance(spectrum, SelfAffineSpectrum):
        surface = replace(spectrum, rms_height=_HEIGHT)
    elif isinstance(spectrum, TabulatedSpectrum):
        scale = spectrum.scale * (_HEIGHT / rms_height(spectrum)) ** 2
        surface = TabulatedSpectrum(spectrum.wavevector, spectrum.node_power, scale=scale)
    else:
        return None
    pressure, gap = _BULK * _HEIGHT * np.exp(nodes["load"]), _HEIGHT * np.exp(nodes["gap"])

    def spanned(places: Places) -> FloatArray:
        """F at all loads and gaps, shape ``(M, loads, gaps)``."""
        count = len(places[_ONE])
        some = {name: places[name] for name in shape}
        body = solid_of_groups({**shape_groups(skin), **some}, np.asarray(_BULK))
        source = GapSource(surface, body, area_correction, "gaussian")
        mixture, _ = source.at(np.broadcast_to(pressure, (count, pressure.size)))
        place, out = mixture.centre / mixture.width, 1 / mixture.width
        # both are lower tails, whose difference keeps its digits
        below = (ndtr(each * out - place) - ndtr(-each * out - place) for each in gap)
        return np.stack([(mixture.fraction * part).sum(axis=-1) for part in below], axis=-1)

    values = Tasks(progress=progress).at("skins", spanned, {_ONE: np.arange(float(total)), **skins}, _BLOCK)
    if not np.isfinite(values).all():
        return None
    grid = np.moveaxis(values.reshape(*shape.values(), pressure.size, gap.size), (-2, -1), (0, 1))
    axes = {name: (float(x[0]), x.size) for name, x in nodes.items() if x.size > 1}
    log_fraction = np.log(np.maximum(grid, 0.0) + _LITTLE).reshape([count for _, count in axes.values()])
    return HumidTable(box=box, axes=axes, coefficients=spline_filter(log_fraction, order=3))
