# SPDX-License-Identifier: GPL-3.0-or-later
"""Cuts that are alike on both sides of a mirror plane."""

from __future__ import annotations

from dataclasses import replace

import lsgp
import meshes
import numpy as np
import oracle
import pytest
from map_checks import codes, only, pairs, surface
from opened_surface import named_by
from shared_meshes import shared_mesh

MIRRORED = lsgp.Options(mirrored_cuts=True)
EXACT = {"horned": meshes.two_horned(), "ball": meshes.icosphere(3), "box": meshes.cube(6, (2, 1, 1))}


def image_of(positions: np.ndarray, middle: float = 0.0) -> np.ndarray:
    """The vertex nearest to each vertex's mirror image in x = middle."""
    opposite = positions * [-1, 1, 1] + [2 * middle, 0, 0]
    return np.linalg.norm(opposite[:, None] - positions, axis=2).argmin(axis=1)


def mirrored_cones(mesh: meshes.Mesh, image: np.ndarray, seed: int, on_plane: int) -> np.ndarray:
    """Two to five pairs of random cones, and some on the plane."""
    rng = np.random.default_rng(seed)
    vertices = rng.permutation(len(mesh.positions))
    beside = vertices[image[vertices] != vertices][: rng.integers(2, 6)]
    return np.unique([*beside, *image[beside], *vertices[image[vertices] == vertices][:on_plane]]).astype(np.int32)


def lengths(mesh: meshes.Mesh, edges: np.ndarray) -> np.ndarray:
    return np.linalg.norm(np.diff(mesh.positions[edges], axis=1), axis=2).ravel()


def mirrored_share(mesh: meshes.Mesh, edges: np.ndarray, middle: float = 0.0) -> float:
    """Of the cuts' length, in tenths of edges: what is within an edge of the mirror image of a cut, or in the plane."""
    edge = lengths(mesh, meshes.edges_of(mesh.triangles)).mean()
    steps = (np.arange(10) + 0.5)[:, None, None] / 10
    ends = mesh.positions[edges]
    points = (ends[:, 0] + steps * (ends[:, 1] - ends[:, 0])).reshape(-1, 3)
    images = points * [-1, 1, 1] + [2 * middle, 0, 0]
    near = np.linalg.norm(images[:, None] - points, axis=2).min(axis=1) <= edge
    near |= np.abs(points[:, 0] - middle) <= edge / 2
    weight = np.tile(lengths(mesh, edges), 10)
    return float(weight @ near / weight.sum())


def assert_mirrored(mesh: meshes.Mesh, image: np.ndarray, edges: np.ndarray, middle: float = 0.0) -> None:
    """Edges beyond those beside the plane have the image of each, the others are within an edge of one."""
    assert mirrored_share(mesh, edges, middle) >= 1 - 1e-9
    away = np.abs(mesh.positions[:, 0] - middle) > lengths(mesh, meshes.edges_of(mesh.triangles)).max()
    far = edges[away[edges].any(axis=1)]
    assert pairs(image[far]) == pairs(far)


@pytest.mark.parametrize("on_plane", [0, 2])
@pytest.mark.parametrize("name", EXACT)
def test_every_cut_has_its_image(name: str, on_plane: int) -> None:
    mesh = EXACT[name]
    middle = (mesh.positions[:, 0].min() + mesh.positions[:, 0].max()) / 2
    image = image_of(mesh.positions, middle)
    of = surface(mesh)
    for seed in range(4):
        cones = mirrored_cones(mesh, image, seed, on_plane)
        usual = lsgp.parameterize(of, cones)
        mirrored = lsgp.parameterize(of, cones, options=MIRRORED)
        assert_mirrored(mesh, image, mirrored.cut_edges, middle)
        assert lengths(mesh, mirrored.cut_edges).sum() <= 1.5 * lengths(mesh, usual.cut_edges).sum()
        opened = oracle.cut_open(mesh.triangles, mirrored.cut_edges)
        assert oracle.euler_of(opened.corner) == 1 and len(np.unique(oracle.face_components(opened.corner))) == 1
        assert set(cones.tolist()) <= set(mirrored.cut_edges.ravel().tolist())
        assert oracle.metric_gap(mirrored.corner_uv, usual.corner_uv) <= 1e-7
        assert "CUTS_NOT_MIRRORED" not in codes(mirrored.warnings)


def with_holes(mesh: meshes.Mesh, places: list[list[float]]) -> meshes.Mesh:
    middle = mesh.positions[mesh.triangles].mean(axis=1)
    kept = (np.linalg.norm(middle[:, None] - np.array(places), axis=2) > 0.25).all(axis=1)
    return meshes.compact(mesh._replace(triangles=mesh.triangles[kept]))


