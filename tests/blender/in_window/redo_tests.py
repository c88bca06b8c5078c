# SPDX-License-Identifier: GPL-3.0-or-later
"""Changing a property in the redo panel: progress, Esc, undo.  Run by run_in_window.py; no pytest."""

import bpy
from installed import addon
from invoke_tests import computing, slowed, stored_uv
from scenes import add_cone_cube, edit
from windows import click, middle, press, region, running, take_picture, until

# Of the first run, and of redone ones.
FIRST = {"seamless": False, "prescription": "AUTOMATIC", "pack": False}
OTHER = {"seamless": True}
THIRD = {"pack": True}
NAME = "Cube"


def cube():
    return bpy.data.objects[NAME]


def waiting():
    return running("UV_OT_cone_wait_for_redo")


def last():
    return bpy.context.window_manager.operators[-1]


def redo(**changed):
    """As the redo panel does when these properties are changed in it."""
    for name, value in changed.items():
        setattr(last().properties, name, value)
    bpy.ops.ed.undo_redo("EXEC_DEFAULT", True)


def unwrapped_with(**options):
    bpy.ops.uv.cone_unwrap("EXEC_DEFAULT", True, **(FIRST | options))
    uv = stored_uv(cube())
    bpy.ops.ed.undo()
    return uv


def begin(in_edit_mode=False):
    """UVs before and after a first run, and those that it has with `OTHER`."""
    add_cone_cube(NAME)
    if in_edit_mode:
        edit(cube())
    bpy.ops.ed.undo_push(message="before")
    before, other = stored_uv(cube()), unwrapped_with(**OTHER)
    assert bpy.ops.uv.cone_unwrap("INVOKE_DEFAULT", True, **FIRST) == {"FINISHED"}
    first = stored_uv(cube())
    yield 0.2
    assert len({before, first, other}) == 3
    return before, first, other


def in_both_modes(work):
    for in_edit_mode in (False, True):
        yield from work(in_edit_mode)
        bpy.ops.object.mode_set(mode="OBJECT")
        bpy.data.objects.remove(cube())


def test_a_long_redo_lets_blender_go_on_and_is_in_the_step_of_undo():
    def work(in_edit_mode):
        before, first, other = yield from begin(in_edit_mode)
        with slowed(3):
            redo(**OTHER)
            assert waiting() and computing()
            ticks = 0
            while waiting():
                assert stored_uv(cube()) == first
                ticks += 1
                yield 0.1
        assert ticks >= 3, ticks
        assert stored_uv(cube()) == other
        bpy.ops.ed.undo()
        yield 0.1
        assert stored_uv(cube()) == before
        bpy.ops.ed.redo()
        yield 0.1
        assert stored_uv(cube()) == other

    yield from in_both_modes(work)


def test_esc_stops_a_redo_and_the_panel_shows_the_earlier_values_again():
    def work(in_edit_mode):
        before, first, _ = yield from begin(in_edit_mode)
        with slowed(10):
            redo(**OTHER)
            yield 0.3
            yield from press("ESC")
            yield from until(lambda: not waiting(), 1.0)
            yield from until(lambda: not computing(), 1.0)
        assert stored_uv(cube()) == first
        assert {name: getattr(last().properties, name) for name in FIRST} == FIRST
        bpy.ops.ed.undo()
        yield 0.1
        assert stored_uv(cube()) == before

    yield from in_both_modes(work)


def test_of_two_changes_the_last_one_counts():
    before, _, other = yield from begin()
    with slowed(1.5):
        redo(prescription="HARMONIC")
        yield 0.3
        redo(prescription="AUTOMATIC", **OTHER)
        yield from until(lambda: not waiting())
        yield from until(lambda: not computing(), 1.0)
    assert stored_uv(cube()) == other
    bpy.ops.ed.undo()
    yield 0.1
    assert stored_uv(cube()) == before


def test_what_is_done_meanwhile_stops_a_redo():
    def move():
        bpy.ops.transform.translate("EXEC_DEFAULT", True, value=(1, 0, 0))

    for done, kept in ((move, 1), (bpy.ops.ed.undo, 0)):
        maps = yield from begin()
        with slowed(10):
            redo(**OTHER)
            yield 0.3
            done()
            yield from until(lambda: not waiting(), 1.0)
            yield from until(lambda: not computing(), 1.0)
        yield 0.3
        assert stored_uv(cube()) == maps[kept]
        assert cube().location.x == kept
        bpy.data.objects.remove(cube())


def test_a_file_opened_meanwhile_stops_a_redo():
    yield from begin()
    with slowed(10):
        redo(**OTHER)
        yield 0.3
        bpy.app.timers.register(lambda: bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True) and None)
        yield from until(lambda: not waiting() and not computing(), 8.0)


def test_a_short_redo_is_over_at_once():
    _, _, other = yield from begin()
    redo(**OTHER)
    assert not waiting() and stored_uv(cube()) == other
    yield 0


def test_a_click_in_the_redo_panel_is_redone_with_progress():
    add_cone_cube(NAME)
    bpy.ops.ed.undo_push(message="before")
    bpy.context.space_data.show_region_hud = True
    assert bpy.ops.uv.cone_auto_unwrap("INVOKE_DEFAULT", True, preset="PAINT") <= {"FINISHED", "RUNNING_MODAL"}
    yield from until(lambda: not running("UV_OT_cone_auto_unwrap"))
    before = stored_uv(cube())
    yield 0.5
    panel = region("HUD")
    take_picture("redo_panel_closed")
    yield from click((panel.x + panel.width / 2, panel.y + panel.height / 2))
    yield 0.5
    panel = region("HUD")
    take_picture("redo_panel_open")
    with slowed(2, "auto_unwrap"):
        yield from click((panel.x + 0.85 * panel.width, panel.y + panel.height - 68))
        yield 0.3
        take_picture("redo_panel_waiting")
        assert last().properties.preset == "BAKE"
        assert waiting() and stored_uv(cube()) == before
        yield from until(lambda: not waiting())
    assert stored_uv(cube()) != before and addon.mesh.reports.current(cube().data) is not None
    yield from click(middle())
