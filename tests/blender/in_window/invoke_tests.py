# SPDX-License-Identifier: GPL-3.0-or-later
"""Unwrap from Cones and Place Cones as an artist invokes them: progress, Esc, undo; the table of angles.

Run by run_in_window.py, not by pytest.
"""

import threading
import time
from contextlib import contextmanager, suppress

import bpy
import numpy as np
import pytest
from installed import addon
from mathutils import Vector
from scenes import add_ball, add_cone_cube, changed, edit, marked, plain_copy, snapshot, uv_key
from windows import STEP, press, region, running, until


@contextmanager
def slowed(seconds, verb="parameterize"):
    """The library takes so much longer and reports progress meanwhile; earlier maps are forgotten."""
    addon.jobs.layouts.remembered.forget()
    lsgp = addon.core.native.lsgp
    work = getattr(lsgp, verb)

    def slowly(*arguments, **options):
        progress = options["progress"] if "progress" in options else arguments[-1]
        begin = time.monotonic()
        while progress is not None and (share := (time.monotonic() - begin) / seconds) < 1:
            if progress(0.9 * share) is False:
                raise lsgp.Cancelled("CANCELLED", "Stopped.")
            time.sleep(STEP)
        return work(*arguments, **options)

    setattr(lsgp, verb, slowly)
    try:
        yield
    finally:
        setattr(lsgp, verb, work)


def unwrap(**options):
    return bpy.ops.uv.cone_unwrap("INVOKE_DEFAULT", True, **options)


def unwrapping():
    return running("UV_OT_cone_unwrap")


def computing():
    return [thread for thread in threading.enumerate() if thread.name == "Cone Unwrap"]


def wait_for_end():
    yield from until(lambda: not unwrapping())


def stored_uv(obj):
    mesh = plain_copy(obj)
    uv = np.empty(2 * len(mesh.loops), np.float32)
    mesh.uv_layers["UVMap"].uv.foreach_get("vector", uv)
    bpy.data.meshes.remove(mesh)
    return uv.tobytes()


def stopped_by(key, in_edit_mode):
    cube = add_cone_cube()
    if in_edit_mode:
        edit(cube)
    before = snapshot(cube)
    with slowed(10):
        assert unwrap(pack=True) == {"RUNNING_MODAL"}
        yield 0.3
        assert unwrapping() and computing()
        yield from press(key)
        yield from until(lambda: not unwrapping(), 1.0)
        assert changed(before, snapshot(cube)) == set()
        yield from until(lambda: not computing(), 1.0)
    yield 0.2
    assert changed(before, snapshot(cube)) == set()
    assert "UV_OT_cone_unwrap" not in [operator.bl_idname for operator in bpy.context.window_manager.operators]


def test_esc_stops_at_once_and_nothing_changes():
    for in_edit_mode in (False, True):
        yield from stopped_by("ESC", in_edit_mode)
        bpy.ops.object.mode_set(mode="OBJECT")


def test_the_right_mouse_button_stops_too():
    yield from stopped_by("RIGHTMOUSE", True)


def test_blender_goes_on_in_a_long_run_and_the_map_is_that_of_a_direct_one():
    cube = add_cone_cube()
    edit(cube)
    before = snapshot(cube)
    bpy.ops.uv.cone_unwrap()
    direct = stored_uv(cube)
    bpy.ops.uv.reset()
    with slowed(3):
        assert unwrap() == {"RUNNING_MODAL"}
        # Eaten: neither leaves edit mode nor deletes.
        yield from press("TAB")
        yield from press("X")
        ticks = 2
        while unwrapping():
            ticks += 1
            yield STEP
        assert ticks >= 3, ticks
    assert stored_uv(cube) == direct
    assert changed(before, snapshot(cube)) == {uv_key()}
    assert not computing()


def test_a_short_run_is_over_at_once():
    cube = add_cone_cube()
    before = stored_uv(cube)
    assert unwrap() == {"FINISHED"}
    assert not unwrapping() and stored_uv(cube) != before
    yield 0


