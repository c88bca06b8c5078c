# SPDX-License-Identifier: GPL-3.0-or-later
"""Edit Cones with the mouse and the keyboard: drag, add, remove, angles, Esc, one step of undo.

Run by run_in_window.py, not by pytest.
"""

import tempfile
from pathlib import Path

import bl_ui
import bpy
import numpy as np
import pytest
from installed import addon
from mathutils import Quaternion, Vector
from scenes import ANGLES, UvMap, add_ball, changed, edit, marked, plain_copy, snapshot, uv_key
from windows import (
    area,
    click,
    drag,
    event,
    move_to,
    place_of,
    press,
    region,
    running,
    take_picture,
    type_text,
    until,
    window,
)

angle_table = addon.jobs.angles.angle_table


def editing():
    return running("MESH_OT_cone_edit")


def begin(cuts=5):
    """A ball in edit mode, unwrapped, seen from the front, with the tool running."""
    ball = add_ball(cuts=cuts)
    edit(ball, select="DESELECT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.uv.cone_unwrap()
    bpy.ops.mesh.select_all(action="DESELECT")
    seen = area().spaces.active.region_3d
    seen.view_perspective = "PERSP"
    seen.view_rotation = Quaternion((0.7071, 0.7071, 0, 0)) @ Quaternion((0, 1, 0), 0.3)
    seen.view_location, seen.view_distance = Vector((0, 0, 0)), 5.0
    bpy.ops.ed.undo_push(message="before")
    yield 0.3
    assert bpy.ops.mesh.cone_edit("INVOKE_DEFAULT", True) == {"RUNNING_MODAL"}
    yield 0.1
    assert editing()


def ball():
    return bpy.data.objects["Ball"]


def in_front(obj, accept):
    """Vertices whose normals face the viewer, sorted by how directly they do."""
    seen = area().spaces.active.region_3d
    toward = seen.view_matrix.inverted().translation.normalized()
    facing = [(vertex.normal @ toward, vertex.index) for vertex in obj.data.vertices]
    return [index for share, index in sorted(facing, reverse=True) if share > 0.5 and accept(index)]


def uv_of(obj):
    mesh = plain_copy(obj)
    uv = np.empty(2 * len(mesh.loops), np.float32)
    mesh.uv_layers["UVMap"].uv.foreach_get("vector", uv)
    bpy.data.meshes.remove(mesh)
    return uv.tobytes()


def angle_of(obj, vertex):
    mesh = plain_copy(obj)
    attribute = mesh.attributes.get(ANGLES)
    degrees = 0.0 if attribute is None else np.degrees(attribute.data[vertex].value)
    bpy.data.meshes.remove(mesh)
    return degrees


def require_one_step_of_undo(before):
    """What was done since a snapshot is undone and redone exactly."""
    after = snapshot(ball())
    bpy.ops.ed.undo()
    yield 0.2
    assert changed(before, snapshot(ball())) == set()
    bpy.ops.ed.redo()
    yield 0.2
    assert changed(after, snapshot(ball())) == set()


def test_dragging_a_cone_moves_it_and_the_map_follows_as_one_step_of_undo():
    yield from begin()
    before, cones = snapshot(ball()), marked(ball())
    start = in_front(ball(), lambda v: v in cones)[0]
    end = in_front(ball(), lambda v: v not in cones)[0]
    uv = uv_of(ball())
    yield from drag(place_of(ball(), start), place_of(ball(), end))
    yield from until(lambda: uv_of(ball()) != uv)
    take_picture("dragging_a_cone")
    assert marked(ball()) == cones
    yield from press("RET", place_of(ball(), end))
    yield from until(lambda: not editing())
    assert marked(ball()) == sorted({*cones} - {start} | {end})
    yield from require_one_step_of_undo(before)


def test_clicks_add_and_remove_and_digits_give_angles():
    yield from begin()
    cones = marked(ball())
    removed = in_front(ball(), lambda v: v in cones)[0]
    added = in_front(ball(), lambda v: v not in cones)[0]
    yield from click(place_of(ball(), removed), ctrl=True)
    place = place_of(ball(), added)
    yield from click(place)
    yield from type_text("270", place)
    yield from press("RET", place)
    assert editing()
    event("WHEELUPMOUSE", "PRESS", place)
    yield 0.2
    yield from press("RET", place)
    yield from until(lambda: not editing())
    assert marked(ball()) == sorted({*cones} - {removed} | {added})
    assert abs(angle_of(ball(), added) - 285) < 1e-4


def left_as_it_was(key):
    yield from begin()
    before, cones = snapshot(ball()), marked(ball())
    uv = uv_of(ball())
    start = in_front(ball(), lambda v: v in cones)[0]
    end = in_front(ball(), lambda v: v not in cones)[0]
    yield from click(place_of(ball(), end))
    yield from type_text("300", place_of(ball(), end))
    yield from drag(place_of(ball(), start), np.array(place_of(ball(), start)) + 40)
    yield from until(lambda: uv_of(ball()) != uv)
    yield from press(key, place_of(ball(), end))
    yield from until(lambda: not editing())
    assert changed(before, snapshot(ball())) == set()


def test_esc_leaves_everything_as_it_was():
    yield from left_as_it_was("ESC")


def test_the_right_mouse_button_leaves_everything_as_it_was():
    yield from left_as_it_was("RIGHTMOUSE")


def test_the_wheel_zooms_beside_cones_and_other_keys_do_nothing():
    yield from begin()
    before = snapshot(ball())
    seen = area().spaces.active.region_3d
    distance = seen.view_distance
    within = region()
    # Neither the ball nor the toolbar.
    corner = within.x + round(0.85 * within.width), within.y + round(0.1 * within.height)
    yield from move_to(corner)
    event("WHEELDOWNMOUSE", "PRESS", corner)
    yield from until(lambda: seen.view_distance > distance)
    for key in ("X", "TAB", "G"):
        yield from press(key, corner)
    assert editing()
    yield from press("RET", corner)
    yield from until(lambda: not editing())
    assert changed(before, snapshot(ball())) == set()


def test_opening_a_file_ends_the_tool():
    yield from begin()
    bpy.app.timers.register(lambda: bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True) and None)
    yield from until(lambda: not editing(), 8.0)


