"""A folder of many small results: a manifest, and a file to which each result adds one line as soon as it is there."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Hashable, Mapping
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import Any, Generic, TypeVar

from skinbayes.atomic import write_atomically
from skinbayes.errors import FingerprintMismatch, InputError, cannot_write, warn_of_repair
from skinbayes.fit.run_lock import LOCK, RunLock
from skinbayes.sealed import DamagedFile, content_digest, read_note, sealed_note

Result = TypeVar("Result")


@dataclass(frozen=True)
class Kind(Generic[Result]):
    """What a folder of results holds.

    Attributes
    ----------
    word : what people call the whole, such as "calibration"
    manifest, lines : names of the two files
    version : the format, for the manifest
    key : what tells one result from another
    to_dict, from_dict : a result as JSON can hold it, and back; of a line that is none, an error
    again : how a damaged result is made good, in words
    """

    word: str
    manifest: str
    lines: str
    version: str
    key: Callable[[Result], Hashable]
    to_dict: Callable[[Result], dict[str, Any]]
    from_dict: Callable[[dict[str, Any]], Result]
    again: str


def stated(options: Mapping[str, Any]) -> dict[str, Any]:
    """Options of a function as JSON can hold and compare them."""
    return {
        name: value if isinstance(value, str | int | float | bool) else repr(value)
        for name, value in options.items()
    }


class ResultFolder(Generic[Result]):
    """A folder that holds many results of one kind; from beginning to end of its context nobody else writes there.

    A result must depend on its task alone, so that lines which were damaged, or cut off when the process was killed, are left
    out and made again.

    Parameters
    ----------
    path : the folder; made if it is not there
    kind : what it holds
    asked : how the results are made, as JSON can hold it; a folder of something else is refused

    Attributes
    ----------
    done : the results that the folder holds, by their key
    """

    def __init__(self, path: Path, kind: Kind[Result], asked: Mapping[str, Any]) -> None:
        self.path = path
        self.done: dict[Hashable, Result] = {}
        self._kind = kind
        self._asked = json.loads(json.dumps({"format": kind.version, **asked}))

    def __enter__(self) -> ResultFolder[Result]:
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
                write_atomically(self.path / self._kind.manifest, sealed_note(self._asked))
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

    def add(self, found: Result) -> None:
        """Keep one more result, forced to disk.

        Raises
        ------
        MachineError
            It cannot be written; those before it are kept.
        """
        entry = self._kind.to_dict(found)
        line = json.dumps({**entry, "sha256": content_digest(entry)}, allow_nan=True) + "\n"
        try:
            with (self.path / self._kind.lines).open("ab") as file:
                file.write(line.encode())
                file.flush()
                os.fsync(file.fileno())
        except OSError as error:
            raise cannot_write(self.path / self._kind.lines, error) from None
        self.done[self._kind.key(found)] = found

    def _examine(self) -> bool:
        """Whether the folder holds these results; InputError if it holds anything else."""
        try:
            names = {item.name for item in self.path.iterdir()} - {LOCK}
        except FileNotFoundError:
            return False
        except (NotADirectoryError, ValueError):
            raise InputError(
                f"{self.path}: cannot be used for a {self._kind.word}; expected a folder"
            ) from None
        names = {name for name in names if not name.startswith(".")}
        if not names:
            return False
        if self._kind.manifest not in names:
            raise InputError(
                f"{self.path}: holds {', '.join(sorted(names)[:4])}, and is no {self._kind.word}; expected a new or "
                f"empty folder, or that of this {self._kind.word}. Nothing was written"
            )
        try:
            held = read_note(self.path / self._kind.manifest)
        except DamagedFile as error:
            raise InputError(
                f"{self.path / self._kind.manifest}: damaged ({error}); give another folder"
            ) from None
        if other := [key for key in self._asked if held.get(key) != self._asked[key]]:
            raise FingerprintMismatch(
                f"{self.path}: holds a {self._kind.word} of {' and '.join(held.get('models', ['something else']))} with other "
                f"{', '.join(other)} than here; give another folder"
            )
        return True

    def _read(self) -> None:
        """Take up what is there; a file with lines that are not what was written is written again without them."""
        file = self.path / self._kind.lines
        try:
            lines = file.read_bytes().splitlines(keepends=True)
        except FileNotFoundError:
            return
        whole = []
        for line in lines:
            found = self._result(line)
            if found is not None:
                self.done[self._kind.key(found)] = found
                whole.append(line)
        if lost := len(lines) - len(whole):
            write_atomically(file, b"".join(whole))
            warn_of_repair(
                f"{file}: {lost} of {len(lines)} lines are not what was written; {self._kind.again}"
            )

    def _result(self, line: bytes) -> Result | None:
        try:
            entry = json.loads(line)
            if line.endswith(b"\n") and entry.pop("sha256") == content_digest(entry):
                return self._kind.from_dict(entry)
        except (ValueError, TypeError, KeyError, AttributeError):
            pass
        return None
