# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes whose edges are split, as importers leave them, are unwrapped as if they were whole, and stay split."""

import bmesh
import bpy
import numpy as np
import pytest
from installed import addon
from scenes import UvMap, add_ball, add_grid, add_tube, changed, edit, mark, marked, snapshot, uv_key

reader = addon.mesh.reader.reader
reports_of, build_content = addon.mesh.reports, addon.overlay.content.build_content


def split(obj, accepts=lambda edge: True):
    """Give both sides of edges vertices of their own; of all edges by default."""
    bm = bmesh.new()
    bm.from_mesh(obj.data)
    bmesh.ops.split_edges(bm, edges=[edge for edge in bm.edges if accepts(edge)])
    bm.to_mesh(obj.data)
    bm.free()
    return obj


def across(edge):
    return (edge.verts[0].co.z + 0.05) * (edge.verts[1].co.z + 0.05) < 0 or edge.verts[0].co.x > 0.5


def merged(obj):
    """A copy with one vertex at each place."""
    copy = bpy.data.objects.new("Merged", obj.data.copy())
    bpy.context.collection.objects.link(copy)
    bm = bmesh.new()
    bm.from_mesh(copy.data)
    bmesh.ops.remove_doubles(bm, verts=bm.verts, dist=1e-5)
    bm.to_mesh(copy.data)
    bm.free()
    return copy


def add_ball_of_quads(around=16, rows=8):
    """With a vertex for each face at the poles, as lathes and exporters leave them."""
    turns = np.arange(around) * 2 * np.pi / around
    heights = np.linspace(0, np.pi, rows + 1)
    positions = [(np.sin(h) * np.cos(a), np.sin(h) * np.sin(a), np.cos(h)) for h in heights for a in turns]
    for first, z in ((0, 1.0), (rows * around, -1.0)):
        positions[first : first + around] = [(0.0, 0.0, z)] * around
    i, j = np.arange(around), np.roll(np.arange(around), -1)
    quads = [np.stack([i, i + around, j + around, j], axis=1) + row * around for row in range(rows)]
    mesh = bpy.data.meshes.new("Quads")
    mesh.from_pydata(positions, [], np.concatenate(quads).tolist())
    mesh.uv_layers.new(name="UVMap")
    obj = bpy.data.objects.new("Quads", mesh)
    bpy.context.collection.objects.link(obj)
    bpy.context.view_layer.objects.active = obj
    obj.select_set(True)
    return obj


def edit_mode_off():
    if bpy.context.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")


@pytest.fixture(params=[lambda edge: True, across], ids=["all", "some"])
def ball(request):
    """Split, with cones at one copy of each place."""
    obj = add_ball()
    places = [tuple(obj.data.vertices[i].co) for i in marked(obj)]
    obj.vertex_groups.clear()
    split(obj, request.param)
    copies = [[vertex.index for vertex in obj.data.vertices if tuple(vertex.co) == place] for place in places]
    mark(obj, [of_one[-1] for of_one in copies])
    return obj


@pytest.mark.slow
@pytest.mark.one_blender
@pytest.mark.parametrize("preset", ["PAINT", "TILE", "BAKE"])
@pytest.mark.parametrize("in_edit_mode", [False, True])
def test_a_split_ball_becomes_one_island(ball, preset, in_edit_mode):
    ball.vertex_groups.clear()
    if in_edit_mode:
        edit(ball)
    before = snapshot(ball)
    assert bpy.ops.uv.cone_auto_unwrap(preset=preset) == {"FINISHED"}
    assert changed(before, snapshot(ball)) == {uv_key()}
    edit_mode_off()
    whole = UvMap(merged(ball))
    assert len(whole.split_edges()) < 0.25 * len(whole.sides)
    assert whole.sister_difference() < 2e-6


def test_cones_at_copies_count_once_and_cuts_are_shown_on_both_sides(ball):
    found = marked(ball)
    assert bpy.ops.uv.cone_unwrap(overlaps="KEEP") == {"FINISHED"}
    stitched = reader(ball.data).stitched
    report = reports_of.find(ball.data)
    assert report.cones == sorted(stitched[found].tolist())
    edges = sum(len(path) - 1 for path in report.paths)
    shown = [build_content(ball, report)]
    assert len(shown[0].cut_lines) == 2 * edges
    assert sorted(cone.vertex for cone in shown[0].cones) == report.cones
    assert all(cone.angle is not None for cone in shown[0].cones)
    assert len(shown[0].cone_uv) > len(shown[0].cones), "cut cones have several places in the map"
    edit(ball)
    shown.append(build_content(ball, report))
    assert np.array_equal(shown[0].cut_uv, shown[1].cut_uv)
    assert np.array_equal(shown[0].cones, shown[1].cones)
    assert np.array_equal(shown[0].cone_uv, shown[1].cone_uv)


