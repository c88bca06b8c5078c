# SPDX-License-Identifier: GPL-3.0-or-later
"""The cuts of a UV map, found from its coordinates, and seams along them."""

from __future__ import annotations

from collections.abc import Iterable

import bmesh
import bpy
import numpy as np
from numpy.typing import NDArray

from ..core.errors import Refused
from .arrays import read_array
from .reader import readable_mesh
from .stored_mesh import StoredMesh

# Of coordinates in single precision, relative to the largest: both sides of an edge that is not cut may have been
# rounded in different ways.
ROUNDING = 4 * np.finfo(np.float32).eps


def cut_edges(obj: bpy.types.Object) -> NDArray[np.int32]:
    """(c, 2) vertex pairs of the visible edges whose faces lie apart along them in the active UV map.

    The mesh's own borders are none: there is nothing on their other side.  Raises Refused where there is no UV map.
    """
    with readable_mesh(obj) as mesh:
        stored = StoredMesh(mesh)
        if stored.uv is None:
            raise Refused("the mesh has no UV map; unwrap it first")
        # Of each loop the coordinates at both ends of its edge, in the order in which the edge has its vertices.
        ends = np.stack([stored.uv, stored.uv[stored.next_loops]], axis=1)
        turned = stored.loop_vertices != stored.edges[stored.loop_edges, 0]
        ends[turned] = ends[turned, ::-1]
        low, high = np.full((len(stored.edges), 2, 2), np.inf), np.full((len(stored.edges), 2, 2), -np.inf)
        np.minimum.at(low, stored.loop_edges, ends)
        np.maximum.at(high, stored.loop_edges, ends)
        gap = np.where(np.isfinite(low), high - low, 0.0).max(axis=(1, 2))
        hidden = read_array(mesh.edges, "hide", bool)
        return stored.edges[~hidden & (gap > ROUNDING * np.abs(stored.uv).max(initial=1.0))]


def mark_seams(mesh: bpy.types.Mesh, edges: Iterable[tuple[int, int]]) -> int:
    """Mark these edges, vertex pairs of a mesh in edit mode, as seams.  Returns how many were not seams before."""
    bm = bmesh.from_edit_mesh(mesh)
    bm.verts.ensure_lookup_table()
    found = [bm.edges.get((bm.verts[first], bm.verts[second])) for first, second in edges]
    new = [edge for edge in found if not edge.seam]
    for edge in new:
        edge.seam = True
    bmesh.update_edit_mesh(mesh, loop_triangles=False, destructive=False)
    return len(new)
