# SPDX-License-Identifier: GPL-3.0-or-later
"""Unwrap from Cones."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import bpy

from ...core import identifiers
from ...core.region import Region
from ...jobs.layouts.maps import map_summary, unwrap_and_place, write_map
from ...jobs.tasks.unwrapped import Unwrapped
from ...jobs.tasks.unwrapping import UnwrapTask, unwrap_task
from ...mesh.region_read import Groups
from ..shared.background import BackgroundOperator, Solved
from ..shared.packing import PackingProperties, with_surroundings
from ..shared.properties import BorderProperty, ConeGroupProperty, CutsProperty, SeamsProperty
from .features import FeatureProperties
from .low_stretch import LowStretchProperties
from .properties import UnwrapProperties, pack_settings, unwrap_settings
from .seamless import SeamlessProperties
from .sections import section


class UV_OT_cone_unwrap(
    ConeGroupProperty,
    SeamsProperty,
    CutsProperty,
    BorderProperty,
    LowStretchProperties,
    SeamlessProperties,
    FeatureProperties,
    UnwrapProperties,
    PackingProperties,
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
            body.prop(self, "cuts")
            self.draw_seams(body)
            for name in ("border", "prescription", "unfold", "repair", "use_subsurf_data"):
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

    def solver(self, context: bpy.types.Context) -> Callable[..., list[Unwrapped | Exception]]:
        settings = with_surroundings(pack_settings(self), *self.sources(context), in_place=self.in_place)
        return partial(unwrap_and_place, settings)

    def write(self, solved: Solved) -> list[str]:
        for obj, _, unwrapped in solved:
            write_map(obj, unwrapped)
        return [map_summary(unwrapped) for _, _, unwrapped in solved]
