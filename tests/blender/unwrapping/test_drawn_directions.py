# SPDX-License-Identifier: GPL-3.0-or-later
"""Draw Texture Up: what strokes store on a mesh, and how unwrapping uses it."""

import bmesh
import bpy
import numpy as np
import pytest
from installed import addon
from scenes import UvMap, add_ball, add_cone_cube, add_grid, add_tube, changed, edit, snapshot
from texture_ways import STORED, off, way_of

drawn_on, picked_objects = addon.jobs.sessions.drawn_on, addon.jobs.sessions.picked_objects
content, reader, screens = addon.overlay.content, addon.mesh.reader, addon.core.screen
Refused, UP = addon.core.errors.Refused, addon.core.identifiers.UP_ATTRIBUTE
SIZE = 400


def from_above(half=1.5):
    """A parallel view down the z axis, of the world from -half to half."""
    matrix = np.diag([1 / half, 1 / half, -0.1, 1.0])

    def screen_of(obj):
        return screens.Screen(matrix @ np.array(obj.matrix_world), SIZE, SIZE)

    return picked_objects.Sight(screen_of)


def pixel(x, y, half=1.5):
    return (x / half + 1) * SIZE / 2, (y / half + 1) * SIZE / 2


def draw(objects, *strokes, erases=False):
    """Strokes from above, each through places (x, y)."""
    tool = drawn_on.DrawnObjects(objects)
    for first, *others in strokes:
        tool.begin_stroke(from_above(), pixel(*first), erases=erases)
        for place in others:
            tool.draw_to(from_above(), pixel(*place))
    return tool


def stored(obj):
    """(f, 3) of the mesh in object mode; None without the attribute."""
    with reader.readable_mesh(obj) as mesh:
        attribute = mesh.attributes.get(UP)
        if attribute is None:
            return None
        values = np.empty((len(mesh.polygons), 3), np.float32)
        attribute.data.foreach_get("vector", values.ravel())
        return values


def keep(tool):
    tool.store()
    tool.end()
    bpy.ops.object.mode_set(mode="OBJECT")


def along(angle):
    return np.array([np.cos(angle), np.sin(angle), 0])


@pytest.mark.parametrize("angle", [0.3, 2.0, -1.1])
def test_v_runs_along_a_stroke_on_an_island(angle):
    grid = add_grid()
    edit(grid)
    way = along(angle)
    keep(draw([grid], [-0.5 * way[:2], 0.5 * way[:2]]))
    assert bpy.ops.uv.cone_auto_unwrap(straighten=False) == {"FINISHED"}
    assert off(way_of(grid, way)) <= STORED
    # The choice of another direction takes precedence.
    assert bpy.ops.uv.cone_auto_unwrap(direction="Y") == {"FINISHED"}
    assert off(way_of(grid, (0, 1, 0))) <= STORED


def test_faces_have_the_direction_in_which_a_stroke_crosses_them():
    grid = add_grid()
    edit(grid)
    keep(draw([grid], [(-0.9, -0.6), (0.6, 0.9)]))
    vectors = stored(grid)
    drawn = vectors.any(axis=1)
    assert np.allclose(vectors[drawn], along(np.pi / 4), atol=1e-5)
    centers = np.array([face.center for face in grid.data.polygons])
    away = np.abs(centers[:, 1] - centers[:, 0] - 0.3)
    assert drawn[away < 1e-3].all() and not drawn[away > 1.0].any()


def test_a_later_stroke_replaces_an_earlier_one_where_it_crosses_it():
    grid = add_grid()
    edit(grid)
    keep(draw([grid], [(-0.9, 0.01), (0.9, 0.01)], [(0.01, -0.9), (0.01, 0.9)]))
    vectors = stored(grid)
    centers = np.array([face.center for face in grid.data.polygons])
    at = np.linalg.norm(centers[:, :2] - 0.01, axis=1).argmin()
    assert np.allclose(vectors[at], (0, 1, 0), atol=1e-5)


def test_strokes_do_not_jump_from_one_part_to_another():
    grid = add_grid()
    below = add_grid()
    below.location = (0.5, 0, -2)
    bpy.context.view_layer.update()
    for obj in (grid, below):
        obj.select_set(True)
    bpy.ops.object.mode_set(mode="EDIT")
    tool = draw([grid, below], [(0.0, 0.0), (1.4, 0.0)])
    for edited in tool.begun:
        vectors = np.array(list(edited.session.directions.values()))
        assert len(vectors) and np.allclose(vectors, (1, 0, 0), atol=1e-5)
    tool.end()


