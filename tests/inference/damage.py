"""Ways in which files are damaged, and what may come of it."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from small_models import same_draws

from skinbayes.errors import InputError
from skinbayes.fit import Fit, load_fit


def damages(content: bytes, flips: int, seed: int) -> Iterator[bytes]:
    """Damaged versions of a file: single bits flipped, blocks of 64 kB and of 512 bytes zeroed, ends cut off."""
    return (changed for changed in _changed(content, flips, seed) if changed != content)


def _changed(content: bytes, flips: int, seed: int) -> Iterator[bytes]:
    rng = np.random.default_rng(seed)
    for place in rng.integers(0, 8 * len(content), flips):
        changed = bytearray(content)
        changed[place // 8] ^= 1 << (place % 8)
        yield bytes(changed)
    for size in (512, 1 << 16):
        for start in rng.integers(0, len(content), max(2, flips // 30)):
            changed = bytearray(content)
            changed[start : start + size] = bytes(len(changed[start : start + size]))
            yield bytes(changed)
    for size in (0, 1, len(content) - 1, *rng.integers(1, len(content), max(2, flips // 30))):
        yield content[:size]
    yield content + b"\0"
    yield content[::-1]
    yield b"nothing of the kind\n" * 50


def outcome(run: Path, whole: Fit, expected: str) -> str:
    """Read a damaged run: ``refused`` with a message that names the file, or ``harmless``; anything else fails."""
    try:
        read = load_fit(run)
    except InputError as error:
        message = str(error)
        assert expected in message, message
        assert "\n" not in message.strip()
        return "refused"
    same_draws(read, whole)
    assert read.provenance == whole.provenance
    for name, group in whole.groups.items():
        assert group.identical(read.groups[name]), name
    if run.is_dir():
        assert read.problem is not None
        assert read.problem.fingerprint == whole.provenance["fingerprint"]
        assert str(read.problem.dataset.sha256) == whole.provenance["data"]["sha256"]
    return "harmless"


def copied(run: Path, folder: Path) -> Path:
    """A copy of a run directory."""
    return Path(shutil.copytree(run, folder / "copy"))
