# SPDX-License-Identifier: GPL-3.0-or-later
"""Islands of all objects are packed together, with their margins, beside what is pinned and on any image."""

import bpy
import numpy as np
import pytest
from installed import addon
from scenes import UvMap, add_cone_cube, add_cube, add_grid, add_texture, covered_twice, pin

pytestmark = pytest.mark.slow

packing = addon.jobs.layouts.packing
TEXELS = 512


def unwrap(**options):
    return bpy.ops.uv.cone_auto_unwrap(texture_size=str(TEXELS), **options)


def add_scene():
    """Six islands or more, on three objects."""
    bpy.ops.mesh.primitive_cylinder_add(vertices=24)
    objects = [bpy.context.object, add_cube("Cube"), add_cube("Scaled", cuts=1)]
    objects[2].scale = (2.0, 2.0, 2.0)
    objects[0].select_set(True)
    bpy.context.view_layer.update()
    return objects


def area(uv_map):
    placed = uv_map.uv[uv_map.triangles] @ (1, 1j)
    return np.abs(((placed[:, 1] - placed[:, 0]).conj() * (placed[:, 2] - placed[:, 0])).imag).sum() / 2


def complex_corners(objects):
    """Of triangles in UV space, and the number of their island."""
    corners, owner = [], []
    for obj in objects:
        uv_map = UvMap(obj)
        corners.append(uv_map.uv[uv_map.triangles] @ (1, 1j))
        owner.append(np.array(uv_map.island_of_face())[uv_map.face_of_triangle] + 1000 * len(owner))
    return np.concatenate(corners), np.concatenate(owner)


def gap_between_islands(corners, owner):
    """The least distance from a corner of one island to a side of another, which is that of two polygons."""
    least = np.inf
    for number in np.unique(owner):
        points = np.unique(corners[owner == number])
        others = corners[owner != number]
        start, along = others.ravel(), (np.roll(others, -1, axis=1) - others).ravel()
        length = np.abs(along)
        start, along, length = start[length > 0], along[length > 0], length[length > 0]
        for point in points:
            part = np.clip(((point - start) * along.conj()).real / length**2, 0, 1)
            least = min(least, np.abs(start + part * along - point).min())
    return least


@pytest.mark.parametrize("preset", ["PAINT", "BAKE"])
def test_islands_are_apart_and_all_of_one_density(preset):
    objects = add_scene()
    assert unwrap(preset=preset, margin=8) == {"FINISHED"}
    corners, owner = complex_corners(objects)
    assert len(np.unique(owner)) >= 6
    assert covered_twice(map(UvMap, objects)) == 0
    around = min(corners.real.min(), corners.imag.min(), 1 - corners.real.max(), 1 - corners.imag.max())
    assert TEXELS * around >= 8 * (1 - 1e-3)
    assert TEXELS * gap_between_islands(corners, owner) >= 16 * (1 - 1e-3)
    surfaces = [obj.scale.x**2 * sum(face.area for face in obj.data.polygons) for obj in objects]
    density = [np.sqrt(area(UvMap(obj)) / surface) for obj, surface in zip(objects, surfaces, strict=True)]
    assert max(density) / min(density) < 1.001


def test_others_leave_pinned_islands_their_place_and_margin():
    cubes = [add_cone_cube("First"), add_cone_cube("Second")]
    cubes[0].select_set(True)
    unwrap()
    pin(cubes[0], [0], UvMap(cubes[0]).uv[[0]])
    before = UvMap(cubes[0]).uv
    unwrap(margin=8)
    assert np.abs(UvMap(cubes[0]).uv[0] - before[0]).max() < 1e-6
    assert TEXELS * gap_between_islands(*complex_corners(cubes)) >= 16 * (1 - 1e-3)


@pytest.mark.parametrize("shift", [0.3, 0.9, 2.0])
def test_pinned_islands_may_stick_out_of_the_square(shift):
    objects = [add_grid("First"), add_cone_cube("Second")]
    objects[0].select_set(True)
    unwrap()
    uv = UvMap(objects[0]).uv
    # The other islands are packed about where the pinned one was before it was moved.
    pin(objects[0], [0], uv[[0]] + np.array([shift, 0]))
    assert unwrap() == {"FINISHED"}
    first, second = map(UvMap, objects)
    assert np.abs(first.uv[0] - uv[0] - np.array([shift, 0])).max() < 1e-5
    assert first.uv[:, 0].max() > 1
    assert second.uv.min() >= 0 and second.uv.max() <= 1
    assert covered_twice([first, second]) == 0


# A cube that is cut where the front does not see it is a net of three faces by four: such a one and the grid fill less
# than a fifth of these images.
@pytest.mark.parametrize(("add_second", "least"), [(add_cone_cube, 0.0), (add_grid, 0.3)])
@pytest.mark.parametrize("wide", [True, False])
def test_islands_are_not_distorted_on_images_that_are_no_squares(wide, add_second, least):
    parts = [add_grid("First"), add_second("Second")]
    parts[0].select_set(True)
    size = (256, 64) if wide else (64, 256)
    unwrap()
    in_square = sum(area(UvMap(part)) for part in parts)
    for part in parts:
        add_texture(part, *size)
    unwrap()
    maps = list(map(UvMap, parts))
    assert covered_twice(maps) == 0
    for uv_map in maps:
        corners = (uv_map.uv * np.array(size) / 256)[uv_map.triangles]
        sides = np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=2)
        assert (sides.max(axis=1) / sides.min(axis=1)).max() == pytest.approx(2**0.5, rel=1e-4)
    # More than they have, or more than anything could have, in a square inside the image.
    assert sum(map(area, maps)) > max(1.2 * in_square / 4, least)


