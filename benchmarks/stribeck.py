"""Stribeck curve of 30 points: skinbayes against scipy.optimize.root on the same equations.

Run with ``python benchmarks/stribeck.py [--json] [--plain-nodes N] [--contact line]``. The plain side takes evenly spaced
nodes, central differences and constant pressures about the nodes, writes "either fluid pressure or mass loss is zero" as
Fischer and Burmeister do, and leaves the rest to scipy.optimize.root (Levenberg–Marquardt, Jacobian by differences; hybr does
not converge here), speed after speed, each started from the one before. Both sides use the same table of asperity pressures,
and the time to make it counts for both. Errors are the largest of the friction coefficient over the curve, against skinbayes on
ten times as many nodes; the points at which the plain side found no film are left out of its error and counted. At its default
of 120 nodes it is several times less accurate than skinbayes on 64: the ratio of times at the same error is larger than what is
printed.

Then a table of films, of the ball or of its cylinder, is built for bulk modulus, roughness and force (`build_film_table`), and
the same curve is taken from it for many parameter vectors at once: seconds a curve against those of the direct solver in the
same run, and the largest difference between both. Last come the 165 measured points of the finger data, each with the viscosity
of its liquid at the shear rate of its own film: from the table, a vector of parameters, and row by row from the direct solver
with that viscosity given, which leaves the search for it aside.
"""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Callable

import numpy as np
from scipy.optimize import root

from skinbayes.contact import LayeredSkin, reduced_modulus
from skinbayes.contact.line_contact import cylinder_of_sphere, line_contact
from skinbayes.files import load_dataset
from skinbayes.lubrication import (
    FILM_PARAMETERS,
    FilmTable,
    FilmTablePlan,
    FlowCurve,
    LubricatedBalls,
    build_film_table,
    liquid_rows,
    stribeck_curve,
    tabulated_friction,
    tabulated_friction_of_liquids,
)
from skinbayes.lubrication.asperities import asperity_law
from skinbayes.lubrication.film import lubricated_films
from skinbayes.roughness import PowerSpectrum, SelfAffineSpectrum, named_surface

POINTS = np.geomspace(1e-6, 0.3, 30)  # N/m
BOUNDARY_FRICTION = 1.447  # of dry skin on glass; the parts are compared through their sum

TOLERANCE = 1e-5  # of pressures over p_H

RANGES = {
    "young_modulus_layer": (7e6, 7e6),
    "young_modulus_bulk": (1e4, 1e5),
    "rms_height": (5e-6, 40e-6),
    "sphere_radius": (8e-3, 8e-3),
    "normal_force": (0.1, 2.0),
    "layer_thickness": (20e-6, 20e-6),
}
"""Of the table, SI: a fit of the finger data in which bulk modulus and roughness are free."""

SHEAR_STRESS, VECTORS, COMPARED = 15e6, 512, 40


def plain_kernel(position: np.ndarray) -> np.ndarray:
    """Deflection by pressures that are constant about each of evenly spaced nodes, over the pressure."""
    half = (position[1] - position[0]) / 2
    offset = position[:, None] - position

    def integral(t: np.ndarray) -> np.ndarray:
        return t * np.log(np.abs(t)) - t

    return (integral(offset + half) - integral(offset - half)) / np.pi


def plain_film(
    number: float,
    position: np.ndarray,
    kernel: np.ndarray,
    law: Callable[[np.ndarray], np.ndarray],
    guess: np.ndarray,
) -> tuple[np.ndarray, np.ndarray, bool]:
    """Film and unknowns (pressures, then H0) at one lubrication number."""
    step = position[1] - position[0]

    def film_of(unknown: np.ndarray) -> np.ndarray:
        return unknown[-1] + position**2 / 2 - kernel @ unknown[:-1]

    start = np.maximum(film_of(guess), 1e-3)
    scale = step / (2 * start[1:-1] ** 3)

    def residual(unknown: np.ndarray) -> np.ndarray:
        film = film_of(unknown)
        fluid = unknown[:-1] - law(film)
        middle = np.maximum((film[1:] + film[:-1]) / 2, 1e-6)
        flow = number * middle - middle**3 * np.diff(fluid) / step
        loss = np.diff(flow) * scale
        balance = step * unknown[:-1].sum() - np.pi / 2
        return np.concatenate(
            [
                [fluid[0]],
                fluid[1:-1] + loss - np.sqrt(fluid[1:-1] ** 2 + loss**2 + 1e-14),
                [fluid[-1], balance],
            ]
        )

    unknown = guess
    options = {
        "xtol": 1e-9,
        "ftol": 1e-12,
        "maxiter": 30 * guess.size,
    }  # function values; a Jacobian takes one a node
    for _ in range(3):  # a fresh start helps where the iteration stalls at the edge of the cavity
        unknown = root(residual, unknown, method="lm", options=options).x
        if np.abs(residual(unknown)).max() < TOLERANCE:
            break
    return film_of(unknown), unknown, bool(np.abs(residual(unknown)).max() < TOLERANCE)


