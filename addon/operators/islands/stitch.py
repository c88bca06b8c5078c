# SPDX-License-Identifier: GPL-3.0-or-later
"""Stitch."""

from __future__ import annotations

import bpy

from ...core import identifiers
from ...jobs.uv_maps.islands import ChangedMap, Map, stitched
from ...mesh.region_read import Faces
from ...mesh.selected_elements import selected_edges
from ...mesh.targets import selects_by_uv
from .base import IslandOperator, read_selected


class UV_OT_cone_stitch(IslandOperator, bpy.types.Operator):
    """Stitch."""

    bl_idname = identifiers.STITCH
    bl_label = "Stitch Islands"
    bl_description = (
        "Join the islands on both sides of the selected edges: the one with less area is moved onto the other, exactly "
        "where their sides match, and scaled to fit otherwise. Pinned islands stay"
    )
    nothing_selected = "No edge is selected; select some that are cut in the UV map"

    def read(self, context: bpy.types.Context, obj: bpy.types.Object) -> Map | None:
        self._edges = selected_edges(obj, by_uv=selects_by_uv(context))
        return read_selected(context, obj, Faces.ALL) if len(self._edges) else None

    def change(self, found: Map, _obj: bpy.types.Object) -> ChangedMap:
        return stitched(found, self._edges)
