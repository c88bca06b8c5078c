# SPDX-License-Identifier: GPL-3.0-or-later
"""What the overlay shows, as arrays: cones by their curvature, both sides of every cut, faces with problems."""

from dataclasses import replace

import bpy
import numpy as np
import pytest
from installed import addon
from scenes import UvMap, add_ball, add_cone_cube, add_grid, add_sphere, corners, edit, mark

content, labels, colors, cache = (getattr(addon.overlay, name) for name in ("content", "labels", "colors", "cache"))
reports, cones = addon.mesh.reports, addon.mesh.cones


def shown(obj):
    return content.build_content(obj, reports.find(obj.data))


def give_angles(obj, angles):
    attribute = obj.data.attributes.new("uv_cone_angle", "FLOAT", "POINT")
    for vertex, angle in angles.items():
        attribute.data[vertex].value = angle


def test_marked_cones_are_shown_before_anything_is_unwrapped():
    cube = add_cone_cube()
    first, second, third = corners(cube)[:3]
    give_angles(cube, {first: 1.5 * np.pi, second: 2.5 * np.pi, third: 2 * np.pi})
    found = {cone.vertex: cone for cone in shown(cube).cones}
    assert sorted(found) == corners(cube)
    curvatures = [found[v].curvature for v in corners(cube)]
    assert curvatures[:3] == pytest.approx([np.pi / 2, -np.pi / 2, 0], abs=1e-6)
    assert curvatures[3:] == [None] * 5 == [found[v].angle for v in corners(cube)[3:]]
    assert len(shown(cube).cut_lines) == 0


def test_an_angle_on_a_border_is_compared_with_half_a_turn():
    grid = add_grid()
    corner, inside = 0, 24
    mark(grid, [corner, inside])
    give_angles(grid, {corner: 1.25 * np.pi, inside: 1.25 * np.pi})
    for in_edit_mode in (False, True):
        if in_edit_mode:
            edit(grid)
        found = [cone.curvature for cone in shown(grid).cones]
        assert found == pytest.approx([-np.pi / 4, 3 * np.pi / 4], abs=1e-6)


def test_imposed_angles_go_before_those_that_were_left_open():
    ball = add_ball()
    bpy.ops.uv.cone_unwrap()
    found = shown(ball).cones
    assert sum(cone.curvature for cone in found) == pytest.approx(4 * np.pi)
    assert [cone.angle for cone in found] == reports.find(ball.data).cone_angles


@pytest.mark.parametrize("build", [add_ball, add_cone_cube])
def test_edit_mode_shows_the_same(build):
    obj = build()
    bpy.ops.uv.cone_unwrap()
    before = shown(obj)
    edit(obj)
    after = shown(obj)
    assert after.cones == before.cones
    for name in ("cone_places", "cone_uv", "cone_rows", "cut_lines", "cut_paths", "cut_uv"):
        np.testing.assert_allclose(getattr(after, name), getattr(before, name), atol=1e-6)


def test_both_sides_of_every_cut_lie_beside_it_on_the_surface():
    cube = add_cone_cube()
    bpy.ops.uv.cone_unwrap()
    found, report = shown(cube), reports.find(cube.data)
    assert len(found.cut_lines) == 2 * len(UvMap(cube).split_edges())
    assert np.bincount(found.cut_paths).tolist() == [2 * (len(path) - 1) for path in report.paths]
    # All cuts run along edges of the cube, whose faces are squares of side 2: lines lie in these faces.
    on_face = np.isclose(np.abs(found.cut_lines), 1.0, atol=1e-6).any(axis=2)
    assert on_face.all()
    side = 2 / 4
    # On so large faces they would float if they were as far from the edges as on small ones.
    vertices = sorted({vertex for path in report.paths for vertex in path})
    places = np.array([cube.data.vertices[vertex].co for vertex in vertices])
    box = np.linalg.norm(np.ptp(places, axis=0))
    assert content.MOST_OFFSET * box < content.SIDE_OFFSET * side
    away = np.sort(1 - np.abs(found.cut_lines), axis=2)
    assert away[..., 1].max() == pytest.approx(content.MOST_OFFSET * box, abs=1e-6)


def test_segments_in_the_layout_are_the_split_edges_there():
    ball = add_ball()
    bpy.ops.uv.cone_unwrap()
    uv = UvMap(ball)
    split = [pair for edge in uv.split_edges() for pair in uv.sides[edge]]
    expected = {frozenset(map(tuple, uv.uv[list(pair)].round(5))) for pair in split}
    assert {frozenset(map(tuple, segment.astype(float).round(5))) for segment in shown(ball).cut_uv} == expected


def test_cones_are_at_all_their_places_in_the_layout():
    cube = add_cone_cube()
    bpy.ops.uv.cone_unwrap()
    found, uv = shown(cube), UvMap(cube)
    for row, cone in enumerate(found.cones):
        expected = {tuple(place) for place in uv.uv[uv.vertex == cone.vertex].round(6)}
        assert {tuple(place) for place in found.cone_uv[found.cone_rows == row].astype(float).round(6)} == expected
    # Where cuts end there is one, where they meet there are several.
    assert len(found.cone_uv) > len(found.cones)


def test_a_hidden_side_is_left_out():
    cube = add_cone_cube()
    bpy.ops.uv.cone_unwrap()
    whole = len(shown(cube).cut_lines)
    edit(cube)
    bpy.ops.mesh.hide()
    assert len(shown(cube).cut_lines) == 0 < whole


