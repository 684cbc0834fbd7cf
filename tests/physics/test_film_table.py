"""Tables of films against the direct solver, and what a table must not do."""

import json
import pickle
from importlib import import_module

import numpy as np
import pytest
from line_curves import FilmTablePlan, stribeck_curve
from small_film_tables import RANGES, draw, skin_of, small_table, spectrum_of

from skinbayes.contact.line_contact import line_contact
from skinbayes.emulation import from_arrays, to_arrays
from skinbayes.errors import InputError
from skinbayes.lubrication import (
    FilmTable,
    LubricatedBalls,
    build_film_table,
    lubricated_films,
    tabulated_friction,
)
from skinbayes.lubrication.film import lubrication_number_per_product
from skinbayes.lubrication.film_reference import smooth_films
from skinbayes.lubrication.film_table import FRACTION
from skinbayes.roughness import named_surface

SHEAR_STRESS = 15e6
PRODUCTS = np.geomspace(1e-6, 0.3, 30)
FIELDS = (
    "friction_coefficient", "boundary", "couette", "pressure_flow", "central_film", "minimum_film", "asperity_load_fraction",
)  # fmt: skip


def direct(parameters, products, nodes=160, **options):
    one = {name: float(value) for name, value in parameters.items()}
    return stribeck_curve(
        products,
        sphere_radius=one["sphere_radius"],
        normal_force=one["normal_force"],
        skin=skin_of(one),
        spectrum=spectrum_of(one),
        frictional_shear_stress=SHEAR_STRESS,
        nodes=nodes,
        **options,
    )


def vector(parameters, place):
    return {name: value[place].item() for name, value in parameters.items()}


def test_table_against_direct_solutions():
    parameters = draw(np.random.default_rng(1), 4)
    found = tabulated_friction(
        small_table(),
        PRODUCTS,
        balls=LubricatedBalls(parameters=parameters, frictional_shear_stress=SHEAR_STRESS, everything=True),
    )
    for place in range(4):
        wanted = direct(vector(parameters, place), PRODUCTS)
        valid = wanted.valid
        assert valid.sum() > 20
        assert np.array_equal(np.isfinite(found.friction_coefficient[place]), valid)
        for name in FIELDS:
            tabulated, solved = getattr(found, name)[place][valid], getattr(wanted, name)[valid]
            # boundary and load fraction fall by many decades; elsewhere films move by more than friction does
            level = 1e-3 if name in ("boundary", "asperity_load_fraction") else 0.0
            tolerance = {"friction_coefficient": 5e-3, "minimum_film": 2e-2}.get(name, 1e-2)
            assert np.all(np.abs(tabulated - solved) <= tolerance * (solved + level)), name


def test_beyond_both_ends_of_the_speeds_against_direct_solutions():
    parameters = vector(draw(np.random.default_rng(2), 1), 0)
    products = np.array([1e-9, 1e-8, 1e-7, 0.1, 0.5])
    found = tabulated_friction(
        small_table(),
        products,
        balls=LubricatedBalls(parameters=parameters, frictional_shear_stress=SHEAR_STRESS, everything=True),
    )
    wanted = direct(parameters, products, nodes=300)
    for name in ("couette", "pressure_flow", "central_film"):
        keep = wanted.valid
        assert np.abs(getattr(found, name) / getattr(wanted, name) - 1)[keep].max() < 0.01, name
    assert np.abs(found.boundary / wanted.boundary - 1)[:3].max() < 2e-3
    # fluid friction in proportion to the speed
    assert found.couette[1] / found.couette[0] == pytest.approx(10, rel=1e-4)
    assert found.pressure_flow[1] / found.pressure_flow[0] == pytest.approx(10, rel=1e-4)


def test_similar_balls_are_the_same_entry_and_the_same_curve():
    """(h, F, R) and (h R/R0, F R/R0, R0) differ by a factor in speed only; b/Rc, and so friction, goes as 1/R."""
    parameters = vector(draw(np.random.default_rng(3), 1), 0)
    ratio = 1.6
    similar = {
        **parameters,
        "sphere_radius": parameters["sphere_radius"] * ratio,
        "rms_height": parameters["rms_height"] / ratio,
        "normal_force": parameters["normal_force"] / ratio,
    }
    table = small_table()
    assert table.contains(**similar)
    products = np.geomspace(1e-6, 0.05, 12)
    # λ = 12 ηv Rc³/(E* b⁴) at equal b
    of_similar = products / ratio**3
    wanted = direct(parameters, products)
    solved = direct(similar, of_similar)
    tabulated = tabulated_friction(
        table, of_similar, balls=LubricatedBalls(parameters=similar, frictional_shear_stress=SHEAR_STRESS)
    )
    for curve, tolerance in ((solved, 1e-5), (tabulated, 6e-3)):
        # E0 h is smaller by the ratio and so are V^(1/2) and p_H
        assert np.all(np.abs(curve.boundary - ratio * wanted.boundary) < tolerance * (wanted.boundary + 1e-2))
        fluid, wanted_fluid = curve.couette + curve.pressure_flow, wanted.couette + wanted.pressure_flow
        assert np.abs(fluid * ratio / wanted_fluid - 1).max() < tolerance


