# SPDX-License-Identifier: GPL-3.0-or-later
"""Operators on meshes of other files, which they refuse with the reason, and on meshes with shape keys."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import bpy
import pytest
from operator_runs import IN_EDIT_MODE, IN_OBJECT_MODE, edit_some, unwrapped_ball
from scenes import changed, snapshot


def linked(folder: Path) -> bpy.types.Object:
    """A selected ball of another file."""
    path = str(folder / "library.blend")
    bpy.data.libraries.write(path, {unwrapped_ball()})
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    with bpy.data.libraries.load(path, link=True) as (source, wanted):
        wanted.objects = source.objects
    (ball,) = wanted.objects
    return shown(ball)


def shown(obj: bpy.types.Object) -> bpy.types.Object:
    """Selected alone, and active."""
    if obj.name not in bpy.context.collection.objects:
        bpy.context.collection.objects.link(obj)
    bpy.ops.object.select_all(action="DESELECT")
    obj.select_set(True)
    bpy.context.view_layer.objects.active = obj
    bpy.context.view_layer.update()
    return obj


def overridden(folder: Path) -> bpy.types.Object:
    """A local override of it, whose mesh is still the other file's."""
    return shown(linked(folder).override_create(remap_local_usages=True))


def overridden_with_its_mesh(folder: Path) -> bpy.types.Object:
    """The same with an override of its mesh, of which Blender saves hardly anything."""
    ball = overridden(folder)
    ball.data.override_create(remap_local_usages=True)
    assert ball.data.override_library is not None
    return ball


def local_with_a_linked_mesh(folder: Path) -> bpy.types.Object:
    mesh = linked(folder).data
    return shown(bpy.data.objects.new("Local", mesh))


@pytest.mark.slow
@pytest.mark.parametrize("build", [linked, overridden, overridden_with_its_mesh, local_with_a_linked_mesh])
@pytest.mark.parametrize("operator", sorted(IN_OBJECT_MODE.keys() - {"get density", "select row"}))
def test_meshes_of_other_files_are_refused_with_the_reason(
    operator: str,
    build: Callable[[Path], bpy.types.Object],
    tmp_path: Path,
    printed: Callable[[], tuple[str, str]],
) -> None:
    ball = build(tmp_path)
    before = snapshot(ball)
    printed()
    try:
        said = str(IN_OBJECT_MODE[operator]())
    except RuntimeError as error:
        said = str(error)
    assert changed(before, snapshot(ball)) == set()
    output, failed = printed()
    assert "Traceback" not in output + failed + said
    assert "linked from another file" in output + said


def with_keys() -> bpy.types.Object:
    """The ball with a shape key, and with a Subdivision Surface modifier."""
    ball = unwrapped_ball()
    ball.shape_key_add(name="Basis")
    key = ball.shape_key_add(name="Long")
    for point in key.data:
        point.co.z *= 3
    key.value = 0.5
    ball.modifiers.new("Subdivision", "SUBSURF").levels = 1
    return ball


def keys_of(obj: bpy.types.Object) -> tuple[dict[str, object], int]:
    """What an operator leaves of them, and how many data-blocks with keys there are."""
    state = snapshot(obj)
    return {name: state[name] for name in ("shape keys", "modifiers", "attribute position POINT FLOAT_VECTOR")}, len(
        bpy.data.shape_keys
    )


@pytest.mark.parametrize("operator", IN_OBJECT_MODE)
def test_shape_keys_stay_in_object_mode(operator: str, tmp_path: Path) -> None:
    ball = with_keys()
    before = keys_of(ball)
    assert IN_OBJECT_MODE[operator]() == {"FINISHED"}
    assert keys_of(ball) == before
    # Blender complains of what it finds to be wrong.
    assert bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "saved.blend"), copy=True) == {"FINISHED"}


@pytest.mark.slow
@pytest.mark.parametrize("operator", IN_EDIT_MODE)
def test_shape_keys_stay_in_edit_mode(operator: str, tmp_path: Path) -> None:
    ball = with_keys()
    before = keys_of(ball)
    edit_some(ball)
    assert IN_EDIT_MODE[operator]() == {"FINISHED"}
    bpy.ops.object.mode_set(mode="OBJECT")
    assert keys_of(ball) == before
    assert bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "saved.blend"), copy=True) == {"FINISHED"}