@pytest.mark.parametrize("add", [add_ball, add_tube, add_grid, add_ball_of_quads])
@pytest.mark.parametrize("accepts", [lambda edge: True, across, lambda edge: False])
def test_both_readers_see_the_same_surface(add, accepts):
    obj = split(add(), accepts)
    mesh = reader(obj.data)
    stitched, border = mesh.stitched, np.array(mesh.on_border(range(len(mesh.stitched))))
    triangles = mesh.all_triangles()
    whole = merged(obj)
    assert len(np.unique(triangles)) == len(whole.data.vertices)
    assert border[np.unique(stitched)].sum() == sum(reader(whole.data).on_border(range(len(whole.data.vertices))))
    edit(obj)
    edited = reader(obj.data)
    assert np.array_equal(edited.stitched, stitched)
    assert np.array_equal(edited.on_border(np.unique(stitched)), border[np.unique(stitched)])
    assert np.array_equal(edited.all_triangles(), triangles)


def test_marking_and_clearing_any_copy_is_for_all(ball):
    ball.vertex_groups.clear()
    stitched = reader(ball.data).stitched
    copies = np.flatnonzero(stitched == stitched[-1])
    assert len(copies) > 1
    edit(ball, select="DESELECT")
    bpy.ops.mesh.select_mode(type="VERT")

    def select(vertex):
        bpy.ops.mesh.select_all(action="DESELECT")
        bm = bmesh.from_edit_mesh(ball.data)
        bm.verts.ensure_lookup_table()
        bm.verts[vertex].select_set(True)

    select(copies[-1])
    assert bpy.ops.mesh.cone_mark() == {"FINISHED"}
    select(copies[1])
    assert bpy.ops.mesh.cone_mark() == {"CANCELLED"}, "it is a cone already"
    assert bpy.ops.mesh.cone_mark(clear=True) == {"FINISHED"}
    assert marked(ball) == []
    # As weight painting leaves them.
    edit_mode_off()
    mark(ball, copies.tolist())
    edit(ball)
    select(copies[0])
    assert bpy.ops.mesh.cone_mark(clear=True) == {"FINISHED"}
    assert marked(ball) == []


def test_seams_from_cuts_are_on_both_sides_and_followed(ball):
    assert bpy.ops.uv.cone_unwrap(overlaps="KEEP", pack=True) == {"FINISHED"}
    cuts = UvMap(merged(ball)).split_edges()
    edit(ball)
    assert bpy.ops.mesh.cone_seams_from_cuts() == {"FINISHED"}
    bpy.ops.mesh.select_all(action="DESELECT")
    assert bpy.ops.mesh.cone_select_cuts() == {"FINISHED"}
    edit_mode_off()
    whole = UvMap(merged(ball))
    assert whole.seams == cuts
    selected = {index for edge in ball.data.edges if edge.select for index in edge.vertices}
    stitched = reader(ball.data).stitched
    on_cut = [v for edge in ball.data.edges if edge.use_seam for v in edge.vertices]
    assert set(stitched[list(selected)]) == set(stitched[on_cut])
    assert bpy.ops.uv.cone_unwrap(overlaps="KEEP", pack=True) == {"FINISHED"}
    assert UvMap(merged(ball)).split_edges() == cuts


def test_the_note_names_all_vertices_that_lie_on_others(ball):
    assert bpy.ops.uv.cone_unwrap() == {"FINISHED"}
    (note,) = (found for found in addon.core.findings.last(ball) if "repeat others" in found.text)
    _, counts = np.unique(reader(ball.data).stitched, return_counts=True)
    assert len(note.elements.vertices) == counts[counts > 1].sum()
    assert not any("belong to no face" in found.text for found in addon.core.findings.last(ball))


@pytest.mark.parametrize("preset", ["PAINT", "TILE", "BAKE"])
@pytest.mark.parametrize("in_edit_mode", [False, True])
def test_edges_without_length_are_points_of_the_map(preset, in_edit_mode):
    ball = add_ball_of_quads()
    if in_edit_mode:
        edit(ball)
    assert bpy.ops.uv.cone_auto_unwrap(preset=preset) == {"FINISHED"}
    edit_mode_off()
    uv = UvMap(ball)
    points = [
        (loops[k], loops[k - 1])
        for loops in uv.loops_of_face
        for k in range(len(loops))
        if (uv.positions[uv.vertex[loops[k]]] == uv.positions[uv.vertex[loops[k - 1]]]).all()
    ]
    assert len(points) == 32
    assert all((uv.uv[a] == uv.uv[b]).all() for a, b in points)
    whole = UvMap(merged(ball))
    assert len(whole.split_edges()) < 0.25 * len(whole.sides)
    assert whole.sister_difference() < 2e-6


def test_any_vertex_of_a_pole_is_its_cone():
    ball = add_ball_of_quads()
    mark(ball, [5, 40, 70, 100, len(ball.data.vertices) - 3])
    assert bpy.ops.uv.cone_unwrap(overlaps="KEEP") == {"FINISHED"}
    report = reports_of.find(ball.data)
    assert report.cones == sorted(np.unique(reader(ball.data).stitched[[5, 40, 70, 100, -3]]).tolist())
    edit(ball)
    assert len(build_content(ball, report).cone_uv) >= 5