def test_rows_of_a_batch_are_single_evaluations_to_the_last_bit():
    rng = np.random.default_rng(4)
    for rows in (0, 30):
        parameters = draw(rng, 700, rows)
        stress, shift = rng.uniform(1e6, 2e7, (700, 1)), rng.uniform(0.5, 20.0, (700, 1))
        batch = tabulated_friction(
            small_table(),
            PRODUCTS,
            balls=LubricatedBalls(
                parameters=parameters,
                frictional_shear_stress=stress,
                velocity_shift_factor=shift,
                everything=True,
            ),
        )
        for place in (0, 1, 272, 273, 699):
            one = {name: value[place : place + 1] for name, value in parameters.items()}
            single = tabulated_friction(
                small_table(),
                PRODUCTS,
                balls=LubricatedBalls(
                    parameters=one,
                    frictional_shear_stress=stress[place],
                    velocity_shift_factor=shift[place],
                    everything=True,
                ),
            )
            for whole, part in zip(batch, single, strict=True):
                assert np.array_equal(whole[place], part[0], equal_nan=True)


def test_curve_and_its_slope_are_continuous():
    """Second differences stay small everywhere: over cells, and over both ends of the tabulated speeds."""
    parameters = vector(draw(np.random.default_rng(5), 1), 0)
    log_product = np.linspace(np.log(1e-8), np.log(0.2), 20001)
    found = tabulated_friction(
        small_table(),
        np.exp(log_product),
        balls=LubricatedBalls(parameters=parameters, frictional_shear_stress=SHEAR_STRESS, everything=True),
    )
    step = log_product[1] - log_product[0]
    for name in ("friction_coefficient", "couette", "pressure_flow", "central_film"):
        curve = np.log(getattr(found, name))
        slope = np.diff(curve) / step
        assert (
            np.abs(np.diff(slope)).max() < 4 * step
        )  # a kink would leave a jump of the slope that does not shrink
        assert np.abs(slope).max() < 2.0
    assert np.all(np.diff(found.boundary) <= 1e-12)
    assert np.all(np.diff(found.central_film) >= 0)
    # and along the axes
    moduli = np.exp(np.linspace(*np.log(RANGES["young_modulus_bulk"]), 2001))[1:-1]
    along = tabulated_friction(
        small_table(),
        3e-3,
        balls=LubricatedBalls(
            parameters={**parameters, "young_modulus_bulk": moduli[:, None]}, frictional_shear_stress=1e7
        ),
    )
    slope = np.diff(np.log(along.friction_coefficient[:, 0]))
    assert np.abs(np.diff(slope)).max() < 1e-4


def test_outside_is_refused_not_extrapolated():
    table = small_table()
    inside = vector(draw(np.random.default_rng(6), 1), 0)
    assert not tabulated_friction(
        table, 1e-3, balls=LubricatedBalls(parameters=inside, frictional_shear_stress=SHEAR_STRESS)
    ).outside_table
    for name, value in (
        ("young_modulus_bulk", 6.1e4),
        ("rms_height", 14.9e-6),
        ("normal_force", 0.61),
        ("normal_force", np.nan),
        ("normal_force", -0.3),
        ("sphere_radius", 8.1e-3),  # not similar to any ball inside: at the edge, or of another b
        ("layer_thickness", 21e-6),
        ("young_modulus_layer", 6.9e6),
    ):
        changed = {**inside, name: value}
        if name in ("sphere_radius", "young_modulus_layer"):
            changed |= {"rms_height": 24.9e-6, "young_modulus_bulk": 5.99e4, "normal_force": 0.599}
        found = tabulated_friction(
            table, 1e-3, balls=LubricatedBalls(parameters=changed, frictional_shear_stress=SHEAR_STRESS)
        )
        assert found.outside_table, name
        assert np.isnan(found.friction_coefficient)
        assert not table.contains(**changed)
    beyond = tabulated_friction(
        table, 10.0, balls=LubricatedBalls(parameters=inside, frictional_shear_stress=SHEAR_STRESS)
    )
    assert beyond.film_beyond_ball
    assert np.isnan(beyond.friction_coefficient)
    assert np.isnan(
        tabulated_friction(
            table, -1.0, balls=LubricatedBalls(parameters=inside, frictional_shear_stress=SHEAR_STRESS)
        ).friction_coefficient
    )


