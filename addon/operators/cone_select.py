# SPDX-License-Identifier: GPL-3.0-or-later
"""Select Cones."""

import bpy

from .. import cones, identifiers, mesh_read, reporting, selection
from .common import ConeGroupProperty, poll_edit_mesh


class MESH_OT_cone_select(ConeGroupProperty, bpy.types.Operator):
    """Select Cones."""

    bl_idname = identifiers.SELECT
    bl_label = "Select Cones"
    bl_description = "Select the vertices marked as cones, in vertex select mode"
    bl_options = {"REGISTER", "UNDO"}

    extend: bpy.props.BoolProperty(name="Extend", description="Keep what is selected already", default=False)

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return poll_edit_mesh(cls, context)

    def execute(self, context: bpy.types.Context) -> set[str]:
        by_object = {obj: cones.marked_cones(obj, self.vertex_group) for obj in mesh_read.target_objects(context)}
        if not any(map(len, by_object.values())):
            self.report(
                {"WARNING"},
                f'No cone is marked in the vertex group "{self.vertex_group}"; use Mark Cone or Place Cones',
            )
            return {"CANCELLED"}
        # A single vertex cannot stay selected in edge or face select mode.
        selection.set_select_mode(context, selection.VERTEX_MODE, [obj.data for obj in by_object])
        total = sum(map(len, by_object.values()))
        visible = sum(
            selection.select_elements(obj.data, self.extend, vertices=marked) for obj, marked in by_object.items()
        )
        hidden = f"; {total - visible} more hidden" if visible < total else ""
        self.report({"INFO"}, f"Selected {reporting.counted(visible, 'cone')}{hidden}")
        return {"FINISHED"}
