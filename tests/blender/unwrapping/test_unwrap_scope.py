# SPDX-License-Identifier: GPL-3.0-or-later
"""Unwrap from Cones: what it may change, what it must leave alone, and how it fails."""

import bmesh
import bpy
import numpy as np
import pytest
from installed import addon
from logged import refused
from scenes import (
    ANGLES,
    UvMap,
    add_cone_cube,
    add_cube,
    add_grid,
    add_sphere,
    changed,
    corners,
    edit,
    mark,
    select_elements,
    snapshot,
    uv_key,
)

lsgp, packing = addon.core.native.lsgp, addon.jobs.layouts.packing


def decorate(obj):
    """A pin, attributes of other kinds, a material, a weight, a modifier and a shape key."""
    mesh = obj.data
    obj.vertex_groups.new(name="other").add([0, 5], 0.5, "REPLACE")
    mesh.materials.append(bpy.data.materials.new("Paint"))
    mesh.attributes.new(".pn.UVMap", "BOOLEAN", "CORNER").data[9].value = True
    mesh.attributes.new("temperature", "FLOAT", "POINT").data[2].value = 36.6
    mesh.attributes.new("part", "INT", "FACE").data[1].value = 7
    mesh.attributes.new("paint", "BYTE_COLOR", "CORNER")
    obj.modifiers.new("Subdivision", "SUBSURF")
    obj.shape_key_add(name="Basis")
    obj.shape_key_add(name="Bent").data[0].co.z += 0.5


@pytest.mark.parametrize("in_edit_mode", [True, False])
def test_only_the_active_uv_layer_changes(in_edit_mode):
    cube = add_cone_cube()
    decorate(cube)
    cube.data.edges[3].use_seam = True
    if in_edit_mode:
        edit(cube)
    before = snapshot(cube)
    assert bpy.ops.uv.cone_unwrap() == {"FINISHED"}
    assert changed(before, snapshot(cube)) == {uv_key()}


@pytest.mark.parametrize("in_edit_mode", [True, False])
def test_a_copy_of_the_mesh_keeps_its_uvs(in_edit_mode):
    cube = add_cone_cube()
    # A copy shares arrays with the mesh until one of them is changed.
    twin = bpy.data.objects.new("Twin", cube.data.copy())
    bpy.context.collection.objects.link(twin)
    if in_edit_mode:
        edit(cube)
    before = UvMap(twin).uv
    assert bpy.ops.uv.cone_unwrap() == {"FINISHED"}
    assert np.array_equal(UvMap(twin).uv, before)
    assert not np.array_equal(UvMap(cube).uv, before)


@pytest.mark.parametrize("in_edit_mode", [True, False])
def test_of_eight_uv_layers_only_the_active_one_changes(in_edit_mode):
    cube = add_cone_cube()
    for number in range(2, 9):
        cube.data.uv_layers.new(name=f"Map {number}")
    cube.data.uv_layers.active_index = 4
    if in_edit_mode:
        edit(cube)
    before = snapshot(cube)
    assert len(before["uv layers"]) == 8
    bpy.ops.uv.cone_unwrap()
    assert changed(before, snapshot(cube)) == {uv_key("Map 5")}


@pytest.mark.parametrize("in_edit_mode", [True, False])
def test_a_mesh_without_uv_layer_gets_one(in_edit_mode):
    cube = add_cone_cube()
    cube.data.uv_layers.remove(cube.data.uv_layers[0])
    if in_edit_mode:
        edit(cube)
    before = snapshot(cube)
    bpy.ops.uv.cone_unwrap()
    after = snapshot(cube)
    assert after["uv layers"] == ["UVMap"]
    # Blender 5 keeps its UV selection beside a new layer.
    differences = {name for name in changed(before, after) if not name.startswith("attribute .uv_select_")}
    assert differences <= {uv_key(), "uv layers", "active uv layer", "render uv layer"}
    assert UvMap(cube).scale_spread() < 1 + 1e-5


