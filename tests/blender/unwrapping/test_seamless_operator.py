# SPDX-License-Identifier: GPL-3.0-or-later
"""Seamless layouts as Blender stores them: both sides of every cut match to the last bit, also on moved islands."""

import re

import bpy
import numpy as np
import pytest
from installed import addon
from logged import refused
from scenes import (
    UvMap,
    add_ball,
    add_cone_cube,
    add_sphere,
    add_texture,
    changed,
    edit,
    joined,
    pin,
    plain_copy,
    set_uv,
    snapshot,
    uv_key,
)

BUILDERS = {"cube": add_cone_cube, "ball": add_ball}


@pytest.fixture(params=BUILDERS)
def solid(request):
    return BUILDERS[request.param]()


def active_uv(obj):
    """(l, 2) float32, as stored."""
    mesh = plain_copy(obj)
    uv = np.empty((len(mesh.loops), 2), np.float32)
    mesh.uv_layers[obj.data.uv_layers.active.name].uv.foreach_get("vector", uv.ravel())
    bpy.data.meshes.remove(mesh)
    return uv


def island_loops(obj):
    """The loops of every island of the map, in the order of their first loop."""
    uv_map = UvMap(obj)
    islands = {}
    for face, island in enumerate(uv_map.island_of_face()):
        islands.setdefault(island, []).extend(uv_map.loops_of_face[face])
    return [np.array(sorted(loops)) for loops in sorted(islands.values())]


def box(uv):
    return np.concatenate([uv.min(axis=0), uv.max(axis=0)])


def apart(first, second):
    """True where two boxes have no inner point in common."""
    return bool((np.maximum(first[:2] - second[2:], second[:2] - first[2:]) >= 0).any())


def extent(obj):
    return float(np.ptp(active_uv(obj), axis=0).max())


def unwrap(**options):
    assert bpy.ops.uv.cone_unwrap(**{"seamless": True, "tile_fit": "TILES", "tiles": 24.0, **options}) == {"FINISHED"}


# --- exact ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("in_edit_mode", [True, False])
@pytest.mark.parametrize("options", [{"tile_fit": "AUTO"}, {"tiles": 16.0}, {"tiles": 300.0}], ids=str)
def test_both_sides_of_every_cut_match_to_the_last_bit(solid, options, in_edit_mode):
    if in_edit_mode:
        edit(solid)
    before = snapshot(solid)
    unwrap(**options)
    assert changed(before, snapshot(solid)) == {uv_key()}
    uv_map = UvMap(solid)
    assert len(uv_map.split_edges()) >= 7
    assert uv_map.tile_error() == 0
    assert uv_map.islands() == 1
    turns = {turn for turn, _, _ in uv_map.crossings()}
    assert len(turns) > 1


def test_unwrapping_without_seamless_does_not_match_tiles(solid):
    unwrap(seamless=False)
    assert UvMap(solid).tile_error() > 1e-3


def test_stripes_are_turned_by_halves_only():
    ball = add_ball()
    unwrap(lattice="STRIPE")
    uv_map = UvMap(ball)
    assert uv_map.tile_error(rotation_order=2) == 0
    assert {turn for turn, _, _ in uv_map.crossings(2)} <= {1, -1}


@pytest.mark.parametrize(("lattice", "rotation_order"), [("TRIANGLE", 3), ("HEXAGON", 6)])
def test_triangles_match_to_the_last_digit(lattice, rotation_order):
    ball = add_ball()
    unwrap(lattice=lattice)
    last_digit = float(np.spacing(np.float32(np.abs(active_uv(ball)).max())))
    uv_map = UvMap(ball)
    assert uv_map.tile_error(rotation_order) <= 4 * last_digit
    assert uv_map.tile_error(4) > 1e-3


def test_checker_matches_with_parity():
    ball = add_ball()
    unwrap(parity=True)
    uv_map = UvMap(ball)
    assert uv_map.tile_error() == 0
    # A quarter turn about the corner of a square swaps the colors as an odd shift does; both or neither.
    compared = 0
    for edge in uv_map.split_edges():
        left, right = (uv_map.uv[list(loops)] for loops in uv_map.sides[edge])
        for part in np.linspace(0.05, 0.95, 19):
            places = [(1 - part) * ends[0] + part * ends[1] for ends in (left, right)]
            if min(np.abs(place - np.round(place)).min() for place in places) > 1e-3:
                assert len({int(np.floor(place).sum()) % 2 for place in places}) == 1
                compared += 1
    assert compared > 100


