"""Gap distribution against a plain evaluation of the theory, sum rules, invariances, batches against their rows."""

from itertools import pairwise

import numpy as np
import pytest
from named_fields import skin_from, surface_from
from scipy.integrate import quad
from scipy.special import erf, exp1

from skinbayes.contact import (
    GapDistribution,
    LayeredSkin,
    effective_modulus,
    gap_distribution,
    mean_separation,
    persson_contact_area,
    relative_contact_area,
    twice_stress_variance,
)
from skinbayes.errors import InputError
from skinbayes.roughness import TabulatedSpectrum, named_surface

WET = LayeredSkin(young_modulus_layer=7e6, young_modulus_bulk=20e3, layer_thickness=20e-6)
SHARES = np.array([0.02, 0.1, 0.3, 0.6, 1, 1.4, 2, 3])


def random_parameters(count, seed):
    rng = np.random.default_rng(seed)

    def log_uniform(low, high):
        return np.exp(rng.uniform(np.log(low), np.log(high), count))

    q0 = log_uniform(3e2, 5e3)
    roughness = (log_uniform(1e-6, 1e-4), rng.uniform(0.3, 0.95, count), q0, q0 * log_uniform(1.5, 20))
    e1 = log_uniform(2e3, 2e5)
    skin = (e1 * log_uniform(1, 1e5), e1, rng.uniform(0.1, 0.5, count), rng.uniform(0.1, 0.5, count))
    return (*roughness, log_uniform(1e7, 1e10)), (*skin, log_uniform(5e-6, 1e-4)), log_uniform(1e-4, 1)


def inner_integral(gamma):
    """γ E₁(x²)/2 + 3(1 − γ) J(x) as a function of x, J summed by the trapezoidal rule from above."""
    log_t = np.linspace(np.log(1e-8), np.log(8), 40001)
    t = np.exp(log_t)
    integrand = erf(t) ** 2 * np.exp(-(t**2))
    steps = (integrand[1:] + integrand[:-1]) / 2 * np.diff(log_t)
    table = np.append(np.cumsum(steps[::-1])[::-1], 0.0)
    return lambda x: gamma * exp1(x**2) / 2 + 3 * (1 - gamma) * np.interp(np.log(x), log_t, table)


def plainly(pressure, surface, skin, gamma, gaps, nodes=160, points=200):
    """F(d) from the formulas of the theory: every integral over q by the midpoint rule, u₁ by finite differences."""
    first, last = np.log(surface.wavevector_min), np.log(surface.wavevector_max)
    inner = inner_integral(gamma)
    middle = (np.arange(points) + 0.5) / points
    edges = np.linspace(first, last, nodes + 1)
    below = np.concatenate([[0.0], twice_stress_variance(surface, skin, wavevector=np.exp(edges[1:]))])
    area = np.append(1.0, relative_contact_area(pressure, below[1:], area_correction=gamma))
    separation, above = np.zeros(nodes + 1), np.zeros(nodes + 1)
    for j in range(nodes):
        # v grows linearly from ζ on and w like its inverse root: steps are even in the root of ln q
        root = np.sqrt(last - edges[j])
        log_q = edges[j] + (root * middle) ** 2
        measure = 2 * root * middle * root / points
        q = np.exp(log_q)
        w = 1 / np.sqrt(twice_stress_variance(surface, skin, wavevector=q) - below[j])
        strength = q**3 * surface.power(q) * effective_modulus(skin, q) * w
        separation[j] = np.sqrt(np.pi) * np.sum(measure * strength * inner(w * pressure / area[j]))
        above[j] = 2 * np.pi * np.sum(measure * q**2 * surface.power(q))
    weight = -np.diff(area)
    with np.errstate(all="ignore"):
        location = -np.diff(area * separation) / weight
    mean = separation[0]
    location = np.where(weight > 1e-9, location, 1e6 * mean)
    location = location / (1 + (location / (2.5 * mean)) ** 4) ** 0.25
    width = np.sqrt((above[1:] + above[:-1]) / 2)
    u = np.append(0, np.geomspace(1e-7 * mean, 8 * np.max(location + width), 8001))
    bells = np.zeros_like(u)
    for fraction, place, spread in zip(weight, location, width, strict=True):
        folded = np.exp(-(((u - place) / spread) ** 2) / 2) + np.exp(-(((u + place) / spread) ** 2) / 2)
        bells += fraction * folded / (np.sqrt(2 * np.pi) * spread)
    cumulative = np.append(0, np.cumsum((bells[1:] + bells[:-1]) / 2 * np.diff(u)))
    first_moment = np.sum((u[1:] * bells[1:] + u[:-1] * bells[:-1]) / 2 * np.diff(u))
    return area[-1] + np.interp(gaps * first_moment / mean, u, cumulative), mean


