# SPDX-License-Identifier: GPL-3.0-or-later
"""Auto Unwrap: the result of one press, and what it preserves."""

import re
from itertools import pairwise

import bmesh
import bpy
import numpy as np
import pytest
from installed import addon
from one_blender import one_blender
from scenes import (
    UV_ROUNDING,
    UvMap,
    add_ball,
    add_cone_cube,
    add_cube,
    add_grid,
    add_object,
    add_ramp,
    add_sphere,
    add_texture,
    changed,
    corners,
    covered_twice,
    edit,
    mark,
    mark_seams,
    marked,
    pin,
    select_elements,
    snapshot,
    uv_key,
)

PRESETS = ("PAINT", "TILE", "BAKE")


def unwrap(**options):
    assert bpy.ops.uv.cone_auto_unwrap(**options) == {"FINISHED"}


@pytest.mark.parametrize("preset", PRESETS)
@pytest.mark.parametrize("in_edit_mode", [True, False])
def test_only_the_active_uv_layer_changes(in_edit_mode, preset):
    sphere = add_sphere()
    if in_edit_mode:
        edit(sphere)
    before = snapshot(sphere)
    unwrap(preset=preset)
    assert changed(before, snapshot(sphere)) == {uv_key()}
    once = snapshot(sphere)
    unwrap(preset=preset)
    assert changed(once, snapshot(sphere)) == set()


@pytest.mark.slow
@pytest.mark.parametrize("add", [add_cube, add_grid, *one_blender(add_sphere, add_ramp, add_ball)])
@pytest.mark.parametrize("preset", PRESETS)
def test_nothing_overlaps_and_all_is_even_or_seamless(preset, add):
    obj = add()
    unwrap(preset=preset)
    uv_map = UvMap(obj)
    assert uv_map.overlapping() == set() and uv_map.flipped() == set()
    assert uv_map.sister_difference() <= UV_ROUNDING * max(1.0, np.abs(uv_map.uv).max())
    if preset == "TILE":
        assert uv_map.tile_error() == 0
    else:
        assert uv_map.l2_stretch() < 1.05
        assert uv_map.uv.min() >= 0 and uv_map.uv.max() <= 1


def test_marked_cones_and_seams_are_kept(reports):
    cube = add_cone_cube()
    reports()
    unwrap(compact=False)
    assert "1 island, " in reports() and len(addon.mesh.reports.find(cube.data).cones) == 8
    assert UvMap(cube).scale_spread() < 1 + 1e-5
    one = add_sphere("One")
    bpy.ops.object.select_all(action="DESELECT")
    one.select_set(True)
    mark(one, [0])
    before = snapshot(one)
    unwrap()
    assert changed(before, snapshot(one)) == {uv_key()}
    assert 0 in {v for edge in UvMap(one).split_edges() for v in edge}


def test_placed_cones_are_marked_where_that_is_asked_for(reports):
    ball = add_ball()
    ball.vertex_groups.clear()
    unwrap(mark=True)
    placed = UvMap(ball)
    marked = [v.index for v in ball.data.vertices if v.groups]
    assert sorted(addon.mesh.reports.find(ball.data).cones) == marked
    # They and their angles are the ones that the map was made from.
    unwrap()
    again = UvMap(ball)
    assert again.split_edges() == placed.split_edges()
    assert again.l2_stretch() == pytest.approx(placed.l2_stretch(), abs=1e-5)


def test_pinned_islands_stay():
    grid = add_grid()
    unwrap()
    uv = UvMap(grid).uv
    loops = [0, len(uv) - 1]
    pin(grid, loops, uv[loops] * 0.5)
    unwrap()
    assert np.array_equal(UvMap(grid).uv[loops], (uv[loops] * 0.5).astype(np.float32))


