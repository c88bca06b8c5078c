# SPDX-License-Identifier: GPL-3.0-or-later
"""Mip levels of a texture whose gutters hold the content beyond the cut at every level."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..base import arguments
from ..base.arguments import FloatArray
from ..base.progress import Progress, share_of, tell
from ..errors import InputError
from ..surface import Surface
from .gutters import convert_texels, pad_image

# Of the time that is left, what a level takes: those after it have a quarter of its texels and less.
_FIRST = 0.75


def pad_mip_levels(
    image: ArrayLike,
    surface: Surface,
    corner_uv: ArrayLike,
    margins: Sequence[float],
    *,
    normal_map: bool = False,
    progress: Progress | None = None,
) -> list[NDArray[Any]]:
    """The texture and its mip levels, each padded as by `pad_image`, for renderers that take all levels.

    margins: how far gutters reach at each level, in pixels of that level; the first is of the image itself.
    Others: as in `pad_image`.

    Each level has half the width and half the height of the last, rounded down, but at least one texel. Its texels
    are the means of those that they cover, also in gutters, and of the values as they are stored; then its gutters are
    filled again. So lookups match across cuts at levels at which the gutters of the image itself would be too narrow.
    Levels are halved in floating point, and rounded only when they are returned.
    Raises InputError: that of `pad_image`; WRONG_PARAMETER: there are more margins than levels, or none. Cancelled.
    """
    arguments.require_callable(progress)
    widths = arguments.floats("margins", margins)
    if widths.ndim != 1 or not (np.isfinite(widths) & (widths >= 0)).all():
        arguments.refuse("margins", margins, "pass a list of widths in pixels, 0 or more")
    pixels = arguments.as_array("image", image)
    most = max(1, max(pixels.shape[:2], default=1).bit_length())
    if not 1 <= len(widths) <= most:
        raise InputError(
            "WRONG_PARAMETER",
            f"margins has {len(widths)} values; an image of shape {pixels.shape} and its mip levels are {most}. Pass "
            "one margin for each.",
        )
    pad = partial(pad_image, surface=surface, corner_uv=corner_uv, normal_map=normal_map)
    begin, end = 0.0, _FIRST if len(widths) > 1 else 1.0
    levels = [pad(pixels, margin=widths[0], progress=share_of(progress, begin, end))]
    # Normals have their zero at half the range of integers, but at 1/2 in floating point.
    middle = np.iinfo(pixels.dtype).max / 2 if pixels.dtype.kind == "u" else 0.5
    level = levels[0].astype(np.float64) - middle + 0.5
    for margin in widths[1:]:
        begin, end = end, _FIRST * (1.0 - end) + end
        level = pad(_halved(_halved(level, 0), 1), margin=margin, progress=share_of(progress, begin, end))
        levels.append(convert_texels(level - 0.5 + middle, pixels.dtype))
    tell(progress, 1.0)
    return levels


def _halved(level: FloatArray, axis: int) -> FloatArray:
    """Means over boxes, of which half as many, rounded down, fill the axis; an odd count has boxes of three texels."""
    count = level.shape[axis]
    half = count // 2
    if half == 0:
        return level
    boxes = np.moveaxis(level, axis, 0)
    last = -1 if count % 2 else None
    first, second, third = boxes[:last:2], boxes[1::2], boxes[2::2]
    if count % 2 == 0:
        return np.moveaxis((first + second) / 2, 0, axis)
    share = np.arange(half).reshape(-1, *[1] * (level.ndim - 1))
    return np.moveaxis(((half - share) * first + half * second + (share + 1) * third) / count, 0, axis)
