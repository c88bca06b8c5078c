# SPDX-License-Identifier: GPL-3.0-or-later
"""Show Texture: a texture in place of all materials, which are restored afterward."""

import bpy
import numpy as np
import pytest
from installed import addon
from scenes import add_cone_cube, add_texture, changed, edit, snapshot

texture, image_aspect, tile_pictures = addon.mesh.texture, addon.mesh.image_aspect, addon.core.tile_pictures


def blocks():
    return {kind: sorted(getattr(bpy.data, kind).keys()) for kind in ("materials", "images", "textures", "texts")}


def slots(obj):
    return [(slot.link, slot.material) for slot in obj.material_slots]


def without_slots(_cube):
    pass


def with_an_empty_slot(cube):
    cube.data.materials.append(None)


def with_materials(cube):
    for name in ("Red", "Green"):
        cube.data.materials.append(bpy.data.materials.new(name))
    cube.data.polygons[7].material_index = 1


def with_materials_of_the_object(cube):
    with_materials(cube)
    cube.material_slots[1].link = "OBJECT"
    cube.material_slots[1].material = bpy.data.materials.new("Own")


@pytest.mark.parametrize("in_edit_mode", [False, True])
@pytest.mark.parametrize("prepare", [without_slots, with_an_empty_slot, with_materials, with_materials_of_the_object])
def test_removing_puts_everything_back(prepare, in_edit_mode):
    cube = add_cone_cube()
    prepare(cube)
    if in_edit_mode:
        edit(cube)
    before, there, kept = snapshot(cube), slots(cube), blocks()
    users = {material.name: material.users for material in bpy.data.materials}
    assert bpy.ops.uv.cone_texture() == {"FINISHED"}
    assert texture.is_shown(cube)
    assert all(material.cone_unwrap_texture for _, material in slots(cube))
    assert bpy.ops.uv.cone_texture(clear=True) == {"FINISHED"}
    assert slots(cube) == there and blocks() == kept
    assert changed(before, snapshot(cube)) == set()
    assert {material.name: material.users for material in bpy.data.materials} == users
    assert not cube.is_property_set("cone_unwrap_replaced") and not cube.data.is_property_set("cone_unwrap_replaced")


def test_pattern_and_count_can_be_changed_while_it_is_shown():
    cube = add_cone_cube()
    with_materials(cube)
    there, kept = slots(cube), blocks()
    for options in ({"pattern": "CHECKER"}, {"pattern": "ASYMMETRIC", "tiles": 3}, {"tiles": 1}):
        bpy.ops.uv.cone_texture(**options)
        assert len(blocks()["materials"]) == 3 and len(blocks()["images"]) == 1
    bpy.ops.uv.cone_texture(clear=True)
    assert slots(cube) == there and blocks() == kept


def test_replaced_materials_are_kept_in_the_file(tmp_path):
    cube = add_cone_cube()
    with_materials(cube)
    bpy.ops.uv.cone_texture(pattern="ASYMMETRIC", tiles=2)
    pixels = np.array(texture.find_material().node_tree.nodes.active.image.pixels)
    for _ in range(2):
        bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "cube.blend"))
        bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "cube.blend"))
    np.testing.assert_array_equal(texture.find_material().node_tree.nodes.active.image.pixels, pixels)
    bpy.ops.uv.cone_texture(clear=True)
    assert [material.name for _, material in slots(bpy.data.objects["Cube"])] == ["Red", "Green"]
    assert blocks()["materials"] == ["Green", "Red"]


@pytest.mark.parametrize("prepare", [without_slots, with_an_empty_slot, with_materials, with_materials_of_the_object])
def test_a_file_is_repaired_without_the_extension_by_the_script_in_it(prepare, tmp_path):
    cube = add_cone_cube('It\'s a "cube"')
    prepare(cube)
    name, there = cube.name, [(link, material and material.name) for link, material in slots(cube)]
    bpy.ops.uv.cone_texture()
    addon.unregister()
    try:
        # Saved once more without the extension, it still has the materials.
        for _ in range(2):
            bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "cube.blend"))
            bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "cube.blend"))
        (script,) = bpy.data.texts
        for _ in range(2):
            exec(compile(script.as_string(), script.name, "exec"), {})
            found = slots(bpy.data.objects[name])
            assert [(link, material and material.name) for link, material in found] == there
    finally:
        addon.register()