def test_objects_are_packed_together_at_one_density():
    objects = [add_cube("Small"), add_cube("Scaled"), add_sphere("Sphere")]
    objects[1].scale = (3.0, 3.0, 3.0)
    objects[2].location.x = 9.0
    bpy.context.view_layer.update()
    unwrap()
    maps = [UvMap(obj) for obj in objects]
    densities = [
        np.sqrt(area_of(uv_map) / (obj.scale.x**2 * sum(face.area for face in obj.data.polygons)))
        for obj, uv_map in zip(objects, maps, strict=True)
    ]
    assert max(densities) / min(densities) < 1.01
    boxes = [(uv_map.uv.min(axis=0), uv_map.uv.max(axis=0)) for uv_map in maps]
    assert min(low.min() for low, _ in boxes) >= 0 and max(high.max() for _, high in boxes) <= 1
    assert covered_twice(maps) == 0


def area_of(uv_map):
    a, b, c = (uv_map.uv[uv_map.triangles[:, i]] @ (1, 1j) for i in range(3))
    return np.abs(((b - a).conj() * (c - a)).imag).sum() / 2


@pytest.mark.parametrize("margin", [4, *one_blender(32)])
@pytest.mark.parametrize("preset", ["PAINT", "BAKE"])
def test_the_margin_is_that_many_texels(preset, margin):
    for number in range(4):
        add_cube(f"Cube {number}", cuts=1)
    unwrap(preset=preset, margin=margin, texture_size="512")
    maps = [UvMap(obj) for obj in bpy.context.selected_objects]
    low, high = min(uv_map.uv.min() for uv_map in maps), max(uv_map.uv.max() for uv_map in maps)
    around = 512 * min(low, 1 - high)
    between = 512 * min(distance(first, second) for i, first in enumerate(maps) for second in maps[:i])
    if preset == "BAKE":
        assert around == pytest.approx(margin, rel=0.02)
        assert around >= margin * (1 - 1e-3)
    assert 0.6 * margin < around < 1.5 * margin
    # Both have theirs.
    assert between > 1.2 * margin


def add_strip(name="Strip"):
    """A grid twelve times as long as it is wide."""
    strip = add_grid(name, segments=24)
    for vertex in strip.data.vertices:
        vertex.co.x *= 12
    return strip


def test_bake_cuts_a_strip_so_that_it_fills_the_square():
    strip = add_strip()
    unwrap(preset="BAKE", compact=False)
    whole, covered = UvMap(strip).islands(), area_of(UvMap(strip))
    unwrap(preset="BAKE")
    uv_map = UvMap(strip)
    assert whole == 1 and uv_map.islands() > 2
    assert area_of(uv_map) > 0.5 > 3 * covered
    assert uv_map.l2_stretch() == pytest.approx(1, abs=1e-5)
    assert uv_map.sister_difference() <= UV_ROUNDING
    assert covered_twice([uv_map]) == 0
    unwrap(preset="PAINT")
    assert 1 < UvMap(strip).islands() <= uv_map.islands()
    unwrap(preset="PAINT", compact=False)
    assert UvMap(strip).islands() == 1


def test_what_counts_is_obeyed():
    strip = add_strip()
    islands = []
    for factor in (0, 1, 100):
        unwrap(fewer_islands=factor)
        islands.append(UvMap(strip).islands())
    assert islands == sorted(islands, reverse=True) and islands[0] > 1 == islands[-1]


def test_paint_leaves_parts_with_marked_seams_whole():
    strip = add_strip()
    unwrap()
    assert UvMap(strip).islands() > 1
    mark_seams(strip, [next(iter(UvMap(strip).sides))])
    unwrap()
    assert UvMap(strip).islands() == 1


def test_what_is_packed_beside_much_else_stays_whole():
    strip, cube = add_strip(), add_cube(cuts=1)
    cube.scale = (8, 8, 8)
    bpy.context.view_layer.update()
    unwrap(preset="BAKE")
    assert UvMap(strip).islands() == 1


def distance(first, second):
    """The least one of the edges of two maps, by samples along them."""
    places = []
    for uv_map in (first, second):
        ends = uv_map.uv[np.array(list(uv_map.sides.values())).reshape(-1, 2)] @ (1, 1j)
        places.append((ends[:, :1] + (ends[:, 1:] - ends[:, :1]) * np.linspace(0, 1, 20)).ravel())
    return np.abs(places[0][:, None] - places[1]).min()


