# SPDX-License-Identifier: GPL-3.0-or-later
"""Suggest the Next Cone."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import bpy

from ...core import identifiers
from ...core.cone_angles import ConeAngles, Kind
from ...core.errors import Refused
from ...core.region import Region
from ...jobs.angles.gains import best_gain
from ...mesh.angles import write_angles
from ...mesh.cones import mark_cones
from ...mesh.selection import VERTEX_MODE, select_elements, set_select_mode
from ..shared.cut_choices import chosen_cuts
from ..shared.properties import CutsProperty
from .base import AngleOperator

if TYPE_CHECKING:
    import lsgp


# Decrease of the stretch; less is not worth a cone.
LEAST_GAIN = 1e-3


class MESH_OT_cone_suggest(CutsProperty, AngleOperator, bpy.types.Operator):
    """Suggest the Next Cone."""

    bl_idname = identifiers.SUGGEST
    bl_label = "Suggest the Next Cone"
    bl_description = (
        "Mark the vertex where one more cone would lower the stretch most, or nearly as much if cuts reach it more "
        "easily, and select it in edit mode"
    )
    bl_options = {"REGISTER", "UNDO"}
    shown = ("mark", "cuts", "seams")

    mark: bpy.props.BoolProperty(
        name="Mark", description="Mark the vertex as a cone, instead of only selecting it", default=True
    )

    def change(self, obj: bpy.types.Object, region: Region, cones: ConeAngles) -> tuple[str, list[lsgp.Finding]]:
        gains = best_gain(region, cones, self.library_options(), chosen_cuts(self.cuts))
        if gains.best is None or gains.present_l2 - gains.predicted_l2[gains.best] < LEAST_GAIN:
            raise Refused("no further cone lowers the stretch by a thousandth; there is nothing to suggest")
        if self.mark:
            mark_cones(obj, self.vertex_group, [gains.best])
            write_angles(obj, [gains.best], [None], [Kind.PRESCRIBED])
        if obj.mode == "EDIT":
            set_select_mode(bpy.context, VERTEX_MODE, [obj.data])
            select_elements(obj.data, extend=False, vertices=[gains.best])
        then = f"expected stretch {gains.predicted_l2[gains.best]:.3f}"
        if math.isfinite(gains.present_l2):
            then += f", {gains.present_l2:.3f} without it"
        return f"vertex {gains.best}, {then}", gains.warnings