def plain_curve(products: np.ndarray, nodes: int) -> tuple[np.ndarray, np.ndarray]:
    """Friction coefficient at speeds times viscosity in N/m, and where a film was found."""
    radius, load, modulus, skin, surface = case()
    line = line_contact(load, radius, reduced_modulus=modulus)
    height, slope = float(line.half_width**2 / radius), float(line.half_width / radius)
    law = asperity_law(surface, skin).scaled(height, float(line.maximum_pressure))
    numbers = 6 * products * radius**2 / float(line.half_width**3 * line.maximum_pressure)
    inlet = 8.0
    position = np.linspace(-inlet, 3.0, nodes)
    kernel, step = plain_kernel(position), position[1] - position[0]
    unknown = np.append(np.sqrt(np.maximum(1 - position**2, 0.0)), 1.5)
    friction, good = np.empty_like(products), np.zeros(products.size, dtype=bool)
    for number in np.geomspace(1.0, numbers.max(), 4):
        _, unknown, _ = plain_film(number, position, kernel, lambda gap: law(gap)[0], unknown)
    for place in np.argsort(-numbers):
        number = numbers[place]
        film, unknown, good[place] = plain_film(number, position, kernel, lambda gap: law(gap)[0], unknown)
        carried = law(film)[0]
        fluid = unknown[:-1] - carried
        cavity = int(np.flatnonzero(fluid > 1e-6 * fluid.max())[-1])
        liquid = np.where(np.arange(nodes) > cavity, film[cavity] / film, 1.0)
        shear = number * slope / (3 * np.pi) * (step * (liquid / film).sum() + 2 / inlet)
        middle = (film[1:] + film[:-1]) / 2
        pressure = slope / np.pi * (middle @ np.diff(fluid) + number * 2 / inlet)
        friction[place] = BOUNDARY_FRICTION * step * carried.sum() * 2 / np.pi + shear + pressure
    return friction, good


def fast_curve(products: np.ndarray, nodes: int) -> np.ndarray:
    """The same with skinbayes."""
    radius, load, modulus, skin, surface = case()
    films = lubricated_films(
        products,
        cylinder_radius=radius,
        load_per_length=load,
        reduced_modulus=modulus,
        asperities=asperity_law(surface, skin),
        nodes=nodes,
    )
    return BOUNDARY_FRICTION * films.asperity_load_fraction + films.couette + films.pressure_flow


def case() -> tuple[float, float, float, LayeredSkin, PowerSpectrum]:
    """Cylinder radius (m), load per length (N/m) and modulus (Pa) of Fig. 13 of the paper, with its skin and surface."""
    skin = LayeredSkin(young_modulus_layer=7e6, young_modulus_bulk=20e3, layer_thickness=20e-6)
    modulus = float(reduced_modulus(20e3, 0.5))
    load, radius = cylinder_of_sphere(0.2, 8e-3, reduced_modulus=modulus)
    return float(radius), float(load), modulus, skin, named_surface("paper_reference")


def best_time(function: Callable[[], object], repeats: int) -> float:
    """Seconds a call, the best of ``repeats``."""
    times = []
    for _ in range(repeats):
        start = time.perf_counter()
        function()
        times.append(time.perf_counter() - start)
    return min(times)


