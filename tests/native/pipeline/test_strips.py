# SPDX-License-Identifier: GPL-3.0-or-later
"""Tubes are found by their rings of quads, and unfold into strips between their borders."""

from __future__ import annotations

from dataclasses import replace

import lsgp
import meshes
import numpy as np
import pytest
from map_checks import pairs, surface
from meshes import Mesh
from zoo.swept import circle, pipe, sweep

STRIPS = lsgp.Options(mode="low-stretch", border="strips")


def of_quads(mesh: Mesh, quads: int) -> lsgp.Surface:
    """The first triangles are halves of quads: those of the first half, then the others in the same order."""
    diagonals = np.sort(mesh.triangles[:quads][:, [0, 2]], axis=1)
    edges = meshes.edges_of(mesh.triangles)
    is_diagonal = (edges[:, None] == diagonals[None]).all(axis=2).any(axis=1)
    return surface(mesh, edges=edges[~is_diagonal])


def of_pipe(around: int, along: int, bend: float, caps: bool) -> lsgp.Surface:
    return of_quads(pipe(around, along, bend, caps), around * along)


def horn(around: int, along: int, taper: float) -> lsgp.Surface:
    """A straight tube whose radius shrinks from 1 to `taper`."""
    mesh = sweep(np.linspace([0, 0, 0], [0, 0, 5], along + 1), circle(1, around), closed=False, caps=False)
    scale = 1 - (1 - taper) * mesh.positions[:, 2:] / 5
    return of_quads(
        mesh._replace(positions=mesh.positions * np.concatenate([scale, scale, scale**0], 1)), around * along
    )


def unwrapped(mesh: lsgp.Surface) -> tuple[lsgp.Surface, lsgp.Result]:
    """Through no cones, ending where tubes end."""
    ending = replace(mesh, borders=lsgp.find_tubes(mesh).borders)
    return ending, lsgp.parameterize(ending, [], None, STRIPS)


def sides_off_rectangle(mesh: lsgp.Surface, result: lsgp.Result, triangles: np.ndarray) -> float:
    """What the box of an island has in area, beyond the island itself: 0 only of rectangles along the axes."""
    uv = result.corner_uv[triangles]
    one, other = uv[:, 1] - uv[:, 0], uv[:, 2] - uv[:, 0]
    area = np.abs(one[:, 0] * other[:, 1] - one[:, 1] * other[:, 0]).sum() / 2
    return float(np.ptp(uv[..., 0]) * np.ptp(uv[..., 1]) / area - 1)


def off_any_rectangle(result: lsgp.Result, triangles: np.ndarray) -> float:
    """What the smallest box of an island has in area beyond the island itself, whichever way it lies."""
    corners = result.corner_uv[triangles]
    outline = corners.reshape(-1, 2)
    one, other = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    area = np.abs(one[:, 0] * other[:, 1] - one[:, 1] * other[:, 0]).sum() / 2
    angles = np.arctan2(*(np.roll(corners, -1, axis=1) - corners).reshape(-1, 2).T[::-1])
    turned = [outline @ [[np.cos(a), -np.sin(a)], [np.sin(a), np.cos(a)]] for a in np.unique(angles.round(6))]
    return float(min(np.ptp(points, axis=0).prod() for points in turned) / area - 1)


@pytest.mark.parametrize("bend", [0.0, 0.7, 1.5])
@pytest.mark.parametrize("caps", [False, True])
@pytest.mark.parametrize(("around", "along"), [(6, 20), (12, 40), (17, 30)])
def test_a_pipe_is_a_rectangle_and_its_caps(around: int, along: int, bend: float, caps: bool) -> None:
    mesh = of_pipe(around, along, bend, caps)
    tubes = lsgp.find_tubes(mesh)
    wall = 2 * around * along
    np.testing.assert_array_equal(tubes.triangles, np.arange(wall))
    rims = np.concatenate([np.arange(around), np.arange(along * around, (along + 1) * around)])
    np.testing.assert_array_equal(np.unique(tubes.borders), rims if caps else np.empty(0))
    _, result = unwrapped(mesh)
    assert result.distortion.l2_stretch < 1.05
    assert len(np.unique(result.island)) == (3 if caps else 1)
    assert sides_off_rectangle(mesh, result, np.arange(wall)) < 1e-6
    assert not len(result.flipped) and not len(result.wrong_angle_sums)


