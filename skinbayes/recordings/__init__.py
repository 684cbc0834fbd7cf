"""Recordings of tribometers: strokes, steady parts, zeros, friction with honest errors; pure functions of arrays in SI."""

from skinbayes.recordings.averages import averaged
from skinbayes.recordings.memory import MeanError, Memory, error_of_mean, memory_of
from skinbayes.recordings.recording import Recording, Rules
from skinbayes.recordings.reduction import reduce_recording
from skinbayes.recordings.rows import FrictionRow, ReducedRecording

__all__ = [
    "FrictionRow",
    "MeanError",
    "Memory",
    "Recording",
    "ReducedRecording",
    "Rules",
    "averaged",
    "error_of_mean",
    "memory_of",
    "reduce_recording",
]
