# SPDX-License-Identifier: GPL-3.0-or-later
"""The angles next to cones and directions, without overlaps, and the scale of the distortion."""

from __future__ import annotations

import math
from collections.abc import Sequence

import blf
import gpu
import numpy as np
from numpy.typing import NDArray

from . import shaders
from .content import Cone
from .heat import Scale

FloatArray = NDArray[np.float32]
Box = tuple[float, float, float, float]

FONT = 0
PADDING = 3
# Pixels around the middle of a cone in which it may be visible.
NEAR = 2
BAR_WIDTH, BAR_HEIGHT, BAR_MARGIN = 180, 10, 16
BEHIND_TEXT = (0.0, 0.0, 0.0, 0.7)


def label(cone: Cone) -> str:
    """The angle in degrees; "auto" where unwrapping chooses it."""
    if cone.angle is None:
        return "auto"
    return in_degrees(cone.angle)


def in_degrees(angle: float) -> str:
    """Without trailing zeros."""
    degrees = math.degrees(angle)
    return f"{degrees:.0f}°" if abs(degrees - round(degrees)) < 0.05 else f"{degrees:.1f}°"


def depths(pixels: FloatArray, width: int, height: int) -> FloatArray:
    """(k,) largest depth, from -1 to 1, drawn near each of these pixels; 1 outside the region.

    pixels: (k, 3).  Reads the active framebuffer.
    """
    found = np.ones(len(pixels), np.float32)
    with np.errstate(invalid="ignore"):
        inside = ((pixels[:, :2] >= NEAR) & (pixels[:, :2] < (width - NEAR, height - NEAR))).all(axis=1)
    if not inside.any():
        return found
    x, y = pixels[inside, :2].astype(int).T
    left, low = int(x.min()) - NEAR, int(y.min()) - NEAR
    columns, rows = int(x.max()) - left + NEAR + 1, int(y.max()) - low + NEAR + 1
    buffer = gpu.state.active_framebuffer_get().read_depth(left, low, columns, rows)
    # At least up to Blender 4.3, numpy gets wrong strides for buffers with two dimensions.
    buffer.dimensions = rows * columns
    drawn = np.asarray(buffer, np.float32).reshape(rows, columns)
    around = range(-NEAR, NEAR + 1)
    found[inside] = 2 * np.max([drawn[y - low + dy, x - left + dx] for dx in around for dy in around], axis=0) - 1
    return found


def without_overlaps(boxes: Sequence[Box], order: Sequence[int]) -> list[int]:
    """Which boxes to keep, in this order of priority, so that no two touch.  A box: left, bottom, right, top."""
    kept: list[int] = []
    for i in order:
        left, low, right, high = boxes[i]
        if all(left > b[2] or right < b[0] or low > b[3] or high < b[1] for b in (boxes[k] for k in kept)):
            kept.append(i)
    return kept


def draw_labels(
    texts: Sequence[str], places: FloatArray, offsets: Sequence[float], size: int, color: Sequence[float]
) -> None:
    """Write texts to the right of their places, the nearest first, without those that would overlap.

    places: (k, 3) pixels and depths. offsets: how many pixels the text is away from each.
    """
    blf.size(FONT, size)
    boxes = []
    for text, (x, y, _), offset in zip(texts, places.tolist(), offsets, strict=True):
        width, height = blf.dimensions(FONT, text)
        low, high = y - height / 2 - PADDING, y + height / 2 + PADDING
        boxes.append((x + offset, low, x + offset + width + 2 * PADDING, high))
    kept = without_overlaps(boxes, np.argsort(places[:, 2], kind="stable").tolist())
    if not kept:
        return
    corners = np.concatenate([rectangle(*boxes[i]) for i in kept])
    shaders.triangle_batch(corners, np.tile(np.float32(BEHIND_TEXT), (len(corners), 1))).draw(shaders.triangles())
    blf.color(FONT, *color)
    for i in kept:
        blf.position(FONT, boxes[i][0] + PADDING, boxes[i][1] + PADDING, 0)
        blf.draw(FONT, texts[i])


def rectangle(left: float, low: float, right: float, high: float) -> FloatArray:
    """(2, 3, 3) triangles."""
    points = np.array([(left, low, 0), (right, low, 0), (right, high, 0), (left, high, 0)], np.float32)
    return points[[[0, 1, 2], [0, 2, 3]]]


def draw_scale_texts(
    scale: Scale, corner: tuple[float, float], pixel: float, size: int, color: Sequence[float]
) -> None:
    """Write what the colors of the bar with this lower left corner mean, above and below it."""
    left, low = corner
    blf.size(FONT, size)
    blf.color(FONT, *color)
    blf.enable(FONT, blf.SHADOW)
    blf.shadow(FONT, 5, 0.0, 0.0, 0.0, 0.9)
    blf.shadow_offset(FONT, 0, 0)
    width = BAR_WIDTH * pixel
    for text, share in zip(scale.ends, (0.0, 0.5, 1.0), strict=True):
        x = left + share * (width - blf.dimensions(FONT, text)[0])
        blf.position(FONT, x, low - 1.2 * size, 0)
        blf.draw(FONT, text)
    blf.position(FONT, left, low + BAR_HEIGHT * pixel + 0.5 * size, 0)
    blf.draw(FONT, scale.label)
    blf.disable(FONT, blf.SHADOW)
