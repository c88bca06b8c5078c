# SPDX-License-Identifier: GPL-3.0-or-later
"""Mark Texture Up."""

from __future__ import annotations

import bmesh
import bpy

from ...core import identifiers
from ...core.text import counted
from ...mesh.reader import reader
from ...mesh.region_read import require_editable
from ...mesh.targets import target_objects
from ...mesh.texture_up import clear_edges, directions_in, mark_edges, write_directions
from ..shared.conclusion import conclude, for_each
from ..shared.polling import EditMeshOperator


class MESH_OT_cone_mark_up(EditMeshOperator, bpy.types.Operator):
    """Mark Texture Up."""

    bl_idname = identifiers.MARK_UP
    bl_label = "Mark Texture Up"
    bl_description = (
        "Let the texture's upward direction run along the selected edges, upward rather than downward, when the mesh "
        "is unwrapped with Texture Up at Automatic. On faces that have a drawn direction that one counts. Edges are "
        f'marked by the attribute "{identifiers.ALONG_ATTRIBUTE}"'
    )
    bl_options = {"REGISTER", "UNDO"}

    clear: bpy.props.BoolProperty(
        name="Clear",
        description="Remove the directions of the selected faces and edges instead",
        options={"SKIP_SAVE"},
    )

    @classmethod
    def description(cls, _context: bpy.types.Context, properties: bpy.types.OperatorProperties) -> str:
        if properties.clear:
            return "Remove the texture's upward direction that is drawn on selected faces or marked on selected edges"
        return cls.bl_description

    def execute(self, context: bpy.types.Context) -> set[str]:
        work = _cleared if self.clear else _marked
        found, failures = for_each(target_objects(context), work)
        done = [f"{obj.name}: {what}" for obj, what in found if what]
        if not done and not failures:
            what = "Nothing selected has a direction" if self.clear else "No edge with a face is selected"
            self.report({"ERROR"}, what)
            return {"CANCELLED"}
        return conclude(self, done, {}, failures)


def _marked(obj: bpy.types.Object) -> str:
    """How many edges are marked now.  Raises Refused."""
    require_editable(obj)
    edges = mark_edges(obj.data)
    return counted(edges, "edge") if edges else ""


def _cleared(obj: bpy.types.Object) -> str:
    """How much lost its direction.  Raises Refused."""
    require_editable(obj)
    drawn = directions_in(reader(obj.data))
    faces = {number for number, face in enumerate(bmesh.from_edit_mesh(obj.data).faces) if face.select}
    kept = {face: direction for face, direction in drawn.items() if face not in faces}
    if len(kept) < len(drawn):
        write_directions(obj.data, kept)
    counts = (len(drawn) - len(kept), "face"), (clear_edges(obj.data), "edge")
    return ", ".join(counted(count, what) for count, what in counts if count)
