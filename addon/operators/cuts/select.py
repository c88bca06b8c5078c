# SPDX-License-Identifier: GPL-3.0-or-later
"""Select Cuts."""

import bpy
import numpy as np
from numpy.typing import NDArray

from ...core import identifiers
from ...core.cut_kinds import KINDS
from ...core.errors import Refused
from ...core.text import counted
from ...mesh import reports
from ...mesh.selection import EDGE_MODE, select_elements, set_select_mode
from ...mesh.targets import target_objects
from ...mesh.uv_cuts import cut_edges, surface_edges
from ..shared.conclusion import NO_CUTS, conclude, for_each
from ..shared.polling import EditMeshOperator


class MESH_OT_cone_select_cuts(EditMeshOperator, bpy.types.Operator):
    """Select Cuts."""

    bl_idname = identifiers.SELECT_CUTS
    bl_label = "Select Cuts"
    bl_description = "Select the edges at which the active UV map is cut, in edge select mode"
    bl_options = {"REGISTER", "UNDO"}

    kind: bpy.props.EnumProperty(
        name="Kind",
        description="Which cuts; kinds are those of the last unwrap",
        items=(
            ("ALL", "All", "All cuts of the UV map, of whatever origin"),
            *((kind.upper(), label, description) for kind, (label, description) in KINDS.items()),
        ),
        options={"SKIP_SAVE"},
    )
    extend: bpy.props.BoolProperty(name="Extend", description="Extend the existing selection", default=False)

    def execute(self, context: bpy.types.Context) -> set[str]:
        found, failures = for_each(target_objects(context), self._edges)
        count = sum(len(edges) for _, edges in found)
        if not count:
            if found:
                self.report({"WARNING"}, NO_CUTS if self.kind == "ALL" else "There is no visible cut of this kind")
            return conclude(self, [], {}, failures)
        set_select_mode(context, EDGE_MODE, [obj.data for obj, _ in found])
        for obj, edges in found:
            select_elements(obj.data, extend=self.extend, edges=edges.tolist())
        return conclude(self, [f"Selected {counted(count, 'edge')}"], {}, failures)

    def _edges(self, obj: bpy.types.Object) -> NDArray[np.int32]:
        """(c, 2) the visible edges of these cuts.  Raises Refused."""
        edges = cut_edges(obj)
        if self.kind == "ALL":
            return edges
        report = reports.find(obj.data)
        if report is None or not report.kinds:
            raise Refused("the UV map has changed since it was unwrapped from cones; unwrap it again")
        wanted = set(map(frozenset, report.edges_of(self.kind.lower())))
        return edges[[frozenset(pair) in wanted for pair in surface_edges(obj, edges).tolist()]]
