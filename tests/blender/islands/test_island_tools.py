# SPDX-License-Identifier: GPL-3.0-or-later
"""Tools on selected islands: straight, rectangular, on a grid, upright, aligned, joined, ripped."""

import bmesh
import bpy
import numpy as np
import pytest
from installed import addon
from mathutils import Matrix
from scenes import (
    UV_ROUNDING,
    UvMap,
    add_cube,
    add_grid,
    add_texture,
    add_tube,
    changed,
    edit,
    select_elements,
    set_uv,
    snapshot,
    uv_key,
)

reports = addon.mesh.reports


def bent_grid(name="Grid", segments=6):
    """Quads that are wavy on the surface and in the map, which is their image seen from above, a bit turned."""
    grid = add_grid(name, segments)
    for vertex in grid.data.vertices:
        x, y, _ = vertex.co
        vertex.co = (x + 0.1 * np.sin(3 * y), y + 0.15 * np.sin(2 * x), 0.2 * np.cos(2 * x))
    places = np.array([vertex.co[:2] for vertex in grid.data.vertices])
    turn = np.array([[np.cos(0.3), np.sin(0.3)], [-np.sin(0.3), np.cos(0.3)]])
    set_uv(grid, (places @ turn / 4 + 0.5)[[loop.vertex_index for loop in grid.data.loops]])
    return grid


def row_of(grid, segments=6, row=2):
    return range(row * segments, (row + 1) * segments)


def pin(obj, vertices):
    name = f".pn.{obj.data.uv_layers.active.name}"
    attributes = obj.data.attributes
    pinned = attributes.get(name) or attributes.new(name, "BOOLEAN", "CORNER")
    for loop in obj.data.loops:
        if loop.vertex_index in vertices:
            pinned.data[loop.index].value = True


def face_uv(obj, faces):
    uv_map = UvMap(obj)
    return uv_map.uv[[loop for face in faces for loop in uv_map.loops_of_face[face]]]


def lines(values):
    """How many different numbers there are but for rounding."""
    return len(np.unique(np.round(np.asarray(values) / (4 * UV_ROUNDING))))


def edit_off():
    if bpy.context.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")


def undone(names, run):
    """Whether an operator that changes objects is undone and redone exactly."""

    def state():
        return {(name, key): value for name in names for key, value in snapshot(bpy.data.objects[name]).items()}

    bpy.ops.ed.undo_push(message="before")
    before = state()
    assert run("EXEC_DEFAULT", True) == {"FINISHED"}
    after = state()
    assert changed(before, after)
    bpy.ops.ed.undo()
    assert changed(before, state()) == set()
    bpy.ops.ed.redo()
    return changed(after, state()) == set()


def selected(obj, faces):
    edit_off()
    edit(obj, select="DESELECT")
    select_elements(obj, "faces", faces)


def test_straighten_makes_a_straight_strip_and_the_rest_follows():
    grid = bent_grid()
    row = row_of(grid)
    selected(grid, row)
    before = snapshot(grid)
    assert bpy.ops.uv.cone_straighten() == {"FINISHED"}
    strip = face_uv(grid, row)
    assert sorted(lines(strip[:, axis]) for axis in range(2)) == [2, 7]
    assert UvMap(grid).islands() == 1
    assert changed(before, snapshot(grid)) <= {uv_key()}


def test_straighten_refuses_what_is_no_row_and_changes_nothing():
    grid = bent_grid()
    selected(grid, range(36))
    before = snapshot(grid)
    with pytest.raises(RuntimeError, match="single row"):
        bpy.ops.uv.cone_straighten()
    assert changed(before, snapshot(grid)) == set()


@pytest.mark.parametrize("spacing", ["MESH", "EVEN"])
def test_grid_has_as_many_lines_as_rows_and_columns(spacing):
    grid = bent_grid()
    selected(grid, range(36))
    assert bpy.ops.uv.cone_grid(spacing=spacing) == {"FINISHED"}
    uv = UvMap(grid).uv
    assert [lines(uv[:, axis]) for axis in range(2)] == [7, 7]
    steps = [np.diff(np.unique(np.round(uv[:, axis], 5))) for axis in range(2)]
    assert (max(np.ptp(step) for step in steps) < 1e-4) == (spacing == "EVEN")