def test_selected_faces_only_are_unwrapped():
    grid = add_grid(segments=6)
    chosen = [face.index for face in grid.data.polygons if face.center.x < 0]
    loops = np.isin(np.arange(len(grid.data.loops)), [i for f in chosen for i in grid.data.polygons[f].loop_indices])
    before = UvMap(grid).uv
    edit(grid)
    select_elements(grid, "faces", chosen)
    unwrap()
    assert np.array_equal(UvMap(grid).uv[~loops], before[~loops])
    assert not np.array_equal(UvMap(grid).uv[loops], before[loops])


def test_tiles_are_as_many_as_asked_for(reports):
    add_cone_cube()
    reports()
    unwrap(preset="TILE", tile_fit="TILES", tiles=12.0)
    assert "12 tiles across" in reports()


@pytest.mark.one_blender
@pytest.mark.parametrize(("stack", "islands"), [("NONE", 3), ("SAME", 2), ("MIRRORED", 1)])
def test_islands_of_one_shape_lie_on_each_other(stack, islands, reports):
    places = np.array([[0, 0, 0], [2, 0, 0], [1.5, 1, 0], [0.2, 2, 0]])
    objects = [
        add_flat("A", places),
        add_flat("B", places + np.array([9, 0, 0])),
        add_flat("C", places[[0, 3, 2, 1]] * np.array([-1, 1, 1])),
    ]
    for obj in objects:
        obj.select_set(True)
    reports()
    unwrap(preset="BAKE", stack=stack)
    told = reports()
    corners = {tuple(sorted(map(tuple, UvMap(obj).uv.round(5).tolist()))) for obj in objects}
    assert len(corners) == islands
    assert (f"{3 - islands} islands stacked" if islands == 1 else "1 island stacked") in told or islands == 3
    assert all(UvMap(obj).overlapping() == set() for obj in objects)


def add_flat(name, places):
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(places.tolist(), [], [list(range(len(places)))])
    obj = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(obj)
    bpy.context.view_layer.objects.active = obj
    return obj


def test_automatic_tiles_have_one_size_in_the_world():
    small, large = add_sphere("Small"), add_ball("Large")
    large.scale = 3, 3, 3
    bpy.context.view_layer.update()
    density = {}
    for chosen in ([small], [large], [small, large]):
        bpy.ops.object.select_all(action="DESELECT")
        for obj in chosen:
            obj.select_set(True)
        bpy.context.view_layer.objects.active = chosen[0]
        unwrap(preset="TILE")
        assert all(UvMap(obj).tile_error() == 0 for obj in chosen)
        for obj in chosen:
            density.setdefault(obj, []).append(tiles_along_a_unit(obj))
    alone = [of_object[0] for of_object in density.values()]
    assert max(alone) > 1.3 * min(alone)
    # Rounding to whole tiles changes the sizes by little.
    together = [of_object[1] for of_object in density.values()]
    assert together == pytest.approx([max(alone)] * 2, rel=0.1)


def test_small_objects_do_not_make_the_tiles_of_others_small(reports):
    small, large = add_ball("Small"), add_ball("Large")
    small.scale = 0.01, 0.01, 0.01
    bpy.context.view_layer.update()
    bpy.ops.object.select_all(action="DESELECT")
    large.select_set(True)
    unwrap(preset="TILE")
    alone = tiles_along_a_unit(large)
    small.select_set(True)
    reports()
    unwrap(preset="TILE")
    assert tiles_along_a_unit(large) == pytest.approx(alone, rel=0.1)
    times = float(re.search(r"Tiles are ([\d.e+]+) times smaller than on the other objects", reports())[1])
    assert tiles_along_a_unit(small) == pytest.approx(times * alone, rel=0.2)
    assert UvMap(small).tile_error() == UvMap(large).tile_error() == 0


