# SPDX-License-Identifier: GPL-3.0-or-later
"""Batches in Blender: .blend, glTF and FBX files in, the same with UV maps out, through the command as it is typed."""

import json
import struct
import subprocess

import bpy
import numpy as np
import pytest
from installed import addon
from mathutils import Matrix
from nightly import nightly
from scenes import UvMap, add_ball, add_cone_cube, add_cube, add_grid, add_sphere, covered_twice, joined

pytestmark = pytest.mark.slow

command = addon.jobs.batch.command


FILES = ["broken.blend", "deep/ball.fbx", "empty.blend", "gone.glb", "sphere.glb", "two.blend"]


def run(*arguments):
    """The exit code of the command: in a Blender of its own, or through its handler where bpy is a module."""
    arguments = [str(argument) for argument in arguments]
    if not bpy.app.binary_path:
        return command.run(arguments)
    bpy.ops.wm.save_userpref()
    typed = [bpy.app.binary_path, "--background", "--command", "cone_unwrap", *arguments]
    return subprocess.run(typed, timeout=300).returncode


def clear():
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)


def write_glb(path, mesh):
    """A mesh as glTF has it, every face with vertices of its own.

    The exporter of Blender 4.2 sets the scene of bpy's window, which is gone where files were read before: one process
    in five crashes there.
    """
    mesh.calc_loop_triangles()
    corners = np.array([mesh.vertices[v].co for face in mesh.loop_triangles for v in face.vertices], "<f4")
    content = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"name": mesh.name, "mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [
            {
                "bufferView": 0,
                "componentType": 5126,  # float
                "type": "VEC3",
                "count": len(corners),
                "min": corners.min(axis=0).tolist(),
                "max": corners.max(axis=0).tolist(),
            }
        ],
        "bufferViews": [{"buffer": 0, "byteLength": corners.nbytes}],
        "buffers": [{"byteLength": corners.nbytes}],
    }
    text = json.dumps(content).encode()
    text += b" " * (-len(text) % 4)
    chunks = [
        struct.pack("<I4s", len(data), kind) + data for kind, data in ((b"JSON", text), (b"BIN\0", corners.tobytes()))
    ]
    path.write_bytes(struct.pack("<4sII", b"glTF", 2, 12 + sum(map(len, chunks))) + b"".join(chunks))


@pytest.fixture
def library(tmp_path):
    """A list of files of all kinds; "two.blend" is saved in edit mode and has a cube with cones and a mesh without."""
    folder = tmp_path / "library"
    (folder / "deep").mkdir(parents=True)
    bpy.ops.wm.save_as_mainfile(filepath=str(folder / "empty.blend"), copy=True)
    write_glb(folder / "sphere.glb", add_sphere().data)
    clear()
    add_ball()
    bpy.ops.export_scene.fbx(filepath=str(folder / "deep" / "ball.fbx"))
    clear()
    add_cone_cube("Marked")
    bare = add_cube("Bare")
    bare.data.uv_layers.remove(bare.data.uv_layers[0])
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.wm.save_as_mainfile(filepath=str(folder / "two.blend"), copy=True)
    bpy.ops.object.mode_set(mode="OBJECT")
    clear()
    (folder / "broken.blend").write_bytes(b"this is no Blender file")
    (folder / "list.txt").write_text("\n".join(FILES))
    return folder


def lines_of(out):
    return [json.loads(line) for line in (out / "journal.jsonl").read_text().splitlines()]


