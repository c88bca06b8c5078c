# SPDX-License-Identifier: GPL-3.0-or-later
"""Vertices and edges that are selected in edit mode, in the 3D view or in the UV editor, as those of the surface."""

from __future__ import annotations

import bpy
import numpy as np
from numpy.typing import NDArray

from .arrays import read_array
from .reader import readable_mesh
from .stored_mesh import StoredMesh


def selected_vertices(obj: bpy.types.Object, *, by_uv: bool) -> NDArray[np.int32]:
    """(k,) each once.  by_uv: by the UV editor's own selection."""
    with readable_mesh(obj) as mesh:
        stored = StoredMesh(mesh)
        if by_uv:
            return np.unique(stored.surface_loops[_loops(stored)])
        chosen = read_array(mesh.vertices, "select", bool) & ~read_array(mesh.vertices, "hide", bool)
        return np.unique(stored.stitched[chosen])


def selected_edges(obj: bpy.types.Object, *, by_uv: bool) -> NDArray[np.int32]:
    """(k, 2) edges of faces, with the lower vertex first, each once.  by_uv: as for vertices."""
    with readable_mesh(obj) as mesh:
        stored = StoredMesh(mesh)
        if by_uv:
            chosen = _loops(stored)
            loops = np.flatnonzero(chosen & chosen[stored.next_loops])
        else:
            shown = read_array(mesh.edges, "select", bool) & ~read_array(mesh.edges, "hide", bool)
            loops = np.flatnonzero(shown[stored.loop_edges])
        ends = np.stack([stored.surface_loops[loops], stored.surface_loops[stored.next_loops[loops]]], axis=1)
        return np.unique(np.sort(ends[ends[:, 0] != ends[:, 1]], axis=1), axis=0)


def _loops(stored: StoredMesh) -> NDArray[np.bool_]:
    """(l,) those that the UV editor shows, where faces are selected, and has selected."""
    return stored.uv_selected & (stored.is_selected & ~stored.is_hidden)[stored.loop_faces]
