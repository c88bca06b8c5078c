# SPDX-License-Identifier: GPL-3.0-or-later
"""Get Texel Density."""

import bpy
import numpy as np

from ...core import identifiers
from ...core.length_units import length_unit
from ...jobs.uv_maps.texels import overall_density
from ...mesh.targets import target_objects
from ...mesh.texel_settings import shown_density, texel_settings
from ..shared.conclusion import conclude, for_each
from .base import NOTHING_SELECTED, TexelOperator


class UV_OT_cone_texel_get(TexelOperator, bpy.types.Operator):
    """Get Texel Density."""

    bl_idname = identifiers.TEXEL_GET
    bl_label = "Get Texel Density"
    bl_description = (
        "Measure how many pixels of the texture a unit of length gets on the selected faces, on all faces of the "
        "selected objects in object mode, and keep it as the density to set"
    )
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context: bpy.types.Context) -> set[str]:
        self.adopt_settings(context)
        found, failures = for_each(target_objects(context), lambda obj: self.measured(context, obj))
        parts = [measured for _, measured in found if measured is not None]
        if not parts:
            if not failures:
                self.report({"ERROR"}, NOTHING_SELECTED)
            return conclude(self, [], {}, failures)
        scene = context.scene
        unit = length_unit(scene).size
        density = overall_density(parts) * unit
        if not density > 0:
            self.report({"ERROR"}, "These faces have no area, on the mesh or in the UV map; unwrap them first")
            return {"CANCELLED"}
        texel_settings(scene).density = density
        of_triangles = np.concatenate([part.density[part.chosen] for part in parts]) * unit
        low, high = (shown_density(scene, float(value)) for value in (np.nanmin(of_triangles), np.nanmax(of_triangles)))
        return conclude(self, [f"{shown_density(scene, density)}, from {low} to {high}"], {}, failures)
