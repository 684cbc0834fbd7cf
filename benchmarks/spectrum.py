"""How long does a map of 4096 × 4096 pixels take to its spectrum, and how much memory, against SurfaceTopography's own?

Each runs in a process of its own on the same map, a synthetic one: first the two-dimensional spectrum alone, then with tilt and
curvature removed before. CPU seconds, best of some rounds; peak of resident memory, the map and the imports included.
"""

from __future__ import annotations

import argparse
import json
import resource
import subprocess
import sys

import numpy as np
from common import best_time

PIXEL = 1e-6


def synthetic(pixels: int) -> np.ndarray:
    """Random waves of a self-affine spectrum, heights in m, made row by row so that making it takes little memory."""
    rng = np.random.default_rng(1)
    half = pixels // 2 + 1
    q_x = np.arange(half)
    waves = np.empty((pixels, half), dtype=complex)
    for i in range(pixels):
        q = np.hypot(min(i, pixels - i), q_x)
        amplitude = np.maximum(q, 8.0) ** -1.8
        waves[i] = amplitude * (rng.standard_normal(half) + 1j * rng.standard_normal(half))
    from scipy import fft

    height = fft.irfft2(waves, overwrite_x=True)
    return height * (1e-5 / height.std())


def measure(program: str, pixels: int, rounds: int) -> dict[str, float]:
    """CPU seconds of the spectrum, of it after detrending, and peak memory in MB."""
    height = synthetic(pixels)
    if program == "skinbayes":
        from skinbayes.topography import HeightMap, analyse_surface, area_spectrum, remove_trend

        surface = HeightMap(height, pixel_size_x=PIXEL, pixel_size_y=PIXEL)
        calls = {
            "spectrum": lambda: area_spectrum(surface),
            "with curvature removed": lambda: area_spectrum(remove_trend(surface)),
            "all of analyse_surface": lambda: analyse_surface(surface),
        }
    else:
        import SurfaceTopography

        topography = SurfaceTopography.Topography(height, (pixels * PIXEL,) * 2, unit="m", periodic=False)
        calls = {
            "spectrum": lambda: topography.power_spectrum_from_area(),
            "with curvature removed": lambda: topography.detrend("curvature").power_spectrum_from_area(),
        }
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    found = {name: best_time(call, rounds) for name, call in calls.items()}
    return found | {
        "peak memory, MB": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024,
        "of it before": before,
    }


def main() -> None:
    """Both programs, each in a process of its own, and their ratio."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--pixels", type=int, default=4096, help="along each side")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--program", choices=("skinbayes", "SurfaceTopography"), help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.program:
        print(json.dumps(measure(arguments.program, arguments.pixels, arguments.rounds)))
        return
    found = {}
    for program in ("skinbayes", "SurfaceTopography"):
        numbers = ["--pixels", str(arguments.pixels), "--rounds", str(arguments.rounds)]
        command = [sys.executable, __file__, "--program", program, *numbers]
        done = subprocess.run(command, check=True, capture_output=True, text=True)
        found[program] = json.loads(done.stdout.splitlines()[-1])
        for name, value in found[program].items():
            print(f"{program:18}  {name:24}  {value:8.2f}")
    ours, theirs = found["skinbayes"], found["SurfaceTopography"]
    for name in ("spectrum", "with curvature removed"):
        print(f"SurfaceTopography takes {theirs[name] / ours[name]:.1f} times the CPU seconds: {name}")


if __name__ == "__main__":
    main()
