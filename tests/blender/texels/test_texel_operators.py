# SPDX-License-Identifier: GPL-3.0-or-later
"""Texel density: get, set, select and show, compared with areas by Heron's formula in world space."""

import math
from dataclasses import replace

import bmesh
import bpy
import numpy as np
import pytest
from installed import addon
from mathutils import Matrix
from scenes import (
    UvMap,
    add_ball,
    add_cone_cube,
    add_grid,
    add_texture,
    add_tube,
    changed,
    edit,
    select_elements,
    set_uv,
    snapshot,
    uv_key,
)

saved_reports, tables = addon.mesh.reports, addon.ui.tables


def heron(corners):
    """(m,) areas of (m, 3, d) triangles by the lengths of their sides."""
    lengths = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2)
    c, b, a = np.sort(lengths, axis=1).T
    return np.sqrt(np.maximum((a + (b + c)) * (c - (a - b)) * (c + (a - b)) * (a + (b - c)), 0)) / 4


def areas(obj):
    """(t,) areas of the triangles in the map and in the world, and the face of each."""
    uv_map = UvMap(obj)
    places = uv_map.positions @ np.array(obj.matrix_world.to_3x3()).T
    return heron(uv_map.uv[uv_map.triangles]), heron(places[uv_map.vertex[uv_map.triangles]]), uv_map.face_of_triangle


def density(obj, side, faces=None):
    mapped, area, face = areas(obj)
    chosen = np.full(len(face), True) if faces is None else np.isin(face, list(faces))
    return side * math.sqrt(mapped[chosen].sum() / area[chosen].sum())


def got():
    return bpy.context.scene.cone_unwrap_texels.density


def stretched_ball(name="Ball"):
    """A ball whose transform stretches and shears it."""
    ball = add_ball(name)
    bpy.ops.uv.cone_unwrap()
    ball.matrix_world = Matrix(((2, 0.4, 0, 1), (0, 3, 0, 2), (0.1, 0, 0.5, 3), (0, 0, 0, 1)))
    bpy.context.view_layer.update()
    return ball


def islands_of(obj):
    islands = {}
    for face, island in enumerate(UvMap(obj).island_of_face()):
        islands.setdefault(island, set()).add(face)
    return list(islands.values())


def bounds(obj, faces):
    uv_map = UvMap(obj)
    uv = uv_map.uv[[loop for face in faces for loop in uv_map.loops_of_face[face]]]
    return uv.min(axis=0), uv.max(axis=0)


@pytest.mark.parametrize("in_edit_mode", [True, False])
def test_the_density_is_that_of_areas_in_the_world(in_edit_mode, reports):
    ball = stretched_ball()
    if in_edit_mode:
        edit(ball)
    before = snapshot(ball)
    reports()
    assert bpy.ops.uv.cone_texel_get(use_image=False, texture_size=2048) == {"FINISHED"}
    assert got() == pytest.approx(density(ball, 2048), rel=1e-5)
    mapped, area, _ = areas(ball)
    each = 2048 * np.sqrt(mapped / area)
    assert f"{got():.1f} px/m, from {each.min():.1f} to {each.max():.1f} px/m" in reports().replace(" px/m to", " to")
    assert changed(before, snapshot(ball)) == set()


def test_of_selected_faces_and_of_several_objects():
    balls = [stretched_ball("A"), stretched_ball("B")]
    balls[1].scale *= 2
    bpy.context.view_layer.update()
    edit(*balls, select="DESELECT")
    faces = [3, 4, 5, 20]
    select_elements(balls[0], "faces", faces)
    bpy.ops.uv.cone_texel_get(use_image=False, texture_size=512)
    assert got() == pytest.approx(density(balls[0], 512, faces), rel=1e-5)
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.uv.cone_texel_get(use_image=False, texture_size=512)
    mapped, area = (np.concatenate(parts) for parts in zip(*(areas(ball)[:2] for ball in balls), strict=True))
    assert got() == pytest.approx(512 * math.sqrt(mapped.sum() / area.sum()), rel=1e-5)
    bpy.ops.mesh.select_all(action="DESELECT")
    with pytest.raises(RuntimeError, match="No face is selected"):
        bpy.ops.uv.cone_texel_get()


def test_the_texture_is_the_active_image_or_as_typed():
    ball = stretched_ball()
    add_texture(ball, 2048, 512)
    bpy.ops.uv.cone_texel_get(texture_size=64)
    assert got() == pytest.approx(density(ball, 1024), rel=1e-5)
    bpy.ops.uv.cone_texel_get(texture_size=64, use_image=False)
    assert got() == pytest.approx(density(ball, 64), rel=1e-5)
    ball.data.materials.clear()
    bpy.ops.uv.cone_texel_get(texture_size=128)
    assert got() == pytest.approx(density(ball, 128), rel=1e-5)