def test_small_objects_without_cuts_have_tiles_as_large_as_others_and_the_layout_stays_small(reports):
    ball, plates = add_ball("Ball"), [add_grid(f"Plate {number}") for number in range(3)]
    for plate in plates:
        plate.scale = 0.02, 0.02, 0.02
    bpy.context.view_layer.update()
    bpy.ops.object.select_all(action="DESELECT")
    ball.select_set(True)
    unwrap(preset="TILE")
    alone = tiles_along_a_unit(ball)
    for plate in plates:
        plate.select_set(True)
    reports()
    unwrap(preset="TILE")
    said = reports()
    assert "times smaller" not in said
    density = [tiles_along_a_unit(obj) for obj in (ball, *plates)]
    assert density == pytest.approx([alone] * 4, rel=0.15)
    sizes = [float(size) for size in re.findall(r"tiles of ([\d.]+) m", said)]
    assert sizes == pytest.approx([1 / alone] * 4, rel=0.15)
    low, high = (np.array([getattr(UvMap(obj).uv, side)(axis=0) for obj in (ball, *plates)]) for side in ("min", "max"))
    # It begins at the origin.
    assert (low.min(axis=0) >= 0).all()
    assert (low.min(axis=0) < 1).all()
    assert (high.max(axis=0) < 4 * np.ptp(UvMap(ball).uv, axis=0).max()).all()


def test_what_is_scaled_to_nothing_does_not_decide_the_size_of_tiles():
    nothing, small, large = add_ball("Nothing"), add_ball("Small"), add_ball("Large")
    nothing.scale, large.scale = (0, 0, 0), (2, 2, 2)
    bpy.context.view_layer.update()
    bpy.ops.object.select_all(action="SELECT")
    unwrap(preset="TILE")
    assert tiles_along_a_unit(large) == pytest.approx(tiles_along_a_unit(small), rel=0.1)
    assert UvMap(small).tile_error() == UvMap(large).tile_error() == 0


def tiles_along_a_unit(obj):
    uv_map, world = UvMap(obj), np.array(obj.matrix_world)[:3, :3]
    loops = uv_map.triangles
    u, v = (uv_map.uv[loops][:, k] - uv_map.uv[loops][:, 0] for k in (1, 2))
    places = uv_map.positions[uv_map.vertex[loops]] @ world.T
    sides = [places[:, k] - places[:, 0] for k in (1, 2)]
    area = np.linalg.norm(np.cross(*sides), axis=1).sum()
    return np.sqrt(np.abs(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]).sum() / area)


def test_a_seam_is_an_open_border_where_that_is_asked_for():
    cube = add_cube()
    for edge in cube.data.edges:
        edge.use_seam = all(abs(cube.data.vertices[v].co.z) < 1e-6 for v in edge.vertices)
    seams = {tuple(sorted(edge.vertices)) for edge in cube.data.edges if edge.use_seam}
    unwrap(seams="BOUNDARY")
    assert seams and seams <= UvMap(cube).split_edges()


def test_cones_come_from_the_group_that_is_named():
    cube = add_cube()
    mark(cube, corners(cube), group="points")
    unwrap(vertex_group="points")
    assert len(addon.mesh.reports.find(cube.data).cones) == 8


def test_a_stretched_map_through_no_cones_is_told_with_a_remedy(reports):
    def open_ball(b):
        bmesh.ops.create_icosphere(b, subdivisions=2, radius=1.0)
        bmesh.ops.delete(b, geom=[next(iter(b.faces))], context="FACES_ONLY")

    add_object("Ball", open_ball)
    reports()
    assert bpy.ops.uv.cone_unwrap(pack=False) == {"FINISHED"}
    said = reports()
    assert UvMap(bpy.context.object).l2_stretch() > 1.5
    (warning,) = (line for line in said.splitlines() if line.startswith("Warning"))
    assert "No cones are marked" in warning and "Auto Unwrap" in warning
    # The number is the one of the map.
    assert f"{UvMap(bpy.context.object).l2_stretch():.3g}, 1 being none" in warning
    unwrap()
    said = reports()
    assert UvMap(bpy.context.object).l2_stretch() < 1.1
    assert "Warning" not in said


