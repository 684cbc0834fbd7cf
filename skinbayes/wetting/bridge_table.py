"""Pull of capillary bridges against the film, interpolated between skins solved beforehand.

The bridges of a layered rough skin depend on a few groups only. Heights scale: a surface k times as high under k times the load
has the same gaps, k times as wide; and so do moduli and loads. What is left is the stiffness of the layer over that of the
tissue, the load over stiffness and height, the pull, the thickness of the layer, and the shape of the spectrum. Those groups that
vary span a box, on whose Chebyshev nodes the bridges are solved.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from itertools import product
from math import prod

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.contact import mean_separation
from skinbayes.roughness import TabulatedSpectrum, rms_height
from skinbayes.roughness.spectrum import PowerSpectrum, SelfAffineSpectrum
from skinbayes.wetting._chebyshev import coefficients, lobatto, polynomials, values_at_nodes
from skinbayes.wetting._curve import REFERENCE, TERMS, Curve, solve_curve
from skinbayes.wetting._gaps import GapSource
from skinbayes.wetting._solids import Solid, scale_modulus, shape_groups, solid_of_groups
from skinbayes.wetting._types import BoolArray

SURFACE_GROUPS = ("hurst_exponent", "wavevector_min", "wavevector_rolloff", "wavevector_max")
"""Groups of a self-affine spectrum, the wavevectors as logarithms."""

_TERMS = TERMS["gaussian"]
_COUNTS = (2, 3, 4, 5, 6, 7, 8, 9, 11, 13, 16, 20)
_PLACES, _TRIALS = 9, 48
# error of p and of the flooded film along one axis, and in the whole box; single solutions are rough to 2e-4
_AIM, _WORST = 3e-4, 6e-4
_CUT, _CUTS = 0.05, 16  # by which a box is cut whose corners have no solution
_TILT = 1 / 3  # exponent of E0/E1 in the load: skins whose pull runs away then lie beyond one value of it
_WIDEN = 1e-9
_NO_LAYER = np.zeros(())  # ln(E0/E1)
_BLOCK = 64  # skins solved at a time
_PULL = 1e-5  # m; the pull varies linearly far below it
_BULK, _HEIGHT = 2e4, 2e-5  # Pa and m; any would do

Groups = Mapping[str, FloatArray]


@dataclass(frozen=True, eq=False, kw_only=True)
class BridgeTable:
    """Bridges of skins in a box of dimensionless groups, each a curve along the Kelvin length.

    Attributes
    ----------
    low, high : of each group of `skin_groups`, dimensionless or ln of SI values
    counts : nodes of each group that varies, dimensionless
    depth : how far the curves go, to ``d_K = 0.9 ū [depth ū E1/p0]^(−½)``, 1/m
    parts : Chebyshev coefficients along z of the logarithms of the film over the flooded one and of p/p0, and ln(ū/h_rms),
        each expanded in the groups, dimensionless, shape ``(nodes, 2 terms + 1)``
    error : at random places of the box, root mean square of the relative error of p at given films, or largest relative error
        of the flooded film, if that is larger; nan if not measured, dimensionless

    References
    ----------
    Persson, Kovalev & Gorb, Tribol. Lett. 50 (2013) 17, doi 10.1007/s11249-012-0053-2 (Sect. 5, Eqs. 5 to 7).
    """

    low: Mapping[str, float]
    high: Mapping[str, float]
    counts: Mapping[str, int]
    depth: float
    parts: FloatArray
    error: float

    def covers(self, groups: Groups) -> BoolArray:
        """Tell which members of a flat batch lie in the box, shape ``(B,)``."""
        inside = [
            (groups[name] >= self.low[name] - _WIDEN) & (groups[name] <= self.high[name] + _WIDEN)
            for name in self.low
        ]
        return np.asarray(np.logical_and.reduce(inside))

    def curve(self, groups: Groups, pressure: FloatArray, *, height: FloatArray) -> Curve:
        """Curves of skins in the box; pressure, Pa, and rms height, m, have the shape ``(B,)`` of the groups."""
        weight = np.ones((pressure.size, 1))
        for name, count in self.counts.items():
            t = 2 * (groups[name] - self.low[name]) / (self.high[name] - self.low[name]) - 1
            basis = polynomials(t, count)[0]
            weight = (weight[:, :, None] * basis[:, None, :]).reshape(pressure.size, -1)
        # one product for each member, contiguous: a product of all rows at once may round differently
        found = (np.ascontiguousarray(weight)[:, None, :] @ self.parts)[:, 0, :]
        return _curve_of(found, _end(self.depth, found[:, -1], _pressing(groups)), pressure, height)


def skin_groups(
    pressure: FloatArray,
    pull: FloatArray,
    *,
    height: FloatArray,
    spectrum: PowerSpectrum,
    skin: Solid,
    area_correction: FloatArray,
) -> dict[str, FloatArray]:
    """Groups of parameters on which capillary bridges depend, up to scale (from Eqs. 3 to 7 of the paper).

    ``stiffness = ln(E0/E1)``, ``load = ln[p0/(E1^⅔ E0^⅓ h_rms)]``, ``pull = ln(1 + γ_w Σcos θ E1/(p0² 10 µm))``, ln of the
    thickness of the layer and of the wavevectors; Hurst exponent, Poisson ratios and γ as they are. Lengths are in m. A
    homogeneous solid has no stiffness and no thickness of a layer.

    Parameters
    ----------
    pressure : p0, Pa, > 0, shape ``(B,)``
    pull : γ_w (cos θ1 + cos θ2), N/m, ≥ 0, shape ``(B,)``
    height : h_rms of the spectrum, m, > 0, shape ``(B,)``
    spectrum : power spectrum, C in m^4, scalar or of shape ``(B,)``
    skin : moduli in Pa, thickness in m, each scalar or of shape ``(B,)``
    area_correction : γ, dimensionless, 0 < γ ≤ 1, scalar or of shape ``(B,)``

    Returns
    -------
    groups : name to values, dimensionless or ln of SI values, each of shape ``(B,)``

    References
    ----------
    Persson, Kovalev & Gorb, Tribol. Lett. 50 (2013) 17, doi 10.1007/s11249-012-0053-2 (Sect. 5, Eqs. 5 to 7).

    Examples
    --------
    >>> from skinbayes.contact import LayeredSkin
    >>> from skinbayes.roughness import named_surface
    >>> skin = LayeredSkin(young_modulus_layer=7e6, young_modulus_bulk=20e3, layer_thickness=20e-6)
    >>> groups = skin_groups(np.array([6830.0]), np.array([0.0845]), height=np.array([22.4e-6]),
    ...     spectrum=named_surface("paper_reference"), skin=skin, area_correction=np.array(0.42))
    >>> print(groups["stiffness"].round(3), groups["load"].round(3), groups["pull"].round(3))
    [5.858] [7.679] [1.531]
    """
    bulk, shape = scale_modulus(skin), shape_groups(skin)
    groups = {name: shape[name] for name in ("stiffness",) if name in shape}
    groups |= {
        "load": np.log(pressure / (bulk * height)) - _TILT * shape.get("stiffness", _NO_LAYER),
        "pull": np.log1p(pull * bulk / np.square(pressure) / _PULL),
        **shape,
        "area_correction": np.asarray(area_correction),
    }
    if isinstance(spectrum, SelfAffineSpectrum):
        groups["hurst_exponent"] = np.asarray(spectrum.hurst_exponent)
        for name in SURFACE_GROUPS[1:]:
            groups[name] = np.log(getattr(spectrum, name))
    return {name: np.broadcast_to(value, pressure.shape) for name, value in groups.items()}


def bridge_table(
    low: Mapping[str, float],
    high: Mapping[str, float],
    *,
    depth: float,
    spectrum: PowerSpectrum | None = None,
    most: int = 4000,
    progress: Callable[[int, int], None] | None = None,
) -> BridgeTable | None:
    """Solve bridges on the nodes of a box of groups, for many skins to be interpolated (Eqs. 5 to 7 of the paper).

    Parameters
    ----------
    low : lower end of each group of `skin_groups`, dimensionless or ln of SI values
    high : upper end of each group; equal to the lower one where it does not vary, dimensionless or ln of SI values
    depth : p0/E1 over the thinnest film that will be asked for, 1/m
    spectrum : tabulated spectrum, C in m^4, if the surface is one; None is a self-affine one
    most : skins to solve at most, dimensionless
    progress : called with the number of skins solved and their total, dimensionless

    Returns
    -------
    table : `BridgeTable`; without the skins of the largest load of the box if the pull runs away there; None if it needs more
        skins than ``most`` or does not come to 6e-4 of the pressure

    Notes
    -----
    Pressures at a film are those of `capillary_state` with ``refine=False``, to ``table.error``; 99 % of them within five times
    that, the worst towards the flooded film, where the pull sets in. The solutions themselves are rough at the level of a few
    1e-4, which is why more nodes do not help beyond that. Three groups take 100 to 600 skins.

    References
    ----------
    Persson, Kovalev & Gorb, Tribol. Lett. 50 (2013) 17, doi 10.1007/s11249-012-0053-2 (Sect. 5, Eqs. 5 to 7).

    Examples
    --------
    Layers from 6 to 8 MPa, down to a film of about 0.1 µm:

    >>> from skinbayes.contact import LayeredSkin
    >>> from skinbayes.roughness import named_surface
    >>> skins = LayeredSkin(young_modulus_layer=np.array([6e6, 8e6]), young_modulus_bulk=20e3,
    ...     layer_thickness=20e-6)
    >>> groups = skin_groups(np.full(2, 6830.0), np.full(2, 0.0845), height=np.full(2, 22.4e-6),
    ...     spectrum=named_surface("paper_reference"), skin=skins, area_correction=np.array(0.42))
    >>> low, high = ({name: end(x) for name, x in groups.items()} for end in (np.min, np.max))
    >>> table = bridge_table(low, high, depth=6830.0 / 20e3 / 1e-7)
    >>> print(dict(table.counts), table.error < 1e-3)
    {'stiffness': 2, 'load': 3} True
    """
    low, high = dict(low), dict(high)
    for _ in range(_CUTS):
        counts = _counts(low, high, depth, spectrum) if _solvable(low, high, depth, spectrum) else None
        if counts is not None:
            break
        # the pull runs away under large loads
        high["load"] -= _CUT * (high["load"] - low["load"])
    else:
        return None
    rng = np.random.default_rng(0)
    trial = {name: rng.uniform(low[name], high[name], _TRIALS) for name in counts}
    sound = _solve({**_fields(low), **trial}, depth, spectrum)
    while prod(counts.values()) <= most:
        whole = _build(low, high, counts, depth, spectrum, progress)
        if whole is None:
            return None
        error = _error(whole, trial, sound)
        if error < _WORST:
            return replace(whole, error=error)
        counts = {name: count + 1 for name, count in counts.items()}
    return None


def _counts(
    low: Mapping[str, float], high: Mapping[str, float], depth: float, spectrum: PowerSpectrum | None
) -> dict[str, int] | None:
    """Nodes along each group that varies, enough where the others are in the middle; None if no number is."""
    middle = {name: (low[name] + high[name]) / 2 for name in low}
    counts: dict[str, int] = {}
    for name in (name for name in low if high[name] > low[name]):
        first, last = ({**middle, name: ends[name]} for ends in (low, high))
        places = {name: np.linspace(low[name], high[name], _PLACES + 2)[1:-1]}
        sound = _solve({**_fields(middle), **places}, depth, spectrum)
        for count in _COUNTS:
            table = _build(first, last, {name: count}, depth, spectrum)
            if table is not None and _error(table, places, sound) < _AIM:
                break
        else:
            return None
        counts[name] = count
    return counts


def _fields(values: Mapping[str, float]) -> dict[str, FloatArray]:
    return {name: np.array([value]) for name, value in values.items()}


def _build(
    low: Mapping[str, float],
    high: Mapping[str, float],
    counts: Mapping[str, int],
    depth: float,
    spectrum: PowerSpectrum | None,
    progress: Callable[[int, int], None] | None = None,
) -> BridgeTable | None:
    """The table with given numbers of nodes, its error left open; None if some nodes have no solution."""
    total = prod(counts.values())
    nodes = [low[name] + (high[name] - low[name]) * lobatto(count) for name, count in counts.items()]
    grid = dict(zip(counts, (x.reshape(-1) for x in np.meshgrid(*nodes, indexing="ij")), strict=True))
    values = np.empty((total, 2 * _TERMS + 1))
    for first in range(0, total, _BLOCK):
        block = slice(first, first + _BLOCK)
        values[block] = _solve({**_fields(low), **{n: x[block] for n, x in grid.items()}}, depth, spectrum)
        if progress is not None:
            progress(min(first + _BLOCK, total), total)
    if not np.isfinite(values).all():
        return None
    parts = values.reshape(*counts.values(), -1)
    for i, count in enumerate(counts.values()):
        moved = np.moveaxis(parts, i, 0)
        parts = np.moveaxis(coefficients(moved.reshape(1, count, -1)).reshape(moved.shape), 0, i)
    parts = np.ascontiguousarray(parts.reshape(total, -1))
    return BridgeTable(
        low=dict(low), high=dict(high), counts=dict(counts), depth=depth, parts=parts, error=np.nan
    )


def _solvable(
    low: Mapping[str, float], high: Mapping[str, float], depth: float, spectrum: PowerSpectrum | None
) -> bool:
    """Tell whether all corners of the box have curves."""
    ends = [sorted({low[name], high[name]}) for name in low]
    corners = dict(zip(low, np.array(list(product(*ends))).T, strict=True))
    return bool(np.isfinite(_solve(corners, depth, spectrum)).all())


def _pressing(groups: Groups) -> FloatArray:
    """ln[p0/(E1 h_rms)]."""
    return np.asarray(groups["load"] + _TILT * groups.get("stiffness", _NO_LAYER))


def _end(depth: float, log_separation: FloatArray, pressing: FloatArray) -> FloatArray:
    """Largest z = ln(1 + d0/d_K) of the curves: films thin as the square of d_K/ū, so that it follows the root of ū."""
    return np.asarray(np.log1p(REFERENCE / 0.9 * np.exp((np.log(depth) + log_separation - pressing) / 2)))


def _error(table: BridgeTable, places: Groups, exact: FloatArray) -> float:
    """Relative error of p, root mean square over places of the box and all films, or the largest of the flooded film, if that is
    larger; ``exact`` are the coefficients there."""
    count = len(exact)
    groups = {n: np.broadcast_to(x, (count,)) for n, x in {**_fields(table.low), **places}.items()}
    one = np.ones(count)
    curve = table.curve(groups, one, height=one)
    sound = _curve_of(exact, curve.end, one, one)
    # all films but the last of them, which one of the two may not reach, and the vertical rise where the gap is flooded
    z = curve.end[:, None] * np.linspace(0.2, 0.98, 48)
    film = np.exp(sound.along(z)[0])
    # a curve that is nan is as wrong as can be
    errors = np.nan_to_num(np.abs(curve.at(film)[1][0] - sound.at(film)[1][0]), nan=np.inf)
    flooded = np.max(np.abs(curve.flooded() / sound.flooded() - 1))
    return float(np.fmax(np.sqrt(np.mean(np.square(errors))), flooded))


def _curve_of(found: FloatArray, end: FloatArray, pressure: FloatArray, height: FloatArray) -> Curve:
    """Curves from coefficients as in `BridgeTable`, shape ``(B, 2 terms + 1)``."""
    separation = height * np.exp(found[:, -1])
    parts = np.stack([found[:, :_TERMS], found[:, _TERMS:-1]], axis=-1)
    parts[:, 0] += np.log(np.stack([separation, pressure], axis=-1))
    nodes = values_at_nodes(np.ascontiguousarray(parts[..., 0]))
    return Curve(REFERENCE * separation, end, nodes, parts)


def _solve(places: Groups, depth: float, spectrum: PowerSpectrum | None) -> FloatArray:
    """Chebyshev coefficients along z, and ln(ū/h_rms), as in `BridgeTable`, of skins with the groups ``places``."""
    curve, load, flooded = _curves(places, depth, spectrum)
    parts = curve.parts[..., :2].copy()
    parts[:, 0] -= np.log(np.stack([flooded, load], axis=-1))
    return np.concatenate([parts[..., 0], parts[..., 1], np.log(flooded / _HEIGHT)[:, None]], axis=1)


def _curves(
    places: Groups, depth: float, spectrum: PowerSpectrum | None
) -> tuple[Curve, FloatArray, FloatArray]:
    """Curves of skins of some height and modulus with the groups ``places``, their loads, Pa, and flooded films, m."""
    count = max(len(x) for x in places.values())
    given = {name: np.broadcast_to(x, (count,)) for name, x in places.items()}
    bulk, height = np.full(count, _BULK), np.full(count, _HEIGHT)
    surface: PowerSpectrum
    if isinstance(spectrum, TabulatedSpectrum):
        scale = spectrum.scale * (height / rms_height(spectrum)) ** 2
        surface = TabulatedSpectrum(spectrum.wavevector, spectrum.node_power, scale=scale)
    else:
        waves = {name: np.exp(given[name]) for name in SURFACE_GROUPS[1:]}
        surface = SelfAffineSpectrum(rms_height=height, hurst_exponent=given["hurst_exponent"], **waves)
    skin = solid_of_groups(given, bulk)
    pressing = _pressing(given)
    load = _BULK * _HEIGHT * np.exp(pressing)
    pull = np.expm1(given["pull"]) * _PULL * np.square(load) / _BULK
    gamma = np.ascontiguousarray(given["area_correction"])
    with np.errstate(all="ignore"):
        flooded = np.asarray(mean_separation(load[:, None], surface, skin=skin, area_correction=gamma))[:, 0]
        source = GapSource(surface, skin, gamma, "gaussian")
        end = _end(depth, np.log(flooded / _HEIGHT), pressing)
        return solve_curve(source, load, pull, flooded, flooded / 10, end), load, flooded
