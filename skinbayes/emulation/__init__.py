"""Emulators: functions that are expensive, replaced by interpolation between solutions computed beforehand."""

from skinbayes.emulation.cache import FOLDER, Stored, Unfinished, cache_folder, cached
from skinbayes.emulation.tasks import Kept, Progress, Tasks

__all__ = ["FOLDER", "Kept", "Progress", "Stored", "Tasks", "Unfinished", "cache_folder", "cached"]
