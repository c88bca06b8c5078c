# SPDX-License-Identifier: GPL-3.0-or-later
"""Boundaries run straight from cone to cone: a cylinder becomes a strip."""

import bpy

op = bpy.context.active_operator
for name in {*op.properties.bl_rna.properties.keys()} - {"rna_type"}:
    op.properties.property_unset(name)
op.mode = "LOW_STRETCH"
op.border = "STRAIGHT"