def test_rectify_finds_four_corners_or_takes_the_selected_ones():
    grid = bent_grid()
    selected(grid, range(36))
    assert bpy.ops.uv.cone_rectify() == {"FINISHED"}
    uv = UvMap(grid).uv
    low, high = uv.min(axis=0), uv.max(axis=0)
    found = {v for v, place in zip(UvMap(grid).vertex, uv, strict=True) if all(np.isclose(place, low, atol=1e-6))}
    assert len(found) == 1
    # Vertices 0 to 6 are the lower side: a corner in the middle of it.
    corners = [3, 6, 48, 42]
    edit_off()
    edit(grid, select="DESELECT")
    bpy.context.tool_settings.mesh_select_mode = (True, False, False)
    select_elements(grid, "verts", corners)
    assert bpy.ops.uv.cone_rectify() == {"FINISHED"}
    uv_map = UvMap(grid)
    low, high = uv_map.uv.min(axis=0), uv_map.uv.max(axis=0)
    for corner in corners:
        place = uv_map.uv[np.flatnonzero(uv_map.vertex == corner)[0]]
        assert np.minimum(abs(place - low), abs(place - high)).max() < 1e-6
    select_elements(grid, "verts", [20])
    bpy.ops.mesh.select_all(action="DESELECT")
    with pytest.raises(RuntimeError, match="Nothing is selected"):
        bpy.ops.uv.cone_rectify()


def test_rectangles_are_those_of_an_image_that_is_not_square():
    grid = bent_grid()
    add_texture(grid, 64, 32)
    flat = add_grid("Flat")
    add_texture(flat, 64, 32)
    places = np.array([vertex.co[:2] for vertex in flat.data.vertices])
    set_uv(flat, (places * (0.125, 0.25) + 0.5)[[loop.vertex_index for loop in flat.data.loops]])
    selected(flat, range(36))
    assert bpy.ops.uv.cone_grid(spacing="MESH") == {"FINISHED"}
    np.testing.assert_allclose(np.ptp(UvMap(flat).uv, axis=0), (0.25, 0.5), rtol=1e-5)


def test_pinned_vertex_stays_and_two_that_do_not_fit_are_refused():
    grid = bent_grid()
    pin(grid, {0})
    before = face_uv(grid, [0])[0]
    selected(grid, range(36))
    assert bpy.ops.uv.cone_grid() == {"FINISHED"}
    assert any(np.array_equal(place, before) for place in face_uv(grid, [0]))
    edit_off()
    pin(grid, {0, 25})
    set_uv(grid, UvMap(grid).uv + np.random.default_rng(1).uniform(0, 0.01, UvMap(grid).uv.shape))
    for vertex in range(49):
        at = UvMap(grid).vertex == vertex
        uv = UvMap(grid).uv
        uv[at] = uv[at][0]
        set_uv(grid, uv)
    selected(grid, range(36))
    with pytest.raises(RuntimeError, match="Unpin"):
        bpy.ops.uv.cone_grid()


def test_texture_that_no_longer_continues_is_told(capfd):
    tube = add_tube()
    bpy.ops.uv.cone_unwrap()
    assert UvMap(tube).split_edges()
    report = reports.find(tube.data)
    assert report.seams["sister_ratio_max"] < 1 + 1e-4
    selected(tube, range(16, 32))
    capfd.readouterr()
    assert bpy.ops.uv.cone_grid() == {"FINISHED"}
    assert "no longer continues" in capfd.readouterr().out
    after = reports.find(tube.data)
    assert after.seams["sister_ratio_max"] > 1 + 1e-4
    assert not after.overlaps_known


def unwrapped_cube():
    cube = add_cube(cuts=2)
    bpy.ops.uv.cone_auto_unwrap(preset="BAKE")
    return cube


