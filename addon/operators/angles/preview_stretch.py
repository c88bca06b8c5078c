# SPDX-License-Identifier: GPL-3.0-or-later
"""Preview Stretch."""

from __future__ import annotations

from typing import TYPE_CHECKING

import bpy

from ...core import identifiers, native
from ...core.cone_angles import ConeAngles
from ...core.region import Region
from ...jobs.angles.gains import gain_at_vertices
from ...mesh.attributes import require_type, write_floats
from .base import AngleOperator

if TYPE_CHECKING:
    import lsgp


class MESH_OT_cone_preview(AngleOperator, bpy.types.Operator):
    """Preview Stretch."""

    bl_idname = identifiers.PREVIEW
    bl_label = "Preview Stretch"
    bl_description = (
        f"Write how much larger or smaller the texture will be at each vertex to the attribute "
        f'"{identifiers.LOG_SCALE_ATTRIBUTE}", and report the expected stretch, without unwrapping'
    )
    bl_options = {"REGISTER", "UNDO"}
    shown = ("gains", "seams", "border")

    gains: bpy.props.BoolProperty(
        name="Gain of a Cone",
        description="Also write by how much one more cone at each vertex would lower the stretch to the "
        f'attribute "{identifiers.GAIN_ATTRIBUTE}"',
        default=False,
    )

    def change(self, obj: bpy.types.Object, region: Region, cones: ConeAngles) -> tuple[str, list[lsgp.Finding]]:
        options = self.library_options()
        names = [identifiers.LOG_SCALE_ATTRIBUTE] + [identifiers.GAIN_ATTRIBUTE] * self.gains
        for name in names:
            require_type(obj.data, name, "FLOAT")
        angles = cones.without_stale(region.surface, options).angles
        found = native.lsgp.prescribe_curvature(region.surface, cones.cones, angles, options)
        columns = [found.log_scale]
        if self.gains:
            columns.append(gain_at_vertices(region.surface, cones, options))
        for name, values in zip(names, columns, strict=True):
            write_floats(obj.data, name, "POINT", values)
        return f"expected stretch {found.predicted_l2:.3f} (1 is none)", found.warnings