HOLES = {
    "in the plane": [[0, -1, 0]],
    "a pair": [[0.6, 0, 0.8], [-0.6, 0, 0.8]],
    "both": [[0, -1, 0], [0, 0, -1], [0.8, -0.3, 0.5], [-0.8, -0.3, 0.5]],
}


@pytest.mark.parametrize("name", HOLES)
def test_cuts_to_holes_have_images_too(name: str) -> None:
    """A hole in the plane joins both sides; those beside it come in pairs like cones."""
    mesh = with_holes(meshes.two_horned(), HOLES[name])
    image = image_of(mesh.positions)
    rims = np.concatenate(oracle.boundary_loops(mesh.triangles))
    for seed in range(4):
        cones = np.setdiff1d(mirrored_cones(mesh, image, seed, seed % 3), rims)
        edges = lsgp.parameterize(surface(mesh), cones, options=MIRRORED).cut_edges
        assert_mirrored(mesh, image, edges)
        assert oracle.euler_of(oracle.cut_open(mesh.triangles, edges).corner) == 1


def test_handles_are_opened_on_both_sides_alike() -> None:
    mesh = meshes.subdivide(meshes.double_torus())
    middle = (mesh.positions[:, 0].min() + mesh.positions[:, 0].max()) / 2
    image = image_of(mesh.positions, middle)
    for seed in range(3):
        cones = mirrored_cones(mesh, image, seed, seed % 3)
        edges = lsgp.parameterize(surface(mesh), cones, options=MIRRORED).cut_edges
        # Around handles two ways may be of the same length but for rounding.
        assert mirrored_share(mesh, edges, middle) >= 0.9
        assert oracle.euler_of(oracle.cut_open(mesh.triangles, edges).corner) == 1


@pytest.mark.parametrize("turn", [0.0, 0.4])
def test_cuts_mirror_each_other_on_triangles_that_do_not(turn: float) -> None:
    mesh = meshes.two_horned(3, turn)
    of = surface(mesh)
    placed = lsgp.place_cones(of, symmetric=True)
    usual = lsgp.parameterize(of, placed.cones, placed.cone_angles)
    mirrored = lsgp.parameterize(of, placed.cones, placed.cone_angles, MIRRORED)
    assert mirrored_share(mesh, mirrored.cut_edges) >= 0.98
    assert mirrored_share(mesh, usual.cut_edges) < 0.95


@pytest.mark.slow
@pytest.mark.many_solves
def test_cuts_differ_no_more_than_the_sides_of_the_surface() -> None:
    """Where these differ by more than an edge, cuts on corresponding vertices are each other's images."""
    mesh = shared_mesh("max-planck-25k")
    edges = meshes.edges_of(mesh.triangles)
    plain = surface(mesh, edges=edges)
    of = replace(plain, cut_costs=lsgp.cut_costs(plain, front=(0, 0, 1)))
    placed = lsgp.place_cones(of, symmetric=True)
    result = lsgp.parameterize(of, placed.cones, placed.cone_angles, MIRRORED)
    named = [f.elements.indices for f in result.warnings if f.code == "CUTS_NOT_MIRRORED"]
    without_image = sum(lengths(mesh, np.asarray(edges)).sum() for edges in named)
    assert without_image <= 0.02 * lengths(mesh, result.cut_edges).sum()
    assert mirrored_share(mesh, result.cut_edges, float(mesh.positions[:, 0].mean())) < 0.95


def test_costs_of_one_side_keep_cuts_away_on_both() -> None:
    mesh = meshes.two_horned()
    image = image_of(mesh.positions)
    edges = meshes.edges_of(mesh.triangles)
    cones = mirrored_cones(mesh, image, 3, 0)
    before = lsgp.parameterize(surface(mesh, edges=edges), cones, options=MIRRORED).cut_edges
    away = np.abs(mesh.positions[:, 0]) > 0.3
    hot = before[away[before].all(axis=1) & ~np.isin(before, cones).any(axis=1)][0]
    one_side = mesh.positions[:, 0] * mesh.positions[hot[0], 0] > 0
    costs = np.where((np.isin(edges, hot).any(axis=1)) & one_side[edges].all(axis=1), 10.0, 1.0)
    after = lsgp.parameterize(surface(mesh, edges=edges, cut_costs=costs), cones, options=MIRRORED).cut_edges
    assert_mirrored(mesh, image, after)
    assert np.isin(before, hot).any() and not np.isin(after, np.concatenate([hot, image[hot]])).any()


