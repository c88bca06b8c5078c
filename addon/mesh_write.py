# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes a finished map into the active UV layer, and nothing else."""

from __future__ import annotations

import bmesh
import bpy
import numpy as np
from numpy.typing import NDArray

from .identifiers import NEW_UV_LAYER
from .mesh_read import Region


def write_uv(obj: bpy.types.Object, region: Region, solved: NDArray[np.bool_], corner_uv: NDArray[np.float64]) -> None:
    """Write the solved triangles of ``region``; all other faces keep their UVs.  A mesh without UV layer gets one.

    solved: (m,) bool. corner_uv: (m, 3, 2).
    """
    mesh = obj.data
    if mesh.uv_layers.active is None:
        mesh.uv_layers.new(name=NEW_UV_LAYER)
    loops = region.triangle_loops[solved].ravel()
    uv = corner_uv[solved].reshape(-1, 2).astype(np.float32)
    if obj.mode == "EDIT":
        _write_edit_mesh(mesh, np.unique(region.triangle_faces[solved]), region.face_loop_start, loops, uv)
    else:
        _write_mesh(mesh, loops, uv)


def _write_mesh(mesh: bpy.types.Mesh, loops: NDArray[np.int32], uv: NDArray[np.float32]) -> None:
    # Copies of the mesh and steps of undo share its arrays. The attribute makes the array the mesh's own first; the UV
    # layer does not, up to Blender 4.5 at least, and would change theirs too.
    attribute = mesh.attributes[mesh.uv_layers.active.name]
    all_uv = np.empty((len(mesh.loops), 2), np.float32)
    attribute.data.foreach_get("vector", all_uv.ravel())
    all_uv[loops] = uv
    attribute.data.foreach_set("vector", all_uv.ravel())
    mesh.update_tag()


def _write_edit_mesh(
    mesh: bpy.types.Mesh,
    faces: NDArray[np.int32],
    face_loop_start: NDArray[np.int32],
    loops: NDArray[np.int32],
    uv: NDArray[np.float32],
) -> None:
    # In edit mode the UVs live in the bmesh, which has no bulk access; leaving and re-entering edit mode for
    # foreach_set would cost the redo panel. Faces and their loops have the order of the mesh that was read.
    loop_uv = np.zeros((int(loops.max(initial=-1)) + 1, 2), np.float32)
    loop_uv[loops] = uv
    values = loop_uv.tolist()
    bm = bmesh.from_edit_mesh(mesh)
    bm.faces.ensure_lookup_table()
    layer = bm.loops.layers.uv[mesh.uv_layers.active.name]
    for face, start in zip(faces.tolist(), face_loop_start[faces].tolist(), strict=True):
        for position, loop in enumerate(bm.faces[face].loops, start):
            loop[layer].uv = values[position]
    bmesh.update_edit_mesh(mesh, loop_triangles=False, destructive=False)