@pytest.mark.parametrize("in_edit_mode", [True, False])
def test_same_call_twice_gives_the_same_bytes(in_edit_mode):
    cube = add_cone_cube()
    for vertex in cube.data.vertices:
        vertex.co.x += 0.3 * vertex.co.z**2
    if in_edit_mode:
        edit(cube)
    bpy.ops.uv.cone_unwrap()
    first = snapshot(cube)
    bpy.ops.uv.cone_unwrap()
    assert changed(first, snapshot(cube)) == set()


def test_edit_mode_and_object_mode_give_the_same_uvs():
    first = add_cone_cube("First")
    bpy.ops.uv.cone_unwrap()
    in_object_mode = UvMap(first).uv
    bpy.ops.object.select_all(action="DESELECT")
    second = add_cone_cube("Second")
    edit(second)
    bpy.ops.uv.cone_unwrap()
    assert UvMap(second).uv.tobytes() == in_object_mode.tobytes()


def test_selected_faces_only_are_unwrapped_and_the_others_keep_their_bytes():
    grid = add_grid(segments=6)
    layer = grid.data.uv_layers.active
    noise = np.random.default_rng(3).random(2 * len(grid.data.loops)).astype(np.float32)
    layer.uv.foreach_set("vector", noise)
    chosen = [face.index for face in grid.data.polygons if face.center.x < 0]
    loops = np.isin(np.arange(len(grid.data.loops)), [i for f in chosen for i in grid.data.polygons[f].loop_indices])
    edit(grid)
    select_elements(grid, "faces", chosen)
    before = UvMap(grid).uv
    state = snapshot(grid)
    assert bpy.ops.uv.cone_unwrap() == {"FINISHED"}
    after = UvMap(grid)
    assert after.uv[~loops].tobytes() == before[~loops].tobytes()
    assert (after.uv[loops] != before[loops]).any(axis=1).all()
    assert after.scale_spread(chosen) < 1 + 1e-5
    assert changed(state, snapshot(grid)) == {uv_key()}


@pytest.mark.parametrize("still_selected", [False, True])
def test_hidden_faces_keep_their_uvs(still_selected):
    grid = add_grid(segments=4)
    right = [face.index for face in grid.data.polygons if face.center.x > 0]
    loops = np.isin(np.arange(len(grid.data.loops)), [i for f in right for i in grid.data.polygons[f].loop_indices])
    grid.data.uv_layers.active.uv.foreach_set("vector", np.full(2 * len(grid.data.loops), 5.0, np.float32))
    edit(grid)
    # In vertex select mode the vertices would be hidden, and with them the faces beside.
    bpy.ops.mesh.select_mode(type="FACE")
    bm = bmesh.from_edit_mesh(grid.data)
    for face in bm.faces:
        if face.index in right:
            # Blender's own Hide deselects; scripts may not.
            face.hide = True
            face.select = still_selected
    bmesh.update_edit_mesh(grid.data)
    bpy.ops.uv.cone_unwrap()
    uv = UvMap(grid).uv
    assert (uv[loops] == 5.0).all()
    assert (uv[~loops] <= 1.0).all()


def test_cones_and_broken_coordinates_outside_of_the_selection_have_no_say():
    grid, twin = add_grid("Grid"), add_grid("Twin")
    left = [face.index for face in grid.data.polygons if face.center.x < 0]
    far = max(range(len(grid.data.vertices)), key=lambda v: grid.data.vertices[v].co.x)
    mark(grid, [far])
    grid.data.vertices[far].co.y = float("nan")
    results = []
    for obj in (twin, grid):
        edit(obj)
        select_elements(obj, "faces", left)
        assert bpy.ops.uv.cone_unwrap() == {"FINISHED"}
        uv_map = UvMap(obj)
        results.append(uv_map.uv[[loop for face in left for loop in uv_map.loops_of_face[face]]])
        bpy.ops.object.mode_set(mode="OBJECT")
    assert results[0].tobytes() == results[1].tobytes()


@pytest.mark.parametrize("in_edit_mode", [True, False])
def test_closed_sphere_without_cones_is_refused_with_a_remedy_and_nothing_changes(in_edit_mode):
    sphere = add_sphere()
    decorate(sphere)
    if in_edit_mode:
        edit(sphere)
    before = snapshot(sphere)
    with refused("TOO_FEW_CONES", r"(?i)Sphere: .*mark cones.*use auto unwrap"):
        bpy.ops.uv.cone_unwrap()
    assert changed(before, snapshot(sphere)) == set()


