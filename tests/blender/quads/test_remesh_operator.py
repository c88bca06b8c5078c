# SPDX-License-Identifier: GPL-3.0-or-later
"""Remesh to Quads: the new object's mesh, the attributes copied to it, and the unchanged original."""

import math
from collections import Counter

import bpy
import numpy as np
import pytest
from installed import addon
from logged import refused
from scenes import add_ball, add_cone_cube, add_cube, add_grid, changed, corners, edit, mark, marked, snapshot

identifiers = addon.core.identifiers
ALLOWED = {"data-blocks", "context", "selected objects"}


def remesh(**options):
    assert bpy.ops.object.cone_remesh_to_quads(**options) == {"FINISHED"}
    return bpy.context.object


def select_only(*objects):
    bpy.ops.object.select_all(action="DESELECT")
    for obj in objects:
        obj.select_set(True)
    bpy.context.view_layer.objects.active = objects[0]


def positions(obj):
    """In the world."""
    return np.array([obj.matrix_world @ vertex.co for vertex in obj.data.vertices])


def quads_of(obj):
    assert {len(face.vertices) for face in obj.data.polygons} == {4}
    return np.array([face.vertices[:] for face in obj.data.polygons])


def valences(obj):
    return np.bincount(quads_of(obj).ravel(), minlength=len(obj.data.vertices))


def assert_closed(obj, euler):
    """Every edge occurs once in each direction in a quad; also checks the Euler characteristic."""
    quads = quads_of(obj)
    sides = Counter((int(a), int(b)) for quad in quads for a, b in zip(quad, np.roll(quad, -1), strict=True))
    assert set(sides.values()) == {1}
    assert all((b, a) in sides for a, b in sides)
    assert len(obj.data.edges) == len(sides) // 2
    assert len(obj.data.vertices) - len(obj.data.edges) + len(quads) == euler


def side_lengths(obj):
    ends = positions(obj)[quads_of(obj)]
    return np.linalg.norm(ends - np.roll(ends, -1, axis=1), axis=2)


def material(name):
    return bpy.data.materials.new(name)


# --- the quads ------------------------------------------------------------------------------------------------------


def test_a_cube_becomes_as_many_squares_a_side(reports):
    cube = add_cone_cube()
    before = snapshot(cube)
    reports()
    made = remesh(count=600)
    assert made.name == made.data.name == "Cube Quads"
    assert changed(before, snapshot(cube)) <= ALLOWED
    assert len(made.data.polygons) == 600
    assert_closed(made, euler=2)
    assert side_lengths(made) == pytest.approx(0.2, abs=1e-5)
    assert np.abs(positions(made)).max(axis=1) == pytest.approx(1.0, abs=1e-6)
    assert Counter(valences(made).tolist()) == {3: 8, 4: 602 - 8}
    assert "600 quads, 8 irregular vertices" in reports()
    # Outward, as the cube's.
    assert all(face.normal.dot(face.center) > 0 for face in made.data.polygons)


def test_the_new_object_is_selected_and_the_original_is_kept():
    cube, other = add_cone_cube(), bpy.data.collections.new("Other")
    bpy.context.scene.collection.children.link(other)
    other.objects.link(cube)
    made = remesh(count=96)
    assert bpy.context.selected_objects == [made]
    assert set(made.users_collection) == set(cube.users_collection)
    assert not cube.hide_get()
    select_only(cube)
    again = remesh(count=96, hide_original=True)
    assert again.name == "Cube Quads.001"
    assert cube.hide_get() and not again.hide_get()


def test_a_torus_needs_no_irregular_vertices(reports):
    bpy.ops.mesh.primitive_torus_add(major_segments=48, minor_segments=16)
    reports()
    made = remesh(count=1000, rows="FREE")
    assert_closed(made, euler=0)
    assert len(made.data.polygons) == pytest.approx(1000, rel=0.05)
    irregular = int((valences(made) != 4).sum())
    assert f"{len(made.data.polygons):,} quads, {irregular} irregular vert" in reports()


