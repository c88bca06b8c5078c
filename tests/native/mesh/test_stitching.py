# SPDX-License-Identifier: GPL-3.0-or-later
"""Boundaries that lie on each other become one."""

from __future__ import annotations

import lsgp
import meshes
import numpy as np
import pytest
from lsgp.stitching import at_stitched, stitched_cones, stitched_vertices, without_stitched
from meshes import Mesh

WHOLE = {
    "cube": meshes.cube(3),
    "torus": meshes.torus(),
    "hill": meshes.hill(),
    "disk with holes": meshes.disk_with_holes(),
    "double torus": meshes.double_torus(),
}


def split_by_halves(mesh: Mesh) -> Mesh:
    """Each triangle takes its vertices from one of two copies, by the side of a plane its middle is on."""
    count = len(mesh.positions)
    above = mesh.positions[mesh.triangles].mean(axis=1) @ [0.3, 0.5, 0.8] > 0
    return Mesh(np.vstack([mesh.positions, mesh.positions]), mesh.triangles + count * above[:, None], mesh.cones)


@pytest.mark.parametrize("split", [meshes.triangle_soup, split_by_halves])
@pytest.mark.parametrize("name", WHOLE)
def test_a_split_surface_is_whole_again(name: str, split) -> None:
    mesh = WHOLE[name]
    parted = split(mesh)
    stitched = lsgp.stitch_borders(parted.positions, parted.triangles)
    assert np.array_equal(parted.positions[stitched], parted.positions)
    assert np.array_equal(stitched[stitched], stitched)
    pairs = np.unique(np.c_[stitched[parted.triangles].ravel(), mesh.triangles.ravel()], axis=0)
    assert len(pairs) == len(np.unique(pairs[:, 0])) == len(np.unique(pairs[:, 1]))


def test_whole_surfaces_stay_what_they_are() -> None:
    for mesh in (*WHOLE.values(), meshes.merge([meshes.cube(2), meshes.torus()])):
        assert np.array_equal(lsgp.stitch_borders(mesh.positions, mesh.triangles), np.arange(len(mesh.positions)))


def test_both_sides_of_a_leaf_stay_apart() -> None:
    leaf = meshes.grid(3, 2)
    count = len(leaf.positions)
    positions = np.vstack([leaf.positions, leaf.positions])
    for back in (leaf.triangles[:, ::-1], leaf.triangles[::-1, [1, 0, 2]]):
        both = np.vstack([leaf.triangles, back + count])
        assert np.array_equal(lsgp.stitch_borders(positions, both), np.arange(2 * count))


def test_where_more_than_two_edges_lie_on_each_other_they_stay_open() -> None:
    pages = [[0, 1, 2], [4, 3, 5], [6, 7, 8], [10, 9, 11]]  # of a book, two of them turned
    spine = [[0, 0, 0], [0, 0, 1]]
    outer = [[1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0]]
    positions = [[*spine, page] for page in outer]
    assert np.array_equal(lsgp.stitch_borders(np.concatenate(positions), pages), np.arange(12))


def test_edges_that_run_the_same_way_stay_open() -> None:
    positions = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 0], [1, 0, 0], [0, -1, 0]]
    assert np.array_equal(lsgp.stitch_borders(positions, [[0, 1, 2], [3, 4, 5]]), np.arange(6))
    assert lsgp.stitch_borders(positions, [[0, 1, 2], [4, 3, 5]]).tolist() == [0, 1, 2, 0, 1, 5]


def test_negative_zero_is_the_same_place_and_the_nearest_number_is_not() -> None:
    triangles = [[0, 1, 2], [4, 3, 5]]
    positions = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, -0.0, 0], [1, 0, -0.0], [0, -1, 0]])
    assert lsgp.stitch_borders(positions, triangles).tolist() == [0, 1, 2, 0, 1, 5]
    positions[4, 0] = np.nextafter(1, 2)
    assert np.array_equal(lsgp.stitch_borders(positions, triangles), np.arange(6))
    positions[[0, 3], 0] = np.nan
    assert np.array_equal(lsgp.stitch_borders(positions, triangles), np.arange(6))


