# SPDX-License-Identifier: GPL-3.0-or-later
"""Every operator wherever it may be called: it runs, or says why it cannot, and never fails in Python."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from unittest.mock import MagicMock

import bpy
import numpy as np
import pytest
from installed import addon
from operator_runs import KINDS
from scenes import UvMap, add_cone_cube, add_cube, add_object, changed, edit, snapshot

OPERATORS = [kind.bl_idname for kind in KINDS]
PANELS = [kind for kind in addon.registration.CLASSES if issubclass(kind, bpy.types.Panel)]
# Their poll has no message, as no menu shows them.
UNSEEN = {"uv.cone_wait_for_redo"}


def make_active(data: bpy.types.ID | None) -> None:
    """A new object with this data is the active one, beside a selected cube."""
    add_cube(cuts=1)
    other = bpy.data.objects.new("Other", data)
    bpy.context.collection.objects.link(other)
    bpy.context.view_layer.objects.active = other


def no_active_object() -> None:
    add_cube(cuts=1)
    bpy.context.view_layer.objects.active = None


def nothing() -> None:
    pass


def a_hidden_mesh() -> None:
    add_cone_cube(cuts=1).hide_set(True)


def a_mesh_in_a_hidden_collection() -> None:
    add_cone_cube(cuts=1)
    bpy.context.view_layer.layer_collection.exclude = True


def a_mesh_without_anything() -> None:
    add_object("Empty", lambda bm: None)


def a_mesh_without_faces() -> None:
    add_object("Wire", lambda bm: bm.edges.new([bm.verts.new((x, 0, 0)) for x in range(2)]))


def a_flat_mesh() -> None:
    add_object("Flat", lambda bm: bm.faces.new([bm.verts.new((0, 0, 0)) for _ in range(3)]))


def edited(*builds: Callable[[], object]) -> None:
    for build in builds:
        build()
    edit(*bpy.data.objects)


def nothing_selected_in_edit_mode() -> None:
    edit(add_cone_cube(cuts=1), select="DESELECT")


def all_hidden_in_edit_mode() -> None:
    edit(add_cone_cube(cuts=1))
    bpy.ops.mesh.hide()


def in_mode(mode: str) -> None:
    add_cone_cube(cuts=1)
    bpy.ops.object.mode_set(mode=mode)


def a_curve_in_edit_mode() -> None:
    bpy.ops.curve.primitive_bezier_curve_add(enter_editmode=True)


def another_object_is_active_beside_one_in_edit_mode() -> None:
    other = add_cube("Other", cuts=1)
    edit(add_cone_cube(cuts=1))
    bpy.context.view_layer.objects.active = other
    other.select_set(True)


def a_second_scene() -> None:
    add_cone_cube(cuts=1)
    bpy.context.window.scene = bpy.data.scenes.new("Other")


CONTEXTS = {
    "nothing": nothing,
    "no active object": no_active_object,
    "an empty": lambda: make_active(None),
    "a curve": lambda: make_active(bpy.data.curves.new("Other", "CURVE")),
    "a lattice": lambda: make_active(bpy.data.lattices.new("Other")),
    "a camera": lambda: make_active(bpy.data.cameras.new("Other")),
    "a hidden mesh": a_hidden_mesh,
    "a mesh in a hidden collection": a_mesh_in_a_hidden_collection,
    "a mesh without anything": a_mesh_without_anything,
    "a mesh without faces": a_mesh_without_faces,
    "a flat mesh": a_flat_mesh,
    "edit mode without anything": lambda: edited(a_mesh_without_anything),
    "edit mode without faces": lambda: edited(a_mesh_without_faces),
    "edit mode of a flat mesh": lambda: edited(a_flat_mesh),
    "edit mode of two": lambda: edited(lambda: add_cone_cube(cuts=1), a_mesh_without_faces),
    "edit mode, nothing selected": nothing_selected_in_edit_mode,
    "edit mode, all hidden": all_hidden_in_edit_mode,
    "edit mode of a curve": a_curve_in_edit_mode,
    "edit mode, another active": another_object_is_active_beside_one_in_edit_mode,
    "sculpt mode": lambda: in_mode("SCULPT"),
    "weight paint mode": lambda: in_mode("WEIGHT_PAINT"),
    "another scene": a_second_scene,
}


@contextmanager
def in_area(kind: str | None) -> Iterator[None]:
    """In an area of this type, as scripts and other add-ons may call operators; None for no area."""
    if kind is None:
        with bpy.context.temp_override(window=None, area=None, region=None):
            yield
        return
    window = bpy.context.window_manager.windows[0]
    area = window.screen.areas[0]
    before, area.type = area.type, kind
    region = next(region for region in area.regions if region.type == "WINDOW")
    try:
        with bpy.context.temp_override(window=window, area=area, region=region):
            yield
    finally:
        area.type = before


def require_a_word(operator: str, how: str, printed: Callable[[], tuple[str, str]]) -> None:
    """Call it; it has to run, or to say something to the artist."""
    group, name = operator.split(".")
    call = getattr(getattr(bpy.ops, group), name)
    reason = ""
    try:
        ended = call(how)
    except RuntimeError as error:
        ended, reason = {"CANCELLED"}, str(error)
    said, failed = printed()
    assert "Traceback" not in said + failed + reason
    assert operator in UNSEEN or "context is incorrect" not in reason, "no reason is given"
    assert ended == {"FINISHED"} or said or reason


@pytest.mark.slow
@pytest.mark.parametrize("context", CONTEXTS)
@pytest.mark.parametrize("operator", OPERATORS)
def test_an_operator_runs_or_says_why_not(operator: str, context: str, printed: Callable[[], tuple[str, str]]) -> None:
    CONTEXTS[context]()
    printed()
    require_a_word(operator, "EXEC_DEFAULT", printed)


@pytest.mark.slow
@pytest.mark.parametrize("how", ["EXEC_DEFAULT", "INVOKE_DEFAULT"])
@pytest.mark.parametrize("area", [None, "VIEW_3D", "IMAGE_EDITOR", "OUTLINER", "TEXT_EDITOR"])
@pytest.mark.parametrize("operator", OPERATORS)
def test_an_operator_runs_or_says_why_not_in_any_area(
    operator: str, area: str | None, how: str, printed: Callable[[], tuple[str, str]]
) -> None:
    edit(add_cone_cube(cuts=1))
    with in_area(area):
        printed()
        require_a_word(operator, how, printed)


@pytest.mark.parametrize("in_edit_mode", [False, True])
@pytest.mark.parametrize("operator", [bpy.ops.uv.cone_auto_unwrap, bpy.ops.uv.cone_unwrap])
def test_without_a_window_a_map_is_the_same(operator: Callable[[], set[str]], in_edit_mode: bool) -> None:
    maps = []
    for area in ("VIEW_3D", None):
        bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
        cube, unselected = add_cone_cube(cuts=1), add_cone_cube("Unselected", cuts=1)
        edit(cube) if in_edit_mode else unselected.select_set(False)
        before = snapshot(unselected)
        with in_area(area):
            assert operator() == {"FINISHED"}
        assert changed(before, snapshot(unselected)) == set()
        maps.append(UvMap(cube).uv)
    assert np.array_equal(*maps) and np.ptp(maps[0]) > 0


@pytest.mark.parametrize("context", CONTEXTS)
def test_panels_are_drawn(context: str) -> None:
    CONTEXTS[context]()
    for kind in PANELS:
        if not hasattr(kind, "poll") or kind.poll(bpy.context):
            panel = type("Panel", (), {name: value for name, value in vars(kind).items() if callable(value)})()
            panel.layout = MagicMock()
            panel.draw(bpy.context)