def behind(over, accept):
    """A vertex inside the view that other geometry occludes, and its place."""
    for vertex in in_front(ball(), accept):
        x, y = place_of(ball(), vertex)
        if 20 < x - over.x < over.width - 20 and 20 < y - over.y < over.height - 20:
            return vertex, (x, y)
    raise LookupError("no vertex is behind it")


def finished():
    """Press Enter, and the cones that there are then."""
    yield from press("RET")
    yield from until(lambda: not editing())
    return marked(ball())


def test_the_sidebar_gets_its_own_clicks():
    yield from begin()
    cones = marked(ball())
    area().spaces.active.show_region_ui = True
    area().spaces.active.region_3d.view_distance = 2.5
    yield 0.5
    sidebar = region("UI")
    category = sidebar.active_panel_category
    _, place = behind(sidebar, lambda v: v not in cones)
    yield from click(place)
    # Of the tabs at its right one that is not the open one.
    for height in range(40, 240, 20):
        yield from click((sidebar.x + sidebar.width - 10, sidebar.y + sidebar.height - height))
        if sidebar.active_panel_category != category:
            break
    yield 0.3
    take_picture("sidebar_while_editing")
    assert sidebar.active_panel_category != category
    assert editing()
    assert (yield from finished()) == cones


def test_the_navigation_gizmo_turns_the_view():
    yield from begin()
    cones = marked(ball())
    view = area().spaces.active.region_3d
    view.view_distance = 1.8
    yield 0.3
    scale = bpy.context.preferences.system.ui_scale
    header = region("TOOL_HEADER")
    ball_place = region().x + region().width - 50 * scale, header.y - 50 * scale
    rotation = view.view_rotation.copy()
    yield from drag(ball_place, (ball_place[0] - 30, ball_place[1] - 5), 4)
    yield 0.3
    assert rotation.rotation_difference(view.view_rotation).angle > 0.1
    assert editing()
    assert (yield from finished()) == cones


def gizmos(space):
    return space.show_gizmo_navigate, space.show_gizmo_tool, space.show_gizmo_context


