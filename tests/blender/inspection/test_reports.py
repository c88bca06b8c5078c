# SPDX-License-Identifier: GPL-3.0-or-later
"""The report of an unwrap is kept with the mesh and shown only for the UV map that it is about."""

import base64
import zlib
from dataclasses import replace
from itertools import pairwise

import bmesh
import bpy
import numpy as np
import pytest
from installed import addon
from scenes import GROUP, UvMap, add_ball, add_cone_cube, add_ramp, corners, edit, joined, mark, select_elements, set_uv

reports, changes = addon.mesh.reports, addon.mesh.changes


def edges_along(paths):
    return sorted(tuple(sorted(edge)) for path in paths for edge in pairwise(path))


@pytest.mark.parametrize("in_edit_mode", [False, True])
def test_a_report_holds_the_cuts_and_the_cones_that_were_imposed(in_edit_mode):
    ball = add_ball()
    cones = corners_of(ball)
    if in_edit_mode:
        edit(ball)
    bpy.ops.uv.cone_unwrap()
    report = reports.find(ball.data)
    assert edges_along(report.paths) == sorted(UvMap(ball).split_edges())
    assert report.cones == cones
    assert sum(2 * np.pi - angle for angle in report.cone_angles) == pytest.approx(4 * np.pi)
    assert (report.faces, report.islands, report.flipped, report.overlapping) == (96, 1, [], [])
    assert report.distortion["l2_stretch"] == pytest.approx(UvMap(ball).l2_stretch(), rel=1e-4)
    assert report.certificate is None


def corners_of(ball):
    return sorted(v.index for v in ball.data.vertices if v.groups)


def test_overlapping_faces_are_named():
    ramp = add_ramp()
    bpy.ops.uv.cone_unwrap(overlaps="KEEP")
    report = reports.find(ramp.data)
    faces = len(ramp.data.polygons)
    assert 0 < len(report.overlapping) <= faces and set(report.overlapping) <= set(range(faces))
    bpy.ops.uv.cone_unwrap(overlaps="SPLIT")
    assert reports.find(ramp.data).overlapping == []


def test_a_seamless_report_has_the_certificate_of_every_cut():
    add_ball()
    bpy.ops.uv.cone_unwrap(seamless=True)
    certificate = reports.find(bpy.context.object.data).certificate
    assert certificate["rotation_order"] == 4 and certificate["error"] == 0
    assert len(certificate["cuts"]) == len(reports.find(bpy.context.object.data).paths)


def test_a_report_is_saved_with_the_file(tmp_path):
    cube = add_cone_cube()
    bpy.ops.uv.cone_unwrap()
    report = reports.find(cube.data)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "cube.blend"))
    reports._known.clear()
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "cube.blend"))
    assert reports.find(bpy.data.objects["Cube"].data) == report


def move_uv(cube):
    cube.data.uv_layers.active.uv[0].vector.x += 0.25


def turn_face(cube):
    edit(cube)
    bpy.ops.mesh.flip_normals()
    bpy.ops.object.mode_set(mode="OBJECT")


def sort_faces(cube):
    edit(cube)
    bpy.ops.mesh.sort_elements(type="REVERSE", elements={"FACE"})
    bpy.ops.object.mode_set(mode="OBJECT")


def remove_face(cube):
    edit(cube)
    select_elements(cube, "faces", [50])
    bpy.ops.mesh.delete(type="FACE")
    bpy.ops.object.mode_set(mode="OBJECT")


def other_layer(cube):
    cube.data.uv_layers.new(name="Other")
    cube.data.uv_layers.active_index = 1


@pytest.mark.parametrize("change", [move_uv, turn_face, sort_faces, remove_face, other_layer])
def test_nothing_is_told_of_a_map_or_a_mesh_that_has_changed(change):
    cube = add_cone_cube()
    bpy.ops.uv.cone_unwrap()
    assert reports.current(cube.data) is not None
    change(cube)
    changes.mark_changed(cube.data)
    assert reports.find(cube.data) is None and reports.current(cube.data) is None