def test_numbers_have_separators(reports):
    add_cone_cube()
    reports()
    made = remesh(count=2400)
    assert len(made.data.polygons) == 2400
    assert "2,400 quads" in reports()


@pytest.mark.parametrize("even_sizes", [False, True])
def test_missing_cones_are_placed(even_sizes):
    ball = add_ball()
    ball.vertex_groups.clear()
    made = remesh(count=500, even_sizes=even_sizes)
    assert_closed(made, euler=2)
    assert (valences(made) - 4).sum() == -8
    assert marked(ball) == []


def test_even_sizes_are_more_even():
    ball = add_ball()
    spread = {}
    for even_sizes in (False, True):
        select_only(ball)
        lengths = side_lengths(remesh(count=1000, even_sizes=even_sizes))
        spread[even_sizes] = lengths.std() / lengths.mean()
    assert spread[True] < spread[False]


def test_polishing_moves_what_is_regular_over_the_surface():
    ball = add_ball()
    made = {}
    for polish in (False, True):
        select_only(ball)
        made[polish] = remesh(count=1000, polish=polish)
    rough, polished = (positions(made[polish]) for polish in (False, True))
    is_irregular = valences(made[True]) != 4
    np.testing.assert_array_equal(rough[is_irregular], polished[is_irregular])
    assert (rough[~is_irregular] != polished[~is_irregular]).any(axis=1).mean() > 0.5
    spread = [np.std(side_lengths(each)) / np.mean(side_lengths(each)) for each in (made[False], made[True])]
    assert spread[1] < spread[0]


def test_marked_cones_are_the_irregular_vertices():
    ball = add_ball()
    cones = positions(ball)[marked(ball)]
    made = remesh(count=500)
    (irregular,) = np.nonzero(valences(made) != 4)
    assert len(irregular) == len(cones) == 8
    gaps = np.linalg.norm(positions(made)[irregular][:, None] - cones, axis=2)
    assert gaps.min(axis=0).max() < 1e-6
    # They are marked on the new mesh with the angles that quads make there.
    assert marked(made) == irregular.tolist()
    kept = addon.mesh.angles.read_angles(made, "uv_cones")
    assert kept.angles == [pytest.approx(n * math.pi / 2) for n in valences(made)[irregular]]


def test_a_prescribed_angle_is_kept():
    ball = add_ball()
    cones = marked(ball)
    addon.mesh.angles.write_angles(ball, cones[:1], [math.pi], [addon.core.cone_angles.Kind.PRESCRIBED])
    place = positions(ball)[cones[0]]
    made = remesh(count=500)
    at = np.linalg.norm(positions(made) - place, axis=1).argmin()
    assert valences(made)[at] == 2


# --- the transform --------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("scale", [(1, 1, 1), (3, 1, 0.5), (-1, 2, 1)])
def test_quads_are_square_in_the_world(scale):
    cube = add_cone_cube()
    parent = bpy.data.objects.new("Parent", None)
    bpy.context.collection.objects.link(parent)
    parent.location = (4, 5, 6)
    cube.parent = parent
    cube.scale, cube.location, cube.rotation_euler = scale, (1, 2, 3), (0.3, 0.2, 0.1)
    bpy.context.view_layer.update()
    made = remesh(amount="SIZE", size=0.25, rows="FREE", even_sizes=True)
    bpy.context.view_layer.update()
    assert made.matrix_world == cube.matrix_world
    assert_closed(made, euler=2)
    # On the cube, in its own coordinates.
    assert np.abs([vertex.co[:] for vertex in made.data.vertices]).max(axis=1) == pytest.approx(1.0, abs=1e-6)
    area = 8 * (abs(scale[0] * scale[1]) + abs(scale[1] * scale[2]) + abs(scale[2] * scale[0]))
    assert len(made.data.polygons) == pytest.approx(area / 0.25**2, rel=0.1)
    lengths = side_lengths(made)
    assert np.median(lengths) == pytest.approx(0.25, rel=0.1)
    assert lengths.std() < 0.15 * lengths.mean()


