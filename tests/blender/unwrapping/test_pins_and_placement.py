# SPDX-License-Identifier: GPL-3.0-or-later
"""Pinned UVs, the place of islands, the aspect of images, Blender's packer, and selections in the UV editor."""

import bmesh
import bpy
import numpy as np
import pytest
from logged import refused
from scenes import (
    UV_ROUNDING,
    UvMap,
    add_ball,
    add_cone_cube,
    add_grid,
    add_sphere,
    add_texture,
    add_tube,
    changed,
    covered_twice,
    edges_where,
    edit,
    mark_seams,
    pin,
    plain_copy,
    select_elements,
    set_uv,
    snapshot,
    uv_key,
)

# Single precision of corners in a few UV squares, over an island's box.
BOX = 1e-5


def active_uv(obj):
    """(l, 2) float32, as stored."""
    mesh = plain_copy(obj)
    uv = np.empty((len(mesh.loops), 2), np.float32)
    mesh.uv_layers[obj.data.uv_layers.active.name].uv.foreach_get("vector", uv.ravel())
    bpy.data.meshes.remove(mesh)
    return uv


def first_loops(obj, vertices):
    """A loop of each of these vertices."""
    loops = {}
    for loop in obj.data.loops:
        loops.setdefault(loop.vertex_index, loop.index)
    return [loops[vertex] for vertex in vertices]


def island_loops(obj):
    """The loops of every island of the map, largest island first."""
    uv_map = UvMap(obj)
    islands = {}
    for face, island in enumerate(uv_map.island_of_face()):
        islands.setdefault(island, []).extend(uv_map.loops_of_face[face])
    return sorted(map(np.array, islands.values()), key=len, reverse=True)


def turned(uv, angle, scale, shift):
    c, s = np.cos(angle), np.sin(angle)
    return (uv - uv.mean(axis=0)) @ (scale * np.array([[c, s], [-s, c]])) + shift


def box(uv):
    return np.concatenate([uv.min(axis=0), uv.max(axis=0)])


def shape_difference(first, second):
    """How far two layouts are from similar: the least-squares rest, relative to the size."""
    a, b = (uv[:, 0] + 1j * uv[:, 1] for uv in (np.asarray(first, float), np.asarray(second, float)))
    a, b = a - a.mean(), b - b.mean()
    return float(np.abs(b - (np.vdot(a, b) / np.vdot(a, a)) * a).max() / np.abs(b).max())


# --- pins -----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("in_edit_mode", [True, False])
def test_pins_are_kept_to_the_byte_and_seams_stay_exact(in_edit_mode):
    ball = add_ball()
    bpy.ops.uv.cone_unwrap()
    loops = first_loops(ball, [0, 9, 20, 31, 40])
    places = UvMap(ball).uv[loops] * 1.7 + [[0.3, 0.1], [0.31, 0.1], [0.3, 0.09], [0.3, 0.12], [0.29, 0.1]]
    pin(ball, loops, places)
    if in_edit_mode:
        edit(ball)
    before, old = snapshot(ball), active_uv(ball)
    assert bpy.ops.uv.cone_unwrap() == {"FINISHED"}
    assert changed(before, snapshot(ball)) == {uv_key()}
    uv = active_uv(ball)
    assert uv[loops].tobytes() == old[loops].tobytes() == places.astype(np.float32).tobytes()
    assert (uv != old).any(axis=1).sum() > len(uv) / 2
    uv_map = UvMap(ball)
    assert uv_map.islands() == 1
    assert uv_map.sister_difference() <= 4 * UV_ROUNDING


def test_two_pins_move_turn_and_scale_the_island_and_leave_its_shape():
    ball = add_ball()
    bpy.ops.uv.cone_unwrap()
    plain = active_uv(ball)
    loops = first_loops(ball, [0, 40])
    pin(ball, loops, np.array([[2.0, 1.0], [2.0, 3.0]]))
    bpy.ops.uv.cone_unwrap()
    moved = active_uv(ball)
    assert moved[loops].tolist() == [[2.0, 1.0], [2.0, 3.0]]
    assert shape_difference(plain, moved) < 1e-5


