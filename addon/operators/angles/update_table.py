# SPDX-License-Identifier: GPL-3.0-or-later
"""Update Table."""

import bpy

from ...core import identifiers
from ...core.errors import object_errors
from ...jobs.angles.angle_table import current_table, last_settings
from ...mesh.targets import active_object
from ..shared.conclusion import conclude
from ..shared.polling import ComputingOperator, poll_active_mesh


class MESH_OT_cone_update_table(ComputingOperator, bpy.types.Operator):
    """Update Table."""

    bl_idname = identifiers.UPDATE_TABLE
    bl_label = "Update Table"
    bl_description = "Read the cone angles of this large mesh and update their table"
    bl_options = {"INTERNAL"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return super().poll(context) and poll_active_mesh(cls, context)

    def execute(self, context: bpy.types.Context) -> set[str]:
        obj = active_object(context)
        try:
            current_table(obj, last_settings(context), on_request=True)
        except object_errors() as error:
            return conclude(self, [], {}, {obj.name: error})
        return {"FINISHED"}
