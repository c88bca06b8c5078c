# SPDX-License-Identifier: GPL-3.0-or-later
"""When operators can run."""

import bpy

from ...core import native
from ...mesh import changes
from ...mesh.targets import active_object, mode, selected_meshes, target_objects


def _poll_targets(operator: type[bpy.types.Operator], context: bpy.types.Context, wanted: str) -> bool:
    """True where there are meshes to work on, and none is being edited with the mouse.  wanted: what to do if not."""
    objects = target_objects(context)
    if not objects:
        operator.poll_message_set(wanted)
        return False
    if any(changes.is_suspended(obj.data) for obj in objects):
        operator.poll_message_set("Finish what is edited with the mouse first: Enter, or Esc to cancel")
        return False
    return True


def poll_edit_mesh(operator: type[bpy.types.Operator], context: bpy.types.Context) -> bool:
    """True where a mesh is in edit mode."""
    wanted = "Enter edit mode on a mesh first"
    if mode(context) != "EDIT_MESH":
        operator.poll_message_set(wanted)
        return False
    return _poll_targets(operator, context, wanted)


def poll_meshes(operator: type[bpy.types.Operator], context: bpy.types.Context) -> bool:
    """True where meshes are in edit mode, or selected in object mode."""
    return _poll_targets(operator, context, "Enter edit mode on a mesh, or select mesh objects in object mode")


def poll_active_mesh(operator: type[bpy.types.Operator], context: bpy.types.Context) -> bool:
    """True where the active object is a mesh, in edit mode or object mode."""
    active = active_object(context)
    if mode(context) in {"EDIT_MESH", "OBJECT"} and active is not None and active.type == "MESH":
        return True
    operator.poll_message_set("Make a mesh the active object, in edit mode or object mode")
    return False


def poll_computation(operator: type[bpy.types.Operator], context: bpy.types.Context) -> bool:
    """True where there are meshes to work on and the computing library is available."""
    return _poll_library(operator) and poll_meshes(operator, context)


def poll_computation_on_objects(operator: type[bpy.types.Operator], context: bpy.types.Context) -> bool:
    """True where meshes are selected in object mode and the computing library is available."""
    if not _poll_library(operator):
        return False
    if not selected_meshes(context):
        operator.poll_message_set("Select mesh objects in object mode")
        return False
    return True


def _poll_library(operator: type[bpy.types.Operator]) -> bool:
    if native.PROBLEM:
        operator.poll_message_set(native.PROBLEM)
        return False
    return True


class EditMeshOperator:
    """Mix-in: runs in edit mode."""

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return poll_edit_mesh(cls, context)


class ComputingOperator:
    """Mix-in: works on meshes with the computing library."""

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return poll_computation(cls, context)
