# SPDX-License-Identifier: GPL-3.0-or-later
"""Select Cones."""

import bpy

from ...core import identifiers
from ...core.text import counted
from ...mesh.cones import marked_cones
from ...mesh.selection import VERTEX_MODE, select_elements, set_select_mode
from ...mesh.targets import target_objects
from ..shared.conclusion import say_selected
from ..shared.polling import EditMeshOperator
from ..shared.properties import ConeGroupProperty


class MESH_OT_cone_select(ConeGroupProperty, EditMeshOperator, bpy.types.Operator):
    """Select Cones."""

    bl_idname = identifiers.SELECT
    bl_label = "Select Cones"
    bl_description = "Select the vertices marked as cones, in vertex select mode"
    bl_options = {"REGISTER", "UNDO"}

    extend: bpy.props.BoolProperty(name="Extend", description="Extend the existing selection", default=False)

    def execute(self, context: bpy.types.Context) -> set[str]:
        by_object = {obj: marked_cones(obj, self.vertex_group) for obj in target_objects(context)}
        if not any(map(len, by_object.values())):
            self.report(
                {"WARNING"},
                f'No cone is marked in the vertex group "{self.vertex_group}"; use Mark Cone or Place Cones',
            )
            return {"CANCELLED"}
        # A single vertex cannot stay selected in edge or face select mode.
        set_select_mode(context, VERTEX_MODE, [obj.data for obj in by_object])
        total = sum(map(len, by_object.values()))
        visible = sum(
            select_elements(obj.data, extend=self.extend, vertices=marked) for obj, marked in by_object.items()
        )
        say_selected(self, visible, total, counted(visible, "cone"))
        return {"FINISHED"}
