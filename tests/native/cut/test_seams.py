# SPDX-License-Identifier: GPL-3.0-or-later
"""What marked seams mean: followed, open borders, or nothing."""

from __future__ import annotations

import lsgp
import meshes
import numpy as np
import oracle
import pytest
import zoo
from map_checks import assert_angles_met, assert_exact_transitions, codes, only, pairs, surface, unwrap
from result_check import undeclared_faults
from segmentations import glue

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
    assert pairs(result.cut_edges) >= pairs(ring(CUBE))


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


@pytest.mark.parametrize("mode", ["follow", "boundary"])
def test_moebius_strip_with_seams_across_is_opened_in_both_modes(mode: str) -> None:
    mesh = meshes.moebius_strip()
    across = [(0, 1), (1, 2), (2, 3)]
    result = unwrap(mesh, seams=across, seams_mode=mode)
    assert result.solved.all() and result.flipped.size == 0
    if mode == "follow":
        assert only(result.warnings, "SEAMS_OPENED").elements.indices.tolist() == list(range(len(mesh.triangles)))


def capped_cylinder(around: int = 16, along: int = 6) -> tuple[meshes.Mesh, np.ndarray, np.ndarray]:
    """A closed cylinder, the edges of its two rims, and those of one straight line from rim to rim."""
    tube = meshes.cylinder(around, along, taper=0)
    positions, triangles, rims = [tube.positions], [tube.triangles], []
    for loop in oracle.boundary_loops(tube.triangles):
        after, center = np.roll(loop, -1), sum(map(len, positions))
        positions.append(tube.positions[loop].mean(axis=0)[None])
        triangles.append(np.stack([after, loop, np.full(len(loop), center)], axis=1))
        rims.append(np.stack([loop, after], axis=1))
    mesh = meshes.make(np.concatenate(positions), np.concatenate(triangles))
    edges = meshes.edges_of(tube.triangles)
    on_line = (np.abs(tube.positions[:, 1]) < 1e-9) & (tube.positions[:, 0] > 0)
    return mesh, np.concatenate(rims), edges[on_line[edges].all(axis=1)]


@pytest.mark.parametrize("mode", ["follow", "boundary"])
def test_closed_cylinder_with_rims_and_a_line_is_a_rectangle_and_two_disks(mode: str) -> None:
    mesh, rims, line = capped_cylinder()
    seams = np.concatenate([rims, line])
    result = unwrap(mesh, seams=seams, seams_mode=mode)
    assert pairs(glue(mesh.triangles).opened(result.corner_uv)) == pairs(seams)
    caps_and_side = sorted(np.unique(result.island, return_counts=True)[1].tolist())
    assert caps_and_side == [16, 16, 192]
    assert result.distortion.l2_stretch <= 1.001
    tail, head, _ = oracle.halfedges(mesh.triangles)
    is_seam = [tuple(sorted(edge)) in pairs(seams) for edge in zip(tail.tolist(), head.tolist(), strict=True)]
    on_side = np.repeat(np.bincount(result.island)[result.island] == 192, 3)
    z = oracle.as_complex(result.corner_uv)
    border = (z[:, [1, 2, 0]] - z).ravel()[on_side & is_seam]
    quarters = np.angle(border / border[0]) / (np.pi / 2)
    assert np.abs(quarters - np.round(quarters)).max() * 90 <= 0.5
    assert len(border) == 2 * (16 + 6)


@pytest.mark.parametrize("mode", ["follow", "boundary"])
def test_closed_cylinder_with_rims_alone_is_a_ring_and_two_disks(mode: str) -> None:
    mesh, rims, _ = capped_cylinder()
    result = unwrap(mesh, seams=rims, seams_mode=mode)
    assert pairs(glue(mesh.triangles).opened(result.corner_uv)) == pairs(rims) and islands_of(result) == 3
    assert "CUTS_ADDED" not in codes(result.warnings)
    assert undeclared_faults(surface(mesh, seams=rims), result, lsgp.Options(seams=mode)) == []
    assert result.flipped.size == 0


@pytest.mark.parametrize("mode", ["follow", "boundary"])
def test_seam_that_ends_inside_a_part_is_opened(mode: str) -> None:
    """Without cones it is a slit; with cones its sides are related by no turn and no shift, and it is listed."""
    mesh = meshes.hill(10)
    slit = [(36, 47), (47, 58), (58, 69)]
    assert set(slit) <= pairs(meshes.edges_of(mesh.triangles))
    without = mesh._replace(cones=np.empty(0, np.int32))
    result = unwrap(without, seams=slit, seams_mode=mode)
    assert pairs(glue(mesh.triangles).opened(result.corner_uv)) == pairs(slit)
    assert "CUTS_ADDED" not in codes(result.warnings) and result.flipped.size == 0
    if mode == "follow":
        result = unwrap(mesh, seams=slit)
        assert pairs(slit) <= pairs(result.cut_edges)
        assert_angles_met(mesh, result)
        added = only(result.warnings, "CUTS_ADDED")
        assert pairs(added.elements.indices) == pairs(result.cut_edges) - pairs(slit)