def test_faces_with_problems_are_covered_by_triangles():
    sphere = add_sphere()
    mark(sphere, [0, 5, 40, 60])
    bpy.ops.uv.cone_unwrap()
    report = replace(reports.find(sphere.data), flipped=[0, 20], overlapping=list(range(len(sphere.data.polygons))))
    areas = {}
    for in_edit_mode in (False, True):
        if in_edit_mode:
            edit(sphere)
        found = content.build_content(sphere, report)
        for name in ("flipped", "overlapping"):
            first, second = (getattr(found, name)[:, i] - getattr(found, name)[:, 0] for i in (1, 2))
            areas[name, in_edit_mode] = np.linalg.norm(np.cross(first, second), axis=1).sum() / 2
    bpy.ops.object.mode_set(mode="OBJECT")
    faces = sphere.data.polygons
    for in_edit_mode in (False, True):
        assert areas["flipped", in_edit_mode] == pytest.approx(faces[0].area + faces[20].area, rel=1e-4)
        assert areas["overlapping", in_edit_mode] == pytest.approx(sum(face.area for face in faces), rel=1e-4)


def test_an_empty_mesh_shows_nothing():
    mesh = bpy.data.meshes.new("Empty")
    obj = bpy.data.objects.new("Empty", mesh)
    bpy.context.collection.objects.link(obj)
    found = shown(obj)
    assert found.cones == [] and len(found.cut_lines) == len(found.flipped) == 0


def test_content_is_kept_until_the_mesh_changes():
    cube = add_cone_cube()
    bpy.ops.uv.cone_unwrap()
    bpy.context.view_layer.update()
    kept = cache.entry(cube)
    assert cache.entry(cube) is kept
    cones.mark_cones(cube, "uv_cones", [9])
    cube.data.update_tag()
    bpy.context.view_layer.update()
    assert cache.entry(cube) is not kept
    assert 9 in [cone.vertex for cone in cache.entry(cube).content.cones]


def test_selecting_builds_nothing_anew():
    cube = add_cone_cube()
    edit(cube)
    bpy.context.view_layer.update()
    kept = cache.entry(cube)
    bpy.ops.mesh.select_all(action="DESELECT")
    bpy.context.view_layer.update()
    assert cache.entry(cube) is kept


@pytest.mark.parametrize(
    "degrees, text", [(270, "270°"), (90.04, "90°"), (256.13, "256.1°"), (None, "auto"), (359.98, "360°")]
)
def test_angles_are_written_without_needless_digits(degrees, text):
    angle = None if degrees is None else np.radians(degrees)
    assert labels.label(content.Cone(0, angle, None)) == text


def test_labels_that_would_lie_on_others_are_left_out():
    boxes = [(0, 0, 10, 10), (5, 5, 15, 15), (11, 0, 20, 4), (30, 0, 40, 10)]
    assert labels.without_overlaps(boxes, [0, 1, 2, 3]) == [0, 2, 3]
    assert labels.without_overlaps(boxes, [1, 0, 2, 3]) == [1, 2, 3]


def test_cuts_of_one_kind_have_one_color():
    look, blank = addon.overlay.look.overlay_look(), np.zeros((3, 2, 3), np.float32)
    shown = content.Content(cut_lines=blank, cut_paths=np.array([0, 1, 2], np.int32), kinds=["seam", "added", "seam"])
    found = colors.of_cuts(shown, np.array([True, True, True]), look, "KIND")
    np.testing.assert_array_equal(found, np.array([look.seam_cut, look.added_cut, look.seam_cut], np.float32))
    some = colors.of_cuts(shown, np.array([False, True, False]), look, "KIND")
    np.testing.assert_array_equal(some, found[1:2])
    for unknown in (
        colors.of_cuts(replace(shown, kinds=[]), np.ones(3, bool), look, "KIND"),
        colors.of_cuts(shown, np.ones(3, bool), look, "MATCHING"),
    ):
        np.testing.assert_array_equal(unknown, colors.of_paths(shown.cut_paths, look))


def test_cut_colors_take_turns_and_then_lighter_ones():
    look = addon.overlay.look.overlay_look()
    count = len(look.cut_colors())
    found = colors.of_paths(np.array([0, 1, count, count + 1, 2 * count], np.int32), look)
    assert found[0] == pytest.approx(look.cut_1[:], abs=1e-6)
    np.testing.assert_array_equal(found[4], found[0])
    assert (found[2, :3] > found[0, :3]).all()
    assert len(np.unique(found, axis=0)) == 4


def test_colors_in_the_preferences_are_those_that_are_drawn():
    look = addon.overlay.look.overlay_look()
    half = np.pi / 4
    drawn = colors.of_cones([content.Cone(0, None, c) for c in (4.0, -4.0, 0.0, None, half, -half)], look)
    for row, name in zip(drawn, ("tip", "saddle", "flat", "automatic"), strict=False):
        assert row == pytest.approx(getattr(look, name)[:], abs=1e-6)
    np.testing.assert_allclose(drawn[4], (drawn[0] + drawn[2]) / 2, atol=1e-6)
    np.testing.assert_allclose(drawn[5], (drawn[1] + drawn[2]) / 2, atol=1e-6)


def test_without_preferences_the_overlay_has_the_default_look(monkeypatch):
    preferences = addon.core.preferences.preferences()
    monkeypatch.setattr(addon.overlay.look, "preferences", lambda: None)
    look = addon.overlay.look.overlay_look()
    for name in (*addon.overlay.look.CUT_NAMES, "tip", "flipped"):
        assert getattr(look, name) == pytest.approx(getattr(preferences, name)[:], abs=1e-6)
    for name in ("line_width", "cone_size", "text_size"):
        assert getattr(look, name) == getattr(preferences, name)
    assert look.cut_colors() == [getattr(look, name) for name in addon.overlay.look.CUT_NAMES]