@pytest.mark.parametrize("in_edit_mode", [True, False])
def test_pins_have_no_say_when_they_are_not_used(in_edit_mode):
    ball = add_ball()
    bpy.ops.uv.cone_unwrap()
    plain = active_uv(ball)
    pin(ball, first_loops(ball, [0, 40]), np.array([[2.0, 1.0], [2.0, 3.0]]))
    if in_edit_mode:
        edit(ball)
    bpy.ops.uv.cone_unwrap(use_pins=False)
    assert active_uv(ball).tobytes() == plain.tobytes()


def test_pins_of_other_layers_and_unselected_faces_have_no_say():
    grid, twin = add_grid("Grid"), add_grid("Twin")
    left = [face.index for face in grid.data.polygons if face.center.x < 0]
    right = [loop for face in grid.data.polygons if face.center.x > 0 for loop in face.loop_indices]
    pin(grid, right, np.random.default_rng(1).random((len(right), 2)))
    grid.data.uv_layers.active = grid.data.uv_layers.new(name="Other")
    pin(grid, range(8), np.random.default_rng(2).random((8, 2)))
    grid.data.uv_layers.active_index = 0
    results = []
    for obj in (grid, twin):
        edit(obj)
        select_elements(obj, "faces", left)
        assert bpy.ops.uv.cone_unwrap(in_place=False) == {"FINISHED"}
        results.append(active_uv(obj)[[loop for f in left for loop in UvMap(obj).loops_of_face[f]]])
        bpy.ops.object.mode_set(mode="OBJECT")
    assert results[0].tobytes() == results[1].tobytes()


def conflict_on_one_vertex():
    """Two corners of one vertex pinned apart where no cut runs."""
    grid = add_grid()
    inner = next(v.index for v in grid.data.vertices if max(abs(v.co.x), abs(v.co.y)) < 0.5)
    loops = [loop.index for loop in grid.data.loops if loop.vertex_index == inner][:2]
    pin(grid, loops, np.array([[0.2, 0.2], [0.8, 0.7]]))
    return grid


def conflict_on_one_point():
    """Two vertices pinned onto one point."""
    grid = add_grid()
    pin(grid, first_loops(grid, [0, 24]), np.array([[0.5, 0.5], [0.5, 0.5]]))
    return grid


@pytest.mark.parametrize("in_edit_mode", [True, False])
@pytest.mark.parametrize("build", [conflict_on_one_vertex, conflict_on_one_point])
def test_conflicting_pins_are_refused_by_name_and_nothing_changes(build, in_edit_mode):
    grid = build()
    if in_edit_mode:
        edit(grid)
    before = snapshot(grid)
    with refused("PINS_CONFLICT", r"Grid: .*[Uu]npin"):
        bpy.ops.uv.cone_unwrap()
    assert changed(before, snapshot(grid)) == set()
    assert bpy.ops.uv.cone_unwrap(use_pins=False) == {"FINISHED"}


def test_pin_that_is_not_a_number_is_refused():
    grid = add_grid()
    pin(grid, [0, 30], np.array([[0.0, 0.0], [np.nan, 0.5]]))
    before = snapshot(grid)
    with refused("PIN_NON_FINITE", r"Grid: "):
        bpy.ops.uv.cone_unwrap()
    assert changed(before, snapshot(grid)) == set()


def test_pins_on_every_corner_of_an_ngon_are_met():
    grid = add_grid(segments=4)
    edit(grid)
    select_elements(grid, "faces", range(4))
    bpy.ops.mesh.dissolve_faces()
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.object.mode_set(mode="OBJECT")
    (ngon,) = (face for face in grid.data.polygons if len(face.vertices) > 4)
    bpy.ops.uv.cone_unwrap()
    loops = list(ngon.loop_indices)
    places = active_uv(grid)[loops] * 2 + np.float32(0.25)
    pin(grid, loops, places)
    assert bpy.ops.uv.cone_unwrap() == {"FINISHED"}
    assert active_uv(grid)[loops].tobytes() == places.tobytes()


