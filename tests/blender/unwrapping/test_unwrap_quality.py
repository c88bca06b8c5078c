# SPDX-License-Identifier: GPL-3.0-or-later
"""Unwrap from Cones: the quality of the UVs it writes, measured from the mesh alone."""

import math
from itertools import pairwise

import bmesh
import bpy
import numpy as np
import pytest
from scenes import (
    ANGLES,
    UV_ROUNDING,
    UvMap,
    add_cone_cube,
    add_cube,
    add_object,
    corners,
    edit,
    mark,
    mark_seams,
    marked,
)

# Relative error of the shortest edge of the test cubes (an eighth of the UV square or more) by 32-bit UVs, with room.
ISOMETRIC = 1 + 1e-5


@pytest.mark.parametrize("in_edit_mode", [True, False])
@pytest.mark.parametrize("unfold", ["POISSON", "SPECTRAL"])
def test_cube_through_its_corners_is_isometric(in_edit_mode, unfold):
    cube = add_cone_cube()
    if in_edit_mode:
        edit(cube)
    assert bpy.ops.uv.cone_unwrap(unfold=unfold) == {"FINISHED"}
    uv_map = UvMap(cube)
    assert uv_map.scale_spread() < ISOMETRIC
    assert uv_map.sister_difference() <= UV_ROUNDING
    assert uv_map.islands() == 1
    assert uv_map.uv.min() >= 0.0 and uv_map.uv.max() <= 1.0


def require_tree(edges, cones):
    """Vertex pairs that are connected, have no cycle, end only at cones and reach all of them."""
    neighbors = {}
    for first, second in edges:
        neighbors.setdefault(first, set()).add(second)
        neighbors.setdefault(second, set()).add(first)
    assert len(edges) == len(neighbors) - 1
    reached, waiting = set(), [cones[0]]
    while waiting:
        vertex = waiting.pop()
        if vertex not in reached:
            reached.add(vertex)
            waiting.extend(neighbors[vertex])
    assert reached == set(neighbors)
    assert {vertex for vertex, others in neighbors.items() if len(others) == 1} <= set(cones) <= reached


def test_cuts_form_a_tree_through_all_cones():
    cube = add_cone_cube()
    bpy.ops.uv.cone_unwrap()
    require_tree(UvMap(cube).split_edges(), corners(cube))


def test_cone_angles_add_up_to_what_the_cube_has():
    cube = add_cone_cube()
    bpy.ops.uv.cone_unwrap()
    uv_map = UvMap(cube)
    for vertex in range(len(cube.data.vertices)):
        expected = 1.5 * math.pi if vertex in corners(cube) else 2 * math.pi
        assert uv_map.angle_sum(vertex) == pytest.approx(expected, abs=1e-4)


@pytest.mark.parametrize("in_edit_mode", [True, False])
def test_typed_cone_angles_are_kept_unless_a_rule_is_chosen(in_edit_mode):
    cube = add_cone_cube()
    typed = corners(cube)[0]
    angles = cube.data.attributes.new(ANGLES, "FLOAT", "POINT")
    angles.data[typed].value = math.pi
    if in_edit_mode:
        edit(cube)
    bpy.ops.uv.cone_unwrap()
    assert UvMap(cube).angle_sum(typed) == pytest.approx(math.pi, abs=1e-4)
    bpy.ops.uv.cone_unwrap(prescription="LEAST_DISTORTION")
    assert UvMap(cube).angle_sum(typed) == pytest.approx(1.5 * math.pi, abs=1e-4)


@pytest.mark.parametrize("prescription", ["LEAST_DISTORTION", "HARMONIC", "STRAIGHTNESS"])
def test_every_rule_keeps_sisters_equal(prescription):
    cube = add_cone_cube()
    for vertex in cube.data.vertices:
        vertex.co.z *= 1.5
    assert bpy.ops.uv.cone_unwrap(prescription=prescription) == {"FINISHED"}
    uv_map = UvMap(cube)
    assert uv_map.split_edges()
    assert uv_map.sister_difference() <= UV_ROUNDING


def cube_edges(cube, path):
    """Vertex pairs along the straight lines between consecutive points of a path of axis-parallel steps."""
    positions = np.array([tuple(v.co) for v in cube.data.vertices])
    find = {tuple(np.round(2 * p).astype(int)): i for i, p in enumerate(positions)}
    pairs = set()
    for start, end in pairwise(path):
        start, end = np.array(start), np.array(end)
        steps = int(2 * np.abs(end - start).max())
        chain = [find[tuple((2 * (start + (end - start) * k / steps)).astype(int))] for k in range(steps + 1)]
        pairs |= {tuple(sorted(pair)) for pair in pairwise(chain)}
    return pairs