def test_rows_run_along_the_world_axis():
    cube = add_cone_cube()
    cube.rotation_euler = (0, 0, 0.5)
    bpy.context.view_layer.update()
    made = remesh(count=600, rows="Z")
    places = positions(made)
    along = places[[edge.vertices[0] for edge in made.data.edges]] - places[[e.vertices[1] for e in made.data.edges]]
    along /= np.linalg.norm(along, axis=1)[:, None]
    upright = np.abs(along[:, 2])
    assert (np.minimum(upright, 1 - upright) < 1e-4).all()


@pytest.mark.parametrize("on_edges", [False, True])
def test_rows_run_along_what_is_drawn(on_edges):
    found = {}
    for drawn in (False, True):
        ball = add_ball()
        if drawn and on_edges:
            ball.data.attributes.new(identifiers.ALONG_ATTRIBUTE, "BOOLEAN", "EDGE").data[7].value = True
        elif drawn:
            attribute = ball.data.attributes.new(identifiers.UP_ATTRIBUTE, "FLOAT_VECTOR", "FACE")
            attribute.data.foreach_set("vector", np.tile([1.0, 2.0, 0.0], len(ball.data.polygons)).astype(np.float32))
        for rows in ("AUTO", "Z"):
            select_only(ball)
            found[drawn, rows] = positions(remesh(count=300, rows=rows))
    np.testing.assert_array_equal(found[False, "AUTO"], found[False, "Z"])
    np.testing.assert_array_equal(found[True, "Z"], found[False, "Z"])
    assert not np.array_equal(found[True, "AUTO"], found[True, "Z"])


def test_an_object_without_size_is_refused(reports):
    cube = add_cone_cube()
    cube.scale = (0, 0, 0)
    bpy.context.view_layer.update()
    with refused("Refused", "scaled to zero"):
        bpy.ops.object.cone_remesh_to_quads(amount="SIZE")
    assert len(bpy.data.objects) == 1


def test_modifiers_are_not_copied():
    cube = add_cone_cube()
    cube.modifiers.new("Bevel", "BEVEL")
    made = remesh(count=96)
    assert [modifier.name for modifier in cube.modifiers] == ["Bevel"]
    assert not made.modifiers


# --- what is carried over -------------------------------------------------------------------------------------------


def test_materials_and_shading_are_those_of_the_faces_below():
    cube = add_cone_cube()
    for name in "ABC":
        cube.data.materials.append(material(name))
    for face in cube.data.polygons:
        face.material_index = int(np.abs(face.center).argmax())
        face.use_smooth = face.center.z > 0.9
    cube.material_slots[2].link = "OBJECT"
    cube.material_slots[2].material = material("Own")
    made = remesh(count=600)
    assert [slot.material.name for slot in made.material_slots] == ["A", "B", "Own"]
    assert [m.name for m in made.data.materials if m] == ["A", "B", "C"]
    for face in made.data.polygons:
        assert face.material_index == np.abs(face.center).argmax()
        assert face.use_smooth == (face.center.z > 0.99)


def test_the_texture_that_shows_the_map_is_not_carried_over():
    cube = add_cone_cube()
    cube.data.materials.append(material("Own"))
    assert bpy.ops.uv.cone_texture(pattern="CHECKER") == {"FINISHED"}
    made = remesh(count=96)
    assert [slot.material.name for slot in made.material_slots] == ["Own"]
    assert cube.material_slots[0].material.cone_unwrap_texture