def test_gizmos_of_tools_are_hidden_so_that_clicks_there_are_on_the_model():
    bpy.ops.wm.tool_set_by_id(name="builtin.move")
    bpy.ops.screen.area_split(direction="VERTICAL", factor=0.4)
    other = next(found for found in window().screen.areas if found.type == "VIEW_3D" and found != area())
    other.spaces.active.show_gizmo_tool = False
    yield from begin()
    assert gizmos(area().spaces.active) == gizmos(other.spaces.active) == (True, False, False)
    cones = marked(ball())
    # The gizmo of Move would be on the selected vertex.
    added = in_front(ball(), lambda v: v not in cones)[0]
    saved = []

    def note(*_):
        saved.extend(gizmos(view.spaces.active) for view in (area(), other))

    bpy.app.handlers.save_pre.append(note)
    with tempfile.TemporaryDirectory() as folder:
        bpy.ops.wm.save_as_mainfile(filepath=str(Path(folder, "saved.blend")), copy=True)
    bpy.app.handlers.save_pre.remove(note)
    assert saved == [(True, True, True), (True, False, True)]
    assert gizmos(area().spaces.active) == (True, False, False) and editing()
    yield from click(place_of(ball(), added))
    assert (yield from finished()) == sorted([*cones, added])
    assert gizmos(area().spaces.active) == (True, True, True)
    assert gizmos(other.spaces.active) == (True, False, True)
    yield from begin_again_and_cancel()
    assert gizmos(area().spaces.active) == (True, True, True)


def begin_again_and_cancel():
    assert bpy.ops.mesh.cone_edit("INVOKE_DEFAULT", True) == {"RUNNING_MODAL"}
    yield 0.1
    assert gizmos(area().spaces.active) == (True, False, False)
    yield from press("ESC")
    yield from until(lambda: not editing())


@pytest.mark.nightly
def test_cones_are_added_in_each_view_of_four():
    yield from begin()
    cones = marked(ball())
    bpy.ops.screen.region_quadview()
    yield 0.5
    added = []
    views = [part for part in area().regions if part.type == "WINDOW"]
    assert len(views) == 4
    for number, view in enumerate(views):
        view.data.view_location, view.data.view_distance = (0, 0, 0), 6.0
        yield 0.3
        toward = view.data.view_matrix.inverted().to_3x3().col[2]
        facing = sorted(ball().data.vertices, key=lambda vertex: -(vertex.normal @ toward))
        free = [vertex.index for vertex in facing if vertex.index not in {*cones, *added}]
        added.append(free[number])
        yield from click(place_of(ball(), added[-1], view))
    yield 0.3
    take_picture("four_views")
    assert (yield from finished()) == sorted([*cones, *added])
    bpy.ops.screen.region_quadview()


def begin_and_change():
    """With one cone more and the map changed; returns what was before."""
    yield from begin()
    before, cones, uv = snapshot(ball()), marked(ball()), uv_of(ball())
    yield from click(place_of(ball(), in_front(ball(), lambda v: v not in cones)[0]))
    yield from until(lambda: uv_of(ball()) != uv)
    return before


def test_leaving_edit_mode_ends_the_tool_and_leaves_everything_as_it_was():
    before = yield from begin_and_change()
    bpy.ops.object.mode_set(mode="OBJECT")
    yield from until(lambda: not editing())
    assert changed(before, snapshot(ball())) == {"mode", "context"}


def test_undo_by_another_operator_ends_the_tool():
    before = yield from begin_and_change()
    bpy.ops.ed.undo_push(message="meanwhile")
    bpy.ops.ed.undo()
    yield from until(lambda: not editing())
    assert changed(before, snapshot(ball())) == set()


def test_other_elements_end_the_tool():
    yield from begin_and_change()
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.mesh.subdivide("EXEC_DEFAULT", True)
    yield from until(lambda: not editing())
    assert bpy.context.mode == "EDIT_MESH"


