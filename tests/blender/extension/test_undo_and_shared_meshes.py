# SPDX-License-Identifier: GPL-3.0-or-later
"""Every operator is undone and redone exactly without a window, and works on meshes that several objects share."""

import bpy
import numpy as np
import pytest
from nightly import EVERYTHING
from operator_runs import (
    IN_EDIT_MODE,
    IN_OBJECT_MODE,
    KINDS,
    ON_QUADS,
    WITH_EVENTS,
    WITHOUT_STEP,
    Run,
    edit_some,
    unwrapped_ball,
)
from scenes import UvMap, changed, edit, select_elements, snapshot

pytestmark = pytest.mark.slow

# That nothing drifts is seen after a few.
TIMES = 10 if EVERYTHING else 3


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
    undone = {kind.bl_idname for kind in KINDS if "UNDO" in kind.bl_options}
    runs = {run.operator for run in (*IN_OBJECT_MODE.values(), *IN_EDIT_MODE.values())}
    assert undone == runs | WITH_EVENTS | ON_QUADS
    assert {kind.bl_idname for kind in KINDS} - undone == WITHOUT_STEP


@pytest.mark.parametrize("operator", IN_OBJECT_MODE)
def test_operators_are_undone_and_redone_in_object_mode(operator: str) -> None:
    require_undone_and_redone([unwrapped_ball().name], IN_OBJECT_MODE[operator], times=TIMES)


@pytest.mark.parametrize("operator", IN_EDIT_MODE)
def test_operators_are_undone_and_redone_in_edit_mode(operator: str) -> None:
    ball = unwrapped_ball()
    edit_some(ball)
    require_undone_and_redone([ball.name], IN_EDIT_MODE[operator], times=TIMES)


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