def test_held_out_errors_are_kept_with_the_table():
    held_out = small_table().held_out
    assert small_table().held_out_count == 20
    assert 0 < held_out[0] < held_out[1] <= held_out[2] < 5e-3


def test_tables_travel():
    table = small_table()
    arrays, metadata = to_arrays(table)
    again = from_arrays(FilmTable, arrays, json.loads(json.dumps(metadata)))
    parameters = draw(np.random.default_rng(7), 3)
    wanted = tabulated_friction(
        table, PRODUCTS, balls=LubricatedBalls(parameters=parameters, frictional_shear_stress=SHEAR_STRESS)
    )
    for other in (again, pickle.loads(pickle.dumps(table))):
        found = tabulated_friction(
            other,
            PRODUCTS,
            balls=LubricatedBalls(parameters=parameters, frictional_shear_stress=SHEAR_STRESS),
        )
        assert np.array_equal(found.friction_coefficient, wanted.friction_coefficient, equal_nan=True)
    with pytest.raises(InputError, match="lacks held_out"):
        from_arrays(FilmTable, {k: v for k, v in arrays.items() if k != "held_out"}, metadata)


def test_progress_and_processes():
    ranges = {**RANGES, "young_modulus_bulk": (4e4, 4e4), "rms_height": (20e-6, 20e-6)}
    said = []
    surface = named_surface("paper_reference")
    options = {"counts": {"normal_force": 3}, "speeds": 9, "nodes": 40, "checked": 2}
    plan = FilmTablePlan(ranges, spectrum=surface, **options)
    one = build_film_table(plan, progress=lambda done, total: said.append((done, total)))
    assert said == [(done, 8) for done in range(1, 9)]  # three anchors, three nodes, two checks
    two = build_film_table(plan, processes=2)
    assert np.array_equal(one.coefficients, two.coefficients)


def test_films_that_are_not_found_end_the_build(monkeypatch):
    solved, solver = lubricated_films, import_module("skinbayes.lubrication.contact_films")

    def sometimes(*arguments, nodes, **options):
        films = solved(*arguments, nodes=nodes, **options)
        return films if nodes != 84 else films._replace(couette=films.couette * np.nan)

    ranges = {name: (low, low) for name, (low, _) in RANGES.items()}
    surface, options = named_surface("paper_reference"), {"speeds": 9, "checked": 0}
    whole = build_film_table(FilmTablePlan(ranges, spectrum=surface, **options))
    monkeypatch.setattr(solver, "lubricated_films", sometimes)
    # with more nodes a film may be found
    again = build_film_table(FilmTablePlan(ranges, spectrum=surface, **options, nodes=84))
    assert np.abs(again.coefficients - whole.coefficients)[:10].max() < 0.1
    monkeypatch.setattr(solver, "lubricated_films", lambda *a, **o: solved(*a, **o)._replace(couette=np.nan))
    with pytest.raises(InputError, match=r"No film was found for a cylinder of radius 0\.00453 m"):
        build_film_table(FilmTablePlan(ranges, spectrum=surface, **options))


def test_smooth_films_between_and_below_their_points():
    log_number = np.array([-12.3, -8.05, -3.3, 0.11, 2.2, 5.5])
    smooth = smooth_films()
    found = smooth(log_number, range(4))
    modulus = 4 / np.pi
    hertz = line_contact(1.0, 1.0, reduced_modulus=modulus)
    for place, number in enumerate(np.exp(log_number)):
        films = lubricated_films(
            number / lubrication_number_per_product(1.0, hertz),
            cylinder_radius=1.0,
            load_per_length=1.0,
            reduced_modulus=modulus,
            nodes=320,
        )
        # b/Rc = 1 here: λ/(3π)∫θ dX/H, ∫H dP_f/π and films in their own unit
        assert np.exp(found[0][place]) == pytest.approx(films.central_film[0], rel=2e-3)
        assert np.exp(found[1][place]) == pytest.approx(3 * np.pi * films.couette[0] / number, rel=3e-3)
        assert np.exp(found[2][place]) == pytest.approx(np.pi * films.pressure_flow[0], rel=2e-3)
        assert np.exp(found[3][place]) == pytest.approx(films.minimum_film[0], rel=6e-3)
    value, slope = smooth(np.array([-16.0, -15.0]), range(1), slope=True)
    assert slope == pytest.approx(0.6, abs=5e-3)  # the isoviscous-elastic limit
    assert value[1] - value[0] == pytest.approx(slope[0], rel=1e-3)


