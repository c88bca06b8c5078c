# SPDX-License-Identifier: GPL-3.0-or-later
"""Mark, clear, select and place cones: what changes, and that nothing else does."""

import math

import bmesh
import bpy
import pytest
from scenes import (
    GROUP,
    add_cone_cube,
    add_cube,
    add_grid,
    add_object,
    changed,
    corners,
    edit,
    mark,
    marked,
    select_elements,
    selected,
    snapshot,
)


def test_mark_adds_the_selected_vertices_to_the_group_and_changes_nothing_else():
    cube = add_cube()
    edit(cube)
    select_elements(cube, "verts", [3, 5, 11])
    before = snapshot(cube)
    assert bpy.ops.mesh.cone_mark() == {"FINISHED"}
    after = snapshot(cube)
    assert marked(cube) == [3, 5, 11]
    assert after["groups"] == [GROUP]
    assert changed(before, after) == {"weights", "groups", "active group"}


def test_mark_keeps_other_groups_their_weights_and_the_active_one():
    cube = add_cube()
    cube.vertex_groups.new(name="first").add([3, 4], 0.25, "REPLACE")
    cube.vertex_groups.new(name="second")
    cube.vertex_groups.active_index = 0
    edit(cube)
    select_elements(cube, "verts", [3])
    before = snapshot(cube)
    bpy.ops.mesh.cone_mark()
    after = snapshot(cube)
    assert after["groups"] == ["first", "second", GROUP]
    assert after["weights"][3] == [(0, 0.25), (2, 1.0)]
    assert after["weights"][4] == [(0, 0.25)]
    assert changed(before, after) == {"weights", "groups"}


def test_clear_takes_only_selected_cones_out_and_keeps_the_group():
    cube = add_cone_cube()
    cones = corners(cube)
    edit(cube)
    select_elements(cube, "verts", cones[:3])
    before = snapshot(cube)
    assert bpy.ops.mesh.cone_mark(clear=True) == {"FINISHED"}
    after = snapshot(cube)
    assert marked(cube) == cones[3:]
    assert changed(before, after) == {"weights"}


def test_mark_then_clear_restores_the_weights():
    cube = add_cube()
    cube.vertex_groups.new(name=GROUP)
    edit(cube)
    select_elements(cube, "verts", [1, 2])
    before = snapshot(cube)
    bpy.ops.mesh.cone_mark()
    assert marked(cube) == [1, 2]
    bpy.ops.mesh.cone_mark(clear=True)
    assert changed(before, snapshot(cube)) == set()


def test_a_vertex_made_between_a_cone_and_another_vertex_is_no_cone():
    cube = add_cube(cuts=1)
    edit(cube)
    select_elements(cube, "verts", [0])
    bpy.ops.mesh.cone_mark()
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.mesh.subdivide()
    bpy.ops.mesh.select_all(action="DESELECT")
    bpy.ops.mesh.cone_select()
    assert selected(cube) == [0]


def test_cones_that_subdividing_makes_between_cones_are_told_and_can_be_cleared(reports):
    cube = add_cube(cuts=0)
    edit(cube)
    bpy.ops.mesh.cone_mark()
    bpy.ops.uv.cone_unwrap()
    assert "in the middle" not in reports()
    eight = marked(cube)
    bpy.ops.mesh.subdivide(number_cuts=3)
    reports()
    assert bpy.ops.uv.cone_unwrap() == {"FINISHED"}
    assert f"{len(marked(cube)) - 8} cones lie in the middle between two others" in reports()
    assert bpy.ops.mesh.cone_select_reported() == {"FINISHED"}
    bpy.ops.mesh.cone_mark(clear=True)
    assert marked(cube) == eight
    assert bpy.ops.uv.cone_unwrap() == {"FINISHED"}
    assert "in the middle" not in reports()


def test_cones_around_a_hole_are_not_told_to_be_between_others(reports):
    def build(bm):
        bmesh.ops.create_cone(bm, segments=12, radius1=1, radius2=1, depth=1)
        bm.loops.layers.uv.new("UVMap")

    edit(add_object("Tube", build))
    bpy.ops.mesh.cone_mark()
    reports()
    assert bpy.ops.uv.cone_unwrap() == {"FINISHED"}
    assert "in the middle" not in reports()


