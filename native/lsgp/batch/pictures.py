# SPDX-License-Identifier: GPL-3.0-or-later
"""A small picture of a result: on the left the surface under a checker, on the right its layout.

The checker shows where texels are large, small, turned or torn; the colours of the layout say the same as a figure: red
where the layout is larger than the surface, blue where it is smaller, by up to twice in length, magenta where it is
flipped.  Drawn by points spread over the triangles: that is quick, and exact enough for a picture of this size.
"""

from __future__ import annotations

import struct
import zlib
from functools import cache

import numpy as np
from numpy.typing import NDArray

from ..api import Result, Surface

Floats = NDArray[np.floating]

SIDE = 80
MARGIN = 4
POINTS_PER_PIXEL = 2
SQUARES = 18
VIEW = np.array([[0.8, 0.0, -0.6], [-0.2572, 0.9035, -0.3429], [0.5421, 0.4286, 0.7228]])  # rows: right, up, to the eye
GROUND = 255
SMALLER, EQUAL, LARGER = np.array([[40.0, 90.0, 200.0], [225.0, 225.0, 215.0], [205.0, 50.0, 30.0]])
FLIPPED = np.array([220.0, 0.0, 220.0])
LIGHT_SQUARE, DARK_SQUARE = np.array([[245.0, 240.0, 225.0], [70.0, 90.0, 120.0]])


def picture_of(surface: Surface, result: Result) -> bytes:
    """The picture as a PNG file, the same bytes for the same result."""
    solved = result.solved
    seen = (_into_unit(surface.positions) @ VIEW.T).astype(np.float32)[surface.triangles[solved]]
    uv = _into_unit(result.corner_uv[solved]).astype(np.float32)
    normal = np.cross(seen[:, 1] - seen[:, 0], seen[:, 2] - seen[:, 0])
    flipped = np.isin(np.flatnonzero(solved), result.flipped)
    return png(np.concatenate([_surface_picture(seen, normal, uv), _layout_picture(normal, uv, flipped)], axis=1))


def png(pixels: NDArray[np.uint8]) -> bytes:
    """Pixels (h, w, 3) as a PNG file."""
    height, width, _ = pixels.shape
    rows = np.concatenate([np.zeros((height, 1), np.uint8), pixels.reshape(height, -1)], axis=1)  # 0: no filter
    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    chunks = [(b"IHDR", header), (b"IDAT", zlib.compress(rows.tobytes(), 1)), (b"IEND", b"")]
    return b"\x89PNG\r\n\x1a\n" + b"".join(
        struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data)) for kind, data in chunks
    )


def _surface_picture(seen: Floats, normal: Floats, uv: Floats) -> NDArray[np.uint8]:
    """seen: (m, 3, 3), corners of triangles in the frame of VIEW. normal: (m, 3). uv: (m, 3, 2), of the corners."""
    flat = _into_square(seen[..., :2])
    length = _length(normal)
    light = 0.45 + 0.55 * np.abs(normal[:, 2]) / np.where(length > 0, length, 1)
    triangle, weights = _spread(flat)
    pixel = _pixels(flat, triangle, weights)
    (depth,) = _blend(seen[..., 2:], triangle, weights)
    place = np.floor(SQUARES * _blend(uv, triangle, weights)).sum(axis=0)
    # Of the points in a pixel those near the foremost one are seen.
    front = np.full(SIDE * SIDE, -np.inf, np.float32)
    np.maximum.at(front, pixel, depth)
    near = 2 * np.ptp(depth) / SIDE if len(depth) else 0.0
    shown = depth >= front[pixel] - near
    colour = np.where((place[shown] % 2 == 0)[:, None], LIGHT_SQUARE, DARK_SQUARE) * light[triangle[shown], None]
    return _mixed(pixel[shown], colour)


def _layout_picture(normal: Floats, uv: Floats, flipped: NDArray[np.bool_]) -> NDArray[np.uint8]:
    flat = _into_square(uv)
    triangle, weights = _spread(flat)
    area, uv_area = _length(normal), _double_area(uv)
    with np.errstate(all="ignore"):
        larger = 0.5 * np.log2(uv_area / uv_area.sum() * area.sum() / area)
    larger = np.clip(np.nan_to_num(larger, nan=0.0), -1, 1)[:, None]
    colour = EQUAL + np.maximum(larger, 0) * (LARGER - EQUAL) + np.maximum(-larger, 0) * (SMALLER - EQUAL)
    colour[flipped] = FLIPPED
    return _mixed(_pixels(flat, triangle, weights), colour[triangle])


