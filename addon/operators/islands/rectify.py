# SPDX-License-Identifier: GPL-3.0-or-later
"""Rectify."""

from __future__ import annotations

import bpy
import numpy as np

from ...core import identifiers
from ...jobs.uv_maps.islands import ChangedMap, Map, shaped, with_islands_of
from ...mesh.region_read import Faces
from ...mesh.selected_elements import selected_vertices
from ...mesh.targets import selects_by_uv
from .base import IslandOperator, read_selected


class UV_OT_cone_rectify(IslandOperator, bpy.types.Operator):
    """Rectify."""

    bl_idname = identifiers.RECTIFY
    bl_label = "Rectify"
    bl_description = (
        "Make rectangles of the selected faces, with the lengths that their boundaries have on the surface and least "
        "stretch inside; the other faces of their islands follow. Without selected faces four selected vertices are "
        "the corners, otherwise the boundary has them where it turns most. Pinned UVs stay"
    )
    nothing_selected = "Nothing is selected; select faces, or the four corners of an island"

    def read(self, context: bpy.types.Context, obj: bpy.types.Object) -> Map | None:
        self._corners = np.empty(0, np.int32)
        found = super().read(context, obj)
        if found is not None:
            return found
        self._corners = selected_vertices(obj, by_uv=selects_by_uv(context))
        if not len(self._corners):
            return None
        return with_islands_of(read_selected(context, obj, Faces.ALL), self._corners)

    def change(self, found: Map, _obj: bpy.types.Object) -> ChangedMap:
        return shaped(found, "rectangle", self._corners)