def run(plain_nodes: int) -> dict[str, float]:
    """Time both sides and compare their results."""
    exact = fast_curve(POINTS, 800)
    result: dict[str, float] = {"points": POINTS.size}
    for nodes in (64, 80, 100):
        result[f"error_{nodes}_nodes"] = float(np.abs(fast_curve(POINTS, nodes) / exact - 1).max())
        result[f"ms_{nodes}_nodes"] = 1e3 * best_time(lambda n=nodes: fast_curve(POINTS, n), 20)
    start = time.perf_counter()
    friction, good = plain_curve(POINTS, plain_nodes)
    seconds = time.perf_counter() - start
    result |= {
        "plain_nodes": plain_nodes,
        "plain_error": float(np.abs(friction / exact - 1)[good].max()),
        "plain_converged": int(good.sum()),
        "plain_ms": 1e3 * seconds,
        "ratio_to_plain": 1e3 * seconds / result["ms_80_nodes"],
    }
    return result


def draw(vectors: int) -> dict[str, np.ndarray]:
    """Parameter vectors within the ranges, shape ``(vectors, 1)``."""
    rng = np.random.default_rng(7)
    return {name: np.exp(rng.uniform(*np.log(RANGES[name]), (vectors, 1))) for name in FILM_PARAMETERS}


def direct_friction(
    parameters: dict[str, float], products: np.ndarray, contact: str, nodes: int = 80, cells: int = 360
) -> np.ndarray:
    """Friction coefficient of one parameter vector with the direct solver."""
    shape = named_surface("paper_reference")
    surface = SelfAffineSpectrum(
        rms_height=parameters["rms_height"],
        hurst_exponent=shape.hurst_exponent,
        wavevector_min=shape.wavevector_min,
        wavevector_rolloff=shape.wavevector_rolloff,
        wavevector_max=shape.wavevector_max,
    )
    skin = LayeredSkin(
        young_modulus_layer=parameters["young_modulus_layer"],
        young_modulus_bulk=parameters["young_modulus_bulk"],
        layer_thickness=parameters["layer_thickness"],
    )
    curve = stribeck_curve(
        products,
        sphere_radius=parameters["sphere_radius"],
        normal_force=parameters["normal_force"],
        skin=skin,
        spectrum=surface,
        frictional_shear_stress=SHEAR_STRESS,
        contact=contact,
        nodes=nodes,
        cells=cells,
    )
    return curve.friction_coefficient


def vector(parameters: dict[str, np.ndarray], place: int, column: int = 0) -> dict[str, float]:
    """One row of one vector."""
    return {
        name: float(value[place % len(value), column % value.shape[1]]) for name, value in parameters.items()
    }


def run_table(contact: str) -> dict[str, float]:
    """Build a table, time curves and compare them with the direct solver."""
    start = time.process_time()
    table = build_film_table(
        FilmTablePlan(RANGES, spectrum=named_surface("paper_reference"), contact=contact)
    )
    result = {
        "table_build_cpu_s": time.process_time() - start,
        "table_held_out_p99": float(table.held_out[1]),
        "table_held_out_worst": float(table.held_out[2]),
    }
    parameters = draw(VECTORS)
    seconds = (
        best_time(
            lambda: tabulated_friction(
                table,
                POINTS,
                balls=LubricatedBalls(parameters=parameters, frictional_shear_stress=SHEAR_STRESS),
            ),
            20,
        )
        / VECTORS
    )
    times, errors = [], []
    tabulated = tabulated_friction(
        table, POINTS, balls=LubricatedBalls(parameters=parameters, frictional_shear_stress=SHEAR_STRESS)
    ).friction_coefficient
    for place in range(COMPARED):
        one = vector(parameters, place)
        times.append(best_time(lambda one=one: direct_friction(one, POINTS, contact), 1))
        difference = np.abs(tabulated[place] / direct_friction(one, POINTS, contact, 200, 800) - 1)
        errors.append(difference[np.isfinite(difference)].max(initial=0.0))
    result |= {
        "table_us_per_curve": 1e6 * seconds,
        "direct_ms_per_curve": 1e3 * float(np.median(times)),
        "ratio_direct_to_table": float(np.median(times)) / seconds,
        "table_error": float(max(errors)),
    }
    return result | run_liquids(table, contact)


