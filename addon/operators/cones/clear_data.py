# SPDX-License-Identifier: GPL-3.0-or-later
"""Clear Cone Data."""

import bpy

from ...core import identifiers
from ...core.text import counted
from ...mesh.clearing import clear_data
from ...mesh.region_read import require_editable
from ...mesh.targets import target_objects
from ..shared.conclusion import conclude, for_each
from ..shared.polling import poll_meshes
from ..shared.properties import ConeGroupProperty


class MESH_OT_cone_clear_data(ConeGroupProperty, bpy.types.Operator):
    """Clear Cone Data."""

    bl_idname = identifiers.CLEAR_DATA
    bl_label = "Clear Cone Data"
    bl_description = (
        "Remove all cones with their angles, cut costs, directions, marked edges, measured distortion, previews and "
        "reports from the meshes; UV maps stay as they are"
    )
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return poll_meshes(cls, context)

    def execute(self, context: bpy.types.Context) -> set[str]:
        found, failures = for_each(target_objects(context), self._cleared)
        count = sum(was_there for _, was_there in found)
        if not count and not failures:
            self.report({"WARNING"}, "These meshes have no cone data; there is nothing to clear")
        done = [f"Cleared the cone data of {counted(count, 'mesh', 'meshes')}"] if count else []
        return conclude(self, done, {}, failures)

    def _cleared(self, obj: bpy.types.Object) -> bool:
        """Whether there was any.  Raises Refused."""
        require_editable(obj)
        return clear_data(obj, self.vertex_group)