# --- place ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("in_edit_mode", [True, False])
def test_islands_stay_where_the_artist_put_them(in_edit_mode):
    ball = add_ball()
    cube = add_cone_cube("Waist")
    mark_seams(ball, edges_where(cube, lambda place: abs(place[2]) < 1e-6))
    bpy.data.objects.remove(cube)
    ball.select_set(True)
    bpy.context.view_layer.objects.active = ball
    bpy.ops.uv.cone_unwrap()
    islands = island_loops(ball)
    assert len(islands) == 2
    uv = active_uv(ball).astype(float)
    uv[islands[0]] = turned(uv[islands[0]], 0.7, 0.4, [1.6, -0.2])
    uv[islands[1]] = turned(uv[islands[1]], -2.0, 1.9, [0.3, 2.5])
    set_uv(ball, uv)
    if in_edit_mode:
        edit(ball)
    bpy.ops.uv.cone_unwrap(keep_placement=True)
    placed = active_uv(ball)
    for loops in islands:
        size = np.ptp(uv[loops], axis=0).max()
        assert np.abs(box(placed[loops]) - box(uv[loops])).max() < BOX * size
        assert np.abs(placed[loops] - uv[loops]).max() < BOX * size
    bpy.ops.uv.cone_unwrap(keep_placement=True)
    assert np.abs(active_uv(ball) - placed).max() < BOX
    bpy.ops.uv.cone_unwrap()
    assert active_uv(ball).min() >= 0 and active_uv(ball).max() <= 1


def test_size_place_and_turn_stay_when_the_shape_changes():
    ball = add_ball()
    bpy.ops.uv.cone_unwrap()
    uv = turned(active_uv(ball).astype(float), 1.1, 0.5, [3.0, 2.0])
    set_uv(ball, uv)
    for vertex in ball.data.vertices:
        vertex.co.x *= 1.2
    for _ in range(5):
        bpy.ops.uv.cone_unwrap(keep_placement=True)
    placed = active_uv(ball).astype(float)
    assert shape_difference(uv, placed) > 1e-2
    # Up to the diagonals of the quads, whose corners count twice.
    middle, size = uv.mean(axis=0), np.sqrt(uv.var(axis=0).sum())
    assert placed.mean(axis=0) == pytest.approx(middle, abs=1e-3 * size)
    assert np.sqrt(placed.var(axis=0).sum()) == pytest.approx(size, rel=1e-3)
    cross = (placed - middle)[:, 0] * (uv - middle)[:, 1] - (placed - middle)[:, 1] * (uv - middle)[:, 0]
    assert abs(cross.sum()) < 1e-3 * ((uv - middle) ** 2).sum()
    # The place is several UV squares from the origin.
    assert UvMap(ball).sister_difference() <= 4 * UV_ROUNDING


@pytest.mark.parametrize("value", [0.0, np.nan])
def test_without_usable_old_coordinates_islands_go_where_they_always_go(value):
    ball = add_ball()
    bpy.ops.uv.cone_unwrap(pack=False)
    usual = active_uv(ball)
    set_uv(ball, np.full((len(ball.data.loops), 2), value))
    bpy.ops.uv.cone_unwrap(keep_placement=True)
    assert active_uv(ball).tobytes() == usual.tobytes()


def test_mesh_without_layer_has_no_place_to_keep():
    ball, twin = add_ball(), add_ball("Twin")
    ball.data.uv_layers.remove(ball.data.uv_layers[0])
    assert bpy.ops.uv.cone_unwrap(keep_placement=True) == {"FINISHED"}
    bpy.ops.uv.cone_unwrap(pack=False)
    assert np.ptp(active_uv(ball), axis=0).max() > 0.9
    assert active_uv(ball).tobytes() == active_uv(twin).tobytes()


def test_pins_go_before_the_old_place():
    ball = add_ball()
    bpy.ops.uv.cone_unwrap()
    loops = first_loops(ball, [0, 40])
    pin(ball, loops, np.array([[2.0, 1.0], [2.0, 3.0]]))
    bpy.ops.uv.cone_unwrap()
    pinned = active_uv(ball)
    bpy.ops.uv.cone_unwrap(keep_placement=True)
    assert active_uv(ball).tobytes() == pinned.tobytes()


# --- aspect ---------------------------------------------------------------------------------------------------------


def side_ratio(obj):
    """Width over height of a map of a square."""
    width, height = np.ptp(active_uv(obj), axis=0)
    return float(width / height)


@pytest.mark.parametrize("in_edit_mode", [True, False])
@pytest.mark.parametrize(("width", "height"), [(64, 32), (16, 64)])
def test_square_is_square_on_its_image_as_in_blenders_own_unwrap(width, height, in_edit_mode):
    square = add_grid()
    add_texture(square, width, height)
    edit(square)
    bpy.ops.uv.unwrap(correct_aspect=True, margin=0.0)
    own = side_ratio(square)
    assert own == pytest.approx(height / width, rel=1e-4)
    if not in_edit_mode:
        bpy.ops.object.mode_set(mode="OBJECT")
    assert bpy.ops.uv.cone_unwrap() == {"FINISHED"}
    assert side_ratio(square) == pytest.approx(height / width, rel=1e-5)
    uv = active_uv(square)
    assert uv.min() >= 0 and uv.max() <= 1 and np.ptp(uv, axis=0).max() > 0.9
    assert bpy.ops.uv.cone_unwrap(correct_aspect=False) == {"FINISHED"}
    assert side_ratio(square) == pytest.approx(1.0, rel=1e-5)