def test_open_parts_keep_their_texture_across_seams_with_cones_only() -> None:
    mesh = meshes.hill(10)
    across = [(11 * i + 5, 11 * i + 16) for i in range(10)]
    marked = surface(mesh, seams=across)
    with_cone = lsgp.parameterize(marked, mesh.cones)
    assert "SEAMS_OPENED" not in codes(with_cone.warnings)
    assert with_cone.seams.sister_ratio_max <= 1 + 1e-9 and pairs(across) <= pairs(with_cone.cut_edges)
    without = lsgp.parameterize(marked, [])
    assert only(without.warnings, "SEAMS_OPENED").elements.indices.tolist() == list(range(len(mesh.triangles)))
    alone = lsgp.parameterize(marked, [], options=lsgp.Options(seams="boundary"))
    assert np.array_equal(without.corner_uv, alone.corner_uv)


def test_straight_borders_and_tiles_run_on_across_seams_of_open_parts() -> None:
    mesh = meshes.cylinder(16, 6)
    seam = [(int(a), int(b)) for a, b in meshes.edges_of(mesh.triangles) if b == a + 16][:6]
    for options in ({"border": "straight"}, {"seamless": lsgp.Seamless()}):
        result = lsgp.parameterize(surface(mesh, seams=seam), [], options=lsgp.Options(**options))
        assert "SEAMS_OPENED" not in codes(result.warnings) and result.solved.all()


@pytest.mark.parametrize("mode", ["follow", "boundary"])
def test_torus_parted_into_rings_is_opened_and_one_parted_into_disks_stays_flat(mode: str) -> None:
    mesh = meshes.torus(18, 10)
    x, y, _ = mesh.positions.T
    edges = meshes.edges_of(mesh.triangles)
    around = [edges[on[edges].all(axis=1)] for on in (np.abs(y) < 1e-9, (np.abs(y) < 1e-9) & (x > 0))]
    rings, ring = around
    assert (len(rings), len(ring)) == (20, 10)
    result = unwrap(mesh, seams=rings, seams_mode=mode)
    assert islands_of(result) == 2 and result.flipped.size == 0
    if mode == "boundary":
        return
    assert "SEAMS_OPENED" in codes(result.warnings)
    result = unwrap(mesh, seams=ring)
    assert "SEAMS_OPENED" not in codes(result.warnings)
    assert pairs(only(result.warnings, "CUTS_ADDED").elements.indices) == pairs(result.cut_edges) - pairs(ring)


def test_seams_that_leave_handles_say_which_cuts_open_them() -> None:
    mesh = meshes.subdivide(meshes.double_torus())
    seam = [tuple(meshes.edges_of(mesh.triangles)[0].tolist())]
    result = unwrap(mesh, seams=seam, seams_mode="boundary")
    added = only(result.warnings, "CUTS_ADDED")
    assert "handles" in added.message and pairs(added.elements.indices) == pairs(result.cut_edges) - pairs(seam)
    assert "CUTS_ADDED" not in codes(unwrap(meshes.torus()).warnings)  # where nothing is marked


@pytest.mark.parametrize("mode", ["follow", "boundary", "ignore"])
def test_holes_of_open_surfaces_without_cones_stay_holes(mode: str) -> None:
    """About these the metric turns by far less or more than once."""
    lift = meshes.hill(20, height=6)
    middle = np.linalg.norm(lift.positions[lift.triangles].mean(axis=1)[:, :2] - [10, 10], axis=1)
    mesh = meshes.compact(meshes.make(lift.positions, lift.triangles[middle > 7]))
    assert len(oracle.boundary_loops(mesh.triangles)) == 2
    result = unwrap(mesh, seams_mode=mode)
    assert result.cut_edges.size == 0 and result.flipped.size == 0 and result.wrong_angle_sums.size == 0


@pytest.mark.parametrize("height", [6, 8])
def test_the_metric_comes_back_around_a_hole_to_where_it_began(height: float) -> None:
    """Read from the log scale alone: edges as long as it makes them, turning by the curvature it leaves, close."""
    lift = meshes.hill(20, height)
    middle = lift.positions[lift.triangles].mean(axis=1)[:, :2]
    mesh = meshes.compact(meshes.make(lift.positions, lift.triangles[np.linalg.norm(middle - [7, 11], axis=1) > 3.5]))
    result = unwrap(mesh, seams_mode="boundary")
    p, t, y = mesh.positions, mesh.triangles, result.log_scale
    tail, head, twin = oracle.halfedges(t)
    onward = dict(zip(tail[twin < 0].tolist(), head[twin < 0].tolist(), strict=True))
    hole = [int(oracle.boundary_loops(t)[1][0])]
    while (vertex := onward[hole[-1]]) != hole[0]:
        hole.append(vertex)
    after = np.roll(hole, -1)
    turns = (oracle.angle_defects(p, t) + oracle.cotan_laplacian(p, t) @ y)[hole]
    assert turns.sum() == pytest.approx(-2 * np.pi, abs=1e-9)
    edges = np.linalg.norm(p[after] - p[hole], axis=1) * np.exp((y[hole] + y[after]) / 2)
    gap = (edges * np.exp(1j * np.cumsum(turns))).sum() / edges.sum()
    assert abs(gap) <= 1e-9
    assert result.cut_edges.size == 0 and result.flipped.size == 0
    assert result.distortion.quasi_conformal <= 1.025


