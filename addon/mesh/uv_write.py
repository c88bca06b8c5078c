# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes finished maps into the active UV layer, and nothing else."""

from __future__ import annotations

from collections import deque

import bmesh
import bpy
import numpy as np
from numpy.typing import NDArray

from ..core import native
from ..core.identifiers import NEW_UV_LAYER
from ..core.region import Region


def write_uv(obj: bpy.types.Object, region: Region, solved: NDArray[np.bool_], corner_uv: NDArray[np.float64]) -> None:
    """Write the solved triangles of a region; all other faces keep their UVs.  A mesh without UV layer gets one.

    solved: (m,) bool. corner_uv: (m, 3, 2).
    """
    mesh = obj.data
    if mesh.uv_layers.active is None:
        mesh.uv_layers.new(name=NEW_UV_LAYER)
    corner_uv = native.part("stitching").in_own_faces(corner_uv, region.surface.triangles, region.triangle_faces)
    loops = region.triangle_loops[solved].ravel()
    uv = corner_uv[solved].reshape(-1, 2).astype(np.float32)
    if obj.mode == "EDIT":
        _write_edit_mesh(mesh, np.unique(region.triangle_faces[solved]), region.face_loop_start, loops, uv)
    else:
        _write_mesh(mesh, loops, uv)


def _write_mesh(mesh: bpy.types.Mesh, loops: NDArray[np.int32], uv: NDArray[np.float32]) -> None:
    # Arrays are shared with copies of the mesh and undo steps. Writing through the attribute unshares the array first;
    # writing through the UV layer does not, at least up to Blender 4.5, and would change the others too.
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
    # In edit mode the UVs are in the bmesh, which has no bulk access; leaving and re-entering edit mode for foreach_set
    # would lose the redo panel. Faces and their loops have the order of the mesh that was read.
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


class EditedUv:
    """The active UV layer of a mesh in edit mode, to be written repeatedly and finally restored or kept.

    A mesh without UV layer gets one, until it is restored. Meanwhile nothing else may add or remove layers of loops,
    which would invalidate the references kept here.
    """

    def __init__(self, mesh: bpy.types.Mesh) -> None:
        self._mesh = mesh
        self._created = mesh.uv_layers.active is None
        if self._created:
            mesh.uv_layers.new(name=NEW_UV_LAYER)
        self._name = mesh.uv_layers.active.name
        self._bm = bmesh.from_edit_mesh(mesh)
        layer = self._bm.loops.layers.uv[self._name]
        # Kept because looking them up takes several times as long as writing them.
        self._loops = [loop[layer] for face in self._bm.faces for loop in face.loops]
        self._before = np.array([loop.uv[:] for loop in self._loops], np.float32).reshape(-1, 2)
        self._now = self._before.copy()
        self._lost = False

    @property
    def is_open(self) -> bool:
        """Whether the mesh is in edit mode as it was, as far as that is known."""
        return not self._lost and self._mesh.is_editmode and self._bm.is_valid

    @property
    def is_changed(self) -> bool:
        """Whether the values differ from those before anything was written."""
        return not np.array_equal(self._now, self._before)

    @property
    def before(self) -> NDArray[np.float32]:
        """(l, 2), as before anything was written."""
        return self._before

    @property
    def now(self) -> NDArray[np.float32]:
        """(l, 2), as last written."""
        return self._now

    def write(self, region: Region, solved: NDArray[np.bool_], corner_uv: NDArray[np.float64]) -> None:
        """As `write_uv`; all other triangles are as they were before anything was written."""
        uv = self._before.copy()
        uv[region.triangle_loops[solved].ravel()] = corner_uv[solved].reshape(-1, 2)
        self._set(uv)

    def write_loops(self, loops: NDArray[np.int32], uv: NDArray[np.float64]) -> None:
        """Write these loops, (k,), (k, 2); all others stay as they were last written."""
        now = self._now.copy()
        now[loops] = uv
        changed = np.unique(loops[(now[loops] != self._now[loops]).any(axis=1)])
        self._put(changed, now)

    def find_again(self, loop_vertices: NDArray[np.int32]) -> None:
        """To be called where something else may have changed the mesh: layers may have moved, and loops may be gone.

        loop_vertices: (l,) of the loops as they were.
        """
        if not self.is_open:
            return
        layer = self._bm.loops.layers.uv.get(self._name)
        self._bm.verts.index_update()
        loops = [loop for face in self._bm.faces for loop in face.loops]
        self._lost = layer is None or [loop.vert.index for loop in loops] != loop_vertices.tolist()
        self._loops = [] if self._lost else [loop[layer] for loop in loops]

    def reset(self) -> None:
        """Put back the values that there were before anything was written."""
        self._set(self._before)

    def restore(self) -> None:
        """Leave the layer as it was before, unless the loops of the mesh are others."""
        if self.is_open:
            self.reset()
        elif (
            not self._mesh.is_editmode
            and self._name in self._mesh.uv_layers
            and len(self._mesh.loops) == len(self._before)
        ):
            # Something else has left edit mode.
            self._mesh.attributes[self._name].data.foreach_set("vector", self._before.ravel())
            self._mesh.update_tag()
        else:
            return
        if self._created and self._name in self._mesh.uv_layers:
            self._mesh.uv_layers.remove(self._mesh.uv_layers[self._name])

    def _set(self, uv: NDArray[np.float32]) -> None:
        self._put(np.flatnonzero((uv != self._now).any(axis=1)), uv)

    def _put(self, changed: NDArray[np.integer], uv: NDArray[np.float32]) -> None:
        """Write all of the values, (l, 2), of which these loops, (k,), have others."""
        loops, values = map(self._loops.__getitem__, changed.tolist()), zip(*uv[changed].T.tolist(), strict=True)
        # Takes half the time of a loop of assignments.
        deque(map(bmesh.types.BMLoopUV.uv.__set__, loops, values), maxlen=0)
        self._now = uv
        bmesh.update_edit_mesh(self._mesh, loop_triangles=False, destructive=False)