def test_parity_has_no_say_without_squares():
    ball = add_ball()
    unwrap(lattice="STRIPE")
    plain = active_uv(ball)
    unwrap(lattice="STRIPE", parity=True)
    assert active_uv(ball).tobytes() == plain.tobytes()


def test_islands_of_one_object_have_tiles_of_one_size_and_lie_apart():
    ball, larger = add_ball(), add_ball("Larger")
    larger.scale = (2.0, 2.0, 2.0)
    for obj in (larger, ball):
        obj.select_set(True)
        bpy.context.view_layer.objects.active = obj
    bpy.ops.object.join()
    unwrap(tiles=60.0)
    islands = island_loops(ball)
    assert len(islands) == 2
    boxes = [box(active_uv(ball)[loops]) for loops in islands]
    assert apart(*boxes)
    assert UvMap(ball).tile_error() == 0
    sides = [(part[2:] - part[:2]).max() for part in boxes]
    assert max(sides) / min(sides) == pytest.approx(2.0, rel=0.3)


# --- tiles ----------------------------------------------------------------------------------------------------------


def test_count_is_of_tiles_along_the_longer_side(solid):
    for tiles in (20.0, 80.0):
        unwrap(tiles=tiles)
        assert extent(solid) == pytest.approx(tiles, rel=0.2)


def mean_scale(obj):
    """Tiles per unit of length, over all edges of the mesh."""
    uv_map = UvMap(obj)
    flat = space = 0.0
    for loops in uv_map.loops_of_face:
        following = loops[1:] + loops[:1]
        flat += (np.linalg.norm(uv_map.uv[loops] - uv_map.uv[following], axis=1) ** 2).sum()
        ends = uv_map.positions[uv_map.vertex[loops]], uv_map.positions[uv_map.vertex[following]]
        space += (np.linalg.norm(ends[0] - ends[1], axis=1) ** 2).sum()
    return float(np.sqrt(flat / space))


def test_size_is_of_the_surface_as_the_object_is_scaled():
    ball = add_ball()
    unwrap(tile_fit="SIZE", tile_size=0.1)
    assert mean_scale(ball) == pytest.approx(10.0, rel=0.1)
    ball.scale = (2.0, 2.0, 2.0)
    bpy.context.view_layer.update()
    unwrap(tile_fit="SIZE", tile_size=0.1)
    assert mean_scale(ball) == pytest.approx(20.0, rel=0.1)
    unwrap(tile_fit="SIZE", tile_size=0.2)
    assert mean_scale(ball) == pytest.approx(10.0, rel=0.1)


@pytest.mark.parametrize("scale", [1.0, 2.0])
def test_how_far_tiles_are_from_the_chosen_size_is_told_once(scale):
    """An edge of the cube is 2 long, and cones are at its ends."""
    cube = add_cone_cube()
    cube.scale = (scale, scale, scale)
    bpy.context.view_layer.update()
    told = []
    for size in (1.0, 0.95, 1.5, 0.3, 3.0):
        unwrap(tile_fit="SIZE", tile_size=size * scale)
        tiles = 2 * mean_scale(cube)
        assert tiles == pytest.approx(round(tiles), rel=1e-5)
        said = [finding.text for finding in addon.core.findings.last(cube) if "size chosen" in finding.text]
        exactly = 100 * (2 / tiles / size - 1)
        larger = round(exactly)
        told.append(larger)
        if abs(exactly) < 1:
            assert not said
            continue
        (text,) = said
        assert f"{abs(larger)} % {'larger' if larger > 0 else 'smaller'} on the surface" in text
        assert not re.search("grid of .* cells", " ".join(f.text for f in addon.core.findings.last(cube)))
    assert told[:2] == [0, 5] and abs(told[2]) > 10 and 0 < abs(told[3]) <= 10 and told[4] == -33


