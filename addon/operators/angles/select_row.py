# SPDX-License-Identifier: GPL-3.0-or-later
"""Select Cone: one row of the table of angles."""

import bpy

from ...core import identifiers
from ...mesh.reader import reader
from ...mesh.selection import VERTEX_MODE, select_elements, set_select_mode
from ..shared.polling import EditMeshOperator


class MESH_OT_cone_select_one(EditMeshOperator, bpy.types.Operator):
    """Select Cone."""

    bl_idname = identifiers.SELECT_ONE
    bl_label = "Select Cone"
    bl_description = "Select only this cone; with Shift, extend the selection"
    bl_options = {"REGISTER", "UNDO", "INTERNAL"}

    vertex: bpy.props.IntProperty(name="Vertex", description="The cone of the active object", min=0)
    extend: bpy.props.BoolProperty(
        name="Extend", description="Extend the existing selection", default=False, options={"SKIP_SAVE"}
    )

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        self.extend = event.shift
        return self.execute(context)

    def execute(self, context: bpy.types.Context) -> set[str]:
        mesh = context.edit_object.data
        if self.vertex >= reader(mesh).size()[0]:
            self.report({"WARNING"}, "The mesh has changed; this vertex no longer exists")
            return {"CANCELLED"}
        set_select_mode(context, VERTEX_MODE, [mesh])
        if not select_elements(mesh, extend=self.extend, vertices=[self.vertex]):
            self.report({"WARNING"}, "This cone is hidden; reveal it to select it")
        return {"FINISHED"}
