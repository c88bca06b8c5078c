# SPDX-License-Identifier: GPL-3.0-or-later
"""Auto Unwrap packs with xatlas if the extension includes it, otherwise with Blender's packer."""

import bpy
import numpy as np
import pytest
from installed import addon
from one_blender import one_blender
from scenes import UvMap, add_cone_cube, add_cube, add_grid, add_texture, covered_twice, pin

pytestmark = pytest.mark.slow

lsgp, packing, blender_packer = addon.core.native.lsgp, addon.jobs.layouts.packing, addon.jobs.layouts.blender_packer
TEXELS = 512
# There is no xatlas for some Pythons.
HAS_XATLAS = lsgp.packer_name() is not None


@pytest.fixture(params=[*one_blender("xatlas"), "Blender"] if HAS_XATLAS else ["Blender"])
def packer(request, monkeypatch):
    """Each packer in turn: with xatlas hidden, or as the extension was installed."""
    if request.param == "Blender":
        monkeypatch.setattr(lsgp, "packer_name", lambda: None)
    return request.param


@pytest.fixture
def runs(monkeypatch):
    """Names of the packers that run, in their order."""
    found = []

    def watch(owner, name, label):
        run = getattr(owner, name)
        monkeypatch.setattr(owner, name, lambda *given, **named: (found.append(label), run(*given, **named))[1])

    watch(lsgp, "pack_islands", "xatlas")
    watch(packing, "pack_once", "Blender")
    return found


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
def test_islands_are_apart_and_all_of_one_density(packer, runs, preset):
    objects = add_scene()
    assert unwrap(preset=preset, margin=8) == {"FINISHED"}
    assert set(runs) == {packer}
    corners, owner = complex_corners(objects)
    assert len(np.unique(owner)) >= 6
    assert covered_twice(map(UvMap, objects)) == 0
    around = min(corners.real.min(), corners.imag.min(), 1 - corners.real.max(), 1 - corners.imag.max())
    if packer == "xatlas" or preset == "BAKE":
        assert TEXELS * around >= 8 * (1 - 1e-3)
        assert TEXELS * gap_between_islands(corners, owner) >= 16 * (1 - 1e-3)
    surfaces = [obj.scale.x**2 * sum(face.area for face in obj.data.polygons) for obj in objects]
    density = [np.sqrt(area(UvMap(obj)) / surface) for obj, surface in zip(objects, surfaces, strict=True)]
    assert max(density) / min(density) < 1.001


@pytest.mark.parametrize(("enough", "may_turn"), [(0.0, False), (1.0, True)])
def test_blenders_packer_turns_no_islands_where_they_fill_enough_without(enough, may_turn, runs, monkeypatch):
    """Turning the two islands of a cube by quarters takes it seconds."""
    monkeypatch.setattr(lsgp, "packer_name", lambda: None)
    monkeypatch.setattr(packing, "ENOUGH_UNTURNED", enough)
    cube = add_cube("Cube")
    assert unwrap() == {"FINISHED"}
    # Other Blenders may fill the square less.
    assert bpy.app.version[:2] != (4, 5) or area(UvMap(cube)) > 0.6
    assert (len(runs) > 1) == may_turn and set(runs) == {"Blender"}


def test_what_xatlas_cannot_pack_is_for_blenders_packer(packer, runs):
    """Islands that have to stay where they are, and images that are no squares."""
    cubes = [add_cone_cube("First"), add_cone_cube("Second")]
    cubes[0].select_set(True)
    unwrap()
    pin(cubes[0], [0], UvMap(cubes[0]).uv[[0]])
    before = UvMap(cubes[0]).uv
    runs.clear()
    unwrap()
    assert set(runs) == {"Blender"}
    assert np.abs(UvMap(cubes[0]).uv[0] - before[0]).max() < 1e-6


def test_a_wide_image_is_for_blenders_packer(packer, runs):
    parts = [add_grid("First"), add_cone_cube("Second")]
    parts[0].select_set(True)
    for part in parts:
        add_texture(part, 256, 64)
    unwrap()
    assert set(runs) == {"Blender"}
    assert covered_twice(map(UvMap, parts)) == 0


def test_margins_without_room_are_made_narrower(packer, runs):
    cubes = [add_cube(f"Cube {number}", cuts=1) for number in range(2)]
    for cube in cubes:
        cube.select_set(True)
    assert bpy.ops.uv.cone_auto_unwrap(texture_size="512", margin=240) == {"FINISHED"}
    assert runs[-1] == "Blender"
    assert covered_twice(map(UvMap, cubes)) == 0


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
def test_islands_are_spread_over_udim_tiles(packer, runs, preset):
    objects = add_scene()
    assert unwrap(preset=preset) == {"FINISHED"}
    before = [area(UvMap(obj)) for obj in objects]
    if packer == "Blender":
        with pytest.raises(RuntimeError, match="this extension has no packer"):
            unwrap(preset=preset, udim=2)
        assert [area(UvMap(obj)) for obj in objects] == before
        return
    assert unwrap(preset=preset, udim=2, margin=8) == {"FINISHED"}
    assert sorted(set(tile_of_islands(objects))) == [(0, 0), (1, 0)]
    corners, owner = complex_corners(objects)
    assert TEXELS * gap_between_islands(corners, owner) >= 16 * (1 - 1e-3)
    grown = [area(UvMap(obj)) / old for obj, old in zip(objects, before, strict=True)]
    assert min(grown) > 4 / 3
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
    told = obstacle if HAS_XATLAS else "has no packer"
    with pytest.raises(RuntimeError, match=f"UDIM tiles: .*{told}.*, or set UDIM Tiles to 1"):
        unwrap(udim=2, **options)
    assert all(np.array_equal(UvMap(obj).uv, uv) for obj, uv in zip(objects, before, strict=True))


def test_an_island_that_is_alone_needs_one_tile():
    cube = add_cone_cube()
    assert unwrap(udim=4, compact=False) == {"FINISHED"}
    uv = UvMap(cube).uv
    assert UvMap(cube).islands() == 1 and uv.min() >= 0 and uv.max() <= 1


def test_operators_with_a_margin_method_are_for_blenders_packer(packer, runs):
    parts = [add_grid("First"), add_cone_cube("Second")]
    parts[0].select_set(True)
    assert bpy.ops.uv.cone_unwrap(pack=True, margin=0.01, margin_method="ADD") == {"FINISHED"}
    assert set(runs) == {"Blender"}


@pytest.mark.parametrize("compact", [True, False])
@pytest.mark.parametrize("preset", ["PAINT", "BAKE"])
def test_straight_sides_stay_along_the_axes(packer, preset, compact):
    """A cross of six squares has a larger scale where it lies at an angle."""
    bpy.ops.mesh.primitive_cube_add()
    unwrap(preset=preset, compact=compact)
    uv_map = UvMap(bpy.context.object)
    along = [np.diff(uv_map.uv[list(side)], axis=0)[0] for sides in uv_map.sides.values() for side in sides]
    assert np.abs(along).min(axis=1).max() < 1e-6


def test_a_strip_that_is_alone_lies_along_the_diagonal(packer):
    """Nothing of it can be divided across, and along an axis it fills an eighth of the square."""
    strip = add_grid("Strip", segments=1)
    strip.data.transform(np.diag([8, 1, 1, 1]))
    assert unwrap() == {"FINISHED"}
    assert area(UvMap(strip)) > 0.18