def test_what_was_changed_meanwhile_is_the_artists():
    cube = add_cone_cube()
    with_materials(cube)
    bpy.ops.uv.cone_texture()
    blue = bpy.data.materials.new("Blue")
    cube.material_slots[0].material = blue
    cube.data.materials.append(blue)
    bpy.ops.uv.cone_texture(clear=True)
    assert [material.name for _, material in slots(cube)] == ["Blue", "Green", "Blue"]


def test_a_slot_that_was_taken_away_meanwhile_is_no_trouble():
    cube = add_cone_cube()
    with_materials(cube)
    bpy.ops.uv.cone_texture()
    cube.data.materials.pop(index=1)
    bpy.ops.uv.cone_texture(clear=True)
    assert [material.name for _, material in slots(cube)] == ["Red"]


def test_the_material_stays_while_another_object_shows_it(reports):
    first, second = add_cone_cube("First"), add_cone_cube("Second")
    bpy.ops.object.select_all(action="SELECT")
    bpy.ops.uv.cone_texture()
    second.select_set(False)
    bpy.ops.uv.cone_texture(clear=True)
    assert not texture.is_shown(first) and texture.is_shown(second)
    first.select_set(False)
    second.select_set(True)
    bpy.ops.uv.cone_texture(clear=True)
    assert blocks()["materials"] == blocks()["images"] == []
    reports()
    assert bpy.ops.uv.cone_texture(clear=True) == {"CANCELLED"}
    assert "there is nothing to remove" in reports()


def test_the_image_the_mesh_had_still_decides_its_aspect():
    cube = add_cone_cube()
    add_texture(cube, 64, 32)
    assert image_aspect.image_aspect(cube) == 2
    bpy.ops.uv.cone_texture()
    assert image_aspect.image_aspect(cube) == 2


def turned_or_mirrored(tile):
    for turns in range(4):
        turned = np.rot90(tile, turns)
        yield turns, False, turned
        yield turns, True, turned[:, ::-1]


@pytest.mark.one_blender
@pytest.mark.parametrize("tiles", [1, 3, 8])
def test_an_asymmetric_tile_looks_different_however_it_is_turned_or_mirrored(tiles):
    picture = tile_pictures.picture("ASYMMETRIC", tiles)
    side = len(picture) // tiles
    tile = picture[:side, :side]
    for turns, mirrored, other in turned_or_mirrored(tile):
        differs = np.abs(other - tile).max(axis=2) > 0.2
        assert (differs.mean() > 0.05) == ((turns, mirrored) != (0, False))


def test_a_checker_has_two_squares_a_tile_and_looks_the_same_turned_by_half():
    for tiles in (1, 8):
        picture = tile_pictures.picture("CHECKER", tiles)
        assert picture.shape == (1024, 1024, 4)
        changes = np.abs(np.diff(picture[0, :, 0])) > 0.1
        assert changes.sum() == 2 * tiles - 1
        np.testing.assert_array_equal(picture, picture[::-1, ::-1])


@pytest.mark.parametrize("repeated", [1, 7, 96, 5000])
def test_a_texture_that_is_seen_many_times_has_about_as_many_texels_as_the_screen(repeated):
    for pattern, least in tile_pictures.LEAST.items():
        picture = tile_pictures.picture(pattern, 1, repeated)
        assert len(picture) == pytest.approx(max(1024 / repeated, least), abs=2)
        changes = np.abs(np.diff(picture[0, :, 0])) > 0.1
        assert pattern != "CHECKER" or changes.sum() == 1


def test_a_seamless_layout_gets_fewer_texels_the_more_tiles_it_has():
    sizes = []
    for tiles in (4, 64):
        cube = add_cone_cube()
        bpy.ops.uv.cone_unwrap(seamless=True, tile_fit="TILES", tiles=tiles)
        bpy.ops.uv.cone_texture("INVOKE_DEFAULT", pattern="CHECKER")
        sizes.append(cube.material_slots[0].material.node_tree.nodes.active.image.size[0])
        bpy.data.objects.remove(cube)
    assert sizes[0] >= 4 * sizes[1]
