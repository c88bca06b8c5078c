# SPDX-License-Identifier: GPL-3.0-or-later
"""Cuts become seams and selections; and islands become seams become the same islands."""

import bmesh
import bpy
import numpy as np
import pytest
from installed import addon
from scenes import (
    UvMap,
    add_ball,
    add_cone_cube,
    add_grid,
    add_tube,
    changed,
    edges_where,
    edit,
    mark_seams,
    plain_copy,
    select_elements,
    snapshot,
)

stored_reports, cut_kinds = addon.mesh.reports, addon.core.cut_kinds


def seams_of(obj):
    mesh = plain_copy(obj)
    seams = {tuple(sorted(edge.vertices)) for edge in mesh.edges if edge.use_seam}
    bpy.data.meshes.remove(mesh)
    return seams


def selected_edges(obj):
    bm = bmesh.from_edit_mesh(obj.data)
    return {tuple(sorted(v.index for v in edge.verts)) for edge in bm.edges if edge.select}


def unwrapped_ball(name="Ball", **options):
    ball = add_ball(name)
    assert bpy.ops.uv.cone_unwrap(**options) == {"FINISHED"}
    edit(ball)
    return ball


@pytest.mark.parametrize("overlaps", ["KEEP", "SPLIT"])
def test_the_cuts_of_the_last_unwrap_become_seams_and_nothing_else_changes(overlaps, reports):
    ball = unwrapped_ball(overlaps=overlaps)
    cuts = UvMap(ball).split_edges()
    assert cuts
    before = snapshot(ball)
    reports()
    assert bpy.ops.mesh.cone_seams_from_cuts() == {"FINISHED"}
    assert f"Marked {len(cuts)} edges as seams" in reports()
    assert seams_of(ball) == cuts
    assert {name for name in changed(before, snapshot(ball)) if "seam" not in name} == set()


def test_marked_seams_stay():
    ball = add_ball()
    other = edges_where(ball, lambda place: place[2] > 0.6)
    bpy.ops.uv.cone_unwrap(seams="IGNORE")
    mark_seams(ball, other)
    edit(ball)
    cuts = UvMap(ball).split_edges()
    assert other - cuts
    assert bpy.ops.mesh.cone_seams_from_cuts() == {"FINISHED"}
    assert seams_of(ball) == cuts | other
    assert bpy.ops.mesh.cone_seams_from_cuts() == {"CANCELLED"}
    assert seams_of(ball) == cuts | other


def test_islands_that_were_moved_by_hand_have_the_same_cuts():
    ball = unwrapped_ball()
    cuts = UvMap(ball).split_edges()
    bm, turn = bmesh.from_edit_mesh(ball.data), np.array([[0.6, 0.8], [-0.8, 0.6]])
    layer = bm.loops.layers.uv.active
    for face in bm.faces:
        for loop in face.loops:
            loop[layer].uv = 0.37 * turn @ loop[layer].uv + (3.1, -7.3)
    bmesh.update_edit_mesh(ball.data)
    assert bpy.ops.mesh.cone_seams_from_cuts() == {"FINISHED"}
    assert seams_of(ball) == cuts


def test_unwrapping_along_the_seams_gives_the_same_cuts():
    ball = unwrapped_ball()
    cuts = UvMap(ball).split_edges()
    bpy.ops.mesh.cone_seams_from_cuts()
    assert bpy.ops.uv.cone_unwrap() == {"FINISHED"}
    assert UvMap(ball).split_edges() == cuts


