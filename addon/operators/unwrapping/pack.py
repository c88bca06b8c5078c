# SPDX-License-Identifier: GPL-3.0-or-later
"""Pack Islands."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial

import bpy

from ...core import identifiers
from ...core.choices import TextureProperties
from ...core.text import counted, square_in_percent
from ...jobs.layouts.repacking import Repacked, RepackSettings, RepackTask, repack
from ...jobs.uv_maps.texels import report_on_scaled
from ...mesh import reports
from ...mesh.region_read import Faces, read_chosen, read_surroundings, require_editable, require_uv_map
from ...mesh.uv_write import write_uv
from ..shared.background import BackgroundOperator, Solved
from ..shared.packing import EFFORTS, PackingProperties


class UV_OT_cone_pack(TextureProperties, PackingProperties, BackgroundOperator, bpy.types.Operator):
    """Pack Islands."""

    bl_idname = identifiers.PACK
    bl_label = "Pack Islands"
    bl_description = (
        "Move and turn the islands of the UV map until they fill the square, those of all objects together; pinned "
        "ones stay where they are. Of selected faces only the islands, in the place that these have. Works on the "
        "selected faces in edit mode, on all faces of the selected objects in object mode"
    )
    bl_options = {"REGISTER", "UNDO", "PRESET"}
    activity = "Packing"
    nothing_selected = "No face is selected; select some whose islands are to be packed"

    scale: bpy.props.EnumProperty(
        name="Scale",
        description="How large islands become; all get larger or smaller alike",
        items=(
            ("AUTO", "Automatic", "All islands fill the square; a selection in its place keeps its density"),
            ("FILL", "Fill", "Islands become as large as there is room"),
            ("KEEP", "Keep Density", "Islands keep their size, as long as there is room"),
        ),
    )
    turned: bpy.props.BoolProperty(name="Rotate", description="Islands may be rotated", default=True)
    keep_stacks: bpy.props.BoolProperty(
        name="Keep Stacks", description="Islands that lie on each other stay so, and share their texels", default=True
    )
    udim: bpy.props.IntProperty(
        name="UDIM Tiles",
        description="Spread the islands over this many UDIM tiles, 1001 and following, so that they become as large "
        "as possible",
        default=1,
        min=1,
        max=100,
        soft_max=10,
    )

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        for name in ("effort", "texture_size", "margin", "scale", "turned", "keep_stacks"):
            layout.prop(self, name)
        if self.scale != "KEEP":
            layout.prop(self, "udim")
        if context.mode == "EDIT_MESH":
            layout.prop(self, "in_place")

    def reader(self, faces: Faces) -> Callable[[bpy.types.Object], RepackTask | None]:
        self._beside = []

        def read(obj: bpy.types.Object) -> RepackTask | None:
            require_editable(obj)
            require_uv_map(obj)
            found = read_chosen(obj, faces)
            if found is None:
                self._beside.append(obj)
                return None
            return RepackTask(*found)

        return read

    def solver(self, context: bpy.types.Context) -> Callable[..., list[Repacked | Exception]]:
        _, faces = self.sources(context)
        settings = RepackSettings(
            self.margin / int(self.texture_size),
            turned=self.turned,
            udim=self.udim,
            effort=EFFORTS[self.effort][0],
            keep_stacks=self.keep_stacks,
            in_place=self.in_place,
            fill={"AUTO": None, "FILL": True, "KEEP": False}[self.scale],
        )
        beside = read_surroundings(self._beside, faces) if self.in_place else None
        if beside is not None:
            settings = replace(settings, others=beside.corner_uv)
        return partial(repack, settings)

    def write(self, solved: Solved) -> list[str]:
        said = []
        for obj, _, done in solved:
            report = reports.find(obj.data)
            if report is not None:
                # Islands are where none lies on another, as far as they did not lie so.
                known = report.overlaps_known
                scaled = report_on_scaled(report, done.region, done.scaled)
                report = replace(scaled, overlaps_known=known, square_used=done.square_used)
            write_uv(obj, done.region, done.scaled.moved, done.scaled.corner_uv)
            if report is not None:
                reports.store(obj.data, report)
            packed = f"{counted(done.scaled.islands, 'island')} packed"
            if done.square_used is not None:
                packed += f", {square_in_percent(done.square_used)}"
            said.append(f"{packed}; {done.note}" if done.note else packed)
        return said
