# SPDX-License-Identifier: GPL-3.0-or-later
"""Every operator of the add-on that changes data, with options with which it does so on a ball that is unwrapped."""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np
from run_in_blender import EXTENSION
from scenes import add_ball, edit, select_elements

KINDS = sorted(
    (kind for kind in bpy.types.Operator.__subclasses__() if kind.__module__.startswith(f"{EXTENSION}.")),
    key=lambda kind: kind.bl_idname,
)
"""The classes of all operators of the add-on."""


@dataclass(frozen=True)
class Run:
    """An operator with options, run as an artist runs it, with a step of undo."""

    operator: str
    options: dict[str, object]

    def __call__(self) -> set[str]:
        space, name = self.operator.split(".")
        return getattr(getattr(bpy.ops, space), name)("EXEC_DEFAULT", True, **self.options)


def call(operator: str, **options: object) -> Run:
    return Run(operator, options)


# By name: what is run on a ball with eight cones that is unwrapped, in object mode and in edit mode with 20 faces
# selected.
IN_OBJECT_MODE = {
    "auto": call("uv.cone_auto_unwrap"),
    "auto tile": call("uv.cone_auto_unwrap", preset="TILE"),
    "auto bake": call("uv.cone_auto_unwrap", preset="BAKE"),
    "auto marked": call("uv.cone_auto_unwrap", mark=True),
    "unwrap": call("uv.cone_unwrap", mode="LOW_STRETCH"),
    "pack": call("uv.cone_pack", effort="QUICK", margin=8),
    "measure": call("uv.cone_measure"),
    "texture": call("uv.cone_texture"),
    "get density": call("uv.cone_texel_get"),
    "set density": call("uv.cone_texel_set", density=64.0),
    "place": call("mesh.cone_place", automatic=False, count=12),
    "preview": call("mesh.cone_preview", gains=True),
    "select row": call("mesh.cone_select_one", vertex=3),
    "clear data": call("mesh.cone_clear_data"),
    "remesh": call("object.cone_remesh_to_quads", count=200),
}
IN_EDIT_MODE = {
    "auto": call("uv.cone_auto_unwrap"),
    "auto tile": call("uv.cone_auto_unwrap", preset="TILE"),
    "unwrap": call("uv.cone_unwrap", mode="LOW_STRETCH"),
    "pack": call("uv.cone_pack", effort="QUICK", margin=8, scale="FILL", in_place=False),
    "orient": call("uv.cone_orient"),
    "rip": call("uv.cone_rip"),
    "measure": call("uv.cone_measure"),
    "set density": call("uv.cone_texel_set", density=64.0),
    "clear data": call("mesh.cone_clear_data"),
    "mark": call("mesh.cone_mark"),
    "unmark": call("mesh.cone_mark", clear=True),
    "mark up": call("mesh.cone_mark_up"),
    "place": call("mesh.cone_place", automatic=False, count=12),
    "preview": call("mesh.cone_preview"),
    "seams from cuts": call("mesh.cone_seams_from_cuts"),
    "select": call("mesh.cone_select"),
    "select cuts": call("mesh.cone_select_cuts"),
    "select reported": call("mesh.cone_select_reported"),
    "select row": call("mesh.cone_select_one", vertex=3),
    "select by density": call("mesh.cone_texel_select", density=1e-3, compare="GREATER"),
    "set angle": call("mesh.cone_set_angle", angle=np.pi),
    "snap": call("mesh.cone_snap_angles"),
    "spread": call("mesh.cone_spread_rest"),
    "steer": call("mesh.cone_steer_cuts", effect="AWAY"),
    "suggest": call("mesh.cone_suggest"),
}
# Undone and redone in a window, in in_window.
ON_QUADS = {f"uv.cone_{name}" for name in ("straighten", "rectify", "grid", "align", "stitch")}
"""Undone on other maps, in islands."""
WITH_EVENTS = {"mesh.cone_draw_up", "mesh.cone_edit", "mesh.cone_edit_cuts"}
# Writing pixels makes steps of its own kind; the others change nothing.
WITHOUT_STEP = {"mesh.cone_update_table", "uv.cone_extend_image", "uv.cone_wait_for_redo"}


def unwrapped_ball(name: str = "Ball") -> bpy.types.Object:
    """With a loose vertex, which is reported."""
    ball = add_ball(name)
    ball.data.vertices.add(1)
    bpy.ops.uv.cone_unwrap(pack=False)  # with those of earlier balls, which takes Blender's packer most of a second
    return ball


def edit_some(*objects: bpy.types.Object) -> None:
    edit(*objects, select="DESELECT")
    for obj in objects:
        select_elements(obj, "faces", range(20))
