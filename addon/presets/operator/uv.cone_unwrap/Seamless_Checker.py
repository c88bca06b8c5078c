# SPDX-License-Identifier: GPL-3.0-or-later
"""For checkers: the black and white squares match, too."""

import bpy

op = bpy.context.active_operator
for name in {*op.properties.bl_rna.properties.keys()} - {"rna_type"}:
    op.properties.property_unset(name)
op.seamless = True
op.lattice = "SQUARE"
op.parity = True