def test_other_layers_and_other_selections_do_not_matter():
    before = yield from begin_and_change()
    bpy.ops.mesh.uv_texture_add("EXEC_DEFAULT", True)
    bpy.context.object.data.uv_layers.active_index = 0
    bpy.ops.mesh.select_all("EXEC_DEFAULT", True, action="SELECT")
    yield 0.2
    assert editing()
    yield from press("ESC")
    yield from until(lambda: not editing())
    after = snapshot(ball())
    assert before[uv_key()] == after[uv_key()]


def test_our_other_operators_wait_for_the_end():
    yield from begin()
    assert not bpy.ops.uv.cone_unwrap.poll() and not bpy.ops.mesh.cone_mark.poll()
    yield from press("ESC")
    yield from until(lambda: not editing())
    assert bpy.ops.uv.cone_unwrap.poll() and bpy.ops.mesh.cone_mark.poll()


def test_ctrl_z_takes_back_one_step_and_blender_keeps_one_of_all():
    yield from begin()
    before, cones = snapshot(ball()), marked(ball())
    first, second = in_front(ball(), lambda v: v not in cones)[:2]
    place = place_of(ball(), first)
    yield from click(place)
    yield from press("RET", place)
    yield from until(lambda: not editing())
    one = snapshot(ball())
    bpy.ops.ed.undo()
    yield 0.2
    assert changed(before, snapshot(ball())) == set()
    assert bpy.ops.mesh.cone_edit("INVOKE_DEFAULT", True) == {"RUNNING_MODAL"}
    yield from click(place)
    yield from type_text("300", place)
    event("WHEELUPMOUSE", "PRESS", place)
    yield 0.2
    yield from click(place_of(ball(), second))
    yield 0.3
    take_picture("steps_to_undo")
    for _ in range(3):
        yield from press("Z", place, ctrl=True)
    yield 0.3
    take_picture("steps_undone")
    assert editing()
    yield from press("RET", place)
    yield from until(lambda: not editing())
    assert changed(one, snapshot(ball())) == set()
    bpy.ops.ed.undo()
    yield 0.2
    assert changed(before, snapshot(ball())) == set()


def status_bar_is_blenders():
    header = bl_ui.space_statusbar.STATUSBAR_HT_header
    return header.draw is header._draw_orig


def test_the_status_bar_is_the_tools_until_it_ends():
    yield from begin()
    yield 0.2
    take_picture("status_bar")
    assert not status_bar_is_blenders()
    yield from press("ESC")
    yield from until(lambda: not editing())
    assert status_bar_is_blenders()


def test_all_steps_undone_leave_everything_as_it_was_and_redone_steps_count():
    yield from begin()
    before, cones = snapshot(ball()), marked(ball())
    added = in_front(ball(), lambda v: v not in cones)[0]
    place = place_of(ball(), added)
    yield from click(place)
    yield from press("Z", place, ctrl=True)
    yield 0.3
    assert changed(before, snapshot(ball())) == set()
    yield from press("Z", place, ctrl=True, shift=True)
    yield from press("Z", place, ctrl=True)
    yield from press("Y", place, ctrl=True)
    yield from press("RET", place)
    yield from until(lambda: not editing())
    assert marked(ball()) == sorted([*cones, added])


def open_sidebar():
    """With the tab of the add-on."""
    area().spaces.active.show_region_ui = True
    yield 0.5
    sidebar = region("UI")
    for height in range(20, round(sidebar.height), 20):
        if sidebar.active_panel_category == "Cone Unwrap":
            break
        yield from click((sidebar.x + sidebar.width - 10, sidebar.y + sidebar.height - height))
    yield 0.3


def test_the_table_shows_the_cones_as_they_are_edited():
    yield from begin()
    cones = marked(ball())
    yield from open_sidebar()
    sidebar = region("UI")
    # Its panel, to be seen in the picture.
    yield from click((sidebar.x + 80, sidebar.y + sidebar.height - 142))
    settings = angle_table.last_settings(bpy.context)
    added = in_front(ball(), lambda v: v not in cones)[0]
    place = place_of(ball(), added)
    yield from click(place)
    yield from type_text("345", place)
    yield 0.3
    (part,) = angle_table.current_table(ball(), settings)
    assert {row.vertex: row.angle for row in part.rows}[added] == np.radians(345)
    take_picture("table_while_editing")
    yield from press("ESC")
    yield from until(lambda: not editing())
    (part,) = angle_table.current_table(ball(), settings)
    assert [row.vertex for row in part.rows] == cones