@pytest.mark.parametrize(("sides", "height", "is_seen"), [(4, 3.0, False), (3, 0.3, True)])
def test_a_stretch_that_nobody_sees_is_not_told(sides, height, is_seen, reports):
    """Cones are placed for a stretch of 1.05, which no artist chose; a pyramid has room for hardly any."""
    bpy.ops.mesh.primitive_cone_add(vertices=sides, radius1=1.0, depth=height)
    reports()
    unwrap(preset="TILE", creases=False)
    assert ("was asked for" in reports()) == is_seen
    assert (UvMap(bpy.context.object).l2_stretch() > 1.1) == is_seen


def test_a_flat_surface_needs_no_cones_and_nothing_is_said(reports):
    add_grid()
    reports()
    assert bpy.ops.uv.cone_unwrap() == {"FINISHED"}
    assert "Warning" not in reports()


def test_an_island_that_is_alone_is_as_large_as_it_can_be():
    cube = add_cone_cube()
    unwrap(margin=16, texture_size="1024", compact=False)
    uv_map = UvMap(cube)
    # Six squares, four of them in a row in some nets.
    side = (1 - 2 * 16 / 1024) / 4
    assert area_of(uv_map) >= 6 * side**2 * (1 - 1e-3)
    assert uv_map.uv.min() == pytest.approx(16 / 1024, abs=1e-6)
    # As its sides lie along the axes it was turned by quarters alone; slanted, it may be turned until it is largest.
    turn = np.array([[np.cos(0.7), np.sin(0.7)], [-np.sin(0.7), np.cos(0.7)]])
    islands = addon.core.islands.Islands(
        uv_map.vertex[uv_map.triangles].astype(np.int32),
        uv_map.uv[uv_map.triangles] @ turn,
        np.zeros(len(uv_map.triangles), np.int32),
        np.zeros((len(uv_map.triangles), 3), bool),
        1.0,
    )
    (packed,) = addon.jobs.layouts.packing.pack([islands], 16 / 1024)
    assert np.ptp(packed.reshape(-1, 2), axis=0).max() == pytest.approx(1 - 32 / 1024, abs=1e-6)
    first, second = packed[:, 1] - packed[:, 0], packed[:, 2] - packed[:, 0]
    area = np.abs(first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]).sum() / 2
    turns = np.exp(1j * np.linspace(0, np.pi / 2, 900))
    turned = turns[:, None] * (uv_map.uv @ (1, 1j))
    box = np.maximum(np.ptp(turned.real, axis=1), np.ptp(turned.imag, axis=1)).min()
    assert area == pytest.approx(area_of(uv_map) * ((1 - 32 / 1024) / box) ** 2, rel=5e-3)


@pytest.mark.all_tries
def test_an_island_that_is_alone_is_turned_on_its_image():
    grid = add_grid()
    for vertex in grid.data.vertices:
        vertex.co.x *= 4
    add_texture(grid, 64, 256)
    unwrap(margin=0)
    # The strip stands upright in the tall image, which it fills.
    assert np.ptp(UvMap(grid).uv, axis=0) == pytest.approx([1.0, 1.0], abs=1e-3)


@pytest.mark.slow
@pytest.mark.one_blender
def test_cuts_keep_out_of_sight_from_the_front():
    bpy.ops.mesh.primitive_monkey_add()
    monkey = bpy.context.object
    monkey.modifiers.new("Subdivision", "SUBSURF").levels = 1
    bpy.ops.object.modifier_apply(modifier="Subdivision")
    face = []
    for turn, cuts in ((0.0, "FRONT"), (np.pi, "FRONT"), (0.0, "SHORTEST")):
        monkey.rotation_euler = (0.0, 0.0, turn)
        bpy.context.view_layer.update()
        unwrap(cuts=cuts)
        uv_map = UvMap(monkey)
        edges = np.array(sorted(uv_map.split_edges()))
        ends = uv_map.positions[edges]
        lengths = np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1)
        normals = np.array([vertex.normal[:] for vertex in monkey.data.vertices])[edges].mean(axis=1)
        # Suzanne looks along -Y, to who looks at the front.
        face.append(lengths[normals[:, 1] < -0.5].sum())
    # Cones on the face need cuts there, too.
    assert face[0] < 0.9 * face[2]
    # Turned round, it is the back of the head that is seen.
    assert face[0] < 0.9 * face[1]


