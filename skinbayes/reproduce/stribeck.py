"""Friction of the ball on lubricated skin, with and without loss in the tissue (Sect. 6.2, Figs. 13 to 15)."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline
from scipy.optimize import brentq, minimize_scalar

from skinbayes.arrays import FloatArray
from skinbayes.contact import (
    ViscoelasticMaterial,
    ViscoelasticSkin,
    standard_linear_solid,
    viscoelastic_line_contact,
)
from skinbayes.lubrication import (
    LubricatedFilms,
    StribeckCurve,
    ViscoelasticFilms,
    ViscoelasticStribeckCurve,
    asperity_law,
    lubricated_films,
    stribeck_curve,
    viscoelastic_films,
    viscoelastic_stribeck_curve,
)
from skinbayes.phrases import number
from skinbayes.reproduce.choices import FILM_AT_EXIT, RELAXATION, SOFTER
from skinbayes.reproduce.drying import hertz_diameter
from skinbayes.reproduce.paper import Paper
from skinbayes.reproduce.registry import Found, computes
from skinbayes.reproduce.words import farthest_from_one


def skin_curve(
    paper: Paper, contact: str, products: FloatArray | None = None, **liquid: object
) -> StribeckCurve:
    """Friction of the ball ("point") or its cylinder ("line") on lubricated skin."""
    return stribeck_curve(
        paper.products if products is None else products,
        normal_force=paper["oil-load"],
        sphere_radius=paper["ball-radius"],
        spectrum=paper.surface,
        skin=paper.wet,
        contact=contact,
        frictional_shear_stress=paper["shear-stress-used"],
        **liquid,  # type: ignore[arg-type]
    )


def lossy_curve(
    paper: Paper, tangent: float, products: FloatArray | None = None
) -> ViscoelasticStribeckCurve:
    """Friction of the cylinder on skin whose tissue has a loss tangent, at the mean speed of the experiments."""
    return viscoelastic_stribeck_curve(
        paper.oil_speed,
        (paper.products if products is None else products) / paper.oil_speed,
        normal_force=paper["oil-load"],
        sphere_radius=paper["ball-radius"],
        spectrum=paper.surface,
        skin=ViscoelasticSkin(
            layer=ViscoelasticMaterial(equilibrium_modulus=paper["young-modulus-layer-wet"]),
            bulk=paper.tissue(tangent),
            layer_thickness=paper["layer-thickness"],
        ),
        frictional_shear_stress=paper["shear-stress-used"],
    )


def films(paper: Paper, products: FloatArray) -> LubricatedFilms:
    """Films under the cylinder on rough wet skin."""
    load, radius = paper.cylinder
    return lubricated_films(
        products,
        load_per_length=float(load),
        cylinder_radius=float(radius),
        reduced_modulus=paper.tissue_modulus,
        asperities=asperity_law(paper.surface, paper.wet),
    )


def lossy_films(paper: Paper, tangent: float, products: FloatArray) -> ViscoelasticFilms:
    """The same on tissue with a loss tangent."""
    load, radius = paper.cylinder
    return viscoelastic_films(
        paper.oil_speed,
        products / paper.oil_speed,
        load_per_length=float(load),
        cylinder_radius=float(radius),
        material=paper.tissue(tangent),
        asperities=asperity_law(paper.surface, paper.wet),
    )


def plain_curve(paper: Paper) -> StribeckCurve:
    """The cylinder on elastic skin with trivial flow factors, as in Fig. 13."""
    return paper.once("cylinder on skin", lambda: skin_curve(paper, "line"))


def ball_curve(paper: Paper) -> StribeckCurve:
    """The ball itself on the same skin."""
    return paper.once("ball on skin", lambda: skin_curve(paper, "point"))


def _lossy(paper: Paper) -> ViscoelasticStribeckCurve:
    """The cylinder on skin whose tissue loses what the indentation loses."""
    return paper.once("cylinder on lossy skin", lambda: lossy_curve(paper, paper.loss_tangent))


class Features(NamedTuple):
    """Where a Stribeck curve is: ηv at half of its plateau and at its minimum, N/m, and the friction there."""

    half: float
    minimum: float
    least: float


def features(products: FloatArray, friction: FloatArray) -> Features:
    """Features of friction against ηv; the plateau is the first value."""
    logs = np.log(products)
    curve = CubicSpline(logs, np.log(friction))
    lowest = int(np.argmin(friction))
    found = minimize_scalar(curve, bounds=(logs[lowest - 1], logs[lowest + 1]), method="bounded")
    half = brentq(lambda log: curve(log) - np.log(friction[0] / 2), logs[0], logs[lowest])
    return Features(float(np.exp(half)), float(np.exp(found.x)), float(np.exp(found.fun)))


@computes("contact-diameter")
def _diameter(paper: Paper) -> float:
    return hertz_diameter(paper, "oil-load")


@computes("contact-frequency")
def _frequency(paper: Paper) -> Found:
    diameter = hertz_diameter(paper, "oil-load")
    ends = (number(paper[name] / diameter, 2) for name in ("oil-speed-least", "oil-speed-most"))
    return Found(paper.oil_speed / diameter, f"From {' to '.join(ends)} 1/s over the range of speeds.")


@computes("hysteresis-friction")
def _hysteresis(paper: Paper) -> Found:
    lossy = _lossy(paper)
    return Found(
        float(lossy.hysteresis[np.argmin(lossy.friction_coefficient)]),
        f"Constant loss angle with tan δ = {number(paper.loss_tangent)}, at the minimum of friction.",
    )


@computes("indentation-set")
def _set(paper: Paper) -> Found:
    return Found(
        paper.indentation(paper.tissue(paper.loss_tangent))[1],
        f"Of a solid of constant loss angle, tan δ = {number(paper.loss_tangent)}. One relaxation time of {RELAXATION:g} s that "
        f"loses as much keeps {number(1e3 * _set_of_one_time(paper))} mm.",
    )


def _set_of_one_time(paper: Paper) -> float:
    """Set, m, of a solid with one relaxation time that loses what the indentation lost."""

    def material(log_ratio: float) -> ViscoelasticMaterial:
        stiff = paper["young-modulus-bulk"] * float(np.exp(log_ratio))
        return standard_linear_solid(paper["young-modulus-bulk"], stiff, relaxation_time=RELAXATION)

    def miss(log_ratio: float) -> float:
        return paper.indentation(material(log_ratio))[0] - paper["indentation-loss"]

    return paper.indentation(material(float(brentq(miss, 0.01, 1.0, xtol=1e-4))))[1]


def _decades(paper: Paper) -> FloatArray:
    """The speeds times viscosity of Fig. 15, N/m."""
    ends = np.log10([paper["profile-product-least"], paper["profile-product-most"]]).round()
    return 10.0 ** np.arange(ends[0], ends[1] + 1)


def profiles(paper: Paper) -> tuple[FloatArray, LubricatedFilms]:
    """The speeds times viscosity of Fig. 15, N/m, and their films."""
    products = _decades(paper)
    return products, films(paper, products)


def _lifted(paper: Paper) -> tuple[NDArray[np.intp], LubricatedFilms]:
    """Rows of the films of Fig. 15 where the liquid carries more than half of the load, and all films."""
    found = profiles(paper)[1]
    return np.flatnonzero(found.asperity_load_fraction < 0.5), found


def _positions(found: LubricatedFilms) -> FloatArray:
    return np.broadcast_to(found.position, found.separation.shape)


@computes("thinnest-at-exit")
def _thinnest(paper: Paper) -> Found:
    rows, found = _lifted(paper)
    place = _positions(found)[rows, np.argmin(found.separation[rows], axis=1)] / paper.half_width
    return Found(
        float(place.min()),
        f"In half-widths of the contact; up to {number(float(place.max()), 2)}. At slower speeds, where asperities carry the "
        "load, it is in the middle.",
    )


@computes("pressure-at-exit")
def _pressure(paper: Paper) -> Found:
    rows, found = _lifted(paper)
    place = _positions(found)[rows, np.argmax(found.asperity_pressure[rows], axis=1)] / paper.half_width
    return Found(
        float(place.min()),
        f"In half-widths of the contact, {len(rows)} of {len(found.separation)} speeds; up to {number(float(place.max()), 2)}.",
    )


@computes("lossy-contact-is-asymmetric")
def _asymmetric(paper: Paper) -> float:
    load, radius = paper.cylinder
    contact = viscoelastic_line_contact(
        paper.oil_speed,
        load_per_length=float(load),
        cylinder_radius=float(radius),
        material=paper.tissue(paper.loss_tangent),
    )
    lead, trail = float(np.squeeze(contact.leading_edge)), float(np.squeeze(contact.trailing_edge))
    return (-lead - trail) / (trail - lead)


def _exit_over_centre(paper: Paper, tangent: float | None) -> tuple[float, float]:
    """Smallest over central film at the exit, and the central film in m."""
    at = np.array([FILM_AT_EXIT])
    found = films(paper, at) if tangent is None else lossy_films(paper, tangent, at)
    return float(found.minimum_film[0] / found.central_film[0]), float(found.central_film[0])


@computes("exit-opens")
def _opens(paper: Paper) -> Found:
    (elastic, film), (lossy, less) = (_exit_over_centre(paper, t) for t in (None, paper.loss_tangent))
    return Found(
        lossy / elastic,
        f"{number(lossy)} of the central film against {number(elastic)}. But the central film falls from "
        f"{number(1e6 * film)} to {number(1e6 * less)} µm.",
    )


def shifts(paper: Paper) -> tuple[float, float]:
    """ηv at half of the plateau and at the minimum, of skin with loss over elastic skin; hysteresis left out."""
    lossy = _lossy(paper)
    with_loss = features(paper.products, lossy.friction_coefficient - lossy.hysteresis)
    without = features(paper.products, plain_curve(paper).friction_coefficient)
    return with_loss.half / without.half, with_loss.minimum / without.minimum


@computes("loss-shifts-down")
def _shift(paper: Paper) -> Found:
    half = shifts(paper)[0]
    return Found(
        half,
        "The exit opens as the paper says, but pressure moves to the inlet and the film as a whole gets thinner: loss moves the "
        f"curve the other way, by {number(np.log10(half), 2)} decades, where one (abstract) or 1.3 (text) down are asked for.",
    )


def softer_features(paper: Paper) -> Features:
    """Features of elastic skin whose layer and tissue are both six times softer."""
    softer = paper.with_values(
        young_modulus_bulk=paper["young-modulus-bulk"] / SOFTER,
        young_modulus_layer_wet=paper["young-modulus-layer-wet"] / SOFTER,
    )
    curve = paper.once("softer skin", lambda: skin_curve(softer, "line", largest_strain=np.inf))
    return features(paper.products, curve.friction_coefficient)


@computes("loss-widens-hydrodynamic")
def _minimum(paper: Paper) -> Found:
    plain, soft = features(paper.products, plain_curve(paper).friction_coefficient), softer_features(paper)
    return Found(
        shifts(paper)[1],
        f"As above. Layer and tissue six times softer would move half of the plateau to {number(soft.half / plain.half, 2)} and "
        f"the minimum to {number(soft.minimum / plain.minimum, 2)} of their speeds.",
    )


@computes("hysteresis-is-small")
def _small(paper: Paper) -> float:
    lossy = _lossy(paper)
    return float(lossy.hysteresis[0] / lossy.friction_coefficient[0])


@computes("skin-like-cylinder")
def _like(paper: Paper) -> Found:
    ball, cylinder = ball_curve(paper), plain_curve(paper)
    of_ball, of_cylinder = (features(paper.products, one.friction_coefficient) for one in (ball, cylinder))
    return Found(
        farthest_from_one(ball.friction_coefficient / cylinder.friction_coefficient),
        f"At equal ηv. The ball's curve lies at {number(of_ball.half / of_cylinder.half)} of the speed of its cylinder's, and "
        f"its smallest friction is {number(of_ball.least)} against {number(of_cylinder.least)}.",
    )