def test_aspect_comes_from_the_active_face_in_edit_mode():
    square = add_grid()
    add_texture(square, 64, 32)
    add_texture(square, 16, 64)
    edit(square)
    for face, material, expected in ((5, 1, 4.0), (6, 0, 0.5), (7, 1, 4.0)):
        bm = bmesh.from_edit_mesh(square.data)
        bm.faces.ensure_lookup_table()
        bm.faces[face].material_index = material
        bm.faces.active = bm.faces[face]
        bmesh.update_edit_mesh(square.data)
        bpy.ops.uv.cone_unwrap()
        ours = side_ratio(square)
        bpy.ops.uv.unwrap(correct_aspect=True, margin=0.0)
        assert ours == pytest.approx(side_ratio(square), rel=1e-4) == pytest.approx(expected, rel=1e-4)


def test_aspect_comes_from_the_active_face_its_shown_texture_and_its_pixels():
    square = add_grid()
    add_texture(square, 64, 32)
    second = add_texture(square, 32, 32)
    second.display_aspect = (3.0, 1.0)
    square.data.polygons.active = 5
    square.data.polygons[5].material_index = 1
    bpy.ops.uv.cone_unwrap()
    assert side_ratio(square) == pytest.approx(1 / 3, rel=1e-5)
    square.data.polygons.active = 6
    bpy.ops.uv.cone_unwrap()
    assert side_ratio(square) == pytest.approx(1 / 2, rel=1e-5)
    # In a group, which is where node setups often keep their textures.
    tree = square.data.materials[0].node_tree
    group = bpy.data.node_groups.new("Group", "ShaderNodeTree")
    inside = group.nodes.new("ShaderNodeTexImage")
    inside.image = bpy.data.images.new("Inside", 80, 20)
    group.nodes.active = inside
    for node in [node for node in tree.nodes if node.type == "TEX_IMAGE"]:
        tree.nodes.remove(node)
    tree.nodes.new("ShaderNodeGroup").node_tree = group
    bpy.ops.uv.cone_unwrap()
    assert side_ratio(square) == pytest.approx(1 / 4, rel=1e-5)
    square.data.materials[0].node_tree.nodes.clear()
    bpy.ops.uv.cone_unwrap()
    assert side_ratio(square) == pytest.approx(1.0, rel=1e-5)


def test_pins_and_place_hold_on_an_image_that_is_not_square():
    ball = add_ball()
    add_texture(ball, 64, 32)
    bpy.ops.uv.cone_unwrap()
    uv = (turned(active_uv(ball) * [2.0, 1.0], 0.8, 0.7, [1.0, 0.4]) * [0.5, 1.0]).astype(np.float32)
    set_uv(ball, uv)
    bpy.ops.uv.cone_unwrap(keep_placement=True)
    assert np.abs(active_uv(ball) - uv).max() < BOX
    loops = first_loops(ball, [0, 20, 40])
    pin(ball, loops)
    places = active_uv(ball)[loops]
    bpy.ops.uv.cone_unwrap()
    assert active_uv(ball)[loops].tobytes() == places.tobytes()
    assert np.abs(active_uv(ball) - uv).max() < BOX


# --- packing --------------------------------------------------------------------------------------------------------


def parts_to_pack():
    """A ball, a tube and a grid in one object: three islands, one of them of a curved surface with cuts."""
    ball = add_ball("Parts")
    add_tube()
    add_grid()
    bpy.context.view_layer.objects.active = ball
    bpy.ops.object.join()
    return ball


