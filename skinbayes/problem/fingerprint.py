"""Digests that tell whether two problems are the same, computed from what the problems are."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from skinbayes.arrays import FloatArray
from skinbayes.files.dataset import Dataset
from skinbayes.files.modelfile import ModelSpec
from skinbayes.files.parameter_block import ParameterSpec
from skinbayes.forward import ForwardModel, Tables
from skinbayes.problem.inputs import Conditions
from skinbayes.problem.observations import Observation
from skinbayes.problem.shared_scatter import SharedScatter
from skinbayes.problem.surface_prior import SurfacePrior
from skinbayes.roughness import TabulatedSpectrum
from skinbayes.statistics.groups import CrossedGroups
from skinbayes.statistics.noise import NoiseFamily


def digest_data(dataset: Dataset | None, observations: Sequence[Observation]) -> str:
    """Digest of the data alone: values, labels, spread and which columns are explained."""
    return _digest(
        {
            "observed": [[o.name, _array(o.values), _array(o.spread)] for o in observations],
            "columns": _arrays(dataset.columns) if dataset is not None and observations else {},
        }
    )


def digest_model(
    spec: ModelSpec,
    forward: ForwardModel,
    parameters: Sequence[ParameterSpec],
    conditions: Conditions,
    observations: Sequence[Observation],
    input_spread: Mapping[str, FloatArray],
    groups: CrossedGroups | None,
    correlated: SharedScatter | None,
    tables: Tables,
    data_digest: str,
    surface: SurfacePrior | None = None,
) -> str:
    """Digest of everything the posterior depends on; comments and titles do not enter."""
    from skinbayes.version import __version__

    table = tables.spectrum
    tied = sorted((str(p.by), p.label, str(p.same_as), repr(p.times)) for p in parameters if p.same_as)
    populations = [
        [p.name, p.columns, None if p.contrast is None else p.contrast.reference] for p in spec.populations
    ]
    return _digest(
        {
            "version": __version__,
            "forward": [forward.name, _function(forward.evaluate)],
            "noise": [_noise(o.noise) for o in observations],
            "covariates": [[c.name, c.column, c.acts_on, repr(c.reference)] for c in spec.covariates],
            # the order of free parameters is that of the coordinates of a run
            "free": [(p.by, p.label, repr(p.prior)) for p in parameters if p.prior is not None],
            "fixed": sorted((str(p.by), p.label, repr(p.value)) for p in parameters if p.value is not None),
            **({"tied": tied} if tied else {}),
            **({"populations": populations} if populations else {}),
            "conditions": [_arrays(conditions.values), _arrays(conditions.covariates)],
            "labels": _arrays(conditions.labels),
            "input_spread": _arrays(input_spread),
            "groups": None if groups is None else [groups.columns, groups.levels, _array(groups.member)],
            **({} if correlated is None else {"correlated": _correlated(correlated)}),
            "data": data_digest,
            "spectrum": None if not isinstance(table, TabulatedSpectrum) else [
                _array(table.wavevector), _array(table.node_power), _array(table.scale)
            ],
            **({} if surface is None else {"surface": [surface.names, *map(_array, surface.map)]}),
            "flow_curves": [[_array(c.shear_rate), _array(c.measured_viscosity)] for c in tables.flow_curves or ()],
        }
    )  # fmt: skip


def _correlated(shared: SharedScatter) -> list[Any]:
    curves = [[_array(c.x), _array(c.level), c.n_nodes] for c in shared.scatter.curves]
    noise = shared.scatter.noise
    return [shared.parameters, curves, noise and [_array(noise.along), _array(noise.series)]]


def _noise(family: NoiseFamily) -> list[str]:
    return [family.name, _function(family.standard_log_density)]


def _function(function: Callable[..., Any]) -> str:
    """Where a function is defined, and with which options it is called."""
    if isinstance(function, partial):
        return f"{_function(function.func)} {function.args!r} {function.keywords!r}"
    return f"{function.__module__}.{function.__qualname__}"


def _digest(content: Mapping[str, Any]) -> str:
    return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()


def _arrays(columns: Mapping[str, NDArray[Any]]) -> dict[str, str]:
    return {name: _array(column) for name, column in columns.items()}


def _array(values: Any) -> str:
    array = np.ascontiguousarray(values)
    text = array.dtype.kind == "U"
    content = json.dumps(array.tolist()).encode() if text else array.astype(float).tobytes()
    return f"{array.shape} {hashlib.sha256(content).hexdigest()}"
