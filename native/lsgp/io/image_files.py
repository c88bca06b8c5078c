# SPDX-License-Identifier: GPL-3.0-or-later
"""Image files, PNG and TIFF, through OpenCV, which keeps 16 bits a channel and floating point."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import InputError
from .mesh_text import malformed
from .optional_packages import is_installed, not_installed
from .side_files import UsageError, read_regular

PNG, TIFF = (".png",), (".tif", ".tiff")
# What PNG holds; TIFF holds whatever is read.
PNG_KINDS = ("uint8", "uint16")


def require_image_suffix(path: Path, what: str) -> None:
    """Raise UsageError where the name is not that of a PNG or TIFF file.  what: the file is, for the message."""
    if path.suffix.lower() not in PNG + TIFF:
        raise UsageError(f"{what} '{path}' is not a PNG or TIFF file by its suffix; use .png or .tif")


def read_image(path: Path) -> NDArray[Any]:
    """The texels of a PNG or TIFF file: (height, width), or (height, width, channels) in the order red, green, blue,
    alpha; of the file's type of numbers.

    Raises OSError; InputError: FORMAT_NOT_INSTALLED, MALFORMED_FILE.
    """
    data = read_regular(path)
    cv2 = _opencv()
    try:
        pixels = cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_UNCHANGED) if data else None
    except cv2.error:
        pixels = None
    if pixels is None:
        raise malformed(f"'{path}' is not a readable PNG or TIFF image.")
    return _channels_swapped(pixels)


def format_image(pixels: NDArray[Any], path: Path) -> bytes:
    """The content of a PNG or TIFF file, by the suffix of its name.  pixels: as of `read_image`.

    Raises InputError: WRONG_PARAMETER for numbers that the format cannot hold; FORMAT_NOT_INSTALLED.
    """
    suffix = path.suffix.lower()
    if suffix in PNG and pixels.dtype.name not in PNG_KINDS:
        raise InputError(
            "WRONG_PARAMETER", f"PNG has no {pixels.dtype}, which the image holds. Name the output .tif instead."
        )
    cv2 = _opencv()
    try:
        written, data = cv2.imencode(suffix, _channels_swapped(pixels))
    except cv2.error:
        written = False
    if not written:
        raise InputError("WRONG_PARAMETER", f"The image cannot be written as {suffix}. Name the output otherwise.")
    return data.tobytes()


def _opencv() -> Any:
    if not is_installed("cv2"):
        raise not_installed("Reading and writing images", "OpenCV", "images", ", and try again.")
    import cv2

    return cv2


def _channels_swapped(pixels: NDArray[Any]) -> NDArray[Any]:
    """OpenCV's order of channels, blue first, to and from ours."""
    if pixels.ndim == 2 or pixels.shape[2] < 3:
        return pixels
    return np.ascontiguousarray(pixels[..., [2, 1, 0, *range(3, pixels.shape[2])]])