def test_files_of_all_kinds(library, tmp_path):
    out = tmp_path / "out"
    assert run(library / "list.txt", "--out", out, "--jobs", 1) == 4
    lines = {line["asset"]: line for line in lines_of(out)}
    assert sorted(lines) == FILES
    ended = {name: (line["status"], line["code"]) for name, line in lines.items()}
    assert ended == {
        "broken.blend": ("refused", "MALFORMED_FILE"),
        "deep/ball.fbx": ("ok", None),
        "empty.blend": ("refused", "NO_MESH"),
        "gone.glb": ("failed", "FILE_ERROR"),
        "sphere.glb": ("ok", None),
        "two.blend": ("ok", None),
    }
    assert not list(out.rglob("*.partial*"))
    assert all((out / lines[name]["picture"]).is_file() for name, how in ended.items() if how[0] == "ok")
    assert run(library / "list.txt", "--out", out, "--only-missing", "--jobs", 1) == 4
    assert [line["asset"] for line in lines_of(out)[len(FILES) :]] == ["gone.glb"]

    bpy.ops.wm.open_mainfile(filepath=str(out / "two.blend"))
    marked, bare = bpy.data.objects["Marked"], bpy.data.objects["Bare"]
    assert lines["two.blend"]["triangles"] == 2 * len(marked.data.polygons) + 2 * len(bare.data.polygons)
    # A cube through its corners is laid out as it is; both sides of every cut are alike.
    assert UvMap(marked).l2_stretch() == pytest.approx(1, abs=1e-4)
    assert all(UvMap(obj).sister_difference() < 1e-5 for obj in (marked, bare))
    assert not bare.vertex_groups

    # Its facets, which glTF has apart, are unwrapped as one surface, and look as before.
    assert lines["sphere.glb"]["islands"] == 1
    assert set(lines["sphere.glb"]["warnings"]) == {"BORDERS_STITCHED"}
    clear()
    bpy.ops.import_scene.gltf(filepath=str(out / "sphere.glb"))
    (sphere,) = (obj.data for obj in bpy.data.objects if obj.type == "MESH")
    assert np.ptp([loop.vector for loop in sphere.uv_layers.active.uv], axis=0).max() > 0.5
    assert len(sphere.polygons) == lines["sphere.glb"]["triangles"]
    for face in sphere.polygons:
        assert all(sphere.corner_normals[loop].vector.dot(face.normal) > 0.999 for loop in face.loop_indices)


@pytest.mark.one_blender
@pytest.mark.parametrize("preset", ["paint", "tile", *nightly("bake")])
def test_with_a_preset_all_objects_of_a_file_are_packed_together(library, tmp_path, preset):
    out = tmp_path / "out"
    assert run(library / "two.blend", "--out", out, "--preset", preset, "--no-pictures") == 0
    (line,) = lines_of(out)
    assert line["overlapping"] == 0
    # The bare cube may end at its creases instead of having cones, but not on a lattice.
    assert line["cones"] > 8 if preset == "tile" else line["cones"] >= 8
    bpy.ops.wm.open_mainfile(filepath=str(out / "two.blend"))
    maps = [UvMap(bpy.data.objects[name]) for name in ("Marked", "Bare")]
    if preset == "tile":
        assert [uv_map.tile_error() for uv_map in maps] == [0, 0]
    else:
        assert min(uv_map.uv.min() for uv_map in maps) > 0 and max(uv_map.uv.max() for uv_map in maps) < 1
        assert covered_twice(maps) == 0


def test_a_file_that_is_saved_while_it_is_unwrapped_in_place_is_not_replaced(tmp_path, monkeypatch):
    add_cube("Cube", cuts=1)
    path = tmp_path / "cube.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path), copy=True)
    clear()
    asset, parser = addon.jobs.batch.asset, command._parser()
    given = parser.parse_args([str(path), "--out", str(tmp_path), "--in-place", "--no-pictures"])
    task = {"input": str(path), "out": str(tmp_path), "output": path.name}
    tasks = addon.core.native.part("batch.tasks")
    task, settings = tasks.Task(path.name, picture="", **task), tasks.Settings.of(given)
    assert asset.unwrap_asset(task, settings)["status"] == "ok"

    def saved(partial, save=asset.save_file):
        save(partial)
        path.write_bytes(b"saved by another program")

    monkeypatch.setattr(asset, "save_file", saved)
    record = asset.unwrap_asset(task, settings)
    assert (record["status"], record["code"]) == ("failed", "FILE_ERROR") and "has changed" in record["message"]
    assert path.read_bytes() == b"saved by another program" and [*tmp_path.iterdir()] == [path]
    clear()


