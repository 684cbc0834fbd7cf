"""Elastic and plastic contact area against a diffusion solver, decimal arithmetic and limits."""

import itertools
from decimal import Decimal, getcontext

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad, solve_ivp
from scipy.linalg import solve_banded
from scipy.special import erf, erfc

from skinbayes.contact import (
    LayeredSkin,
    effective_modulus,
    elastoplastic_contact_area,
    relative_contact_area,
    total_contact_area,
    twice_stress_variance,
)
from skinbayes.contact.elastoplastic import _fourier, _images
from skinbayes.roughness import named_surface


def diffuse_between_walls(ratio, spreads, cells=2000):
    """Finite volumes, Crank–Nicolson, for ∂P/∂V = ¼ ∂²P/∂σ² with P = 0 at 0 and at 1 (σ in units of σ_Y).

    Returns rows (elastic, plastic, lost, load carried elastically) at each spread √V.
    """
    h = 1 / cells
    sigma = h * (np.arange(cells) + 0.5)
    start = (min(ratio, 1 - ratio) / 8) ** 2
    density = np.exp(-((sigma - ratio) ** 2) / start) / np.sqrt(np.pi * start)
    density /= density.sum() * h
    now, plastic, lost, rows = start, 0.0, 0.0, []
    for spread in spreads:
        for following in np.geomspace(now, spread**2, 500)[1:]:
            r = (following - now) / 8 / h**2
            band = np.array([np.full(cells, -r), np.full(cells, 1 + 2 * r), np.full(cells, -r)])
            band[1, [0, -1]] += r
            right = (1 - 2 * r) * density
            right[[0, -1]] -= r * density[[0, -1]]
            right[1:] += r * density[:-1]
            right[:-1] += r * density[1:]
            before, density = density, solve_banded((1, 1), band, right)
            flux = 2 * r * h * (before + density)  # through a wall half a cell away
            lost, plastic, now = lost + flux[0], plastic + flux[-1], following
        rows.append((density.sum() * h, plastic, lost, (sigma * density).sum() * h))
    return np.array(rows)


@pytest.mark.parametrize("ratio", [0.05, 0.3, 0.8])
def test_parts_are_what_the_diffusion_of_stress_leaves(ratio):
    spreads = np.array([0.25, 0.5, 0.8, 1.3])
    rows = diffuse_between_walls(ratio, spreads)
    area = elastoplastic_contact_area(ratio, spreads**2, yield_stress=1.0, area_correction=1.0)
    np.testing.assert_allclose(area.elastic, rows[:, 0], rtol=2e-4)
    np.testing.assert_allclose(area.plastic, rows[:, 1], rtol=2e-3, atol=1e-7)
    np.testing.assert_allclose(area.non_contact, rows[:, 2], rtol=2e-3, atol=1e-7)
    # what the surviving stresses carry and what the yielded area carries is the load
    np.testing.assert_allclose(rows[:, 3] + area.plastic, ratio, rtol=1e-4)


@pytest.mark.parametrize("ratio", [1e-6, 0.01, 0.4, 0.97])
@pytest.mark.parametrize("spread", [0.03, 0.3, 0.74, 0.76, 2.0])
def test_load_is_conserved(ratio, spread):
    # the stress distribution as eigenfunctions of the strip: P(σ) = 2 Σ sin(nπr) sin(nπσ) exp(−(nπs)²/4)
    n = np.arange(1, 400)
    modes = np.sin(n * np.pi * ratio) * np.exp(-((n * np.pi * spread) ** 2) / 4)
    carried = 2 * np.sum(modes * -((-1.0) ** n) / (n * np.pi))
    area = elastoplastic_contact_area(ratio, spread**2, yield_stress=1.0, area_correction=1.0)
    assert carried + area.plastic == pytest.approx(ratio, rel=1e-11)


def decimal_erfc(x):
    """1 − erf(x) by the power series, in the precision of the context; nothing beyond 20, where it is below 1e-175."""
    if x > 20:
        return Decimal(0)
    term = total = x
    k = 0
    while k < 5 or abs(term) > Decimal(10) ** (-getcontext().prec):
        k += 1
        term *= -x * x / k
        total += term / (2 * k + 1)
    return 1 - 2 * total / PI.sqrt()


PI = Decimal(
    "3.14159265358979323846264338327950288419716939937510582097494459230781640628620899862803482534211706798214808651328"
    "2306647093844609550582231725359408128481117450284102701938521105559644622948954930381964428810975665933446128475648"
    "2337867831652712019091456485669234603486104543266482133936072602491412737245870066063155881748815209209628292540917"
)