@pytest.mark.parametrize("in_edit_mode", [True, False])
@pytest.mark.parametrize("sync", [True, False])
def test_packed_islands_keep_their_shape_and_their_seams(in_edit_mode, sync):
    obj = parts_to_pack()
    bpy.context.tool_settings.use_uv_select_sync = sync
    bpy.ops.uv.cone_unwrap(pack=False)
    plain, islands = active_uv(obj), island_loops(obj)
    assert len(islands) == 3
    if in_edit_mode:
        edit(obj)
    before = snapshot(obj)
    assert bpy.ops.uv.cone_unwrap(pack=True, margin=0.02) == {"FINISHED"}
    assert changed(before, snapshot(obj)) == {uv_key()}
    packed = active_uv(obj)
    assert packed.tobytes() != plain.tobytes()
    for loops in islands:
        assert shape_difference(plain[loops], packed[loops]) < 1e-6
    assert UvMap(obj).sister_difference() <= UV_ROUNDING
    assert packed.min() >= 0 and packed.max() <= 1
    assert np.ptp(packed, axis=0).max() > 0.9
    assert bpy.ops.uv.cone_unwrap(pack=True, margin=0.02) == {"FINISHED"}
    assert active_uv(obj).tobytes() == packed.tobytes()


def test_a_wider_margin_makes_smaller_islands():
    obj = add_grid("Parts", segments=2)
    add_grid(segments=3)
    bpy.context.view_layer.objects.active = obj
    bpy.ops.object.join()
    areas = []
    for margin in (0.0, 0.1):
        bpy.ops.uv.cone_unwrap(pack=True, margin=margin)
        uv_map = UvMap(obj)
        corners = uv_map.uv[[loops[:3] for loops in uv_map.loops_of_face]]
        a, b = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
        areas.append(float(np.abs(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).sum()))
    assert areas[1] < 0.95 * areas[0]


@pytest.mark.parametrize("in_edit_mode", [True, False])
def test_objects_are_packed_together(in_edit_mode):
    objects = [add_grid("First"), add_ball("Second")]
    bpy.ops.uv.cone_unwrap(pack=False)
    assert covered_twice(map(UvMap, objects)) > 0
    if in_edit_mode:
        edit(*objects)
    assert bpy.ops.uv.cone_unwrap(pack=True, margin=0.01) == {"FINISHED"}
    first, second = map(active_uv, objects)
    every = np.concatenate([first, second])
    assert every.min() >= 0 and every.max() <= 1 and np.ptp(every, axis=0).max() > 0.9
    assert covered_twice(map(UvMap, objects)) == 0


@pytest.mark.parametrize("in_edit_mode", [True, False])
def test_packing_leaves_unselected_faces_and_failed_objects_alone(in_edit_mode):
    good, bad = add_cone_cube("Good"), add_sphere("Bad")
    set_uv(bad, np.random.default_rng(4).random((len(bad.data.loops), 2)))
    if in_edit_mode:
        edit(good, bad)
    before = snapshot(bad)
    assert bpy.ops.uv.cone_unwrap(pack=True) == {"FINISHED"}
    assert changed(before, snapshot(bad)) == set()


def test_islands_with_pins_are_not_packed():
    obj = parts_to_pack()
    bpy.ops.uv.cone_unwrap()
    islands = island_loops(obj)
    held = islands[0][[0, 40]]
    pin(obj, held.tolist(), np.array([[0.1, 0.1], [0.3, 0.2]]))
    bpy.ops.uv.cone_unwrap(pack=False)
    pinned = active_uv(obj)
    bpy.ops.uv.cone_unwrap(pack=True)
    packed = active_uv(obj)
    assert packed[islands[0]].tobytes() == pinned[islands[0]].tobytes()
    assert packed[islands[1]].tobytes() != pinned[islands[1]].tobytes()


def test_nothing_is_packed_where_every_island_is_pinned():
    ball = add_ball()
    bpy.ops.uv.cone_unwrap()
    pin(ball, first_loops(ball, [0, 40]))
    before = active_uv(ball)
    assert bpy.ops.uv.cone_unwrap(pack=True) == {"FINISHED"}
    assert np.abs(active_uv(ball) - before).max() < BOX


@pytest.mark.parametrize("correct_aspect", [True, False])
def test_packing_turns_islands_on_their_image(correct_aspect):
    obj = parts_to_pack()
    add_texture(obj, 64, 16)
    bpy.ops.uv.cone_unwrap(correct_aspect=correct_aspect, pack=False)
    plain, islands = active_uv(obj), island_loops(obj)
    bpy.ops.uv.cone_unwrap(correct_aspect=correct_aspect, pack=True)
    packed = active_uv(obj)
    image = np.array([4.0, 1.0] if correct_aspect else [1.0, 1.0])
    for loops in islands:
        assert shape_difference(plain[loops] * image, packed[loops] * image) < 1e-6
    assert packed.min() >= 0 and packed.max() <= 1


