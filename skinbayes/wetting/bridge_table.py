"""Capillary pressure of bridges against the film, interpolated between skins solved beforehand.

The bridges of a layered rough skin depend on a few groups only. Heights scale: a surface k times as high under k times the load
has the same gaps, k times as wide; and so do moduli and loads. What is left is the stiffness of the layer over that of the
tissue, the load over stiffness and height, the capillary pressure, the thickness of the layer, and the shape of the spectrum.
Those groups that vary span a box, on whose Chebyshev nodes the bridges are solved.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import numpy as np

from skinbayes.arrays import BoolArray, FloatArray
from skinbayes.contact import mean_separation
from skinbayes.emulation import Box, Interpolant, Places, Progress, Tasks, counts_along, refined
from skinbayes.emulation.chebyshev import values_at_nodes
from skinbayes.roughness import TabulatedSpectrum, rms_height
from skinbayes.roughness.spectrum import PowerSpectrum, SelfAffineSpectrum
from skinbayes.wetting._curve import REFERENCE, TERMS, Curve, solve_curve
from skinbayes.wetting._gaps import GapSource
from skinbayes.wetting._solids import Solid, scale_modulus, shape_groups, solid_of_groups

SURFACE_GROUPS = ("hurst_exponent", "wavevector_min", "wavevector_rolloff", "wavevector_max")
"""Groups of a self-affine spectrum, the wavevectors as logarithms."""

_TERMS = TERMS["gaussian"]
_TRIALS = 48
# error of p and of the flooded film along one axis, and in the whole box; single solutions are rough to 2e-4
_AIM, _WORST = 3e-4, 6e-4
_CUT, _CUTS = 0.05, 16  # by which a box is cut whose corners have no solution
_TILT = (
    1 / 3
)  # exponent of E0/E1 in the load: skins whose capillary pressure runs away then lie beyond one value of it
_NO_LAYER = np.zeros(())  # ln(E0/E1)
_TENSION_SCALE = 1e-5  # m; the capillary pressure varies linearly far below it
_BULK, _HEIGHT = 2e4, 2e-5  # Pa and m; any would do


@dataclass(frozen=True, eq=False, kw_only=True)
class BridgeTable:
    """Bridges of skins in a box of dimensionless groups, each a curve along the Kelvin length.

    Attributes
    ----------
    found : of the groups of `skin_groups`, dimensionless or ln of SI values: the logarithms of the film over the flooded one and
        of p/p0, as Chebyshev coefficients along z, and ln(ū/h_rms), dimensionless, ``2 terms + 1`` columns. Its error is the
        root mean square of the relative error of p at given films, or the largest relative error of the flooded film, if
        that is larger
    depth : how far the curves go, to ``d_K = 0.9 ū [depth ū E1/p0]^(−½)``, 1/m

    References
    ----------
    Persson, Kovalev & Gorb, Tribol. Lett. 50 (2013) 17, doi 10.1007/s11249-012-0053-2 (Sect. 5, Eqs. 5 to 7).
    """

    found: Interpolant
    depth: float

    def covers(self, groups: Places) -> BoolArray:
        """Tell which members of a flat batch lie in the box, shape ``(B,)``."""
        return self.found.box.covers(groups)

    def curve(self, groups: Places, pressure: FloatArray, *, height: FloatArray) -> Curve:
        """Curves of skins in the box; pressure, Pa, and rms height, m, have the shape ``(B,)`` of the groups."""
        return _curve_of(self.found(groups), self.depth, groups, pressure, height)


def skin_groups(
    pressure: FloatArray,
    wetting_tension: FloatArray,
    *,
    height: FloatArray,
    spectrum: PowerSpectrum,
    skin: Solid,
    area_correction: FloatArray,
) -> dict[str, FloatArray]:
    """Groups of parameters on which capillary bridges depend, up to scale (from Eqs. 3 to 7 of the paper).

    ``stiffness = ln(E0/E1)``, ``load = ln[p0/(E1^⅔ E0^⅓ h_rms)]``, ``wetting_tension = ln(1 + γ_w Σcos θ E1/(p0² 10 µm))``, ln
    of the thickness of the layer and of the wavevectors; Hurst exponent, Poisson ratios and γ as they are. Lengths are in m. A
    homogeneous solid has no stiffness and no thickness of a layer.

    Parameters
    ----------
    pressure : p0, Pa, > 0, shape ``(B,)``
    wetting_tension : γ_w (cos θ1 + cos θ2), N/m, ≥ 0, shape ``(B,)``
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
    >>> print(groups["stiffness"].round(3), groups["load"].round(3), groups["wetting_tension"].round(3))
    [5.858] [7.679] [1.531]
    """
    bulk, shape = scale_modulus(skin), shape_groups(skin)
    groups = {name: shape[name] for name in ("stiffness",) if name in shape}
    groups |= {
        "load": np.log(pressure / (bulk * height)) - _TILT * shape.get("stiffness", _NO_LAYER),
        "wetting_tension": np.log1p(wetting_tension * bulk / np.square(pressure) / _TENSION_SCALE),
        **shape,
        "area_correction": np.asarray(area_correction),
    }
    if isinstance(spectrum, SelfAffineSpectrum):
        groups["hurst_exponent"] = np.asarray(spectrum.hurst_exponent)
        for name in SURFACE_GROUPS[1:]:
            groups[name] = np.log(getattr(spectrum, name))
    return {name: np.broadcast_to(value, pressure.shape) for name, value in groups.items()}


def bridge_table(
    box: Box,
    *,
    depth: float,
    spectrum: PowerSpectrum | None = None,
    most: int = 4000,
    progress: Progress | None = None,
) -> BridgeTable | None:
    """Solve bridges on the nodes of a box of groups, for many skins to be interpolated (Eqs. 5 to 7 of the paper).

    Parameters
    ----------
    box : of the groups of `skin_groups`, dimensionless or ln of SI values
    depth : p0/E1 over the thinnest film that will be asked for, 1/m
    spectrum : tabulated spectrum, C in m^4, if the surface is one; None is a self-affine one
    most : skins to solve at most, dimensionless
    progress : called with the number of parts done and their total

    Returns
    -------
    table : `BridgeTable`; without the skins of the largest load of the box if the capillary pressure runs away there; None if
        it needs more skins than ``most`` or does not come to 6e-4 of the pressure

    Notes
    -----
    Pressures at a film are those of `capillary_state` with ``refine=False``, to ``table.found.error``; 99 % of them within five
    times that, the worst towards the flooded film, where the capillary pressure sets in. The solutions themselves are rough at
    the level of a few 1e-4, which is why more nodes do not help beyond that. Three groups take 100 to 600 skins.

    References
    ----------
    Persson, Kovalev & Gorb, Tribol. Lett. 50 (2013) 17, doi 10.1007/s11249-012-0053-2 (Sect. 5, Eqs. 5 to 7).

    Examples
    --------
    Layers from 6 to 8 MPa, down to a film of about 0.1 µm:

    >>> from skinbayes.contact import LayeredSkin
    >>> from skinbayes.emulation import Box
    >>> from skinbayes.roughness import named_surface
    >>> skins = LayeredSkin(young_modulus_layer=np.array([6e6, 8e6]), young_modulus_bulk=20e3,
    ...     layer_thickness=20e-6)
    >>> groups = skin_groups(np.full(2, 6830.0), np.full(2, 0.0845), height=np.full(2, 22.4e-6),
    ...     spectrum=named_surface("paper_reference"), skin=skins, area_correction=np.array(0.42))
    >>> table = bridge_table(Box.around(groups), depth=6830.0 / 20e3 / 1e-7)
    >>> print(dict(table.found.counts), table.found.error < 1e-3)
    {'stiffness': 2, 'load': 3} True
    """
    solve = partial(_solve, depth=depth, spectrum=spectrum)
    judge = partial(_error, depth=depth)
    for _ in range(_CUTS):
        corners = box.corners()
        solvable = corners is not None and np.isfinite(solve(corners)).all()
        if solvable and (counts := counts_along(box, solve, judge, _AIM, Tasks())) is not None:
            break
        # the capillary pressure runs away under large loads
        low, high = box.ends["load"]
        box = Box({**box.ends, "load": (low, high - _CUT * (high - low))})
    else:
        return None
    trial = box.random(_TRIALS, seed=0)
    found = refined(
        box,
        counts,
        solve,
        judge,
        trial=trial,
        exact=solve(trial),
        worst=_WORST,
        most=most,
        tasks=Tasks(progress=progress),
    )
    return None if found is None else BridgeTable(found=found, depth=depth)


def _pressing(groups: Places) -> FloatArray:
    """ln[p0/(E1 h_rms)]."""
    return np.asarray(groups["load"] + _TILT * groups.get("stiffness", _NO_LAYER))


def _end(depth: float, log_separation: FloatArray, pressing: FloatArray) -> FloatArray:
    """Largest z = ln(1 + d0/d_K) of the curves: films thin as the square of d_K/ū, so that it follows the root of ū."""
    return np.asarray(np.log1p(REFERENCE / 0.9 * np.exp((np.log(depth) + log_separation - pressing) / 2)))


def _error(found: FloatArray, exact: FloatArray, places: Places, depth: float) -> float:
    """Relative error of p, root mean square over places of the box and all films, or the largest of the flooded film, if that is
    larger, of interpolated coefficients."""
    groups = {name: np.broadcast_to(x, (len(exact),)) for name, x in places.items()}
    one = np.ones(len(exact))
    curve = _curve_of(found, depth, groups, one, one)
    sound = _curve_of(exact, depth, groups, one, one)._replace(end=curve.end)
    # all films but the last of them, which one of the two may not reach, and the vertical rise where the gap is flooded
    z = curve.end[:, None] * np.linspace(0.2, 0.98, 48)
    film = np.exp(sound.along(z)[0])
    # a curve that is nan is as wrong as can be
    errors = np.nan_to_num(np.abs(curve.at(film)[1][0] - sound.at(film)[1][0]), nan=np.inf)
    flooded = np.max(np.abs(curve.flooded() / sound.flooded() - 1))
    return float(np.fmax(np.sqrt(np.mean(np.square(errors))), flooded))


def _curve_of(
    found: FloatArray, depth: float, groups: Places, pressure: FloatArray, height: FloatArray
) -> Curve:
    """Curves from the columns of a `BridgeTable`, shape ``(B, 2 terms + 1)``."""
    end = _end(depth, found[:, -1], _pressing(groups))
    separation = height * np.exp(found[:, -1])
    parts = np.stack([found[:, :_TERMS], found[:, _TERMS:-1]], axis=-1)
    parts[:, 0] += np.log(np.stack([separation, pressure], axis=-1))
    nodes = values_at_nodes(np.ascontiguousarray(parts[..., 0]))
    return Curve(REFERENCE * separation, end, nodes, parts)


def _solve(places: Places, depth: float, spectrum: PowerSpectrum | None) -> FloatArray:
    """Columns of a `BridgeTable` for skins with the groups ``places``."""
    curve, load, flooded = _curves(places, depth, spectrum)
    parts = curve.parts[..., :2].copy()
    parts[:, 0] -= np.log(np.stack([flooded, load], axis=-1))
    return np.concatenate([parts[..., 0], parts[..., 1], np.log(flooded / _HEIGHT)[:, None]], axis=1)


def _curves(
    places: Places, depth: float, spectrum: PowerSpectrum | None
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
    wetting_tension = np.expm1(given["wetting_tension"]) * _TENSION_SCALE * np.square(load) / _BULK
    gamma = np.ascontiguousarray(given["area_correction"])
    with np.errstate(all="ignore"):
        flooded = np.asarray(mean_separation(load[:, None], surface, skin=skin, area_correction=gamma))[:, 0]
        source = GapSource(surface, skin, gamma, "gaussian")
        end = _end(depth, np.log(flooded / _HEIGHT), pressing)
        return solve_curve(source, load, wetting_tension, flooded, flooded / 10, end), load, flooded
