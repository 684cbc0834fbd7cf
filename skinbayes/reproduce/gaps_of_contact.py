"""Misprints and gaps of Sects. 3, 4 and 6.1: surface, contact area, Hertz."""

from __future__ import annotations

from dataclasses import replace

from skinbayes.contact import (
    AREA_CORRECTION,
    mean_separation,
    persson_contact_area,
    relative_contact_area,
    total_contact_area,
    twice_stress_variance,
)
from skinbayes.friction import friction_coefficient
from skinbayes.phrases import number
from skinbayes.reproduce import formulas
from skinbayes.reproduce.contact import correction_of_area
from skinbayes.reproduce.demonstration import Demonstration
from skinbayes.reproduce.paper import Paper
from skinbayes.reproduce.shown import printed_text
from skinbayes.reproduce.statements import printed_value, statements
from skinbayes.reproduce.surface import (
    height_of_slope,
    rolloff_of_slope,
    smallest_wavevector_of_slope,
    with_other,
)
from skinbayes.roughness import SelfAffineSpectrum, rms_slope, total_area_ratio


def square(paper: Paper) -> Demonstration:
    """The square that the mean pressure lacks."""
    case = paper["ball-load"], paper.tissue_modulus, paper["ball-radius"]
    stiffer = case[0], 2 * case[1], case[2]
    forms = {
        "as printed, E*": formulas.sphere_pressure,
        "E*², as in Appendix B": formulas.sphere_pressure_of_appendix,
    }
    return Demonstration(
        id="missing-square",
        title="The mean Hertz pressure of the sphere lacks a square",
        where="Sect. 6.1, above Eq. 9",
        text="Under the root E* has to be squared, as it is in Appendix B. Then ball, load and tissue give the pressure that the "
        "paper uses everywhere; as printed the result has not the unit of a pressure and rises with the wrong power of E*.",
        headers=("formula", "0.5 N, 8 mm, E1 = 20 kPa", "with twice the modulus"),
        rows=[
            *(
                (name, f"{number(form(*case), 4)} {unit}", f"{number(form(*stiffer) / form(*case))} times")
                for (name, form), unit in zip(forms.items(), ("in SI numbers", "Pa"), strict=True)
            ),
            ("printed in Sect. 4", f"{number(printed_value('nominal-pressure'), 4)} Pa", ""),
        ],
    )


def surface(paper: Paper) -> Demonstration:
    """Four parameters and the slope beside them."""
    rolloff, height, smallest = (
        rolloff_of_slope(paper),
        height_of_slope(paper),
        smallest_wavevector_of_slope(paper),
    )
    surfaces = {
        "the four printed parameters": paper.printed_surface,
        f"plateau up to q_r = {number(rolloff, 4)} 1/m": with_other(paper, wavevector_rolloff=rolloff),
        f"no plateau, h_rms = {number(1e6 * height)} µm": with_other(paper, rms_height=height),
        f"no plateau, q0 = {number(smallest)} 1/m": with_other(
            paper, wavevector_min=smallest, wavevector_rolloff=smallest
        ),
    }
    return Demonstration(
        id="four-parameters",
        title="The four roughness parameters do not belong to the slope and the area beside them",
        where="Sect. 3; Fig. 4",
        text="Slope 2.8 and area 2.7 A0 agree with each other and not with the four parameters; heights at large "
        "wavevectors have to be √10 larger. Three repairs do that, and give the same slope, contact and separation. Which "
        "of them the authors had cannot be told from these; skinbayes uses the plateau, which leaves h_rms as printed.",
        headers=("surface", "rms slope", "A_tot/A0", "10⁴ A/A0, wet", "ū(p0)"),
        rows=[
            *((name, *_numbers(surface, paper)) for name, surface in surfaces.items()),
            (
                "printed",
                number(printed_value("rms-slope-in-use")),
                number(printed_value("total-area-in-use")),
                number(1e4 * printed_value("wet-area")),
                printed_text(statements()["separation-without"].words),
            ),
        ],
    )