@pytest.mark.parametrize(("around", "along"), [(3, 1), (8, 1), (40, 3)])
def test_a_straight_ring_of_any_height_is_exact(around: int, along: int) -> None:
    _, result = unwrapped(of_pipe(around, along, 0.0, False))
    assert abs(result.distortion.l2_stretch - 1) < 1e-9


@pytest.mark.parametrize("taper", [0.6, 0.3, 0.1])
def test_a_horn_tapers_evenly(taper: float) -> None:
    """It lies on a cone, which unfolds exactly, but not with parallel sides."""
    mesh = horn(16, 40, taper)
    _, result = unwrapped(mesh)
    assert result.distortion.l2_stretch < 1.01
    assert sides_off_rectangle(mesh, result, np.arange(len(mesh.triangles))) > 0.1


def test_a_winding_tube_is_cut_along_one_row_whatever_the_front_sees() -> None:
    around, along = 16, 60
    mesh = sweep(np.linspace([0, 0, 0], [0, 20, 0], along + 1), circle(1, around), closed=False, caps=False)
    ring = np.arange(len(mesh.positions)) // around
    angle = 2 * np.pi * (np.arange(len(ring)) % around) / around + 0.1 * ring
    places = np.stack([np.cos(angle), 0.35 * ring, np.sin(angle)], axis=1)
    tube = of_quads(mesh._replace(positions=places), around * along)
    tube = replace(tube, cut_costs=lsgp.cut_costs(tube, (0, 0, 1)))
    cuts = lsgp.parameterize(tube, [], None, STRIPS).cut_edges
    assert len(cuts) == along
    assert len(np.unique(cuts % around)) == 1


def coil(around: int, along: int, thickness: float, turns: float) -> lsgp.Surface:
    """A tube along a helix of radius 0.5: on its inner side rings are far closer to each other than outside."""
    s = np.linspace(0, 1, along + 1)
    angle = 2 * np.pi * turns * s
    path = np.stack([0.5 * np.cos(angle), 0.5 * np.sin(angle), 1.2 * turns * s], 1)
    return of_quads(sweep(path, circle(thickness, around), closed=False, caps=False), around * along)


@pytest.mark.parametrize(("around", "along", "turns"), [(10, 39, 5), (10, 159, 5), (12, 60, 2)])
def test_a_coil_is_a_rectangle_whatever_that_costs(around: int, along: int, turns: float) -> None:
    mesh = coil(around, along, 0.42, turns)
    result = lsgp.parameterize(mesh, [], None, STRIPS)
    assert not len(result.flipped) and not len(result.overlapping)
    assert len(result.cut_edges) == along
    assert off_any_rectangle(result, np.arange(len(mesh.triangles))) < 1e-5


@pytest.mark.parametrize("bend", [0.1, 0.25, 0.5, 0.75])
def test_a_bend_stretches_a_strip_as_by_formula(bend: float) -> None:
    """Symmetric Dirichlet energy keeps the girth of a round tube and gives all of its rows one length.

    A row at the angle t is 1 - k cos t long. With areas in these proportions the squared length has the mean
    1 + 3/2 k^2, and the squared inverse 1 / sqrt(1 - k^2).
    """
    around, along = 32, 128
    straight = np.linspace([0, 0, 0], [0, 0, 1], along + 1)
    mesh = sweep(straight, circle(1, around), closed=False, caps=False)
    turn, angle = np.meshgrid(2 * np.pi * np.arange(around) / around, np.linspace(0, np.pi, along + 1))
    out = 1 / bend + np.cos(turn)
    positions = np.stack([out * np.cos(angle), out * np.sin(angle), np.sin(turn)], 2).reshape(-1, 3)
    result = lsgp.parameterize(of_quads(mesh._replace(positions=positions), around * along), [], None, STRIPS)
    squared, inverse = 1 + 1.5 * bend**2, (1 - bend**2) ** -0.5
    length = (squared / inverse) ** 0.25
    expected = np.sqrt((length + squared / length) / 2)
    assert result.distortion.l2_stretch == pytest.approx(expected, abs=1e-3)


@pytest.mark.parametrize("preset", ["paint", "bake"])
def test_coils_are_straight_strips_and_their_excess_is_named(preset: lsgp.Preset) -> None:
    mesh = coil(10, 100, 0.42, 5)
    result = lsgp.auto_unwrap(mesh, preset=preset)
    assert not len(result.cones)
    for island in np.unique(result.island):
        assert off_any_rectangle(result, np.flatnonzero(result.island == island)) < 1e-3
    assert result.distortion.l2_stretch > 1.05
    (told,) = [finding for finding in result.warnings if finding.code == "HIGH_DISTORTION"]
    assert f"{100 * (result.distortion.l2_stretch - 1):.1f} %" in told.message
    np.testing.assert_array_equal(np.sort(told.elements.indices), np.arange(len(mesh.triangles)))
    straight = lsgp.auto_unwrap(of_pipe(10, 40, 0.5, False), preset=preset)
    assert all(finding.code != "HIGH_DISTORTION" for finding in straight.warnings)