def test_groups_and_attributes_of_points_are_interpolated():
    cube = add_cone_cube()
    group = cube.vertex_groups.new(name="Height")
    cube.vertex_groups.new(name="Empty")
    values = cube.data.attributes.new("x", "FLOAT", "POINT")
    colors = cube.data.color_attributes.new("tint", "FLOAT_COLOR", "POINT")
    painted = cube.data.color_attributes.new("paint", "FLOAT_COLOR", "CORNER")
    for vertex in cube.data.vertices:
        group.add([vertex.index], 0.5 + 0.5 * vertex.co.z, "REPLACE")
        values.data[vertex.index].value = vertex.co.x
        colors.data[vertex.index].color = (*(0.5 + 0.5 * np.array(vertex.co)), 1)
    for loop in cube.data.loops:
        painted.data[loop.index].color = (*(0.5 + 0.5 * np.array(cube.data.vertices[loop.vertex_index].co)), 0.5)
    made = remesh(count=600)
    assert [g.name for g in made.vertex_groups] == ["Height", "Empty", "uv_cones"]
    places = np.array([vertex.co for vertex in made.data.vertices])
    weights = np.zeros(len(places))
    for vertex in made.data.vertices:
        weights[vertex.index] = next((g.weight for g in vertex.groups if g.group == 0), 0.0)
    assert weights == pytest.approx(0.5 + 0.5 * places[:, 2], abs=1e-6)
    attributes = made.data.attributes
    assert [entry.value for entry in attributes["x"].data] == pytest.approx(places[:, 0], abs=1e-6)
    for name, alpha in (("tint", 1.0), ("paint", 0.5)):
        assert attributes[name].domain == "POINT"
        found = np.array([entry.color[:] for entry in attributes[name].data])
        assert found[:, :3] == pytest.approx(0.5 + 0.5 * places, abs=1e-6)
        assert found[:, 3] == pytest.approx(alpha)


def test_attributes_of_faces_are_those_of_the_faces_below():
    cube = add_cone_cube()
    numbers = cube.data.attributes.new("side", "INT", "FACE")
    for face in cube.data.polygons:
        numbers.data[face.index].value = int(np.abs(face.center).argmax())
    made = remesh(count=600)
    sides = made.data.attributes["side"].data
    assert all(sides[face.index].value == np.abs(face.center).argmax() for face in made.data.polygons)


def set_uv(obj, name, place_to_uv):
    """A UV map whose value at each corner of a face is that of a function of the place and the face's center."""
    layer = obj.data.uv_layers.get(name) or obj.data.uv_layers.new(name=name)
    for face in obj.data.polygons:
        for loop in face.loop_indices:
            place = obj.data.vertices[obj.data.loops[loop].vertex_index].co
            layer.uv[loop].vector = place_to_uv(np.array(place), np.array(face.center))
    return layer


def quad_corners(obj, layer):
    """Of each quad the places, (q, 4, 3), and the UVs, (q, 4, 2), of its corners."""
    data = obj.data
    places = np.array([data.vertices[loop.vertex_index].co for loop in data.loops]).reshape(-1, 4, 3)
    return places, np.array([entry.vector for entry in data.uv_layers[layer].uv]).reshape(-1, 4, 2)


def atlas(place, middle):
    """The sides of a cube apart from each other."""
    axis, sign = int(np.abs(middle).argmax()), middle[np.abs(middle).argmax()] > 0
    return np.delete(place, axis) + np.array([4 * axis, 4 * sign])


