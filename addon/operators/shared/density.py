# SPDX-License-Identifier: GPL-3.0-or-later
"""The texel density that operators are given, or take from the scene."""

import bpy

from ...core.length_units import length_unit
from ...mesh.texel_settings import DENSITY_DESCRIPTION, density_unit, texel_settings


class DensityProperty:
    """Mix-in: a density in the scene's unit."""

    density: bpy.props.FloatProperty(
        name="Density",
        description=DENSITY_DESCRIPTION,
        default=1024.0,
        min=1e-6,
        soft_max=1e5,
        precision=2,
        options={"SKIP_SAVE"},
    )

    def adopt_density(self, context: bpy.types.Context) -> None:
        """Take that of the scene where the caller has not set one; the redo panel shows it as set."""
        if not self.properties.is_property_set("density"):
            self.density = texel_settings(context.scene).density

    def draw_density(self, layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
        layout.prop(self, "density", text=f"Density ({density_unit(context.scene)})")


def density_in_world(chosen: bpy.types.Operator | bpy.types.OperatorProperties, context: bpy.types.Context) -> float:
    """In pixels per unit of length of Blender: of an operator, present or last used; the scene's where it says none."""
    is_set = getattr(chosen, "properties", chosen).is_property_set("density")
    density = chosen.density if is_set else texel_settings(context.scene).density
    return density / length_unit(context.scene).size