def test_mark_works_on_every_object_in_edit_mode_and_leaves_hidden_vertices():
    first, second = add_cube("First"), add_cube("Second")
    edit(first, second)
    select_elements(first, "verts", [0, 1])
    select_elements(second, "verts", [2])
    bm = bmesh.from_edit_mesh(first.data)
    bm.verts.ensure_lookup_table()
    bm.verts[1].hide = True
    bpy.ops.mesh.cone_mark()
    assert marked(first) == [0]
    assert marked(second) == [2]


def test_mark_uses_the_group_it_is_given():
    cube = add_cube()
    edit(cube)
    select_elements(cube, "verts", [7])
    bpy.ops.mesh.cone_mark(vertex_group="points")
    assert marked(cube, "points") == [7]
    assert [group.name for group in cube.vertex_groups] == ["points"]


def test_mark_without_selection_is_refused_and_changes_nothing():
    cube = add_cube()
    edit(cube, select="DESELECT")
    before = snapshot(cube)
    with pytest.raises(RuntimeError, match="select the vertices"):
        bpy.ops.mesh.cone_mark()
    assert changed(before, snapshot(cube)) == set()


def test_nothing_to_mark_or_clear_is_said_and_cancelled(reports):
    cube = add_cone_cube()
    edit(cube)
    select_elements(cube, "verts", corners(cube))
    assert bpy.ops.mesh.cone_mark() == {"CANCELLED"}
    assert "cones already" in reports()
    others = sorted(set(range(len(cube.data.vertices))) - set(corners(cube)))
    select_elements(cube, "verts", others)
    assert bpy.ops.mesh.cone_mark(clear=True) == {"CANCELLED"}
    assert "No selected vertex is a cone" in reports()


def test_select_selects_exactly_the_cones_and_changes_nothing_but_selection(reports):
    cube = add_cone_cube()
    edit(cube)
    before = snapshot(cube)
    assert bpy.ops.mesh.cone_select() == {"FINISHED"}
    assert selected(cube) == corners(cube)
    assert "Selected 8 cones" in reports()
    differences = changed(before, snapshot(cube))
    assert "vertices select" in differences
    assert all(name.endswith("select") or ".select_" in name for name in differences)


def test_select_extend_keeps_what_was_selected():
    cube = add_cone_cube()
    cones = corners(cube)
    other = next(v for v in range(len(cube.data.vertices)) if v not in cones)
    edit(cube)
    select_elements(cube, "verts", [other])
    bpy.ops.mesh.cone_select(extend=True)
    assert selected(cube) == sorted([*cones, other])


def test_select_leaves_hidden_cones_hidden_and_says_so(reports):
    cube = add_cone_cube()
    cones = corners(cube)
    edit(cube)
    select_elements(cube, "verts", cones[:2])
    bpy.ops.mesh.hide()
    bpy.ops.mesh.cone_select()
    assert selected(cube) == cones[2:]
    assert "Selected 6 cones; 2 more hidden" in reports()


def test_select_goes_to_vertex_select_mode():
    cube = add_cone_cube()
    edit(cube)
    bpy.context.tool_settings.mesh_select_mode = (False, False, True)
    bpy.ops.mesh.cone_select()
    assert tuple(bpy.context.tool_settings.mesh_select_mode) == (True, False, False)
    assert selected(cube) == corners(cube)


def test_select_without_cones_is_cancelled_and_keeps_the_selection():
    cube = add_cube()
    edit(cube)
    select_elements(cube, "verts", [4])
    before = snapshot(cube)
    assert bpy.ops.mesh.cone_select() == {"CANCELLED"}
    assert changed(before, snapshot(cube)) == set()


@pytest.mark.parametrize("call", [bpy.ops.mesh.cone_mark, bpy.ops.mesh.cone_select])
def test_marking_and_selecting_ask_for_edit_mode(call):
    add_cube()
    assert not call.poll()
    with pytest.raises(RuntimeError, match="Enter edit mode on a mesh"):
        call()


@pytest.mark.parametrize("in_edit_mode", [True, False])
@pytest.mark.parametrize("cuts", [0, 1, 3])
def test_place_marks_as_many_cones_as_asked_and_changes_only_the_group_and_the_angles(cuts, in_edit_mode):
    cube = add_cube(cuts=cuts)
    if in_edit_mode:
        edit(cube)
    before = snapshot(cube)
    assert bpy.ops.mesh.cone_place(automatic=False, count=8) == {"FINISHED"}
    assert len(marked(cube)) == 8
    attributes = {"attribute uv_cone_angle POINT FLOAT", "attribute uv_cone_angle_kind POINT INT"}
    assert changed(before, snapshot(cube)) <= {"weights", "groups", "active group"} | attributes


