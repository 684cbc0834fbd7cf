"""Digests that tell whether two problems are the same."""

from __future__ import annotations

import hashlib
import json

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.files.dataset import Dataset
from skinbayes.files.modelfile import ModelSpec
from skinbayes.files.parameter_block import ParameterSpec
from skinbayes.roughness import TabulatedSpectrum


def digest_data(
    spec: ModelSpec, dataset: Dataset | None, observed: FloatArray | None, spread: FloatArray | None
) -> str:
    """Digest of the data alone: values, labels, spread and which column is explained."""
    digest = hashlib.sha256()
    if dataset is not None and observed is not None and spread is not None:
        digest.update(json.dumps([spec.observable, list(dataset.columns)]).encode())
        for column in dataset.columns.values():
            digest.update(column.astype(str).tobytes() if column.dtype.kind == "U" else column.tobytes())
        digest.update(spread.tobytes())
    return digest.hexdigest()


def digest_model(
    spec: ModelSpec,
    free: tuple[ParameterSpec, ...],
    fixed: tuple[ParameterSpec, ...],
    table: TabulatedSpectrum | None,
    data_digest: str,
) -> str:
    """Digest of everything the posterior depends on; comments and titles do not enter."""
    from skinbayes import __version__

    content = {
        "version": __version__,
        "forward": spec.forward,
        "observable": spec.observable,
        "noise": spec.noise,
        "free": [(p.by, p.label, repr(p.prior)) for p in free],
        "fixed": sorted((str(p.by), p.label, repr(p.value)) for p in fixed),
        "data": data_digest,
        "table": None if table is None else [
            table.wavevector.tolist(), table.node_power.tolist(), np.asarray(table.scale).tolist()
        ],
    }  # fmt: skip
    return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()
