"""The steps of a run on disk, safe against being killed at any moment.

A store is a directory with one small header and one HDF5 file for each block of steps. A file is written under a
temporary name, forced to disk and then renamed, and never touched again: at any moment the directory holds a
complete run up to some block.
"""

from __future__ import annotations

import hashlib
import io
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from skinbayes.atomic import PARTIAL, write_atomically
from skinbayes.errors import FingerprintMismatch, InputError, cannot_write
from skinbayes.sampling.advance import Block
from skinbayes.sampling.watched import WatchedDirectory

HEADER = "header.json"
FORMAT = 1


class SampleStore:
    """A directory that keeps the blocks of one run.

    Parameters
    ----------
    path : the directory; made when the first thing is written
    resume : continue what is there; without it a directory that holds a run is refused
    """

    def __init__(self, path: str | Path, resume: bool = False) -> None:
        self.path = Path(path)
        self._resume = resume
        self._header = b""
        self._digest = ""
        self._rounds: list[list[Block]] = []
        self._watched: WatchedDirectory | None = None

    def open(self, identity: Mapping[str, Any]) -> list[list[Block]]:
        """Claim the directory for a run, or take up the run it holds.

        Parameters
        ----------
        identity : everything the draws depend on, under names a user understands; values go through JSON

        Returns
        -------
        the blocks stored so far: for each, one :class:`Block` an ensemble

        Raises
        ------
        FingerprintMismatch
            If the directory holds a run with another identity; the parts that differ are named.
        InputError
            If it holds a run and this one was not to resume, or if a file is missing or damaged.
        """
        if self.path.exists() and not self.path.is_dir():
            raise InputError(f"{self.path}: a file found, a directory expected for the steps of a run.")
        wanted = json.loads(json.dumps(dict(identity)))
        self._digest = hashlib.sha256(json.dumps(wanted, sort_keys=True).encode()).hexdigest()
        self._header = (json.dumps({"format": FORMAT, "identity": wanted}, indent=2) + "\n").encode()
        for leftover in self.path.glob(f"*{PARTIAL}"):
            leftover.unlink(missing_ok=True)
        numbers = sorted(int(file.stem.removeprefix("segment-")) for file in self.path.glob("segment-*.h5"))
        header = self.path / HEADER
        if not header.exists():
            if numbers:
                raise InputError(
                    f"{header}: missing, though steps of a run are beside it. The run cannot be continued."
                )
            self._begin()
            return []
        if not self._resume:
            raise InputError(
                f"{self.path}: holds a run of {len(numbers)} blocks of steps already. "
                "Resume it, or give another directory."
            )
        self._compare(header, wanted)
        if numbers != list(range(1, len(numbers) + 1)):
            lost = min(set(range(1, len(numbers) + 1)) - set(numbers))
            raise InputError(
                f"{self._segment(lost)}: missing, though later steps are there. The run cannot be continued."
            )
        self._rounds = [self._read(self._segment(number), wanted) for number in numbers]
        self._watched = WatchedDirectory(self.path)
        return list(self._rounds)

    @property
    def has_steps(self) -> bool:
        """Whether there are steps, on disk or, if that failed, in memory."""
        return bool(self._rounds)

    def append(self, blocks: list[Block]) -> None:
        """Add the next block of every ensemble; on return it is on disk, as are all before it.

        Raises
        ------
        FolderGone
            The directory is no longer where it was; nothing is made in its place.
        MachineError
            It cannot be written, because the disk is full for example.
        """
        self._rounds.append(blocks)
        self.complete()

    def complete(self) -> None:
        """Write every file of the run that is not there, as when somebody removed it; raises as :meth:`append` does."""
        if self._watched is None:
            return
        try:
            self._watched.check()
            names = {file.name for file in self.path.iterdir()}
        except OSError as error:
            raise cannot_write(self.path, error) from error
        if HEADER not in names:
            self._publish(self.path / HEADER, self._header)
        for number, blocks in enumerate(self._rounds, start=1):
            target = self._segment(number)
            if target.name not in names:
                self._publish(target, self._image(blocks))

    def copy_to(self, path: Path) -> SampleStore:
        """Write the run once more, into a directory that holds none."""
        copy = SampleStore(path)
        copy._header, copy._digest, copy._rounds = self._header, self._digest, self._rounds
        copy._begin()
        copy.complete()
        return copy

    def _begin(self) -> None:
        try:
            self.path.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise cannot_write(self.path, error, begun=False) from error
        self._publish(self.path / HEADER, self._header)
        self._watched = WatchedDirectory(self.path)

    def _segment(self, number: int) -> Path:
        return self.path / f"segment-{number:06d}.h5"

    def _compare(self, header: Path, wanted: dict[str, Any]) -> None:
        try:
            content = json.loads(header.read_text(encoding="utf-8"))
            stored, version = content["identity"], content["format"]
        except (OSError, ValueError, KeyError, TypeError) as error:
            raise InputError(f"{header}: cannot be read ({error}). The run cannot be continued.") from error
        if version != FORMAT:
            raise InputError(f"{header}: store format {version!r} found, {FORMAT} expected.")
        differing = [key for key in {**stored, **wanted} if stored.get(key) != wanted.get(key)]
        if differing:
            parts = "; ".join(
                f"{key} is {stored.get(key)!r} there and {wanted.get(key)!r} here" for key in differing
            )
            raise FingerprintMismatch(
                f"{self.path}: holds a run that cannot be continued with these settings: {parts}. "
                "Use the same model, data and settings, or another directory."
            )

    def _publish(self, target: Path, content: bytes) -> None:
        try:
            write_atomically(target, content)
        except OSError as error:
            if self._watched is not None:
                self._watched.check()
            raise cannot_write(target, error) from error

    def _image(self, blocks: list[Block]) -> bytes:
        """The content of a segment. It is made in memory, because HDF5 does not survive a full disk."""
        import h5py

        image = io.BytesIO()
        with h5py.File(image, "w") as file:
            file.attrs["identity"] = self._digest
            for name, values in _arrays(blocks).items():
                # Checksums make a damaged file an error when it is read.
                file.create_dataset(name, data=values, chunks=values.shape, fletcher32=True)
        return image.getvalue()

    def _read(self, path: Path, identity: Mapping[str, Any]) -> list[Block]:
        import h5py

        try:
            with h5py.File(path, "r", locking=False) as file:
                digest = file.attrs["identity"]
                arrays = {name: file[name][()] for name in _ARRAYS}
        except (OSError, KeyError, ValueError, RuntimeError) as error:
            raise InputError(f"{path}: damaged ({error}). The run cannot be continued.") from error
        if digest != self._digest:
            raise FingerprintMismatch(f"{path}: belongs to another run than the {HEADER} beside it.")
        return _blocks(arrays)