def run_liquids(table: FilmTable, contact: str) -> dict[str, float]:
    """Time the measured points with self-consistent viscosity."""
    rheology, data = (
        load_dataset("fehlberg2025-rheology").columns,
        load_dataset("fehlberg2025-finger-stribeck").columns,
    )
    names = np.asarray(rheology["liquid"])
    curves = {
        name: FlowCurve(rheology["shear_rate"][names == name], rheology["viscosity"][names == name])
        for name in set(names.tolist())
    }
    rows = liquid_rows([curves[name] for name in np.asarray(data["liquid"]).tolist()])
    speed = np.asarray(data["sliding_speed"], dtype=float)
    parameters = draw(128) | {"normal_force": np.asarray(data["normal_force"], dtype=float)[None]}
    seconds = best_time(
        lambda: tabulated_friction_of_liquids(
            table,
            speed,
            balls=LubricatedBalls(parameters=parameters, frictional_shear_stress=SHEAR_STRESS),
            liquids=rows,
        ),
        20,
    )
    plain = best_time(
        lambda: tabulated_friction(
            table,
            0.1 * speed,
            balls=LubricatedBalls(parameters=parameters, frictional_shear_stress=SHEAR_STRESS),
        ),
        20,
    )
    friction, viscosity = tabulated_friction_of_liquids(
        table,
        speed,
        balls=LubricatedBalls(parameters=parameters, frictional_shear_stress=SHEAR_STRESS),
        liquids=rows,
    )
    start, errors = time.perf_counter(), []
    for column in range(speed.size):
        product = np.array([viscosity.viscosity[0, column] * speed[column]])
        if np.isfinite(product[0]):
            direct = direct_friction(vector(parameters, 0, column), product, contact)
            errors.append(abs(friction.friction_coefficient[0, column] / direct[0] - 1))
    direct_seconds = time.perf_counter() - start
    return {
        "rows": speed.size,
        "rows_ms_one_pass": 1e3 * plain / 128,
        "rows_ms_own_viscosity": 1e3 * seconds / 128,
        "rows_direct_ms": 1e3 * direct_seconds,
        "rows_ratio": direct_seconds * 128 / seconds,
        "rows_error": float(max(errors)),
    }


def main() -> None:
    """Print a small table, or JSON."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--json", action="store_true", help="one JSON document on standard output")
    parser.add_argument("--plain-nodes", type=int, default=120, help="nodes of the plain side")
    parser.add_argument("--contact", choices=("point", "line"), default="point", help="of the table of films")
    arguments = parser.parse_args()
    result = run(arguments.plain_nodes) | run_table(arguments.contact)
    if arguments.json:
        print(json.dumps(result, indent=2))
        return
    print(f"Stribeck curve of {POINTS.size} points")
    for nodes in (64, 80, 100):
        time_, error = result[f"ms_{nodes}_nodes"], result[f"error_{nodes}_nodes"]
        print(f"  skinbayes, {nodes:3d} nodes            {time_:10.1f} ms   error {error:.2%}")
    print(f"  scipy.optimize.root, {result['plain_nodes']:3.0f} nodes  {result['plain_ms']:10.1f} ms   "
          f"error {result['plain_error']:.2%}, {result['plain_converged']:.0f} points converged")  # fmt: skip
    print(f"  times faster (80 nodes)         {result['ratio_to_plain']:10.0f}")
    print(
        f"Table of films, built in {result['table_build_cpu_s']:.1f} CPU s, held-out errors "
        f"{result['table_held_out_p99']:.2%} (99th percentile), {result['table_held_out_worst']:.2%} (worst)"
    )
    print(f"  direct, 80 nodes or 360 cells   {result['direct_ms_per_curve']:10.1f} ms")
    print(
        f"  table, {VECTORS} vectors at once     {result['table_us_per_curve']:10.1f} us   "
        f"largest error of {COMPARED} curves {result['table_error']:.2%}"
    )
    print(f"  times faster                    {result['ratio_direct_to_table']:10.0f}")
    print(f"The {result['rows']:.0f} measured points, 128 vectors at once")
    print(f"  viscosity given                 {result['rows_ms_one_pass']:10.3f} ms")
    print(f"  viscosity of their own films    {result['rows_ms_own_viscosity']:10.3f} ms")
    print(
        f"  direct, that viscosity given    {result['rows_direct_ms']:10.1f} ms   largest difference "
        f"{result['rows_error']:.2%}"
    )
    print(f"  times faster                    {result['rows_ratio']:10.0f}")  # fmt: skip


if __name__ == "__main__":
    main()