def one_sided(mesh: meshes.Mesh, edges: np.ndarray) -> set[tuple[int, int]]:
    """Edges with a half whose middle is over an edge from the image in x = 0 of the middles of all halves."""
    edge = lengths(mesh, meshes.edges_of(mesh.triangles)).mean()
    tail, head = mesh.positions[edges].transpose(1, 0, 2)
    middles = np.concatenate([(3 * tail + head) / 4, (tail + 3 * head) / 4])
    apart = np.linalg.norm(middles[:, None] * [-1, 1, 1] - middles, axis=2).min(axis=1)
    return pairs(np.concatenate([edges, edges])[apart > edge])


def test_cuts_that_cannot_be_mirrored_are_named_once() -> None:
    """Two cones in the plane, which is too expensive for cuts: a way beside it and its image would enclose a piece."""
    mesh = meshes.two_horned()
    edges = meshes.edges_of(mesh.triangles)
    x, y = mesh.positions[:, 0], mesh.positions[:, 1]
    middle = np.flatnonzero(np.abs(x) < 1e-9)
    cones = [int(middle[y[middle].argmin()]), int(middle[y[middle].argmax()]), int(x.argmin()), int(x.argmax())]
    near, is_left = np.abs(x[edges]).max(axis=1) < 0.5, (x[edges] < 0).all(axis=1)
    costs = np.where(near, 20.0, 1.0) * np.where(is_left, 0.9, 1.0)
    alone = lsgp.parameterize(surface(mesh, edges=edges, cut_costs=costs), cones, options=MIRRORED)
    only_here = one_sided(mesh, alone.cut_edges)
    assert only_here and len(set(cones)) == 4
    assert pairs(only(alone.warnings, "CUTS_NOT_MIRRORED").elements.indices) == only_here

    both = meshes.merge([mesh, mesh])
    count = len(mesh.positions)
    twice = surface(both, edges=np.concatenate([edges, edges + count]), cut_costs=np.tile(costs, 2))
    result = lsgp.parameterize(twice, [*cones, *np.add(cones, count)], options=MIRRORED)
    finding = only(result.warnings, "CUTS_NOT_MIRRORED")
    assert finding.message.startswith(f"{2 * len(only_here)} cut edges have no mirror image, ")
    share = lengths(mesh, np.array(sorted(only_here))).sum() / lengths(mesh, alone.cut_edges).sum()
    assert f", {round(100 * share)} % of the length" in finding.message
    assert pairs(finding.elements.indices) == only_here | {(a + count, b + count) for a, b in only_here}

    # Those that are marked are as the user wants them.
    marked = surface(mesh, edges=edges, seams=np.array(sorted(only_here)))
    assert "CUTS_NOT_MIRRORED" not in codes(lsgp.parameterize(marked, cones, options=MIRRORED).warnings)
    assert "CUTS_NOT_MIRRORED" not in codes(lsgp.parameterize(twice, [*cones, *np.add(cones, count)]).warnings)


def test_cones_that_do_not_mirror_each_other_have_the_usual_cuts() -> None:
    mesh = meshes.two_horned()
    image = image_of(mesh.positions)
    cones = mirrored_cones(mesh, image, 1, 0)
    odd = np.append(cones, np.flatnonzero((image != np.arange(len(image))) & ~np.isin(np.arange(len(image)), cones))[0])
    usual = lsgp.parameterize(surface(mesh), odd)
    assert np.array_equal(usual.corner_uv, lsgp.parameterize(surface(mesh), odd, options=MIRRORED).corner_uv)


def test_auto_unwrap_mirrors_cuts_with_the_cones() -> None:
    mesh = meshes.two_horned()
    image = image_of(mesh.positions)
    options = replace(lsgp.preset_options("paint"), overlaps="keep", compact="off")
    result = lsgp.auto_unwrap(surface(mesh), options=options, pack="shelves")
    assert set(image[result.cones].tolist()) == set(result.cones.tolist()) and len(result.cones) > 2
    assert_mirrored(mesh, image, result.cut_edges)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("mesh", "count"),
    [
        (meshes.two_horned(2), 36),
        (meshes.two_horned(3), 36),
        (meshes.two_horned(3, 0.4), 24),
    ],
    ids=["coarse", "fine", "turned"],
)
def test_islands_that_are_split_or_made_compact_are_alike_on_both_sides(mesh: meshes.Mesh, count: int) -> None:
    middle = (mesh.positions[:, 0].min() + mesh.positions[:, 0].max()) / 2
    placed = lsgp.place_cones(surface(mesh), symmetric=True, count=count)
    kept = lsgp.parameterize(surface(mesh), placed.cones, placed.cone_angles, MIRRORED)
    assert len(kept.overlapping) > 0
    for compact in ("off", "full"):
        options = replace(MIRRORED, overlaps="split", compact=compact)
        split = lsgp.parameterize(surface(mesh), placed.cones, placed.cone_angles, options)
        assert len(split.overlapping) == 0
        assert mirrored_share(mesh, split.cut_edges, middle) >= 0.98
        assert set(placed.cones.tolist()) <= set(split.cut_edges.ravel().tolist())
        assert split.seams.sister_ratio_max <= 1 + 1e-9
        # A motion for each piece: no triangle changes its shape.
        assert oracle.metric_gap(kept.corner_uv, split.corner_uv) <= 1e-9