@pytest.mark.parametrize(("taper", "is_straight"), [(0.95, True), (0.8, False)])
def test_only_what_is_a_straight_strip_is_told_to_be_stretched_as_one(taper: float, is_straight: bool) -> None:
    """A bent horn is stretched about as much, but as a sector."""
    around, along = 12, 40
    mesh = pipe(around, along, 4.0, False)
    rings = mesh.positions.reshape(along + 1, around, 3)
    middle = rings.mean(axis=1, keepdims=True)
    scaled = middle + (rings - middle) * np.linspace(1, taper, along + 1)[:, None, None]
    result = lsgp.auto_unwrap(of_quads(mesh._replace(positions=scaled.reshape(-1, 3)), around * along))
    assert not len(result.cones) and result.distortion.l2_stretch > 1.05
    assert any(finding.code == "HIGH_DISTORTION" for finding in result.warnings) == is_straight


def knot(around: int, along: int, thickness: float) -> lsgp.Surface:
    """A trefoil on a torus, with a row of quads beside that: rings are all of about the same girth."""
    s = 2 * np.pi * np.arange(along) / along
    outward = np.stack([np.cos(2 * s), np.sin(2 * s), 0 * s], 1)
    normal = np.cos(3 * s)[:, None] * outward + np.sin(3 * s)[:, None] * [0, 0, 1]
    path = 2 * outward + normal
    tangent = np.roll(path, -1, axis=0) - np.roll(path, 1, axis=0)
    side = np.cross(tangent / np.linalg.norm(tangent, axis=1, keepdims=True), normal)
    turn = 2 * np.pi * np.arange(around) / around
    rings = np.cos(turn)[:, None] * normal[:, None] + np.sin(turn)[:, None] * side[:, None]
    mesh = sweep(path, circle(thickness, around), closed=True, caps=False)
    return of_quads(mesh._replace(positions=(path[:, None] + thickness * rings).reshape(-1, 3)), around * along)


@pytest.mark.parametrize(("around", "along", "thickness"), [(8, 60, 0.3), (12, 160, 0.3), (12, 160, 0.4)])
def test_a_tube_that_is_closed_on_itself_is_cut_along_one_row_and_one_ring(
    around: int, along: int, thickness: float
) -> None:
    mesh = knot(around, along, thickness)
    tubes = lsgp.find_tubes(mesh)
    assert len(tubes.triangles) == len(mesh.triangles) and not len(tubes.borders)
    result = lsgp.parameterize(mesh, [], None, STRIPS)
    assert not len(result.flipped) and not len(result.overlapping)
    ring, place = result.cut_edges // around, result.cut_edges % around
    runs_around = ring[:, 0] == ring[:, 1]
    assert np.count_nonzero(runs_around) == around and len(np.unique(ring[runs_around])) == 1
    assert np.count_nonzero(~runs_around) == along and len(np.unique(place[~runs_around])) == 1
    assert off_any_rectangle(result, np.arange(len(mesh.triangles))) < 1e-5


@pytest.mark.parametrize("minor", [0.35, 0.5, 0.7, 0.75, 0.8, 1.0, 1.4])
def test_a_torus_is_a_tube_where_its_strip_is_hardly_stretched(minor: float) -> None:
    ratio = minor / 2
    mesh = surface(meshes.torus(60, round(60 * ratio), 2.0, minor))  # of about square quads
    is_slender = (1 + 1.5 * ratio**2) ** 0.25 <= 1.05
    assert len(lsgp.find_tubes(mesh).triangles) == (len(mesh.triangles) if is_slender else 0)


@pytest.mark.parametrize("change", [0.0, 0.04, 0.06])
def test_a_torus_is_a_tube_where_its_girth_is_even(change: float) -> None:
    mesh = meshes.torus(60, 18, 2.0, 0.5)
    angle = np.arctan2(mesh.positions[:, 1], mesh.positions[:, 0])
    middle = 2 * np.stack([np.cos(angle), np.sin(angle), 0 * angle], 1)
    scaled = middle + (mesh.positions - middle) * (1 + change * np.cos(angle))[:, None]
    is_even = 1 + change <= 1.1 * (1 - change)
    tubes = lsgp.find_tubes(surface(mesh._replace(positions=scaled)))
    assert len(tubes.triangles) == (len(mesh.triangles) if is_even else 0)