def test_uv_maps_are_those_of_the_surface_below(reports):
    cube = add_cone_cube()
    while cube.data.uv_layers:
        cube.data.uv_layers.remove(cube.data.uv_layers[0])
    set_uv(cube, "Flat", lambda place, middle: (place[0] + place[2], place[1]))
    set_uv(cube, "Atlas", atlas).active_render = True
    cube.data.uv_layers.active_index = 0
    reports()
    made = remesh(count=600)
    assert [layer.name for layer in made.data.uv_layers] == ["Flat", "Atlas"]
    assert made.data.uv_layers.active.name == "Flat" and made.data.uv_layers["Atlas"].active_render
    places, uv = quad_corners(made, "Flat")
    np.testing.assert_allclose(uv, np.stack([places[..., 0] + places[..., 2], places[..., 1]], axis=2), atol=1e-6)
    # Rows of quads lie along the seams, so that every quad is on one side.
    places, uv = quad_corners(made, "Atlas")
    expected = [[atlas(place, quad.mean(axis=0)) for place in quad] for quad in places]
    np.testing.assert_allclose(uv, expected, atol=1e-6)
    assert "seams" not in reports()


def test_quads_across_seams_are_continued_from_their_centers_and_counted(reports):
    cube = add_cone_cube(cuts=4)
    set_uv(cube, "UVMap", lambda place, middle: place[:2] + np.array([7 * (middle[0] > 0.2), 0]))
    reports()
    made = remesh(count=294)
    places, uv = quad_corners(made, "UVMap")
    middles = places.mean(axis=1)
    upright = np.abs(middles[:, 2]) > 0.99
    moved = 7 * (middles[:, 0] > 0.2)[:, None, None] * np.array([1, 0])
    np.testing.assert_allclose(uv[upright], (places[..., :2] + moved)[upright], atol=1e-5)
    is_across = (places[..., 0] < 0.199).any(axis=1) & (places[..., 0] > 0.201).any(axis=1)
    assert is_across.sum() == 4 * 7 and "28 across seams of UV maps" in reports()
    edit(made, select="DESELECT")
    assert bpy.ops.mesh.cone_select_reported() == {"FINISHED"}
    bpy.ops.object.mode_set(mode="OBJECT")
    assert [face.select for face in made.data.polygons] == is_across.tolist()


def test_a_mesh_without_uv_maps_gets_none():
    cube = add_cone_cube()
    while cube.data.uv_layers:
        cube.data.uv_layers.remove(cube.data.uv_layers[0])
    assert not remesh(count=96).data.uv_layers


def edges_where(obj, values):
    """The middles of the edges with a value, as a set of rounded places."""
    ends = np.array([[obj.data.vertices[v].co for v in edge.vertices] for edge in obj.data.edges], float)
    return {tuple(np.round(middle, 3) + 0.0) for middle in ends.mean(axis=1)[np.array(values, bool)]}


def test_marks_of_edges_are_on_the_edges_along_them():
    cube = add_cone_cube()
    ends = np.array([[cube.data.vertices[v].co for v in edge.vertices] for edge in cube.data.edges])
    on_top = (ends[..., 2] > 0.99).all(axis=1)
    at_right = on_top & (ends[..., 0] > 0.99).all(axis=1)
    at_front = on_top & (ends[..., 1] < -0.99).all(axis=1)
    cube.data.edges.foreach_set("use_seam", at_right)
    cube.data.edges.foreach_set("use_edge_sharp", at_front)
    cube.data.attributes.new("crease_edge", "FLOAT", "EDGE").data.foreach_set("value", 0.75 * at_right)
    cube.data.attributes.new(identifiers.FEATURE_ATTRIBUTE, "BOOLEAN", "EDGE").data.foreach_set("value", at_right)
    made = remesh(count=600)
    steps = {tuple(np.round([1, y, 1], 3)) for y in np.arange(-0.9, 1, 0.2)}
    assert edges_where(made, [edge.use_seam for edge in made.data.edges]) == steps
    assert edges_where(made, [edge.use_edge_sharp for edge in made.data.edges]) == {(y, -x, z) for x, y, z in steps}
    creases = [entry.value for entry in made.data.attributes["crease_edge"].data]
    assert edges_where(made, creases) == steps and set(creases) == {0, 0.75}
    features = made.data.attributes[identifiers.FEATURE_ATTRIBUTE].data
    assert edges_where(made, [entry.value for entry in features]) == steps


