# SPDX-License-Identifier: GPL-3.0-or-later
"""Align."""

from __future__ import annotations

import bpy

from ...core import identifiers
from ...core.errors import object_errors
from ...jobs.uv_maps.islands import aligned, tiles_of
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


class UV_OT_cone_align(IslandOperator, bpy.types.Operator):
    """Align."""

    bl_idname = identifiers.ALIGN
    bl_label = "Align Islands"
    bl_description = (
        "Move the islands of the selected faces until one side of all is on a line, that of all together or that of "
        "pinned ones, which stay. Those of seamless layouts move by whole tiles"
    )

    side: bpy.props.EnumProperty(name="Side", description="What is on the line", items=SIDES)

    def execute(self, context: bpy.types.Context) -> set[str]:
        found, failures = for_each(target_objects(context), lambda obj: self.read(context, obj))
        found = [(obj, one) for obj, one in found if one is not None]
        if not found:
            return self.conclude_each([], failures)
        tiles = [tiles_of(reports.find(obj.data)) for obj, _ in found]
        try:
            changed = aligned([one for _, one in found], self.side.lower(), tiles)
        except object_errors() as error:
            return self.conclude_each([], failures | {found[0][0].name: error})
        return self.conclude_each([(obj, one) for (obj, _), one in zip(found, changed, strict=True)], failures)