# A way through the eight corners of the cube along seven of its edges.
THROUGH_CORNERS = [(-1, -1, -1), (1, -1, -1), (1, 1, -1), (-1, 1, -1), (-1, 1, 1), (1, 1, 1), (1, -1, 1), (-1, -1, 1)]


@pytest.mark.parametrize("in_edit_mode", [True, False])
@pytest.mark.parametrize(
    "path", [THROUGH_CORNERS, [(y, z, x) for x, y, z in THROUGH_CORNERS]], ids=["one way", "turned"]
)
def test_cuts_follow_marked_seams(path, in_edit_mode):
    cube = add_cone_cube()
    seams = cube_edges(cube, path)
    mark_seams(cube, seams)
    if in_edit_mode:
        edit(cube)
    bpy.ops.uv.cone_unwrap()
    uv_map = UvMap(cube)
    assert uv_map.split_edges() == seams
    assert uv_map.seams == seams


def test_cuts_take_a_detour_along_a_marked_seam():
    cube = add_cone_cube()
    straight = cube_edges(cube, [(1, 1, 1), (1, 0.5, 1)])
    detour = cube_edges(cube, [(1, 0.5, 1), (0.5, 0.5, 1), (0.5, -0.5, 1), (1, -0.5, 1)])
    end = cube_edges(cube, [(1, -0.5, 1), (1, -1, 1)])
    mark_seams(cube, straight | detour | end)
    bpy.ops.uv.cone_unwrap()
    assert straight | detour | end <= UvMap(cube).split_edges()


def dissolve_top(cube):
    """Enter edit mode and make the upper side of the cube one polygon with 16 corners."""
    edit(cube)
    bm = bmesh.from_edit_mesh(cube.data)
    inner = [v for v in bm.verts if v.co.z > 0.99 and max(abs(v.co.x), abs(v.co.y)) < 0.99]
    bmesh.ops.dissolve_verts(bm, verts=inner)
    bmesh.update_edit_mesh(cube.data, destructive=True)
    bpy.ops.mesh.select_all(action="SELECT")
    assert sorted({len(face.verts) for face in bm.faces}) == [4, 16]


def test_ngons_stay_whole_and_isometric():
    cube = add_cone_cube()
    dissolve_top(cube)
    bpy.ops.uv.cone_unwrap()
    uv_map = UvMap(cube)
    assert sorted({len(loops) for loops in uv_map.loops_of_face}) == [4, 16]
    # Also across the whole polygon, because every pair of its corners counts.
    assert uv_map.scale_spread() < ISOMETRIC


def test_cuts_go_round_ngons_where_the_way_across_is_shorter():
    cube = add_cube()
    cones = [v for v in corners(cube) if math.prod(cube.data.vertices[v].co) > 0]
    upper = [v for v in cones if cube.data.vertices[v].co.z > 0]
    assert len(cones) == 4 and len(upper) == 2
    mark(cube, cones)
    dissolve_top(cube)
    bpy.ops.uv.cone_unwrap()
    # A cut along a diagonal inside of the polygon would be missing between the polygons' edges.
    require_tree(UvMap(cube).split_edges(), marked(cube))


def test_suzanne_through_placed_cones():
    bpy.ops.mesh.primitive_monkey_add()
    suzanne = bpy.context.object
    suzanne.modifiers.new("Subdivision", "SUBSURF").levels = 1
    bpy.ops.object.modifier_apply(modifier="Subdivision")
    edit(suzanne)
    assert bpy.ops.mesh.cone_place() == {"FINISHED"}
    assert marked(suzanne)
    assert bpy.ops.uv.cone_unwrap(overlaps="KEEP") == {"FINISHED"}
    uv_map = UvMap(suzanne)
    assert uv_map.islands() == 3
    assert np.isfinite(uv_map.uv).all()
    assert uv_map.uv.min() >= 0.0 and uv_map.uv.max() <= 1.0
    assert uv_map.sister_difference() <= UV_ROUNDING


def test_flat_grid_keeps_its_shape_without_cones():
    def build(bm):
        bmesh.ops.create_grid(bm, x_segments=5, y_segments=3, size=1.0)

    grid = add_object("Grid", build)
    mark(grid, [])
    assert bpy.ops.uv.cone_unwrap() == {"FINISHED"}
    uv_map = UvMap(grid)
    assert uv_map.split_edges() == set()
    assert uv_map.scale_spread() < ISOMETRIC
