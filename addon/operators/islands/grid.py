# SPDX-License-Identifier: GPL-3.0-or-later
"""Grid."""

from __future__ import annotations

import bpy

from ...core import identifiers
from ...jobs.uv_maps.islands import ChangedMap, Map, shaped
from .base import IslandOperator

SPACINGS = (
    ("MESH", "Of the Mesh", "Each row and column is as wide as its quads are on the surface, on the average"),
    ("EVEN", "Even", "All rows are of one width, and all columns"),
)


class UV_OT_cone_grid(IslandOperator, bpy.types.Operator):
    """Grid."""

    bl_idname = identifiers.GRID
    bl_label = "Grid"
    bl_description = (
        "Lay the selected quads out on a grid along the axes. The other faces of their islands follow with least "
        "stretch; pinned UVs stay"
    )

    spacing: bpy.props.EnumProperty(name="Spacing", description="Widths of rows and columns", items=SPACINGS)

    def change(self, found: Map, _obj: bpy.types.Object) -> ChangedMap:
        return shaped(found, {"MESH": "grid", "EVEN": "even-grid"}[self.spacing])