def _into_unit(values: Floats) -> Floats:
    """Coordinates (..., d) moved and scaled, alike in all directions, into the unit cube."""
    if not values.size:
        return values
    lowest, highest = _bounds(values)
    extent = (highest - lowest).max()
    return (values - lowest) / (extent if extent > 0 else 1.0)


def _bounds(values: Floats) -> Floats:
    """The lowest and the highest of each coordinate, (2, d).  By columns, which is many times as fast as by axes."""
    columns = values.reshape(-1, values.shape[-1]).T
    return np.array([[column.min() for column in columns], [column.max() for column in columns]])


def _length(vectors: Floats) -> Floats:
    x, y, z = vectors.T
    return np.sqrt(x * x + y * y + z * z)


def _double_area(flat: Floats) -> Floats:
    """Twice the area of triangles (m, 3, 2)."""
    (ax, ay), (bx, by) = (flat[:, 1] - flat[:, 0]).T, (flat[:, 2] - flat[:, 0]).T
    return np.abs(ax * by - ay * bx)


def _into_square(values: Floats) -> Floats:
    """Coordinates (m, 3, 2) in pixels, in the middle of the picture."""
    unit = _into_unit(values)
    middle = _bounds(unit)[1] / 2 if len(unit) else 0.0
    return (unit - middle) * (SIDE - 2 * MARGIN) + SIDE / 2


def _spread(flat: Floats) -> tuple[NDArray[np.int64], Floats]:
    """Points spread evenly over triangles (m, 3, 2): the triangle of each and its barycentric coordinates (3, p)."""
    area = 0.5 * _double_area(flat)
    # Shares of a point are carried over to the next triangles.
    count = np.diff(np.floor(np.cumsum(area * POINTS_PER_PIXEL, dtype=float)), prepend=0.0).astype(np.int64)
    triangle = np.repeat(np.arange(len(flat)), count)
    number = np.arange(len(triangle)) - np.repeat(np.cumsum(count) - count, count)
    return triangle, _spread_points()[:, number]


@cache
def _spread_points() -> Floats:
    """Barycentric coordinates (3, p) of as many points as a triangle can have, the first of which are spread evenly as
    well: the sequence of Roberts in a square that is folded to a triangle."""
    number = np.arange(POINTS_PER_PIXEL * SIDE * SIDE + 1)
    a, b = (0.5 + number * 0.7548776662466927) % 1, (0.5 + number * 0.5698402909980532) % 1
    outside = a + b > 1
    a, b = np.where(outside, 1 - a, a), np.where(outside, 1 - b, b)
    return np.stack([1 - a - b, a, b]).astype(np.float32)


def _blend(values: Floats, triangle: NDArray[np.int64], weights: Floats) -> Floats:
    """Values (m, 3, d) at points, (d, p)."""
    return np.stack([sum(weights[i] * column[triangle, i] for i in range(3)) for column in np.moveaxis(values, 2, 0)])


def _pixels(flat: Floats, triangle: NDArray[np.int64], weights: Floats) -> NDArray[np.int64]:
    column, row = _blend(flat, triangle, weights).astype(np.int64)
    return np.clip(SIDE - 1 - row, 0, SIDE - 1) * SIDE + np.clip(column, 0, SIDE - 1)


def _mixed(pixel: NDArray[np.int64], colour: Floats) -> NDArray[np.uint8]:
    """The mean colour of the points in each pixel; an empty pixel among full ones takes the mean of theirs."""
    count = np.bincount(pixel, minlength=SIDE * SIDE)
    total = np.stack([np.bincount(pixel, colour[:, i], SIDE * SIDE) for i in range(3)], axis=1)
    inked = (count > 0).reshape(SIDE, SIDE)
    image = (total / np.maximum(count, 1)[:, None]).reshape(SIDE, SIDE, 3)
    beside = _sum_of_neighbours(inked.astype(float)[..., None])
    holes = ~inked & (beside[..., 0] >= 3)
    image[holes] = _sum_of_neighbours(image)[holes] / beside[holes]
    image[~(inked | holes)] = GROUND
    return np.rint(image).astype(np.uint8)


def _sum_of_neighbours(image: Floats) -> Floats:
    padded = np.pad(image, ((1, 1), (1, 1), (0, 0)))
    return padded[:-2, 1:-1] + padded[2:, 1:-1] + padded[1:-1, :-2] + padded[1:-1, 2:]
