# SPDX-License-Identifier: GPL-3.0-or-later
"""Measure Distortion: attributes of faces that hold the distortion, and leave no trace once cleared."""

import bpy
import numpy as np
import pytest
from installed import addon
from scenes import UvMap, add_ball, add_cone_cube, add_grid, add_object, changed, edit, plain_copy, set_uv, snapshot

distortion, heat = addon.mesh.distortion, addon.overlay.heat

NAMES = [f"uv_cone_distortion_{measure}" for measure in ("conformal", "area", "stretch")]
KEYS = {f"attribute {name} FACE FLOAT" for name in NAMES}


def values(obj):
    mesh = plain_copy(obj)
    found = []
    for name in NAMES:
        of_face = np.empty(len(mesh.polygons), np.float32)
        mesh.attributes[name].data.foreach_get("value", of_face)
        found.append(of_face)
    bpy.data.meshes.remove(mesh)
    return np.array(found)


def expected(obj):
    """Means over each face's triangles by area, from numpy's singular values."""
    uv = UvMap(obj)
    place = uv.positions[uv.vertex[uv.triangles]]
    edges = np.stack([place[:, 1] - place[:, 0], place[:, 2] - place[:, 0]], axis=2)
    there = uv.uv[uv.triangles]
    images = np.stack([there[:, 1] - there[:, 0], there[:, 2] - there[:, 0]], axis=2)
    s = np.linalg.svd(images @ np.linalg.inv(np.linalg.qr(edges)[1]), compute_uv=False)
    area = np.linalg.norm(np.cross(edges[:, :, 0], edges[:, :, 1]), axis=1) / 2
    unit = (s.prod(axis=1) * area).sum() / area.sum()
    of_triangle = [s[:, 0] / s[:, 1], s.prod(axis=1) / unit, np.sqrt((1 / s**2).mean(axis=1) * unit)]
    total = np.bincount(uv.face_of_triangle, area)
    return np.array([np.bincount(uv.face_of_triangle, area * v) / total for v in of_triangle])


@pytest.mark.parametrize("in_edit_mode", [False, True])
def test_measures_are_those_of_numpys_singular_values(in_edit_mode):
    ball = add_ball()
    bpy.ops.uv.cone_unwrap()
    if in_edit_mode:
        edit(ball, select="DESELECT")
    before = snapshot(ball)
    assert bpy.ops.uv.cone_measure() == {"FINISHED"}
    assert changed(before, snapshot(ball)) == KEYS
    np.testing.assert_allclose(values(ball), expected(ball), rtol=1e-4)


@pytest.mark.parametrize("in_edit_mode", [False, True])
def test_clearing_leaves_no_trace(in_edit_mode):
    ball = add_ball()
    bpy.ops.uv.cone_unwrap()
    if in_edit_mode:
        edit(ball)
    before, properties = snapshot(ball), sorted(ball.data.keys())
    bpy.ops.uv.cone_measure()
    assert bpy.ops.uv.cone_measure(clear=True) == {"FINISHED"}
    assert changed(before, snapshot(ball)) == set()
    assert sorted(ball.data.keys()) == properties
    assert not ball.data.is_property_set("cone_unwrap_measured")


def test_measured_twice_is_as_measured_once():
    ball = add_ball()
    bpy.ops.uv.cone_unwrap()
    bpy.ops.uv.cone_measure()
    once = snapshot(ball)
    bpy.ops.uv.cone_measure()
    assert changed(once, snapshot(ball)) == set()


def test_any_uv_map_can_be_measured_and_an_even_one_has_no_distortion():
    grid = add_grid()
    set_uv(grid, np.array([grid.data.vertices[loop.vertex_index].co[:2] for loop in grid.data.loops]) * 3 + 1)
    bpy.ops.uv.cone_measure()
    np.testing.assert_allclose(values(grid), 1, rtol=1e-5)


def test_collapsed_and_empty_faces_have_finite_values():
    grid = add_grid()
    for vertex in grid.data.polygons[0].vertices:
        grid.data.vertices[vertex].co = (0, 0, 0)
    uv = np.random.default_rng(1).uniform(size=(len(grid.data.loops), 2))
    uv[list(grid.data.polygons[20].loop_indices)] = 0.5
    set_uv(grid, uv)
    assert bpy.ops.uv.cone_measure() == {"FINISHED"}
    assert np.isfinite(values(grid)).all()
    assert (values(grid)[:, 0] == 0).all()


def test_measures_are_shown_only_of_the_map_they_are_of():
    cube = add_cone_cube()
    bpy.ops.uv.cone_unwrap()
    bpy.ops.uv.cone_measure()
    assert distortion.is_current(cube.data)
    cube.data.uv_layers.active.uv[0].vector.x += 0.5
    assert distortion.is_measured(cube.data) and not distortion.is_current(cube.data)
    bpy.ops.uv.cone_measure()
    assert distortion.is_current(cube.data)
    edit(cube)
    assert distortion.is_current(cube.data)


def test_several_objects_are_measured_and_one_without_a_uv_map_is_named(reports):
    first = add_cone_cube("First")

    def build(bm):
        bm.faces.new([bm.verts.new(place) for place in ((0, 0, 0), (1, 0, 0), (0, 1, 0))])

    add_object("Bare", build)
    second = add_cone_cube("Second")
    for obj in bpy.data.objects:
        obj.select_set(True)
    reports()
    assert bpy.ops.uv.cone_measure() == {"FINISHED"}
    assert "Bare: the mesh has no UV map; unwrap it first" in reports()
    assert distortion.is_measured(first.data) and distortion.is_measured(second.data)
    bpy.ops.uv.cone_measure(clear=True)
    assert not distortion.is_measured(first.data)
    reports()
    assert bpy.ops.uv.cone_measure(clear=True) == {"CANCELLED"}
    assert "nothing to clear" in reports()


@pytest.mark.parametrize("measure", heat.SCALES)
def test_scales_have_their_colors_at_the_ends_and_nothing_beyond(measure):
    scale = heat.SCALES[measure]
    found = scale.colors_of([0, scale.least, scale.most, 1e30])
    np.testing.assert_array_equal(found[0], found[1])
    np.testing.assert_array_equal(found[2], found[3])
    np.testing.assert_allclose(found[1, :3], scale.colors[0], rtol=1e-6)
    np.testing.assert_allclose(found[3, :3], scale.colors[-1], rtol=1e-6)


def test_even_faces_have_the_middle_color():
    for measure in ("area", "stretch"):
        scale = heat.SCALES[measure]
        np.testing.assert_allclose(scale.colors_of([1.0])[0, :3], scale.colors[2], rtol=1e-6)