def test_a_long_run_is_one_step_of_undo():
    for in_edit_mode in (False, True):
        name = add_cone_cube().name
        if in_edit_mode:
            edit(bpy.data.objects[name])
        bpy.ops.ed.undo_push(message="before")
        before = stored_uv(bpy.data.objects[name])
        with slowed(0.5):
            assert unwrap() == {"RUNNING_MODAL"}
            yield from wait_for_end()
        after = stored_uv(bpy.data.objects[name])
        assert after != before
        bpy.ops.ed.undo()
        yield 0.1
        assert stored_uv(bpy.data.objects[name]) == before
        bpy.ops.ed.redo()
        yield 0.1
        assert stored_uv(bpy.data.objects[name]) == after
        bpy.ops.object.mode_set(mode="OBJECT")


def test_after_a_long_run_it_can_be_adjusted():
    cube = add_cone_cube()
    edit(cube)
    with slowed(0.5):
        assert unwrap(use_pins=False) == {"RUNNING_MODAL"}
        yield from wait_for_end()
    after = stored_uv(cube)
    last = bpy.context.window_manager.operators[-1]
    assert last.bl_idname == "UV_OT_cone_unwrap" and not last.properties.use_pins
    bpy.ops.uv.reset()
    # Runs the operator as the panel of the last operation does.
    bpy.ops.screen.repeat_history(index=len(bpy.context.window_manager.operators) - 2)
    yield 0.2
    assert stored_uv(cube) == after


def move_vertex(obj):
    obj.data.vertices[0].co.x += 1.0


def add_layer(obj):
    obj.data.uv_layers.new(name="Other")
    obj.data.uv_layers.active_index = 1


def enter_edit_mode(obj):
    edit(obj)


@pytest.mark.nightly
def test_a_mesh_that_is_changed_meanwhile_is_left_alone():
    for change in (move_vertex, add_layer, enter_edit_mode):
        cube = add_cone_cube()
        before = stored_uv(cube)
        with slowed(5):
            assert unwrap() == {"RUNNING_MODAL"}
            yield 0.2
            assert unwrapping()
            change(cube)
            changed_by_us = snapshot(cube)
            yield from wait_for_end()
        assert changed(changed_by_us, snapshot(cube)) == set(), change.__name__
        assert stored_uv(cube) == before, change.__name__
        bpy.ops.object.mode_set(mode="OBJECT")
        bpy.data.objects.remove(cube)


def test_of_two_objects_one_is_removed_meanwhile_and_the_other_unwrapped():
    gone, kept = add_cone_cube("Gone"), add_cone_cube("Kept")
    before = stored_uv(kept)
    with slowed(0.5):
        assert unwrap() == {"RUNNING_MODAL"}
        yield 0.2
        bpy.data.objects.remove(gone)
        yield from wait_for_end()
    assert stored_uv(kept) != before


def test_opening_a_file_stops_the_computation():
    add_cone_cube()
    with slowed(10):
        assert unwrap() == {"RUNNING_MODAL"}
        yield 0.2
        bpy.app.timers.register(lambda: bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True) and None)
        yield from until(lambda: not unwrapping() and not computing(), 8.0)


def test_the_library_itself_tells_its_progress_and_stops():
    ball = add_ball(cuts=100)
    before = stored_uv(ball)
    assert unwrap() == {"RUNNING_MODAL"}
    yield from press("ESC")
    yield from until(lambda: not unwrapping(), 2.0)
    yield from until(lambda: not computing())
    assert stored_uv(ball) == before


def place(**options):
    return bpy.ops.mesh.cone_place("INVOKE_DEFAULT", True, **options)


def placing():
    return running("MESH_OT_cone_place")


def test_placing_cones_is_stopped_by_esc_and_nothing_changes():
    cube = add_cone_cube()
    edit(cube)
    before = snapshot(cube)
    with slowed(10, "place_cones"):
        assert place(automatic=False, count=10) == {"RUNNING_MODAL"}
        yield 0.3
        assert placing() and computing()
        yield from press("ESC")
        yield from until(lambda: not placing(), 1.0)
        yield from until(lambda: not computing(), 1.0)
    assert changed(before, snapshot(cube)) == set()


