# SPDX-License-Identifier: GPL-3.0-or-later
"""Texels of an image: which triangle covers each, which border is nearest, which covered texel is nearest.

Places in an image are complex numbers in pixels, x to the right and y down: the center of the texel in row i and column
j is (j + 1/2) + (i + 1/2) 1j, and (u, v) lies at u width + (1 - v) height 1j.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..base.arguments import FloatArray
from ..base.progress import UNTOLD, Steps

ComplexArray = NDArray[np.complex128]
Indices = NDArray[np.int64]
Shape = tuple[int, int]

# Pairs of a shape and a texel that are looked at together: bounds the memory.
_PAIRS_AT_ONCE = 1 << 20
# In pixels; what is this near to an edge counts as on it.
ON_EDGE = 1e-9


def to_pixels(corner_uv: FloatArray, shape: Shape) -> ComplexArray:
    """Places (...) of texture coordinates (..., 2) in an image of (height, width) texels."""
    height, width = shape
    return corner_uv[..., 0] * width + 1j * ((1 - corner_uv[..., 1]) * height)


def centers(texels: Indices, width: int) -> ComplexArray:
    """Places of texels that are numbered row by row."""
    return texels % width + 0.5 + 1j * (texels // width + 0.5)


def cross(a: ComplexArray, b: ComplexArray) -> FloatArray:
    """Twice the area that two vectors span."""
    return a.real * b.imag - a.imag * b.real


def edge_distances(corners: ComplexArray, places: ComplexArray) -> FloatArray:
    """(k, 3), how far places lie inside each edge of triangles, by their orientation; edge c is from corner c to c + 1.

    corners: (k, 3), of triangles with an area. places: (k,).
    """
    along = corners[:, [1, 2, 0]] - corners
    turn = np.sign(cross(along[:, 0], along[:, 1]))
    return turn[:, None] * cross(along, places[:, None] - corners) / np.abs(along)


def covering_triangles(corners: ComplexArray, shape: Shape, steps: Steps = UNTOLD) -> Indices:
    """(height * width,), the first triangle that the center of each texel is in; -1: it is in none.

    corners: (m, 3); triangles that are not finite or have no area cover nothing. steps: told of.  Raises Cancelled.
    """
    owner = np.full(shape[0] * shape[1], -1, np.int64)
    usable = np.flatnonzero(has_area(corners))
    for rows, texels in _pairs(corners[usable], 0.0, shape):
        steps.tell()
        triangles = usable[rows]
        inside = (edge_distances(corners[triangles], centers(texels, shape[1])) >= -ON_EDGE).all(axis=1)
        triangles, texels = triangles[inside], texels[inside]
        free = owner[texels] < 0
        # Of several values for one texel the last stays.
        owner[texels[free][::-1]] = triangles[free][::-1]
    return owner


def has_area(corners: ComplexArray) -> NDArray[np.bool_]:
    """Of triangles, (m, 3): finite and with an area that counts in pixels."""
    sides = corners[:, [1, 2, 0]] - corners
    with np.errstate(invalid="ignore"):
        return np.abs(cross(sides[:, 0], sides[:, 1])) > ON_EDGE * np.abs(sides).max(axis=1, initial=0.0)


def nearest_segments(
    segments: ComplexArray, margin: float, empty: NDArray[np.bool_], shape: Shape, steps: Steps
) -> Indices:
    """(height * width,), the segment nearest to the center of each empty texel, no farther than margin; -1: none.

    segments: (k, 2). empty: (height * width,). steps: told of.  Raises Cancelled.
    """
    nearest = np.full(len(empty), -1, np.int64)
    least = np.full(len(empty), np.nextafter(margin, math.inf))
    for rows, texels in _pairs(segments, margin, shape):
        steps.tell()
        wanted = empty[texels]
        rows, texels = rows[wanted], texels[wanted]
        places = centers(texels, shape[1])
        distance = np.abs(places - nearest_points(segments[rows], places))
        before = least[texels]
        np.minimum.at(least, texels, distance)
        nearer = (distance == least[texels]) & (distance < before)
        nearest[texels[nearer][::-1]] = rows[nearer][::-1]
    return nearest


def nearest_points(segments: ComplexArray, places: ComplexArray) -> ComplexArray:
    """(k,), the points of segments, (k, 2), that are nearest to places, (k,)."""
    start, along = segments[:, 0], segments[:, 1] - segments[:, 0]
    length = np.maximum(np.abs(along) ** 2, np.finfo(float).tiny)
    return start + np.clip(((places - start) * along.conj()).real / length, 0, 1) * along


def nearest_covered(texels: Indices, covered: NDArray[np.bool_], reach: int, steps: Steps) -> Indices:
    """(k,), the covered texel nearest to each of these, at most `reach` columns and rows away; -1: there is none.

    covered: (height, width). steps: told of.  Raises Cancelled.
    Exact: the nearest of each column is found first, the nearest column after it.
    """
    if not len(texels):
        return texels
    width = covered.shape[1]
    in_column = _nearest_in_columns(covered)
    row, column = texels // width, texels % width
    least, found = np.full(len(texels), np.inf), np.full(len(texels), -1, np.int64)
    for step in sorted(range(-reach, reach + 1), key=abs):
        steps.tell()
        there = np.clip(column + step, 0, width - 1)
        above = in_column[row, there].astype(np.int64)
        distance = np.where(above < 0, np.inf, (there - column) ** 2.0 + (above - row) ** 2.0)
        nearer = (distance < least) & (np.abs(above - row) <= reach)
        least[nearer], found[nearer] = distance[nearer], (above * width + there)[nearer]
    return found


def _nearest_in_columns(covered: NDArray[np.bool_]) -> NDArray[np.int32]:
    """(height, width), the row of the nearest covered texel of the same column; -1: there is none."""
    height = np.int32(len(covered))
    rows = np.arange(height, dtype=np.int32)[:, None]
    above = np.maximum.accumulate(np.where(covered, rows, np.int32(-1)), axis=0)
    below = np.minimum.accumulate(np.where(covered, rows, height)[::-1], axis=0)[::-1]
    takes_below = (below < height) & ((above < 0) | (below - rows < rows - above))
    return np.where(takes_below, below, above)


def _pairs(points: ComplexArray, margin: float, shape: Shape) -> Iterator[tuple[Indices, Indices]]:
    """Rows of points, (k, c), and texels whose centers are within the margin of the rows' bounding boxes; in the order
    of rows, a limited number at once."""
    first_x, count_x = _range(points.real, margin, shape[1])
    first_y, count_y = _range(points.imag, margin, shape[0])
    # One line of texels of one row's box after the other.
    for rows, line in _expanded(count_y * (count_x > 0), _PAIRS_AT_ONCE // max(shape[1], 1) + 1):
        starts = (first_y[rows] + line) * shape[1] + first_x[rows]
        for of_line, step in _expanded(count_x[rows], _PAIRS_AT_ONCE):
            yield rows[of_line], starts[of_line] + step


def _range(values: FloatArray, margin: float, size: int) -> tuple[Indices, Indices]:
    """(k,) the first texel and how many, along one axis, with centers within the margin of values, (k, c)."""
    first = np.clip(np.ceil(values.min(axis=1, initial=np.inf) - margin - 0.5 - ON_EDGE), 0, size)
    last = np.clip(np.floor(values.max(axis=1, initial=-np.inf) + margin - 0.5 + ON_EDGE), -1, size - 1)
    return first.astype(np.int64), np.maximum(last - first + 1, 0).astype(np.int64)


def _expanded(counts: Indices, most: int) -> Iterator[tuple[Indices, Indices]]:
    """Each index as often as its count says, and the numbers from 0 below its count; up to about `most` at once."""
    ends = np.cumsum(counts)
    begin = 0
    while begin < len(counts):
        done = ends[begin - 1] if begin else 0
        end = max(int(np.searchsorted(ends, done + most, side="right")), begin + 1)
        part = counts[begin:end]
        index = np.repeat(np.arange(begin, end), part)
        yield index, np.arange(len(index)) - np.repeat(np.cumsum(part) - part, part)
        begin = end


def as_rows(image: NDArray[Any]) -> NDArray[Any]:
    """(height * width, channels) of an image with or without an axis of channels."""
    return image.reshape(image.shape[0] * image.shape[1], -1)