def exact_parts(ratio, spread):
    """Elastic and plastic part by image sources, without thought for cancellation."""
    getcontext().prec = 330
    r, s = Decimal(ratio), Decimal(spread)

    def difference(k):
        return decimal_erfc((k - r) / s) - decimal_erfc((k + r) / s)

    terms = {k: difference(k) for k in range(1, 17)}
    elastic = 1 - decimal_erfc(r / s) + sum((-1) ** k * d for k, d in terms.items())
    return float(elastic), float(sum(d for k, d in terms.items() if k % 2))


@pytest.mark.parametrize("ratio", [1e-12, 1e-5, 3e-3, 0.2, 0.5, 0.9, 1 - 1e-7])
@pytest.mark.parametrize("spread", [0.06, 0.2, 0.5, 0.74, 0.76, 1.1])
def test_both_parts_keep_their_relative_accuracy(ratio, spread):
    elastic, plastic = exact_parts(ratio, spread)
    # γ = 1, so that V_eff = V; s² is chosen first and its root taken by the function under test
    area = elastoplastic_contact_area(ratio, spread * spread, yield_stress=1.0, area_correction=1.0)
    if elastic > 1e-250:
        assert area.elastic == pytest.approx(elastic, rel=1e-12, abs=0)
    if plastic > 1e-250:
        assert area.plastic == pytest.approx(plastic, rel=1e-12, abs=0)
    total = total_contact_area(ratio, spread * spread, yield_stress=1.0, area_correction=1.0)
    assert total == pytest.approx(elastic + plastic, rel=1e-12, abs=0)


def test_both_parts_together_alone_are_the_sum_of_both():
    rng = np.random.default_rng(2)
    pressure, limit = np.exp(rng.uniform(0, 18, (2, 400)))
    spread = np.exp(rng.uniform(-4, 4, 400)) * limit
    gamma = rng.uniform(0.2, 1.0, 400)
    pressure[:3], limit[3:6], spread[6] = (0.0, np.nan, -1.0), (np.inf, -1.0, 0.0), np.nan
    square = np.square(spread)
    both = total_contact_area(pressure, square, yield_stress=limit, area_correction=gamma)
    parts = elastoplastic_contact_area(pressure, square, yield_stress=limit, area_correction=gamma)
    np.testing.assert_allclose(both, parts.total, rtol=1e-12)
    assert np.isnan(both[[1, 2, 4, 5, 6]]).all() and np.isfinite(both[7:]).all()
    for i in range(0, 400, 40):  # a batch and its rows
        one = total_contact_area(pressure[i], square[i], yield_stress=limit[i], area_correction=gamma[i])
        assert one == both[i] or np.isnan(both[i])


def test_both_series_agree_where_both_converge():
    ratio, spread = (
        x.reshape(-1) for x in np.meshgrid([1e-9, 1e-3, 0.3, 0.5, 0.8, 0.999], np.linspace(0.6, 1.2, 13))
    )
    for one, other in zip(
        _fourier(ratio, spread, ratio / spread), _images(ratio, spread, ratio / spread), strict=True
    ):
        np.testing.assert_allclose(one, other, rtol=1e-12)


def test_elastic_limit():
    pressure, twice_variance = np.array([10.0, 1e3, 6830.0]), np.array([1e4, 1e12, 3e14])
    hard = elastoplastic_contact_area(pressure, twice_variance, yield_stress=np.inf)
    np.testing.assert_allclose(hard.elastic, relative_contact_area(pressure, twice_variance), rtol=1e-15)
    assert np.all(hard.plastic == 0)
    np.testing.assert_allclose(hard.total + hard.non_contact, 1.0, rtol=1e-14)
    nearly = elastoplastic_contact_area(pressure, twice_variance, yield_stress=1e12)
    np.testing.assert_allclose(nearly.elastic, hard.elastic, rtol=1e-13)


def test_plastic_limit_carries_the_load_at_the_yield_stress():
    area = elastoplastic_contact_area([1.0, 500.0, 6830.0], 1e22, yield_stress=5e7)
    np.testing.assert_allclose(area.plastic, np.array([1.0, 500.0, 6830.0]) / 5e7, rtol=1e-13)
    assert np.all(area.elastic < 1e-100)
    np.testing.assert_allclose(area.plastic_fraction, 1.0, rtol=1e-15)


def test_smooth_surface_touches_everywhere_and_does_not_yield():
    area = elastoplastic_contact_area(1.0, 0.0, yield_stress=[2.0, np.inf])
    assert np.all(area.elastic == 1) and np.all(area.plastic == 0) and np.all(area.non_contact == 0)


def test_pressure_at_and_above_the_yield_stress_is_full_plastic_contact():
    area = elastoplastic_contact_area([1.0, 2.0], [0.3, 1e9], yield_stress=1.0)
    assert np.all(area.plastic == 1) and np.all(area.elastic == 0) and np.all(area.non_contact == 0)
    below = elastoplastic_contact_area(1 - 1e-9, 0.3, yield_stress=1.0)
    assert below.plastic == pytest.approx(1.0, abs=1e-8)