def test_seams_between_rows_of_quads_are_left_out():
    cube = add_cone_cube()
    ends = np.array([[cube.data.vertices[v].co for v in edge.vertices] for edge in cube.data.edges])
    cube.data.edges.foreach_set("use_seam", (ends[..., 0] == 0.5).all(axis=1))
    made = remesh(count=600)
    assert not any(edge.use_seam for edge in made.data.edges)


def test_marks_are_not_carried_through_thin_parts():
    grid = add_grid()
    mesh = grid.data
    size = mesh.vertices[0].co.length
    bpy.ops.object.modifier_add(type="SOLIDIFY")
    grid.modifiers[0].thickness = 1e-4 * size
    bpy.ops.object.modifier_apply(modifier="Solidify")
    is_above = [all(mesh.vertices[v].normal.z > 0.99 for v in edge.vertices) for edge in mesh.edges]
    mesh.edges.foreach_set("use_seam", is_above)
    other, places = mesh.copy(), np.array([vertex.co for vertex in mesh.vertices])
    addon.mesh.carried_edges.carry_edge_values(mesh, other, (places, places))
    assert 0 < sum(is_above) < len(is_above)
    assert [edge.use_seam for edge in other.edges] == is_above


# --- refusals -------------------------------------------------------------------------------------------------------


def test_an_open_mesh_is_refused_and_its_border_can_be_selected():
    bpy.ops.mesh.primitive_monkey_add()
    monkey = bpy.context.object
    before = snapshot(monkey)
    sides = Counter(tuple(sorted(key)) for face in monkey.data.polygons for key in face.edge_keys)
    border = {edge for edge, count in sides.items() if count == 1}
    # Of the first of its parts, one eye.
    with refused("OPEN_SURFACE", "boundary of 8 edges"):
        bpy.ops.object.cone_remesh_to_quads()
    assert changed(before, snapshot(monkey)) == set()
    edit(monkey, select="DESELECT")
    assert bpy.ops.mesh.cone_select_reported() == {"FINISHED"}
    bpy.ops.object.mode_set(mode="OBJECT")
    chosen = {tuple(sorted(edge.vertices)) for edge in monkey.data.edges if edge.select}
    assert len(chosen) == 8 and chosen <= border


def test_of_two_objects_one_may_be_refused(reports):
    grid, cube = add_grid(), add_cone_cube()
    select_only(grid, cube)
    reports()
    assert bpy.ops.object.cone_remesh_to_quads(count=96) == {"FINISHED"}
    said = reports()
    assert "Cube: 96 quads, 8 irregular vertices" in said
    assert "Warning: Grid: The surface has a boundary" in said
    assert {obj.name for obj in bpy.data.objects} == {"Grid", "Cube", "Cube Quads"}
    # The refused one stays selected, and active.
    assert {obj.name for obj in bpy.context.selected_objects} == {"Grid", "Cube Quads"}
    assert bpy.context.object == grid


def test_objects_that_share_a_mesh_get_quads_of_their_own():
    cube = add_cone_cube()
    double = cube.copy()
    bpy.context.collection.objects.link(double)
    double.scale = (2, 2, 2)
    select_only(cube, double)
    bpy.context.view_layer.update()
    assert bpy.ops.object.cone_remesh_to_quads(amount="SIZE", size=0.25) == {"FINISHED"}
    counts = {obj.name: len(obj.data.polygons) for obj in bpy.context.selected_objects}
    assert counts == {"Cube Quads": 6 * 8**2, "Cube.001 Quads": 6 * 16**2}


def test_it_runs_in_object_mode_only():
    cube = add_cone_cube()
    edit(cube)
    with pytest.raises(RuntimeError, match="Select mesh objects in object mode"):
        bpy.ops.object.cone_remesh_to_quads()
    bpy.ops.object.mode_set(mode="OBJECT")
    bpy.ops.object.select_all(action="DESELECT")
    with pytest.raises(RuntimeError, match="Select mesh objects in object mode"):
        bpy.ops.object.cone_remesh_to_quads()