FAILURES = {
    "no memory": (lsgp, "parameterize", MemoryError(), "not enough memory"),
    "solver": (
        lsgp,
        "parameterize",
        lsgp.SolverError("SOLVER_FAILED", "The equations could not be solved. Clean the mesh."),
        "could not be solved. Clean the mesh",
    ),
    "packer": (lsgp, "pack_islands", MemoryError(), "not enough memory"),
    "packing": (
        packing,
        "pack",
        addon.core.errors.Refused("no room; switch Pack Islands off"),
        "switch Pack Islands off",
    ),
}


@pytest.mark.parametrize("in_edit_mode", [True, False])
@pytest.mark.parametrize("failure", FAILURES)
def test_failure_at_any_stage_changes_nothing(failure, in_edit_mode, monkeypatch):
    owner, name, error, said = FAILURES[failure]
    cube = add_cone_cube()
    decorate(cube)
    if in_edit_mode:
        edit(cube)

    def fail(*_arguments, **_options):
        raise error

    before = snapshot(cube)
    monkeypatch.setattr(owner, name, fail)
    with pytest.raises(RuntimeError, match=said):
        bpy.ops.uv.cone_unwrap(pack=True)
    assert changed(before, snapshot(cube)) == set()
    monkeypatch.undo()
    assert bpy.ops.uv.cone_unwrap(pack=True) == {"FINISHED"}
    assert changed(before, snapshot(cube)) == {uv_key()}


@pytest.mark.parametrize("options", [{"pack": True}, {"keep_placement": True}, {"seams": "BOUNDARY"}])
@pytest.mark.parametrize("in_edit_mode", [True, False])
def test_refusal_changes_nothing_whatever_is_asked(options, in_edit_mode):
    sphere = add_sphere()
    count = len(sphere.data.polygons)
    if in_edit_mode:
        add_grid()
        bpy.context.view_layer.objects.active = sphere
        bpy.ops.object.join()
    decorate(sphere)
    if in_edit_mode:
        edit(sphere)
        select_elements(sphere, "faces", range(count))
    before = snapshot(sphere)
    with refused("TOO_FEW_CONES", r"Sphere: "):
        bpy.ops.uv.cone_unwrap(**options)
    assert changed(before, snapshot(sphere)) == set()


def test_refusal_does_not_create_a_uv_layer():
    sphere = add_sphere()
    sphere.data.uv_layers.remove(sphere.data.uv_layers[0])
    with pytest.raises(RuntimeError):
        bpy.ops.uv.cone_unwrap()
    assert len(sphere.data.uv_layers) == 0


def test_angle_that_is_not_a_number_is_refused():
    cube = add_cone_cube()
    cube.data.attributes.new(ANGLES, "FLOAT", "POINT").data[corners(cube)[2]].value = float("nan")
    before = snapshot(cube)
    with pytest.raises(RuntimeError, match="Cube: "):
        bpy.ops.uv.cone_unwrap()
    assert changed(before, snapshot(cube)) == set()


@pytest.mark.parametrize("in_edit_mode", [True, False])
def test_one_object_failing_does_not_stop_the_others(in_edit_mode, reports):
    bad, good = add_sphere("Bad"), add_cone_cube("Good")
    if in_edit_mode:
        edit(bad, good)
    before_bad, before_good = snapshot(bad), snapshot(good)
    reports()
    assert bpy.ops.uv.cone_unwrap() == {"FINISHED"}
    said = reports()
    assert changed(before_bad, snapshot(bad)) == set()
    assert changed(before_good, snapshot(good)) == {uv_key()}
    assert "Warning: Bad: " in said
    assert "Info: Good: 1 island, 0.0 % stretch" in said


