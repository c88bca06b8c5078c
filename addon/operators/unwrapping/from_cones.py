# SPDX-License-Identifier: GPL-3.0-or-later
"""Unwrap from Cones."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import bpy

from ...core import identifiers
from ...core.region import Region
from ...jobs.layouts.maps import final_layouts, map_summary, write_map
from ...jobs.layouts.remembered import unwrap_all_once
from ...jobs.tasks.unwrapping import Unwrapped, UnwrapTask, unwrap_task
from ...mesh.region_read import Groups
from ..shared.background import BackgroundOperator, Solved
from ..shared.properties import BorderProperty, ConeGroupProperty, CutsProperty, SeamsProperty
from .features import FeatureProperties
from .low_stretch import LowStretchProperties
from .properties import UnwrapProperties, pack_settings, unwrap_settings
from .seamless import SeamlessProperties
from .sections import section

if TYPE_CHECKING:
    from ...jobs.tasks.solving import Progress


class UV_OT_cone_unwrap(
    ConeGroupProperty,
    SeamsProperty,
    CutsProperty,
    BorderProperty,
    LowStretchProperties,
    SeamlessProperties,
    FeatureProperties,
    UnwrapProperties,
    BackgroundOperator,
    bpy.types.Operator,
):
    """Unwrap from Cones."""

    bl_idname = identifiers.UNWRAP
    bl_label = "Unwrap from Cones"
    bl_description = (
        "Cut the mesh through its cones and unwrap it so that both sides of every cut have the same length. "
        "Works on the selected faces in edit mode (in a UV editor with its own selection, on those with all UVs "
        "selected), on all faces of the selected objects in object mode"
    )
    bl_options = {"REGISTER", "UNDO", "PRESET"}
    activity = "Unwrapping from cones"
    nothing_selected = "No face is selected; select the faces to unwrap"

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        self.draw_mode(layout, context)
        layout.prop(self, "overlaps")
        self.draw_seamless(layout, context)
        body = section(layout, "cone_unwrap_cuts", "Cuts and Cones")
        if body is not None:
            for name in ("cuts", "seams", "border", "prescription", "unfold", "repair", "use_subsurf_data"):
                body.prop(self, name)
            self.draw_vertex_group(body, context)
        if self.seamless or self.mode == "LOW_STRETCH":
            self.draw_features(layout, "cone_unwrap_features", in_tiles=self.seamless)
        body = section(layout, "cone_unwrap_islands", "Islands")
        if body is not None:
            self.draw_placement(body)

    def plan(self) -> tuple[Groups, Callable[[bpy.types.Object, Region], UnwrapTask]]:
        self.adopt_density(bpy.context)
        settings = unwrap_settings(self)
        return Groups(settings.cone_group, settings.weight_group), lambda _obj, region: unwrap_task(region, settings)

    @staticmethod
    def solve(tasks: list[UnwrapTask], progress: Progress | None = None) -> list[Unwrapped | Exception]:
        return unwrap_all_once(tasks, progress)

    def write(self, solved: Solved) -> list[str]:
        layouts = final_layouts([unwrapped for _, _, unwrapped in solved], pack_settings(self))
        for (obj, _, unwrapped), corner_uv in zip(solved, layouts, strict=True):
            write_map(obj, unwrapped, corner_uv)
        return [map_summary(unwrapped, corner_uv) for (_, _, unwrapped), corner_uv in zip(solved, layouts, strict=True)]
