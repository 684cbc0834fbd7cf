"""Files that show whether they are still what was written: a checksum at their end or, in JSON, among the content."""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

DAMAGED = ".damaged"
"""Ending of a damaged file that was put aside."""

LARGEST_NOTE = 1 << 24
"""Bytes; the JSON files of a run are far smaller."""

_PIECE = 1 << 20
_LABEL, _END = b"\nsha256 ", b" of the %016d bytes above\n"
_SEAL_SIZE = len(_LABEL) + 64 + len(_END % 0)


class DamagedFile(ValueError):
    """A file is not what was written; the text says in which way, and does not name the file."""


def sealed(content: bytes) -> bytes:
    """Content with a line at its end that holds its checksum; readers of HDF5 look past it."""
    return content + _seal(hashlib.sha256(content).hexdigest(), len(content))


def checked(path: Path) -> str:
    """sha256 of a whole file, after every byte of it was compared with the seal at its end.

    Raises
    ------
    DamagedFile
        A bit of it, or of the seal, is not what was written, or it was never sealed.
    OSError
        It cannot be read; nothing is known about its content.
    """
    if not path.is_file():
        raise DamagedFile("no ordinary file")
    with path.open("rb") as file:
        size = left = file.seek(0, os.SEEK_END) - _SEAL_SIZE
        # looked at before the whole is read, because a file without a seal may be of any size, or have no end
        if size < 0:
            raise DamagedFile("it has no checksum at its end")
        file.seek(size)
        seal = file.read(_SEAL_SIZE)
        if not seal.endswith(_END % size):
            raise DamagedFile("it has no checksum at its end")
        file.seek(0)
        found = hashlib.sha256()
        while piece := file.read(min(_PIECE, left)):
            found.update(piece)
            left -= len(piece)
    if seal != _seal(found.hexdigest(), size):
        raise DamagedFile("its content does not fit its checksum")
    found.update(seal)
    return found.hexdigest()


def _seal(digest: str, size: int) -> bytes:
    return _LABEL + digest.encode() + _END % size


def file_digest(path: Path) -> str:
    """sha256 of a file."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def sealed_note(note: Mapping[str, Any]) -> bytes:
    """A JSON object with the checksum of its content under ``sha256``."""
    return (json.dumps({**note, "sha256": content_digest(note)}, indent=1) + "\n").encode()


def read_note(path: Path) -> dict[str, Any]:
    """The content of a file made by :func:`sealed_note`, without the checksum.

    Raises
    ------
    DamagedFile
        It is something else, or its content does not fit its checksum.
    FileNotFoundError, PermissionError
        There is no such file, or it must not be read: nothing is known about its content.
    """
    if path.exists() and not path.is_file():
        raise DamagedFile("no ordinary file")
    try:
        with path.open("rb") as file:
            text = file.read(LARGEST_NOTE + 1)
        note = json.loads(text) if len(text) <= LARGEST_NOTE else None
        fits = isinstance(note, dict) and note.pop("sha256", None) == content_digest(note)
    except (FileNotFoundError, PermissionError):
        raise
    except NotADirectoryError as error:
        raise FileNotFoundError(error) from None
    except (OSError, ValueError) as error:
        raise DamagedFile(f"{error}") from None
    except RecursionError:
        raise DamagedFile("it is nested too deeply") from None
    if note is None or not fits:
        raise DamagedFile("its content does not fit its checksum")
    return dict(note)


def content_digest(value: Mapping[str, Any]) -> str:
    """sha256 of an object of JSON, whatever the order of its keys."""
    return hashlib.sha256(json.dumps(value, sort_keys=True).encode()).hexdigest()


def put_aside(path: Path) -> Path:
    """Rename what is damaged, so that its place is free and nothing is lost; returns the new path."""
    aside, number = path.with_name(path.name + DAMAGED), 1
    while aside.exists() or aside.is_symlink():
        number += 1
        aside = path.with_name(f"{path.name}{DAMAGED}-{number}")
    return path.rename(aside)
