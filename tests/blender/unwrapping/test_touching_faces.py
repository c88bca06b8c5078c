# SPDX-License-Identifier: GPL-3.0-or-later
"""Faces that have more than an edge in common, whose diagonals can lie on each other or on an edge."""

import bmesh
import bpy
import numpy as np
import pytest
from installed import addon
from logged import logged
from scenes import UvMap, add_cube, add_grid, add_object, edit


def add_doublets(bm, faces):
    """Divides quads in two by a bent line between two of their corners: all that the new vertex has is two edges."""
    for face in faces:
        a, b, c, d = face.verts
        middle = bm.verts.new(face.calc_center_median() + 0.05 * face.normal)
        bm.faces.remove(face)
        bm.faces.new([a, b, c, middle])
        bm.faces.new([c, d, a, middle])


def with_doublets(obj):
    bm = bmesh.new()
    bm.from_mesh(obj.data)
    bm.faces.ensure_lookup_table()
    add_doublets(bm, [bm.faces[i] for i in range(0, len(bm.faces), 3)])
    bm.to_mesh(obj.data)
    bm.free()
    return obj


def pillow():
    """A square on top, and two triangles below whose common edge is a diagonal of the square."""

    def build(bm):
        a, b, c, d = (bm.verts.new(place) for place in [(0, 0, 0), (1, 0, 0), (1, 1, 0.1), (0, 1, 0)])
        bm.faces.new([a, b, c, d])
        bm.faces.new([a, c, b])
        bm.faces.new([a, d, c])
        bm.loops.layers.uv.new("UVMap")

    return add_object("Pillow", build)


def edges_of(triangles):
    pairs = np.sort(np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]), axis=1)
    return np.unique(pairs, axis=0, return_counts=True)


MODELS = {"grid": lambda: with_doublets(add_grid()), "cube": lambda: with_doublets(add_cube()), "pillow": pillow}


@pytest.mark.parametrize("in_edit_mode", [True, False])
@pytest.mark.parametrize("name", MODELS)
def test_no_edge_has_more_than_two_of_the_triangles(name, in_edit_mode):
    obj = MODELS[name]()
    obj.data.calc_loop_triangles()
    drawn = np.array([triangle.vertices for triangle in obj.data.loop_triangles])
    assert edges_of(drawn)[1].max() > 2, "Blender's own triangles will do"
    if in_edit_mode:
        edit(obj)
    triangles = addon.mesh.reader.reader(obj.data).all_triangles()
    pairs, counts = edges_of(triangles)
    assert len(triangles) == len(drawn) and counts.max() == 2
    assert {tuple(sorted(edge.vertices)) for edge in obj.data.edges} <= set(map(tuple, pairs.tolist()))


def test_triangles_of_plain_faces_are_those_that_blender_draws():
    cube = add_cube()
    mesh = addon.mesh.stored_mesh.StoredMesh(cube.data)
    assert np.array_equal(mesh.triangle_loops, mesh.drawn_loops)


@pytest.mark.parametrize("in_edit_mode", [True, False])
def test_faces_that_share_two_edges_stay_whole(in_edit_mode):
    grid = with_doublets(add_grid())
    if in_edit_mode:
        edit(grid)
    with logged() as codes:
        assert bpy.ops.uv.cone_auto_unwrap() == {"FINISHED"}
    assert "DUPLICATE_FACE" not in codes
    found = UvMap(grid)
    assert found.islands() == 1 and not found.split_edges()
    assert found.scale_spread() < 1.4
