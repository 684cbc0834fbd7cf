"""Numbers and equations of the contact area (Sects. 1, 4 and 7)."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.optimize import brentq

from skinbayes.contact import (
    AREA_CORRECTION,
    LayeredSkin,
    elastoplastic_contact_area,
    layered_sphere_contact,
    persson_contact_area,
    relative_contact_area,
    surface_response,
    twice_stress_variance,
)
from skinbayes.friction import friction_coefficient
from skinbayes.phrases import number
from skinbayes.reproduce import formulas
from skinbayes.reproduce.choices import BEGUN, SHARPNESS, TRANSITION, UNEQUAL_POISSON_RATIOS
from skinbayes.reproduce.paper import Paper
from skinbayes.reproduce.registry import Found, computes
from skinbayes.reproduce.statements import printed_value
from skinbayes.wetting import young_modulus_at_humidity


@computes("softening")
def _softening(paper: Paper) -> Found:
    dry, wet = young_modulus_at_humidity(
        [0.0, 1.0],
        paper["young-modulus-layer-dry"],
        young_modulus_wet=paper["young-modulus-layer-wet"],
        transition_humidity=TRANSITION,
        sharpness=SHARPNESS,
    )
    return Found(float(dry / wet), "Follows from the moduli that the paper uses for dry and wet skin.")


@computes("modulus-of-indenter")
def _indenter(paper: Paper) -> float:
    contact = layered_sphere_contact(
        paper["ball-load"],
        paper["probe-diameter"] / 2,
        moduli=[paper["young-modulus-layer-wet"], paper["young-modulus-bulk"]],
        poisson_ratios=[paper["poisson-ratio-layer"], paper["poisson-ratio-bulk"]],
        thicknesses=[paper["layer-thickness"]],
    )
    return float(np.squeeze(contact.equivalent_modulus)) * (1 - paper["poisson-ratio-bulk"] ** 2)


@computes("yield-over-modulus")
def _yield(paper: Paper) -> float:
    return paper["yield-stress"] / paper["young-modulus-layer-dry"]


@computes("nominal-pressure")
def _pressure(paper: Paper) -> Found:
    return Found(paper.pressure, "With E*² under the root, as in Appendix B; Sect. 6.1 prints E*.")


@computes("nominal-pressure-rounded")
def _pressure_again(paper: Paper) -> float:
    return paper.pressure


@computes("nominal-pressure-order")
def _pressure_order(paper: Paper) -> Found:
    other = paper.pressure_under(paper["oil-load"])
    return Found(paper.pressure, f"{number(other / 1e3)} kPa in silicone fluids.")


def correction_of_area(paper: Paper, wanted: float) -> float:
    """The Yang–Persson factor γ with which wet skin has a given area."""
    variance = paper.variance(paper.wet)

    def miss(gamma: float) -> float:
        return float(relative_contact_area(paper.pressure, variance, area_correction=gamma)) - wanted

    return float(brentq(miss, 0.2, 1.0))


@computes("wet-area")
def _wet(paper: Paper) -> Found:
    plain = float(persson_contact_area(paper.pressure, paper.variance(paper.wet)))
    printed = printed_value("wet-area")
    return Found(
        paper.wet_area,
        f"With the usual Yang–Persson correction, γ = {AREA_CORRECTION:g}, which the paper does not mention. Its Eqs. 2 "
        f"and 3 alone give {number(plain)}; γ = {number(correction_of_area(paper, printed))} gives the printed number.",
    )


@computes("dry-area")
def _dry(paper: Paper) -> float:
    return paper.dry_area


@computes("dry-area-yielded")
def _yielded(paper: Paper) -> float:
    return paper.pressure / paper["yield-stress"]


@computes("wet-area-order")
def _wet_order(paper: Paper) -> float:
    return paper.wet_area


@computes("dry-area-order")
def _dry_order(paper: Paper) -> float:
    return paper.dry_area


def yielded_fraction(paper: Paper, wavevector: float, gamma: float | None = None) -> float:
    """Fraction of the contact area of dry skin that has yielded, with roughness up to a wavevector in 1/m."""
    given = {} if gamma is None else {"area_correction": gamma}
    area = elastoplastic_contact_area(
        paper.pressure,
        paper.variance(paper.dry, wavevector),
        yield_stress=paper["yield-stress"],
        **given,
    )
    return float(area.plastic / (area.elastic + area.plastic))


def yielding_wavevector(paper: Paper, fraction: float, gamma: float | None = None) -> float:
    """Wavevector, 1/m, at which a fraction of the contact area has yielded."""

    def miss(log_q: float) -> float:
        return yielded_fraction(paper, float(np.exp(log_q)), gamma) - fraction

    return float(np.exp(brentq(miss, np.log(2e4), np.log(1e6), xtol=1e-6)))


@computes("plastic-onset")
def _onset(paper: Paper) -> Found:
    plain = (number(yielding_wavevector(paper, share, 1.0)) for share in (BEGUN, 0.5, 0.99))
    return Found(
        yielding_wavevector(paper, BEGUN),
        f"Without the correction a tenth, half and 99 % have yielded at {', '.join(plain)} 1/m.",
    )


@computes("wavelength-of-onset")
def _wavelength(paper: Paper) -> float:
    printed = printed_value("plastic-onset")
    return 2 * np.pi / printed


@computes("shear-stress-dry")
def _shear_dry(paper: Paper) -> Found:
    return Found(
        paper["friction-measured-dry"] * paper.pressure / paper.dry_area,
        "Where all contacts have yielded this is μ σ_Y; neither surface nor modulus enters.",
    )


@computes("shear-stress-wet")
def _shear_wet(paper: Paper) -> float:
    return paper["friction-measured-wet"] * paper.pressure / paper.wet_area


@computes("friction-dry")
def _friction_dry(paper: Paper) -> float:
    return _friction(paper, paper.dry_area)


@computes("friction-wet")
def _friction_wet(paper: Paper) -> float:
    return _friction(paper, paper.wet_area)


def _friction(paper: Paper, area: float) -> float:
    found = friction_coefficient(paper["shear-stress-used"], area, nominal_pressure=paper.pressure)
    return float(found)


@computes("contact-stress-dry")
def _stress(paper: Paper) -> float:
    return paper.pressure / paper.dry_area


def wet_area_at(paper: Paper, pressure: float) -> float:
    """A/A0 of wet skin at another pressure, Pa."""
    return float(relative_contact_area(pressure, paper.variance(paper.wet)))


@computes("tyre-area")
def _tyre(paper: Paper) -> float:
    return wet_area_at(paper, paper["tyre-pressure"])


@computes("tyre-over-skin")
def _tyre_over_skin(paper: Paper) -> float:
    return wet_area_at(paper, paper["tyre-pressure"]) / wet_area_at(paper, paper["skin-pressure"])


@computes("eq-2")
def _eq2(paper: Paper) -> Found:
    area = persson_contact_area(paper.pressure, paper.variance(paper.wet))
    gradient = formulas.gradient(paper.surface, paper.wet, paper.pressure)
    return Found(
        float(area),
        "The equations as printed do not give the area printed for wet skin.",
        formulas.area(gradient),
    )


@computes("eq-3")
def _eq3(paper: Paper) -> Found:
    found = twice_stress_variance(paper.surface, paper.wet) / (4 * paper.pressure**2)
    return Found(float(found), formula=formulas.gradient(paper.surface, paper.wet, paper.pressure))


@computes("eq-4")
def _eq4(paper: Paper) -> Found:
    return _response(paper.wet)


@computes("eq-4-unequal")
def _eq4_unequal(paper: Paper) -> Found:
    layer, bulk = UNEQUAL_POISSON_RATIOS
    return _response(replace(paper.wet, poisson_ratio_layer=layer, poisson_ratio_bulk=bulk))


def _response(skin: LayeredSkin) -> Found:
    wavevector = 1 / float(skin.layer_thickness)
    return Found(float(surface_response(skin, wavevector)), formula=formulas.response(wavevector, skin))
