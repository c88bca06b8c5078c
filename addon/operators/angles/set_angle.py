# SPDX-License-Identifier: GPL-3.0-or-later
"""Set Cone Angle."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import bpy
import numpy as np

from ...core import identifiers
from ...core.cone_angles import ConeAngles, Kind
from ...core.errors import Refused
from ...core.region import Region
from ...core.text import counted, degrees
from ...jobs.angles.prescribing import missing_curvature
from ...mesh.angles import write_angles
from ...mesh.cones import mark_cones, marked_cones, selected_vertices
from ...mesh.targets import active_object
from ..shared.polling import poll_edit_mesh
from .base import AngleOperator

if TYPE_CHECKING:
    import lsgp


class MESH_OT_cone_set_angle(AngleOperator, bpy.types.Operator):
    """Set Cone Angle."""

    bl_idname = identifiers.SET_ANGLE
    bl_label = "Set Cone Angle"
    bl_description = "Prescribe the angle of the selected cones, or let unwrapping choose it again"
    bl_options = {"REGISTER", "UNDO"}

    automatic: bpy.props.BoolProperty(
        name="Automatic", description="Unwrapping chooses the angle with the least distortion", default=False
    )
    angle: bpy.props.FloatProperty(
        name="Angle",
        description="Total angle around the cone, where 360° is flat; on a boundary, the angle of the corner",
        default=1.5 * math.pi,
        min=math.radians(0.1),
        soft_max=4 * math.pi,
        step=9000,
        precision=2,
        subtype="ANGLE",
    )
    vertex: bpy.props.IntProperty(
        name="Vertex",
        description="Only this cone of the active object; -1 for all selected ones",
        default=-1,
        min=-1,
        options={"HIDDEN", "SKIP_SAVE"},
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return super().poll(context) and poll_edit_mesh(cls, context)

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.prop(self, "automatic")
        row = layout.row()
        row.active = not self.automatic
        row.prop(self, "angle")
        self.draw_vertex_group(layout, context)

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        if bpy.app.background or context.window is None:
            return self.execute(context)
        return context.window_manager.invoke_props_dialog(self)

    def objects(self, context: bpy.types.Context) -> list[bpy.types.Object]:
        if self.vertex >= 0:
            return [active_object(context)]
        objects = super().objects(context)
        return [obj for obj in objects if len(self._cones(obj))] or objects[:1]

    def change(self, obj: bpy.types.Object, region: Region, cones: ConeAngles) -> tuple[str, list[lsgp.Finding]]:
        rows = np.flatnonzero(np.isin(cones.cones, self._cones(obj)))
        if not len(rows):
            raise Refused("no selected vertex is a cone; select cones, or mark them first")
        angle = None if self.automatic else self.angle
        wanted = cones.fixed()
        for row in rows:
            wanted[row] = angle
        missing = missing_curvature(region.surface, cones.cones, wanted, rows, self.library_options())
        vertices = cones.cones[rows]
        # Angles count only where the weight is 1.
        mark_cones(obj, self.vertex_group, vertices)
        write_angles(obj, vertices, [angle] * len(rows), [Kind.PRESCRIBED] * len(rows))
        said = f"{counted(len(rows), 'cone')} set to {'automatic' if angle is None else degrees(angle)}"
        if missing:
            said += f"; {degrees(missing)} of curvature is missing now, as the table of angles shows"
        return said, []

    def _cones(self, obj: bpy.types.Object) -> np.ndarray:
        """The cones to set, ascending."""
        chosen = [self.vertex] if self.vertex >= 0 else selected_vertices(obj.data)
        return np.intersect1d(chosen, marked_cones(obj, self.vertex_group))
