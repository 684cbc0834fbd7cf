"""Tables that are slow to build, kept on disk from one run to the next."""

from __future__ import annotations

import hashlib
import json
import os
import zipfile
from collections.abc import Callable, Mapping
from contextlib import suppress
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


def cached(kind: str, key: Mapping[str, Any], build: Callable[[], Stored]) -> Stored:
    """What ``build`` gives, from disk if it was built before with the same key.

    A file that cannot be read, or is damaged, is built and written again; a folder that cannot be written is left alone.

    Parameters
    ----------
    kind : first part of the file's name
    key : everything the result depends on, code version included; numbers, texts, lists and mappings of them
    build : makes arrays and metadata

    Returns
    -------
    tuple
        Arrays by name and metadata.
    """
    folder = cache_folder()
    if folder is None:
        return build()
    text = json.dumps(key, sort_keys=True)
    path = folder / f"{kind}-{hashlib.sha256(text.encode()).hexdigest()[:32]}.npz"
    found = _read(path, text)
    if found is None:
        found = build()
        _write(path, text, found)
    return found


def _read(path: Path, key: str) -> Stored | None:
    try:
        with path.open("rb") as file, np.load(file, allow_pickle=False) as stored:
            note = json.loads(str(stored["note"]))
            if note["key"] != key:
                return None
            return {name: stored[name] for name in stored.files if name != "note"}, note["metadata"]
    except (OSError, KeyError, ValueError, EOFError, zipfile.BadZipFile):
        return None


def _write(path: Path, key: str, found: Stored) -> None:
    arrays, metadata = found
    temporary = path.with_name(f".{path.name}.{os.getpid()}.part")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with temporary.open("wb") as file:
            note = np.array(json.dumps({"key": key, "metadata": dict(metadata)}))
            everything: dict[str, Any] = {"note": note, **arrays}
            np.savez_compressed(file, **everything)
        temporary.replace(path)
    except OSError:  # a cache is a convenience
        with suppress(OSError):
            temporary.unlink(missing_ok=True)
