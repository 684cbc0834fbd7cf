"""Random balls, skins, surfaces and speeds: a film is found everywhere, and it balances load and mass."""

import numpy as np
import pytest
from named_fields import surface_from

from skinbayes.contact import LayeredSkin, reduced_modulus
from skinbayes.contact.line_contact import cylinder_of_sphere
from skinbayes.lubrication import asperity_law, lubricated_films


def random_films(rng, nodes):
    def scale(low, high):
        return float(np.exp(rng.uniform(np.log(low), np.log(high))))

    bulk = scale(5e3, 5e6)
    skin = LayeredSkin(
        young_modulus_layer=max(bulk, scale(1e6, 1e9)),
        young_modulus_bulk=bulk,
        layer_thickness=scale(1e-5, 1e-4),
    )
    surface = surface_from((scale(1e-6, 5e-5), rng.uniform(0.6, 0.95), 1e3, scale(1.1e3, 2e4), 1e9))
    modulus = float(reduced_modulus(bulk, 0.5))
    cylinder = cylinder_of_sphere(scale(0.02, 5.0), scale(1e-3, 2e-2), reduced_modulus=modulus)
    speeds = np.sort(np.exp(rng.uniform(np.log(1e-8), np.log(10.0), int(rng.integers(1, 31)))))
    law = asperity_law(surface, skin)
    radius, load = float(cylinder.cylinder_radius), float(cylinder.load_per_length)
    return load, lubricated_films(
        speeds,
        cylinder_radius=radius,
        load_per_length=load,
        reduced_modulus=modulus,
        asperities=law,
        nodes=nodes,
    )


def check(seed, cases):
    rng = np.random.default_rng(seed)
    points = 0
    for _ in range(cases):
        load, films = random_films(rng, 80)
        points += films.couette.size
        assert np.isfinite(films.couette).all()
        assert np.isfinite(films.pressure_flow).all()
        assert np.all(films.minimum_film > 0)
        assert np.all(films.asperity_load_fraction >= -1e-9)
        assert np.all(films.asperity_load_fraction <= 1 + 1e-9)
        assert np.all(np.diff(films.asperity_load_fraction) < 1e-9)
        assert np.all(np.diff(films.minimum_film) > -1e-9 * films.minimum_film[1:])
        assert films.fluid_pressure.min() > -1e-6 * films.fluid_pressure.max()
        # the fluid's share with what it carries before the grid, 2λ/(3X²), and that of the asperities
        carried = films.fluid_pressure @ films.load_weight / load
        assert np.all(np.abs(carried + films.asperity_load_fraction - 1) < 0.005)
    return points


def test_a_film_is_found_in_every_random_case():
    assert check(11, 30) > 300


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(4))
def test_a_film_is_found_in_a_thousand_random_cases(seed):
    assert check(100 + seed, 250) > 3000


@pytest.mark.slow
def test_few_nodes_are_enough_all_over():
    worst = []
    for seed in range(40):
        _, coarse = random_films(np.random.default_rng(seed), 80)
        _, fine = random_films(np.random.default_rng(seed), 400)
        friction, wanted = (f.asperity_load_fraction + f.couette + f.pressure_flow for f in (coarse, fine))
        worst.append(np.abs(friction / wanted - 1).max())
    assert np.median(worst) < 5e-3
    # the worst case is nearly smooth, its thinnest film 12 nm, on a grid that reaches up to λ = 93
    assert max(worst) < 0.016
