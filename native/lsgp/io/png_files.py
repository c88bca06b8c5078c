# SPDX-License-Identifier: GPL-3.0-or-later
"""PNG files of 8 bits a channel, without a further package."""

from __future__ import annotations

import os
import struct
import zlib

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..base import arguments
from ..errors import InputError
from .whole_files import write_whole


def write_png(path: str | os.PathLike[str], pixels: ArrayLike) -> None:
    """Write a picture, (height, width, 3) uint8, red, green, blue, into a PNG file, as a whole or not at all.

    Raises OSError; InputError: WRONG_SHAPE, WRONG_DTYPE.

    >>> lsgp.write_png("layout.png", lsgp.draw_layout(surface, result))
    """
    array = arguments.as_array("pixels", pixels)
    if array.ndim != 3 or array.shape[2] != 3 or not array.size:
        raise InputError("WRONG_SHAPE", f"pixels has shape {array.shape}; pass (height, width, 3).")
    if array.dtype != np.uint8:
        raise InputError("WRONG_DTYPE", f"pixels holds {array.dtype}; pass uint8, from 0 to 255.")
    write_whole(path, png(array))


def png(pixels: NDArray[np.uint8]) -> bytes:
    """The content of a PNG file of pixels (height, width, 3)."""
    height, width, _ = pixels.shape
    rows = np.concatenate([np.zeros((height, 1), np.uint8), pixels.reshape(height, -1)], axis=1)  # 0: no filter
    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    chunks = [(b"IHDR", header), (b"IDAT", zlib.compress(rows.tobytes(), 9)), (b"IEND", b"")]
    return b"\x89PNG\r\n\x1a\n" + b"".join(
        struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data)) for kind, data in chunks
    )
