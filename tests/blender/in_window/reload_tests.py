# SPDX-License-Identifier: GPL-3.0-or-later
"""The add-on is disabled while its operators run: they end as with Esc, and leave nothing.

Run by run_in_window.py; no pytest.
"""

import addon_utils
import bl_ui
import bpy
import edit_tests
from installed import EXTENSION
from invoke_tests import computing, slowed
from redo_tests import OTHER, begin, cube, redo, waiting
from scenes import add_cone_cube, changed, edit, marked, snapshot
from windows import area, click, middle, move_to, place_of, press, until, window

KINDS = ("MESH_OT_cone_", "UV_OT_cone_", "OBJECT_OT_cone_")


def disabled():
    """Disable the add-on, see that nothing of it is left, and enable it again."""
    addon_utils.disable(EXTENSION)
    try:
        assert not computing()
        # Blender removes the ended operators with the next event.
        yield from move_to(middle())
        yield 0.2
        assert not [modal for modal in window().modal_operators if modal.bl_idname.startswith(KINDS)]
        assert status_bar_is_blenders()
    finally:
        addon_utils.enable(EXTENSION)
    yield 0.2


def status_bar_is_blenders():
    header = bl_ui.space_statusbar.STATUSBAR_HT_header
    return getattr(header, "_draw_orig", header.draw) is header.draw


def test_disabled_while_it_computes():
    cube = add_cone_cube()
    for in_edit_mode in (False, True):
        if in_edit_mode:
            edit(cube)
        before = snapshot(cube)
        with slowed(20):
            assert bpy.ops.uv.cone_unwrap("INVOKE_DEFAULT", True) == {"RUNNING_MODAL"}
            yield 0.3
            assert computing()
            yield from disabled()
        assert changed(before, snapshot(cube)) == set()
        assert bpy.ops.uv.cone_unwrap("EXEC_DEFAULT", True) == {"FINISHED"}


def test_disabled_while_it_computes_for_a_redo():
    yield from begin()
    kept = snapshot(cube())
    with slowed(20):
        redo(**OTHER)
        assert waiting() and computing()
        yield from disabled()
    assert changed(kept, snapshot(cube())) == set()


def test_disabled_while_something_is_edited():
    yield from edit_tests.begin()
    yield from press("ESC")
    ball, gizmos = edit_tests.ball(), area().spaces.active.show_gizmo_tool
    cones = marked(ball)
    place = place_of(ball, edit_tests.in_front(ball, lambda vertex: vertex not in cones)[0])
    for operator in ("cone_edit", "cone_edit_cuts", "cone_draw_up"):
        before = snapshot(ball)
        assert getattr(bpy.ops.mesh, operator)("INVOKE_DEFAULT", True) == {"RUNNING_MODAL"}
        yield from click(place)
        if operator == "cone_edit":
            yield from until(lambda before=before: changed(before, snapshot(ball)))
        yield from disabled()
        assert changed(before, snapshot(ball)) == set(), operator
        assert area().spaces.active.show_gizmo_tool == gizmos