@pytest.mark.parametrize(
    ("system", "unit", "scale", "name", "meters"),
    [
        ("METRIC", "METERS", 1.0, "px/m", 1.0),
        ("METRIC", "CENTIMETERS", 0.01, "px/cm", 0.01),
        ("METRIC", "ADAPTIVE", 10.0, "px/m", 1.0),
        ("IMPERIAL", "FEET", 1.0, "px/ft", 0.3048),
        ("IMPERIAL", "INCHES", 2.0, "px/in", 0.0254),
        ("IMPERIAL", "ADAPTIVE", 1.0, "px/ft", 0.3048),
        ("NONE", None, 1.0, "px/unit", 1.0),
    ],
)
def test_lengths_are_in_the_unit_of_the_scene(system, unit, scale, name, meters, reports):
    settings = bpy.context.scene.unit_settings
    settings.system, settings.scale_length = system, scale
    if unit is not None:
        settings.length_unit = unit
    ball = stretched_ball()
    reports()
    bpy.ops.uv.cone_texel_get(use_image=False)
    # A unit of Blender's is `scale` meters.
    wanted = density(ball, 1024) * meters / scale
    assert got() == pytest.approx(wanted, rel=1e-5)
    assert name in reports()
    bpy.ops.uv.cone_texel_set(use_image=False, density=3 * wanted)
    bpy.ops.uv.cone_texel_get(use_image=False)
    assert got() == pytest.approx(3 * wanted, rel=1e-4)


@pytest.mark.parametrize("in_edit_mode", [True, False])
def test_every_island_is_scaled_about_its_middle(in_edit_mode):
    cube = add_cone_cube()
    if in_edit_mode:
        edit(cube)
    bpy.ops.uv.smart_project() if in_edit_mode else bpy.ops.uv.cone_unwrap()
    cube.scale = (1, 2, 3)
    bpy.context.view_layer.update()
    before = snapshot(cube)
    islands = islands_of(cube)
    middles = [sum(bounds(cube, faces)) / 2 for faces in islands]
    assert bpy.ops.uv.cone_texel_set(use_image=False, texture_size=512, density=37.5) == {"FINISHED"}
    assert changed(before, snapshot(cube)) == {uv_key()}
    assert islands_of(cube) == islands
    for faces, middle in zip(islands, middles, strict=True):
        assert density(cube, 512, faces) == pytest.approx(37.5, rel=1e-4)
        assert sum(bounds(cube, faces)) / 2 == pytest.approx(middle, abs=1e-6)


def test_only_the_islands_of_selected_faces_are_scaled_and_as_wholes():
    cube = add_cone_cube()
    edit(cube)
    bpy.ops.uv.smart_project()
    islands = islands_of(cube)
    assert len(islands) == 6
    before = [density(cube, 1024, faces) for faces in islands]
    select_elements(cube, "faces", [min(islands[0]), max(islands[2])])
    bpy.ops.uv.cone_texel_set(use_image=False, density=77)
    after = [density(cube, 1024, faces) for faces in islands]
    expected = [77 if i in (0, 2) else value for i, value in enumerate(before)]
    assert after == pytest.approx(expected, rel=1e-4)
    bpy.ops.mesh.select_all(action="DESELECT")
    with pytest.raises(RuntimeError, match="No face is selected"):
        bpy.ops.uv.cone_texel_set()


def test_a_map_without_area_is_left_alone_and_said_to_be(reports):
    grid = add_grid()
    set_uv(grid, np.zeros((len(grid.data.loops), 2)))
    assert bpy.ops.uv.cone_texel_set(density=10) == {"CANCELLED"}
    assert "skipped because they have no area" in reports()
    with pytest.raises(RuntimeError, match="no area"):
        bpy.ops.uv.cone_texel_get()


def test_a_map_without_finite_coordinates_is_refused():
    ball = stretched_ball()
    set_uv(ball, np.full_like(UvMap(ball).uv, np.nan))
    before = snapshot(ball)
    with pytest.raises(RuntimeError, match="no finite coordinates"):
        bpy.ops.uv.cone_texel_set(density=64.0)
    assert changed(before, snapshot(ball)) == set()


def test_what_has_no_map_or_no_size_is_refused():
    grid = add_grid()
    grid.scale = (0, 0, 0)
    bpy.context.view_layer.update()
    with pytest.raises(RuntimeError, match="scaled to zero"):
        bpy.ops.uv.cone_texel_get()
    grid.data.uv_layers.remove(grid.data.uv_layers[0])
    for operator in (bpy.ops.uv.cone_texel_get, bpy.ops.uv.cone_texel_set):
        with pytest.raises(RuntimeError, match="has no UV map; unwrap it first"):
            operator()