def test_faces_without_coordinates_are_counted(tmp_path):
    """A band that is one-sided is refused where a number of cones is given, and cut open otherwise, as an object of its
    own and beside a cube in one object."""
    turn = np.linspace(0, 2 * np.pi, 24, endpoint=False)
    edge = [
        np.stack([(2 + s * np.cos(turn / 2)) * np.cos(turn), (2 + s * np.cos(turn / 2)) * np.sin(turn)], axis=1)
        for s in (-0.5, 0.5)
    ]
    height = [s * np.sin(turn / 2) for s in (-0.5, 0.5)]
    places = np.concatenate([np.column_stack([xy, z]) for xy, z in zip(edge, height, strict=True)])
    faces = [(i, i + 1, i + 25, i + 24) for i in range(23)] + [(23, 24, 0, 47)]
    for name in ("joined", "apart"):
        clear()
        cube = add_cube("Cube", cuts=1)
        band = bpy.data.meshes.new("Band")
        band.from_pydata(places.tolist(), [], faces)
        band_object = bpy.data.objects.new("Band", band)
        bpy.context.collection.objects.link(band_object)
        band_area = sum(face.area for face in band.polygons)
        area = 100 * band_area / (band_area + sum(face.area for face in cube.data.polygons))
        if name == "joined":
            joined(cube, band_object)
        bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / f"{name}.blend"), copy=True)
    clear()
    (tmp_path / "list.txt").write_text("joined.blend\napart.blend\n")
    options = ["--no-pictures", "--jobs", 1]
    assert run(tmp_path / "list.txt", "--out", tmp_path / "open", *options) == 0
    assert [line["missing_faces"] for line in lines_of(tmp_path / "open")] == [0, 0]
    assert run(tmp_path / "list.txt", "--out", tmp_path / "out", *options, "--cones", "auto:8") == 4
    for line in lines_of(tmp_path / "out"):
        assert (line["status"], line["missing_faces"]) == ("ok", len(faces))
        assert line["missing_area_percent"] == pytest.approx(area, rel=0.05)


@pytest.mark.one_blender
@pytest.mark.parametrize("add_large", [add_ball, *nightly(add_sphere)], ids=["marked cones", "automatic cones"])
def test_islands_that_single_precision_spoils_are_a_warning_which_strict_refuses(tmp_path, add_large):
    speck = add_grid("Speck")  # without cuts, whose two sides would differ as well
    triangles = 2 * len(speck.data.polygons)
    speck.data.transform(Matrix.Scale(1e-7, 4))
    joined(speck, add_large())
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "speck.blend"), copy=True)
    clear()
    (tmp_path / "list.txt").write_text("speck.blend\n")
    assert run(tmp_path / "list.txt", "--out", tmp_path / "out", "--no-pictures") == 0
    assert lines_of(tmp_path / "out")[0]["warnings"] == {"ISLANDS_TINY": triangles}
    assert run(tmp_path / "list.txt", "--out", tmp_path / "strict", "--no-pictures", "--strict") == 3
    assert lines_of(tmp_path / "strict")[0]["code"] == "ISLANDS_TINY"


@pytest.mark.one_blender
def test_islands_inside_that_are_made_smaller_are_a_warning(tmp_path):
    outer, inner = add_ball("Outer"), add_ball("Inner")
    triangles = sum(len(face.vertices) - 2 for face in inner.data.polygons)
    inner.data.transform(Matrix.Translation((-5, 0, 0)) @ Matrix.Scale(0.5, 4))  # where joining puts the other
    joined(outer, inner)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "balls.blend"), copy=True)
    clear()
    (tmp_path / "list.txt").write_text("balls.blend\n")
    options = ["--no-pictures", "--preset", "paint"]
    assert run(tmp_path / "list.txt", "--out", tmp_path / "usual", *options) == 0
    assert "ISLANDS_HIDDEN" not in lines_of(tmp_path / "usual")[0]["warnings"]
    assert run(tmp_path / "list.txt", "--out", tmp_path / "less", *options, "--inside", "0.5") == 0
    assert lines_of(tmp_path / "less")[0]["warnings"]["ISLANDS_HIDDEN"] == triangles


@pytest.mark.one_blender
def test_options_that_name_files_of_one_mesh_are_refused(library, tmp_path):
    (library / "cones.json").write_text('{"cones": [0, 1, 2]}')
    (library / "list.txt").write_text("two.blend\n")
    out = tmp_path / "out"
    assert run(library / "list.txt", "--out", out, "--cones", library / "cones.json") == 3
    (line,) = lines_of(out)
    assert (line["status"], line["code"]) == ("refused", "WRONG_USAGE")
    assert "cones, seams, features and weights are those of the meshes" in line["message"]