def begin_with_two():
    """Two balls beside each other in edit mode, one of them scaled, with the tool running."""
    left, right = add_ball("Left", cuts=4), add_ball("Right", cuts=4)
    left.location.x, right.location.x, right.scale = -1.4, 1.4, (0.6, 1.0, 1.4)
    bpy.ops.object.select_all(action="SELECT")
    bpy.ops.uv.cone_unwrap()
    edit(left, right, select="DESELECT")
    seen = area().spaces.active.region_3d
    seen.view_perspective = "PERSP"
    seen.view_rotation, seen.view_distance = Quaternion((0.7071, 0.7071, 0, 0)), 9.0
    bpy.ops.ed.undo_push(message="before")
    yield 0.3
    assert bpy.ops.mesh.cone_edit("INVOKE_DEFAULT", True) == {"RUNNING_MODAL"}
    yield 0.1
    return left.name, right.name


def add_one_to_each(names):
    """By clicks; returns the vertices."""
    added = []
    for name in names:
        obj = bpy.data.objects[name]
        cones = marked(obj)
        added.append(in_front(obj, lambda v, cones=cones: v not in cones)[0])
        yield from click(place_of(obj, added[-1]))
        yield 0.3
    return added


def states(names):
    return [snapshot(bpy.data.objects[name]) for name in names]


def test_two_objects_are_edited_in_one_step_of_undo():
    names = yield from begin_with_two()
    before = states(names)
    cones = [marked(bpy.data.objects[name]) for name in names]
    added = yield from add_one_to_each(names)
    yield from type_text("340", place_of(bpy.data.objects[names[1]], added[1]))
    yield 0.3
    take_picture("two_objects")
    yield from press("RET")
    yield from press("RET")
    yield from until(lambda: not editing())
    assert [marked(bpy.data.objects[name]) for name in names] == [
        sorted([*old, new]) for old, new in zip(cones, added, strict=True)
    ]
    assert abs(angle_of(bpy.data.objects[names[1]], added[1]) - 340) < 1e-4
    after = states(names)
    bpy.ops.ed.undo()
    yield 0.2
    assert not any(changed(*pair) for pair in zip(before, states(names), strict=True))
    bpy.ops.ed.redo()
    yield 0.2
    assert not any(changed(*pair) for pair in zip(after, states(names), strict=True))


def test_esc_leaves_two_objects_as_they_were():
    names = yield from begin_with_two()
    before = states(names)
    yield from add_one_to_each(names)
    assert all(uv_key() in changed(*pair) for pair in zip(before, states(names), strict=True))
    yield from press("ESC")
    yield from until(lambda: not editing())
    assert not any(changed(*pair) for pair in zip(before, states(names), strict=True))


@pytest.mark.nightly
def test_objects_outside_a_local_view_are_not_picked():
    names = yield from begin_with_two()
    left, right = (bpy.data.objects[name] for name in names)
    place = place_of(right, in_front(right, lambda v: v not in marked(right))[0])
    bpy.ops.view3d.localview(frame_selected=False)
    right.local_view_set(area().spaces.active, False)
    yield 0.5
    assert right.mode == "EDIT"
    assert [obj.visible_get(viewport=area().spaces.active) for obj in (left, right)] == [True, False]
    yield from click(place)
    yield from click(place_of(left, in_front(left, lambda v: v not in marked(left))[0]))
    yield 0.3
    take_picture("local_view")
    yield from press("RET")
    yield from until(lambda: not editing())
    assert (len(marked(left)), len(marked(right))) == (9, 8)
    bpy.ops.view3d.localview()


def test_under_a_subdivision_surface_the_vertices_of_the_cage_are_picked():
    yield from begin()
    yield from press("ESC")
    yield from until(lambda: not editing())
    ball().modifiers.new("Subdivision", "SUBSURF").levels = 2
    yield 0.3
    assert bpy.ops.mesh.cone_edit("INVOKE_DEFAULT", True) == {"RUNNING_MODAL"}
    cones, uv = marked(ball()), uv_of(ball())
    added = in_front(ball(), lambda v: v not in cones)[0]
    yield from click(place_of(ball(), added))
    yield from until(lambda: uv_of(ball()) != uv)
    take_picture("subdivision")
    assert (yield from finished()) == sorted([*cones, added])