@pytest.mark.parametrize("i", range(4))
def test_distribution_agrees_with_a_plain_evaluation(i):
    roughness, skin, reach = random_parameters(4, 1)
    surface, material = surface_from(x[i] for x in roughness), skin_from(x[i] for x in skin)
    gamma = (0.42, 0.42, 1.0, 0.3)[i]
    pressure = reach[i] * np.sqrt(twice_stress_variance(surface, material))
    found = gap_distribution(pressure, surface, skin=material, area_correction=gamma)
    expected, mean = plainly(pressure, surface, material, gamma, SHARES * found.mean)
    assert mean == pytest.approx(found.mean, rel=3e-3)
    np.testing.assert_allclose(found.cumulative(SHARES * found.mean), expected, atol=6e-3)


def some_gaps(closure="gaussian", count=20):
    roughness, skin, reach = random_parameters(count, 2)
    surface, material = surface_from(roughness), skin_from(skin)
    p = (reach * np.sqrt(twice_stress_variance(surface, material)))[:, None] * np.array([0.1, 1.0])
    return (
        gap_distribution(p, surface, skin=material, area_correction=0.42, closure=closure),
        p,
        surface,
        material,
    )


@pytest.mark.parametrize("closure", ["gaussian", "sharp"])
def test_area_and_mean_are_those_of_the_theory(closure):
    gaps, p, surface, material = some_gaps(closure)
    twice_variance = twice_stress_variance(surface, material)[:, None]
    np.testing.assert_allclose(gaps.contact_fraction, relative_contact_area(p, twice_variance), rtol=1e-6)
    np.testing.assert_array_equal(gaps.mean, mean_separation(p, surface, skin=material))
    np.testing.assert_allclose(gaps.film(np.inf), gaps.mean, rtol=1e-12)
    np.testing.assert_allclose(gaps.cumulative(np.inf), 1, rtol=1e-12)
    np.testing.assert_allclose(gaps.cumulative(0.0), gaps.contact_fraction, rtol=1e-12)
    assert np.all(gaps.film(0.0) == 0)
    assert np.all(gaps.weight >= 0) and np.all(gaps.location >= 0) and np.all(gaps.width > 0)


@pytest.mark.parametrize("closure", ["gaussian", "sharp"])
def test_film_is_the_moment_of_the_distribution(closure):
    gaps, *_ = some_gaps(closure, 3)
    for i in range(3):
        one = GapDistribution(**{name: np.asarray(value)[i, 1] for name, value in vars(gaps).items()})
        for d in one.mean * np.array([0.01, 0.4, 1.0, 3.0]):
            # by parts: ∫ u dF = d F(d) − ∫ F du
            breaks = np.append(0, np.geomspace(d * 1e-4, d, 60))
            parts = [quad(one.cumulative, a, b, epsabs=0, epsrel=1e-10)[0] for a, b in pairwise(breaks)]
            expected = d * one.cumulative(d) - sum(parts)
            assert one.film(d) == pytest.approx(expected, rel=1e-6, abs=1e-9 * one.mean)


