# SPDX-License-Identifier: GPL-3.0-or-later
"""What marked seams mean: followed, open borders, or nothing."""

from __future__ import annotations

import lsgp
import meshes
import numpy as np
import oracle
import pytest
from map_checks import assert_exact_transitions, codes, only, pairs, surface, unwrap

CUBE = meshes.cube(4)


def ring(mesh: meshes.Mesh, level: float = 0.5) -> np.ndarray:
    """The edges around a cube at one height: a closed seam that divides it in two."""
    z = mesh.positions[:, 2]
    height = z.min() + level * (z.max() - z.min())
    edges = meshes.edges_of(mesh.triangles)
    on = np.abs(z - height) < 1e-9
    return edges[on[edges].all(axis=1)]


def islands_of(result: lsgp.Result) -> int:
    return len(np.unique(result.island))


def test_ring_that_divides_the_surface_makes_two_islands_of_one_map() -> None:
    seam = ring(CUBE)
    assert len(seam) == 16
    whole, parted = unwrap(CUBE), unwrap(CUBE, seams=seam)
    assert islands_of(whole) == 1 and islands_of(parted) == 2
    assert pairs(seam) <= pairs(parted.cut_edges)
    # Both sides of every edge of the ring have one length: one transition relates the islands.
    assert parted.seams.sister_ratio_max <= 1 + 1e-9
    found = lsgp.measure_distortion(surface(CUBE), parted.corner_uv, CUBE.cones)
    assert found.seams.sister_ratio_max <= 1 + 1e-9
    assert found.seams.rotation_residual <= 1e-9 and found.seams.translation_residual <= 1e-12
    # The same metric as without the ring.
    assert oracle.metric_gap(whole.corner_uv, parted.corner_uv) <= 1e-9


def test_islands_parted_by_a_seam_do_not_overlap() -> None:
    result = unwrap(CUBE, seams=ring(CUBE))
    boxes = [
        (result.corner_uv[result.island == i].min(axis=(0, 1)), result.corner_uv[result.island == i].max(axis=(0, 1)))
        for i in np.unique(result.island)
    ]
    (low_a, high_a), (low_b, high_b) = boxes
    assert (high_a < low_b).any() or (high_b < low_a).any()


def test_dangling_seam_that_no_cut_needs_leaves_the_map_as_it_is() -> None:
    vertex = int(np.setdiff1d(np.arange(len(CUBE.positions)), np.concatenate([ring(CUBE).ravel(), CUBE.cones]))[0])
    around = meshes.edges_of(CUBE.triangles)
    dangling = around[(around == vertex).any(axis=1)][:1]
    plain, marked = unwrap(CUBE), unwrap(CUBE, seams=dangling)
    assert oracle.metric_gap(plain.corner_uv, marked.corner_uv) <= 1e-9
    assert islands_of(marked) == 1


def test_seams_as_borders_part_the_surface() -> None:
    result = unwrap(CUBE, seams=ring(CUBE), seams_mode="boundary")
    assert islands_of(result) == 2
    assert result.solved.all()
    assert not pairs(ring(CUBE)) & pairs(result.cut_edges)  # borders, not cuts


def test_ignored_seams_change_nothing() -> None:
    plain, marked = unwrap(CUBE), unwrap(CUBE, seams=ring(CUBE), seams_mode="ignore")
    assert np.array_equal(plain.corner_uv, marked.corner_uv)


@pytest.mark.parametrize("mode", ["follow", "boundary"])
def test_closed_surface_with_seams_and_no_cones_is_opened_along_them(mode: str) -> None:
    mesh = CUBE._replace(cones=np.empty(0, np.int32))
    result = unwrap(mesh, seams=ring(mesh), seams_mode=mode)
    assert result.solved.all() and islands_of(result) == 2
    assert ("SEAMS_OPENED" in codes(result.warnings)) == (mode == "follow")
    if mode == "follow":
        finding = only(result.warnings, "SEAMS_OPENED")
        assert finding.elements.kind == "triangles" and len(finding.elements.indices) == len(mesh.triangles)
    with pytest.raises(lsgp.TopologyError):
        unwrap(mesh, seams=ring(mesh), seams_mode="ignore")


def test_all_edges_as_seams_and_no_cones_makes_every_triangle_an_island() -> None:
    mesh = meshes.octahedron()._replace(cones=np.empty(0, np.int32))
    result = unwrap(mesh, seams=meshes.edges_of(mesh.triangles))
    assert islands_of(result) == 8
    stretch = oracle.stretches(mesh.positions, mesh.triangles, result.corner_uv)
    assert np.ptp(stretch) <= 1e-9 * stretch.max()


def test_seam_around_a_tube_of_a_torus_is_followed_by_its_cut() -> None:
    mesh = meshes.torus(16, 10)
    plain = unwrap(mesh)
    edges = meshes.edges_of(mesh.triangles)
    meridian = (np.abs(mesh.positions[:, 1]) < 1e-9) & (mesh.positions[:, 0] > 0)
    seam = pairs(edges[meridian[edges].all(axis=1)])
    assert len(seam) == 10
    followed = unwrap(mesh, seams=sorted(seam))
    assert seam <= pairs(followed.cut_edges)
    assert_exact_transitions(mesh, followed)
    assert oracle.metric_gap(plain.corner_uv, followed.corner_uv) <= 1e-7
    opened = unwrap(mesh, seams=sorted(seam), seams_mode="boundary")
    assert opened.solved.all() and opened.flipped.size == 0


def test_moebius_strip_cut_across_is_a_strip() -> None:
    mesh = meshes.moebius_strip()
    with pytest.raises(lsgp.TopologyError) as caught:
        unwrap(mesh)
    assert caught.value.code == "NOT_ORIENTABLE"
    edges = meshes.edges_of(mesh.triangles)
    across = np.array(sorted(pairs(edges) & {(0, 1), (1, 2), (2, 3)}))
    assert len(across) == 3
    result = unwrap(mesh, seams=across, seams_mode="boundary")
    assert result.solved.all() and result.flipped.size == 0
