# SPDX-License-Identifier: GPL-3.0-or-later
"""Images of tiles that make a UV map visible: a checker, and a tile whose rotation and mirroring can be seen."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

# Texels along a side of the image, where the number of tiles divides it; and at least along a side of a tile, that its
# pattern is seen.
SIZE, LEAST = 1024, {"CHECKER": 8, "ASYMMETRIC": 64}

DARK, LIGHT = (0.30, 0.36, 0.42), (0.88, 0.87, 0.83)
# Bars of the letter F in the asymmetric tile: left, bottom, right, top as fractions of the tile.
LETTER = ((0.30, 0.20, 0.42, 0.80), (0.30, 0.68, 0.72, 0.80), (0.30, 0.45, 0.60, 0.57))
INK, RIM = (0.10, 0.12, 0.16), (0.98, 0.98, 0.96)
RIM_WIDTH, CORNER = 0.02, 0.12
# At the corners of a tile, from (0, 0) along u and then up.
CORNERS = ((0.85, 0.20, 0.15), (0.95, 0.75, 0.10), (0.15, 0.55, 0.25), (0.15, 0.35, 0.80))


def picture(pattern: str, tiles: int, repeated: float = 1.0) -> NDArray[np.float32]:
    """(s, s, 4) values from 0 to 1, bottom row first, showing tiles² tiles; s is SIZE or a little less.

    repeated: how often the image is seen side by side. It gets so many times less texels: where several are in one
    pixel, and Blender's solid views take a single one, squares would become a moire.
    """
    side = max(int(SIZE / max(repeated, 1.0)) // tiles // 2 * 2, min(LEAST[pattern], SIZE // tiles // 2 * 2), 2)
    tile = {"CHECKER": _checker, "ASYMMETRIC": _asymmetric}[pattern](side)
    whole = np.tile(tile, (tiles, tiles, 1))
    if pattern == "ASYMMETRIC":
        whole *= _tints(tiles, side)
    return np.concatenate([whole, np.ones((*whole.shape[:2], 1))], axis=2).astype(np.float32)


def _checker(side: int) -> NDArray[np.float64]:
    half = np.arange(side) < side // 2
    return np.where((half[:, None] == half)[..., None], DARK, LIGHT)


def _asymmetric(side: int) -> NDArray[np.float64]:
    v, u = np.meshgrid(*[(np.arange(side) + 0.5) / side] * 2, indexing="ij")
    tile = np.broadcast_to(LIGHT, (side, side, 3)).copy()
    for color, (x, y) in zip(CORNERS, ((0, 0), (1, 0), (1, 1), (0, 1)), strict=True):
        tile[np.maximum(np.abs(u - x), np.abs(v - y)) < CORNER] = color
    tile[np.minimum.reduce([u, v, 1 - u, 1 - v]) < RIM_WIDTH] = RIM
    for left, low, right, high in LETTER:
        tile[(left <= u) & (u < right) & (low <= v) & (v < high)] = INK
    return tile


def _tints(tiles: int, side: int) -> NDArray[np.float64]:
    """A tint for each tile, so that neighboring tiles differ."""
    row, column = np.meshgrid(np.arange(tiles), np.arange(tiles), indexing="ij")
    tint = np.stack([0.80 + 0.20 * column / tiles, np.full((tiles, tiles), 0.92), 0.80 + 0.20 * row / tiles], axis=2)
    return np.repeat(np.repeat(tint, side, axis=0), side, axis=1)