def test_erasing_undoing_and_escaping():
    grid = add_grid()
    edit(grid)
    before = snapshot(grid)
    tool = draw([grid], [(-0.5, 0.1), (0.5, 0.1)])
    session = tool.begun[0].session
    first = dict(session.directions)
    tool.begin_stroke(from_above(), pixel(-0.5, 0.1), erases=True)
    tool.draw_to(from_above(), pixel(0.5, 0.1))
    assert not session.directions
    assert tool.history.undo() and session.directions == first
    assert tool.history.redo() and not session.directions
    assert tool.history.undo() and tool.history.undo() and not tool.changed
    tool.restore()
    tool.end()
    assert changed(before, snapshot(grid)) == set() and stored(grid) is None


def test_a_mesh_that_changed_meanwhile_is_not_written_to():
    grid = add_grid()
    edit(grid)
    tool = draw([grid], [(-0.5, 0), (0.5, 0)])
    assert tool.is_intact()
    tool.doubt()
    assert tool.is_intact()
    bpy.ops.mesh.subdivide()
    tool.doubt()
    assert not tool.is_intact()
    tool.end()


def test_the_stretch_of_an_object_counts():
    grid = add_grid()
    grid.scale = (3, 1, 1)
    bpy.context.view_layer.update()
    edit(grid)
    way = np.array([1.0, 0.5, 0])  # in the world
    tool = drawn_on.DrawnObjects([grid])
    tool.begin_stroke(from_above(4), pixel(*(-0.8 * way[:2]), 4), erases=False)
    tool.draw_to(from_above(4), pixel(*(0.8 * way[:2]), 4))
    keep(tool)
    assert bpy.ops.uv.cone_auto_unwrap(straighten=False) == {"FINISHED"}
    image = way_of(grid, way)
    # The shape of the object in the world is what is unwrapped, so that its angles are those of the map.
    assert off(image) <= STORED


def test_packing_does_not_rotate_what_follows_strokes():
    tubes = [add_tube(taper=0.0) for _ in range(3)]
    for i, tube in enumerate(tubes):
        tube.location.x = 4 * i
        tube.select_set(True)
    edit(tubes[0], select="DESELECT")
    bm = bmesh.from_edit_mesh(tubes[0].data)
    next(edge for edge in bm.edges if edge.verts[0].co.xy == edge.verts[1].co.xy).select_set(True)
    bmesh.update_edit_mesh(tubes[0].data)
    assert bpy.ops.mesh.cone_mark_up() == {"FINISHED"}
    bpy.ops.object.mode_set(mode="OBJECT")
    for tube in tubes:
        tube.select_set(True)
    assert bpy.ops.uv.cone_auto_unwrap(compact=False) == {"FINISHED"}
    assert off(way_of(tubes[0], (0, 0, 1))) <= STORED


def test_tiles_follow_a_stroke_up_to_quarter_turns():
    cube = add_cone_cube()
    edit(cube)
    keep(draw([cube], [(-0.4, -0.4), (0.4, 0.4)]))
    assert bpy.ops.uv.cone_unwrap(seamless=True) == {"FINISHED"}
    top = np.array([face.normal.z > 0.9 for face in cube.data.polygons])
    assert off(way_of(cube, along(np.pi / 4))[top], 4) <= np.radians(1)
    assert UvMap(cube).tile_error() == 0


def test_the_attribute_of_another_kind_is_left_alone():
    grid = add_grid()
    grid.data.attributes.new(UP, "FLOAT", "POINT")
    edit(grid)
    with pytest.raises(Refused, match="not a vector attribute on faces"):
        drawn_on.DrawnObjects([grid])
    bpy.ops.object.mode_set(mode="OBJECT")
    assert bpy.ops.uv.cone_auto_unwrap() == {"FINISHED"}


