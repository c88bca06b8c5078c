# SPDX-License-Identifier: GPL-3.0-or-later
"""Mark Texture Up: edges along which v runs, measured at the UVs of their ends."""

import bmesh
import bpy
import numpy as np
import pytest
from installed import addon
from scenes import add_ball, add_cone_cube, add_cube, add_grid, add_tube, edit, joined
from texture_ways import STORED, way_of

content, identifiers = addon.overlay.content, addon.core.identifiers
unwrap_settings = addon.operators.unwrapping.properties.unwrap_settings
ALONG, UP = identifiers.ALONG_ATTRIBUTE, identifiers.UP_ATTRIBUTE
MET = np.radians(0.01)


def ends_of(obj, edge):
    return np.array([obj.data.vertices[v].co for v in obj.data.edges[edge].vertices])


def upright(obj):
    """The edges that run along z."""
    along = [np.diff(ends_of(obj, edge.index), axis=0)[0] for edge in obj.data.edges]
    return [number for number, way in enumerate(along) if np.abs(way[:2]).max() < 1e-5]


def select_edges(obj, edges):
    bm = bmesh.from_edit_mesh(obj.data)
    bm.edges.ensure_lookup_table()
    for number in edges:
        bm.edges[number].select_set(True)
    bmesh.update_edit_mesh(obj.data)


def mark(obj, edges):
    """With the operator."""
    edit(obj, select="DESELECT")
    select_edges(obj, edges)
    try:
        return bpy.ops.mesh.cone_mark_up()
    finally:
        bpy.ops.object.mode_set(mode="OBJECT")


def set_attribute(obj, edges):
    """As Geometry Nodes or a script would."""
    attribute = obj.data.attributes.new(ALONG, "BOOLEAN", "EDGE")
    attribute.data.foreach_set("value", [edge.index in set(edges) for edge in obj.data.edges])


def marked(obj):
    attribute = obj.data.attributes.get(ALONG)
    return [] if attribute is None else [number for number, item in enumerate(attribute.data) if item.value]


def images(obj, edge):
    """Of an edge in the UVs of each face beside it, from its lower end to its upper one."""
    first, last = obj.data.edges[edge].vertices
    if (obj.matrix_world @ obj.data.vertices[first].co).z > (obj.matrix_world @ obj.data.vertices[last].co).z:
        first, last = last, first
    uv = obj.data.uv_layers.active.uv
    out = []
    for face in obj.data.polygons:
        if {first, last} <= set(face.vertices):
            place = {obj.data.loops[loop].vertex_index: uv[loop].vector for loop in face.loop_indices}
            out.append(complex(*(np.array(place[last], float) - np.array(place[first], float))))
    return np.array(out)


def off(image, rotation_order=1):
    angle, turn = np.angle(image / 1j), 2 * np.pi / rotation_order
    return np.abs(angle - turn * np.round(angle / turn)).max()


@pytest.mark.parametrize("rotation", [(0, 0, 0), (0.4, 1.9, -0.7)])
def test_v_runs_up_along_a_marked_edge(rotation):
    tube = add_tube(taper=0.0)
    tube.rotation_euler = rotation
    bpy.context.view_layer.update()
    edge = upright(tube)[3]
    assert mark(tube, [edge]) == {"FINISHED"}
    assert marked(tube) == [edge] and UP not in tube.data.attributes
    for unwrap in (bpy.ops.uv.cone_auto_unwrap, bpy.ops.uv.cone_unwrap):
        assert unwrap() == {"FINISHED"}
        assert len(images(tube, edge)) == 2 and off(images(tube, edge)) <= MET


