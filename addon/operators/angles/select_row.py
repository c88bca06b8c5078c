# SPDX-License-Identifier: GPL-3.0-or-later
"""Select Cone: one row of the table of angles."""

from __future__ import annotations

import bmesh
import bpy
from bpy_extras.view3d_utils import location_3d_to_region_2d
from mathutils import Vector

from ...core import identifiers
from ...mesh.reader import reader
from ...mesh.selection import VERTEX_MODE, select_elements, select_stored_vertex, set_select_mode
from ...mesh.targets import active_object
from ...overlay import cache
from ..shared.polling import poll_active_mesh


class MESH_OT_cone_select_one(bpy.types.Operator):
    """Select Cone."""

    bl_idname = identifiers.SELECT_ONE
    bl_label = "Select Cone"
    bl_description = (
        "Select only this cone, and turn the view to it where it is out of sight; with Shift, extend the selection. In "
        "object mode the cone is drawn larger"
    )
    bl_options = {"REGISTER", "UNDO", "INTERNAL"}

    vertex: bpy.props.IntProperty(name="Vertex", description="The cone of the active object", min=0)
    extend: bpy.props.BoolProperty(
        name="Extend", description="Extend the existing selection", default=False, options={"SKIP_SAVE"}
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return poll_active_mesh(cls, context)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        self.extend = event.shift
        return self.execute(context)

    def execute(self, context: bpy.types.Context) -> set[str]:
        obj = active_object(context)
        if self.vertex >= reader(obj.data).size()[0]:
            self.report({"WARNING"}, "The mesh has changed; this vertex no longer exists")
            return {"CANCELLED"}
        if obj.mode == "EDIT":
            set_select_mode(context, VERTEX_MODE, [obj.data])
            if not select_elements(obj.data, extend=self.extend, vertices=[self.vertex]):
                self.report({"WARNING"}, "This cone is hidden; reveal it to select it")
        else:
            select_stored_vertex(obj.data, self.vertex, extend=self.extend)
            cache.highlight(obj, self.vertex)
        bring_into_sight(context, obj, self.vertex)
        return {"FINISHED"}


def bring_into_sight(context: bpy.types.Context, obj: bpy.types.Object, vertex: int) -> None:
    """Turn the 3D view to a vertex that is on the side away from it or out of its region."""
    view = context.region_data
    if not isinstance(view, bpy.types.RegionView3D) or view.view_perspective == "CAMERA":
        return
    if obj.mode == "EDIT":
        bm = bmesh.from_edit_mesh(obj.data)
        bm.verts.ensure_lookup_table()
        found = bm.verts[vertex]
    else:
        found = obj.data.vertices[vertex]
    place = obj.matrix_world @ found.co
    outward = obj.matrix_world.inverted_safe().to_3x3().transposed() @ found.normal
    if outward.dot(view.view_rotation @ Vector((0, 0, 1))) <= 0:
        view.view_rotation = outward.to_track_quat("Z", "Y")
    region = next(region for region in context.area.regions if region.type == "WINDOW")
    at = location_3d_to_region_2d(region, view, place)
    if at is None or not (0 <= at.x <= region.width and 0 <= at.y <= region.height):
        view.view_location = place
