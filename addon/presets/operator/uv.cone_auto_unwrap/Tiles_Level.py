# SPDX-License-Identifier: GPL-3.0-or-later
"""For tileable textures that lie level, such as bricks."""

import bpy

op = bpy.context.active_operator
for name in {*op.properties.bl_rna.properties.keys()} - {"rna_type"}:
    op.properties.property_unset(name)
op.preset = "TILE"
op.direction = "Z"
