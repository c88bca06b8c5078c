# SPDX-License-Identifier: GPL-3.0-or-later
"""A mesh in edit mode whose UV map is edited, until it is restored or kept."""

from __future__ import annotations

from contextlib import suppress

import bpy

from ...mesh import changes
from ...mesh.stored_mesh import FrozenMesh
from ...mesh.uv_write import EditedUv


class MapSession:
    """mesh: reads positions, faces and the current UVs."""

    def __init__(self, obj: bpy.types.Object, mesh: FrozenMesh) -> None:
        self._obj, self.mesh = obj, mesh
        self._era, self._doubted = changes.era(), False
        self._uv = EditedUv(obj.data)

    def doubt(self) -> None:
        """Something else may have changed the mesh."""
        self._doubted = True

    def is_intact(self) -> bool:
        """Whether the mesh can still be written to."""
        if changes.era() != self._era:
            return False
        try:
            if self._doubted:
                self._uv.find_again(self.mesh.loop_vertices)
                self._doubted = False
            return self._uv.is_open
        except ReferenceError:
            # The mesh was removed.
            return False

    def restore(self) -> None:
        """Leave the mesh as it was before the session."""
        if changes.era() == self._era:
            with suppress(ReferenceError):
                self._uv.restore()