def _numbers(surface: SelfAffineSpectrum, paper: Paper) -> tuple[str, ...]:
    slope = float(rms_slope(surface))
    area = relative_contact_area(paper.pressure, twice_stress_variance(surface, paper.wet))
    separation = float(mean_separation(paper.pressure, surface, skin=paper.wet))
    return (
        number(slope),
        number(float(total_area_ratio(slope))),
        number(1e4 * float(area)),
        f"{number(1e6 * separation)} µm",
    )


def wet_area(paper: Paper) -> Demonstration:
    """The wet area by the equations and by others."""
    printed, variance = printed_value("wet-area"), paper.variance(paper.wet)
    gamma = correction_of_area(paper, printed)

    def plain(surface: SelfAffineSpectrum, modulus_factor: float = 1.0) -> float:
        skin = paper.skin(paper["young-modulus-layer-wet"] * modulus_factor)
        return float(persson_contact_area(paper.pressure, twice_stress_variance(surface, skin)))

    areas = {
        "Eqs. 2 and 3, Eq. 4": float(persson_contact_area(paper.pressure, variance)),
        "the same with E0 in place of E0*": plain(paper.surface, 1 - paper["poisson-ratio-layer"] ** 2),
        "the same on the four printed parameters": plain(paper.printed_surface),
        f"corrected, γ = {AREA_CORRECTION:g}": paper.wet_area,
        f"corrected, γ = {number(gamma)}": float(
            relative_contact_area(paper.pressure, variance, area_correction=gamma)
        ),
    }
    return Demonstration(
        id="wet-area",
        title="The wet contact area is not that of Eqs. 2 and 3",
        where="Sect. 4; Fig. 6",
        text="The equations as printed give two thirds of the printed area. The Yang–Persson correction, which the "
        "paper does not mention, gives it at a usual γ. Neither E0 for E0* nor the four printed parameters do.",
        headers=("theory", "10⁴ A/A0 at 6.83 kPa", "over printed"),
        rows=[
            *((name, number(1e4 * area), number(area / printed)) for name, area in areas.items()),
            ("printed", number(1e4 * printed), "1"),
        ],
    )


def dry_friction(paper: Paper) -> Demonstration:
    """Friction where everything yields."""
    rough = replace(paper.surface, rms_height=2 * float(paper.surface.rms_height))
    cases = {
        "as in the paper": (paper.surface, 1.0, paper["yield-stress"]),
        "heights doubled": (rough, 1.0, paper["yield-stress"]),
        "layer three times as stiff": (paper.surface, 3.0, paper["yield-stress"]),
        "yield stress doubled": (paper.surface, 1.0, 2 * paper["yield-stress"]),
    }
    return Demonstration(
        id="dry-friction",
        title="That one shear stress explains dry and wet friction is weaker evidence than it seems",
        where="Sect. 4; abstract",
        text="Where all contacts have yielded friction is σ_f/σ_Y, whatever surface and modulus are. Dry friction of 0.3 says "
        "that the shear stress is 0.3 of the yield stress, and 15 MPa follow from 50 MPa.",
        headers=("skin", "μ dry", "μ wet"),
        rows=tuple(
            (name, *(number(friction) for friction in _frictions(paper, *case)))
            for name, case in cases.items()
        ),
    )


def _frictions(
    paper: Paper, surface: SelfAffineSpectrum, stiffer: float, yield_stress: float
) -> tuple[float, float]:
    dry, wet = (
        twice_stress_variance(surface, paper.skin(paper[f"young-modulus-layer-{state}"] * stiffer))
        for state in ("dry", "wet")
    )
    areas = (
        total_contact_area(paper.pressure, dry, yield_stress=yield_stress),
        relative_contact_area(paper.pressure, wet),
    )
    first, second = (
        float(friction_coefficient(paper["shear-stress-used"], area, nominal_pressure=paper.pressure))
        for area in areas
    )
    return first, second
