# SPDX-License-Identifier: GPL-3.0-or-later
"""The objects to work on; and objects to be written to later, if they are still as they were."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass

import bpy
import numpy as np

from ..core.errors import Refused
from .arrays import read_array


def target_objects(context: bpy.types.Context) -> list[bpy.types.Object]:
    """Mesh objects to work on, one per mesh: those in edit mode, or the selected ones in object mode."""
    one_per_mesh: dict[bpy.types.Mesh, bpy.types.Object] = {}
    for obj in _edited_objects(context) if mode(context) == "EDIT_MESH" else selected_meshes(context):
        one_per_mesh.setdefault(obj.data, obj)
    return list(one_per_mesh.values())


def selected_meshes(context: bpy.types.Context) -> list[bpy.types.Object]:
    """The selected mesh objects in object mode; none in other modes.

    An object can be in edit mode while the active one is in object mode.
    """
    if mode(context) != "OBJECT":
        return []
    objects = getattr(context, "selected_objects", None)
    if objects is None:
        objects = context.view_layer.objects.selected
    return [obj for obj in objects if obj.type == "MESH" and obj.mode == "OBJECT"]


def _edited_objects(context: bpy.types.Context) -> list[bpy.types.Object]:
    """The mesh objects in edit mode, the active one first."""
    objects = getattr(context, "objects_in_mode_unique_data", None)
    if objects is None:
        active = active_object(context)
        others = [obj for obj in context.view_layer.objects if obj.type == "MESH" and obj.mode == "EDIT"]
        objects = [active, *others]
    return list(objects)


# A context without a window, as that of Blender's timers, has no members that belong to a screen, and says that all is
# in object mode.


def mode(context: bpy.types.Context) -> str:
    """As `context.mode`, also without a window."""
    active = active_object(context)
    if context.screen is not None or active is None:
        return context.mode
    return "EDIT_MESH" if (active.type, active.mode) == ("MESH", "EDIT") else active.mode


def active_object(context: bpy.types.Context) -> bpy.types.Object | None:
    """As `context.object`, also without a window."""
    return getattr(context, "object", context.view_layer.objects.active)


def selects_by_uv(context: bpy.types.Context) -> bool:
    """Whether the context is a UV editor with a selection of its own."""
    space = context.space_data
    in_uv_editor = space is not None and space.type == "IMAGE_EDITOR" and space.show_uvedit
    return in_uv_editor and not context.tool_settings.use_uv_select_sync


@dataclass(frozen=True, slots=True)
class Target:
    """An object's name and identifier, and the state of its mesh that the result depends on."""

    name: str
    uid: int
    state: bytes

    def find(self) -> bpy.types.Object:
        """The object.  Raises Refused where it is gone or its mesh has changed."""
        found = next((obj for obj in bpy.data.objects if obj.session_uid == self.uid), None)
        if found is None or found.type != "MESH" or _state(found) != self.state:
            raise Refused("the mesh has changed since this began and was left alone; run it again")
        return found


def target(obj: bpy.types.Object) -> Target:
    """The object in its current state."""
    return Target(obj.name, obj.session_uid, _state(obj))


def _state(obj: bpy.types.Object) -> bytes:
    """A digest of the mode, the positions, the faces and the name of the active UV layer."""
    mesh = obj.data
    if obj.mode == "EDIT":
        obj.update_from_editmode()
    layer = mesh.uv_layers.active
    digest = hashlib.blake2b(repr((obj.mode, mesh.session_uid, getattr(layer, "name", None))).encode())
    digest.update(read_array(mesh.vertices, "co", np.float32, 3))
    digest.update(read_array(mesh.loops, "vertex_index", np.int32))
    digest.update(read_array(mesh.polygons, "loop_start", np.int32))
    return digest.digest()
