# SPDX-License-Identifier: GPL-3.0-or-later
"""A texture for seamless layouts: pinwheels that look the same turned by a quarter, but not mirrored.

A layout whose cuts are related by quarter turns and whole tiles shows no seam in a texture that repeats in every tile
and looks the same turned by a quarter about the middle of a tile; then it looks the same turned about its corners, too.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

SAMPLES = 4  # a texel's side
TWISTS = ((0.5, 2.4), (0.0, 1.2))  # u and v of a center in the tile, radians
RIBBON, OUTLINE, LINE = (0.0, 0.022), (0.022, 0.034), (0.046, 0.054)  # distances from the nearest edge of a vane
VEIN = 0.005
CREAM, BLUE, INK, RUST = (0.95, 0.93, 0.87), (0.25, 0.48, 0.58), (0.07, 0.14, 0.22), (0.85, 0.36, 0.16)


def pinwheels(size: int) -> FloatArray:
    """One tile, (size, size, 3) display colors from 0 to 1, the lowest row first; size is even.

    A quarter turn of the tile gives the same numbers, to the last bit.
    """
    steps = (np.arange(size // 2 * SAMPLES) + 0.5) / (size * SAMPLES)
    color = _color(*np.meshgrid(steps, steps))
    quadrant = color.reshape(size // 2, SAMPLES, size // 2, SAMPLES, 3).mean(axis=(1, 3))
    # Rows go up and columns right: turned once to the left the lower left quadrant is the lower right one.
    turned = [np.rot90(quadrant, -turns) for turns in range(4)]
    return np.concatenate(
        [np.concatenate([turned[0], turned[1]], axis=1), np.concatenate([turned[3], turned[2]], axis=1)]
    )


def bilinear(texture: FloatArray, uv: FloatArray) -> FloatArray:
    """Colors at texture coordinates, (n, 2) to (n, 3), the texture repeated, as renderers filter it."""
    size = len(texture)
    place = uv * size - 0.5
    first = np.floor(place)
    share = place - first
    column, row = (first % size).astype(int).T
    right, up = (column + 1) % size, (row + 1) % size
    x, y = share.T[..., None]
    low = (1 - x) * texture[row, column] + x * texture[row, right]
    high = (1 - x) * texture[up, column] + x * texture[up, right]
    return (1 - y) * low + y * high


def _color(u: FloatArray, v: FloatArray) -> FloatArray:
    """Colors at places of the tile, exact: a vane in each quarter of a tile that is twisted about its fixed points."""
    for center, angle in TWISTS:
        u, v = _twisted(u, v, center, angle)
    x, y = _in_one_vane(u, v)
    edge = np.minimum.reduce([x, y, 0.5 - x, 0.5 - y])
    color = np.where((x < 0.25)[..., None], BLUE, CREAM)
    color[np.abs(x - 0.25) < VEIN] = INK
    for (least, most), ink in ((LINE, INK), (OUTLINE, INK), (RIBBON, RUST)):
        color[(least <= edge) & (edge < most)] = ink
    return color


def _twisted(u: FloatArray, v: FloatArray, center: float, angle: float) -> tuple[FloatArray, FloatArray]:
    """Turned about (center, center) in every tile, by `angle` there and less and less up to half a tile away."""
    x, y = ((place - center + 0.5) % 1 - 0.5 for place in (u, v))
    near = np.clip(1 - 2 * np.hypot(x, y), 0, 1)
    turn = angle * near**2 * (3 - 2 * near)
    return u - x + np.cos(turn) * x - np.sin(turn) * y, v - y + np.sin(turn) * x + np.cos(turn) * y


def _in_one_vane(u: FloatArray, v: FloatArray) -> tuple[FloatArray, FloatArray]:
    """The place turned by quarters about the middle of the tile into the quarter from 0 to 0.5 both ways."""
    x, y = ((place + 0.5) % 1 - 0.5 for place in (u - 0.5, v - 0.5))
    for _ in range(3):
        outside = (x < 0) | (y < 0)
        x, y = np.where(outside, y, x), np.where(outside, -x, y)
    return x, y
