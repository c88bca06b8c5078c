# SPDX-License-Identifier: GPL-3.0-or-later
"""Auto Unwrap and Unwrap from Cones at a texel density: the measured density, and layouts that do not fit."""

import math

import bpy
import numpy as np
import pytest
from scenes import UvMap, add_ball, add_cone_cube, add_cube, add_texture, changed, covered_twice, snapshot


def density(obj, side):
    """Texels per unit of length in the world of a uniformly scaled object, by areas of its triangles."""
    uv_map = UvMap(obj)
    places = uv_map.positions[uv_map.vertex[uv_map.triangles]] * obj.scale.x
    area = np.linalg.norm(np.cross(places[:, 1] - places[:, 0], places[:, 2] - places[:, 0]), axis=1).sum() / 2
    return side * math.sqrt(np.abs(uv_map._areas()).sum() / area)


def cubes(number):
    made = [add_cube(f"Cube {i}", cuts=1) for i in range(number)]
    made[-1].scale = (2, 2, 2)
    bpy.context.view_layer.update()
    return made


def unwrap(**options):
    return bpy.ops.uv.cone_auto_unwrap(**{"scale": "DENSITY", "texture_size": "512", "margin": 4} | options)


@pytest.mark.parametrize("preset", ["PAINT", "BAKE"])
@pytest.mark.parametrize("number, asked, udim, tiles", [(4, 18, 1, 1), (4, 18, 4, 1), (10, 31, 4, 2)])
def test_all_objects_get_the_density_in_as_few_tiles_as_hold_them(preset, number, asked, udim, tiles):
    """At 31 any net of the largest cube, 16 units long at most, has room in a tile, and all ten cubes have not."""
    objects = cubes(number)
    assert unwrap(preset=preset, density=asked, udim=udim) == {"FINISHED"}
    assert [density(obj, 512) for obj in objects] == pytest.approx([asked] * number, rel=1e-4)
    maps = [UvMap(obj) for obj in objects]
    used = set()
    for uv_map in maps:
        island = np.array(uv_map.island_of_face())[uv_map.face_of_triangle]
        for number in set(island):
            uv = uv_map.uv[uv_map.triangles[island == number]].reshape(-1, 2)
            tile = np.floor(uv.mean(axis=0))
            used.add(tuple(tile.astype(int).tolist()))
            assert (uv - tile >= 4 / 512 - 1e-6).all() and (uv - tile <= 1 - 4 / 512 + 1e-6).all()
    assert used <= {(column, 0) for column in range(udim)} and (len(used) == 1) == (tiles == 1)
    if tiles == 1:
        assert covered_twice(maps) == 0


def test_what_the_tiles_do_not_hold_is_refused_with_their_number():
    objects = cubes(10)
    before = [snapshot(obj) for obj in objects]
    with pytest.raises(RuntimeError, match=r"the islands take \d tiles of 512 x 512 texels, and there is 1"):
        unwrap(density=31)
    assert [changed(one, snapshot(obj)) for one, obj in zip(before, objects, strict=True)] == [set()] * 10


def test_the_density_is_that_of_the_scene_in_its_unit_where_none_is_given():
    cube = add_cone_cube()
    bpy.context.scene.cone_unwrap_texels.density = 2
    bpy.context.scene.unit_settings.length_unit = "CENTIMETERS"
    unwrap(texture_size="4096", udim=4, compact=False)
    assert density(cube, 4096) == pytest.approx(200, rel=1e-4)


@pytest.mark.parametrize("operator", ["cone_auto_unwrap", "cone_unwrap"])
def test_tiles_are_a_whole_texture_at_the_density(operator):
    cube = add_cone_cube()
    cube.scale = (1.5, 1.5, 1.5)
    bpy.context.view_layer.update()
    options = {"cone_auto_unwrap": {"preset": "TILE"}, "cone_unwrap": {"seamless": True}}[operator]
    # Four tiles along an edge of three: nothing has to be rounded.
    asked = 4 * 2048 / 3
    run = getattr(bpy.ops.uv, operator)
    assert run(tile_fit="DENSITY", density=asked, texture_size="2048", **options) == {"FINISHED"}
    assert density(cube, 2048) == pytest.approx(asked, rel=1e-5)
    assert UvMap(cube).tile_error() == 0


def test_an_image_that_is_not_square_has_no_one_density():
    ball = add_ball()
    add_texture(ball, 64, 256)
    with pytest.raises(RuntimeError, match="the image is not square"):
        unwrap(density=10)


@pytest.mark.parametrize(
    "preset, options",
    [("PAINT", {}), ("BAKE", {"udim": 2}), ("BAKE", {"scale": "DENSITY", "density": 20, "udim": 4})],
    ids=["one tile", "tiles", "density"],
)
def test_an_object_has_as_many_times_the_density_of_others_as_its_weight_says(preset, options):
    plain, fine, coarse = cubes(3)
    fine.cone_unwrap_density_weight, coarse.cone_unwrap_density_weight = 2, 0.5
    assert unwrap(preset=preset, **({"scale": "FILL"} | options)) == {"FINISHED"}
    found = np.array([density(obj, 512) for obj in (plain, fine, coarse)])
    assert found / found[0] == pytest.approx([1, 2, 0.5], rel=1e-4)
    if options.get("scale") == "DENSITY":
        assert found[0] == pytest.approx(20, rel=1e-4)


@pytest.mark.parametrize("tiles", [{"tile_fit": "DENSITY", "density": 512}, {"tile_fit": "AUTO"}])
def test_tiles_are_as_many_times_smaller_as_the_weight_of_an_object_says(tiles):
    plain, fine = add_cone_cube("Plain"), add_cone_cube("Fine")
    fine.cone_unwrap_density_weight = 2
    assert bpy.ops.uv.cone_auto_unwrap(preset="TILE", texture_size="1024", **tiles) == {"FINISHED"}
    assert density(fine, 1024) == pytest.approx(2 * density(plain, 1024), rel=1e-5)
    assert UvMap(plain).tile_error() == UvMap(fine).tile_error() == 0
