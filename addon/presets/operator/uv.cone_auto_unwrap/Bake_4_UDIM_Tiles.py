# SPDX-License-Identifier: GPL-3.0-or-later
"""For baking into four tiles of 4096 texels."""

import bpy

op = bpy.context.active_operator
for name in {*op.properties.bl_rna.properties.keys()} - {"rna_type"}:
    op.properties.property_unset(name)
op.preset = "BAKE"
op.texture_size = "4096"
op.margin = 16
op.udim = 4
