# SPDX-License-Identifier: GPL-3.0-or-later
"""Edges that are to run straight along u or v."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .base import arguments
from .base.angles import arctan2
from .base.arguments import FloatArray, IndexArray
from .base.edge_keys import edge_keys
from .base.unique_rows import unique_rows
from .surface import Surface, require_vertices


def feature_edges(
    surface: Surface, *, angle: float | None = None, seams: bool = False, borders: bool = False
) -> IndexArray:
    """Edges for `Surface.features`, (f, 2) int32, the lower vertex first, sorted: those that are any of the following.

    angle: edges at which the surface bends by at least this, radians, between the normals of two triangles, and which
        are among `Surface.edges`; None: no such edges. seams: those of the surface. borders: edges of one triangle
        alone, and `Surface.borders`.
    Raises InputError.
    """
    require_vertices(surface)
    found = [np.empty((0, 2), np.int32)]
    sides = np.stack([surface.triangles, np.roll(surface.triangles, -1, axis=1)], axis=-1).reshape(-1, 2)
    vertex_count = len(surface.positions)
    keys = edge_keys(sides[:, 0], sides[:, 1], vertex_count)
    order = np.argsort(keys, kind="stable")
    _, begin, count = np.unique(keys[order], return_index=True, return_counts=True)
    if angle is not None:
        least = arguments.positive("angle", angle, "pass an angle above 0, at most pi")
        first, second = (order[begin[count == 2] + i] for i in range(2))
        bent = first[_bends(surface, sides, first, second) >= least]
        if surface.edges is not None:
            bent = bent[np.isin(keys[bent], edge_keys(surface.edges[:, 0], surface.edges[:, 1], vertex_count))]
        found.append(sides[bent])
    if arguments.flag("seams", seams):
        found.append(surface.seams)
    if arguments.flag("borders", borders):
        found += [sides[order[begin[count == 1]]], surface.borders]
    return unique_rows(np.sort(np.concatenate(found), axis=1)).rows.astype(np.int32)


def _bends(surface: Surface, sides: IndexArray, first: NDArray[np.intp], second: NDArray[np.intp]) -> FloatArray:
    """Angles between the normals on both sides of edges, whatever the orientation of triangles; 0 beside triangles
    without area. first, second: the edges' sides, three of each triangle."""
    corners = surface.positions[surface.triangles]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    a, b = normal[first // 3], normal[second // 3]
    b = np.where((sides[first] == sides[second]).all(axis=1, keepdims=True), -b, b)
    return arctan2(np.linalg.norm(np.cross(a, b), axis=1), (a * b).sum(axis=1))