@pytest.mark.parametrize("rings", [3, 8])
def test_a_blade_ends_where_its_rings_are_folded_onto_themselves(rings: int) -> None:
    """Both sides of a row of quads: a ring has two quads, which meet at both ends of the blade."""
    low = 2 * np.arange(rings)[:, None]

    def of_each_ring(*corners: int) -> np.ndarray:
        return low + np.array(corners)

    front = np.concatenate([of_each_ring(0, 1, 3), of_each_ring(0, 3, 2)])
    back = np.concatenate([of_each_ring(1, 0, 2), of_each_ring(1, 2, 3)])
    step = np.arange(rings + 1)
    places = np.stack([np.stack([side + 0 * step, 0.01 * side * step, 0.3 * step], 1) for side in (0, 0.5)], 1)
    mesh = meshes.make(places.reshape(-1, 3), np.concatenate([front, back]).tolist())
    hidden = pairs(np.concatenate([of_each_ring(0, 3), of_each_ring(1, 2)]))
    quads = surface(
        mesh, edges=np.array([e for e in meshes.edges_of(mesh.triangles).tolist() if tuple(e) not in hidden])
    )
    tubes = lsgp.find_tubes(quads)
    assert len(tubes.triangles) == len(mesh.triangles)
    assert pairs(tubes.borders) == {(0, 1), (2 * rings, 2 * rings + 1)}


def with_bars(count: int, gap: bool = False) -> lsgp.Surface:
    """A block of triangles, and over it bars of quads, 6 cubes between their corners; perhaps with gaps."""
    filled = np.zeros((8, 4 * count - 1, 6), bool)
    filled[:, :, :3] = True
    filled[[0, -1], 1::4, 3:5] = True
    filled[:, 1::4, 5] = True
    filled[4, 1::4, 5] = not gap
    mesh = meshes.voxels(filled)
    height = mesh.positions[:, 2] - mesh.positions[:, 2].min()
    ends = np.stack([mesh.triangles, np.roll(mesh.triangles, -1, axis=1)], 2)
    length = np.linalg.norm(np.diff(mesh.positions[ends], axis=2)[:, :, 0], axis=2)
    diagonal = ends[np.arange(len(ends)), length.argmax(axis=1)]
    hidden = pairs(diagonal[(height[mesh.triangles] > height.max() / 2 * 1.01).all(axis=1)])
    return surface(
        mesh, edges=np.array([e for e in meshes.edges_of(mesh.triangles).tolist() if tuple(e) not in hidden])
    )


def test_handles_are_tubes_of_bodies_that_are_none() -> None:
    mesh = with_bars(1)
    tubes = lsgp.find_tubes(mesh)
    low, high = mesh.positions.min(axis=0), mesh.positions.max(axis=0)
    at = (mesh.positions[mesh.triangles].mean(axis=1) - low) / (high - low) * [8, 3, 6]
    in_bar = (at[:, 2] > 5 - 1e-9) & (at[:, 0] > 1 + 1e-9) & (at[:, 0] < 7 - 1e-9)
    np.testing.assert_array_equal(tubes.triangles, np.flatnonzero(in_bar))
    assert len(tubes.borders) == 2 * 4
    assert not len(lsgp.find_tubes(with_bars(1, gap=True)).triangles)


@pytest.mark.parametrize("preset", ["paint", "bake"])
@pytest.mark.parametrize("count", [1, 2, 3])
def test_every_handle_is_worth_its_own_island(count: int, preset: lsgp.Preset) -> None:
    """Together they are not weighed against a single one."""
    mesh = with_bars(count)
    corners = mesh.positions[mesh.triangles]
    area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    share = area[lsgp.find_tubes(mesh).triangles].sum() / area.sum() / count
    weights = lsgp.preset_weights(preset)
    worth = (weights.islands + 0.15) / share  # an island, and the error of estimates
    for factor in (0.9, 1.1):
        result = lsgp.auto_unwrap(mesh, preset=preset, weights=replace(weights, strips=factor * worth))
        assert any(choice.name == "tubes as strips" for choice in result.choices) == (factor > 1)