def test_the_report_comes_back_with_the_map():
    cube = add_cone_cube()
    bpy.ops.uv.cone_unwrap()
    first, uv = reports.find(cube.data), UvMap(cube).uv
    bpy.ops.uv.cone_unwrap(seamless=True, tile_fit="TILES", tiles=8)
    second = reports.find(cube.data)
    assert second != first
    set_uv(cube, uv)
    assert reports.find(cube.data) == first


def test_moving_vertices_leaves_the_report():
    cube = add_cone_cube()
    edit(cube)
    bpy.ops.uv.cone_unwrap()
    report = reports.find(cube.data)
    for vertex in bmesh.from_edit_mesh(cube.data).verts:
        vertex.co.z *= 2
    bmesh.update_edit_mesh(cube.data)
    assert reports.find(cube.data) == report


def test_the_report_is_the_same_in_edit_mode():
    cube = add_cone_cube()
    bpy.ops.uv.cone_unwrap()
    report = reports.find(cube.data)
    edit(cube)
    assert reports.find(cube.data) == report


def test_faces_unwrapped_one_after_the_other_are_all_told_of():
    first = joined(add_cone_cube("Cube"), add_cone_cube("Second"))
    half = len(first.data.polygons) // 2
    edit(first, select="DESELECT")
    select_elements(first, "faces", range(half))
    bpy.ops.uv.cone_unwrap()
    one = reports.find(first.data)
    select_elements(first, "faces", range(half, 2 * half))
    bpy.ops.uv.cone_unwrap()
    both = reports.find(first.data)
    assert both.faces == half and one.faces == half
    assert len(both.cones) == 16 and both.cones[:8] == one.cones
    assert edges_along(both.paths) == sorted(UvMap(first).split_edges())
    # Unwrapped again, a part replaces what was told of it.
    bpy.ops.uv.cone_unwrap(seamless=True)
    assert len(reports.find(first.data).cones) == 16


def test_a_refused_unwrap_leaves_the_report():
    cube = add_cone_cube()
    bpy.ops.uv.cone_unwrap()
    before = reports.find(cube.data)
    cube.data.vertices[corners(cube)[0]].co.x = float("nan")
    with pytest.raises(RuntimeError):
        bpy.ops.uv.cone_unwrap()
    assert reports.find(cube.data) == before


def test_what_another_version_has_written_is_ignored():
    cube = add_cone_cube()
    mark(cube, [], GROUP)
    bpy.ops.uv.cone_unwrap()
    digest = cube.data.cone_unwrap_report.partition("\n")[0]
    packed = [base64.b85encode(zlib.compress(text)).decode() for text in (b'{"paths": []}', b"[1]", b"no JSON")]
    for text in ('{"paths": [[0, 1]], "cones": [3]}', "[1]", "nonsense", "", "ä", *packed):
        reports._known.clear()
        cube.data.cone_unwrap_report = f"{digest}\n{text}"
        assert reports.find(cube.data) is None


def test_a_report_on_a_hundred_thousand_triangles_takes_few_characters():
    cube = add_cone_cube()
    bpy.ops.uv.cone_unwrap(seamless=True)
    faces = 50_000
    large = replace(
        reports.find(cube.data),
        # Cuts along rows and columns of a grid of 250 by 200 quads, and all faces but some.
        paths=[list(range(251 * row, 251 * (row + 1))) for row in range(0, 200, 20)]
        + [list(range(column, 251 * 201, 251)) for column in range(0, 250, 25)],
        overlapping=[face for face in range(faces) if face % 10_000 > 100],
        flipped=[17, 4000, 4001, 4002],
        faces=faces,
    )
    reports.store(cube.data, large)
    assert len(cube.data.cone_unwrap_report) < 4000
    reports._known.clear()
    assert reports.find(cube.data) == large


@pytest.mark.parametrize(
    ("numbers", "runs"),
    [
        ([], []),
        ([0], [0, 1]),
        ([7], [7, 1]),
        (list(range(5, 1000)), [5, 1, 1, 994]),
        ([4, 2, 0, 9], [4, 1, -2, 2, 9, 1]),
    ],
)
def test_numbers_in_equal_steps_are_kept_as_runs(numbers, runs):
    assert addon.core.runs.as_runs(numbers) == runs
    assert addon.core.runs.from_runs(runs) == numbers