def test_cuts_are_selected_in_edge_select_mode():
    ball = unwrapped_ball()
    cuts = UvMap(ball).split_edges()
    assert bpy.ops.mesh.cone_select_cuts() == {"FINISHED"}
    assert tuple(bpy.context.tool_settings.mesh_select_mode) == (False, True, False)
    assert selected_edges(ball) == cuts
    bpy.ops.mesh.select_all(action="DESELECT")
    bm = bmesh.from_edit_mesh(ball.data)
    bm.edges.ensure_lookup_table()
    further = next(edge for edge in bm.edges if tuple(sorted(v.index for v in edge.verts)) not in cuts)
    further.select_set(True)
    assert bpy.ops.mesh.cone_select_cuts(extend=True) == {"FINISHED"}
    assert selected_edges(ball) == cuts | {tuple(sorted(v.index for v in further.verts))}


def test_seams_and_cuts_that_cones_need_are_told_apart():
    ball = add_ball()
    bpy.ops.uv.cone_unwrap()
    marked = sorted(UvMap(ball).split_edges())[::2]
    mark_seams(ball, marked)
    bpy.ops.uv.cone_unwrap()
    edit(ball)
    cuts = UvMap(ball).split_edges()
    report = stored_reports.find(ball.data)
    of_kind = {kind: {tuple(sorted(edge)) for edge in report.edges_of(kind)} for kind in cut_kinds.KINDS}
    assert of_kind["seam"] == set(marked) & cuts != set()
    assert of_kind["required"] == cuts - set(marked) != set()
    assert of_kind["added"] == of_kind["moved"] == set()
    for kind, edges in of_kind.items():
        if not edges:
            assert bpy.ops.mesh.cone_select_cuts(kind=kind.upper()) == {"CANCELLED"}
            continue
        assert bpy.ops.mesh.cone_select_cuts(kind=kind.upper()) == {"FINISHED"}
        assert selected_edges(ball) == edges


def islands_between(uv, cuts):
    """How many islands the faces are in if the map is cut along these edges."""
    root = list(range(len(uv.loops_of_face)))
    face_of = {loop: face for face, loops in enumerate(uv.loops_of_face) for loop in loops}
    for edge in uv.sides.keys() - cuts:
        one, other = (root[face_of[side[0]]] for side in uv.sides[edge])
        root = [one if number == other else number for number in root]
    return len(set(root))


def test_cuts_that_divide_an_island_are_added_ones():
    cube = add_cone_cube(cuts=1)
    bpy.ops.uv.cone_auto_unwrap(preset="PAINT")
    edit(cube)
    report, uv = stored_reports.find(cube.data), UvMap(cube)
    added = {tuple(sorted(edge)) for edge in report.edges_of("added")}
    required = {tuple(sorted(edge)) for edge in report.edges_of("required")}
    assert added and added | required == uv.split_edges()
    assert islands_between(uv, added | required) == uv.islands() == 2
    assert islands_between(uv, required) == 1


def test_kinds_are_those_of_the_map_as_it_was_unwrapped():
    ball = unwrapped_ball()
    bm = bmesh.from_edit_mesh(ball.data)
    next(iter(bm.faces)).loops[0][bm.loops.layers.uv.active].uv.x += 0.1
    bmesh.update_edit_mesh(ball.data)
    with pytest.raises(RuntimeError, match="unwrap it again"):
        bpy.ops.mesh.cone_select_cuts(kind="REQUIRED")


def test_several_objects_and_one_without_a_map(reports):
    balls = [unwrapped_ball(name) for name in ("A", "B")]
    bpy.ops.object.mode_set(mode="OBJECT")
    bare = add_cone_cube("Bare")
    bare.data.uv_layers.remove(bare.data.uv_layers[0])
    edit(*balls, bare)
    reports()
    assert bpy.ops.mesh.cone_seams_from_cuts() == {"FINISHED"}
    assert "Bare: the mesh has no UV map; unwrap it first" in reports()
    for ball in balls:
        assert seams_of(ball) == UvMap(ball).split_edges()
    bpy.ops.object.mode_set(mode="OBJECT")
    edit(bare)
    with pytest.raises(RuntimeError, match="no UV map"):
        bpy.ops.mesh.cone_seams_from_cuts()
    with pytest.raises(RuntimeError, match="no UV map"):
        bpy.ops.mesh.cone_select_cuts()


