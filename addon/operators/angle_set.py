# SPDX-License-Identifier: GPL-3.0-or-later
"""Set Cone Angle."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import bpy
import numpy as np

from .. import identifiers, native, reporting
from ..angle_table import degrees
from ..angles import ConeAngles, Kind, write_angles
from ..cones import mark_cones, marked_cones, selected_vertices
from .angle_common import AngleOperator
from .common import poll_edit_mesh

if TYPE_CHECKING:
    import lsgp

    from ..mesh_read import Region

# What other angles can still mend.
NOT_YET = {"GAUSS_BONNET", "TOO_FEW_CONES"}


class MESH_OT_cone_set_angle(AngleOperator, bpy.types.Operator):
    """Set Cone Angle."""

    bl_idname = identifiers.SET_ANGLE
    bl_label = "Set Cone Angle"
    bl_description = "Prescribe the angle left at the selected cones, or leave it to the unwrap again"
    bl_options = {"REGISTER", "UNDO"}

    automatic: bpy.props.BoolProperty(
        name="Automatic", description="The angle is found on unwrapping, where it distorts least", default=False
    )
    angle: bpy.props.FloatProperty(
        name="Angle",
        description="What is left of the full turn around the cone; at a corner of the border, the angle of the corner",
        default=1.5 * math.pi,
        min=math.radians(0.1),
        soft_max=4 * math.pi,
        step=9000,
        precision=2,
        subtype="ANGLE",
    )
    vertex: bpy.props.IntProperty(
        name="Vertex",
        description="Only this cone of the active object; all selected ones with -1",
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
            return [context.object]
        objects = super().objects(context)
        return [obj for obj in objects if len(self._cones(obj))] or objects[:1]

    def change(self, obj: bpy.types.Object, region: Region, cones: ConeAngles) -> tuple[str, list[lsgp.Finding]]:
        rows = np.flatnonzero(np.isin(cones.cones, self._cones(obj)))
        if not len(rows):
            raise reporting.Refused("no selected vertex is a cone; select cones, or mark them first")
        angle = None if self.automatic else self.angle
        wanted = cones.fixed()
        for row in rows:
            wanted[row] = angle
        missing = require_possible(region.surface, cones.cones, wanted, rows, self.library_options())
        vertices = cones.cones[rows]
        # Of full weight, where angles count.
        mark_cones(obj, self.vertex_group, vertices)
        write_angles(obj, vertices, [angle] * len(rows), [Kind.PRESCRIBED] * len(rows))
        said = f"{reporting.counted(len(rows), 'cone')} set to {'automatic' if angle is None else degrees(angle)}"
        if missing:
            said += f"; {degrees(missing)} of curvature are missing now, as the table of angles shows"
        return said, []

    def _cones(self, obj: bpy.types.Object) -> np.ndarray:
        """The cones that are to be set."""
        chosen = [self.vertex] if self.vertex >= 0 else selected_vertices(obj.data)
        return np.intersect1d(chosen, marked_cones(obj, self.vertex_group))


def require_possible(
    surface: lsgp.Surface, cones: np.ndarray, angles: list[float | None], changed: np.ndarray, options: lsgp.Options
) -> float:
    """The curvature that is missing in parts whose ledger does not close; other angles can still mend that.

    Raises LsgpError where no others can, in the parts of the changed cones.
    """
    lsgp = native.lsgp
    missing = 0.0
    for part in lsgp.build_ledger(surface, cones, angles, options):
        own = part.cones
        if not np.isin(own, changed).any():
            continue
        missing += 0.0 if part.closes else part.missing
        try:
            lsgp.prescribe_curvature(lsgp.part_surface(surface, part), cones[own], [angles[i] for i in own], options)
        except lsgp.LsgpError as error:
            if error.code not in NOT_YET:
                raise
    return missing
