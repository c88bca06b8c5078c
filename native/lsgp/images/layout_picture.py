# SPDX-License-Identifier: GPL-3.0-or-later
"""A picture of a layout: islands, cuts and cones, over the unit squares in which they lie."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..base import arguments
from ..base.arguments import FloatArray, IndexArray
from ..base.edge_keys import edge_keys, side_keys
from ..base.progress import UNTOLD
from ..indexed_uv import index_uv
from ..results import Result
from ..surface import Surface, require_vertices
from .texel_raster import ComplexArray, Shape, centers, covering_triangles, nearest_points, nearest_segments, to_pixels

LEAST_SIZE, MOST_SIZE = 64, 8192
# Parts of the picture's longer side.
MARGIN = 1 / 64
BOUNDARY_WIDTH, CUT_WIDTH, CONE_WIDTH, RIM_WIDTH = 1 / 512, 1 / 256, 1 / 80, 1 / 512
MOST_LINES = 24

PAPER, INK = (252, 251, 248), (52, 58, 68)
LINE_SHADE, UNIT_SHADE = 0.06, 0.25  # parts of INK over what is below
# As in the add-on's overlay: cuts take them in turn, and lighter ones in every other round.
CUT_COLORS = ("#d6336c", "#2b9348", "#7b4fc9", "#e3b505", "#12a0a0", "#c23fb5", "#87991a", "#3c9be0", "#c2703d")
TIP, SADDLE, FLAT = (255, 128, 26), (51, 140, 255), (191, 191, 191)
FULL_CURVATURE = math.pi / 2  # radians, from which a cone has the color of tips or saddles
FLIPPED, OVERLAPPING = (255, 13, 13), (217, 26, 242)


def draw_layout(surface: Surface, result: Result, *, size: int = 1024) -> NDArray[np.uint8]:
    """The layout of a result as a picture, (height, width, 3), red, green, blue; `write_png` writes it into a file.

    The picture has all unit squares in which the layout lies, v upwards. Every island has a fill of its own. Both sides
    of a cut have the same color; boundaries are dark. Cones are orange where the surface is tip-like, blue where it is
    saddle-like and gray where it is flat. Flipped triangles are red, overlapping ones magenta. Triangles without
    coordinates are not drawn.

    size: pixels of the longer side, 64 to 8192.
    Raises InputError: WRONG_PARAMETER; WRONG_SHAPE if the result is one of another surface.

    >>> lsgp.draw_layout(surface, lsgp.auto_unwrap(surface)).shape
    (1024, 1024, 3)
    """
    require_vertices(surface)
    arguments.require_type("result", result, Result)
    remedy = f"pass pixels of the longer side, {LEAST_SIZE} to {MOST_SIZE}"
    if arguments.whole_number("size", size, LEAST_SIZE, remedy) > MOST_SIZE:
        arguments.refuse("size", size, remedy)
    corner_uv = arguments.corner_coordinates("result.corner_uv", result.corner_uv, len(surface.triangles))

    drawn = np.isfinite(corner_uv).all(axis=(1, 2))
    view = _View.of(corner_uv[drawn].reshape(-1, 2), size)
    corners = view.places(np.where(drawn[:, None, None], corner_uv, math.nan))
    canvas = _Canvas(_repeated(PAPER, view.shape[0] * view.shape[1]), view.shape)
    canvas.fill(corners, _fills(result.island))
    for triangles, color in ((result.overlapping, OVERLAPPING), (result.flipped, FLIPPED)):
        canvas.fill(corners[triangles], _repeated(color, len(triangles)))
    canvas.rule(view)

    sides = np.stack([corners, corners[:, [1, 2, 0]]], axis=2).reshape(-1, 2)
    path = np.where(np.repeat(drawn, 3), _paths_of_sides(surface, result.cut_paths), -1)
    is_cut, is_boundary = path >= 0, _have_no_partner(index_uv(surface.triangles, corner_uv)[1]) & (path < 0)
    canvas.stroke(sides[is_boundary], _repeated(INK, np.count_nonzero(is_boundary)), BOUNDARY_WIDTH * size)
    canvas.stroke(sides[is_cut], _cut_colors(path[is_cut]), CUT_WIDTH * size)

    cone, at = _cones_in_layout(surface, result.cones, corners)
    dots = np.stack([at, at], axis=1)
    canvas.stroke(dots, _repeated(INK, len(dots)), (CONE_WIDTH + 2 * RIM_WIDTH) * size)
    canvas.stroke(dots, _cone_colors(surface, result)[cone], CONE_WIDTH * size)
    return np.rint(canvas.pixels).astype(np.uint8).reshape(*view.shape, 3)


class _View(NamedTuple):
    """What is drawn of the plane, whole unit squares, and where.

    low: its corner in texture coordinates. extent: width and height in these. margin: pixels around it. scale: pixels
    of one unit. shape: of the picture, height and width.
    """

    low: FloatArray
    extent: FloatArray
    margin: int
    scale: float
    shape: Shape

    @classmethod
    def of(cls, uv: FloatArray, size: int) -> _View:
        """That of coordinates (k, 2), with `size` pixels along its longer side."""
        low, high = (uv.min(axis=0), uv.max(axis=0)) if len(uv) else (np.zeros(2), np.ones(2))
        beyond = 1e-6 * (high - low).max()  # the square that coordinates have left by rounding
        low = np.floor(low + beyond)
        extent = np.maximum(np.ceil(high - beyond) - low, 1.0)
        margin = math.ceil(MARGIN * size)
        scale = float((size - 2 * margin) / extent.max())
        width, height = np.maximum(np.rint(scale * extent), 1).astype(int) + 2 * margin
        return cls(low, extent, margin, scale, (int(height), int(width)))

    def places(self, uv: FloatArray) -> ComplexArray:
        """Places (...) in the picture of coordinates (..., 2)."""
        inside = (self.shape[0] - 2 * self.margin, self.shape[1] - 2 * self.margin)
        return self.margin * (1 + 1j) + to_pixels((uv - self.low) / self.extent, inside)


class _Canvas(NamedTuple):
    """pixels: (height * width, 3), row by row. shape: height and width."""

    pixels: FloatArray
    shape: Shape

    def fill(self, corners: ComplexArray, colors: FloatArray) -> None:
        """Triangles, (k, 3); where several are, the first. Their borders are jagged: lines are drawn over them."""
        owner = covering_triangles(corners, self.shape)
        covered = owner >= 0
        self.pixels[covered] = colors[owner[covered]]

    def rule(self, view: _View) -> None:
        """Thin lines over everything: the borders of unit squares and of equal parts of them, or of several squares
        where there are many."""
        step = 2.0 ** math.ceil(math.log2(view.extent.max() / MOST_LINES))
        shades = []
        for length, extent in zip(self.shape, view.extent[::-1], strict=True):
            value = np.arange(0.0, extent + 0.5 * step, step)
            last = length - 2 * view.margin - 1
            at = view.margin + np.minimum(np.rint(value * view.scale).astype(int), last)
            shade = np.zeros(length)
            shade[at] = np.where((value % 1 == 0) & (step < 1), UNIT_SHADE, LINE_SHADE)
            shades.append(shade)
        rows, columns = shades[0][::-1], shades[1]
        share = np.maximum(rows[:, None], columns)
        inside = np.zeros(self.shape, bool)
        inside[view.margin : -view.margin, view.margin : -view.margin] = True
        self._blend(np.flatnonzero(inside), np.float64(INK), share[inside])

    def stroke(self, segments: ComplexArray, colors: FloatArray, width: float) -> None:
        """Segments, (k, 2), with round ends; where several are, the nearest."""
        pieces, rows = _short_pieces(segments, 4 * width)
        reach = 0.5 * max(width, 1.0) + 0.5
        nearest = nearest_segments(pieces, reach, np.ones(len(self.pixels), bool), self.shape, UNTOLD)
        pixels = np.flatnonzero(nearest >= 0)
        nearest, at = nearest[pixels], centers(pixels, self.shape[1])
        distance = np.abs(at - nearest_points(pieces[nearest], at))
        self._blend(pixels, colors[rows[nearest]], np.clip(reach - distance, 0, 1))

    def _blend(self, pixels: NDArray[np.intp], colors: FloatArray, share: FloatArray) -> None:
        self.pixels[pixels] += share[:, None] * (colors - self.pixels[pixels])


def _short_pieces(segments: ComplexArray, length: float) -> tuple[ComplexArray, NDArray[np.intp]]:
    """Segments in pieces of at most this length, whose bounding boxes have few pixels, and the segment of each."""
    along = segments[:, 1] - segments[:, 0]
    count = np.maximum(np.ceil(np.abs(along) / length), 1).astype(int)
    rows = np.repeat(np.arange(len(segments)), count)
    number = np.arange(len(rows)) - np.repeat(np.cumsum(count) - count, count)
    starts, steps = segments[rows, 0], along[rows] / count[rows]
    return np.stack([starts + number * steps, starts + (number + 1) * steps], axis=1), rows


def _repeated(color: Sequence[float], count: int) -> FloatArray:
    return np.tile(np.array(color, np.float64), (count, 1))


def _fills(island: IndexArray) -> FloatArray:
    """Soft colors (m, 3): hues apart by the golden section, which repeats none, so that those of islands that follow
    each other differ most."""
    hue = island[:, None] * 0.6180339887 + np.array([1, 2, 3]) / 3
    return 218 - 10 * (island % 2)[:, None] + 26 * np.cos(2 * math.pi * hue)


def _cut_colors(path: NDArray[np.int64]) -> FloatArray:
    """(k, 3) of the paths with these numbers."""
    colors = np.array([list(bytes.fromhex(color[1:])) for color in CUT_COLORS], np.float64)
    turn, place = np.divmod(path, len(colors))
    return np.where(turn[:, None] % 2 == 1, 0.5 * (colors[place] + 255), colors[place])


def _paths_of_sides(surface: Surface, paths: Sequence[IndexArray]) -> NDArray[np.int64]:
    """(3 m,), the number of the path along each side of each triangle, from corner c to c + 1; -1: none."""
    count = len(surface.positions)
    keys = [edge_keys(path[:-1], path[1:], count) for path in paths]
    numbers = np.repeat(np.arange(len(paths)), [len(of_path) for of_path in keys])
    along = np.concatenate([np.empty(0, np.int64), *keys])
    order = np.argsort(along, kind="stable")
    sides = side_keys(surface.triangles, count)
    at = np.searchsorted(along[order], sides)
    found = np.append(along[order], -1)[at] == sides
    return np.where(found, np.append(numbers[order], -1)[at], -1)


def _have_no_partner(corners: IndexArray) -> NDArray[np.bool_]:
    """(3 m,), whether each side of each triangle, (m, 3) with -1 in those that do not count, is a side of no other."""
    keys = side_keys(corners, int(corners.max(initial=0)) + 1)
    counts = np.repeat((corners >= 0).all(axis=1), 3)
    _, index, times = np.unique(keys[counts], return_inverse=True, return_counts=True)
    counts[counts] = times[index] == 1
    return counts


def _cones_in_layout(
    surface: Surface, cones: IndexArray, corners: ComplexArray
) -> tuple[NDArray[np.intp], ComplexArray]:
    """Of all places (d,) of cones in the picture, one for each corner there: the cone, a row of `cones`; the place."""
    row = np.full(len(surface.positions), -1)
    row[cones] = np.arange(len(cones))
    of_corner = row[surface.triangles]
    marked = (of_corner >= 0) & ~np.isnan(corners)
    return of_corner[marked], corners[marked]


def _cone_colors(surface: Surface, result: Result) -> FloatArray:
    """(k, 3), by the curvature of each."""
    on_boundary = np.zeros(len(surface.positions), bool)
    on_boundary[surface.triangles.ravel()[_have_no_partner(surface.triangles)]] = True
    curvature = np.where(on_boundary[result.cones], math.pi, 2 * math.pi) - result.cone_angles
    full = np.where(curvature[:, None] > 0, TIP, SADDLE)
    return FLAT + np.minimum(np.abs(curvature) / FULL_CURVATURE, 1)[:, None] * (full - np.float64(FLAT))
