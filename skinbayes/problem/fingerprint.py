"""Digests that tell whether two problems are the same."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Sequence

import numpy as np

from skinbayes.arrays import ArrayLike
from skinbayes.files.dataset import Dataset
from skinbayes.files.modelfile import ModelSpec
from skinbayes.files.parameter_block import ParameterSpec
from skinbayes.forward import Tables
from skinbayes.problem.observations import Observation
from skinbayes.roughness import TabulatedSpectrum


def digest_data(dataset: Dataset | None, observations: Sequence[Observation]) -> str:
    """Digest of the data alone: values, labels, spread and which columns are explained."""
    digest = hashlib.sha256()
    if dataset is not None and observations:
        digest.update(json.dumps([[o.name for o in observations], list(dataset.columns)]).encode())
        for column in dataset.columns.values():
            digest.update(column.astype(str).tobytes() if column.dtype.kind == "U" else column.tobytes())
        for observation in observations:
            digest.update(observation.spread.tobytes())
    return digest.hexdigest()


def digest_model(
    spec: ModelSpec,
    free: tuple[ParameterSpec, ...],
    fixed: tuple[ParameterSpec, ...],
    tables: Tables,
    data_digest: str,
) -> str:
    """Digest of everything the posterior depends on; comments and titles do not enter."""
    from skinbayes import __version__

    table = tables.spectrum
    content = {
        "version": __version__,
        "forward": spec.forward,
        "observables": spec.observables,
        "noise": spec.noise,
        "input_spread": spec.input_spread,
        "covariates": [[c.name, c.column, c.acts_on, repr(c.reference)] for c in spec.covariates],
        "free": [(p.by, p.label, repr(p.prior)) for p in free],
        "fixed": sorted((str(p.by), p.label, repr(p.value)) for p in fixed),
        "data": data_digest,
        "table": None if not isinstance(table, TabulatedSpectrum) else [
            table.wavevector.tolist(), table.node_power.tolist(), np.asarray(table.scale).tolist()
        ],
        "flow_curves": [[_list(c.shear_rate), _list(c.measured_viscosity)] for c in tables.flow_curves or ()],
    }  # fmt: skip
    return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()


def _list(values: ArrayLike) -> list[float]:
    found: list[float] = np.asarray(values, dtype=float).tolist()
    return found
