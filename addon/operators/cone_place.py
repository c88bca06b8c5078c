# SPDX-License-Identifier: GPL-3.0-or-later
"""Place Cones."""

import bpy
import numpy as np

from .. import cones, findings, identifiers, mesh_read, native, reporting
from .common import SEAMS, ConeGroupProperty, SeamsProperty, poll_computation, require_region


class MESH_OT_cone_place(ConeGroupProperty, SeamsProperty, bpy.types.Operator):
    """Place Cones."""

    bl_idname = identifiers.PLACE
    bl_label = "Place Cones"
    bl_description = (
        "Mark cones where the surface would be stretched most, one after the other; "
        "on the selected faces in edit mode, on all faces of the selected objects in object mode"
    )
    bl_options = {"REGISTER", "UNDO"}

    automatic: bpy.props.BoolProperty(
        name="Automatic",
        description="Place as many cones as it takes to keep the stretch low",
        default=True,
    )
    count: bpy.props.IntProperty(
        name="Count",
        description="Cones on each connected part, those marked already included",
        default=8,
        min=0,
        soft_max=64,
    )
    keep: bpy.props.BoolProperty(
        name="Keep Marked",
        description="Keep the cones marked already and add to them; otherwise they are cleared first",
        default=True,
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return poll_computation(cls, context)

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.prop(self, "automatic")
        row = layout.row()
        row.active = not self.automatic
        row.prop(self, "count")
        layout.prop(self, "keep")
        layout.prop(self, "seams")
        self.draw_vertex_group(layout, context)

    def execute(self, context: bpy.types.Context) -> set[str]:
        placed: list[tuple[bpy.types.Object, np.ndarray, np.ndarray]] = []
        failures = {}
        by_uv = mesh_read.selects_by_uv(context)
        for obj in mesh_read.target_objects(context):
            region = None
            try:
                region = require_region(obj, by_uv)
                if region is None:
                    continue
                marked = cones.marked_cones(obj, self.vertex_group)
                marked = marked[region.vertex_used[marked]]
                found = native.lsgp.place_cones(
                    region.surface,
                    marked if self.keep else (),
                    count=None if self.automatic else self.count,
                    seams=SEAMS[self.seams][0],
                ).cones
                placed.append((obj, marked, found))
                findings.keep(obj, region, [])
            except (native.lsgp.LsgpError, reporting.Refused) as error:
                failures[obj.name] = error
                findings.keep(obj, region, [error])
        if not placed and not failures:
            self.report({"ERROR"}, "No face is selected; select the faces to place cones on")
            return {"CANCELLED"}
        done = []
        for obj, marked, found in placed:
            new = np.setdiff1d(found, marked)
            dropped = np.setdiff1d(marked, found)
            if len(dropped) and not self.keep:
                cones.clear_cones(obj, self.vertex_group, dropped)
            if len(new):
                cones.mark_cones(obj, self.vertex_group, new)
            done.append(f"{obj.name}: {reporting.counted(len(found), 'cone')}, {len(new)} of them new")
        return reporting.conclude(self, done, {}, failures)
