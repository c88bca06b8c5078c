# SPDX-License-Identifier: GPL-3.0-or-later
"""Select Reported Elements: selects the elements that errors and warnings name."""

import bmesh
import bpy
import numpy as np
import pytest
from logged import refused
from scenes import (
    add_cone_cube,
    add_grid,
    add_object,
    add_sphere,
    changed,
    corners,
    edges_where,
    edit,
    mark,
    mark_seams,
    select_elements,
    selected,
    snapshot,
)

MODES = {"verts": (True, False, False), "edges": (False, True, False), "faces": (False, False, True)}


def selected_faces(obj):
    return [face.index for face in bmesh.from_edit_mesh(obj.data).faces if face.select]


def selected_edges(obj):
    return {tuple(sorted(v.index for v in e.verts)) for e in bmesh.from_edit_mesh(obj.data).edges if e.select}


def select_mode():
    return tuple(bpy.context.tool_settings.mesh_select_mode)


def test_vertices_of_a_refusal_are_selected_and_the_refusal_itself_selects_nothing():
    cube = add_cone_cube()
    broken = corners(cube)[3]
    edit(cube)
    bmesh.from_edit_mesh(cube.data).verts.ensure_lookup_table()
    bmesh.from_edit_mesh(cube.data).verts[broken].co.x = float("nan")
    before = snapshot(cube)
    with refused("NON_FINITE_POSITION"):
        bpy.ops.uv.cone_unwrap()
    assert changed(before, snapshot(cube)) == set()
    bpy.context.tool_settings.mesh_select_mode = MODES["faces"]
    assert bpy.ops.mesh.cone_select_reported() == {"FINISHED"}
    assert select_mode() == MODES["verts"]
    assert selected(cube) == [broken]


def test_faces_of_a_part_that_was_left_out_are_selected(reports):
    cube = add_cone_cube("Parts")
    count = len(cube.data.polygons)
    add_sphere("Sphere")
    bpy.context.view_layer.objects.active = cube
    bpy.ops.object.join()
    bpy.ops.uv.cone_unwrap()
    edit(cube, select="DESELECT")
    reports()
    assert bpy.ops.mesh.cone_select_reported() == {"FINISHED"}
    assert select_mode() == MODES["faces"]
    assert selected_faces(cube) == list(range(count, len(cube.data.polygons)))
    assert f"Selected {len(cube.data.polygons) - count} reported elements" in reports()


def test_edges_with_too_many_faces_are_selected():
    def build(bm):
        bmesh.ops.create_grid(bm, x_segments=3, y_segments=3, size=1.0)
        bm.edges.ensure_lookup_table()
        edge = next(edge for edge in bm.edges if len(edge.link_faces) == 2)
        bm.faces.new([*edge.verts, bm.verts.new((0.0, 0.0, 1.0))])
        bm.loops.layers.uv.new("UVMap")

    fins = add_object("Fins", build)
    faces = [list(face.vertices) for face in fins.data.polygons]
    wrong = {
        tuple(sorted(edge.vertices))
        for edge in fins.data.edges
        if sum(set(edge.vertices) <= set(face) for face in faces) == 3
    }
    assert len(wrong) == 1
    edit(fins)
    assert bpy.ops.uv.cone_unwrap() == {"FINISHED"}
    assert bpy.ops.mesh.cone_select_reported() == {"FINISHED"}
    assert wrong <= selected_edges(fins)


def test_two_objects_are_each_shown_their_own():
    first, second, fine = add_cone_cube("First"), add_cone_cube("Second"), add_cone_cube("Fine")
    broken = corners(first)[0], corners(second)[5]
    for obj, corner in zip((first, second), broken, strict=True):
        obj.data.vertices[corner].co.y = float("nan")
    edit(first, second, fine)
    assert bpy.ops.uv.cone_unwrap() == {"FINISHED"}
    assert bpy.ops.mesh.cone_select_reported() == {"FINISHED"}
    assert [selected(obj) for obj in (first, second, fine)] == [[broken[0]], [broken[1]], []]


def test_extend_keeps_what_is_selected():
    cube = add_cone_cube()
    broken = corners(cube)[0]
    cube.data.vertices[broken].co.x = float("nan")
    edit(cube)
    with pytest.raises(RuntimeError):
        bpy.ops.uv.cone_unwrap()
    other = corners(cube)[6]
    select_elements(cube, "verts", [other])
    bpy.ops.mesh.cone_select_reported(extend=True)
    assert selected(cube) == sorted([broken, other])
    bpy.ops.mesh.cone_select_reported()
    assert selected(cube) == [broken]


