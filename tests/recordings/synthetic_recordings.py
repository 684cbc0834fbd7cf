"""Recordings of known friction: back and forth, with noise that remembers, drift, stick and slip, and a zero that is off."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
from scipy.signal import lfilter

from skinbayes.recordings import Recording


def synthetic(
    seed: int, *, friction: float = 0.5, strokes: int = 10, duration: float = 4.0, rate: float = 100.0, noise: float = 0.03,
    memory: float = 0.1, drift: float = 0.0, zero: float = 0.05, load: float = 0.5, slip: float = 0.0, running_in: float = 0.0,
    static: float = 0.15,
) -> Recording:  # fmt: skip
    """A reciprocating recording whose friction is ``friction`` in the middle of each stroke, but for running in.

    Noise is relative and forgets in ``memory`` s; ``drift`` is relative, along each stroke; ``slip`` is the relative size of a
    sawtooth of random periods and heights with mean zero; ``zero`` N is added to the tangential force.
    """
    rng = np.random.default_rng(seed)
    samples = int(strokes * duration * rate)
    t = np.arange(samples) / rate
    number, share = (t / duration).astype(int), (t / duration) % 1
    dwell = 0.05
    way = np.clip((share - dwell) / (1 - 2 * dwell), 0, 1)
    direction = np.where(number % 2 == 0, 1, -1)
    keep = np.exp(-1 / (memory * rate)) if memory else 0.0
    remembered = lfilter([np.sqrt(1 - keep**2)], [1, -keep], rng.normal(size=samples + 5000))[5000:]
    normal = load * (1 + 0.03 * np.sin(2 * np.pi * t / 7)) + 0.01 * load * rng.normal(size=samples)
    mu = (
        friction * (1 + running_in * 0.5 ** (number / 3)) * (1 + drift * (share - 0.5))
        + noise * friction * remembered
    )
    mu *= np.where(share < dwell, share / dwell, 1) * (
        1 + static * np.exp(-(((share - 1.3 * dwell) / 0.01) ** 2))
    )
    if slip:
        periods = rng.uniform(0.1, 0.2, size=int(t[-1] / 0.1) + 2)
        ends, heights = np.cumsum(periods), slip * friction * rng.uniform(0.5, 1.5, size=periods.size)
        i = np.searchsorted(ends, t, side="right")
        mu += heights[i] * ((t - ends[i]) / periods[i] + 0.5)
    return Recording(
        f"synthetic-{seed}",
        t,
        direction * mu * normal + zero,
        normal,
        position=0.02 * np.where(direction > 0, way, 1 - way),
    )


def without_strokes(recording: Recording, duration: float, missing: tuple[int, ...]) -> Recording:
    """The same while the slide stood still and force and load were off during some strokes (numbers from 0)."""
    number = (recording.time / duration).astype(int)
    gone = np.isin(number, missing)
    return replace(
        recording,
        tangential_force=np.where(gone, 0.05, recording.tangential_force),
        normal_force=np.where(gone, 0.0, recording.normal_force),
    )


def write_german(recording: Recording, path: Path) -> Path:
    """As an instrument with semicolons, decimal commas, a block of text above, a line of units, and Windows-1252."""
    lines = ["Gerät;Reibprüfstand", "Datum;30.11.2026", "", "Zeit;Kraft Fx;Kraft Fz;Weg", "s;N;N;mm"]
    lines += [
        ";".join(f"{value:.5f}".replace(".", ",") for value in row)
        for row in zip(
            recording.time,
            recording.tangential_force,
            recording.normal_force,
            1e3 * np.asarray(recording.position),
            strict=True,
        )
    ]
    path.write_bytes(("\r\n".join(lines) + "\r\n").encode("cp1252"))
    return path


GERMAN = {
    "time": {"name": "Zeit"},
    "tangential_force": {"name": "Kraft Fx"},
    "normal_force": {"name": "Kraft Fz"},
    "position": {"name": "Weg"},
}


def write_tabs(recording: Recording, path: Path) -> Path:
    """As an instrument with tabs, forces in mN, load negative under pressure, and no column of time."""
    lines = ["Ft (mN)\tFn (mN)\tx [um]"]
    lines += [
        f"{1e3 * t:.4f}\t{-1e3 * n:.4f}\t{1e6 * x:.2f}"
        for t, n, x in zip(
            recording.tangential_force, recording.normal_force, np.asarray(recording.position), strict=True
        )
    ]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


TABS = {
    "tangential_force": {"name": "Ft", "unit": "mN"},
    "normal_force": {"name": "Fn", "unit": "mN", "sign": -1},
    "position": {"number": 3},
}


def recipe(columns: dict, **more: object) -> dict:
    """A recipe with what it needs."""
    return {"title": "Made up", "authors": ["A. Author"], "columns": columns, **more}