def test_speeds_are_counted_forwards_where_rough_skin_lets_go_at_once():
    """Roughness of many decay lengths under a light ball: the load fraction falls from 5 % to e^-23 while λ grows e-fold."""
    rough = {
        "young_modulus_layer": 1.2e9, "young_modulus_bulk": 7e4, "rms_height": 76e-6, "sphere_radius": 1e-2,
        "normal_force": 5.6e-3, "layer_thickness": 173e-6,
    }  # fmt: skip
    ranges = {name: (value, value) for name, value in rough.items()}
    plan = FilmTablePlan(ranges, spectrum=named_surface("paper_reference"))
    ball = plan.ball(np.log(list(rough.values())))
    half, unit = ball.anchors()
    fractions = np.exp(ball.outputs(half + unit * np.array([0.0, 1.0, 2.0]), 96)[FRACTION])
    assert unit > 0.5
    assert fractions[0] == pytest.approx(0.5, abs=0.05)
    assert 1e-5 < fractions[1] < 0.05
    assert fractions[2] < 1e-6


def test_wrong_inputs_are_named():
    with pytest.raises(InputError, match="need exactly young_modulus_layer"):
        build_film_table(
            FilmTablePlan({"rms_height": (1e-6, 2e-6)}, spectrum=named_surface("paper_reference"))
        )
    with pytest.raises(InputError, match=r"rms_height ranges from 2e-05 to 1e-05 m"):
        build_film_table(
            FilmTablePlan({**RANGES, "rms_height": (2e-5, 1e-5)}, spectrum=named_surface("paper_reference"))
        )
    with pytest.raises(InputError, match="missing or unknown: layer_thickness"):
        tabulated_friction(
            small_table(),
            1e-3,
            balls=LubricatedBalls(
                parameters={n: v[0] for n, v in RANGES.items() if n != "layer_thickness"},
                frictional_shear_stress=1e6,
            ),
        )


def test_the_key_tells_tables_apart():
    surface = named_surface("paper_reference")
    key = FilmTablePlan(RANGES, spectrum=surface).key()
    assert json.loads(json.dumps(key)) == key
    assert (
        FilmTablePlan(dict(reversed(RANGES.items())), spectrum=named_surface("paper_reference")).key() == key
    )
    others = [
        FilmTablePlan({**RANGES, "normal_force": (0.2, 0.7)}, spectrum=surface).key(),
        FilmTablePlan(RANGES, spectrum=named_surface("paper_reference_sharp")).key(),
        FilmTablePlan(RANGES, spectrum=surface, poisson_ratio_layer=0.4).key(),
        FilmTablePlan(RANGES, spectrum=surface, poisson_ratio_bulk=0.4).key(),
        FilmTablePlan(RANGES, spectrum=surface, area_correction=1.0).key(),
        FilmTablePlan(RANGES, spectrum=surface, counts={"rms_height": 9}).key(),
        FilmTablePlan(RANGES, spectrum=surface, speeds=32).key(),
        FilmTablePlan(RANGES, spectrum=surface, nodes=97).key(),
        FilmTablePlan(RANGES, spectrum=surface, checked=0).key(),
    ]
    texts = {json.dumps(other, sort_keys=True) for other in (key, *others)}
    assert len(texts) == 10


def test_numbers_of_the_direct_solver_belong_to_the_version_of_tables():
    """Whoever changes these numbers raises VERSION in film_table.py, so that stored tables are built anew."""
    one = {name: float(np.sqrt(low * high)) for name, (low, high) in RANGES.items()}
    curve = direct(one, [1e-5, 1e-3, 1e-2, 0.1], nodes=80)
    version_1 = VERSION_1_FRICTION
    assert curve.friction_coefficient == pytest.approx(version_1, rel=2e-6)


VERSION_1_FRICTION = [1.640783676, 0.965422395, 0.175572675, 0.148386114]