@pytest.mark.parametrize("ratio", [20, 40])
def test_long_strips_are_divided_into_equal_pieces(ratio: int) -> None:
    """No piece is longer than the others by more than two of its edges."""
    around = 8 * ratio
    height = around * 2 * np.sin(np.pi / around) / ratio
    ring = of_quads(sweep(np.array([[0, 0, 0], [0, 0, height]]), circle(1, around), closed=False, caps=False), around)
    result = lsgp.auto_unwrap(ring)
    counts = np.bincount(result.island)
    assert len(counts) > 2 and np.ptp(counts) <= 2 * 4
    assert abs(result.distortion.l2_stretch - 1) < 1e-9


def test_the_texture_runs_on_across_the_cut_without_turning() -> None:
    mesh, result = unwrapped(of_pipe(12, 40, 1.5, False))
    assert result.seams.sister_ratio_max < 1 + 1e-9 and result.seams.rotation_residual < 1e-9
    uv = {}
    turns = []
    for f, corners in enumerate(mesh.triangles):
        for c in range(3):
            tail, head = corners[c], corners[(c + 1) % 3]
            uv[tail, head] = result.corner_uv[f, (c + 1) % 3] - result.corner_uv[f, c]
    for (tail, head), here in uv.items():
        if (head, tail) in uv:
            turns.append(np.abs(here + uv[head, tail]).max())
    assert max(turns) < 1e-6


def test_triangles_are_halves_of_quads_across_their_longest_edges() -> None:
    mesh = of_pipe(12, 40, 1.0, True)
    bare = replace(mesh, edges=None)
    np.testing.assert_array_equal(lsgp.find_tubes(bare).triangles, lsgp.find_tubes(mesh).triangles)
    np.testing.assert_array_equal(lsgp.find_tubes(bare).borders, lsgp.find_tubes(mesh).borders)


@pytest.mark.parametrize("seed", range(5))
def test_the_order_of_vertices_and_triangles_changes_nothing(seed: int) -> None:
    mesh = of_pipe(9, 25, 1.0, True)
    rng = np.random.default_rng(seed)
    vertex, triangle = rng.permutation(len(mesh.positions)), rng.permutation(len(mesh.triangles))
    assert mesh.edges is not None
    other = lsgp.Surface(mesh.positions[np.argsort(vertex)], vertex[mesh.triangles[triangle]], vertex[mesh.edges])
    tubes, others = lsgp.find_tubes(mesh), lsgp.find_tubes(other)
    assert set(triangle[others.triangles]) == set(tubes.triangles)
    pairs = {tuple(sorted(pair)) for pair in vertex[tubes.borders].tolist()}
    assert {tuple(sorted(pair)) for pair in others.borders.tolist()} == pairs


@pytest.mark.parametrize(
    "mesh",
    [meshes.bumpy_sphere(2), meshes.cube(3), meshes.grid(5, 5), meshes.octahedron()],
    ids=["sphere", "box", "grid", "octahedron"],
)
def test_what_is_no_tube_has_none(mesh: Mesh) -> None:
    tubes = lsgp.find_tubes(surface(mesh))
    assert not len(tubes.borders) and not len(tubes.triangles)


def test_marked_cones_and_seams_have_precedence() -> None:
    mesh = of_pipe(12, 40, 1.0, True)
    seam = mesh.triangles[:1, :2]
    assert not len(lsgp.find_tubes(mesh, [100]).triangles)
    assert not len(lsgp.find_tubes(replace(mesh, seams=seam)).triangles)
    ring = of_pipe(12, 40, 1.5, False)
    for marked, options in (
        (ring, replace(STRIPS, loop_turning={0: 0.5})),
        (replace(ring, seams=seam), STRIPS),
    ):
        free = lsgp.parameterize(marked, [], None, replace(options, border="free"))
        np.testing.assert_array_equal(lsgp.parameterize(marked, [], None, options).corner_uv, free.corner_uv)


def test_rings_get_no_cones() -> None:
    mesh = of_pipe(12, 40, 1.5, True)
    ending = replace(mesh, borders=lsgp.find_tubes(mesh).borders)
    placed = lsgp.place_cones(ending, target=1.001, border="strips")
    assert not len(placed.cones) and placed.reached
    assert len(lsgp.place_cones(ending, target=1.001).cones) > 0