def test_auto_unwrap_is_stopped_by_esc_and_is_one_step_of_undo():
    cube = add_cone_cube()
    bpy.ops.ed.undo_push(message="before")
    before = stored_uv(cube)
    with slowed(10, "auto_unwrap"):
        assert bpy.ops.uv.cone_auto_unwrap("INVOKE_DEFAULT", True) == {"RUNNING_MODAL"}
        yield 0.3
        assert running("UV_OT_cone_auto_unwrap") and computing()
        yield from press("ESC")
        yield from until(lambda: not running("UV_OT_cone_auto_unwrap"), 1.0)
        yield from until(lambda: not computing(), 1.0)
    assert stored_uv(cube) == before
    with slowed(0.5, "auto_unwrap"):
        assert bpy.ops.uv.cone_auto_unwrap("INVOKE_DEFAULT", True) == {"RUNNING_MODAL"}
        yield from until(lambda: not running("UV_OT_cone_auto_unwrap"))
    assert stored_uv(cube) != before
    bpy.ops.ed.undo()
    yield 0.1
    assert stored_uv(bpy.data.objects["Cube"]) == before


def test_placing_cones_for_long_is_one_step_of_undo():
    cube = add_cone_cube()
    edit(cube)
    bpy.ops.ed.undo_push(message="before")
    before = marked(bpy.data.objects["Cube"])
    with slowed(0.5, "place_cones"):
        assert place(automatic=False, count=10) == {"RUNNING_MODAL"}
        yield from until(lambda: not placing())
    after = marked(bpy.data.objects["Cube"])
    assert set(before) < set(after) and len(after) == 10
    bpy.ops.ed.undo()
    yield 0.1
    assert marked(bpy.data.objects["Cube"]) == before
    bpy.ops.ed.redo()
    yield 0.1
    assert marked(bpy.data.objects["Cube"]) == after


def test_the_table_of_angles_is_drawn_and_follows_undo():
    panel = bpy.types.VIEW3D_PT_cone_angles
    tables = addon.jobs.angles.angle_table
    draw, outcomes = panel.draw, []

    def watched(self, context):
        try:
            draw(self, context)
            table = tables.current_table(context.object, tables.last_settings(context))
            outcomes.append([row.angle for part in table for row in part.rows])
        except Exception as error:  # Blender would only print it
            outcomes.append(error)

    panel.draw = watched
    # Nobody opens it here.
    register(panel, set())
    try:
        edit(add_cone_cube())
        bpy.context.space_data.show_region_ui = True

        def drawn():
            # Blender takes no category before it has drawn the tabs.
            with suppress(AttributeError):
                region("UI").active_panel_category = "Cone Unwrap"
            region("UI").tag_redraw()
            return outcomes[-1:] == [[None] * 8]

        yield from until(drawn)
        bpy.ops.ed.undo_push(message="before")
        bpy.ops.mesh.cone_set_angle("EXEC_DEFAULT", True, angle=np.pi)
        yield from until(lambda: outcomes[-1] == [np.pi] * 8)
        bpy.ops.ed.undo()
        yield from until(lambda: outcomes[-1] == [None] * 8)
    finally:
        panel.draw = draw
        register(panel, {"DEFAULT_CLOSED"})


def register(panel, options):
    """Register a panel anew with these options."""
    bpy.utils.unregister_class(panel)
    panel.bl_options = options
    bpy.utils.register_class(panel)


PREFERRED = ("preset", "texture_size", "margin", "direction")


def pressed(**options):
    """What Auto Unwrap, invoked, was run with."""
    assert bpy.ops.uv.cone_auto_unwrap("INVOKE_DEFAULT", True, **options) <= {"FINISHED", "RUNNING_MODAL"}
    yield from until(lambda: not running("UV_OT_cone_auto_unwrap"))
    return used()


def used():
    properties = bpy.context.window_manager.operators[-1].properties
    return tuple(getattr(properties, name) for name in PREFERRED)


def redone(**changed):
    """What Auto Unwrap is run with when these properties are changed in the redo panel."""
    for name, value in changed.items():
        setattr(bpy.context.window_manager.operators[-1].properties, name, value)
    bpy.ops.ed.undo_redo("EXEC_DEFAULT", True)
    yield from until(lambda: not running("UV_OT_cone_wait_for_redo"))
    return used()


@contextmanager
def own_preferences():
    preferences = bpy.context.preferences.addons[addon.core.identifiers.EXTENSION].preferences
    try:
        yield preferences
    finally:
        for name in ("preset", "paint", "tile", "bake"):
            preferences.property_unset(name)


