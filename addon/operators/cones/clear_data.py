# SPDX-License-Identifier: GPL-3.0-or-later
"""Clear Cone Data."""

import bpy

from ...core import identifiers
from ...core.text import counted
from ...mesh.clearing import clear_data
from ...mesh.targets import target_objects
from ..shared.polling import poll_meshes
from ..shared.properties import ConeGroupProperty


class MESH_OT_cone_clear_data(ConeGroupProperty, bpy.types.Operator):
    """Clear Cone Data."""

    bl_idname = identifiers.CLEAR_DATA
    bl_label = "Clear Cone Data"
    bl_description = (
        "Remove all cones with their angles, cut costs, directions, marked edges, measured distortion, previews and "
        "reports from the meshes; UV maps stay as they are"
    )
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return poll_meshes(cls, context)

    def execute(self, context: bpy.types.Context) -> set[str]:
        objects = [obj for obj in target_objects(context) if obj.data.is_editable and obj.is_editable]
        cleared = sum(clear_data(obj, self.vertex_group) for obj in objects)
        if not cleared:
            self.report({"WARNING"}, "These meshes have no cone data; there is nothing to clear")
            return {"CANCELLED"}
        self.report({"INFO"}, f"Cleared the cone data of {counted(cleared, 'mesh', 'meshes')}")
        return {"FINISHED"}
