"""Calibrated axes: by hand on linear, logarithmic, turned and sheared axes, and against perturbed pixels."""

import math

import numpy as np
import pytest

from skinbayes.errors import InputError
from skinbayes.files.pixel_axes import PixelAxes


def test_linear_axes_by_hand() -> None:
    # 600 pixels for 0 to 6, 400 pixels upwards for -2 to 2: 0.01 for each pixel on both
    axes = PixelAxes.from_points([(100, 500), (700, 500), (100, 500), (100, 100)], (0.0, 6.0, -2.0, 2.0))
    assert axes.values([(250, 350)]) == pytest.approx(np.array([[1.5, -0.5]]), abs=1e-12)
    assert axes.reading_error([[1.5, -0.5]], 1.0) == pytest.approx(np.array([[0.01, 0.01]]), rel=1e-12)
    assert axes.reading_error([[1.5, -0.5]], 2.5) == pytest.approx(np.array([[0.025, 0.025]]), rel=1e-12)


def test_logarithmic_axes_have_a_constant_relative_error() -> None:
    # six decades on 600 pixels, one decade on 400
    axes = PixelAxes.from_points(
        [(100, 500), (700, 500), (100, 500), (100, 100)], (1e-6, 1.0, 0.1, 1.0), (True, True)
    )
    values = axes.values([(100, 500), (400, 300), (700, 100)])
    assert values == pytest.approx(np.array([[1e-6, 0.1], [1e-3, 10**-0.5], [1.0, 1.0]]), rel=1e-12)
    relative = axes.reading_error(values, 1.0) / values
    assert relative[:, 0] == pytest.approx(np.full(3, math.log(10) / 100), rel=1e-12)
    assert relative[:, 1] == pytest.approx(np.full(3, math.log(10) / 400), rel=1e-12)


@pytest.mark.parametrize("angle", [3.0, -20.0, 45.0, 90.0, 180.0])
def test_turning_the_picture_changes_no_error(angle: float) -> None:
    turn = math.radians(angle)
    along, across = (math.cos(turn), math.sin(turn)), (math.sin(turn), -math.cos(turn))
    start = (300.0, 300.0)
    points = [
        start,
        (300 + 200 * along[0], 300 + 200 * along[1]),
        start,
        (300 + 100 * across[0], 300 + 100 * across[1]),
    ]
    axes = PixelAxes.from_points(points, (10.0, 30.0, 0.0, 5.0))
    middle = (300 + 100 * along[0] + 20 * across[0], 300 + 100 * along[1] + 20 * across[1])
    assert axes.values([middle]) == pytest.approx(np.array([[20.0, 1.0]]), abs=1e-10)
    assert axes.reading_error([[20.0, 1.0]], 1.0) == pytest.approx(np.array([[0.1, 0.05]]), rel=1e-10)


def test_sheared_axes_by_hand() -> None:
    # the ordinate leans by 30 pixels on 100: along it the abscissa, 0.1 for each pixel in x, must not change,
    # so it takes 0.1 · 30/100 = 0.03 for each pixel in y
    axes = PixelAxes.from_points([(0, 0), (100, 0), (0, 0), (30, -100)], (0.0, 10.0, 0.0, 50.0))
    assert axes.matrix == pytest.approx(np.array([[0.1, 0.03], [0.0, -0.5]]), abs=1e-14)
    error = axes.reading_error([[0.0, 0.0]], 1.0)
    assert error == pytest.approx(np.array([[math.sqrt(0.1**2 + 0.03**2), 0.5]]), rel=1e-12)


def test_points_of_one_axis_may_lie_anywhere() -> None:
    # the points of the ordinate need not lie on the line where the abscissa begins
    axes = PixelAxes.from_points([(100, 480), (700, 480), (90, 500), (90, 100)], (0.0, 6.0, 0.0, 4.0))
    assert axes.values([(400, 300)]) == pytest.approx(np.array([[3.0, 2.0]]), abs=1e-12)


def test_errors_are_those_of_perturbed_pixels() -> None:
    points = np.array([(80.0, 520.0), (705.0, 498.0), (80.0, 520.0), (64.0, 97.0)])
    axes = PixelAxes.from_points(points, (1e-4, 10.0, 0.0, 1.5), (True, False))
    pixel = np.array([333.0, 222.0])
    value = axes.values(pixel[np.newaxis])
    noise = np.random.default_rng(5).normal(0.0, 0.7, (40_000, 2))
    seen = axes.values(pixel + noise).std(axis=0)
    # 40 000 draws: 0.35 % of a standard deviation; the logarithm is not linear: less than 0.1 % here
    assert axes.reading_error(value, 0.7)[0] == pytest.approx(seen, rel=0.015)


def test_a_small_tilt_can_be_ignored() -> None:
    points = [(100.0, 500.0), (700.0, 506.0), (100.0, 500.0), (103.0, 100.0)]
    axes = PixelAxes.from_points(points, (0.0, 6.0, 0.0, 4.0), straight=True)
    assert axes.matrix == pytest.approx(np.array([[0.01, 0.0], [0.0, -0.01]]), abs=1e-15)
    assert axes.values([(400, 300)]) == pytest.approx(np.array([[3.0, 2.0]]), abs=1e-12)
    swapped = PixelAxes.from_points(
        [(500.0, 100.0), (506.0, 700.0), (500.0, 100.0), (100.0, 103.0)], (0.0, 6.0, 0.0, 4.0), straight=True
    )
    assert swapped.values([(300, 400)]) == pytest.approx(np.array([[3.0, 2.0]]), abs=1e-12)


BAD: dict[str, tuple[list[tuple[float, float]], tuple[float, float, float, float], tuple[bool, bool], str]] = {
    "same value": ([(0, 0), (9, 0), (0, 0), (0, 9)], (1.0, 1.0, 0.0, 1.0), (False, False), "same value"),
    "same pixel": ([(0, 0), (0, 0), (0, 0), (0, 9)], (0.0, 1.0, 0.0, 1.0), (False, False), "span two axes"),
    "parallel": ([(0, 0), (900, 1), (0, 0), (900, 0)], (0.0, 1.0, 0.0, 1.0), (False, False), "span two axes"),
    "log of zero": ([(0, 0), (9, 0), (0, 0), (0, 9)], (1.0, 2.0, 0.0, 1.0), (False, True), "Y1 has the value 0"),
}  # fmt: skip


@pytest.mark.parametrize("case", BAD)
def test_impossible_calibrations_are_refused(case: str) -> None:
    points, values, logarithmic, said = BAD[case]
    with pytest.raises(InputError, match=said):
        PixelAxes.from_points(points, values, logarithmic)