def test_tube_without_seams_is_a_strip_and_a_ring_where_seams_are_borders() -> None:
    mesh = meshes.cylinder(16, 6)
    assert unwrap(mesh).cut_edges.size > 0 and unwrap(mesh).distortion.l2_stretch <= 1.05
    ring = unwrap(mesh, seams_mode="boundary")
    assert ring.cut_edges.size == 0 and ring.flipped.size == 0 and ring.distortion.l2_stretch > 1.5


def test_ring_too_long_for_numbers_is_cut_and_says_so() -> None:
    mesh, rims, _ = capped_cylinder(8, 60)
    mesh = mesh._replace(positions=mesh.positions * [1, 1, 8])  # 2.8 times as long as around
    result = unwrap(mesh, seams=rims, seams_mode="boundary")
    added = only(result.warnings, "CUTS_ADDED")
    assert "stretched too much" in added.message
    assert pairs(added.elements.indices) == pairs(result.cut_edges) - pairs(rims)
    assert result.flipped.size == 0 and result.distortion.l2_stretch <= 1.01


def test_holes_that_stay_holes_need_no_edges_for_cuts() -> None:
    mesh, rims, _ = capped_cylinder()
    result = lsgp.parameterize(lsgp.Surface(mesh.positions, mesh.triangles, rims, rims), [])
    assert result.solved.all() and islands_of(result) == 3


def test_fins_that_open_along_their_seams_leave_the_seams_of_a_body_with_cones_joined() -> None:
    """Where three triangles meet at a seam, two of a body with cones and one of a fin without."""
    ball = meshes.bumpy_sphere(2)
    edge = ball.triangles[7, :2]
    top = ball.positions[edge].mean(axis=0) * 2
    count = len(ball.positions)
    places = np.concatenate([ball.positions, [top, top * 1.5]])
    fin = [[*edge, count], [count, edge[1], count + 1]]
    whole = lsgp.Surface(
        places, np.concatenate([ball.triangles, fin]), seams=np.array([edge, [edge[1], count]], np.int32)
    )
    alone = lsgp.parameterize(lsgp.Surface(ball.positions, ball.triangles, seams=edge[None]), ball.cones)
    found = lsgp.parameterize(whole, ball.cones)
    assert only(found.warnings, "SEAMS_OPENED").elements.indices.tolist() == [
        len(ball.triangles),
        len(ball.triangles) + 1,
    ]
    assert found.cones.tolist() == alone.cones.tolist() == sorted(ball.cones)
    of_ball = found.corner_uv[: len(ball.triangles)]
    lengths = [np.linalg.norm(uv - np.roll(uv, 1, axis=1), axis=2) for uv in (of_ball, alone.corner_uv)]
    assert lengths[0] == pytest.approx(lengths[1] * (lengths[0].sum() / lengths[1].sum()), rel=1e-9)
    assert undeclared_faults(whole, found) == []


@pytest.mark.parametrize("seed", [1706, 1818, 1989, 2074, 2446])
def test_a_part_with_cones_ends_nowhere_else_where_others_open_along_their_seams(seed: int) -> None:
    """Parts touch at edges of three or more triangles, some of them marked, others not; which sheets run on at the
    others was decided anew once seams were open."""
    mesh = zoo.member(f"mixture-seed={seed}").mesh()
    sides = np.sort(mesh.triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    edges, count = np.unique(sides, axis=0, return_counts=True)
    plain = lsgp.Surface(mesh.positions, mesh.triangles)
    random = np.random.default_rng(seed)

    def with_cones(given: lsgp.Surface, cones: np.ndarray) -> list[tuple[list[int], int, int]]:
        parts = lsgp.build_ledger(given, cones, None)
        return [(part.triangles.tolist(), part.euler, part.borders) for part in parts if len(part.cones)]

    compared = 0
    for part in lsgp.build_ledger(plain, [], None):
        own = np.setdiff1d(mesh.triangles[part.triangles], np.delete(mesh.triangles, part.triangles, axis=0))
        for share in (0.1, 0.5, 0.5, 0.5) if len(own) else ():
            is_marked = random.random(len(edges)) < np.where(count > 2, 0.5, share)
            marked = lsgp.Surface(mesh.positions, mesh.triangles, seams=edges[is_marked])
            assert with_cones(marked, own[:3]) == with_cones(plain, own[:3])
            compared += 1
    assert compared > 0
