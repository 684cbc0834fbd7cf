"""Opening files that a person names: ordinary ones of a bounded size, and nothing that would keep the program waiting."""

from __future__ import annotations

import os
import stat
from io import BufferedReader, BytesIO
from pathlib import Path

from skinbayes.errors import InputError

_KINDS = {
    stat.S_IFDIR: "this is a folder",
    stat.S_IFIFO: "this is a pipe, which has no end that could be seen beforehand",
    stat.S_IFCHR: "this is a device",
    stat.S_IFBLK: "this is a device",
    stat.S_IFSOCK: "this is a socket",
}


def open_file(path: Path, largest: int, expected: str) -> BufferedReader | BytesIO:
    """Open an ordinary file for reading bytes.

    Its kind and size are looked at before anything is read, and opening never waits: a pipe that nobody writes to, a terminal
    or a device is refused.

    Parameters
    ----------
    path : the file
    largest : bytes that it may have
    expected : what it should be, such as ``"a CSV file"``

    Raises
    ------
    InputError
        if there is no such file, it cannot be read, is of another kind or too large
    """
    try:
        _check(path.stat(), path, largest, expected)
        # what is there may have changed since it was looked at
        stream = os.fdopen(os.open(path, os.O_RDONLY | _FLAGS), "rb")
    except (OSError, ValueError) as error:  # ValueError for a name with a zero byte
        if isinstance(error, InputError):
            raise
        raise InputError(f"{path}: cannot be read ({_reason(error)}); expected {expected}") from None
    try:
        found = os.fstat(stream.fileno())
        _check(found, path, largest, expected)
        if not found.st_size:  # empty, or of those that the system makes while they are read, without an end
            stream.close()
            return BytesIO()
    except BaseException:
        stream.close()
        raise
    return stream


def read_file(path: Path, largest: int, expected: str) -> bytes:
    """All bytes of an ordinary file of at most ``largest`` bytes; raises as `open_file` does."""
    with open_file(path, largest, expected) as stream:
        try:
            data = stream.read(largest + 1)
        except OSError as error:
            raise InputError(f"{path}: cannot be read ({_reason(error)}); expected {expected}") from None
    if len(data) > largest:  # it grew
        raise InputError(f"{path}: more than {largest:,} bytes; expected {expected} of at most {largest:,}")
    return data


_FLAGS = getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_NOCTTY", 0) | getattr(os, "O_BINARY", 0)


def _check(found: os.stat_result, path: Path, largest: int, expected: str) -> None:
    kind = stat.S_IFMT(found.st_mode)
    if kind != stat.S_IFREG:
        what = _KINDS.get(kind, "this is no ordinary file")
        raise InputError(f"{path}: cannot be read ({what}); expected {expected}")
    if found.st_size > largest:
        raise InputError(f"{path}: {found.st_size:,} bytes; expected {expected} of at most {largest:,} bytes")


def _reason(error: Exception) -> str:
    return getattr(error, "strerror", None) or str(error)
