# SPDX-License-Identifier: GPL-3.0-or-later
"""Mark Cone and Clear Cone."""

import bpy
import numpy as np

from ...core import identifiers
from ...core.text import counted
from ...mesh import angles, cones
from ...mesh.targets import target_objects
from ..shared.polling import EditMeshOperator
from ..shared.properties import ConeGroupProperty


class MESH_OT_cone_mark(ConeGroupProperty, EditMeshOperator, bpy.types.Operator):
    """Mark Cone, or with ``clear`` Clear Cone."""

    bl_idname = identifiers.MARK
    bl_label = "Mark Cone"
    bl_description = "Mark selected vertices as cones: the points that absorb the curvature when the mesh is unwrapped"
    bl_options = {"REGISTER", "UNDO"}

    clear: bpy.props.BoolProperty(name="Clear", description="Clear selected cones instead", default=False)

    @classmethod
    def description(cls, _context: bpy.types.Context, properties: bpy.types.OperatorProperties) -> str:
        return "Clear the cones among the selected vertices" if properties.clear else cls.bl_description

    def execute(self, context: bpy.types.Context) -> set[str]:
        changed = 0
        selected = 0
        for obj in target_objects(context):
            vertices = cones.selected_vertices(obj.data)
            selected += len(vertices)
            marked = cones.marked_cones(obj, self.vertex_group)
            if self.clear:
                affected = np.intersect1d(vertices, marked)
                if len(affected):
                    cones.clear_cones(obj, self.vertex_group, affected)
                    angles.forget_angles(obj, affected)
            else:
                affected = np.setdiff1d(vertices, marked)
                if len(affected):
                    cones.mark_cones(obj, self.vertex_group, affected)
            changed += len(affected)
        if not selected:
            self.report({"ERROR"}, "No vertex is selected; select the vertices to mark or clear")
            return {"CANCELLED"}
        if not changed:
            self.report(
                {"WARNING"},
                "No selected vertex is a cone; Select Cones shows them"
                if self.clear
                else "All selected vertices are cones already",
            )
            return {"CANCELLED"}
        self.report({"INFO"}, f"{'Cleared' if self.clear else 'Marked'} {counted(changed, 'cone')}")
        return {"FINISHED"}
