"""Tables that are slow to build, kept on disk from one run to the next."""

from __future__ import annotations

import hashlib
import io
import json
import os
import tempfile
import time
import zipfile
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from skinbayes.arrays import FloatArray

FOLDER = "SKINBAYES_CACHE"
"""Environment variable that names the folder; empty keeps nothing on disk. By default the user's cache folder."""

Stored = tuple[Mapping[str, FloatArray], Mapping[str, Any]]
"""Arrays by name, and metadata that JSON can hold."""


def cache_folder() -> Path | None:
    """Folder in which tables are kept, None if nothing is to be kept."""
    given = os.environ.get(FOLDER)
    if given is not None:
        return Path(given) if given else None
    import platformdirs

    return Path(platformdirs.user_cache_dir("skinbayes", appauthor=False))


@dataclass(frozen=True)
class Unfinished:
    """Where what is done of a table is kept, so that a build that was killed goes on from there.

    Several processes may build the same table at once: each writes whole files, and all compute the same numbers.

    Attributes
    ----------
    path : the file, None if nothing is kept
    key : everything that the table depends on
    """

    path: Path | None
    key: str

    def load(self) -> dict[str, FloatArray]:
        """Arrays that were kept last, none if there are none."""
        found = None if self.path is None else _read(self.path, self.key)
        return {} if found is None else dict(found[0])

    def save(self, arrays: Mapping[str, FloatArray]) -> None:
        """Keep arrays instead of those kept before."""
        if self.path is not None:
            _write(self.path, self.key, (arrays, {}))

    def remove(self) -> None:
        """Keep nothing any more."""
        if self.path is not None:
            with suppress(OSError):
                self.path.unlink(missing_ok=True)


def cached(kind: str, key: Mapping[str, Any], build: Callable[[Unfinished], Stored]) -> Stored:
    """What ``build`` gives, from disk if it was built before with the same key.

    A file that is not, to the last bit, what was written is built and written again; a folder that cannot be written is
    left alone.

    Parameters
    ----------
    kind : first part of the file's name
    key : everything the result depends on, code version included; numbers, texts, lists and mappings of them
    build : makes arrays and metadata; is given the place where it may keep what is done so far

    Returns
    -------
    tuple
        Arrays by name and metadata.
    """
    folder = cache_folder()
    if folder is None:
        return build(Unfinished(None, ""))
    text = json.dumps(key, sort_keys=True)
    path = folder / f"{kind}-{hashlib.sha256(text.encode()).hexdigest()[:32]}.table"
    found = _read(path, text)
    if found is None:
        unfinished = Unfinished(path.with_suffix(".unfinished"), text)
        found = build(unfinished)
        _write(path, text, found)
        unfinished.remove()
    return found


_MAGIC = b"skinbayes table 3\n"
_DIGEST = hashlib.sha256().digest_size
_LARGEST = 2**30  # bytes; a table has some millions
_ABANDONED = 86_400.0  # seconds after which a file that was never finished is removed


def _read(path: Path, key: str) -> Stored | None:
    """What `_write` wrote with this key; None for anything else, whatever it is."""
    try:
        if not path.is_file() or path.stat().st_size > _LARGEST:
            return None
        content = path.read_bytes()
        start = len(_MAGIC) + _DIGEST
        body = content[start:]
        if content[:start] != _MAGIC + hashlib.sha256(body).digest():
            return None
        with np.load(io.BytesIO(body), allow_pickle=False) as stored:
            note = json.loads(str(stored["note"]))
            if note["key"] != key:
                return None
            return {name: stored[name] for name in stored.files if name != "note"}, note["metadata"]
    except (OSError, KeyError, ValueError, TypeError, EOFError, MemoryError, zipfile.BadZipFile):
        return None


def _write(path: Path, key: str, found: Stored) -> None:
    """Write to a temporary name and rename, so that there is never half a file; a folder that does not let us is left alone."""
    arrays, metadata = found
    body = io.BytesIO()
    note = np.array(json.dumps({"key": key, "metadata": dict(metadata)}))
    everything: dict[str, Any] = {"note": note, **arrays}
    np.savez_compressed(body, **everything)
    part = None
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        _remove_abandoned(path.parent)
        handle, part = tempfile.mkstemp(suffix=_PART, prefix=".", dir=path.parent)
        with os.fdopen(handle, "wb") as file:
            file.write(_MAGIC + hashlib.sha256(body.getvalue()).digest() + body.getvalue())
            file.flush()
            os.fsync(file.fileno())
        Path(part).replace(path)
    except OSError:  # a cache is a convenience
        if part is not None:
            with suppress(OSError):
                Path(part).unlink()


_PART = ".part"


def _remove_abandoned(folder: Path) -> None:
    """Remove what a process that was killed while it wrote has left behind."""
    for part in folder.glob(f".*{_PART}"):
        with suppress(OSError):
            if time.time() - part.stat().st_mtime > _ABANDONED:
                part.unlink()
