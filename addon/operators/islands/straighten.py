# SPDX-License-Identifier: GPL-3.0-or-later
"""Straighten."""

from __future__ import annotations

import bpy

from ...core import identifiers
from ...jobs.uv_maps.islands import ChangedMap, Map, shaped
from .base import IslandOperator


class UV_OT_cone_straighten(IslandOperator, bpy.types.Operator):
    """Straighten."""

    bl_idname = identifiers.STRAIGHTEN
    bl_label = "Straighten"
    bl_description = (
        "Lay the selected rows of quads out as straight strips along the axes, with the lengths that the quads have on "
        "the surface. The other faces of their islands follow with least stretch; pinned UVs stay"
    )

    def change(self, found: Map, _obj: bpy.types.Object) -> ChangedMap:
        return shaped(found, "strip")