@pytest.mark.parametrize("in_edit_mode", [True, False])
def test_clearing_cone_data_removes_directions(in_edit_mode):
    grid = add_grid()
    edit(grid)
    keep(draw([grid], [(-0.5, 0), (0.5, 0)]))
    if in_edit_mode:
        edit(grid)
    assert bpy.ops.mesh.cone_clear_data() == {"FINISHED"}
    assert stored(grid) is None


def drawn_around(obj):
    """Directions on all faces, in circles, which no island of a closed mesh can meet; as they are stored."""
    up = np.array([np.cross(face.center, [0.2, 0.1, 1.0]) for face in obj.data.polygons], np.float32)
    up /= np.linalg.norm(up, axis=1, keepdims=True)
    obj.data.attributes.new(UP, "FLOAT_VECTOR", "FACE").data.foreach_set("vector", up.ravel())
    return up


@pytest.mark.slow
@pytest.mark.one_blender
@pytest.mark.parametrize("seamless", [False, True])
def test_what_the_map_misses_is_told_at_each_face(seamless):
    ball = add_ball()
    up = drawn_around(ball)
    assert bpy.ops.uv.cone_unwrap(seamless=seamless) == {"FINISHED"}
    shown = content.build_content(ball, addon.mesh.reports.find(ball.data))
    report = addon.mesh.reports.find(ball.data)
    assert report.drawn == list(range(len(up)))
    order = 4 if seamless else 1
    expected = [off(way_of(ball, direction.astype(float))[[face]], order) for face, direction in enumerate(up)]
    # Faces are not flat, so that their triangles differ.
    assert np.abs(np.array(report.drawn_errors) - expected).mean() < np.radians(5)
    missed = [face for face, error in enumerate(report.drawn_errors) if error > np.radians(0.05)]
    assert shown.missed_by == [report.drawn_errors[face] for face in missed] and len(missed) > 50
    np.testing.assert_allclose(shown.missed_places, [ball.data.polygons[f].center for f in missed], atol=0.05)
    rows = {label: value for label, value, _ in addon.ui.tables.quality_rows(report)}
    assert rows["Texture Up, Largest Error"] == f"{np.degrees(max(report.drawn_errors)):.2f}°"


def test_nothing_is_told_of_strokes_that_are_met_or_were_not_followed():
    grid = add_grid()
    edit(grid)
    keep(draw([grid], ((-0.5, -0.5), (-0.3, 0.4))))
    assert bpy.ops.uv.cone_unwrap() == {"FINISHED"}
    report = addon.mesh.reports.find(grid.data)
    assert report.drawn and content.build_content(grid, report).missed_by == []
    ball = add_ball()
    drawn_around(ball)
    assert bpy.ops.uv.cone_unwrap(direction="Z") == {"FINISHED"}
    assert addon.mesh.reports.find(ball.data).drawn == []


def test_arrows_lie_on_their_faces_and_axes_show_the_map():
    grid = add_grid()
    edit(grid)
    tool = draw([grid], [(-0.5, 0.01), (0.5, 0.01)])
    session = tool.begun[0].session
    shown = content.with_directions(content.Content(), session.mesh, session.directions).up_lines
    assert len(shown) == 3 * len(session.directions) and np.abs(shown[:, :, 2]).max() < 1e-6
    shafts = shown[::3, 1] - shown[::3, 0]
    assert (shafts[:, 0] > 0).all() and np.abs(shafts[:, 1]).max() < 1e-5
    keep(tool)
    assert bpy.ops.uv.cone_auto_unwrap() == {"FINISHED"}
    u, v = (lines[:, 1] - lines[:, 0] for lines in content.texture_axes(reader.reader(grid.data)))
    # v runs along the stroke, u to its right; an isometric map has axes of one length.
    assert np.allclose(v / np.linalg.norm(v, axis=1)[:, None], (1, 0, 0), atol=1e-3)
    assert np.allclose(u, np.c_[v[:, 1], -v[:, 0], v[:, 2]], atol=1e-3 * np.abs(v).max())


def test_axes_of_large_meshes_are_drawn_on_some_faces():
    ball = add_ball(cuts=13)
    assert len(ball.data.polygons) > content.MOST_AXES
    assert bpy.ops.uv.cone_unwrap() == {"FINISHED"}
    u, v = content.texture_axes(reader.reader(ball.data))
    assert len(u) == len(v) and content.MOST_AXES / 2 <= len(u) <= content.MOST_AXES
