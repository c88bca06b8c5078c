# SPDX-License-Identifier: GPL-3.0-or-later
"""Mark Texture Up."""

from __future__ import annotations

import bmesh
import bpy
import numpy as np

from ...core import identifiers
from ...core.text import counted
from ...jobs.tasks.directions import upward
from ...mesh.reader import reader
from ...mesh.region_read import require_editable
from ...mesh.targets import target_objects
from ...mesh.texture_up import directions_in, write_directions
from ..shared.conclusion import conclude, for_each
from ..shared.polling import EditMeshOperator


class MESH_OT_cone_mark_up(EditMeshOperator, bpy.types.Operator):
    """Mark Texture Up."""

    bl_idname = identifiers.MARK_UP
    bl_label = "Mark Texture Up"
    bl_description = (
        "Let the texture's upward direction run along the selected edges when the mesh is unwrapped with Texture Up at "
        "Automatic: each edge gives its direction to one face beside it"
    )
    bl_options = {"REGISTER", "UNDO"}

    clear: bpy.props.BoolProperty(
        name="Clear", description="Remove the directions of the selected faces instead", options={"SKIP_SAVE"}
    )

    @classmethod
    def description(cls, _context: bpy.types.Context, properties: bpy.types.OperatorProperties) -> str:
        if properties.clear:
            return "Remove what was drawn or marked as the texture's upward direction on the selected faces"
        return cls.bl_description

    def execute(self, context: bpy.types.Context) -> set[str]:
        work = _cleared if self.clear else _marked
        found, failures = for_each(target_objects(context), work)
        done = [f"{obj.name}: {counted(count, 'face')}" for obj, count in found if count]
        if not done and not failures:
            what = "No selected face has a direction" if self.clear else "No edge with a face is selected"
            self.report({"ERROR"}, what)
            return {"CANCELLED"}
        return conclude(self, done, {}, failures)


def _marked(obj: bpy.types.Object) -> int:
    """How many faces got a direction.  Raises Refused."""
    require_editable(obj)
    bm = bmesh.from_edit_mesh(obj.data)
    bm.faces.index_update()
    world = np.array(obj.matrix_world.to_3x3(), np.float64)
    new = {}
    for edge in bm.edges:
        beside = [face for face in edge.link_faces if not face.hide]
        length = edge.calc_length()
        if edge.select and not edge.hide and beside and length > 0:
            along = np.array((edge.verts[1].co - edge.verts[0].co) / length, np.float64)
            new[min(face.index for face in beside)] = tuple(upward(along, world).tolist())
    if new:
        write_directions(obj.data, directions_in(reader(obj.data)) | new)
    return len(new)


def _cleared(obj: bpy.types.Object) -> int:
    """How many faces lost their direction.  Raises Refused."""
    require_editable(obj)
    drawn = directions_in(reader(obj.data))
    faces = {number for number, face in enumerate(bmesh.from_edit_mesh(obj.data).faces) if face.select}
    kept = {face: direction for face, direction in drawn.items() if face not in faces}
    if len(kept) < len(drawn):
        write_directions(obj.data, kept)
    return len(drawn) - len(kept)