def test_no_tile_has_a_size_on_what_is_scaled_to_nothing():
    cube = add_cone_cube()
    cube.scale = (0.0, 0.0, 0.0)
    bpy.context.view_layer.update()
    before = snapshot(cube)
    with pytest.raises(RuntimeError, match="Cube: the object is scaled to zero"):
        bpy.ops.uv.cone_unwrap(seamless=True, tile_fit="SIZE")
    assert changed(before, snapshot(cube)) == set()
    unwrap()


@pytest.mark.parametrize(("size", "levels", "cell"), [("1024", 6, 2**-4), ("256", 0, 2**-8), ("64", 9, 1.0)])
def test_mip_safe_tiles_are_whole_texels(solid, size, levels, cell):
    unwrap(mip_safe=True, texture_size=size, mip_levels=levels)
    assert UvMap(solid).tile_error(cell=cell) == 0
    assert extent(solid) == pytest.approx(24 * cell, rel=0.2)


def test_same_input_same_bytes(solid):
    unwrap()
    first = active_uv(solid)
    unwrap()
    assert active_uv(solid).tobytes() == first.tobytes()


# --- moved by whole tiles only --------------------------------------------------------------------------------------


@pytest.mark.parametrize("in_edit_mode", [True, False])
@pytest.mark.parametrize("away", [(3.3, -2.2), (-700.4, 5000.1)])
def test_islands_keep_their_place_by_whole_tiles(solid, away, in_edit_mode):
    unwrap()
    plain = active_uv(solid).astype(float)
    set_uv(solid, plain + away)
    if in_edit_mode:
        edit(solid)
    unwrap(keep_placement=True)
    moved = active_uv(solid)
    # Thousands of tiles away, single precision resolves no more than this.
    rounding = 2 * float(np.spacing(np.float32(2 * np.abs(moved).max())))
    assert np.abs(moved - plain - np.round(away)).max() <= rounding
    assert UvMap(solid).tile_error() == 0
    unwrap(keep_placement=True)
    assert active_uv(solid).tobytes() == moved.tobytes()


@pytest.mark.parametrize("value", [0.0, np.nan])
def test_without_usable_old_coordinates_tiles_still_match(solid, value):
    set_uv(solid, np.full((len(solid.data.loops), 2), value))
    unwrap(keep_placement=True)
    assert np.isfinite(active_uv(solid)).all()
    assert UvMap(solid).tile_error() == 0


def test_checker_stays_as_it_is_where_an_island_is_moved():
    ball = add_ball()
    unwrap(parity=True)
    plain = active_uv(ball).astype(float)
    set_uv(ball, plain + np.array([3.1, 0.9]))
    unwrap(parity=True, keep_placement=True)
    assert np.abs(active_uv(ball) - plain - (4.0, 0.0)).max() <= 1e-5


def test_aspect_of_the_image_has_no_say(solid):
    unwrap()
    plain = active_uv(solid)
    add_texture(solid, 64, 16)
    unwrap(correct_aspect=True)
    assert active_uv(solid).tobytes() == plain.tobytes()


def many_parts():
    """Two objects: a ball; a ball and two cubes in one."""
    parts = add_ball("Parts")
    add_cone_cube("Fine", cuts=5)
    add_cone_cube("Coarse", cuts=1)
    parts.select_set(True)
    bpy.context.view_layer.objects.active = parts
    bpy.ops.object.join()
    first = add_ball("First")
    parts.select_set(True)
    return [first, parts]


@pytest.mark.parametrize("in_edit_mode", [True, False])
@pytest.mark.parametrize("build", ["cubes", "parts"])
def test_objects_are_packed_by_whole_tiles(build, in_edit_mode):
    objects = [add_cone_cube(f"Cube {i}", cuts=1) for i in range(7)] if build == "cubes" else many_parts()
    unwrap()
    plain = [active_uv(obj).astype(float) for obj in objects]
    islands = [island_loops(obj) for obj in objects]
    assert sum(map(len, islands)) == (7 if build == "cubes" else 4)
    if in_edit_mode:
        edit(*objects)
    before = [snapshot(obj) for obj in objects]
    unwrap(pack=True, margin=0.2)
    assert all(changed(b, snapshot(obj)) <= {uv_key()} for b, obj in zip(before, objects, strict=True))
    boxes = []
    for obj, uv, parts in zip(objects, plain, islands, strict=True):
        packed = active_uv(obj).astype(float)
        for loops in parts:
            shift = packed[loops] - uv[loops]
            assert np.abs(shift - np.round(shift[0])).max() <= 2 * np.spacing(np.float32(2 * np.abs(packed).max()))
            boxes.append(box(packed[loops]))
        assert UvMap(obj).tile_error() == 0
    assert all(apart(a, b) for i, a in enumerate(boxes) for b in boxes[:i])
    assert min(part.min() for part in boxes) >= 0
    # A square would do, were there no steps and gaps.
    area = sum((part[2] - part[0]) * (part[3] - part[1]) for part in boxes)
    assert max(part.max() for part in boxes) <= max(
        2.0 * np.sqrt(area), max(np.ptp(p, axis=0).max() for p in plain) + 2
    )