_ARRAYS = (
    "positions",
    "log_density",
    "generator_key",
    "generator_position",
    "generator_has_gauss",
    "generator_cached_gaussian",
    "evaluations",
    "invalid",
    "first_invalid",
)


def _arrays(blocks: list[Block]) -> dict[str, np.ndarray]:
    """The blocks of all ensembles as arrays whose first axis is the ensemble."""
    states = [block.random_state for block in blocks]
    return {
        "positions": np.stack([block.positions for block in blocks]),
        "log_density": np.stack([block.log_density for block in blocks]),
        "generator_key": np.array([state[1] for state in states], dtype=np.uint32),
        "generator_position": np.array([state[2] for state in states], dtype=np.int64),
        "generator_has_gauss": np.array([state[3] for state in states], dtype=np.int64),
        "generator_cached_gaussian": np.array([state[4] for state in states], dtype=np.float64),
        "evaluations": np.array([block.evaluations for block in blocks], dtype=np.int64),
        "invalid": np.array([block.invalid for block in blocks], dtype=np.int64),
        "first_invalid": np.stack([block.first_invalid for block in blocks]),
    }


def _blocks(arrays: Mapping[str, np.ndarray]) -> list[Block]:
    """The inverse of :func:`_arrays`."""
    return [
        Block(
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
