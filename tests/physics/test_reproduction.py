"""The table of the paper: complete, judged by rules that can fail, and right where something independent says so."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from reproduction_page import BLOCK, PAGE, blocks, filled
from scipy.integrate import quad
from scipy.special import erf

from skinbayes.reproduce import (
    COMPUTED,
    RULES,
    Compared,
    Found,
    Paper,
    compared,
    demonstrations,
    judged,
    reproduction,
    statements,
)
from skinbayes.reproduce.printed import read_printed
from skinbayes.reproduce.statements import COMPARED

WANTED = {name: found for name, found in statements().items() if found.role in COMPARED}


@pytest.fixture(scope="module")
def paper() -> Paper:
    return Paper()


@pytest.fixture(scope="module")
def rows(paper: Paper) -> dict[str, Compared]:
    return {row.statement.id: row for row in reproduction(paper)}


def test_every_statement_has_a_function_and_every_function_a_statement() -> None:
    assert set(COMPUTED) == set(WANTED)
    assert len(WANTED) >= 80


def test_everything_is_computed_and_judged(rows: dict[str, Compared]) -> None:
    assert set(rows) == set(WANTED)
    for row in rows.values():
        assert math.isfinite(row.computed), row.statement.id
        assert (row.formula is not None) == (row.statement.role == "equation"), row.statement.id
        assert row.statement.reading in RULES, row.statement.id


def test_what_does_not_agree_is_known_and_explained(rows: dict[str, Compared]) -> None:
    missed = {name for name, row in rows.items() if not row.agrees}
    assert missed == {
        "rms-slope-of-four-numbers", "total-area-of-four-numbers", "wet-area", "capillary-pressure-red", "droplet-film",
        "contact-width", "vapour-pressure-air", "latent-heat", "time-of-bridges", "sphere-pressure", "sphere-like-cylinder",
        "skin-like-cylinder", "indentation-set", "loss-shifts-down", "loss-widens-hydrodynamic", "soft-in-dry-air",
        "stiff-is-load", "bridges-below-90", "flow-factors-matter-little",
    }  # fmt: skip
    assert all(rows[name].note for name in missed)


def test_the_page_has_the_numbers_that_are_computed(rows: dict[str, Compared], paper: Paper) -> None:
    text = PAGE.read_text(encoding="utf-8")
    now = blocks(list(rows.values()), demonstrations(paper))
    assert {match[2] for match in BLOCK.finditer(text)} == set(now)
    assert filled(text, now) == text


@pytest.mark.parametrize("name", WANTED)
def test_a_wrong_value_is_flagged(name: str) -> None:
    stated = WANTED[name]
    assert not judged(stated, Found(math.nan, formula=1.0 if stated.role == "equation" else None)).agrees
    if stated.role == "equation":
        assert not judged(stated, Found(1.002, formula=1.0)).agrees
        assert judged(stated, Found(1.0005, formula=1.0)).agrees
    elif stated.printed is not None:
        low, high = stated.printed.low, stated.printed.high
        assert not judged(stated, Found(4.0 * high)).agrees
        assert not judged(stated, Found(-high)).agrees
        assert judged(stated, Found((low + high) / 2)).agrees
    else:
        verdicts = {judged(stated, Found(value)).agrees for value in (-2.0, 0.0, 0.5, 1.0, 2.0, 5.0)}
        assert verdicts == {True, False}


RULED = (
    ("6.83 kPa", "Pa", (6.826e3, 6.834e3), (6.824e3, 6.836e3)),
    ("≈ 14 um", "m", (13.1e-6, 14.9e-6), (12.9e-6, 15.1e-6)),
    ("about 500 s", "s", (401, 599), (399, 601)),
    ("≈ 1e5 1/m", "1/m", (0.51e5, 1.49e5), (0.49e5, 1.51e5)),
    ("≈ -0.04", "1", (-0.049, -0.031), (-0.051, -0.029)),
    ("∼ 14 um", "m", (13.1e-6, 14.9e-6), (12.9e-6, 15.1e-6)),
    ("∼ 30", "1", (10, 94), (9, 95)),
    ("of order 100 s", "s", (32, 316), (31, 317)),
    ("≈ 6–9 um", "m", (5.6e-6, 9.4e-6), (5.4e-6, 9.6e-6)),
    ("a few %", "1", (0.016, 0.094), (0.014, 0.096)),
    ("a few nm or less", "m", (1e-12, 9.4e-9), (-1e-9, 9.6e-9)),
    ("> 14 um", "m", (13.6e-6, 14.4e-6), (13.4e-6, 14.6e-6)),
)


@pytest.mark.parametrize(("text", "unit", "inside", "outside"), RULED)
def test_what_printing_allows(
    text: str, unit: str, inside: tuple[float, float], outside: tuple[float, float]
) -> None:
    printed = read_printed(text, unit, where="here")
    agrees = RULES[printed.reading].agrees
    assert all(agrees(value, printed) for value in inside)
    assert not any(agrees(value, printed) for value in outside)


WORDS = {
    "complete": (0.995, 0.98), "nearly complete": (0.81, 0.79), "negligible": (-0.09, -0.11), "small": (0.09, 0.11),
    "much larger": (3.1, 2.9), "much smaller": (0.3, 0.35), "grows": (1.02, 1.005), "falls": (0.98, 0.995),
    "proportional": (0.91, 0.89), "positive": (0.01, -0.01), "formula": (5e-4, 2e-3),
}  # fmt: skip


@pytest.mark.parametrize("word", WORDS)
def test_what_words_allow(word: str) -> None:
    inside, outside = WORDS[word]
    assert RULES[word].agrees(inside, None) and not RULES[word].agrees(outside, None)


def test_similar_is_the_same_up_and_down() -> None:
    assert all(RULES["similar"].agrees(ratio, None) for ratio in (0.81, 1.24))
    assert not any(RULES["similar"].agrees(ratio, None) for ratio in (0.79, 1.26, -1.0))


def test_a_wrong_input_is_seen(paper: Paper) -> None:
    soft = paper.with_values(yield_stress=25e6)
    assert not compared(WANTED["dry-area"], soft).agrees
    stiff = paper.with_values(young_modulus_bulk=40e3)
    assert not compared(WANTED["nominal-pressure"], stiff).agrees
    assert not compared(
        WANTED["cosines-polypropylene"], paper.with_values(angle_polypropylene=math.radians(110))
    ).agrees


def test_inputs_are_those_of_the_table_of_reported_values() -> None:
    from skinbayes.files import load_reference

    reported = {
        str(row["quantity"]): float(row["value"])
        for row in load_reference("persson2013-reported-values").rows
    }
    pairs = {
        "young-modulus-bulk": "bulk elastic modulus",
        "layer-thickness": "stratum corneum thickness",
        "young-modulus-layer-wet": "stratum corneum modulus wet",
        "young-modulus-layer-dry": "stratum corneum modulus dry",
        "yield-stress": "yield stress / hardness",
        "hurst-exponent": "Hurst exponent",
        "rms-height": "rms roughness",
        "rms-slope-in-use": "rms slope",
        "total-area-in-use": "total over nominal area",
        "wavevector-min": "smallest wavevector",
        "wavevector-max": "largest wavevector",
        "nominal-pressure": "nominal pressure",
        "plastic-onset": "plastic onset wavevector",
        "wet-area": "relative contact area wet highest magnification",
        "dry-area": "relative contact area dry highest magnification",
        "ball-radius": "glass ball radius",
        "ball-load": "normal load Fig 7",
        "droplet-volume": "water droplet volume",
        "stroke-length": "stroke length",
        "contact-width": "contact width",
        "droplet-film": "average film thickness",
        "flooding-film": "flooding film thickness",
        "capillary-pressure": "capillary pressure at max area",
        "evaporation-rate": "evaporation rate",
        "time-of-bridges": "evaporation time for 14 um",
        "oil-load": "Stribeck load Fig 12/13",
        "oil-viscosity-most": "Stribeck viscosity max",
        "fig11-modulus": "Fig 11 effective modulus",
        "slope-cylinder": "hydrodynamic slope cylinder",
        "critical-shear-rate": "onset shear rate at eta0=1 Pa s",
    }
    for name, quantity in pairs.items():
        printed = statements()[name].printed
        assert printed is not None and printed.low == pytest.approx(reported[quantity], rel=1e-12), name


def test_plain_contact_area_by_quadrature(rows: dict[str, Compared]) -> None:
    # spectrum and response written down here, in the variables of the paper
    height, hurst, low, knee, high, thick = 22.4e-6, 0.78, 1e3, 6.345e3, 1e9, 20e-6
    spread = 0.5 * (knee**2 - low**2) + knee**2 / (2 * hurst) * (1 - (high / knee) ** (-2 * hurst))
    plateau = height**2 / (2 * math.pi * spread)
    ratio = 7e6 / 20e3
    m, n = (ratio - 1) / (ratio + 1), 1 - 2 / (1 + ratio)

    def integrand(log_q: float) -> float:
        q = math.exp(log_q)
        e, x = math.exp(-2 * q * thick), q * thick
        response = (1 + 4 * m * x * e - m * n * e * e) / (1 - (m + n + 4 * m * x * x) * e + m * n * e * e)
        power = plateau * min(1.0, (q / knee) ** (-2 * (1 + hurst)))
        return q**4 * power * (7e6 / 0.75 / response) ** 2

    edges = [math.log(edge) for edge in (low, knee, 3e4, 3e5, 1e7, high)]
    parts = [quad(integrand, a, b, epsrel=1e-10)[0] for a, b in pairwise(edges)]
    pressure = 2 / (3 * math.pi) * (6 * 0.5 * (20e3 / 0.75) ** 2 / 8e-3**2) ** (1 / 3)
    area = erf(pressure / math.sqrt(math.pi * sum(parts)))
    assert rows["nominal-pressure"].computed == pytest.approx(pressure, rel=1e-9)
    assert rows["eq-2"].computed == pytest.approx(area, rel=2e-4)


def test_what_the_authors_must_have_used_gives_their_outputs(paper: Paper) -> None:
    from skinbayes.contact import mean_separation, relative_contact_area, twice_stress_variance
    from skinbayes.reproduce.gap_of_surface import used
    from skinbayes.roughness import SelfAffineSpectrum, rms_slope

    height, cut_off, gamma = used(paper, 13e-6)
    surface = SelfAffineSpectrum(
        rms_height=height,
        hurst_exponent=0.78,
        wavevector_min=1e3,
        wavevector_rolloff=1e3,
        wavevector_max=cut_off,
    )
    assert rms_slope(surface) == pytest.approx(2.8, rel=1e-6)
    assert mean_separation(paper.pressure, surface, skin=paper.wet, area_correction=gamma) == pytest.approx(
        13e-6, rel=1e-6
    )
    variance = twice_stress_variance(surface, paper.wet)
    assert relative_contact_area(paper.pressure, variance, area_correction=gamma) == pytest.approx(
        6.59e-4, rel=1e-6
    )
    assert height == pytest.approx(math.sqrt(10) * 22.4e-6, rel=0.05) and cut_off == pytest.approx(
        1e9, rel=0.2
    )
    assert 0.39 < gamma < 0.43


def test_droplet_and_evaporation_by_hand(rows: dict[str, Compared]) -> None:
    assert rows["droplet-film"].computed == pytest.approx(50e-9 / (0.08 * 0.008), rel=1e-12)
    assert rows["eq-8"].computed == pytest.approx((5600 - 1150) * 8.9e-5 / 2272e3, rel=1e-9)
    # vapour pressure after Buck (1981), good to 0.1 % here
    buck = 611.21 * math.exp((18.678 - 35 / 234.5) * 35 / (257.14 + 35))
    assert rows["vapour-pressure-skin"].computed == pytest.approx(buck, rel=2e-3)
    assert rows["time-of-bridges"].computed == pytest.approx(
        14e-6 / rows["evaporation-rate"].computed, rel=1e-12
    )


def test_ball_and_cylinder_by_hand(rows: dict[str, Compared]) -> None:
    stiff, load, radius = 20e3 / 0.75, 0.5, 8e-3
    contact = (3 * load * radius / (4 * stiff)) ** (1 / 3)
    mean = load / (math.pi * contact**2)
    half = contact * math.sqrt(1.5) / 2  # r0 = 2b √(2/3)
    # p = f/2b, b² = 4 f Rc/(π E*)
    force, cylinder = 2 * half * mean, half * math.pi * stiff / (8 * mean)
    assert rows["contact-width"].computed == pytest.approx(2 * contact, rel=1e-9)
    assert rows["radius-constant"].computed == pytest.approx(cylinder / radius, rel=1e-9)
    assert rows["load-constant"].computed == pytest.approx(
        force / (stiff * load**2 / radius) ** (1 / 3), rel=1e-9
    )


def test_thinning_and_angles_by_hand(rows: dict[str, Compared]) -> None:
    assert rows["critical-shear-rate"].computed == pytest.approx(1e4**1.25, rel=1e-9)
    assert rows["cosines-polypropylene"].computed == pytest.approx(
        np.cos(np.radians([80, 102])).sum(), rel=1e-12
    )
    assert rows["total-area-in-use"].computed == pytest.approx(
        quad(lambda t: math.sqrt(1 + 2.8**2 * t) * math.exp(-t), 0, math.inf)[0], rel=1e-7
    )
