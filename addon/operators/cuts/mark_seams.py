# SPDX-License-Identifier: GPL-3.0-or-later
"""Seams from Cuts."""

import bpy

from ...core import identifiers
from ...core.text import counted
from ...mesh.region_read import require_editable
from ...mesh.targets import target_objects
from ...mesh.uv_cuts import cut_edges, mark_seams
from ..shared.conclusion import NO_CUTS, conclude, for_each
from ..shared.polling import EditMeshOperator


class MESH_OT_cone_seams_from_cuts(EditMeshOperator, bpy.types.Operator):
    """Seams from Cuts."""

    bl_idname = identifiers.SEAMS_FROM_CUTS
    bl_label = "Seams from Cuts"
    bl_description = "Mark the edges at which the active UV map is cut as seams; seams that are marked already stay"
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context: bpy.types.Context) -> set[str]:
        marked, failures = for_each(target_objects(context), _marked)
        cuts = sum(count for _, (count, _) in marked)
        new = sum(count for _, (_, count) in marked)
        if not new:
            if cuts:
                self.report({"INFO"}, f"All {counted(cuts, 'edge')} of the cuts are seams already")
            elif marked:
                self.report({"WARNING"}, NO_CUTS)
            return conclude(self, [], {}, failures)
        return conclude(self, [f"Marked {counted(new, 'edge')} as {'a seam' if new == 1 else 'seams'}"], {}, failures)


def _marked(obj: bpy.types.Object) -> tuple[int, int]:
    """How many edges are cut, and how many of them were marked.  Raises Refused."""
    require_editable(obj)
    edges = cut_edges(obj)
    return len(edges), mark_seams(obj.data, edges.tolist())
