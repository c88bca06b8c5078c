# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects to be written to later: found again by what undo does not change, and only where they are as they were."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass

import bpy
import numpy as np

from .reporting import Refused


@dataclass(frozen=True, slots=True)
class Target:
    """An object, what Blender knows it by, and the state of its mesh that what is written depends on."""

    name: str
    uid: int
    state: bytes

    def find(self) -> bpy.types.Object:
        """The object.  Raises Refused where it is gone or its mesh is another one."""
        found = next((obj for obj in bpy.data.objects if obj.session_uid == self.uid), None)
        if found is None or found.type != "MESH" or _state(found) != self.state:
            raise Refused("the mesh has changed since this began and was left alone; run it again")
        return found


def target(obj: bpy.types.Object) -> Target:
    """The object as it is now."""
    return Target(obj.name, obj.session_uid, _state(obj))


def _state(obj: bpy.types.Object) -> bytes:
    """A digest of the mode, the positions, the faces and which UV layer is active."""
    mesh = obj.data
    if obj.mode == "EDIT":
        obj.update_from_editmode()
    layer = mesh.uv_layers.active
    digest = hashlib.blake2b(repr((obj.mode, mesh.session_uid, getattr(layer, "name", None))).encode())
    for elements, name, dtype, columns in (
        (mesh.vertices, "co", np.float32, 3),
        (mesh.loops, "vertex_index", np.int32, 1),
        (mesh.polygons, "loop_start", np.int32, 1),
    ):
        values = np.empty(len(elements) * columns, dtype)
        elements.foreach_get(name, values)
        digest.update(values)
    return digest.digest()
