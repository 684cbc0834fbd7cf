"""The folder of a calibration: a manifest, and a file to which each simulation adds one line as soon as it is done."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from pathlib import Path
from types import TracebackType
from typing import Any

from skinbayes.atomic import write_atomically
from skinbayes.calibration.simulation import Simulated
from skinbayes.errors import FingerprintMismatch, InputError, cannot_write, warn_of_repair
from skinbayes.fit.run_lock import LOCK, RunLock
from skinbayes.sealed import DamagedFile, content_digest, read_note, sealed_note

MANIFEST = "calibration.json"
SIMULATIONS = "simulations.jsonl"

FORMAT = "skinbayes calibration 1"


class CalibrationDirectory:
    """A folder that holds the simulations of one calibration; from beginning to end of its context nobody else writes there.

    A simulation depends on the seed and on its number alone, so that lines which were damaged, or cut off when the process was
    killed, are left out and made again.

    Parameters
    ----------
    path : the folder; made if it is not there
    asked : what is simulated, as JSON can hold it; a folder of something else is refused

    Attributes
    ----------
    done : the simulations that the folder holds, by number
    """

    def __init__(self, path: Path, asked: Mapping[str, Any]) -> None:
        self.path = path
        self.done: dict[int, Simulated] = {}
        self._asked = json.loads(json.dumps({"format": FORMAT, **asked}))

    def __enter__(self) -> CalibrationDirectory:
        """Claim the folder and read what it holds.

        Raises
        ------
        InputError
            It holds something else, another process writes there, or it cannot be written.
        MachineError
            The disk is full.
        """
        self._examine()  # before anything is written
        try:
            self.path.mkdir(parents=True, exist_ok=True)
            self._lock = RunLock(self.path)
        except OSError as error:
            raise cannot_write(self.path, error, begun=False) from None
        try:
            if not self._examine():  # once more, now that nobody else writes here
                write_atomically(self.path / MANIFEST, sealed_note(self._asked))
            self._read()
        except BaseException as error:
            self._lock.release()
            if isinstance(error, OSError):
                raise cannot_write(self.path, error, begun=False) from None
            raise
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Give the folder back."""
        self._lock.release()

    def add(self, found: Simulated) -> None:
        """Keep one more simulation, forced to disk.

        Raises
        ------
        MachineError
            It cannot be written; those before it are kept.
        """
        entry = found.to_dict()
        line = json.dumps({**entry, "sha256": content_digest(entry)}, allow_nan=True) + "\n"
        try:
            with (self.path / SIMULATIONS).open("ab") as file:
                file.write(line.encode())
                file.flush()
                os.fsync(file.fileno())
        except OSError as error:
            raise cannot_write(self.path / SIMULATIONS, error) from None
        self.done[found.number] = found

    def _examine(self) -> bool:
        """Whether the folder holds this calibration; InputError if it holds anything else."""
        try:
            names = {item.name for item in self.path.iterdir()} - {LOCK}
        except FileNotFoundError:
            return False
        except (NotADirectoryError, ValueError):
            raise InputError(f"{self.path}: cannot be used for a calibration; expected a folder") from None
        names = {name for name in names if not name.startswith(".")}
        if not names:
            return False
        if MANIFEST not in names:
            raise InputError(
                f"{self.path}: holds {', '.join(sorted(names)[:4])}, and is no calibration; expected a new or empty folder, "
                "or that of this calibration. Nothing was written"
            )
        try:
            held = read_note(self.path / MANIFEST)
        except DamagedFile as error:
            raise InputError(f"{self.path / MANIFEST}: damaged ({error}); give another folder") from None
        if other := [key for key in self._asked if held.get(key) != self._asked[key]]:
            raise FingerprintMismatch(
                f"{self.path}: holds a calibration of {' and '.join(held.get('models', ['something else']))} with other "
                f"{', '.join(other)} than here; give another folder"
            )
        return True

    def _read(self) -> None:
        """Take up what is there; a file with lines that are not what was written is written again without them."""
        file = self.path / SIMULATIONS
        try:
            lines = file.read_bytes().splitlines(keepends=True)
        except FileNotFoundError:
            return
        whole = []
        for line in lines:
            found = _simulated(line)
            if found is not None and found.number not in self.done:
                self.done[found.number] = found
                whole.append(line)
        if lost := len(lines) - len(whole):
            write_atomically(file, b"".join(whole))
            warn_of_repair(f"{file}: {lost} of {len(lines)} lines are not what was written; simulated again")


def _simulated(line: bytes) -> Simulated | None:
    try:
        entry = json.loads(line)
        if line.endswith(b"\n") and entry.pop("sha256") == content_digest(entry):
            return Simulated.from_dict(entry)
    except (ValueError, TypeError, KeyError, AttributeError):
        pass
    return None
