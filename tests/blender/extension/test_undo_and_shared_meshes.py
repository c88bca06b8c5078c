# SPDX-License-Identifier: GPL-3.0-or-later
"""Every operator is undone and redone exactly without a window, and works on meshes that several objects share."""

from dataclasses import dataclass

import bpy
import numpy as np
import pytest
from installed import EXTENSION
from scenes import UvMap, add_ball, changed, edit, select_elements, snapshot


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
WITH_EVENTS = {"mesh.cone_draw_up", "mesh.cone_edit", "mesh.cone_edit_cuts"}
# Writing pixels makes steps of its own kind; the others change nothing.
WITHOUT_STEP = {"mesh.cone_update_table", "uv.cone_extend_image", "uv.cone_wait_for_redo"}


def unwrapped_ball(name: str = "Ball") -> bpy.types.Object:
    """With a loose vertex, which is reported."""
    ball = add_ball(name)
    ball.data.vertices.add(1)
    bpy.ops.uv.cone_unwrap()
    return ball


def edit_some(*objects: bpy.types.Object) -> None:
    edit(*objects, select="DESELECT")
    for obj in objects:
        select_elements(obj, "faces", range(20))


def require_undone_and_redone(names: list[str], run: Run, times: int = 2) -> None:
    def state() -> dict[str, object]:
        kept = bpy.context.scene.cone_unwrap_texels
        found = {(name, key): value for name in names for key, value in snapshot(bpy.data.objects[name]).items()}
        return found | {"density": kept.density, "replaced": sorted(map(replaced, names))}

    bpy.ops.ed.undo_push(message="before")
    before = state()
    assert run() == {"FINISHED"}
    after = state()
    assert changed(before, after)
    for _ in range(times):
        bpy.ops.ed.undo()
        assert changed(before, state()) == set()
        bpy.ops.ed.redo()
        assert changed(after, state()) == set()


def replaced(name: str) -> list[int]:
    """The slots of an object in which a texture is instead of its materials."""
    obj = bpy.data.objects[name]
    return [entry.slot for owner in (obj, obj.data) for entry in owner.cone_unwrap_replaced]


def test_every_operator_is_here() -> None:
    kinds = [kind for kind in bpy.types.Operator.__subclasses__() if kind.__module__.startswith(f"{EXTENSION}.")]
    undone = {kind.bl_idname for kind in kinds if "UNDO" in kind.bl_options}
    assert undone == {run.operator for run in (*IN_OBJECT_MODE.values(), *IN_EDIT_MODE.values())} | WITH_EVENTS
    assert {kind.bl_idname for kind in kinds} - undone == WITHOUT_STEP


@pytest.mark.parametrize("operator", IN_OBJECT_MODE)
def test_operators_are_undone_and_redone_in_object_mode(operator: str) -> None:
    require_undone_and_redone([unwrapped_ball().name], IN_OBJECT_MODE[operator], times=10)


@pytest.mark.parametrize("operator", IN_EDIT_MODE)
def test_operators_are_undone_and_redone_in_edit_mode(operator: str) -> None:
    ball = unwrapped_ball()
    edit_some(ball)
    require_undone_and_redone([ball.name], IN_EDIT_MODE[operator], times=10)


def linked(obj: bpy.types.Object, name: str = "Twin") -> bpy.types.Object:
    """Another selected object with the same mesh."""
    twin = bpy.data.objects.new(name, obj.data)
    twin.location.x = 4
    bpy.context.collection.objects.link(twin)
    twin.select_set(True)
    return twin


@pytest.mark.parametrize("operator", IN_OBJECT_MODE)
def test_a_mesh_of_two_objects_is_undone_and_redone_in_object_mode(operator: str) -> None:
    ball = unwrapped_ball()
    twin = linked(ball)
    require_undone_and_redone([ball.name, twin.name], IN_OBJECT_MODE[operator])


@pytest.mark.parametrize("operator", IN_EDIT_MODE)
def test_a_mesh_of_two_objects_is_undone_and_redone_beside_another_in_edit_mode(operator: str) -> None:
    ball = unwrapped_ball()
    twin, other = linked(ball), unwrapped_ball("Other")
    edit(ball, twin, other, select="DESELECT")
    for obj in (ball, other):
        select_elements(obj, "faces", range(20))
    require_undone_and_redone([ball.name, twin.name, other.name], IN_EDIT_MODE[operator])


@pytest.mark.parametrize("in_edit_mode", [False, True])
@pytest.mark.parametrize("operator", ["auto", "auto tile", "unwrap", "set density"])
def test_a_mesh_of_two_objects_gets_the_map_that_it_gets_alone(operator: str, in_edit_mode: bool) -> None:
    maps = []
    for shares in (False, True):
        bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
        ball = unwrapped_ball()
        objects = [ball, linked(ball)] if shares else [ball]
        if in_edit_mode:
            edit(*objects)
        assert IN_OBJECT_MODE[operator]() == {"FINISHED"}
        maps.append(UvMap(ball).uv)
    assert np.array_equal(*maps)
