"""Writing a file as a whole: it is there with all its content, or the one before it is."""

from __future__ import annotations

import os
import secrets
from contextlib import suppress
from pathlib import Path

PARTIAL = ".partial"
"""End of the name of a file that is being written; one that a killed process left behind may be removed."""


def write_atomically(path: Path, content: bytes) -> None:
    """Write a file under a temporary name, force it to disk, and rename it.

    What stood under the name is replaced. A link is replaced itself; what it points at is not touched.

    Parameters
    ----------
    path : the file; its folder exists
    content : all of it

    Raises
    ------
    OSError
        It cannot be written: what was there before is unchanged, and nothing else is left behind.
    """
    partial = path.with_name(f".{secrets.token_hex(8)}{PARTIAL}")
    # O_EXCL: made anew, never opened through a link
    flags = os.O_WRONLY | os.O_CREAT | os.O_EXCL | getattr(os, "O_BINARY", 0)
    try:
        with os.fdopen(os.open(partial, flags, 0o666), "wb") as file:
            file.write(content)
            file.flush()
            os.fsync(file.fileno())
        partial.replace(path)
    except BaseException:
        with suppress(OSError):
            partial.unlink(missing_ok=True)
        raise
    _names_to_disk(path.parent)


def _names_to_disk(folder: Path) -> None:
    """Force the names in a folder to disk, where the system can do that."""
    if os.name != "posix":
        return
    handle = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)
