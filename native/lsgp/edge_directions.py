# SPDX-License-Identifier: GPL-3.0-or-later
"""Directions of the texture along edges."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .base import arguments
from .base.arguments import FloatArray, IndexArray
from .base.edge_keys import edge_keys
from .errors import InputError
from .surface import Surface, require_vertices

# Of a vector's largest component: what is less is rounding, and the vector is across that axis.
_ACROSS = 1e-6


def edge_directions(surface: Surface, edges: ArrayLike, *, up: ArrayLike | None = None) -> FloatArray:
    """Directions for `Surface.directions` with which v runs along edges, in the triangles on both sides of each.

    edges: (e, 2), each from its first vertex to its second, those named twice with twice the weight. up: (3,): edges
        run up instead, whatever the order of their vertices; those across it run along the z axis, those across that
        too along y, the rest along x. None: as named.
    Returns (m, 3). Every edge has the weight of its length, whatever size its triangles are; weights are such that
    vectors have length 1 on the average over the area of these triangles, as directions beside them may have.
    Raises InputError: EDGE_NOT_IN_MESH where no triangle has an edge.
    """
    require_vertices(surface)
    pairs = arguments.index_rows("edges", edges, 2)
    arguments.require_indices("edges", pairs, len(surface.positions))
    upright = None if up is None else arguments.floats_of_shape("up", up, (3,))
    if upright is not None and not (np.isfinite(upright).all() and upright.any()):
        arguments.refuse("up", up, "pass finite numbers that are not all 0")
    directions = np.zeros(surface.triangles.shape)
    row, triangle, tail = sides_of_edges(surface, pairs)
    if not len(row):
        return directions
    place = surface.positions[surface.triangles[triangle]]
    place = place - place[:, :1]
    largest = np.abs(place).max()
    if not (np.isfinite(largest) and largest > 0):
        return directions
    place /= largest
    along = place[np.arange(len(row)), (tail + 1) % 3] - place[np.arange(len(row)), tail]
    reverse = surface.triangles[triangle, tail] != pairs[row, 0]
    along[reverse] *= -1
    if upright is not None:
        along[~is_upward(along, upright)] *= -1
    area = np.linalg.norm(np.cross(place[:, 1], place[:, 2]), axis=1) / 2
    np.add.at(directions, triangle, np.divide(along, area[:, None], out=np.zeros_like(along), where=area[:, None] > 0))
    once = np.unique(triangle, return_index=True)[1]
    weight = np.linalg.norm(along[area > 0], axis=1).sum()
    return directions * (area[once].sum() / weight) if weight > 0 else directions


def is_upward(vectors: FloatArray, up: FloatArray) -> NDArray[np.bool_]:
    """(k,) which of the vectors, (k, 3), are rather along `up`, (3,), than against it; of those across it the ones that
    are along z, or else y, or else x."""
    parts = np.column_stack([(vectors * (up / math.hypot(*up))).sum(axis=1), vectors[:, ::-1]])
    counts = np.abs(parts) > _ACROSS * np.abs(vectors).max(axis=1, initial=0, keepdims=True)
    return parts[np.arange(len(parts)), counts.argmax(axis=1)] >= 0


def sides_of_edges(surface: Surface, edges: IndexArray) -> tuple[NDArray[np.intp], NDArray[np.intp], NDArray[np.intp]]:
    """Where triangles have edges, (e, 2): (s,) each, the row of the edge, a triangle that has it, and the corner from
    which it runs to the next one there, by rows.  Raises InputError: EDGE_NOT_IN_MESH."""
    sides = np.stack([surface.triangles, np.roll(surface.triangles, -1, axis=1)], axis=-1).reshape(-1, 2)
    keys, wanted = (edge_keys(ends[:, 0], ends[:, 1], len(surface.positions)) for ends in (sides, edges))
    order = np.argsort(keys, kind="stable")
    begin, end = (np.searchsorted(keys[order], wanted, where) for where in ("left", "right"))
    missing = np.flatnonzero((begin == end) | (edges[:, 0] == edges[:, 1]))
    if len(missing):
        a, b = edges[missing[0]].tolist()
        raise InputError(
            "EDGE_NOT_IN_MESH",
            f"There is no edge from vertex {a} to {b}, along which a direction is to run. Name edges of triangles.",
        )
    count = end - begin
    row = np.repeat(np.arange(len(edges)), count)
    side = order[np.arange(len(row)) - np.repeat(np.cumsum(count) - count, count) + np.repeat(begin, count)]
    return row, side // 3, side % 3