def test_the_first_press_begins_with_the_preferences_until_the_artist_chooses():
    add_cone_cube()
    with own_preferences() as preferences:
        assert (yield from pressed()) == ("PAINT", "1024", 4, "AUTO")
        preferences.preset, preferences.bake.texture_size = "BAKE", "2048"
        preferences.bake.margin, preferences.bake.direction = 8, "Z"
        # The last run had what the preferences said then; nobody chose it.
        assert (yield from pressed()) == ("BAKE", "2048", 8, "Z")
        assert (yield from pressed(margin=2)) == ("BAKE", "2048", 2, "Z")
        preferences.preset, preferences.tile.direction = "TILE", "X"
        preferences.bake.margin = 16
        assert (yield from pressed()) == ("TILE", "1024", 2, "X")
        assert (yield from pressed(preset="BAKE")) == ("BAKE", "2048", 2, "Z")


def test_what_was_chosen_for_one_object_is_not_taken_for_another():
    def count():
        return bpy.context.window_manager.operators[-1].properties.count

    objects = [add_cone_cube("First"), add_cone_cube("Second")]

    def make_active(obj):
        bpy.ops.object.select_all(action="DESELECT")
        obj.select_set(True)
        bpy.context.view_layer.objects.active = obj

    make_active(objects[0])
    assert (yield from pressed(count=9, texture_size="512")) == ("PAINT", "512", 4, "AUTO")
    make_active(objects[1])
    assert (yield from pressed(preset="BAKE")) == ("BAKE", "1024", 4, "AUTO") and count() == 0
    make_active(objects[0])
    assert (yield from pressed()) == ("PAINT", "512", 4, "AUTO") and count() == 9
    assert bpy.ops.mesh.cone_clear_data() == {"FINISHED"}
    assert (yield from pressed()) == ("PAINT", "1024", 4, "AUTO") and count() == 0


def test_a_preset_that_is_chosen_in_the_redo_panel_brings_its_preferences():
    add_cone_cube()
    bpy.ops.ed.undo_push(message="before")
    with own_preferences() as preferences:
        preferences.paint.margin, preferences.bake.margin, preferences.bake.texture_size = 6, 12, "4096"
        preferences.tile.tile_fit, preferences.tile.tiles = "TILES", 5.0
        assert (yield from pressed(texture_size="512")) == ("PAINT", "512", 6, "AUTO")
        assert (yield from redone(preset="BAKE")) == ("BAKE", "512", 12, "AUTO")
        # What the artist chose there stays.
        assert (yield from redone(margin=3)) == ("BAKE", "512", 3, "AUTO")
        assert (yield from redone(preset="TILE")) == ("TILE", "512", 3, "AUTO")
        tiles = bpy.context.window_manager.operators[-1].properties
        assert (tiles.tile_fit, tiles.tiles) == ("TILES", 5.0)
        assert (yield from redone(preset="PAINT")) == ("PAINT", "512", 3, "AUTO")


def test_a_click_on_a_row_turns_the_view_to_a_cone_that_is_out_of_sight():
    cube = add_cone_cube()
    view = bpy.context.region_data
    for mode in ("OBJECT", "EDIT"):
        bpy.ops.object.mode_set(mode=mode)
        view.view_rotation, view.view_location = (1, 0, 0, 0), (0, 0, 0)
        yield 0.2
        # From above, the corners at the top are seen and stay where they are.
        for vertex in marked(cube):
            before = view.view_rotation.copy()
            assert bpy.ops.mesh.cone_select_one(vertex=vertex) == {"FINISHED"}
            yield 0.1
            toward = view.view_rotation @ Vector((0, 0, 1))
            outward = Vector(np.sign(corner_places(cube)[vertex]))
            was_seen = outward.dot(before @ Vector((0, 0, 1))) > 0
            assert outward.dot(toward) > 0 and (view.view_rotation == before) == was_seen


def corner_places(cube):
    """The positions of the vertices of a mesh in any mode."""
    mesh = plain_copy(cube)
    places = [tuple(vertex.co) for vertex in mesh.vertices]
    bpy.data.meshes.remove(mesh)
    return places
