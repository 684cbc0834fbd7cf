"""The fingerprint is of what a problem is: no part of it can be changed behind its back."""

from __future__ import annotations

import pickle
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_array_equal
from small_models import finger, two_parameters

from skinbayes.errors import FingerprintMismatch
from skinbayes.fit import sample
from skinbayes.forward import forward_models
from skinbayes.problem import load_problem
from skinbayes.problem.simulated import with_data
from skinbayes.statistics import make_prior, noise_family

GROUPED = 'frictional_shear_stress = { lognormal = ["10 MPa", 1.0] }\nyoung_modulus_layer = "7 MPa"'
NOISE = 'family = "lognormal"\nnoise_scale = { half_normal = 0.5 }\n[groups.person]\nscale = { half_normal = 0.3 }'


def other_prior(problem):
    first, *others = problem.free
    return replace(problem, free=(replace(first, prior=make_prior("uniform", (1e6, 5e7))), *others))


def other_noise(problem):
    (observation,) = problem.observations
    return replace(problem, observations=(replace(observation, noise=noise_family("gaussian")),))


def other_spread(problem):
    (observation,) = problem.observations
    return replace(
        problem, observations=(replace(observation, spread=np.full_like(observation.values, 0.1)),)
    )


def other_conditions(problem):
    rows = problem.conditions
    values = {name: 1.01 * column for name, column in rows.values.items()}
    return replace(problem, conditions=replace(rows, values=values))


def other_value(problem):
    first, *others = problem.fixed
    return replace(problem, fixed=(replace(first, value=1.5 * first.value), *others))


CHANGES = {
    "prior": other_prior,
    "order of parameters": lambda problem: replace(problem, free=problem.free[::-1]),
    "fixed value": other_value,
    "data": lambda problem: with_data(problem, 1.01 * problem.observed),
    "spread": other_spread,
    "noise family": other_noise,
    "conditions": other_conditions,
    "forward model": lambda problem: replace(problem, forward=forward_models()["constant"]),
    "groups": lambda problem: replace(problem, groups=None),
    "spread of inputs": lambda problem: replace(problem, input_spread={"normal_force": np.full(11, 0.1)}),
}


@pytest.mark.parametrize("change", CHANGES)
def test_every_part_that_moves_the_posterior_moves_the_fingerprint(change, tmp_path):
    problem = finger(tmp_path, GROUPED, NOISE)
    changed = CHANGES[change](problem)
    assert changed.fingerprint != problem.fingerprint
    data_changed = change in ("data", "spread")
    assert (changed.data_fingerprint != problem.data_fingerprint) == data_changed


def test_the_same_problem_has_the_same_fingerprint(tmp_path):
    problem = finger(tmp_path, GROUPED, NOISE)
    assert replace(problem).fingerprint == finger(tmp_path, GROUPED, NOISE).fingerprint == problem.fingerprint
    assert with_data(problem, problem.observed).data_fingerprint == problem.data_fingerprint


def test_a_changed_parameter_is_evaluated_as_changed():
    """Where an input comes from follows from the parameters too, and is not kept from before."""
    problem = load_problem("forearm-glass")
    swapped = replace(problem, free=problem.free[::-1])
    theta = problem.prior_medians()
    assert_array_equal(swapped.predict_data(theta[::-1]), problem.predict_data(theta))


def test_a_run_of_other_priors_is_not_continued(tmp_path):
    problem = two_parameters(tmp_path)
    options = {"walkers": 16, "ensembles": 2, "max_steps": 100, "ess": 1e6, "importance": False}
    sample(problem, directory=tmp_path / "run", **options)
    with pytest.raises(FingerprintMismatch, match="another model, data, prior"):
        sample(other_prior(problem), directory=tmp_path / "run", resume=True, **options)


@pytest.mark.parametrize("name", forward_models())
def test_every_forward_model_has_an_identity(name, tmp_path):
    """Whatever way its function is made, it is told from the others and is the same in another process."""
    problem = two_parameters(tmp_path)
    fingerprint = replace(problem, forward=forward_models()[name]).fingerprint
    assert (fingerprint == problem.fingerprint) == (name == "friction")
    assert (
        pickle.loads(pickle.dumps(replace(problem, forward=forward_models()[name]))).fingerprint
        == fingerprint
    )
