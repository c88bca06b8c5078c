# SPDX-License-Identifier: GPL-3.0-or-later
"""Spread the Rest."""

from __future__ import annotations

from typing import TYPE_CHECKING

import bpy
import numpy as np

from .. import identifiers, native, reporting
from ..angles import ConeAngles, Kind, write_angles
from ..cones import selected_vertices
from .angle_common import AngleOperator

if TYPE_CHECKING:
    import lsgp

    from ..mesh_read import Region


class MESH_OT_cone_spread_rest(AngleOperator, bpy.types.Operator):
    """Spread the Rest."""

    bl_idname = identifiers.SPREAD_REST
    bl_label = "Spread the Rest"
    bl_description = (
        "Have the automatic cones, or those selected, take up the curvature that prescribed and snapped angles leave, "
        "where it distorts least; their angles are then in the table"
    )
    bl_options = {"REGISTER", "UNDO"}
    shown = ("selected", "seams", "border")

    selected: bpy.props.BoolProperty(
        name="Over Selected",
        description="Over the selected cones, whose angles are given up, instead of the automatic ones",
        default=False,
    )

    def change(self, obj: bpy.types.Object, region: Region, cones: ConeAngles) -> tuple[str, list[lsgp.Finding]]:
        self.require_cones(cones)
        kept = cones.held(region.surface, self.library_options()).angles if self.selected else cones.fixed()
        if self.selected:
            chosen = np.isin(cones.cones, selected_vertices(obj.data) if obj.mode == "EDIT" else [])
            kept = [None if free else angle for angle, free in zip(kept, chosen, strict=True)]
        if all(angle is not None for angle in kept):
            raise reporting.Refused(
                "no cone is selected; select those that are to take up the rest"
                if self.selected
                else "no cone is automatic; select those that are to take up the rest, and spread it over these"
            )
        found = native.lsgp.prescribe_curvature(
            region.surface, cones.cones, kept, self.library_options(prescription="manual")
        )
        angle_at = dict(zip(found.cones.tolist(), found.cone_angles.tolist(), strict=True))
        spread = [
            vertex
            for vertex, angle in zip(cones.cones.tolist(), kept, strict=True)
            if angle is None and vertex in angle_at
        ]
        write_angles(obj, spread, [angle_at[vertex] for vertex in spread], [Kind.FOUND] * len(spread))
        said = f"spread over {reporting.counted(len(spread), 'cone')}, stretch {found.predicted_l2:.3f} expected"
        return said, found.warnings
