# SPDX-License-Identifier: GPL-3.0-or-later
"""Select Cone: one row of the table of angles."""

import bmesh
import bpy

from .. import identifiers, selection
from .common import poll_edit_mesh


class MESH_OT_cone_select_one(bpy.types.Operator):
    """Select Cone."""

    bl_idname = identifiers.SELECT_ONE
    bl_label = "Select Cone"
    bl_description = "Select this cone alone; with Shift, beside what is selected"
    bl_options = {"REGISTER", "UNDO", "INTERNAL"}

    vertex: bpy.props.IntProperty(name="Vertex", description="The cone of the active object", min=0)
    extend: bpy.props.BoolProperty(
        name="Extend", description="Keep what is selected already", default=False, options={"SKIP_SAVE"}
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return poll_edit_mesh(cls, context)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        self.extend = event.shift
        return self.execute(context)

    def execute(self, context: bpy.types.Context) -> set[str]:
        mesh = context.edit_object.data
        if self.vertex >= len(bmesh.from_edit_mesh(mesh).verts):
            self.report({"WARNING"}, "The mesh has changed; there is no such vertex any more")
            return {"CANCELLED"}
        selection.set_select_mode(context, selection.VERTEX_MODE, [mesh])
        if not selection.select_elements(mesh, self.extend, vertices=[self.vertex]):
            self.report({"WARNING"}, "This cone is hidden; reveal it to select it")
        return {"FINISHED"}