def test_hidden_elements_stay_hidden_and_are_counted(reports):
    cube = add_cone_cube()
    broken = corners(cube)[:2]
    for vertex in broken:
        cube.data.vertices[vertex].co.x = float("nan")
    edit(cube)
    with pytest.raises(RuntimeError):
        bpy.ops.uv.cone_unwrap()
    select_elements(cube, "verts", broken[:1])
    bpy.ops.mesh.hide()
    reports()
    assert bpy.ops.mesh.cone_select_reported() == {"FINISHED"}
    assert selected(cube) == broken[1:]
    assert "Selected 1 reported element; 1 more hidden" in reports()


def test_success_forgets_and_other_meshes_are_not_mistaken(reports):
    cube = add_cone_cube()
    broken = cube.data.vertices[corners(cube)[0]]
    place = broken.co.copy()
    broken.co.x = float("nan")
    with pytest.raises(RuntimeError):
        bpy.ops.uv.cone_unwrap()
    edit(cube)
    bm = bmesh.from_edit_mesh(cube.data)
    loose = bm.verts.new((9.0, 9.0, 9.0))
    bmesh.update_edit_mesh(cube.data)
    reports()
    assert bpy.ops.mesh.cone_select_reported() == {"CANCELLED"}
    assert "Cube has changed since" in reports()
    bm.verts.remove(loose)
    bmesh.update_edit_mesh(cube.data)
    assert bpy.ops.mesh.cone_select_reported() == {"FINISHED"}
    bm.verts.ensure_lookup_table()
    bm.verts[selected(cube)[0]].co = place
    bpy.ops.mesh.select_all(action="SELECT")
    assert bpy.ops.uv.cone_unwrap() == {"FINISHED"}
    before = snapshot(cube)
    reports()
    assert bpy.ops.mesh.cone_select_reported() == {"CANCELLED"}
    assert "Nothing was reported" in reports()
    assert changed(before, snapshot(cube)) == set()


def test_refused_placement_of_cones_can_be_shown_too():
    sphere = add_sphere()
    sphere.data.vertices[5].co.z = float("nan")
    edit(sphere)
    with pytest.raises(RuntimeError, match="Sphere: "):
        bpy.ops.mesh.cone_place()
    assert bpy.ops.mesh.cone_select_reported() == {"FINISHED"}
    assert selected(sphere) == [5]


def test_opened_seams_are_shown_as_faces():
    sphere = add_sphere()
    mark_seams(sphere, edges_where(sphere, lambda place: abs(place[2]) < 1e-6))
    edit(sphere)
    assert bpy.ops.uv.cone_unwrap() == {"FINISHED"}
    assert bpy.ops.mesh.cone_select_reported() == {"FINISHED"}
    assert selected_faces(sphere) == list(range(len(sphere.data.polygons)))


def test_poll_asks_for_edit_mode():
    add_grid()
    with pytest.raises(RuntimeError, match="Enter edit mode"):
        bpy.ops.mesh.cone_select_reported()


def test_conflicting_pins_are_shown():
    grid = add_grid()
    mark(grid, [])
    layer = grid.data.attributes.new(".pn.UVMap", "BOOLEAN", "CORNER")
    vertices = [0, 24]
    for vertex in vertices:
        loop = next(loop.index for loop in grid.data.loops if loop.vertex_index == vertex)
        layer.data[loop].value = True
    grid.data.uv_layers.active.uv.foreach_set("vector", np.zeros(2 * len(grid.data.loops), np.float32))
    edit(grid)
    with refused("PINS_CONFLICT"):
        bpy.ops.uv.cone_unwrap()
    bpy.ops.mesh.cone_select_reported()
    assert selected(grid) == vertices


def test_what_was_reported_on_a_mesh_is_shown_on_every_object_that_has_it():
    cube = add_cone_cube()
    broken = corners(cube)[2]
    cube.data.vertices[broken].co.x = float("nan")
    with pytest.raises(RuntimeError):
        bpy.ops.uv.cone_unwrap()
    twin = bpy.data.objects.new("Twin", cube.data)
    bpy.context.collection.objects.link(twin)
    edit(twin)
    assert bpy.ops.mesh.cone_select_reported() == {"FINISHED"}
    assert selected(twin) == [broken]