def density_in_world(obj, texture_size):
    """Texels per unit of length of the whole map: by shoelaces of the faces' UVs, beside their areas in the world."""
    matrix, mesh = np.array(obj.matrix_world), obj.data
    uv = np.array([entry.vector for entry in mesh.uv_layers.active.uv])
    places = np.array([matrix[:3, :3] @ vertex.co for vertex in mesh.vertices])
    texels = area = 0.0
    for face in mesh.polygons:
        u, v = uv[list(face.loop_indices)].T
        texels += abs(u @ np.roll(v, -1) - v @ np.roll(u, -1)) / 2 * texture_size**2
        corners = places[list(face.vertices)]
        area += np.linalg.norm(np.cross(corners, np.roll(corners, -1, axis=0)).sum(axis=0)) / 2
    return np.sqrt(texels / area)


@pytest.fixture
def scaled(tmp_path):
    """A list of a file with a cube and two that are twice as large in the world."""
    add_cube("Plain", cuts=1)
    for name in ("Scaled", "Twin"):
        add_cube(name, cuts=1).scale = (2, 2, 2)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "scaled.blend"), copy=True)
    clear()
    (tmp_path / "list.txt").write_text("scaled.blend\n")
    return tmp_path / "list.txt"


@pytest.mark.one_blender
@pytest.mark.parametrize("preset", [*nightly([]), ["--preset", "paint"]])
def test_all_objects_get_the_texel_density_that_is_asked_for(scaled, tmp_path, preset):
    out = tmp_path / "out"
    assert run(scaled, "--out", out, "--texel-density", 20, "--texture-size", 512, *preset, "--no-pictures") == 0
    (line,) = lines_of(out)
    assert "ISLANDS_OUTSIDE" not in line["warnings"]
    bpy.ops.wm.open_mainfile(filepath=str(out / "scaled.blend"))
    objects = [bpy.data.objects[name] for name in ("Plain", "Scaled", "Twin")]
    assert [density_in_world(obj, 512) for obj in objects] == pytest.approx([20, 20, 20], rel=0.02 if preset else 1e-4)
    if preset:
        assert covered_twice([UvMap(obj) for obj in objects]) == 0


@pytest.mark.one_blender
def test_a_texel_density_that_the_square_cannot_hold_is_a_warning_or_takes_tiles(scaled, tmp_path):
    # 6 faces of 2 x 2 and 12 of 4 x 4 at 100 texels per unit: 2.2 million texels, eight times those of the texture.
    how = ["--preset", "paint", "--texel-density", 100, "--texture-size", 512, "--no-pictures"]
    assert run(scaled, "--out", tmp_path / "square", *how) == 0
    assert lines_of(tmp_path / "square")[0]["warnings"]["ISLANDS_OUTSIDE"] > 0

    assert run(scaled, "--out", tmp_path / "few", *how, "--udim", 2) == 3
    (line,) = lines_of(tmp_path / "few")
    assert line["code"] in {"TOO_FEW_TILES", "ISLAND_TOO_LARGE"}
    assert "triangles" not in line["message"]  # those of both objects together, which nobody could find


@pytest.mark.one_blender
@pytest.mark.parametrize("preset", [*nightly([]), ["--preset", "bake"]])
def test_tiles_without_a_density_are_filled(scaled, tmp_path, preset):
    out = tmp_path / "out"
    how = [*preset, "--udim", 2, "--margin", 8, "--texture-size", 512, "--overlaps", "split"]
    assert run(scaled, "--out", out, *how, "--no-pictures") == 0
    bpy.ops.wm.open_mainfile(filepath=str(out / "scaled.blend"))
    objects = [bpy.data.objects[name] for name in ("Plain", "Scaled", "Twin")]
    uv = np.concatenate([UvMap(obj).uv for obj in objects])
    assert set(np.floor(uv[:, 0])) == {0, 1} and set(np.floor(uv[:, 1])) == {0}
    inside = uv % 1
    assert inside.min() > 7.99 / 512 and inside.max() < 1 - 7.99 / 512
    densities = [density_in_world(obj, 512) for obj in objects]
    assert max(densities) / min(densities) < 1.001