def test_cumulative_rises_and_the_mean_below_lies_below():
    gaps, *_ = some_gaps()
    d = np.geomspace(1e-11, 1e-3, 200)
    fraction, film, below = gaps.cumulative(d), gaps.film(d), gaps.mean_below(d)
    assert fraction.shape == film.shape == (20, 2, 200)
    assert np.all(np.diff(fraction) >= -1e-15) and np.all(np.diff(film) >= -1e-15 * gaps.mean[..., None])
    inside = d > 1e-3 * gaps.mean[..., None]
    assert np.all((below < d)[inside]) and np.all((below > 0.1 * np.minimum(d, gaps.mean[..., None]))[inside])
    np.testing.assert_allclose(gaps.mean_below(np.inf), gaps.mean / (1 - gaps.contact_fraction), rtol=1e-9)


def test_more_pressure_less_gap():
    p = np.geomspace(1e3, 1e6, 30)
    gaps = gap_distribution(p, named_surface("paper_reference"), skin=WET)
    assert np.all(np.diff(gaps.contact_fraction) > 0)
    assert np.all(np.diff(gaps.cumulative(np.array([1e-7, 1e-6, 1e-5])), axis=0) > 0)


def test_without_correction_the_area_is_plain():
    surface, p = named_surface("paper_reference"), np.array([2e3, 2e4])
    plain = gap_distribution(p, surface, skin=WET, area_correction=1.0)
    np.testing.assert_allclose(
        plain.contact_fraction, persson_contact_area(p, twice_stress_variance(surface, WET)), rtol=1e-6
    )


def test_only_ratios_of_pressures_and_of_lengths_matter():
    roughness, skin, reach = random_parameters(10, 3)
    surface, (e0, e1, nu0, nu1, d) = surface_from(roughness), skin
    p = (reach * np.sqrt(twice_stress_variance(surface, skin_from(skin))))[:, None]
    first = gap_distribution(p, surface, skin=skin_from(skin))
    at = first.mean[..., None] * SHARES
    stiffer = gap_distribution(7 * p, surface, skin=skin_from((7 * e0, 7 * e1, nu0, nu1, d)))
    h, hurst, q0, q_r, q1 = roughness
    larger = gap_distribution(
        p,
        surface_from((3 * h, hurst, q0 / 3, q_r / 3, q1 / 3)),
        skin=skin_from((e0, e1, nu0, nu1, 3 * d)),
    )
    np.testing.assert_allclose(stiffer.cumulative(at), first.cumulative(at), atol=1e-9)
    np.testing.assert_allclose(larger.cumulative(3 * at), first.cumulative(at), atol=1e-9)


def test_gaps_of_contacts_at_full_load_are_closed():
    surface = named_surface("paper_reference")
    for p in (12 * np.sqrt(twice_stress_variance(surface, WET)), 1e12):
        pressed = gap_distribution(p, surface, skin=WET)
        assert pressed.cumulative(1e-9) == 1 and pressed.film(1e-6) == pytest.approx(0, abs=1e-20)


@pytest.mark.parametrize(("closure", "step"), [("gaussian", 2e-3), ("sharp", 3e-4)])  # its bells are narrow
@pytest.mark.parametrize("seed", range(3))
def test_no_kinks_along_lines_through_the_parameters(closure, step, seed):
    rng = np.random.default_rng(seed)
    along = step * np.arange(300)
    start = [2e-5, 0.7, 1e3, 5e3, 1e9], [7e6, 2e4, 0.4, 0.4, 2e-5]
    directions = rng.uniform(-0.3, 0.3, 5), rng.uniform(-0.5, 0.2, 5)
    directions[0][2:4] = np.sort(directions[0][2:4])
    surface = surface_from(x * np.exp(a * along) for x, a in zip(start[0], directions[0], strict=True))
    skin = skin_from(x * np.exp(a * along) for x, a in zip(start[1], directions[1], strict=True))
    gaps = gap_distribution(
        (7e3 * np.exp(along))[:, None], surface, skin=skin, area_correction=0.42, closure=closure
    )
    for values in (*gaps.cumulative([1e-7, 3e-6, 1e-5])[:, 0].T, *gaps.film([3e-6, 1e-5])[:, 0].T / 1e-5):
        slope = np.diff(values) / step
        assert np.abs(np.diff(slope, 2)).max() < 1e-3 * np.abs(values).max()


