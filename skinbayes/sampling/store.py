"""The steps of a run on disk, safe against being killed at any moment.

A store is a directory with one small header and one HDF5 file for each block of steps. A file is written under a
temporary name, forced to disk and then renamed, and never touched again: at any moment the directory holds a
complete run up to some block. Every file has a checksum. What is damaged is put aside with what follows it: the same
steps are made again from those before.
"""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from skinbayes.atomic import PARTIAL, write_atomically
from skinbayes.errors import FingerprintMismatch, InputError, cannot_write, warn_of_repair
from skinbayes.sampling.advance import EnsembleSteps
from skinbayes.sampling.segments import OtherRun, read_segment, segment_image
from skinbayes.sampling.watched import WatchedDirectory
from skinbayes.sealed import DAMAGED, DamagedFile, content_digest, put_aside, read_note, sealed_note

HEADER = "header.json"
FORMAT = 2
FINGERPRINT = "model or data (fingerprint)"
"""Name of the target's fingerprint in the identity of a run."""

_SEGMENT = re.compile(r"segment-([0-9]{6})\.h5")


def stored_identity(path: Path) -> dict[str, Any] | None:
    """What the draws of a stored run depend on, None if there is no header.

    Parameters
    ----------
    path : the directory of a store

    Raises
    ------
    DamagedFile
        The header is not what was written.
    InputError
        It is of another version.
    """
    header = path / HEADER
    try:
        content = read_note(header)
    except FileNotFoundError:
        return None
    if content.get("format") != FORMAT:
        raise InputError(f"{header}: store format {content.get('format')!r:.20} found, {FORMAT} expected.")
    identity = content.get("identity")
    if not isinstance(identity, dict):
        raise DamagedFile("it does not say what the run is")
    return identity


def stored_fingerprint(path: Path) -> str | None:
    """Fingerprint of the target whose steps a directory holds, None if that cannot be told."""
    try:
        found = (stored_identity(path) or {}).get(FINGERPRINT)
    except DamagedFile:
        return None
    return found if isinstance(found, str) else None


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
        self._rounds: list[list[EnsembleSteps]] = []
        self._watched: WatchedDirectory | None = None

    def open(self, identity: Mapping[str, Any]) -> list[list[EnsembleSteps]]:
        """Claim the directory for a run, or take up the run it holds.

        Parameters
        ----------
        identity : everything the draws depend on, under names a user understands; values go through JSON

        Returns
        -------
        the blocks stored so far: for each, one :class:`EnsembleSteps` an ensemble

        Raises
        ------
        FingerprintMismatch
            If the directory holds a run with another identity; the parts that differ are named.
        InputError
                If it holds a run and this one was not to resume, or cannot be written.

        Warns
        -----
        RepairWarning
            Steps were damaged or missing: those before them are returned, those after them are put aside.
        """
        if self.path.exists() and not self.path.is_dir():
            raise InputError(f"{self.path}: a file found, a directory expected for the steps of a run.")
        wanted = json.loads(json.dumps(dict(identity)))
        self._digest = content_digest(wanted)
        self._header = sealed_note({"format": FORMAT, "identity": wanted})
        for leftover in self.path.glob(f"*{PARTIAL}"):
            leftover.unlink(missing_ok=True)
        segments = self._segments()
        header, trouble = self.path / HEADER, ""
        try:
            stored = stored_identity(self.path)
        except DamagedFile as error:
            stored, trouble = None, f"damaged ({error})"
        except PermissionError as error:
            raise InputError(f"{header}: cannot be read ({error.strerror}).") from error
        if (segments or stored is not None) and not self._resume:
            raise InputError(
                f"{self.path}: holds a run of {len(segments)} blocks of steps already. "
                "Resume it, or give another directory."
            )
        if stored is not None:
            self._compare(stored, wanted)
        self._rounds = self._read(segments)
        if stored is None:
            # the segments, too, know which run they belong to
            if header.exists():
                put_aside(header)
            elif segments:
                trouble = "missing"
            if trouble:
                warn_of_repair(f"{header}: {trouble}; written again.")
            self._begin()
        else:
            self._watched = WatchedDirectory(self.path)
        return list(self._rounds)

    @property
    def has_steps(self) -> bool:
        """Whether there are steps, on disk or, if that failed, in memory."""
        return bool(self._rounds)

    def append(self, blocks: list[EnsembleSteps]) -> None:
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
                before = self._rounds[number - 2] if number > 1 else None
                self._publish(target, segment_image(blocks, self._digest, before))

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

    def _segments(self) -> list[Path]:
        """What has the name of a segment, in order."""
        names = (file.name for file in self.path.iterdir()) if self.path.is_dir() else ()
        return [self.path / name for name in sorted(filter(_SEGMENT.fullmatch, names))]

    def _compare(self, stored: dict[str, Any], wanted: dict[str, Any]) -> None:
        differing = [key for key in {**stored, **wanted} if stored.get(key) != wanted.get(key)]
        if differing:
            parts = "; ".join(
                f"{key} is {stored.get(key)!r:.200} there and {wanted.get(key)!r:.200} here"
                for key in differing
            )
            raise FingerprintMismatch(
                f"{self.path}: holds a run that cannot be continued with these settings: {parts}. "
                "Use the same model, data and settings, or another directory."
            )

    def _read(self, segments: list[Path]) -> list[list[EnsembleSteps]]:
        """The blocks up to the first segment that is missing or damaged; the segments from there on are put aside."""
        rounds: list[list[EnsembleSteps]] = []
        for path in segments:
            expected = self._segment(len(rounds) + 1)
            try:
                if path != expected:
                    raise FileNotFoundError
                rounds.append(read_segment(path, self._digest, rounds[-1] if rounds else None))
                continue
            except FileNotFoundError:
                trouble = "missing"
            except DamagedFile as error:
                trouble = f"damaged ({error})"
            except PermissionError as error:
                raise InputError(f"{path}: cannot be read ({error.strerror}).") from error
            except OtherRun:
                raise FingerprintMismatch(
                    f"{path}: belongs to another run than the steps beside it. Put it elsewhere and resume: "
                    "its steps and those after it are made again."
                ) from None
            later = segments[len(rounds) :]
            for file in later:
                put_aside(file)
            warn_of_repair(
                f"{expected}: {trouble}. Blocks of steps kept: {len(rounds)}; put aside as *{DAMAGED}: {len(later)}. "
                "The steps from there on are made again, and the draws become the same."
            )
            break
        return rounds

    def _publish(self, target: Path, content: bytes) -> None:
        try:
            write_atomically(target, content)
        except OSError as error:
            if self._watched is not None:
                self._watched.check()
            raise cannot_write(target, error) from error
