# SPDX-License-Identifier: GPL-3.0-or-later
"""Update Table."""

import bpy

from .. import angle_table, identifiers
from .common import poll_computation


class MESH_OT_cone_update_table(bpy.types.Operator):
    """Update Table."""

    bl_idname = identifiers.UPDATE_TABLE
    bl_label = "Update Table"
    bl_description = "Read the cone angles of this large mesh and keep its ledger"
    bl_options = {"INTERNAL"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return poll_computation(cls, context)

    def execute(self, context: bpy.types.Context) -> set[str]:
        angle_table.current_table(context.object, angle_table.last_settings(context), asked=True)
        return {"FINISHED"}
