# SPDX-License-Identifier: GPL-3.0-or-later
"""Align."""

from __future__ import annotations

import bmesh
import bpy

from ...core import identifiers
from ...core.errors import Refused, object_errors
from ...jobs.uv_maps.islands import Map, aligned, island_of_face, tiles_of
from ...mesh import reports
from ...mesh.targets import target_objects
from ..shared.conclusion import for_each
from .base import IslandOperator

SIDES = (
    ("LEFT", "Left", "Left sides on one line"),
    ("CENTER", "Center", "Middles one above the other"),
    ("RIGHT", "Right", "Right sides on one line"),
    ("BOTTOM", "Bottom", "Lower sides on one line"),
    ("MIDDLE", "Middle", "Middles side by side"),
    ("TOP", "Top", "Upper sides on one line"),
)
LINES = (
    ("ALL", "All Islands", "The line is that of all islands together, or that of pinned ones"),
    ("ACTIVE", "Active Island", "The island of the active face stays, and the others come to its side"),
)


class UV_OT_cone_align(IslandOperator, bpy.types.Operator):
    """Align."""

    bl_idname = identifiers.ALIGN
    bl_label = "Align Islands"
    bl_description = (
        "Move the islands of the selected faces until one side of all is on a line, that of all together, of "
        "pinned ones, which stay, or of the island of the active face. Those of seamless layouts move by whole tiles"
    )

    side: bpy.props.EnumProperty(name="Side", description="What is on the line", items=SIDES)
    line: bpy.props.EnumProperty(name="Line", description="Which islands the line is that of", items=LINES)

    def execute(self, context: bpy.types.Context) -> set[str]:
        found, failures = for_each(target_objects(context), lambda obj: self.read(context, obj))
        found = [(obj, one) for obj, one in found if one is not None]
        if not found:
            return self.conclude_each([], failures)
        tiles = [tiles_of(reports.find(obj.data)) for obj, _ in found]
        try:
            active = self._active(context, found) if self.line == "ACTIVE" else None
            changed = aligned([one for _, one in found], self.side.lower(), tiles, active)
        except object_errors() as error:
            return self.conclude_each([], failures | {found[0][0].name: error})
        return self.conclude_each([(obj, one) for (obj, _), one in zip(found, changed, strict=True)], failures)

    def _active(self, context: bpy.types.Context, found: list[tuple[bpy.types.Object, Map]]) -> tuple[int, int]:
        """The place of the active object, and the island of its active face.  Raises Refused."""
        for place, (obj, one) in enumerate(found):
            face = bmesh.from_edit_mesh(obj.data).faces.active if obj == context.view_layer.objects.active else None
            island = None if face is None else island_of_face(one, face.index)
            if island is not None:
                return place, island
        raise Refused("no selected face is active; select one of the island last, or choose All Islands")