def test_an_edge_inside_a_curved_surface_is_met_on_both_sides():
    ball = add_ball()
    assert bpy.ops.uv.cone_auto_unwrap() == {"FINISHED"}
    sloping = [e.index for e in ball.data.edges if abs(np.diff(ends_of(ball, e.index), axis=0)[0, 2]) > 0.05]
    uncut = [e for e in sloping if np.ptp(images(ball, e)) < 1e-6]
    set_attribute(ball, uncut[len(uncut) // 2 :][:1])
    assert bpy.ops.uv.cone_auto_unwrap() == {"FINISHED"}
    image = images(ball, marked(ball)[0])
    assert len(image) == 2 and off(image) <= MET
    assert bpy.ops.uv.cone_auto_unwrap(direction="X") == {"FINISHED"}
    assert off(images(ball, marked(ball)[0])) > MET


def test_marks_survive_edits_of_the_mesh():
    tube = add_tube(taper=0.0)
    edge = upright(tube)[3]
    mark(tube, [edge])
    edit(tube)
    bpy.ops.mesh.subdivide(number_cuts=2)
    bpy.ops.object.mode_set(mode="OBJECT")
    parts = marked(tube)
    assert len(parts) == 3 and set(parts) <= set(upright(tube))
    assert bpy.ops.uv.cone_auto_unwrap() == {"FINISHED"}
    assert max(off(images(tube, part)) for part in parts) <= MET


def test_tiles_follow_a_marked_edge_up_to_quarter_turns():
    cube = add_cone_cube()
    cube.rotation_euler = (0.3, 0.2, 0.1)
    bpy.context.view_layer.update()
    diagonal = next(e.index for e in cube.data.edges if np.ptp(ends_of(cube, e.index), axis=0).max() > 0)
    set_attribute(cube, [diagonal])
    assert bpy.ops.uv.cone_unwrap(seamless=True) == {"FINISHED"}
    assert off(images(cube, diagonal), 4) <= np.radians(1)


def test_drawn_directions_take_precedence_on_their_faces():
    grid = add_grid()
    edge = next(e.index for e in grid.data.edges if np.ptp(ends_of(grid, e.index), axis=0)[0] < 1e-6)
    way = np.array([1.0, 0.4, 0.0])
    beside = [f.index for f in grid.data.polygons if set(grid.data.edges[edge].vertices) <= set(f.vertices)]
    set_attribute(grid, [edge])
    attribute = grid.data.attributes.new(UP, "FLOAT_VECTOR", "FACE")
    for face in beside:
        attribute.data[face].vector = way / np.linalg.norm(way)
    assert bpy.ops.uv.cone_auto_unwrap(straighten=False) == {"FINISHED"}
    assert off(way_of(grid, way)) <= STORED
    report = addon.mesh.reports.find(grid.data)
    assert report.drawn == sorted(beside)
    assert content.build_content(grid, report).missed_by == []


def test_marking_and_clearing():
    cube = add_cube(cuts=2)
    edges = upright(cube)
    assert mark(cube, edges[:2]) == {"FINISHED"} and mark(cube, edges[1:3]) == {"FINISHED"}
    assert marked(cube) == edges[:3]
    attribute = cube.data.attributes.new(UP, "FLOAT_VECTOR", "FACE")
    attribute.data[0].vector = (0, 0, 1)
    edit(cube, select="DESELECT")
    select_edges(cube, edges[:1])
    assert bpy.ops.mesh.cone_mark_up(clear=True) == {"FINISHED"}
    bpy.ops.object.mode_set(mode="OBJECT")
    assert marked(cube) == edges[1:3] and UP in cube.data.attributes
    edit(cube)
    bpy.ops.mesh.select_all(action="SELECT")
    assert bpy.ops.mesh.cone_mark_up(clear=True) == {"FINISHED"}
    with pytest.raises(RuntimeError, match="Nothing selected has a direction"):
        bpy.ops.mesh.cone_mark_up(clear=True)
    bpy.ops.mesh.select_all(action="DESELECT")
    with pytest.raises(RuntimeError, match="No edge with a face is selected"):
        bpy.ops.mesh.cone_mark_up()
    bpy.ops.object.mode_set(mode="OBJECT")
    assert ALONG not in cube.data.attributes and UP not in cube.data.attributes


def test_the_attribute_of_another_kind_is_left_alone():
    tube = add_tube(taper=0.0)
    tube.data.attributes.new(ALONG, "FLOAT", "POINT")
    with pytest.raises(RuntimeError, match="not a boolean attribute on edges"):
        mark(tube, upright(tube)[:1])
    assert bpy.ops.uv.cone_auto_unwrap() == {"FINISHED"}


@pytest.mark.parametrize("in_edit_mode", [True, False])
def test_arrows_run_up_along_marked_edges(in_edit_mode):
    tube = add_tube(taper=0.0)
    tube.rotation_euler = (np.pi, 0, 0)
    bpy.context.view_layer.update()
    edge = upright(tube)[3]
    mark(tube, [edge])
    if in_edit_mode:
        edit(tube)
    shown = content.build_content(tube, None).along_lines
    assert len(shown) == 3
    # Upside down.
    assert shown[0, 1, 2] < shown[0, 0, 2]
    np.testing.assert_allclose(shown[0].mean(axis=0), ends_of(tube, edge).mean(axis=0), atol=1e-6)


def test_what_the_map_misses_is_told_at_each_edge():
    ball = add_ball()
    edges = [e.index for e in ball.data.edges if abs(np.diff(ends_of(ball, e.index), axis=0)[0, 2]) > 0.05][::7]
    set_attribute(ball, edges)
    assert bpy.ops.uv.cone_unwrap() == {"FINISHED"}
    report = addon.mesh.reports.find(ball.data)
    shown = content.build_content(ball, report)
    told = {tuple(np.round(place, 4)): error for place, error in zip(shown.missed_places, shown.missed_by, strict=True)}
    assert len(told) > 10
    faces = [
        {f.index for f in ball.data.polygons if set(ball.data.edges[e].vertices) <= set(f.vertices)} for e in edges
    ]
    for edge, beside in zip(edges, faces, strict=True):
        # Those beside a face with two marked edges have a direction in between there.
        if not any(beside & others for others in faces if others is not beside):
            error = off(images(ball, edge))
            found = told.get(tuple(np.round(ends_of(ball, edge).mean(axis=0).astype(np.float32), 4)), 0.0)
            assert found == pytest.approx(error if error > content.NOTICEABLE else 0.0, abs=1e-3)
    for mark_of_all in (False, True):
        ball.data.attributes[ALONG].data.foreach_set("value", [mark_of_all] * len(ball.data.edges))
        assert bool(content.build_content(ball, report).missed_by) == mark_of_all


def test_cones_of_one_of_two_parts_are_edited_under_directions():
    tube = joined(add_tube(taper=0.0), add_ball())
    edge = upright(tube)[3]
    set_attribute(tube, [edge])
    tube.data.attributes.new("uv_cone_feature", "BOOLEAN", "EDGE").data[edge].value = True
    edit(tube)
    chosen = bpy.context.window_manager.operator_properties_last(identifiers.UNWRAP)
    session = addon.jobs.sessions.cone_session.ConeSession(tube, unwrap_settings(chosen))
    for vertex in (len(tube.data.vertices) - 1, tube.data.edges[edge].vertices[0]):
        session.cones.add(vertex)
        step = session.draft()
        unwrapped = step.solve()
        # The ball alone, and then both.
        has_direction = np.isfinite(unwrapped.result.direction_errors).any()
        assert has_direction == (vertex != len(tube.data.vertices) - 1)
        session.show(step, unwrapped)
    session.restore()


def test_clearing_cone_data_removes_marks():
    tube = add_tube()
    set_attribute(tube, [0])
    edit(tube)
    assert bpy.ops.mesh.cone_clear_data() == {"FINISHED"}
    bpy.ops.object.mode_set(mode="OBJECT")
    assert ALONG not in tube.data.attributes