@pytest.mark.slow
def test_cuts_of_split_islands_with_handles_are_alike_on_both_sides_or_named() -> None:
    """Rounding decides which cones and cuts are found where many are equally good."""
    mesh = meshes.subdivide(meshes.double_torus())
    middle = (mesh.positions[:, 0].min() + mesh.positions[:, 0].max()) / 2
    shares = []
    for seed in range(6):
        noise = np.random.default_rng(seed).standard_normal(mesh.positions.shape)
        moved = mesh._replace(positions=mesh.positions * (1 + 1e-15 * noise))
        placed = lsgp.place_cones(surface(moved), symmetric=True, count=12)
        for compact in ("off", "full"):
            options = replace(MIRRORED, overlaps="split", compact=compact)
            split = lsgp.parameterize(surface(moved), placed.cones, placed.cone_angles, options)
            assert len(split.overlapping) == 0
            named = lengths(moved, named_by(split, "CUTS_NOT_MIRRORED").reshape(-1, 2)).sum()
            shares.append(mirrored_share(moved, split.cut_edges, middle))
            assert shares[-1] + named / lengths(moved, split.cut_edges).sum() >= 0.98
    assert np.mean(shares) >= 0.95


@pytest.mark.parametrize(
    ("mesh", "count", "fuller"),
    [
        (meshes.two_horned(3), 12, 2.0),
        (meshes.two_horned(3, 0.4), 28, 2.0),
        (meshes.ellipsoid(2, (1, 1.4, 3)), 16, 1.1),
    ],
    ids=["horned", "turned", "ellipsoid"],
)
def test_cuts_that_fill_the_square_are_not_closed_to_be_alike(mesh: meshes.Mesh, count: int, fuller: float) -> None:
    middle = (mesh.positions[:, 0].min() + mesh.positions[:, 0].max()) / 2
    placed = lsgp.place_cones(surface(mesh), symmetric=True, count=count)

    def unwrapped(compact: str) -> tuple[lsgp.Result, float]:
        """The map, and how far its area fills the box of its largest island, made a square."""
        options = replace(MIRRORED, overlaps="split", compact=compact)
        result = lsgp.parameterize(surface(mesh), placed.cones, placed.cone_angles, options)
        sides = [
            np.ptp(result.corner_uv[result.island == i], axis=(0, 1)).max() for i in range(result.island.max() + 1)
        ]
        return result, float(oracle.signed_areas(result.corner_uv).sum() / max(sides) ** 2)

    (whole, filled_whole), (cut, filled_cut) = unwrapped("off"), unwrapped("full")
    assert whole.island.max() == 0 < cut.island.max()
    assert filled_cut > fuller * filled_whole
    assert mirrored_share(mesh, cut.cut_edges, middle) >= 0.98
    assert oracle.metric_gap(whole.corner_uv, cut.corner_uv) <= 1e-9


@pytest.mark.slow
@pytest.mark.parametrize(
    "turn", [pytest.param(0.0, id="exact"), pytest.param(0.4, id="turned", marks=pytest.mark.many_solves)]
)
def test_islands_that_mirror_themselves_are_divided_alike_on_both_sides(turn: float) -> None:
    """With all but one of several numbers of cones; single sets may overlap, and are then divided further."""
    mesh = meshes.two_horned(3, turn)
    shares = []
    for count in (8, 10, 12, 16, 20, 24):
        placed = lsgp.place_cones(surface(mesh), symmetric=True, count=count)
        options = replace(MIRRORED, overlaps="split", compact="full")
        result = lsgp.parameterize(surface(mesh), placed.cones, placed.cone_angles, options)
        assert result.island.max() > 0
        shares.append(mirrored_share(mesh, result.cut_edges))
    assert sum(share < 0.98 for share in shares) <= 1, shares


@pytest.mark.parametrize(("around", "along"), [(18, 10), (24, 12), (30, 16)])
def test_a_torus_without_cones_is_cut_alike_on_both_sides(around: int, along: int) -> None:
    """Its plane is one of several: here either x or y is mirrored in it, as the cut along it is in z anyway."""
    mesh = meshes.torus(around, along)
    edges = lsgp.parameterize(surface(mesh), [], None, MIRRORED).cut_edges
    turned = mesh._replace(positions=mesh.positions[:, [1, 0, 2]])
    assert max(mirrored_share(either, edges) for either in (mesh, turned)) >= 1 - 1e-9