@pytest.mark.parametrize("preset", ["PAINT", "BAKE"])
@pytest.mark.parametrize("straighten", [True, False])
def test_the_sides_of_a_domed_panel_are_made_straight(straighten, preset):
    panel = add_grid(segments=10)
    for vertex in panel.data.vertices:
        vertex.co.z = 0.15 * np.cos(np.pi / 2 * vertex.co.x) * np.cos(np.pi / 2 * vertex.co.y)
    unwrap(preset=preset, straighten=straighten)
    uv = UvMap(panel)
    off_axis = np.abs(np.remainder(uv.border_directions() + np.pi / 4, np.pi / 2) - np.pi / 4)
    assert off_axis.max() < 1e-5 if straighten else off_axis.max() > 1e-3
    assert uv.l2_stretch() < 1.01


@pytest.mark.parametrize(("creases", "islands"), [(True, 3), (False, 1)])
def test_a_cylinder_ends_at_its_rims(creases, islands):
    """A rectangle and two disks without stretch; continuing across the rims would take a cone at each vertex there."""
    bpy.ops.mesh.primitive_cylinder_add(vertices=32)
    cylinder = bpy.context.active_object
    unwrap(creases=creases, mark=True, compact=False)
    uv = UvMap(cylinder)
    assert uv.islands() == islands
    assert bool(marked(cylinder)) != creases
    shown = {tuple(sorted(edge)) for path in addon.mesh.reports.find(cylinder.data).paths for edge in pairwise(path)}
    assert shown == uv.split_edges()
    assert covered_twice([uv]) == 0
    if creases:
        assert uv.l2_stretch() == pytest.approx(1, abs=1e-5)


def placed(**options):
    """The number of cones in the report, and the stretch of the map."""
    unwrap(creases=False, **options)
    mapped = bpy.context.object
    return len(addon.mesh.reports.find(mapped.data).cones), UvMap(mapped).l2_stretch()


def test_as_many_cones_are_placed_as_asked_for():
    add_sphere()
    assert placed(count=6)[0] == 6
    assert placed(count=11)[0] == 11
    assert placed(count=0) == placed()


def test_less_stretch_takes_more_cones():
    add_sphere()
    (few, most), (usual, _), (many, least) = (placed(target=target) for target in (1.3, 1.05, 1.02))
    assert few < usual < many
    assert least < most


def test_the_usual_target_is_that_of_the_library(reports):
    add_sphere()
    unwrap(creases=False)
    usual = UvMap(bpy.context.object).uv
    addon.jobs.layouts.remembered.forget()
    unwrap(creases=False, target=addon.jobs.tasks.unwrapping.USUAL_TARGET)
    assert np.array_equal(UvMap(bpy.context.object).uv, usual)


@pytest.mark.one_blender
def test_islands_inside_are_smaller(reports):
    """Of two balls in one object, the one in the other."""
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=3)
    obj = bpy.context.object
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=3, radius=0.5)
    obj.select_set(True)
    bpy.context.view_layer.objects.active = obj
    bpy.ops.object.join()

    def share_inside(**options):
        unwrap(preset="BAKE", **options)
        mesh, found = obj.data, UvMap(obj)
        areas = np.zeros(2)
        for polygon in mesh.polygons:
            u, v = found.uv[polygon.loop_start : polygon.loop_start + polygon.loop_total].T
            area = abs(u @ np.roll(v, -1) - v @ np.roll(u, -1)) / 2
            areas[int(np.linalg.norm(polygon.center) < 0.6)] += area
        return areas[1] / areas[0]

    usual = share_inside()
    assert "inside" not in reports()
    assert share_inside(inside=0.5) == pytest.approx(usual / 4, rel=1e-3)
    assert "inside smaller" in reports()
