# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether a UV map is still the one something was found out about, told by a digest that is quick in any mode."""

from __future__ import annotations

import hashlib

import bmesh
import bpy
import numpy as np
from numpy.typing import NDArray

# Faces looked at, spread evenly over the mesh: reading all of them takes too long in edit mode.
FACES = 512


def probe(mesh: bpy.types.Mesh) -> str:
    """A digest of the mesh's size, the active UV layer, and the corners and UVs of a sample of faces.

    It is the same in edit mode and out of it, and after undo and redo what it was before.
    """
    layer = mesh.uv_layers.active
    name = None if layer is None else layer.name
    if mesh.is_editmode:
        size, corners, uv = _edited(bmesh.from_edit_mesh(mesh), name)
    else:
        size, corners, uv = _stored(mesh, name)
    digest = hashlib.blake2b(repr((size, name)).encode(), digest_size=16)
    digest.update(np.array(corners, np.int32))
    digest.update(uv.astype(np.float32))
    return digest.hexdigest()


def _edited(bm: bmesh.types.BMesh, layer_name: str | None) -> tuple[tuple[int, ...], list[int], NDArray]:
    bm.verts.index_update()
    bm.faces.ensure_lookup_table()
    layer = None if layer_name is None else bm.loops.layers.uv[layer_name]
    loops = [loop for i in _sample(len(bm.faces)) for loop in bm.faces[i].loops]
    uv = np.array([] if layer is None else [loop[layer].uv[:] for loop in loops])
    size = (len(bm.verts), len(bm.edges), len(bm.faces))
    return size, [loop.vert.index for loop in loops], uv


def _stored(mesh: bpy.types.Mesh, layer_name: str | None) -> tuple[tuple[int, ...], list[int], NDArray]:
    layer = None if layer_name is None else mesh.uv_layers[layer_name].uv
    loops = [loop for i in _sample(len(mesh.polygons)) for loop in mesh.polygons[i].loop_indices]
    uv = np.array([] if layer is None else [layer[loop].vector[:] for loop in loops])
    size = (len(mesh.vertices), len(mesh.edges), len(mesh.polygons))
    return size, [mesh.loops[loop].vertex_index for loop in loops], uv


def _sample(count: int) -> range:
    return range(0, count, max(1, count // FACES))