def place_in_layout(obj, vertex):
    """Pixels, in the window, of a vertex in the UV editor, where it is only once."""
    within = region("WINDOW", "IMAGE_EDITOR")
    uv_map = UvMap(obj)
    x, y = within.view2d.view_to_region(*uv_map.uv[uv_map.vertex == vertex][0], clip=False)
    return within.x + x, within.y + y


def inner_vertices(obj):
    """Those that are once in the layout, away from its cuts; the farthest from all cones there first."""
    uv_map = UvMap(obj)
    on_cuts = {vertex for edge in uv_map.split_edges() for vertex in edge}
    cones = uv_map.uv[np.isin(uv_map.vertex, marked(obj))]

    def distance(vertex):
        return np.linalg.norm(cones - uv_map.uv[uv_map.vertex == vertex][0], axis=1).min()

    return sorted({*range(len(obj.data.vertices))} - on_cuts, key=distance, reverse=True)


def ends(obj, cones):
    """Cones at ends of cuts, which are once in the layout too."""
    uv_map = UvMap(obj)
    return [cone for cone in cones if len(np.unique(uv_map.uv[uv_map.vertex == cone].round(6), axis=0)) == 1]


def test_cones_are_added_and_dragged_in_the_uv_editor():
    yield from begin()
    yield from press("ESC")
    yield from until(lambda: not editing())
    other = max((a for a in bpy.context.screen.areas if a.type != "VIEW_3D"), key=lambda a: a.width * a.height)
    other.ui_type = "UV"
    bpy.context.tool_settings.use_uv_select_sync = True
    yield 0.5
    within = region("WINDOW", "IMAGE_EDITOR")
    with bpy.context.temp_override(area=other, region=within):
        bpy.ops.image.view_all(fit_view=True)
    yield 0.5
    before, cones = snapshot(ball()), marked(ball())
    with bpy.context.temp_override(area=other, region=within):
        assert bpy.ops.mesh.cone_edit("INVOKE_DEFAULT", True) == {"RUNNING_MODAL"}
    added = inner_vertices(ball())[0]
    yield from click(place_in_layout(ball(), added))
    yield 0.5
    take_picture("uv_editor_added")
    (part,) = angle_table.current_table(ball(), angle_table.last_settings(bpy.context))
    assert [row.vertex for row in part.rows] == sorted([*cones, added])
    yield from press("Z", place_in_layout(ball(), added), ctrl=True)
    yield 0.5
    assert changed(before, snapshot(ball())) == set()
    start, target = ends(ball(), cones)[0], inner_vertices(ball())[1]
    yield from drag(place_in_layout(ball(), start), place_in_layout(ball(), target))
    yield 0.5
    take_picture("uv_editor_dragged")
    yield from press("RET")
    yield from until(lambda: not editing())
    assert marked(ball()) == sorted({*cones} - {start} | {target})
    bpy.ops.ed.undo()
    yield 0.2
    assert changed(before, snapshot(ball())) == set()


def test_gizmos_of_tools_are_hidden_in_uv_editors_that_have_some():
    yield from begin()
    yield from press("ESC")
    yield from until(lambda: not editing())
    other = max((a for a in bpy.context.screen.areas if a.type != "VIEW_3D"), key=lambda a: a.width * a.height)
    other.ui_type = "UV"
    yield 0.5
    for tool, is_shown in (("builtin.select_box", True), ("builtin.move", False)):
        with bpy.context.temp_override(area=other, region=region("WINDOW", "IMAGE_EDITOR")):
            bpy.ops.wm.tool_set_by_id(name=tool)
        assert bpy.ops.mesh.cone_edit("INVOKE_DEFAULT", True) == {"RUNNING_MODAL"}
        yield 0.1
        assert other.spaces.active.show_gizmo == is_shown
        yield from press("ESC")
        yield from until(lambda: not editing())
        assert other.spaces.active.show_gizmo