def identical(a, b):
    return np.array_equal(np.asarray(a), np.asarray(b), equal_nan=True)


@pytest.mark.parametrize("closure", ["gaussian", "sharp"])
def test_batch_and_rows_agree_to_the_last_bit(closure):
    roughness, skin, _ = random_parameters(9, 4)
    gamma, p, d = np.linspace(0.3, 1, 9), np.geomspace(1e3, 1e6, 7), np.geomspace(1e-8, 1e-4, 5)
    whole = gap_distribution(
        p, surface_from(roughness), skin=skin_from(skin), area_correction=gamma, closure=closure
    )
    for i in range(9):
        surface, one = surface_from(x[i] for x in roughness), skin_from(x[i] for x in skin)
        row, alone = (
            gap_distribution(load, surface, skin=one, area_correction=gamma[i], closure=closure)
            for load in (p, p[3])
        )
        for name in ("mean", "contact_fraction", "location", "width", "weight"):
            assert identical(getattr(row, name), getattr(whole, name)[i])
            assert identical(getattr(alone, name), getattr(whole, name)[i, 3])
        for name in ("cumulative", "film", "mean_below"):
            assert identical(getattr(row, name)(d), getattr(whole, name)(d)[i])
            assert identical(getattr(alone, name)(d[2]), getattr(whole, name)(d)[i, 3, 2])


def test_table_and_closed_spectrum_agree():
    surface = named_surface("paper_reference")
    q = np.union1d(np.geomspace(1e3, 1e9, 60), [surface.wavevector_rolloff])
    table = TabulatedSpectrum(q, surface.power(q), scale=np.array([1.0, 4.0]))
    closed = surface_from((22.4e-6 * np.array([1.0, 2.0]), 0.78, 1e3, 6.345e3, 1e9))
    p, d = np.geomspace(1e3, 1e6, 5), np.geomspace(1e-7, 1e-4, 20)
    found = gap_distribution(p, table, skin=WET)
    np.testing.assert_allclose(
        found.cumulative(d), gap_distribution(p, closed, skin=WET).cumulative(d), atol=5e-3
    )
    np.testing.assert_allclose(found.film(np.inf), found.mean, rtol=1e-12)


def test_the_closures_differ_where_the_paper_needs_it():
    # film at which the paper finds the largest attraction: 6 to 9 µm; a Gaussian scatter of gaps fills sooner
    surface = named_surface("paper_reference")
    broad, sharp = (
        gap_distribution(9.6e3, surface, skin=WET, area_correction=0.42, closure=closure)
        for closure in ("gaussian", "sharp")
    )
    assert broad.cumulative(5e-6) > 2 * sharp.cumulative(5e-6)
    assert broad.mean == sharp.mean


def test_shapes_nan_and_messages():
    surface = surface_from((np.array([[1e-5], [-1e-5], [2e-5]]), 0.8, 1e3, 1e4, 1e9))
    skin = LayeredSkin(
        young_modulus_layer=np.array([[7e6, 1e9]]), young_modulus_bulk=2e4, layer_thickness=2e-5
    )
    gaps = gap_distribution([7e3, 1e4, 2e4, -1.0], surface, skin=skin)
    assert gaps.mean.shape == gaps.contact_fraction.shape == (3, 2, 4)
    assert gaps.cumulative(1e-6).shape == (3, 2, 4) and gaps.film([1e-6, 2e-6]).shape == (3, 2, 4, 2)
    bad = np.isnan(gaps.cumulative(1e-6))
    assert bad[1].all() and bad[..., 3].all() and not bad[[0, 2], :, :3].any()
    assert np.isnan(gaps.cumulative(-1e-6)).all()
    single = gap_distribution(7e3, named_surface("paper_reference"), skin=WET)
    assert np.ndim(single.mean) == np.ndim(single.cumulative(1e-6)) == 0
    with pytest.raises(InputError, match="closure is 'exact', but must be one of 'gaussian', 'sharp'"):
        gap_distribution(7e3, named_surface("paper_reference"), skin=WET, closure="exact")
