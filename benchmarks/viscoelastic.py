"""Where loss in the skin moves the Stribeck curve of Fig. 13, and where stiffness does.

Run with ``python benchmarks/viscoelastic.py [--nodes N] [--cells N] [--json]``. A ball of 8 mm under 0.2 N slides on the wet skin
of the paper; its tissue, its layer or both get loss, their elastic modulus at v/b, relaxed or instantaneous held at that of the
elastic skin. Of each curve, speed held and viscosity varied, three numbers are printed, all as ηv over that of elastic skin:
where friction is half of its plateau, where it is smallest, and where the rising branch reaches the friction that elastic skin
has at 0.1 N/m. A number above 1 is a curve that lies at higher speeds. Hysteresis is left out of the friction, since it hardly
depends on ηv, and printed beside it. These curves are those of the cylinder of Eq. 9. A second table sets the ball in two
dimensions beside it, each over elastic skin with the modulus of the tissue at its own frequency, v/a and v/b, and says by how
much the friction of the ball is missed if that of the elastic ball is multiplied by the ratio of the cylinders, from 1e-5 to 1
N/m, at the same v or at the same frequency, v/b of the cylinder being v/a of the ball. Loss is chosen so that pressing in a ball
5 mm deep at 2.5 mm/s and drawing it back costs a quarter of the work, as quoted in the paper, or 60 % for strong loss.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.optimize import brentq

from skinbayes.contact import (
    ViscoelasticMaterial,
    ViscoelasticSkin,
    constant_loss_solid,
    indentation_cycle,
    sphere_contact,
    standard_linear_solid,
)
from skinbayes.lubrication import CELLS, LINE, NODES, POINT, viscoelastic_stribeck_curve
from skinbayes.roughness import named_surface

PRODUCTS = np.geomspace(2e-5, 0.3, 31)  # N/m
WIDE = np.geomspace(1e-5, 1.0, 36)  # N/m
SPEED = 0.01  # m/s
BULK, LAYER, THICKNESS = 20e3, 7e6, 20e-6
RATE, DEPTH, RADIUS, FORCE = 2.5e-3, 5e-3, 8e-3, 0.2
SHEAR_STRESS = 15e6 * 6.59 / 6.48133  # A/A0 of the paper at 6.83 kPa
HALF_WIDTH = 2.178e-3  # m, of the elastic contact

Maker = Callable[[float, float], ViscoelasticMaterial]
"""Material of a modulus scale, Pa, and an amount of loss."""


class Features(NamedTuple):
    """ηv, N/m, at half of the plateau, at the minimum and on the rising branch; friction at the minimum, that of the tissue."""

    half: float
    minimum: float
    rising: float
    least: float
    hysteresis: float


def elastic(modulus: float) -> ViscoelasticMaterial:
    """Material without loss."""
    return ViscoelasticMaterial(equilibrium_modulus=modulus)


PLAIN = ViscoelasticSkin(bulk=elastic(BULK), layer=elastic(LAYER), layer_thickness=THICKNESS)


def curve(
    skin: ViscoelasticSkin,
    speed: float,
    size: dict[str, int],
    contact: str = LINE,
    products: np.ndarray = PRODUCTS,
) -> tuple[np.ndarray, float]:
    """Friction without hysteresis at the products, and hysteresis at the minimum."""
    found = viscoelastic_stribeck_curve(
        speed,
        products / speed,
        normal_force=FORCE,
        sphere_radius=RADIUS,
        spectrum=named_surface("paper_reference"),
        skin=skin,
        contact=contact,
        frictional_shear_stress=SHEAR_STRESS,
        **size,
    )
    friction = found.friction_coefficient - found.hysteresis
    return friction, float(found.hysteresis[np.nanargmin(friction)])


def features(
    friction: np.ndarray, hysteresis: float, level: float | None = None, products: np.ndarray = PRODUCTS
) -> Features:
    """Features of a curve; the rising branch at friction ``level``, of itself at 0.1 N/m if not given."""
    place = np.log(products)
    fine = np.linspace(place[0], place[-1], 40001)
    smooth = CubicSpline(place, np.log(friction))(fine)
    low = int(np.argmin(smooth))
    below = smooth < np.log(friction[0] / 2)
    half = fine[np.argmax(below)] if below.any() else np.nan
    if level is None:
        level = float(np.exp(np.interp(np.log(0.1), fine, smooth)))
    rising = np.interp(np.log(level), smooth[low:], fine[low:])
    return Features(*(float(np.exp(x)) for x in (half, fine[low], rising, smooth[low])), hysteresis)


def calibrated(maker: Maker, loss: float) -> float:
    """Amount of loss at which an indentation costs this fraction of its work."""

    def miss(amount: float) -> float:
        cycle = indentation_cycle(RATE, DEPTH, sphere_radius=RADIUS, material=maker(BULK, amount))
        return cycle.loss_fraction - loss

    return float(brentq(miss, 0.02, 40.0, xtol=1e-6))


def zener(time: float) -> Maker:
    """One relaxation time, s; E_g = E∞ (1 + amount)."""
    return lambda modulus, amount: standard_linear_solid(
        modulus, modulus * (1 + amount), relaxation_time=time
    )


def prony(modulus: float, amount: float) -> ViscoelasticMaterial:
    """Three relaxation times with equal moduli."""
    return ViscoelasticMaterial(
        equilibrium_modulus=modulus,
        relaxing_moduli=[modulus * amount / 3] * 3,
        relaxation_times=[0.1, 0.7, 5.0],
    )


def power_law(modulus: float, amount: float) -> ViscoelasticMaterial:
    """Constant loss angle, tan δ = amount/10, elastic at 1 Pa per Pa of the modulus where ω = 1/s."""
    return constant_loss_solid(
        modulus, amount / 10, angular_frequency=1.0, lowest_frequency=1e-3, highest_frequency=1e5
    )


def normalised(maker: Maker, amount: float, modulus: float, frequency: float) -> ViscoelasticMaterial:
    """Material with |E| = ``modulus`` at a frequency, 1/s."""
    return maker(modulus * modulus / float(abs(maker(modulus, amount).complex_modulus(frequency))), amount)


def cases() -> dict[str, tuple[ViscoelasticSkin, float]]:
    """Skin and speed, m/s, by what is said of them."""

    def skin(bulk: ViscoelasticMaterial, layer: ViscoelasticMaterial | None = None) -> ViscoelasticSkin:
        return ViscoelasticSkin(bulk=bulk, layer=layer or elastic(LAYER), layer_thickness=THICKNESS)

    found = {}
    contact = SPEED / HALF_WIDTH
    models = {"one time": zener(0.7), "three times": prony, "power law": power_law}
    for loss in (0.25, 0.6):
        for name, maker in models.items():
            try:
                amount = calibrated(maker, loss)
            except ValueError:
                continue  # one relaxation time cannot lose so much
            for where, frequency in (("at v/b", contact), ("relaxed", 1e-3), ("instantaneous", 1e4)):
                tissue = normalised(maker, amount, BULK, frequency)
                found[f"tissue, {name}, {loss:.0%}, {where}"] = skin(tissue), SPEED
            both = (normalised(maker, amount, scale, contact) for scale in (BULK, LAYER))
            found[f"both, {name}, {loss:.0%}, at v/b"] = skin(*both), SPEED
            layer = normalised(maker, amount, LAYER, 1e-3)
            found[f"layer, {name}, {loss:.0%}, relaxed"] = skin(elastic(BULK), layer), SPEED
    amount = calibrated(zener(0.7), 0.25)
    for deborah in (0.1, 0.5, 1.0, 2.0, 10.0):
        speed = deborah * HALF_WIDTH / 0.7
        tissue = normalised(zener(0.7), amount, BULK, speed / HALF_WIDTH)
        found[f"tissue, one time, 25%, at v/b, vτ/b = {deborah:g}"] = skin(tissue), speed
    for ratio in (3.0, 10.0):
        tissue = normalised(zener(0.7), ratio - 1, BULK, 1 / 0.7)
        found[f"tissue, one time, E_g/E∞ = {ratio:g}, at v/b, vτ/b = 1"] = skin(tissue), HALF_WIDTH / 0.7
    found["elastic, tissue and layer a sixth as stiff"] = skin(elastic(BULK / 6), elastic(LAYER / 6)), SPEED
    return found


BOTH = (
    "tissue, one time, 25%, at v/b", "tissue, three times, 25%, at v/b", "tissue, power law, 25%, at v/b",
    "tissue, one time, 25%, relaxed", "tissue, power law, 25%, relaxed", "tissue, power law, 25%, instantaneous",
    *(f"tissue, one time, 25%, at v/b, vτ/b = {deborah:g}" for deborah in (0.1, 0.5, 1.0, 2.0, 10.0)),
    "tissue, one time, 60%, at v/b", "tissue, power law, 60%, at v/b",
    "tissue, one time, E_g/E∞ = 10, at v/b, vτ/b = 1",
)  # fmt: skip
"""Cases in which the ball is set beside the cylinder."""


class Both(NamedTuple):
    """Cylinder and ball: features over elastic skin, hysteresis, and the worst friction ratio of the approximations less 1."""

    line: tuple[float, ...]
    point: tuple[float, ...]
    same_speed: float
    same_frequency: float


def strain(skin: ViscoelasticSkin, speed: float, contact: str) -> float:
    """b/Rc with the modulus at the frequency of the contact, which goes as E*^(−1/3)."""
    return float(
        viscoelastic_stribeck_curve(
            speed, 0.01 / speed, normal_force=FORCE, sphere_radius=RADIUS, spectrum=named_surface("paper_reference"),
            skin=skin, contact=contact, frictional_shear_stress=0.0,
        ).strain
    )  # fmt: skip


def both(skin: ViscoelasticSkin, speed: float, size: dict[str, int]) -> Both:
    """One case; each contact over elastic skin with the modulus of the tissue at its own frequency."""
    narrower = HALF_WIDTH / float(sphere_contact(FORCE, RADIUS, reduced_modulus=BULK / 0.75).contact_radius)
    pairs = []
    for contact, v in ((LINE, speed), (POINT, speed), (LINE, speed * narrower)):
        held = BULK * (strain(PLAIN, v, contact) / strain(skin, v, contact)) ** 3
        plain = ViscoelasticSkin(bulk=elastic(held), layer=elastic(LAYER), layer_thickness=THICKNESS)
        pairs.append([curve(which, v, size, contact, WIDE) for which in (plain, skin)])
    known = np.isfinite([friction for pair in pairs for friction, _ in pair]).all(axis=0)
    products, shifts, ratios = WIDE[known], [], []  # films of soft tissue end before 1 N/m
    for pair in pairs:
        (plain_friction, plain_loss), (friction, loss) = ((one[0][known], one[1]) for one in pair)
        level = float(np.exp(np.interp(np.log(0.1), np.log(products), np.log(plain_friction))))
        reference = features(plain_friction, plain_loss, level, products)
        found = features(friction, loss, level, products)
        shifts.append(
            (
                *(a / b for a, b in zip(found[:3], reference[:3], strict=True)),
                found.least / reference.least,
                found.hysteresis,
            )
        )
        ratios.append(np.log(friction / plain_friction))
    worst = (float(np.expm1(np.abs(ratios[line] - ratios[1]).max())) for line in (0, 2))
    return Both(*shifts[:2], *worst)


def main() -> None:
    """Print the table."""
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--nodes", type=int, default=NODES)
    arguments.add_argument("--cells", type=int, default=CELLS)
    arguments.add_argument("--json", action="store_true")
    given = arguments.parse_args()
    size = {"nodes": given.nodes, "cells": given.cells}
    reference = features(*curve(PLAIN, SPEED, size))
    level = float(np.exp(np.interp(np.log(0.1), np.log(PRODUCTS), np.log(curve(PLAIN, SPEED, size)[0]))))
    rows = {"elastic": reference}
    given_cases = cases()
    for name, (skin, speed) in given_cases.items():
        rows[name] = features(*curve(skin, speed, size), level=level)
    beside = {name: both(*given_cases[name], size) for name in BOTH if name in given_cases}
    if given.json:
        print(json.dumps({name: row._asdict() for name, row in (rows | beside).items()}, indent=1))
        return
    print(f"{'':58s} half  minimum rising | friction at the minimum, hysteresis")
    for name, row in rows.items():
        half, minimum, rising = (a / b for a, b in zip(row[:3], reference[:3], strict=True))
        print(f"{name:58s} {half:5.2f} {minimum:7.2f} {rising:7.2f} | {row.least:.3f} {row.hysteresis:.3f}")
    print(
        f"\n{'cylinder, then ball':58s} half  minimum rising   least  hysteresis | missed by the cylinders, at v/a = v/b"
    )
    for name, two in beside.items():
        for one in (two.line, two.point):
            said = "  ".join(f"{value:.3f}" for value in one)
            end = f" | {two.same_speed:.1%} {two.same_frequency:.1%}" if one is two.point else ""
            print(f"{name if one is two.line else '':58s} {said}{end}")


if __name__ == "__main__":
    main()
