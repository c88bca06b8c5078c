# SPDX-License-Identifier: GPL-3.0-or-later
"""The properties that choose between preserving angles and preserving lengths."""

import bpy

from ...core.choices import Choices, enum_items
from ...core.identifiers import IMPORTANCE_GROUP

MODES: Choices = {
    "CONFORMAL": ("conformal", "Conformal", "Preserve angles; the scale may vary over the surface"),
    "LOW_STRETCH": ("low-stretch", "Low Stretch", "Preserve lengths as far as the cone angles allow"),
}


class LowStretchProperties:
    """Mix-in: what the map preserves, and where that matters most. Weights as in Blender's own unwrap."""

    mode: bpy.props.EnumProperty(
        name="Mode",
        description="What the map preserves where it cannot preserve both angles and lengths",
        items=enum_items(MODES),
    )
    stretch: bpy.props.FloatProperty(
        name="Less Stretch",
        description="From 0, the conformal map, to 1, the map with the least stretch",
        default=1.0,
        min=0.0,
        max=1.0,
        subtype="FACTOR",
    )
    use_weights: bpy.props.BoolProperty(
        name="Importance Weights",
        description="Whether to take into account per-vertex importance weights",
        default=False,
    )
    weight_group: bpy.props.StringProperty(
        name="Weight Group",
        description="Vertex group name for importance weights (where they are high, stretch is reduced most)",
        default=IMPORTANCE_GROUP,
    )
    weight_factor: bpy.props.FloatProperty(
        name="Weight Factor",
        description="How much influence the weightmap has for weighted parameterization, 0 being no influence",
        default=1.0,
        min=0.0,
        max=10000.0,
        soft_max=10.0,
    )

    def draw_mode(self, layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
        """The mode and, where lengths are preserved, the other properties."""
        layout.row().prop(self, "mode", expand=True)
        if self.mode != "LOW_STRETCH":
            return
        column = layout.column()
        column.prop(self, "stretch")
        column.prop(self, "use_weights")
        if not self.use_weights:
            return
        if context.object is None:
            column.prop(self, "weight_group")
        else:
            column.prop_search(self, "weight_group", context.object, "vertex_groups", results_are_suggestions=True)
        column.prop(self, "weight_factor")
