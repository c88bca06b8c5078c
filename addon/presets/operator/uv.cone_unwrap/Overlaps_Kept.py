# SPDX-License-Identifier: GPL-3.0-or-later
"""As the cones give it: islands may overlap themselves, and stay as large as they come."""

import bpy

op = bpy.context.active_operator
for name in {*op.properties.bl_rna.properties.keys()} - {"rna_type"}:
    op.properties.property_unset(name)
op.overlaps = "KEEP"
op.pack = False