def test_undo_leaves_the_file_as_it_was():
    cube = add_cube()
    mark(cube, corners(cube))
    bpy.ops.ed.undo_push(message="before")
    before = snapshot(cube)
    assert bpy.ops.object.cone_remesh_to_quads("EXEC_DEFAULT", True, count=96) == {"FINISHED"}
    assert "Cube Quads" in bpy.data.objects
    bpy.ops.ed.undo()
    assert changed(before, snapshot(bpy.data.objects["Cube"])) == set()
    assert "Cube Quads" not in bpy.data.objects and "Cube Quads" not in bpy.data.meshes


@pytest.mark.parametrize("follows", [True, False])
def test_rows_run_along_creases_unless_told_not_to(follows):
    """On a turned box every vertex on an edge is on two of its planes."""
    bpy.ops.mesh.primitive_cube_add(rotation=(0.3, 0.5, 0.2))
    box = bpy.context.object
    box.data.transform(box.matrix_basis)
    box.matrix_basis.identity()
    normals = np.array([face.normal[:] for face in box.data.polygons])
    offsets = np.array([face.normal.dot(face.center) for face in box.data.polygons])
    made = remesh(count=600, follow_creases=follows)
    assert_closed(made, euler=2)
    at_planes = (np.abs(positions(made) @ normals.T - offsets) < 1e-5).sum(axis=1)
    on_edges = int((at_planes >= 2).sum())
    assert on_edges > 80 if follows else on_edges < 60


# --- the density of quads ---------------------------------------------------------------------------------------------


def weigh(obj, group=identifiers.QUAD_DENSITY_GROUP):
    """A weight of 1 where x is 1, of 0 where it is -1, and linear between."""
    group = obj.vertex_groups.new(name=group)
    for vertex in obj.data.vertices:
        group.add([vertex.index], (vertex.co.x / max(abs(v.co.x) for v in obj.data.vertices) + 1) / 2, "REPLACE")


def sizes(obj):
    """Mean areas of the quads in the outer quarters, where x is low and where it is high."""
    faces = [(face.center.x, face.area) for face in obj.data.polygons]
    reach = max(abs(x) for x, _ in faces)
    return [np.mean([area for x, area in faces if sign * x > reach / 2]) for sign in (-1, 1)]


def test_quads_are_smaller_where_the_group_of_density_has_weight():
    ball = add_ball(cuts=7)
    weigh(ball)
    before = snapshot(ball)
    made = remesh(count=1500)
    assert changed(before, snapshot(ball)) <= ALLOWED
    assert_closed(made, euler=2)
    low, high = sizes(made)
    # Between weights of 1/8 and 7/8 about 16^(3/4) = 8 times.
    assert 5 < low / high < 12
    assert len(made.data.polygons) == pytest.approx(1500, rel=0.1)


def test_the_side_of_quads_is_that_where_the_weight_of_density_is_none():
    ball = add_ball(cuts=7)
    weigh(ball)
    made = remesh(amount="SIZE", size=0.25, rows="FREE")
    low, high = (math.sqrt(area) for area in sizes(made))
    assert 0.15 < low < 0.25 and 0.25 / 4 < high < 0.15


@pytest.mark.parametrize("options", [{"density_group": "none"}, {"density_group": ""}], ids=str)
def test_density_has_no_say_without_its_group(options):
    ball = add_ball()
    plain = positions(remesh(count=400))
    select_only(ball)
    weigh(ball)
    assert np.array_equal(positions(remesh(count=400, **options)), plain)


def test_another_group_of_density_can_be_chosen():
    ball = add_ball(cuts=5)
    weigh(ball, "small here")
    low, high = sizes(remesh(count=1000, density_group="small here"))
    assert low > 4 * high
