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

    Borders are none: there is nothing on their other side, unless they lie on each other; then both are.  Raises
    Refused where there is no UV map.
    """
    with readable_mesh(obj) as mesh:
        stored = StoredMesh(mesh)
        if stored.uv is None:
            raise Refused("the mesh has no UV map; unwrap it first")
        # Of each loop the coordinates at both ends of its edge, in the order of its vertices on the surface.
        ends = np.stack([stored.uv, stored.uv[stored.next_loops]], axis=1)
        edge = stored.surface_edge_of
        of_loop = edge[stored.loop_edges]
        turned = stored.surface_loops != stored.surface_edges.min(axis=1)[stored.loop_edges]
        ends[turned] = ends[turned, ::-1]
        low, high = np.full((len(edge), 2, 2), np.inf), np.full((len(edge), 2, 2), -np.inf)
        np.minimum.at(low, of_loop, ends)
        np.maximum.at(high, of_loop, ends)
        gap = np.where(np.isfinite(low), high - low, 0.0).max(axis=(1, 2))[edge]
        hidden = read_array(mesh.edges, "hide", bool)
        return stored.edges[~hidden & (gap > ROUNDING * np.abs(stored.uv).max(initial=1.0))]


def surface_edges(obj: bpy.types.Object, edges: NDArray[np.int32]) -> NDArray[np.int32]:
    """(c, 2) the edges of the surface that these of the mesh are."""
    with readable_mesh(obj) as mesh:
        return StoredMesh(mesh).stitched[edges]


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
