# SPDX-License-Identifier: GPL-3.0-or-later
"""Suggest the Next Cone."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import bpy

from .. import identifiers, native, reporting, selection
from ..angles import ConeAngles, Kind, write_angles
from ..cones import mark_cones
from .angle_common import AngleOperator
from .common import SEAMS

if TYPE_CHECKING:
    import lsgp

    from ..mesh_read import Region

# Of the stretch; less is not worth a cone.
LEAST_GAIN = 1e-3


class MESH_OT_cone_suggest(AngleOperator, bpy.types.Operator):
    """Suggest the Next Cone."""

    bl_idname = identifiers.SUGGEST
    bl_label = "Suggest the Next Cone"
    bl_description = "Mark the vertex where one more cone would lower the stretch most, and select it in edit mode"
    bl_options = {"REGISTER", "UNDO"}
    shown = ("mark", "seams")

    mark: bpy.props.BoolProperty(
        name="Mark", description="Mark it as a cone; otherwise it is selected only", default=True
    )

    def change(self, obj: bpy.types.Object, region: Region, cones: ConeAngles) -> tuple[str, list[lsgp.Finding]]:
        gains = self._gains(region.surface, cones)
        if gains.best is None or gains.present_l2 - gains.predicted_l2[gains.best] < LEAST_GAIN:
            raise reporting.Refused("no further cone lowers the stretch by a thousandth; there is nothing to add")
        if self.mark:
            mark_cones(obj, self.vertex_group, [gains.best])
            write_angles(obj, [gains.best], [None], [Kind.PRESCRIBED])
        if obj.mode == "EDIT":
            selection.set_select_mode(bpy.context, selection.VERTEX_MODE, [obj.data])
            selection.select_elements(obj.data, extend=False, vertices=[gains.best])
        then = f"stretch {gains.predicted_l2[gains.best]:.3f} expected"
        if math.isfinite(gains.present_l2):
            then += f", {gains.present_l2:.3f} without it"
        return f"vertex {gains.best}, {then}", gains.warnings

    def _gains(self, surface: lsgp.Surface, cones: ConeAngles) -> lsgp.ConeGains:
        """What one more cone would do to the part where it does most."""
        lsgp, fixed, seams = native.lsgp, cones.fixed(), SEAMS[self.seams][0]
        gains = lsgp.cone_gains(surface, cones.cones, fixed, seams=seams)
        parts = lsgp.build_ledger(surface, cones.cones, fixed, self.library_options())
        if gains.best is None or len(parts) == 1:
            return gains
        part = next(part for part in parts if (surface.triangles[part.triangles] == gains.best).any())
        own = part.cones
        return lsgp.cone_gains(lsgp.part_surface(surface, part), cones.cones[own], [fixed[i] for i in own], seams=seams)