@pytest.mark.parametrize("around", [8, 15])
def test_a_seamless_strip_goes_around_in_whole_tiles(around: int) -> None:
    mesh = of_pipe(around, 30, 1.0, False)
    options = lsgp.Options(border="strips", seamless=lsgp.Seamless(tiles=12))
    result = lsgp.parameterize(mesh, [], None, options)
    assert result.seamless is not None
    rim = result.corner_uv[mesh.triangles < around]
    girth = max(np.ptp(rim[:, 0]), np.ptp(rim[:, 1]))
    assert abs(girth - round(girth)) < 1e-6 and round(girth) > 0


# --- in one press ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("preset", ["paint", "bake"])
@pytest.mark.parametrize(("around", "along", "bend"), [(8, 24, 0.0), (12, 40, 1.5), (16, 60, 2.5)])
def test_a_press_unrolls_pipes(around: int, along: int, bend: float, preset: lsgp.Preset) -> None:
    mesh = of_pipe(around, along, bend, True)
    result = lsgp.auto_unwrap(mesh, preset=preset)
    assert not len(result.cones) and result.distortion.l2_stretch < 1.05
    wall = np.arange(2 * around * along)
    for island in np.unique(result.island[wall]):
        assert off_any_rectangle(result, np.flatnonzero(result.island == island)) < 1e-3


@pytest.mark.parametrize("preset", ["paint", "bake"])
def test_without_the_wish_a_pipe_gets_cones_where_these_stretch_it_less(preset: lsgp.Preset) -> None:
    mesh = of_pipe(12, 40, 2.5, False)
    weights = replace(lsgp.preset_weights(preset), strips=0.0)
    usual, unrolled = (lsgp.auto_unwrap(mesh, preset=preset, weights=how) for how in (weights, None))
    assert len(usual.cones) > 0 == len(unrolled.cones)
    assert usual.distortion.l2_stretch < unrolled.distortion.l2_stretch


def opened(mesh: lsgp.Surface, around: int, along: int) -> lsgp.Surface:
    """A tube with a marked seam along it, and others around its ends."""
    line, ring = around * np.arange(along), np.arange(around)
    rims = [np.stack([at + ring, at + np.roll(ring, -1)], 1) for at in (0, around * along)]
    return replace(mesh, seams=np.concatenate([np.stack([line, line + around], 1), *rims]).astype(np.int32))


@pytest.mark.parametrize("seams", ["exact", "follow"])
@pytest.mark.parametrize("preset", ["paint", "bake"])
@pytest.mark.parametrize("caps", [False, True])
@pytest.mark.parametrize(("around", "along", "bend"), [(8, 24, 0.0), (12, 40, 1.5), (12, 120, 1.5), (16, 60, 1.0)])
def test_a_pipe_that_seams_open_is_a_rectangle(
    around: int, along: int, bend: float, caps: bool, preset: lsgp.Preset, seams: str
) -> None:
    mesh = opened(of_pipe(around, along, bend, caps), around, along)
    if not caps:
        mesh = replace(mesh, seams=mesh.seams[:along])
    result = lsgp.auto_unwrap(mesh, preset=preset, options=replace(lsgp.preset_options(preset), seams=seams))
    assert pairs(result.cut_edges) == pairs(mesh.seams) and not len(result.cones)
    assert off_any_rectangle(result, np.arange(2 * around * along)) < 1e-5
    assert result.distortion.l2_stretch < 1.05


def test_a_cone_that_a_seam_opens_stays_a_sector() -> None:
    mesh = replace(horn(16, 40, 0.5), seams=np.stack([16 * np.arange(40), 16 * np.arange(1, 41)], 1).astype(np.int32))
    result = lsgp.auto_unwrap(mesh)
    assert result.distortion.l2_stretch < 1.001
    assert off_any_rectangle(result, np.arange(len(mesh.triangles))) > 0.1


def test_a_hilly_grid_that_seams_bound_is_no_tube() -> None:
    hill = meshes.hill(10, height=1.0)
    other = meshes.hill(10, height=0.0)
    both = lsgp.Surface(
        np.concatenate([hill.positions, other.positions]),
        np.concatenate([hill.triangles, other.triangles + len(hill.positions)]),
    )
    assert not len(lsgp.find_tubes(both).triangles)


def test_horns_and_balls_stay_as_they_are_cut_best() -> None:
    assert not len(lsgp.auto_unwrap(horn(16, 40, 0.3)).cones)
    assert len(lsgp.auto_unwrap(surface(meshes.bumpy_sphere(3))).cones) > 0


def test_a_map_that_may_not_end_at_creases_ends_at_no_tube() -> None:
    mesh = of_pipe(12, 40, 1.5, True)
    assert len(lsgp.auto_unwrap(mesh, creases=False).cones) > 0
