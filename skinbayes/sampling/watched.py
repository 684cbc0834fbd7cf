"""Noticing that a directory is no longer where it was."""

from __future__ import annotations

import os
import weakref
from pathlib import Path

from skinbayes.errors import FolderGone


class WatchedDirectory:
    """A directory that has to stay where it is as long as something is written into it.

    Parameters
    ----------
    path : a directory that exists
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self._known = path.stat()
        self._handle: int | None = None
        if os.name == "posix":  # held open, so that its number is not given to another one
            self._handle = os.open(path, os.O_RDONLY)
            self._known = os.fstat(self._handle)
            weakref.finalize(self, os.close, self._handle)

    def check(self) -> None:
        """Raise :class:`FolderGone` if another directory, or none, is under the name."""
        try:
            there = os.path.samestat(self.path.stat(), self._known)
        except (FileNotFoundError, NotADirectoryError):
            there = False
        if not there:
            raise FolderGone(self.path, self._new_place())

    def _new_place(self) -> Path | None:
        """Where a renamed directory is, as far as the system tells."""
        try:
            place = Path(f"/proc/self/fd/{self._handle}").readlink()
            return place if os.path.samestat(place.stat(), self._known) else None
        except OSError:
            return None