def test_images_of_several_shapes_share_the_square():
    parts = [add_grid("First"), add_cone_cube("Second")]
    parts[0].select_set(True)
    add_texture(parts[0], 256, 64)
    add_texture(parts[1], 64, 64)
    assert unwrap() == {"FINISHED"}
    assert covered_twice(map(UvMap, parts)) == 0


def test_margins_without_room_are_made_narrower():
    cubes = [add_cube(f"Cube {number}", cuts=1) for number in range(2)]
    for cube in cubes:
        cube.select_set(True)
    assert bpy.ops.uv.cone_auto_unwrap(texture_size="512", margin=240) == {"FINISHED"}
    assert covered_twice(map(UvMap, cubes)) == 0


@pytest.mark.parametrize("seed", range(4))
def test_triangles_are_clipped_to_the_square(seed):
    random = np.random.default_rng(seed)
    triangles = random.uniform(-0.5, 1.5, (20, 3, 2))
    parts = packing.clipped(triangles, packing.UNIT_SQUARE)
    assert parts.min() >= -1e-12 and parts.max() <= 1 + 1e-12
    points = random.uniform(0, 1, (400, 2)) @ (1, 1j)

    def covered(of):
        a, b, c = (of @ (1, 1j)).T[:, :, None]
        sides = [((q - p).conj() * (points - p)).imag for p, q in ((a, b), (b, c), (c, a))]
        return (np.min(sides, axis=0) >= 0).sum(axis=0) + (np.max(sides, axis=0) <= 0).sum(axis=0)

    assert np.array_equal(covered(parts), covered(triangles))


def tile_of_islands(objects):
    """The tile of each island, and whether all of it is inside."""
    corners, owner = complex_corners(objects)
    found = []
    for number in np.unique(owner):
        places = corners[owner == number].ravel()
        column, row = np.floor(places.real.mean()), np.floor(places.imag.mean())
        inside = places - complex(column, row)
        assert min(inside.real.min(), inside.imag.min(), 1 - inside.real.max(), 1 - inside.imag.max()) > 0
        found.append((int(column), int(row)))
    return found


@pytest.mark.parametrize("preset", ["PAINT", "BAKE"])
def test_islands_are_spread_over_udim_tiles(preset):
    objects = add_scene()
    assert unwrap(preset=preset) == {"FINISHED"}
    before = [area(UvMap(obj)) for obj in objects]
    assert unwrap(preset=preset, udim=2, margin=8) == {"FINISHED"}
    assert sorted(set(tile_of_islands(objects))) == [(0, 0), (1, 0)]
    corners, owner = complex_corners(objects)
    assert TEXELS * gap_between_islands(corners, owner) >= 16 * (1 - 1e-3)
    grown = [area(UvMap(obj)) / old for obj, old in zip(objects, before, strict=True)]
    # With Paint the largest island nearly fills a tile alone; Bake cuts it.
    assert min(grown) > (4 / 3 if preset == "BAKE" else 1)
    assert max(grown) / min(grown) < 1.001


@pytest.mark.parametrize("obstacle", ["some are pinned", "not square", "no room"])
def test_udim_tiles_are_refused_where_islands_cannot_be_spread(obstacle):
    objects = add_scene()
    unwrap()
    options = {"margin": 250} if obstacle == "no room" else {}
    if obstacle == "not square":
        for obj in objects:
            add_texture(obj, 256, 64)
    if obstacle == "some are pinned":
        pin(objects[0], [0], UvMap(objects[0]).uv[[0]])
    before = [UvMap(obj).uv for obj in objects]
    with pytest.raises(RuntimeError, match=f"UDIM tiles: .*{obstacle}.*, or set UDIM Tiles to 1"):
        unwrap(udim=2, **options)
    assert all(np.array_equal(UvMap(obj).uv, uv) for obj, uv in zip(objects, before, strict=True))


def test_an_island_that_is_alone_needs_one_tile():
    cube = add_cone_cube()
    assert unwrap(udim=4, compact=False) == {"FINISHED"}
    uv = UvMap(cube).uv
    assert UvMap(cube).islands() == 1 and uv.min() >= 0 and uv.max() <= 1


@pytest.mark.parametrize("compact", [True, False])
@pytest.mark.parametrize("preset", ["PAINT", "BAKE"])
def test_straight_sides_stay_along_the_axes(preset, compact):
    """A cross of six squares has a larger scale where it lies at an angle."""
    bpy.ops.mesh.primitive_cube_add()
    unwrap(preset=preset, compact=compact)
    uv_map = UvMap(bpy.context.object)
    along = [np.diff(uv_map.uv[list(side)], axis=0)[0] for sides in uv_map.sides.values() for side in sides]
    assert np.abs(along).min(axis=1).max() < 1e-6


def test_a_strip_that_is_alone_lies_along_the_diagonal():
    """Nothing of it can be divided across, and along an axis it fills an eighth of the square."""
    strip = add_grid("Strip", segments=1)
    strip.data.transform(np.diag([8, 1, 1, 1]))
    assert unwrap() == {"FINISHED"}
    assert area(UvMap(strip)) > 0.18