@pytest.mark.parametrize("cuts", [0, 3])
def test_place_finds_the_corners_of_a_cube(cuts):
    cube = add_cube(cuts=cuts)
    assert bpy.ops.mesh.cone_place(automatic=False, count=8) == {"FINISHED"}
    assert marked(cube) == corners(cube)


def test_place_keeps_marked_cones_or_replaces_them_as_asked():
    cube = add_cube()
    odd = next(v for v in range(len(cube.data.vertices)) if v not in corners(cube))
    mark(cube, [odd])
    bpy.ops.mesh.cone_place(automatic=False, count=4)
    assert odd in marked(cube) and len(marked(cube)) == 4
    bpy.ops.mesh.cone_place(automatic=False, count=8, keep=False)
    assert marked(cube) == corners(cube)


def test_place_gives_the_same_cones_in_edit_and_object_mode_and_every_time():
    first, second = add_cube("First"), add_cube("Second")
    bpy.ops.mesh.cone_place(automatic=False, count=6)
    chosen = marked(first)
    assert marked(second) == chosen
    bpy.ops.object.select_all(action="DESELECT")
    edit(second)
    bpy.ops.mesh.cone_place(automatic=False, count=6, keep=False)
    assert marked(second) == chosen


def test_place_looks_at_selected_faces_only():
    first = add_cube("First")
    edit(first, select="DESELECT")
    upper = [f.index for f in bmesh.from_edit_mesh(first.data).faces if f.calc_center_median().z > -0.9]
    select_elements(first, "faces", upper)
    bpy.ops.mesh.cone_place(automatic=False, count=4)
    top = [v for v in corners(first) if first.data.vertices[v].co.z > 0]
    assert marked(first) == top


@pytest.mark.parametrize("turned", [0, math.pi])
def test_place_keeps_cones_out_of_what_the_front_view_shows(turned):
    def build(bm):
        bmesh.ops.create_icosphere(bm, subdivisions=4, radius=1.0)
        bmesh.ops.scale(bm, vec=(1.0, depth, 1.3), verts=bm.verts)

    depth = 0.7
    egg = add_object("Egg", build)
    egg.rotation_euler.z = turned
    bpy.context.view_layer.update()
    foremost = {}
    for cuts in ("SHORTEST", "FRONT"):
        bpy.ops.mesh.cone_place(target=1.06, keep=False, cuts=cuts)
        foremost[cuts] = max(-(egg.matrix_world @ egg.data.vertices[v].co).y for v in marked(egg))
    assert foremost["FRONT"] < math.cos(math.pi / 4) * depth
    assert foremost["FRONT"] != foremost["SHORTEST"]


def test_place_without_selected_faces_is_refused():
    grid = add_grid()
    edit(grid, select="DESELECT")
    before = snapshot(grid)
    with pytest.raises(RuntimeError, match="select the faces"):
        bpy.ops.mesh.cone_place()
    assert changed(before, snapshot(grid)) == set()


def test_normalize_all_on_a_rigged_mesh_leaves_bones_and_cones_alone():
    cube = add_cube()
    bpy.ops.object.armature_add()
    rig = bpy.context.object
    bpy.ops.object.mode_set(mode="EDIT")
    rig.data.edit_bones[0].name = "lower"
    upper = rig.data.edit_bones.new("upper")
    upper.head, upper.tail = (0, 0, 1), (0, 0, 2)
    bpy.ops.object.mode_set(mode="OBJECT")
    bpy.context.view_layer.objects.active = cube
    cube.modifiers.new("Armature", "ARMATURE").object = rig
    for name, weight in (("lower", 0.25), ("upper", 0.75)):
        cube.vertex_groups.new(name=name).add(range(len(cube.data.vertices)), weight, "REPLACE")
    edit(cube)
    select_elements(cube, "verts", [3])
    bpy.ops.mesh.cone_mark()
    bpy.ops.object.mode_set(mode="OBJECT")
    # A lock would leave nothing to other groups where Blender normalizes all of them together.
    assert not cube.vertex_groups[GROUP].lock_weight
    assert bpy.ops.object.vertex_group_normalize_all(lock_active=False) == {"FINISHED"}
    weights = [[round(group.weight, 6) for group in cube.data.vertices[v].groups] for v in (3, 4)]
    assert weights == [[0.25, 0.75, 1.0], [0.25, 0.75]]