def test_no_load_no_contact():
    area = elastoplastic_contact_area(0.0, 1.0, yield_stress=[0.5, 5.0, np.inf])
    assert np.all(area.total == 0) and np.all(np.isnan(area.plastic_fraction))
    np.testing.assert_allclose(area.non_contact, 1.0, rtol=1e-14)


def test_impossible_arguments_give_nan():
    area = elastoplastic_contact_area(
        [-1.0, 1.0, 1.0, 1.0, np.nan, 1.0],
        [1.0, -1.0, 1.0, 1.0, 1.0, np.nan],
        yield_stress=[1.0, 1.0, -1.0, 0.0, 1.0, 1.0],
    )
    assert np.isnan([area.elastic, area.plastic, area.non_contact]).all()
    assert np.isnan(elastoplastic_contact_area(1.0, 1.0, yield_stress=3.0, area_correction=1.5).total)


@given(st.floats(1e-12, 0.999999), st.floats(1e-3, 30.0))
def test_parts_sum_to_one_and_stay_in_range(ratio, spread):
    area = elastoplastic_contact_area(ratio, spread**2, yield_stress=1.0, area_correction=1.0)
    for part in (area.elastic, area.plastic, area.non_contact):
        assert 0 <= part <= 1 + 1e-14
    assert area.elastic + area.plastic + area.non_contact == pytest.approx(1.0, abs=1e-13)


@given(st.floats(1e-9, 0.9), st.floats(1e-2, 10.0), st.floats(1.01, 3.0))
def test_more_roughness_means_less_elastic_and_more_plastic_area(ratio, spread, factor):
    area = elastoplastic_contact_area(
        ratio, [spread**2, (factor * spread) ** 2], yield_stress=1.0, area_correction=1.0
    )
    assert area.elastic[1] <= area.elastic[0] * (1 + 1e-12)
    assert area.plastic[1] >= area.plastic[0] * (1 - 1e-12)


def test_batch_and_rows_agree_to_the_last_bit():
    rng = np.random.default_rng(11)
    pressure = np.exp(rng.uniform(0, 12, (37, 1)))
    twice_variance = np.exp(rng.uniform(0, 45, (37, 6)))
    limit = np.append(np.exp(rng.uniform(8, 20, 36)), np.inf)[:, None]
    whole = elastoplastic_contact_area(pressure, twice_variance, yield_stress=limit)
    for i in range(37):
        row = elastoplastic_contact_area(pressure[i], twice_variance[i], yield_stress=limit[i])
        assert all(np.array_equal(a, b[i]) for a, b in zip(row, whole, strict=True))
        for j in range(6):
            alone = elastoplastic_contact_area(pressure[i, 0], twice_variance[i, j], yield_stress=limit[i, 0])
            assert all(a == b[i, j] for a, b in zip(alone, whole, strict=True))


@pytest.mark.parametrize("upper", [5e4, 9e4, 1.05e5, 2e5])
@pytest.mark.parametrize("gamma", [1.0, 0.42])
def test_dry_skin_from_the_spectrum_to_the_plastic_fraction(upper, gamma):
    """The whole chain written again: quad, an ODE for the correction, image sources as they stand."""
    surface, pressure, limit = named_surface("paper_reference"), 6830.0, 50e6
    skin = LayeredSkin(young_modulus_layer=1e9, young_modulus_bulk=20e3, layer_thickness=20e-6)

    def rate(t):
        q = np.exp(t)
        return np.pi * q**4 * surface.power(q) * effective_modulus(skin, q) ** 2

    edges = np.log([1e3, 6.345e3, 3e4, upper])
    twice_variance = sum(quad(rate, a, b, epsabs=0, epsrel=1e-10)[0] for a, b in itertools.pairwise(edges))
    solved = solve_ivp(
        lambda x, y: np.exp(x) * (gamma + (1 - gamma) * erf(pressure * np.exp(-y / 2)) ** 2) / np.exp(y),
        (np.log(1e4), np.log(twice_variance)),
        [np.log(1e4)],
        rtol=1e-11,
        atol=1e-12,
        method="DOP853",
    )
    r, s = pressure / limit, np.exp(solved.y[0, -1] / 2) / limit
    k = np.arange(1, 12)
    d = erfc((k - r) / s) - erfc((k + r) / s)
    elastic, plastic = erf(r / s) + np.sum((-1.0) ** k * d), np.sum(d[::2])
    area = elastoplastic_contact_area(
        pressure,
        twice_stress_variance(surface, skin, wavevector=upper),
        yield_stress=limit,
        area_correction=gamma,
    )
    assert area.elastic == pytest.approx(
        elastic, rel=1e-6, abs=1e-8 if s > 1 else 0
    )  # images cancel when s > 1
    assert area.plastic == pytest.approx(plastic, rel=1e-4)
    assert area.plastic_fraction == pytest.approx(plastic / (elastic + plastic), rel=1e-4)
