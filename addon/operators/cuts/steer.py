# SPDX-License-Identifier: GPL-3.0-or-later
"""Steer Cuts."""

from __future__ import annotations

import bpy
import numpy as np

from ...core import identifiers
from ...core.choices import Choices, enum_items
from ...core.identifiers import SEAM_COST_GROUP
from ...core.text import counted
from ...mesh import cones
from ...mesh.reader import reader
from ...mesh.targets import target_objects
from ..shared.polling import EditMeshOperator

# Of the vertex group; None for vertices outside it.
WEIGHTS: Choices = {
    "AWAY": (1.0, "Keep Cuts Away", "Keep cuts away from the selected vertices when the mesh is unwrapped"),
    "ATTRACT": (0.0, "Attract Cuts", "Draw cuts to the selected vertices when the mesh is unwrapped"),
    "CLEAR": (None, "Clear Cut Costs", "Let cuts run at the selected vertices as if nothing were painted there"),
}


class MESH_OT_cone_steer_cuts(EditMeshOperator, bpy.types.Operator):
    """Steer Cuts."""

    bl_idname = identifiers.STEER_CUTS
    bl_label = "Steer Cuts"
    bl_description = (
        "Keep cuts away from the selected vertices, or draw them there, by weights of the vertex group "
        f'"{SEAM_COST_GROUP}"'
    )
    bl_options = {"REGISTER", "UNDO"}

    effect: bpy.props.EnumProperty(
        name="Effect", description="What cuts do at the selected vertices", items=enum_items(WEIGHTS)
    )

    @classmethod
    def description(cls, _context: bpy.types.Context, properties: bpy.types.OperatorProperties) -> str:
        return WEIGHTS[properties.effect][2]

    def execute(self, context: bpy.types.Context) -> set[str]:
        weight, changed, selected = WEIGHTS[self.effect][0], 0, 0
        for obj in target_objects(context):
            vertices = cones.selected_vertices(obj.data)
            selected += len(vertices)
            before = cones.weights_in(obj, SEAM_COST_GROUP, reader(obj.data), outside=np.nan)
            if before is None:
                before = np.full(len(obj.data.vertices), np.nan)
            now = before[vertices]
            affected = vertices[~np.isnan(now) if weight is None else now != weight]
            if weight is not None and len(affected):
                cones.write_weights(obj, SEAM_COST_GROUP, affected, weight)
            elif len(affected):
                cones.clear_cones(obj, SEAM_COST_GROUP, affected)
            changed += len(affected)
        if not selected:
            self.report({"ERROR"}, "No vertex is selected; select where cuts are to run or not to run")
            return {"CANCELLED"}
        if not changed:
            self.report({"WARNING"}, "The selected vertices are like that already")
            return {"CANCELLED"}
        self.report(
            {"INFO"}, f"{WEIGHTS[self.effect][1]}: {counted(changed, 'vertex', 'vertices')}; unwrap the mesh again"
        )
        return {"FINISHED"}
