"""Emulators: functions that are expensive, replaced by interpolation between solutions computed beforehand."""

from skinbayes.emulation.box import Box, Places
from skinbayes.emulation.cache import FOLDER, Stored, Unfinished, cache_folder, cached
from skinbayes.emulation.interpolant import Interpolant, counts_along, refined
from skinbayes.emulation.stored import from_arrays, kept_table, to_arrays
from skinbayes.emulation.tasks import Kept, Progress, Tasks

__all__ = [
    "FOLDER", "Box", "Interpolant", "Kept", "Places", "Progress", "Stored", "Tasks", "Unfinished", "cache_folder", "cached",
    "counts_along", "from_arrays", "kept_table", "refined", "to_arrays",
]  # fmt: skip