@pytest.mark.one_blender
@pytest.mark.parametrize(
    "how",
    [["--preset", "paint"], *nightly(["--preset", "bake", "--texel-density", 20]), ["--texel-density", 20]],
    ids=["filled", "preset at a density", "density"],
)
def test_objects_get_as_many_times_the_density_as_their_weights_say(tmp_path, how):
    for name, weight in (("Plain", 1.0), ("Fine", 2.0), ("Coarse", 0.5)):
        add_cube(name, cuts=1).cone_unwrap_density_weight = weight
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "weighted.blend"), copy=True)
    clear()
    out = tmp_path / "out"
    sized = ["--texture-size", 512] if "--texel-density" in how else []
    assert run(tmp_path / "weighted.blend", "--out", out, *how, *sized, "--no-pictures") == 0
    bpy.ops.wm.open_mainfile(filepath=str(out / "weighted.blend"))
    found = np.array([density_in_world(bpy.data.objects[name], 512) for name in ("Plain", "Fine", "Coarse")])
    assert found / found[0] == pytest.approx([1, 2, 0.5], rel=1e-3)
    if sized:
        assert found[0] == pytest.approx(20, rel=1e-3)


@pytest.mark.one_blender
@pytest.mark.parametrize(
    "options",
    [["--pack", "shelves"], ["--pack", "tight", "--texel-density", 9, "--margin", 1], ["--time-limit", 60]],
)
def test_other_ways_to_pack_and_time_limits_are_refused(scaled, tmp_path, options):
    sized = ["--texture-size", 512] if "tight" in options else []
    assert run(scaled, "--out", tmp_path / "out", "--preset", "bake", *options, *sized) == 3
    (line,) = lines_of(tmp_path / "out")
    assert line["code"] == "WRONG_USAGE" and "is for lsgp batch" in line["message"]


@pytest.mark.one_blender
def test_tiles_are_shared_by_all_objects(scaled, tmp_path):
    out = tmp_path / "out"
    # 6 faces of 120 and 12 of 240 texels a side: however they are joined, one tile of 1024 does not hold them.
    how = ["--preset", "bake", "--texel-density", 60, "--texture-size", 1024, "--udim", 4, "--margin", 24]
    assert run(scaled, "--out", out, *how, "--no-pictures") == 0
    bpy.ops.wm.open_mainfile(filepath=str(out / "scaled.blend"))
    maps = [UvMap(bpy.data.objects[name]) for name in ("Plain", "Scaled", "Twin")]
    tiles = np.unique(np.concatenate([np.floor(uv_map.uv) for uv_map in maps]), axis=0)
    assert len(tiles) > 1
    for uv_map in maps:
        inside = uv_map.uv % 1
        assert inside.min() > 23.9 / 1024 and inside.max() < 1 - 23.9 / 1024
    beside = np.array([0, 1e-4])  # of points of the raster, which lie on diagonals of the squares
    for tile in tiles:
        for uv_map in maps:
            uv_map.uv -= tile + beside
        assert covered_twice(maps) == 0
        for uv_map in maps:
            uv_map.uv += tile + beside


def test_wrong_usage(tmp_path):
    assert run(tmp_path / "nowhere", "--out", tmp_path / "out") == 2
    assert run("--no-such-option") == 2
    assert run("--help") == 0


@pytest.mark.one_blender
def test_presets_take_the_subdivision_surface_as_the_operator_does(tmp_path):
    cage = add_cone_cube("Cage", cuts=1)
    for vertex in cage.data.vertices:
        vertex.co.z *= 3
    cage.modifiers.new("Subdivision", "SUBSURF").levels = 2
    source, out = tmp_path / "cage.blend", tmp_path / "out"
    bpy.ops.wm.save_as_mainfile(filepath=str(source), copy=True)
    wanted, flat = (edge_shares(cage, use_subsurf_data=use) for use in (True, False))
    assert run(source, "--out", out, "--preset", "paint", "--no-pictures") == 0
    bpy.ops.wm.open_mainfile(filepath=str(out / "cage.blend"))
    found = edge_shares(bpy.data.objects["Cage"])
    assert found == pytest.approx(wanted, abs=1e-4)
    assert np.abs(flat - wanted).max() > 0.01