def test_hidden_edges_are_left_alone():
    ball = unwrapped_ball()
    cuts = UvMap(ball).split_edges()
    select_elements(ball, "faces", [face.index for face in ball.data.polygons if face.center.z > 0])
    bpy.ops.mesh.hide()
    hidden = {tuple(sorted(v.index for v in e.verts)) for e in bmesh.from_edit_mesh(ball.data).edges if e.hide}
    assert hidden & cuts and cuts - hidden
    assert bpy.ops.mesh.cone_seams_from_cuts() == {"FINISHED"}
    assert seams_of(ball) == cuts - hidden


def test_borders_of_the_mesh_are_no_cuts(reports):
    grid = add_grid()
    edit(grid)
    bpy.ops.uv.unwrap()
    for operator in (bpy.ops.mesh.cone_seams_from_cuts, bpy.ops.mesh.cone_select_cuts):
        reports()
        assert operator() == {"CANCELLED"}
        assert "No visible edge is cut in the UV map; unwrap the mesh first" in reports()


def test_a_cut_within_an_island_is_a_seam_too():
    tube = add_tube()
    assert bpy.ops.uv.cone_unwrap() == {"FINISHED"}
    uv_map = UvMap(tube)
    assert uv_map.islands() == 1
    edit(tube)
    bpy.ops.mesh.cone_seams_from_cuts()
    assert seams_of(tube) == uv_map.split_edges() != set()


def faces_by_island(obj):
    islands = {}
    for face, island in enumerate(UvMap(obj).island_of_face()):
        islands.setdefault(island, set()).add(face)
    return {frozenset(faces) for faces in islands.values()}


def add_suzanne_with_seams_from_islands():
    """Suzanne without a map, with seams around the islands of Blender's own Smart UV Project, and these islands."""
    bpy.ops.mesh.primitive_monkey_add()
    suzanne = bpy.context.object
    edit(suzanne)
    assert bpy.ops.uv.smart_project(angle_limit=1.15, island_margin=0.01) == {"FINISHED"}
    islands = faces_by_island(suzanne)
    assert len(islands) > 20
    # Without this, and without synchronized selection, Blender's operator sees no islands.
    bpy.ops.uv.select_all(action="SELECT")
    assert bpy.ops.uv.seams_from_islands() == {"FINISHED"}
    bpy.ops.object.mode_set(mode="OBJECT")
    suzanne.data.uv_layers.remove(suzanne.data.uv_layers[0])
    return suzanne, islands


@pytest.mark.parametrize("in_edit_mode", [True, False])
@pytest.mark.parametrize("mode", ["BOUNDARY", "FOLLOW"])
def test_suzanne_with_seams_from_islands_gets_the_same_islands_again(mode, in_edit_mode):
    suzanne, islands = add_suzanne_with_seams_from_islands()
    seams = seams_of(suzanne)
    if in_edit_mode:
        edit(suzanne)
    assert bpy.ops.uv.cone_unwrap(seams=mode, overlaps="KEEP", pack=False) == {"FINISHED"}
    assert faces_by_island(suzanne) == islands
    assert UvMap(suzanne).split_edges() == seams == seams_of(suzanne)


def test_of_suzannes_islands_only_those_that_overlap_themselves_are_split():
    suzanne, islands = add_suzanne_with_seams_from_islands()
    bpy.ops.uv.cone_unwrap(seams="BOUNDARY", overlaps="KEEP", pack=False)
    overlapping = UvMap(suzanne).overlapping()
    assert overlapping
    bpy.ops.uv.cone_unwrap(seams="BOUNDARY", overlaps="SPLIT", pack=False)
    now = faces_by_island(suzanne)
    assert not UvMap(suzanne).overlapping()
    assert islands - now == {island for island in islands if island & overlapping}
    assert all(any(part <= island for island in islands) for part in now)
