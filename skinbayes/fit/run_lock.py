"""One process at a time writes into a run directory."""

from __future__ import annotations

import errno
import os
import socket
import sys
from contextlib import suppress
from pathlib import Path

from skinbayes.errors import InputError

LOCK = ".skinbayes.lock"
"""File in a run directory that is held while a process writes there."""

_WITHOUT_LOCKS = frozenset(
    getattr(errno, name) for name in ("ENOLCK", "ENOSYS", "ENOTSUP", "EOPNOTSUPP") if hasattr(errno, name)
)


class RunLock:
    """The lock of a run directory, held by the operating system, so that it ends with this process however it ends.

    Readers are not kept out. On a file system without locks nothing is locked.

    Parameters
    ----------
    directory : a folder that exists

    Raises
    ------
    InputError
        Another process holds it.
    OSError
        The folder cannot be written.
    """

    def __init__(self, directory: Path) -> None:
        self._path = directory / LOCK
        while True:
            # not through a link; not inherited by processes that this one starts
            flags = os.O_RDWR | os.O_CREAT | getattr(os, "O_NOFOLLOW", 0)
            self._handle = os.open(self._path, flags, 0o666)
            try:
                if not _locked(self._handle):
                    raise InputError(
                        f"{directory}: another fit is running in this folder ({self._holder()}); wait until it has ended, "
                        "or give another folder"
                    )
                if self._is_in_place():
                    break
            except BaseException:
                os.close(self._handle)
                raise
            os.close(self._handle)  # the holder before removed it as it ended
        with suppress(OSError):  # who holds it is a courtesy, for which a full disk has no room
            os.truncate(self._handle, 0)
            os.write(self._handle, f"process {os.getpid()} on {socket.gethostname()}".encode())

    def release(self) -> None:
        """Give the lock back and remove its file, wherever it is by now."""
        with suppress(OSError):  # Windows keeps files that are open
            if self._is_in_place():
                self._path.unlink()
        os.close(self._handle)

    def _holder(self) -> str:
        with suppress(OSError):
            os.lseek(self._handle, 0, os.SEEK_SET)
            text = os.read(self._handle, 200).decode("utf-8", "replace")
            if text.startswith("process ") and text.isprintable():
                return text
        return "by a process unknown"

    def _is_in_place(self) -> bool:
        try:
            return os.path.samestat(self._path.lstat(), os.fstat(self._handle))
        except (FileNotFoundError, NotADirectoryError):
            return False


def _locked(handle: int) -> bool:
    """Try to lock an open file; False if another one holds it."""
    try:
        if sys.platform == "win32":
            import msvcrt

            os.lseek(handle, 1 << 20, os.SEEK_SET)  # beyond the text, which others read
            msvcrt.locking(handle, msvcrt.LK_NBLCK, 1)
            os.lseek(handle, 0, os.SEEK_SET)
        else:
            import fcntl

            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError as error:
        if error.errno in _WITHOUT_LOCKS:
            return True
        if error.errno in (errno.EACCES, errno.EAGAIN, errno.EDEADLK):
            return False
        raise
    return True
