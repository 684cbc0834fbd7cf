"""Heights from a NumPy array or an image of one channel."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np

from skinbayes.errors import InputError
from skinbayes.files.surface_scale import Scale, check_pixels, first_line
from skinbayes.topography import HeightMap, LineProfile


def read_array(path: Path, stated: Scale) -> HeightMap | LineProfile:
    """An array of one or two axes; nothing in it is run."""
    try:
        array = np.load(path, mmap_mode="r", allow_pickle=False)
    except (ValueError, OSError, EOFError) as error:
        raise InputError(f"{path}: cannot be read as a NumPy array ({first_line(error)})") from None
    if array.dtype.kind not in "iuf" or array.ndim not in (1, 2):
        raise InputError(
            f"{path}: an array of {array.dtype} with {array.ndim} axes; expected numbers on one axis (a line) or two (a map)"
        )
    check_pixels(path, *array.shape)
    return stated.surface(path, np.array(array, dtype=np.float64))


def read_image(path: Path, stated: Scale) -> HeightMap | LineProfile:
    """A TIFF with one value a pixel, as integers or floats."""
    from PIL import Image

    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of large images: their size is checked here
            image = Image.open(path)
        with image:
            if image.mode not in ("L", "I", "F") and not image.mode.startswith("I;16"):
                raise InputError(
                    f"{path}: an image of the mode {image.mode}, which has colours or no heights; expected one number a pixel"
                )
            if (frames := getattr(image, "n_frames", 1)) > 1:
                raise InputError(f"{path}: {frames} images in one file; expected one")
            check_pixels(path, image.height, image.width)
            height = np.array(image, dtype=np.float64)
    except InputError:
        raise
    except Exception as error:  # damaged images fail in many ways
        raise InputError(f"{path}: cannot be read as a TIFF image ({first_line(error)})") from None
    return stated.surface(path, height)
