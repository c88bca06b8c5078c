# SPDX-License-Identifier: GPL-3.0-or-later
"""Welds vertices that a file for display has split: such files repeat a vertex wherever normals or UVs differ."""

from __future__ import annotations

import bmesh
import bpy
import numpy as np
from numpy.typing import NDArray

from .arrays import read_array

NORMAL = "cone_unwrap_normal"


def weld(mesh: bpy.types.Mesh) -> None:
    """Merge vertices of triangles at exactly the same position.  Triangles and shading stay as they are."""
    if not mesh.polygons:
        return
    positions = read_array(mesh.vertices, "co", np.float32, 3)
    triangles = read_array(mesh.loops, "vertex_index", np.int32).reshape(-1, 3)
    joined = joined_vertices(positions, triangles)
    moved = np.flatnonzero(joined != np.arange(len(joined)))
    if not len(moved):
        return
    normals = mesh.attributes.new(NORMAL, "FLOAT_VECTOR", "CORNER")
    normals.data.foreach_set("vector", read_array(mesh.corner_normals, "vector", np.float32, 3).ravel())
    bm = bmesh.new()
    bm.from_mesh(mesh)
    vertices = list(bm.verts)
    bmesh.ops.weld_verts(bm, targetmap={vertices[i]: vertices[joined[i]] for i in moved})
    bm.to_mesh(mesh)
    bm.free()
    normals = mesh.attributes[NORMAL]
    vectors = read_array(normals.data, "vector", np.float32, 3)
    mesh.attributes.remove(normals)
    mesh.normals_split_custom_set(vectors.tolist())


def joined_vertices(positions: NDArray[np.float32], triangles: NDArray[np.int32]) -> NDArray[np.int64]:
    """(n,) the vertex that each vertex is merged with; itself for most.

    positions: (n, 3). triangles: (m, 3). Triangles that would degenerate or coincide with another one, as the two
    sides of a leaf do, are left alone.
    """
    _, first, place = np.unique(positions, axis=0, return_index=True, return_inverse=True)
    joined = first[place.ravel()]
    corners = np.sort(joined[triangles], axis=1)
    _, same, count = np.unique(corners, axis=0, return_inverse=True, return_counts=True)
    spoiled = (np.diff(corners, axis=1) == 0).any(axis=1) | (count[same.ravel()] > 1)
    kept = triangles[spoiled].ravel()
    joined[kept] = kept
    return joined
