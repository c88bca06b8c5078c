# SPDX-License-Identifier: GPL-3.0-or-later
"""Moves of islands of seamless layouts by whole cells, which keep a tileable texture free of visible seams.

Coordinates are stored in float32. A move by whole cells keeps the rotation of every cut and changes its translation
by a lattice vector; only the grid on which float32 represents both sides exactly may become coarser.

All functions raise InputError for arguments of other shapes and types than documented.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .base import arguments
from .base.arguments import FloatArray, IndexArray
from .base.unique_rows import unique_rows
from .errors import InputError

# Mantissa of float32: below 2^e it holds every multiple of 2^(e - 24).
_MANTISSA_BITS = 24
_QUARTER_TURNS = np.array([1, 1j, -1, -1j])
# Of the lattices: rotations are multiples of 2 pi / rotation_order.
_ROTATION_ORDERS = (1, 2, 3, 4, 6)


def whole_cells(shift: ArrayLike, rotation_order: int, cell: float) -> FloatArray:
    """Moves by whole cells near the given ones, (k, 2): the nearest in the nearest row of lattice points.

    rotation_order, cell: as in `SeamlessReport`.
    """
    rotation_order, cell = _cells(rotation_order, cell)
    x, y = _rows_of("shift", shift, 2).T
    gx, gy = _second_vector(rotation_order)
    rows = np.round(y / (gy * cell))
    return _points(np.round(x / cell - rows * gx), rows, rotation_order, cell)


def nearest_places(
    corner_uv: FloatArray, old_uv: FloatArray, island: IndexArray, rotation_order: int, cell: float
) -> FloatArray:
    """The move by whole cells, (islands, 2), that brings each island nearest to the former position of its corners.

    corner_uv, old_uv: (m, 3, 2). island: (m,), -1 for none. Islands with an old coordinate that is not finite do not
    move.
    """
    rotation_order, cell = _cells(rotation_order, cell)
    island = arguments.islands("island", island)
    corner_uv = arguments.corner_coordinates("corner_uv", corner_uv, len(island))
    old_uv = arguments.corner_coordinates("old_uv", old_uv, len(island))
    count = int(island.max(initial=-1)) + 1
    solved = island >= 0
    of_corner = np.repeat(island[solved], 3)
    away = (old_uv - corner_uv)[solved].reshape(-1, 2)
    corners = np.maximum(np.bincount(of_corner, minlength=count), 1)
    with np.errstate(invalid="ignore"):
        mean = np.stack([np.bincount(of_corner, away[:, i], count) for i in (0, 1)], axis=1) / corners[:, None]
    mean[~np.isfinite(mean).all(axis=1)] = 0.0
    return whole_cells(mean, rotation_order, cell)


def shelf_places(boxes: ArrayLike, rotation_order: int, cell: float) -> FloatArray:
    """Moves by whole cells, (k, 2), that put boxes onto shelves from the origin upwards; none overlaps another.

    boxes: (k, 4), the least u and v and the largest u and v of each. The tallest come first.
    """
    rotation_order, cell = _cells(rotation_order, cell)
    boxes = _rows_of("boxes", boxes, 4)
    if not (np.isfinite(boxes).all() and (boxes[:, 2:] >= boxes[:, :2]).all()):
        raise InputError("WRONG_PARAMETER", "boxes are not finite or have no inside; pass those of solved islands.")
    shifts = np.zeros((len(boxes), 2))
    if not len(boxes):
        return shifts
    sizes = boxes[:, 2:] - boxes[:, :2] + cell  # a box starts within a cell of where it may
    width = max(math.sqrt(sizes.prod(axis=1).sum()), sizes[:, 0].max())
    right = floor = ceiling = 0.0
    for i in np.argsort(-sizes[:, 1], kind="stable").tolist():
        if right > 0 and right + sizes[i, 0] > width:
            right, floor = 0.0, ceiling
        shifts[i] = _cells_beyond((right, floor) - boxes[i, :2], rotation_order, cell)
        right = boxes[i, 2] + shifts[i, 0]
        ceiling = max(ceiling, boxes[i, 3] + shifts[i, 1])
    return shifts


def island_boxes(corner_uv: FloatArray, island: IndexArray) -> FloatArray:
    """(islands, 4): the least u and v and the largest u and v of each island."""
    island = arguments.islands("island", island)
    corner_uv = arguments.corner_coordinates("corner_uv", corner_uv, len(island))
    count = int(island.max(initial=-1)) + 1
    solved = island >= 0
    order = np.argsort(island[solved], kind="stable")
    uv, island = corner_uv[solved][order], island[solved][order]
    least, largest = np.full((count, 2), np.inf), np.full((count, 2), -np.inf)
    first = np.flatnonzero(np.diff(island, prepend=-1))
    least[island[first]] = np.minimum.reduceat(uv.min(axis=1), first)
    largest[island[first]] = np.maximum.reduceat(uv.max(axis=1), first)
    return np.concatenate([least, largest], axis=1)


def shift_islands(
    triangles: IndexArray, corner_uv: FloatArray, island: IndexArray, cut_edges: IndexArray, shifts: FloatArray
) -> FloatArray:
    """Move islands of a seamless layout and round to float32, so that both sides of every cut still match.

    triangles: (m, 3). corner_uv: (m, 3, 2), island: (m,), cut_edges: (c, 2): of the `Result`. shifts: (islands, 2),
    whole cells each. If float32 is too coarse for the vertices of cuts at their new position, both sides are rounded to
    its grid together; cuts with third or sixth turns, which float32 never represents exactly, match up to rounding.
    Returns a new array.
    """
    island = arguments.islands("island", island)
    triangles = arguments.index_rows("triangles", triangles, 3)
    corner_uv = arguments.corner_coordinates("corner_uv", corner_uv, len(island))
    cut_edges = arguments.index_rows("cut_edges", cut_edges, 2)
    shifts = _rows_of("shifts", shifts, 2)
    if len(triangles) != len(island) or len(shifts) <= island.max(initial=-1):
        raise InputError(
            "WRONG_SHAPE",
            f"There are {len(triangles)} triangles, {len(island)} islands of triangles and {len(shifts)} shifts; pass "
            "an island for each triangle and a shift for each island.",
        )
    if not np.isfinite(shifts).all():
        raise InputError("WRONG_PARAMETER", "shifts are not all finite; pass whole cells for each island.")
    arguments.require_indices("triangles", triangles, np.iinfo(np.int32).max)
    arguments.require_indices("cut_edges", cut_edges, int(triangles.max(initial=-1)) + 1)
    lost = np.flatnonzero((island >= 0) & ~np.isfinite(corner_uv).all(axis=(1, 2)))
    if len(lost):
        raise InputError(
            "WRONG_PARAMETER",
            f"corner_uv is not finite at triangle {lost[0]}, which lies in an island; give such triangles island -1.",
        )
    with np.errstate(over="ignore"):
        moved = corner_uv + np.append(shifts, [[0.0, 0.0]], axis=0)[island][:, None, :]
    largest = float(np.finfo(np.float32).max)
    outside = np.flatnonzero((island >= 0) & (np.abs(moved) > largest).any(axis=(1, 2)))
    if len(outside):
        raise InputError(
            "WRONG_PARAMETER",
            f"The shift of island {island[outside[0]]} takes triangle {outside[0]} beyond {largest:.3g}, the largest "
            "number of float32; give smaller shifts.",
        )
    on_cut = np.isin(triangles.ravel(), cut_edges)
    corners = np.flatnonzero(on_cut & np.repeat(island >= 0, 3))
    flat = moved.reshape(-1, 2)
    if not np.array_equal(flat[corners], flat[corners].astype(np.float32)):
        flat[corners] = _on_coarser_grid(triangles, flat, island, cut_edges, corners)
    return moved.astype(np.float32).astype(np.float64)


def _on_coarser_grid(
    triangles: IndexArray, uv: FloatArray, island: IndexArray, cut_edges: IndexArray, corners: NDArray[np.intp]
) -> FloatArray:
    """New coordinates (k, 2) of these corners: multiples of what float32 resolves at the largest of all."""
    largest = float(np.abs(uv[corners]).max())
    step = 2.0 ** (math.ceil(math.log2(largest + 1)) - _MANTISSA_BITS)
    # A copy of a vertex on a cut: all corners that share its place.
    keys = np.stack([triangles.ravel()[corners], np.repeat(island, 3)[corners], *uv[corners].T], axis=1)
    _, first, copy_of, _ = unique_rows(keys)
    old = uv[corners[first]] @ (1, 1j)
    copy_at = np.full(len(uv), -1)
    copy_at[corners] = copy_of
    crossings: list[list[tuple[int, complex]]] = [[] for _ in old]
    for left, right, turn in _crossings(triangles, uv, island, cut_edges):
        a, b = copy_at[left], copy_at[right]
        crossings[a].append((b, turn))
        crossings[b].append((a, turn.conjugate()))

    # One copy is rounded, the others follow through the cuts they were related by.
    new = np.empty(len(old), complex)
    is_placed = np.zeros(len(old), bool)
    for start in range(len(old)):
        if is_placed[start]:
            continue
        is_placed[start] = True
        new[start] = complex(*(np.round(np.array([old[start].real, old[start].imag]) / step) * step))
        waiting = [start]
        while waiting:
            a = waiting.pop()
            for b, turn in crossings[a]:
                if not is_placed[b]:
                    is_placed[b] = True
                    new[b] = turn * new[a] + (old[b] - turn * old[a])
                    waiting.append(b)
    return np.stack([new.real, new.imag], axis=1)[copy_of]


def _crossings(
    triangles: IndexArray, uv: FloatArray, island: IndexArray, cut_edges: IndexArray
) -> Iterator[tuple[int, int, complex]]:
    """Corners left and right of the cuts, in pairs of the same vertex, where a quarter turn relates them exactly."""
    solved = np.flatnonzero(island >= 0)
    tail = (3 * solved[:, None] + np.arange(3)).ravel()
    head = (3 * solved[:, None] + [1, 2, 0]).ravel()
    vertex = triangles.ravel().astype(np.int64)
    size = int(vertex.max()) + 1
    low, high = np.minimum(vertex[tail], vertex[head]), np.maximum(vertex[tail], vertex[head])
    key = low * size + high
    on_cut = np.isin(key, cut_edges.min(axis=1).astype(np.int64) * size + cut_edges.max(axis=1))
    tail, head, key = tail[on_cut], head[on_cut], key[on_cut]
    order = np.argsort(key, kind="stable")
    # The first side of each edge with every other one; doubles of a triangle make more than two.
    _, first, edge = np.unique(key[order], return_index=True, return_inverse=True)
    left, right = order[first[edge.reshape(-1)]], order
    left, right = left[left != right], right[left != right]
    alike = vertex[tail[left]] == vertex[tail[right]]
    ends = np.where(alike, [tail[right], head[right]], [head[right], tail[right]])
    pairs = np.stack([tail[left], head[left], *ends])
    l0, l1, r0, r1 = uv[pairs] @ (1, 1j)
    related = _QUARTER_TURNS[:, None] * (l1 - l0) == r1 - r0
    for pair in np.flatnonzero(related.any(axis=0)).tolist():
        turn = complex(_QUARTER_TURNS[related[:, pair].argmax()])
        for side in (0, 1):
            yield int(pairs[side, pair]), int(pairs[side + 2, pair]), turn


def _cells(rotation_order: int, cell: float) -> tuple[int, float]:
    rotation_order = arguments.whole_number("rotation_order", rotation_order, 1, f"choose one of {_ROTATION_ORDERS}")
    arguments.require_choice("rotation_order", rotation_order, _ROTATION_ORDERS)
    return rotation_order, arguments.positive("cell", cell)


def _rows_of(name: str, values: ArrayLike, width: int) -> FloatArray:
    """(k, width); a single row may come without its axis."""
    array = arguments.as_array(name, values)
    return arguments.float_rows(name, array[None] if array.ndim == 1 and array.size else array, width)


def _second_vector(rotation_order: int) -> tuple[float, float]:
    """From a lattice point to its neighbor in the next row, in cells; in its own row the neighbor is at (1, 0)."""
    return (0.5, math.sqrt(3) / 2) if rotation_order in (3, 6) else (0.0, 1.0)


def _points(columns: FloatArray, rows: FloatArray, rotation_order: int, cell: float) -> FloatArray:
    gx, gy = _second_vector(rotation_order)
    return np.stack([columns + rows * gx, rows * gy], axis=-1) * cell


def _cells_beyond(shift: FloatArray, rotation_order: int, cell: float) -> FloatArray:
    """The smallest move by whole cells, first upwards, then to the right, that is no less than the given one."""
    gx, gy = _second_vector(rotation_order)
    rows = np.ceil(shift[1] / (gy * cell))
    return _points(np.ceil(shift[0] / cell - rows * gx), rows, rotation_order, cell)