def up_in_map(obj, face):
    """How the world's z runs in the map on a face beside it, of length 1."""
    uv_map = UvMap(obj)
    loops = uv_map.loops_of_face[face]
    places = uv_map.positions[uv_map.vertex[loops]] @ np.array(obj.matrix_world.to_3x3()).T
    design = np.c_[places - places.mean(axis=0)]
    gradient, *_ = np.linalg.lstsq(design, uv_map.uv[loops] - uv_map.uv[loops].mean(axis=0), rcond=None)
    along = np.array([0, 0, 1]) @ gradient
    return along / np.linalg.norm(along)


@pytest.mark.parametrize("by", ["MODEL", "WORLD"])
def test_orient_turns_islands_upright(by):
    grid = bent_grid()
    grid.matrix_world = Matrix.Rotation(np.pi / 2, 4, "X") if by == "WORLD" else Matrix.Identity(4)
    if by == "MODEL":
        grid.data.transform(Matrix.Rotation(np.pi / 2, 4, "X"))
    bpy.context.view_layer.update()
    selected(grid, range(36))
    assert bpy.ops.uv.cone_orient(by=by) == {"FINISHED"}
    mean = np.mean([up_in_map(grid, face) for face in range(36)], axis=0)
    assert abs(mean[0]) < 0.1
    assert mean[1] > 0.5


def test_orient_by_the_active_edge_makes_it_upright():
    grid = bent_grid()
    edit(grid, select="DESELECT")
    bm = bmesh.from_edit_mesh(grid.data)
    bm.edges.ensure_lookup_table()
    for face in bm.faces:
        face.select_set(True)
    edge = bm.faces[:][0].edges[0]
    bm.select_history.clear()
    bm.select_history.add(edge)
    ends = [vertex.index for vertex in edge.verts]
    bmesh.update_edit_mesh(grid.data)
    assert bpy.ops.uv.cone_orient(by="EDGE") == {"FINISHED"}
    uv_map = UvMap(grid)
    first, second = (uv_map.uv[np.flatnonzero(uv_map.vertex == end)[0]] for end in ends)
    assert abs((second - first)[0]) < 4 * UV_ROUNDING


def test_orient_leaves_pinned_islands_and_says_when_all_are():
    grid = bent_grid()
    pin(grid, {0})
    selected(grid, range(36))
    with pytest.raises(RuntimeError, match="unpin"):
        bpy.ops.uv.cone_orient()


def test_seamless_islands_are_turned_so_that_tiles_match():
    cube = add_cube(cuts=2)
    bpy.ops.uv.cone_auto_unwrap(preset="TILE")
    assert UvMap(cube).tile_error() == 0
    edit(cube)
    for by in ("WORLD", "MODEL"):
        assert bpy.ops.uv.cone_orient(by=by) == {"FINISHED"}
        assert UvMap(cube).tile_error() == 0
    assert bpy.ops.uv.cone_align(side="LEFT") == {"FINISHED"}
    assert UvMap(cube).tile_error() == 0


def boxes(obj):
    uv_map, island = UvMap(obj), np.array(UvMap(obj).island_of_face())
    found = []
    for number in np.unique(island):
        uv = face_uv(obj, np.flatnonzero(island == number))
        found.append([*uv.min(axis=0), *uv.max(axis=0)])
    assert len(found) == uv_map.islands()
    return np.array(found)


def test_align_puts_sides_of_all_objects_on_one_line():
    first, second = bent_grid("First"), bent_grid("Second")
    set_uv(second, UvMap(second).uv + np.array([0.7, 0.1]))
    edit(first, second)
    assert bpy.ops.uv.cone_align(side="LEFT") == {"FINISHED"}
    assert abs(boxes(first)[0, 0] - boxes(second)[0, 0]) < UV_ROUNDING
    assert bpy.ops.uv.cone_align(side="TOP") == {"FINISHED"}
    assert abs(boxes(first)[0, 3] - boxes(second)[0, 3]) < UV_ROUNDING


