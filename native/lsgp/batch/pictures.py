# SPDX-License-Identifier: GPL-3.0-or-later
"""A small picture of a result: on the left the surface under a checker, on the right its layout.

The checker shows where texels are large, small, turned or torn; the colors of the layout show the scale: red
where the layout is larger than the surface, blue where it is smaller, by up to twice in length, magenta where it is
flipped.  Drawn by points spread over the triangles: that is quick, and exact enough for a picture of this size.

Arrays are by columns, (coordinate, corner, triangle) or (coordinate, point), which is several times as fast as by rows.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..io.png_files import png
from ..io.whole_files import write_whole
from ..results import Result
from ..surface import Surface

Floats = NDArray[np.floating]

SIDE = 80
MARGIN = 4
POINTS_PER_PIXEL = 2
SQUARES = 18
SLACK = 2.0  # pixels of depth in which points are seen beside each other
VIEW = np.array([[0.8, 0.0, -0.6], [-0.2572, 0.9035, -0.3429], [0.5421, 0.4286, 0.7228]])  # rows: right, up, to the eye
GROUND = 255
LEVELS = 31  # of each color above none; more are hardly seen, but make files half as large again
SMALLER, EQUAL, LARGER = np.array([[40, 90, 200], [225, 225, 215], [205, 50, 30]], np.float32)
FLIPPED = np.array([220, 0, 220], np.float32)
LIGHT_SQUARE, DARK_SQUARE = np.array([[245, 240, 225], [70, 90, 120]], np.float32)


def picture_of(surface: Surface, result: Result) -> bytes:
    """The picture as a PNG file, the same bytes for the same result."""
    solved = result.solved
    seen = _into_square(np.take(VIEW @ surface.positions.T, surface.triangles[solved].T, axis=1))
    uv = _into_square(result.corner_uv[solved].T)
    normal = _cross(seen[:, 1] - seen[:, 0], seen[:, 2] - seen[:, 0])
    flipped = np.isin(np.flatnonzero(solved), result.flipped)
    return png(np.concatenate([_surface_picture(seen, normal, uv), _layout_picture(normal, uv, flipped)], axis=1))


def write_picture(path: Path, surface: Surface, result: Result) -> None:
    """Write the picture into a folder that is made where it is missing.  Raises OSError."""
    path.parent.mkdir(parents=True, exist_ok=True)
    write_whole(path, picture_of(surface, result))


def _surface_picture(seen: Floats, normal: Floats, uv: Floats) -> NDArray[np.uint8]:
    """seen: (3, 3, m), in the frame of VIEW. normal: (3, m). uv: (2, 3, m)."""
    points = Points.spread(seen[:2], np.abs(normal[2]))
    (depth,) = points.values(seen[2:])
    points = points.where(depth >= _front(points.pixel, depth)[points.pixel] - SLACK)
    column, row = (points.values(uv) * (SQUARES / (SIDE - 2 * MARGIN))).astype(np.int32)
    length = _length(normal)
    light = 0.45 + 0.55 * np.abs(normal[2]) / np.where(length > 0, length, 1)
    squares = np.where((column + row) % 2 == 0, LIGHT_SQUARE[:, None], DARK_SQUARE[:, None])
    return _mixed(points.pixel, squares * light[points.triangle])


def _front(pixel: NDArray[np.intp], depth: Floats) -> Floats:
    """The depth of what is seen in each pixel.  Infinite, so that nothing is seen, where all points lie behind those of
    the pixels around: the surface goes on there, and no point happened to fall on it."""
    front = np.full(SIDE * SIDE, -np.inf, np.float32)
    np.maximum.at(front, pixel, depth)
    nearer = _around(front, np.arange(SIDE * SIDE)) > front + 2 * SLACK
    front[np.count_nonzero(nearer, axis=0) >= 3] = np.inf
    return front


def _layout_picture(normal: Floats, uv: Floats, flipped: NDArray[np.bool_]) -> NDArray[np.uint8]:
    area, (uv_area,) = _length(normal), np.abs(_cross(uv[:, 1] - uv[:, 0], uv[:, 2] - uv[:, 0]))
    points = Points.spread(uv, uv_area)
    with np.errstate(all="ignore"):
        larger = 0.5 * np.log2(uv_area / uv_area.sum() * area.sum() / area)
    larger = np.clip(np.nan_to_num(larger, nan=0.0), -1, 1)[points.triangle]
    most = np.where(larger > 0, (LARGER - EQUAL)[:, None], (SMALLER - EQUAL)[:, None])
    color = EQUAL[:, None] + np.abs(larger) * most
    return _mixed(points.pixel, np.where(flipped[points.triangle], FLIPPED[:, None], color))


@dataclass(frozen=True)
class Points:
    """Points spread over triangles. triangle: (p,), of each. weights: (3, p), barycentric. pixel: (p,), where it is."""

    triangle: NDArray[np.intp]
    weights: Floats
    pixel: NDArray[np.intp]

    @classmethod
    def spread(cls, flat: Floats, double_area: Floats) -> Points:
        """Evenly over triangles (2, 3, m) in the square of the picture."""
        # Shares of a point are carried over to the next triangles.
        ends = np.cumsum(0.5 * POINTS_PER_PIXEL * double_area, dtype=float).astype(np.intp)
        count = np.diff(ends, prepend=0)
        triangle = np.repeat(np.arange(len(count)), count)
        number = np.arange(len(triangle)) - (ends - count)[triangle]
        weights = np.take(_even_weights(), number, axis=1, mode="clip")
        column, row = _blend(flat, triangle, weights).astype(np.intp)
        return cls(triangle, weights, (SIDE - 1 - row) * SIDE + column)

    def where(self, keep: NDArray[np.bool_]) -> Points:
        return Points(self.triangle[keep], np.compress(keep, self.weights, axis=1), self.pixel[keep])

    def values(self, at_corners: Floats) -> Floats:
        """Values (d, 3, m) of corners at the points, (d, p)."""
        return _blend(at_corners, self.triangle, self.weights)


def _blend(at_corners: Floats, triangle: NDArray[np.intp], weights: Floats) -> Floats:
    return np.einsum("dcp,cp->dp", np.take(at_corners, triangle, axis=2, mode="clip"), weights)


@cache
def _even_weights() -> Floats:
    """Barycentric coordinates (3, p) of as many points as a triangle can have, the first of which are spread evenly as
    well: the sequence of Roberts in a square that is folded to a triangle."""
    number = np.arange(POINTS_PER_PIXEL * SIDE * SIDE + 1)
    a, b = (0.5 + number * 0.7548776662466927) % 1, (0.5 + number * 0.5698402909980532) % 1
    outside = a + b > 1
    a, b = np.where(outside, 1 - a, a), np.where(outside, 1 - b, b)
    return np.stack([1 - a - b, a, b]).astype(np.float32)


def _into_square(values: Floats) -> Floats:
    """Coordinates (2 or 3, 3, m) in pixels, the first two in the middle of the picture, its margins free."""
    columns = values.reshape(len(values), -1)
    if not columns.size:
        return values
    lowest, highest = columns.min(axis=1), columns.max(axis=1)
    extent = (highest - lowest)[:2].max()
    pixel = (extent if extent > 0 else 1.0) / (SIDE - 2 * MARGIN)
    columns = (columns - 0.5 * (lowest + highest)[:, None]) / pixel + SIDE / 2
    return columns.astype(np.float32).reshape(values.shape)


def _cross(a: Floats, b: Floats) -> Floats:
    """The cross product of vectors (3, m), or the one coordinate it has, (1, m), of vectors (2, m)."""
    z = a[0] * b[1] - a[1] * b[0]
    return np.stack([z] if len(a) == 2 else [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], z])


def _length(vectors: Floats) -> Floats:
    x, y, z = vectors
    return np.sqrt(x * x + y * y + z * z)


def _mixed(pixel: NDArray[np.intp], color: Floats) -> NDArray[np.uint8]:
    """The mean color (3, p) of the points in each pixel; an empty pixel among full ones takes the mean of theirs."""
    sums = np.stack([np.bincount(pixel, weights, SIDE * SIDE) for weights in (None, *color)])
    empty = np.flatnonzero(sums[0] == 0)
    holes = empty[np.count_nonzero(_around(sums[0], empty), axis=0) >= 3]
    sums[:, holes] = _around(sums, holes).sum(axis=1)
    count, image = sums[0], sums[1:]
    image = np.where(count > 0, image / np.maximum(count, 1), GROUND)
    image = np.rint(image * (LEVELS / 255)) * (255 / LEVELS)
    return image.astype(np.uint8).T.reshape(SIDE, SIDE, 3)


def _around(image: Floats, pixel: NDArray[np.intp]) -> Floats:
    """What an image (..., SIDE * SIDE) has in the four pixels beside each of some: (..., 4, k)."""
    return np.take(image, pixel + np.array([[-SIDE], [-1], [1], [SIDE]]), axis=-1, mode="wrap")  # margins are empty
