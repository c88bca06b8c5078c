# SPDX-License-Identifier: GPL-3.0-or-later
"""As few islands as there can be, whatever room they leave."""

import bpy

op = bpy.context.active_operator
for name in {*op.properties.bl_rna.properties.keys()} - {"rna_type"}:
    op.properties.property_unset(name)
op.preset = "PAINT"
op.creases = False
op.compact = False