def test_the_bridge_from_the_outline_of_a_face_to_its_hole_closes() -> None:
    """As where the face names the vertices at its ends twice; what is folded on itself has no area to hold together."""
    ring = np.array(
        [[0, 0, 0], [3, 0, 0], [3, 3, 0], [0, 3, 0], [0, 0, 0], [1, 1, 0], [1, 2, 0], [2, 1, 0], [1, 1, 0]], float
    )
    assert stitched_vertices(ring, np.arange(9), np.array([9])).tolist() == [0, 1, 2, 3, 0, 5, 6, 7, 5]
    there_and_back = ring[[0, 1, 2, 1]]
    assert np.array_equal(stitched_vertices(there_and_back, np.arange(4), np.array([4])), np.arange(4))


def test_no_face_touches_itself_at_a_vertex_afterward() -> None:
    """A ring whose hole has a corner on its outline, and a triangle in the hole, which joins both its ends."""
    ring = [[0, 0, 0], [4, 0, 0], [4, 4, 0], [0, 4, 0], [0, 0, 0], [1, 2, 0], [2, 1, 0]]
    positions = np.array([*ring, [0, 0, 0], [2, 1, 0], [1, 2, 0]], float)
    stitched = stitched_vertices(positions, np.arange(10), np.array([7, 3]))
    assert stitched[:7].tolist() == list(range(7)) and stitched[8:].tolist() == [6, 5]


def test_what_is_no_array_of_vertices_is_refused() -> None:
    with pytest.raises(lsgp.InputError) as refusal:
        lsgp.stitch_borders(np.zeros((3, 2)), [[0, 1, 2]])
    assert refusal.value.code == "WRONG_SHAPE"
    with pytest.raises(lsgp.InputError) as refusal:
        lsgp.stitch_borders(np.zeros((3, 3)), [[0, 1, 3]])
    assert refusal.value.code == "INDEX_OUT_OF_RANGE"
    assert lsgp.stitch_borders(np.empty((0, 3)), np.empty((0, 3), int)).shape == (0,)


def test_cones_and_edges_follow_their_vertices() -> None:
    stitched = np.array([0, 1, 0, 1, 4], np.int32)
    assert at_stitched(stitched, np.array([[2, 3], [4, 9], [-1, 3]])).tolist() == [[0, 1], [4, 9], [-1, 1]]
    cones, rows = stitched_cones(stitched, np.array([2, 0, 4, 4, 9], np.int32))
    assert (cones.tolist(), rows.tolist()) == ([0, 4, 4, 9], [0, 2, 3, 4])


def test_only_vertices_that_belong_to_no_face_of_their_own_are_told() -> None:
    told = [lsgp.Finding("ISOLATED_VERTICES", "…", lsgp.Elements("vertices", np.array([1, 3], np.int32)))]
    assert without_stitched(np.array([0, 0, 2, 0]), told) == []
    (rest,) = without_stitched(np.array([0, 0, 2, 3]), told)
    assert rest.message == "1 vertex belongs to no face and got no coordinates."
    assert rest.elements.indices.tolist() == [3]


def test_a_slit_inside_the_surface_closes() -> None:
    """Both sides of its first and last edge share a vertex."""
    hill = meshes.hill()
    edges, count = np.unique(
        np.sort(hill.triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1), axis=0, return_counts=True
    )
    inside = np.setdiff1d(np.arange(len(hill.positions)), edges[count == 1])
    middle = inside[len(inside) // 2]
    ring = np.flatnonzero((hill.triangles == middle).any(axis=1))
    half = ring[hill.positions[hill.triangles[ring]].mean(axis=1)[:, 0] > hill.positions[middle, 0]]
    triangles = hill.triangles.copy()
    triangles[half] = np.where(triangles[half] == middle, len(hill.positions), triangles[half])
    positions = np.vstack([hill.positions, hill.positions[middle]])
    assert meshes.euler_characteristic(triangles) < meshes.euler_characteristic(hill.triangles)
    stitched = lsgp.stitch_borders(positions, triangles)
    assert np.array_equal(stitched[triangles], hill.triangles)
