"""One block of steps of all ensembles as an HDF5 file with a checksum."""

from __future__ import annotations

import hashlib
import io
from collections.abc import Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from skinbayes.sampling.advance import EnsembleSteps
from skinbayes.sealed import DamagedFile, checked, sealed

_STATE_WORDS = 624
"""Length of the state of the Mersenne Twister."""

_KINDS = {
    "positions": np.float64,
    "log_density": np.float64,
    "generator_key": np.uint32,
    "generator_position": np.int64,
    "generator_has_gauss": np.int64,
    "generator_cached_gaussian": np.float64,
    "evaluations": np.int64,
    "invalid": np.int64,
    "first_invalid": np.float64,
}
"""The arrays of a segment; their first axis is the ensemble."""


class OtherRun(ValueError):
    """A segment is whole, but of another run."""


def segment_image(blocks: list[EnsembleSteps], identity: str, before: list[EnsembleSteps] | None) -> bytes:
    """The content of a segment file. It is made in memory: HDF5 does not survive a disk that is full.

    Parameters
    ----------
    blocks : one an ensemble
    identity : digest of what the draws of the run depend on
    before : the blocks of the segment before this one, None for the first
    """
    import h5py

    image = io.BytesIO()
    with h5py.File(image, "w") as file:
        file.attrs["identity"] = identity
        file.attrs["follows"] = _digest(before)
        for name, values in _arrays(blocks).items():
            file.create_dataset(name, data=values)
    return sealed(image.getvalue())


def read_segment(path: Path, identity: str, before: list[EnsembleSteps] | None) -> list[EnsembleSteps]:
    """The blocks of a segment file.

    Parameters
    ----------
    path : the file
    identity, before : as in :func:`segment_image`

    Raises
    ------
    DamagedFile
        It is not what was written, or does not follow ``before``.
    OtherRun
        It is whole, but of a run with another identity.
    PermissionError
        It must not be read.
    """
    import h5py

    try:
        checked(path)
        with h5py.File(path, "r", locking=False) as file:
            found, follows = str(file.attrs["identity"]), str(file.attrs["follows"])
            arrays = _read(file) if found == identity and follows == _digest(before) else {}
    except (DamagedFile, PermissionError):
        raise
    except Exception as error:  # HDF5 raises errors of many types about a file that was made to confuse it
        raise DamagedFile(f"{error}") from error
    if found != identity:
        raise OtherRun
    if not arrays:
        raise DamagedFile("it does not follow the steps before it")
    return _blocks(arrays)


def _digest(blocks: list[EnsembleSteps] | None) -> str:
    """Digest of everything in the blocks, by which the next segment knows what it follows."""
    digest = hashlib.sha256()
    for name, values in _arrays(blocks or []).items():
        digest.update(name.encode() + values.tobytes())
    return digest.hexdigest()


def _read(file: Mapping[str, object]) -> dict[str, NDArray[np.generic]]:
    """The arrays; types and sizes are looked at first, because a file may declare more than it holds."""
    import h5py

    shapes: dict[str, tuple[int, ...]] = {}
    for name, kind in _KINDS.items():
        item = file[name]
        if not (isinstance(item, h5py.Dataset) and item.dtype == kind and item.shape):
            raise DamagedFile(f"'{name}' is not as this version writes it")
        if item.id.get_storage_size() != item.nbytes:
            raise DamagedFile(f"'{name}' declares more than it holds")
        shapes[name] = item.shape
    ensembles, steps, walkers, dimension = shapes["positions"]
    expected = {
        **dict.fromkeys(_KINDS, (ensembles,)),
        "positions": (ensembles, steps, walkers, dimension),
        "log_density": (ensembles, steps, walkers),
        "generator_key": (ensembles, _STATE_WORDS),
        "first_invalid": (ensembles, dimension),
    }
    if shapes != expected or not all(shapes["positions"]):
        raise DamagedFile("its arrays do not belong together")
    return {name: np.asarray(file[name]) for name in _KINDS}


def _arrays(blocks: list[EnsembleSteps]) -> dict[str, NDArray[np.generic]]:
    """The blocks of all ensembles as arrays whose first axis is the ensemble; none for no blocks."""
    if not blocks:
        return {}
    states = list(zip(*(block.random_state for block in blocks), strict=True))[1:]
    values = dict(zip((name for name in _KINDS if name.startswith("generator_")), states, strict=True))
    values |= {name: tuple(getattr(block, name) for block in blocks) for name in _KINDS if name not in values}
    return {name: np.array(values[name], dtype=kind) for name, kind in _KINDS.items()}


def _blocks(arrays: Mapping[str, NDArray[np.generic]]) -> list[EnsembleSteps]:
    """The inverse of :func:`_arrays`."""
    return [
        EnsembleSteps(
            positions=arrays["positions"][index],
            log_density=arrays["log_density"][index],
            random_state=(
                "MT19937",
                arrays["generator_key"][index],
                int(arrays["generator_position"][index]),
                int(arrays["generator_has_gauss"][index]),
                float(arrays["generator_cached_gaussian"][index]),
            ),
            evaluations=int(arrays["evaluations"][index]),
            invalid=int(arrays["invalid"][index]),
            first_invalid=arrays["first_invalid"][index],
        )
        for index in range(len(arrays["positions"]))
    ]
