# SPDX-License-Identifier: GPL-3.0-or-later
"""Joining what a file for display has apart: such files repeat a vertex wherever normals or UVs differ around it."""

from __future__ import annotations

import bmesh
import bpy
import numpy as np
from numpy.typing import NDArray

NORMAL = "cone_unwrap_normal"


def weld(mesh: bpy.types.Mesh) -> None:
    """Join the vertices of triangles that lie at exactly the same place.  Triangles and shading stay as they are."""
    if not mesh.polygons:
        return
    positions = _read(mesh.vertices, "co", 3, np.float32).reshape(-1, 3)
    triangles = _read(mesh.loops, "vertex_index", 1, np.int32).reshape(-1, 3)
    joined = joined_vertices(positions, triangles)
    moved = np.flatnonzero(joined != np.arange(len(joined)))
    if not len(moved):
        return
    normals = mesh.attributes.new(NORMAL, "FLOAT_VECTOR", "CORNER")
    normals.data.foreach_set("vector", _read(mesh.corner_normals, "vector", 3, np.float32))
    bm = bmesh.new()
    bm.from_mesh(mesh)
    vertices = list(bm.verts)
    bmesh.ops.weld_verts(bm, targetmap={vertices[i]: vertices[joined[i]] for i in moved})
    bm.to_mesh(mesh)
    bm.free()
    normals = mesh.attributes[NORMAL]
    vectors = _read(normals.data, "vector", 3, np.float32).reshape(-1, 3)
    mesh.attributes.remove(normals)
    mesh.normals_split_custom_set(vectors.tolist())


def joined_vertices(positions: NDArray[np.float32], triangles: NDArray[np.int32]) -> NDArray[np.int64]:
    """For each vertex the one it is joined with, itself for most.

    Triangles that would lose a side, or become the same as another, as the two sides of a leaf do, are left alone.
    """
    _, first, place = np.unique(positions, axis=0, return_index=True, return_inverse=True)
    joined = first[place.ravel()]
    corners = np.sort(joined[triangles], axis=1)
    _, same, count = np.unique(corners, axis=0, return_inverse=True, return_counts=True)
    spoiled = (np.diff(corners, axis=1) == 0).any(axis=1) | (count[same.ravel()] > 1)
    kept = triangles[spoiled].ravel()
    joined[kept] = kept
    return joined


def _read(elements: bpy.types.bpy_prop_collection, name: str, width: int, kind: type) -> NDArray:
    values = np.empty(width * len(elements), kind)
    elements.foreach_get(name, values)
    return values