def test_all_objects_failing_is_an_error_and_changes_nothing():
    objects = [add_sphere("First"), add_sphere("Second")]
    edit(*objects)
    before = [snapshot(obj) for obj in objects]
    with pytest.raises(RuntimeError, match="First, Second: "):
        bpy.ops.uv.cone_unwrap()
    assert [changed(old, snapshot(obj)) for old, obj in zip(before, objects, strict=True)] == [set(), set()]


def test_a_part_that_cannot_be_solved_keeps_its_uvs_and_is_named(reports):
    cube = add_cone_cube("Parts")
    cube_faces = len(cube.data.polygons)
    add_sphere("Sphere")
    bpy.context.view_layer.objects.active = cube
    bpy.ops.object.join()
    before = UvMap(cube)
    reports()
    assert bpy.ops.uv.cone_unwrap() == {"FINISHED"}
    said = reports()
    after = UvMap(cube)
    kept = [np.array_equal(before.uv[loops], after.uv[loops]) for loops in after.loops_of_face]
    assert kept == [face >= cube_faces for face in range(len(kept))]
    assert "Warning: Parts: " in said


def test_object_without_selected_faces_is_left_out():
    first, second = add_cone_cube("First"), add_cone_cube("Second")
    edit(first, second)
    select_elements(second, "faces", [])
    before = snapshot(second)
    assert bpy.ops.uv.cone_unwrap() == {"FINISHED"}
    assert changed(before, snapshot(second)) == set()


def test_no_selected_face_at_all_is_refused():
    cube = add_cone_cube()
    edit(cube, select="DESELECT")
    before = snapshot(cube)
    with pytest.raises(RuntimeError, match="select the faces to unwrap"):
        bpy.ops.uv.cone_unwrap()
    assert changed(before, snapshot(cube)) == set()


def test_mesh_without_faces_is_refused():
    obj = bpy.data.objects.new("Empty", bpy.data.meshes.new("Empty"))
    bpy.context.collection.objects.link(obj)
    obj.select_set(True)
    bpy.context.view_layer.objects.active = obj
    with pytest.raises(RuntimeError, match="Empty: the mesh has no faces"):
        bpy.ops.uv.cone_unwrap()


def test_objects_that_share_a_mesh_are_unwrapped_once(reports):
    cube = add_cone_cube()
    twin = bpy.data.objects.new("Twin", cube.data)
    bpy.context.collection.objects.link(twin)
    twin.select_set(True)
    reports()
    assert bpy.ops.uv.cone_unwrap() == {"FINISHED"}
    assert reports().count("1 island, ") == 1


def test_linked_mesh_is_refused_with_a_remedy(tmp_path):
    cube = add_cone_cube()
    bpy.data.libraries.write(str(tmp_path / "source.blend"), {cube.data})
    bpy.data.objects.remove(cube)
    with bpy.data.libraries.load(str(tmp_path / "source.blend"), link=True) as (source, target):
        target.meshes = source.meshes
    obj = bpy.data.objects.new("Linked", target.meshes[0])
    bpy.context.collection.objects.link(obj)
    obj.select_set(True)
    before = snapshot(obj)
    with pytest.raises(RuntimeError, match=r"Linked: .*make it local"):
        bpy.ops.uv.cone_unwrap()
    assert changed(before, snapshot(obj)) == set()


def test_cones_come_from_the_group_that_is_named():
    cube = add_cube()
    mark(cube, corners(cube), group="points")
    with pytest.raises(RuntimeError):
        bpy.ops.uv.cone_unwrap()
    assert bpy.ops.uv.cone_unwrap(vertex_group="points") == {"FINISHED"}


def test_weight_zero_does_not_mark_a_cone():
    cube = add_cube()
    cube.vertex_groups.new(name="uv_cones").add(corners(cube), 0.0, "REPLACE")
    with pytest.raises(RuntimeError):
        bpy.ops.uv.cone_unwrap()


@pytest.mark.parametrize("call", [bpy.ops.uv.cone_unwrap, bpy.ops.mesh.cone_place])
def test_polls_ask_for_a_mesh(call):
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    bpy.context.collection.objects.link(camera)
    camera.select_set(True)
    assert not call.poll()
    with pytest.raises(RuntimeError, match="edit mode on a mesh, or select mesh objects"):
        call()
