# SPDX-License-Identifier: GPL-3.0-or-later
"""Select Cuts."""

import bpy

from ...core import identifiers
from ...core.text import counted
from ...mesh.selection import EDGE_MODE, select_elements, set_select_mode
from ...mesh.targets import target_objects
from ...mesh.uv_cuts import cut_edges
from ..shared.conclusion import NO_CUTS, conclude, for_each
from ..shared.polling import EditMeshOperator


class MESH_OT_cone_select_cuts(EditMeshOperator, bpy.types.Operator):
    """Select Cuts."""

    bl_idname = identifiers.SELECT_CUTS
    bl_label = "Select Cuts"
    bl_description = "Select the edges at which the active UV map is cut, in edge select mode"
    bl_options = {"REGISTER", "UNDO"}

    extend: bpy.props.BoolProperty(name="Extend", description="Extend the existing selection", default=False)

    def execute(self, context: bpy.types.Context) -> set[str]:
        found, failures = for_each(target_objects(context), cut_edges)
        count = sum(len(edges) for _, edges in found)
        if not count:
            if found:
                self.report({"WARNING"}, NO_CUTS)
            return conclude(self, [], {}, failures)
        set_select_mode(context, EDGE_MODE, [obj.data for obj, _ in found])
        for obj, edges in found:
            select_elements(obj.data, extend=self.extend, edges=edges.tolist())
        return conclude(self, [f"Selected {counted(count, 'edge')}"], {}, failures)
