# SPDX-License-Identifier: GPL-3.0-or-later
"""Every operator is undone and redone exactly without a window, and works on meshes that several objects share."""

from collections.abc import Callable

import bpy
import numpy as np
import pytest
from scenes import UvMap, add_ball, changed, edit, select_elements, snapshot

Run = Callable[[], set[str]]


def call(name: str, **options: object) -> Run:
    space, operator = name.split(".")

    def run() -> set[str]:
        return getattr(getattr(bpy.ops, space), operator)("EXEC_DEFAULT", True, **options)

    return run


# By name: what is run on a ball with eight cones that is unwrapped, in object mode and in edit mode with 20 faces
# selected.
IN_OBJECT_MODE = {
    "auto": call("uv.cone_auto_unwrap"),
    "auto tile": call("uv.cone_auto_unwrap", preset="TILE"),
    "auto bake": call("uv.cone_auto_unwrap", preset="BAKE"),
    "unwrap": call("uv.cone_unwrap", mode="LOW_STRETCH"),
    "measure": call("uv.cone_measure"),
    "set density": call("uv.cone_texel_set", density=64.0),
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
    "set angle": call("mesh.cone_set_angle", angle=np.pi),
    "snap": call("mesh.cone_snap_angles"),
    "spread": call("mesh.cone_spread_rest"),
    "steer": call("mesh.cone_steer_cuts", effect="AWAY"),
    "suggest": call("mesh.cone_suggest"),
}


def unwrapped_ball(name: str = "Ball") -> bpy.types.Object:
    ball = add_ball(name)
    bpy.ops.uv.cone_unwrap()
    return ball


def edit_some(*objects: bpy.types.Object) -> None:
    edit(*objects, select="DESELECT")
    for obj in objects:
        select_elements(obj, "faces", range(20))


def require_undone_and_redone(names: list[str], run: Run) -> None:
    def state() -> dict[str, object]:
        return {(name, key): value for name in names for key, value in snapshot(bpy.data.objects[name]).items()}

    bpy.ops.ed.undo_push(message="before")
    before = state()
    assert run() == {"FINISHED"}
    after = state()
    assert changed(before, after)
    for _ in range(2):
        bpy.ops.ed.undo()
        assert changed(before, state()) == set()
        bpy.ops.ed.redo()
        assert changed(after, state()) == set()


@pytest.mark.parametrize("operator", IN_OBJECT_MODE)
def test_operators_are_undone_and_redone_in_object_mode(operator: str) -> None:
    require_undone_and_redone([unwrapped_ball().name], IN_OBJECT_MODE[operator])


@pytest.mark.parametrize("operator", IN_EDIT_MODE)
def test_operators_are_undone_and_redone_in_edit_mode(operator: str) -> None:
    ball = unwrapped_ball()
    edit_some(ball)
    require_undone_and_redone([ball.name], IN_EDIT_MODE[operator])


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