def test_the_old_place_goes_before_packing():
    cubes = [add_cone_cube("One"), add_cone_cube("Two")]
    unwrap(pack=True)
    for cube in cubes:
        set_uv(cube, active_uv(cube) + np.float32(50))
    moved = [active_uv(cube) for cube in cubes]
    unwrap(pack=True, keep_placement=True)
    assert [active_uv(cube).tobytes() for cube in cubes] == [uv.tobytes() for uv in moved]


# --- what is said and refused ---------------------------------------------------------------------------------------


def test_report_says_tiles_cuts_and_that_they_are_exact(reports):
    cube = add_cone_cube()
    reports()
    unwrap(tiles=24.0)
    said = reports()
    # Eight cones on a tree of seven paths, unless some of those pass through a cone on their way.
    assert "Cube: 1 island, " in said
    assert "24 tiles across, 7 cuts, all exact" in said
    unwrap(seamless=False)
    assert "tiles" not in reports()
    assert UvMap(cube).islands() == 1


def test_report_of_triangles_speaks_of_rounding(reports):
    add_ball()
    reports()
    unwrap(lattice="HEXAGON")
    assert "cuts, all exact up to the rounding of UVs" in reports()


@pytest.mark.parametrize("in_edit_mode", [True, False])
def test_pins_are_refused_by_name_and_nothing_changes(solid, in_edit_mode):
    pin(solid, [0, 9], np.array([[0.0, 0.0], [1.0, 0.5]]))
    if in_edit_mode:
        edit(solid)
    before = snapshot(solid)
    with refused("PINS_CONFLICT", rf"{solid.name}: "):
        bpy.ops.uv.cone_unwrap(seamless=True)
    assert changed(before, snapshot(solid)) == set()
    unwrap(use_pins=False)
    assert UvMap(solid).tile_error() == 0


@pytest.mark.parametrize(
    "options",
    [{"tile_fit": "TILES", "tiles": np.nan}, {"tile_fit": "SIZE", "tile_size": np.nan}],
    ids=["tiles", "size"],
)
def test_no_number_is_refused_by_name(solid, options):
    before = snapshot(solid)
    with refused("WRONG_PARAMETER"):
        bpy.ops.uv.cone_unwrap(seamless=True, **options)
    assert changed(before, snapshot(solid)) == set()


def test_surface_without_such_a_layout_is_refused_by_name():
    ball = add_ball()
    before = snapshot(ball)
    with refused("SEAMLESS_IMPOSSIBLE", r"Ball: "):
        bpy.ops.uv.cone_unwrap(seamless=True, lattice="TRANSLATION")
    assert changed(before, snapshot(ball)) == set()


@pytest.mark.parametrize("pack", [True, False])
def test_one_failure_does_not_stop_the_others(pack):
    bad, good = add_sphere("Bad"), add_cone_cube("Good")
    before = snapshot(bad)
    unwrap(pack=pack)
    assert changed(before, snapshot(bad)) == set()
    assert UvMap(good).tile_error() == 0
    assert extent(good) > 10


def test_a_part_that_is_smaller_than_a_tile_is_told(reports):
    cube, small = add_cone_cube(), add_cone_cube("Small")
    for vertex in small.data.vertices:
        vertex.co *= 0.01
    joined(cube, small)
    reports()
    unwrap(tiles=4.0)
    assert re.search(r"Tiles are up to [\d.]+ times smaller than elsewhere on 1 component", reports())
