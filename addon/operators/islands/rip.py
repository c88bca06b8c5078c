# SPDX-License-Identifier: GPL-3.0-or-later
"""Rip."""

from __future__ import annotations

import bpy

from ...core import identifiers
from ...core.choices import TextureProperties
from ...jobs.layouts.ripping import ripped
from ...jobs.uv_maps.islands import ChangedMap, Map
from .base import IslandOperator


class UV_OT_cone_rip(TextureProperties, IslandOperator, bpy.types.Operator):
    """Rip."""

    bl_idname = identifiers.RIP
    bl_label = "Rip to Islands"
    bl_description = (
        "Make the selected faces islands of their own, in their shape, where others leave room for them. No seam is "
        "marked"
    )

    def draw(self, _context: bpy.types.Context) -> None:
        self.layout.use_property_split = True
        self.layout.prop(self, "texture_size")
        self.layout.prop(self, "margin")

    def change(self, found: Map, _obj: bpy.types.Object) -> ChangedMap:
        return ripped(found, self.margin / int(self.texture_size))