def test_packing_works_in_local_view():
    obj = parts_to_pack()
    bpy.ops.uv.cone_unwrap(pack=True)
    expected = active_uv(obj).tobytes()
    bpy.ops.uv.cone_unwrap(pack=False)
    assert active_uv(obj).tobytes() != expected
    window = bpy.context.window_manager.windows[0]
    area = next(area for area in window.screen.areas if area.type == "VIEW_3D")
    region = next(region for region in area.regions if region.type == "WINDOW")
    edit(obj)
    with bpy.context.temp_override(window=window, area=area, region=region):
        bpy.ops.view3d.localview()
        assert area.spaces.active.local_view is not None
        before = snapshot(obj)
        assert bpy.ops.uv.cone_unwrap(pack=True) == {"FINISHED"}
        assert changed(before, snapshot(obj)) == {uv_key()}
    assert active_uv(obj).tobytes() == expected


# --- selection in the UV editor -------------------------------------------------------------------------------------


@pytest.fixture
def uv_editor():
    """Turns the largest area into a UV editor: a context override for operators."""
    window = bpy.context.window_manager.windows[0]
    area = max(window.screen.areas, key=lambda area: area.width * area.height)
    area.ui_type = "UV"
    region = next(region for region in area.regions if region.type == "WINDOW")
    return {"window": window, "area": area, "region": region}


def select_uvs(obj, faces, uv_editor):
    """Select the UVs of these faces only, in a UV editor with a selection of its own."""
    bpy.context.tool_settings.use_uv_select_sync = False
    edit(obj)
    select_elements(obj, "faces", faces)
    with bpy.context.temp_override(**uv_editor):
        bpy.ops.uv.select_all(action="SELECT")
    bpy.ops.mesh.select_all(action="SELECT")


def loops_of(obj, faces):
    return np.array([loop for face in faces for loop in UvMap(obj).loops_of_face[face]])


def test_uv_editor_unwraps_faces_with_selected_uvs_only(uv_editor):
    grid = add_grid(segments=6)
    set_uv(grid, np.random.default_rng(3).random((len(grid.data.loops), 2)))
    left = [face.index for face in grid.data.polygons if face.center.x < 0]
    select_uvs(grid, left, uv_editor)
    before, state = active_uv(grid), snapshot(grid)
    with bpy.context.temp_override(**uv_editor):
        assert bpy.ops.uv.cone_unwrap() == {"FINISHED"}
    assert changed(state, snapshot(grid)) == {uv_key()}
    after, chosen = active_uv(grid), np.zeros(len(before), bool)
    chosen[loops_of(grid, left)] = True
    assert after[~chosen].tobytes() == before[~chosen].tobytes()
    assert (after[chosen] != before[chosen]).any(axis=1).all()
    assert UvMap(grid).scale_spread(left) < 1 + 1e-5


def test_selected_uvs_have_no_say_in_the_3d_view_or_in_sync(uv_editor):
    grid = add_grid(segments=6)
    set_uv(grid, np.random.default_rng(3).random((len(grid.data.loops), 2)))
    left = [face.index for face in grid.data.polygons if face.center.x < 0]
    select_uvs(grid, left, uv_editor)
    bpy.ops.uv.cone_unwrap()
    assert UvMap(grid).scale_spread() < 1 + 1e-5
    bpy.ops.object.mode_set(mode="OBJECT")
    set_uv(grid, np.random.default_rng(3).random((len(grid.data.loops), 2)))
    edit(grid)
    bpy.context.tool_settings.use_uv_select_sync = True
    with bpy.context.temp_override(**uv_editor):
        bpy.ops.uv.cone_unwrap()
    assert UvMap(grid).scale_spread() < 1 + 1e-5


def test_no_selected_uv_is_refused(uv_editor):
    grid = add_grid(segments=6)
    select_uvs(grid, [0], uv_editor)
    with bpy.context.temp_override(**uv_editor):
        bpy.ops.uv.select_all(action="DESELECT")
        before = snapshot(grid)
        with pytest.raises(RuntimeError, match="select the faces to unwrap"):
            bpy.ops.uv.cone_unwrap()
    assert changed(before, snapshot(grid)) == set()