def edge_shares(obj, **options):
    """Lengths of the edges in the map by the mean one; with options, after unwrapping with them."""
    assert not options or bpy.ops.uv.cone_auto_unwrap(**options) == {"FINISHED"}
    return UvMap(obj).edge_shares()


# What an artist's file can have that is Python: each of these writes the file that it names.
TEXT = "import bpy, pathlib; pathlib.Path({path!r}).write_text('run')\n"
HANDLER = (
    "import bpy, pathlib\n"
    "def handler(*_): pathlib.Path({path!r}).write_text('run')\n"
    "bpy.app.handlers.save_pre.append(handler)\n"
    "bpy.app.handlers.depsgraph_update_post.append(handler)\n"
)
# The call takes it beyond the simple expressions that Blender evaluates without Python.
DRIVER = "[__import__('pathlib').Path({path!r}).write_text('run'), var][1]"


def write_hostile(path, marks):
    """A .blend with Python wherever Blender runs some: texts that are registered, drivers, a modifier of nodes."""
    for name, code in (("startup.py", TEXT), ("handler.py", HANDLER)):
        text = bpy.data.texts.new(name)
        text.write(code.format(path=str(marks / name)))
        text.use_module = True
    cube = add_cone_cube("Driven", cuts=1)
    cube["__init__"] = TEXT.format(path=str(marks / "property"))
    cube.shape_key_add(name="Basis")
    cube.shape_key_add(name="Key")
    levels = cube.modifiers.new("Subdivision", "SUBSURF")
    drive(cube, "location", marks / "location", 0)
    drive(levels, "levels", marks / "levels")
    drive(cube.data.shape_keys.key_blocks["Key"], "value", marks / "key")
    bpy.context.preferences.filepaths.use_scripts_auto_execute = False
    bpy.ops.wm.save_as_mainfile(filepath=str(path), copy=True, compress=True)
    clear()


def drive(owner, name, mark, *index):
    driver = owner.driver_add(name, *index).driver
    variable = driver.variables.new()
    variable.name = "var"
    variable.targets[0].id = bpy.data.objects["Driven"]
    variable.targets[0].data_path = "scale.x"
    driver.expression = DRIVER.format(path=str(mark))


def test_files_run_no_python_whatever_the_preferences_say(tmp_path):
    marks, source, out = tmp_path / "marks", tmp_path / "source", tmp_path / "out"
    marks.mkdir(), source.mkdir()
    names = ["first.blend", "second.blend"]
    for name in names:
        write_hostile(source / name, marks)
    write_glb(source / "between.glb", add_sphere().data)
    clear()
    assert not list(marks.iterdir())
    (source / "list.txt").write_text("first.blend\nbetween.glb\nsecond.blend\n")
    filepaths = bpy.context.preferences.filepaths
    filepaths.use_scripts_auto_execute = True
    bpy.ops.wm.save_userpref()
    try:
        code = run(source / "list.txt", "--out", out, "--jobs", 1, "--preset", "paint", "--no-pictures")
    finally:
        filepaths.use_scripts_auto_execute = False
        bpy.ops.wm.save_userpref()
    assert [(line["status"], line["code"]) for line in lines_of(out)] == [("ok", None)] * 3, lines_of(out)
    assert code == 0
    assert list(marks.iterdir()) == []
    # The file is not hostile in vain: opened with its scripts, it runs all of them.
    bpy.ops.wm.open_mainfile(filepath=str(source / "first.blend"), use_scripts=True)
    assert {mark.name for mark in used(marks, tmp_path)} == {"startup.py", "handler.py", "location", "levels", "key"}
    # From here on Blender would run them by itself.
    for mark in marks.iterdir():
        mark.unlink()
    addon.jobs.batch.files.open_file(str(source / "first.blend"))
    assert used(marks, tmp_path) == []


def used(marks, folder):
    """The marks that there are once the open file is evaluated and saved."""
    bpy.context.view_layer.update()
    addon.jobs.batch.files.save_file(str(folder / "saved.blend"))
    return list(marks.iterdir())
