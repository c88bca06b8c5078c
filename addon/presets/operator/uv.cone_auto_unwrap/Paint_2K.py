# SPDX-License-Identifier: GPL-3.0-or-later
"""For painting at 2048 texels."""

import bpy

op = bpy.context.active_operator
for name in {*op.properties.bl_rna.properties.keys()} - {"rna_type"}:
    op.properties.property_unset(name)
op.preset = "PAINT"
op.texture_size = "2048"
op.margin = 8