def test_align_to_the_island_of_the_active_face():
    first, second = bent_grid("First"), bent_grid("Second")
    set_uv(second, UvMap(second).uv + np.array([0.7, 0.1]))
    edit(first, second)
    with pytest.raises(RuntimeError, match="no selected face is active"):
        bpy.ops.uv.cone_align(side="LEFT", line="ACTIVE")
    bpy.context.view_layer.objects.active = second
    bm = bmesh.from_edit_mesh(second.data)
    bm.faces.ensure_lookup_table()
    bm.faces.active = bm.faces[7]
    before = boxes(second)
    assert before[0, 0] > boxes(first)[0, 0] + 0.1
    assert bpy.ops.uv.cone_align(side="LEFT", line="ACTIVE") == {"FINISHED"}
    assert boxes(second).tolist() == before.tolist()
    assert abs(boxes(first)[0, 0] - before[0, 0]) < UV_ROUNDING
    # A pinned island neither gives the line nor moves.
    edit_off()
    pin(first, range(49))
    held = boxes(first)
    edit(second, first)
    assert bpy.ops.uv.cone_align(side="TOP", line="ACTIVE") == {"FINISHED"}
    assert boxes(first).tolist() == held.tolist()
    assert boxes(second).tolist() == before.tolist()


def test_stitch_joins_islands_exactly():
    cube = unwrapped_cube()
    before = UvMap(cube)
    assert before.islands() > 1
    edit(cube)
    assert bpy.ops.uv.cone_stitch() == {"FINISHED"}
    after = UvMap(cube)
    assert after.islands() == 1
    old, new = (
        np.linalg.norm(found.uv[found.triangles] - np.roll(found.uv[found.triangles], 1, axis=1), axis=2)
        for found in (before, after)
    )
    np.testing.assert_allclose(old, new, atol=8 * UV_ROUNDING)
    with pytest.raises(RuntimeError, match="one island"):
        bpy.ops.uv.cone_stitch()


@pytest.mark.parametrize("name", ["straighten", "grid", "rectify", "align", "stitch"])
def test_tools_are_undone_and_redone(name):
    first, second = bent_grid("First"), bent_grid("Second")
    set_uv(second, UvMap(second).uv + np.array([0.7, 0.1]))
    if name == "stitch":
        uv = UvMap(second).uv
        uv[:72] += (0.0, 0.5)
        set_uv(second, uv)
    edit(first, second, select="SELECT" if name in ("align", "stitch") else "DESELECT")
    if name not in ("align", "stitch"):
        select_elements(first, "faces", row_of(first))
    assert undone(["First", "Second"], getattr(bpy.ops.uv, f"cone_{name}"))


def test_rip_makes_islands_of_the_selected_faces_in_free_space():
    grid = bent_grid()
    selected(grid, [0, 1, 35])
    before = UvMap(grid)
    assert bpy.ops.uv.cone_rip() == {"FINISHED"}
    after = UvMap(grid)
    assert after.islands() == 3
    assert after.overlap_area() < 1e-3
    rest = [face for face in range(36) if face not in (0, 1, 35)]
    assert np.array_equal(
        face_uv(grid, rest), before.uv[[loop for face in rest for loop in before.loops_of_face[face]]]
    )
    for face in (0, 1, 35):
        old, new = (m.uv[m.loops_of_face[face]] for m in (before, after))
        np.testing.assert_allclose(old - old[0], new - new[0], atol=4 * UV_ROUNDING)
    selected(grid, [35])
    with pytest.raises(RuntimeError, match="whole islands"):
        bpy.ops.uv.cone_rip()


@pytest.mark.parametrize("name", ["straighten", "rectify", "grid", "align", "orient", "stitch", "rip"])
def test_nothing_selected_and_no_map_are_said(name):
    operator = getattr(bpy.ops.uv, f"cone_{name}")
    grid = bent_grid()
    assert not operator.poll()
    edit(grid, select="DESELECT")
    with pytest.raises(RuntimeError, match="selected; select"):
        operator()
    edit_off()
    grid.data.uv_layers.remove(grid.data.uv_layers[0])
    edit(grid)
    with pytest.raises(RuntimeError, match="no UV map"):
        operator()
