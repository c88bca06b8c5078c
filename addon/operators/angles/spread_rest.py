# SPDX-License-Identifier: GPL-3.0-or-later
"""Spread the Rest."""

from __future__ import annotations

from typing import TYPE_CHECKING

import bpy
import numpy as np

from ...core import identifiers
from ...core.cone_angles import ConeAngles, Kind
from ...core.errors import Refused
from ...core.region import Region
from ...core.text import counted
from ...jobs.angles.prescribing import spread
from ...mesh.angles import write_angles
from ...mesh.cones import selected_vertices
from .base import AngleOperator

if TYPE_CHECKING:
    import lsgp


class MESH_OT_cone_spread_rest(AngleOperator, bpy.types.Operator):
    """Spread the Rest."""

    bl_idname = identifiers.SPREAD_REST
    bl_label = "Spread the Rest"
    bl_description = (
        "Distribute the curvature that prescribed and snapped angles leave over the automatic or the selected cones, "
        "with the least distortion; their angles are then in the table"
    )
    bl_options = {"REGISTER", "UNDO"}
    shown = ("selected", "seams", "border")

    selected: bpy.props.BoolProperty(
        name="Over Selected",
        description="Over the selected cones, whose angles are replaced, instead of the automatic ones",
        default=False,
    )

    def change(self, obj: bpy.types.Object, region: Region, cones: ConeAngles) -> tuple[str, list[lsgp.Finding]]:
        self.require_cones(cones)
        options = self.library_options(prescription="manual")
        kept = self._kept(obj, region, cones)
        if all(angle is not None for angle in kept):
            raise Refused(
                "no cone is selected; select those that are to take up the rest"
                if self.selected
                else "no cone is automatic; select those that are to take up the rest, and spread it over these"
            )
        new = spread(region.surface, cones.cones, kept, options)
        write_angles(obj, new.angles.keys(), list(new.angles.values()), [Kind.FOUND] * len(new.angles))
        said = f"spread over {counted(len(new.angles), 'cone')}, expected stretch {new.prescription.predicted_l2:.3f}"
        return said, new.prescription.warnings

    def _kept(self, obj: bpy.types.Object, region: Region, cones: ConeAngles) -> list[float | None]:
        """The angles that stay; None for the cones to spread over."""
        if not self.selected:
            return cones.fixed()
        current = cones.without_stale(region.surface, self.library_options()).angles
        chosen = np.isin(cones.cones, selected_vertices(obj.data) if obj.mode == "EDIT" else [])
        return [None if free else angle for angle, free in zip(current, chosen, strict=True)]