@pytest.mark.parametrize("compare", ["EQUAL", "LESS", "GREATER"])
def test_faces_are_selected_by_their_density(compare):
    ball = stretched_ball()
    edit(ball, select="DESELECT")
    mapped, area, face = areas(ball)
    each = 1024 * np.sqrt(np.bincount(face, mapped) / np.bincount(face, area))
    wanted = float(np.median(each))
    assert bpy.ops.mesh.cone_texel_select(use_image=False, density=wanted, compare=compare, tolerance=15) == {
        "FINISHED"
    }
    fits = {
        "EQUAL": np.abs(each / wanted - 1) <= 0.15,
        "LESS": each / wanted < 0.85,
        "GREATER": each / wanted > 1.15,
    }[compare]
    chosen = {f.index for f in bmesh.from_edit_mesh(ball.data).faces if f.select}
    assert chosen == set(np.flatnonzero(fits).tolist()) and 0 < len(chosen) < len(each)
    assert tuple(bpy.context.tool_settings.mesh_select_mode) == (False, False, True)


def test_no_face_that_fits_is_said(reports):
    edit(stretched_ball())
    reports()
    assert bpy.ops.mesh.cone_texel_select(density=1e5) == {"CANCELLED"}
    assert "No face fits 100000 px/m" in reports()


def test_the_table_has_least_median_and_most():
    ball = add_ball()
    ball.scale = (1, 2, 0.5)
    bpy.context.view_layer.update()
    bpy.ops.uv.cone_unwrap()
    report = saved_reports.find(ball.data)
    rows = {label: float(value) for label, value, _ in tables.texel_rows(report, bpy.context.scene, (2048, 512))}
    mapped, area, _ = areas(ball)
    each = 1024 * np.sqrt(mapped / area)
    order = np.argsort(each)
    median = each[order][np.searchsorted(np.cumsum(area[order]), area.sum() / 2)]
    assert rows == pytest.approx(
        {
            "px/m, Least": each.min(),
            "px/m, Median": median,
            "px/m, Most": each.max(),
        },
        rel=2e-3,
    )
    assert tables.texel_rows(replace(report, texel_density=None), bpy.context.scene, (8, 8)) == []


@pytest.mark.parametrize("in_edit_mode", [True, False])
def test_the_report_goes_on_with_the_scaled_islands(in_edit_mode):
    ball = add_ball()
    bpy.ops.uv.cone_unwrap(seamless=True)
    before = saved_reports.find(ball.data)
    assert before.certificate is not None
    if in_edit_mode:
        edit(ball)
    bpy.ops.uv.cone_texel_set(use_image=False, density=200)
    after = saved_reports.find(ball.data)
    assert (after.paths, after.cones, after.flipped) == (before.paths, before.cones, before.flipped)
    # One island, so nothing else has changed.
    assert (after.distortion, after.seams, after.overlapping) == (before.distortion, before.seams, before.overlapping)
    assert after.certificate is None and after.overlaps_known
    mapped, area, _ = areas(ball)
    low, _, high = after.texel_density
    assert (low, high) == pytest.approx((np.sqrt(mapped / area).min(), np.sqrt(mapped / area).max()), rel=1e-3)


def test_of_islands_of_several_scales_the_report_is_measured_anew():
    add_tube()
    add_grid()
    bpy.ops.object.select_all(action="SELECT")
    bpy.ops.object.join()
    joined = bpy.context.object
    assert bpy.ops.uv.cone_unwrap() == {"FINISHED"}
    before = saved_reports.find(joined.data)
    edit(joined)
    islands = islands_of(joined)
    assert len(islands) == 2 and ("Overlapping Faces", "0", "0") in tables.quality_rows(before)
    select_elements(joined, "faces", [min(islands[0])])
    bpy.ops.uv.cone_texel_set(use_image=False, density=5 * density(joined, 1024))
    after = saved_reports.find(joined.data)
    assert after.distortion["l2_stretch"] == pytest.approx(UvMap(joined).l2_stretch(), rel=1e-4)
    assert after.distortion["l2_stretch"] > 1.2 * before.distortion["l2_stretch"]
    # Where islands lie after that was not looked at.
    assert ("Overlapping Faces", "?", "0") in tables.quality_rows(after)


def test_what_is_not_said_is_taken_from_the_settings_of_the_scene():
    ball = stretched_ball()
    settings = bpy.context.scene.cone_unwrap_texels
    settings.density, settings.texture_size, settings.use_image = 55, 256, False
    add_texture(ball, 4096, 4096)
    assert bpy.ops.uv.cone_texel_set() == {"FINISHED"}
    assert density(ball, 256) == pytest.approx(55, rel=1e-4)
    assert bpy.ops.uv.cone_texel_set(density=11) == {"FINISHED"}
    assert density(ball, 256) == pytest.approx(11, rel=1e-4)
