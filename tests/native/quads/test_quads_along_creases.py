# SPDX-License-Identifier: GPL-3.0-or-later
"""Creases of hard surfaces are rows of edges of quads, also on models with few vertices inside their faces."""

from __future__ import annotations

import itertools
from dataclasses import fields, replace
from functools import cache

import lsgp
import meshes
import numpy as np
import oracle
import pytest
from hulls import hull
from lsgp.quads.divided_triangles import divide_long_edges
from map_checks import codes, surface
from meshes import Mesh
from nightly import nightly
from numpy.typing import NDArray
from quad_checks import fans, require_on_surface, sides
from sanitized_run import many_solves
from scipy.spatial import HalfspaceIntersection, cKDTree
from shared_meshes import hard_mesh, shared_mesh
from zoo import closed

EXACT = 1e-6  # of the size
SHARP = np.radians(40)
SLAB = np.zeros((5, 5, 2), bool)
SLAB[:2], SLAB[:, :2] = True, True


STRAIGHT = {
    "cube of twelve triangles": closed.box(1, (1, 1, 1)),
    "flat box": closed.box(3, (1, 1.7, 0.3)),
    "long box": closed.box(2, (1, 1.2, 5)),
    "L": meshes.voxels(SLAB),
    "low L": meshes.voxels(SLAB[:, :, :1]),
    "square prism": closed.prism(4, 3, 1.5),
    "hexagonal prism": closed.prism(6, 3, 2.0),
    "octagonal prism": closed.prism(8, 3, 1.0),
}
BEVELED = {"beveled block": closed.beveled_box(6, 0.15, (1, 1.3, 0.8))}
ROUND = {"cylinder": closed.prism(24, 3, 2.0), "disk": closed.prism(32, 3, 0.4), "rod": closed.prism(16, 3, 6.0)}
SOLIDS = STRAIGHT | BEVELED | ROUND
TARGETS = (300, 1000, pytest.param(4000, marks=pytest.mark.many_solves))
ROUNDED = 0.02  # of the stretch, by grids of another size


@cache
def remesh(name: str, target: int) -> lsgp.QuadRemesh:
    return lsgp.remesh_to_quads(surface(SOLIDS[name]), target=target)


def creases(mesh: lsgp.Surface | Mesh) -> NDArray[np.int64]:
    """One halfedge of each edge at which a closed surface bends."""
    corners = mesh.positions[mesh.triangles]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    twin = oracle.halfedges(mesh.triangles)[2]
    h = np.arange(len(twin))
    bend = np.arccos(np.clip((normal[h // 3] * normal[twin // 3]).sum(axis=1), -1, 1))
    return h[(bend > SHARP) & (h < twin)]


def carried_share(mesh: Mesh, quads: lsgp.QuadMesh) -> float:
    """Of the length of creases: where an edge of a quad is, along it."""
    h = creases(mesh)
    begin = mesh.positions[mesh.triangles.ravel()[h]]
    end = mesh.positions[mesh.triangles.ravel()[h // 3 * 3 + (h + 1) % 3]]
    tail = quads.positions[quads.quads.ravel()]
    side = quads.positions[np.roll(quads.quads, -1, axis=1).ravel()] - tail
    size, kept, whole = np.ptp(mesh.positions, axis=0).max(), 0.0, 0.0
    for a, b in zip(begin, end, strict=True):
        length = np.linalg.norm(b - a)
        along = (b - a) / length
        is_parallel = np.linalg.norm(np.cross(side, along), axis=1) < EXACT * size
        near, edge = tail[is_parallel], side[is_parallel]
        for step in (np.arange(8) + 0.5) / 8:
            point = a + step * (b - a)
            share = np.clip(((point - near) * edge).sum(axis=1) / (edge**2).sum(axis=1), 0, 1)
            away = np.linalg.norm(near + share[:, None] * edge - point, axis=1)
            kept += length / 8 if (away < EXACT * size).any() else 0.0
        whole += length
    return kept / whole


@pytest.mark.slow
@pytest.mark.parametrize("target", TARGETS)
@pytest.mark.parametrize("name", STRAIGHT)
def test_edges_of_quads_carry_every_crease(name: str, target: int) -> None:
    assert carried_share(SOLIDS[name], remesh(name, target).mesh) == pytest.approx(1, abs=1e-6)


@pytest.mark.parametrize("target", TARGETS)
@pytest.mark.parametrize("name", SOLIDS)
def test_creases_lie_on_whole_cells_of_the_layout(name: str, target: int) -> None:
    found = remesh(name, target)
    h = creases(found.surface)
    uv = found.layout.corner_uv.astype(np.float32).astype(float).reshape(-1, 2) / found.layout.seamless.cell
    both = np.stack([uv[h], uv[h // 3 * 3 + (h + 1) % 3]], axis=1)
    assert ((both[:, 0] == both[:, 1]) & (both[:, 0] == np.round(both[:, 0]))).any(axis=1).all()
    assert "FEATURES_OFF_LATTICE" not in codes(found.warnings)


@pytest.mark.parametrize("target", TARGETS)
@pytest.mark.parametrize("name", SOLIDS)
def test_they_are_a_closed_manifold_whose_irregular_vertices_are_the_cones(name: str, target: int) -> None:
    mesh, found = SOLIDS[name], remesh(name, target)
    once = sides(found.mesh.quads)
    assert set(once.values()) == {1} and all((b, a) in once for a, b in once)
    assert fans(found.mesh.quads) == len(found.mesh.positions) == len(found.mesh.quads) + 2
    require_on_surface(mesh, found.mesh)
    turns = np.round(found.layout.cone_angles / (np.pi / 2)).astype(int)
    assert sorted(turns[turns != 4].tolist()) == sorted(found.mesh.valences[found.mesh.irregular].tolist())
    assert len(found.mesh.quads) == pytest.approx(target, rel=0.15)


@pytest.mark.parametrize("name", ["cube of twelve triangles", "beveled block", "cylinder", "L"])
def test_the_same_bytes_along_creases_for_any_number_of_threads(name: str) -> None:
    seen = []
    for threads in (1, 2):
        options = lsgp.Options(seamless=lsgp.Seamless(), straighten=True, threads=threads)
        remesh = lsgp.remesh_to_quads(surface(SOLIDS[name]), target=1000, options=options)
        assert remesh.layout.seamless.feature_share > 0.9
        seen.append([getattr(remesh.mesh, field.name).tobytes() for field in fields(remesh.mesh)])
    assert seen[0] == seen[1]


def chamfered(size: tuple[float, float, float], width: float, every: int) -> Mesh:
    """A box of few triangles, one in `every` of whose edges is a plane of this width."""
    planes = [[*(side * axis), -size[k]] for k, axis in enumerate(np.eye(3)) for side in (1, -1)]
    edges = [(i, j, a, b) for i in range(3) for j in range(i) for a in (1, -1) for b in (1, -1)]
    for i, j, a, b in edges[::every]:
        normal = (a * np.eye(3)[i] + b * np.eye(3)[j]) / np.sqrt(2)
        planes.append([*normal, width - (size[i] + size[j]) / np.sqrt(2)])
    corners = HalfspaceIntersection(np.array(planes), np.zeros(3)).intersections
    return hull(np.unique(np.round(corners, 9), axis=0))


def remesh_of_bevels(width: float, every: int, target: int, seed: int) -> tuple[float, float]:
    """The share of the corners of a box with bevels, all of its vertices, that are vertices of quads, and of its
    creases that edges carry. Its symmetry is broken, so that no rounding error decides alike everywhere."""
    mesh = chamfered((1, 1.3, 0.8), width, every)
    off = 1e-9 * np.random.default_rng(seed).standard_normal(mesh.positions.shape)
    mesh = mesh._replace(positions=mesh.positions + off)
    found = lsgp.remesh_to_quads(surface(mesh), target=target).mesh
    return np.isin(np.arange(len(mesh.positions)), found.surface_vertices).mean(), carried_share(mesh, found)


@pytest.mark.slow
@pytest.mark.many_solves
@pytest.mark.parametrize(
    ("widths", "targets", "least"), [*nightly(((0.05, 0.1, 0.15), (1000, 4000), 0.88)), ((0.2, 0.25), (4000,), 0.95)]
)
def test_corners_of_bevels_are_vertices_of_quads(
    widths: tuple[float, ...], targets: tuple[int, ...], least: float
) -> None:
    """The narrowest ones are narrower than a quad."""
    cases = itertools.product(widths, (1, 2), targets, (1, 2))
    kept, carried = np.mean([remesh_of_bevels(*case) for case in cases], axis=0)
    assert kept >= least
    assert carried >= least


@pytest.mark.slow
@pytest.mark.many_solves
@pytest.mark.parametrize("name", ["disk", "hexagonal prism", "octagonal prism"])
def test_rounding_takes_no_number_of_quads_far_from_the_target(name: str) -> None:
    """Coarse grids along creases have few sizes to choose from, and the last digits of positions decide which. A tenth
    is near enough; a layout that follows features may miss by a quarter more than one that follows none."""
    given, target = surface(SOLIDS[name]), 300
    missed = []
    for seed in range(1, 9):
        off = 1e-15 * np.random.RandomState(seed).standard_normal(given.positions.shape)
        found = lsgp.remesh_to_quads(replace(given, positions=given.positions + off), target=target)
        missed.append(abs(len(found.mesh.quads) / target - 1))
    assert np.mean(missed) <= 0.1 and max(missed) <= 0.1 + 0.25


@pytest.mark.parametrize("name", ["cylinder", "disk"])
def test_few_vertices_on_round_faces_do_not_limit_quads(name: str) -> None:
    """The caps are fans around one vertex, where no cone can be; a divided surface has room for some."""
    found = remesh(name, 1000)
    quality = lsgp.quad_quality(found.mesh.positions, found.mesh.quads)
    assert len(found.surface.triangles) > len(SOLIDS[name].triangles)
    assert quality.angle_error < np.radians(6)


def test_a_surface_that_is_fine_or_soft_is_not_divided() -> None:
    for mesh in (meshes.cube(12), meshes.bumpy_sphere(2), meshes.icosphere(1)):
        given = surface(mesh)
        assert lsgp.remesh_to_quads(given, target=200).surface == given


@pytest.mark.nightly
def test_cones_that_cost_much_by_themselves_are_placed_where_creases_gain_by_them() -> None:
    mesh = shared_mesh("fandisk")
    remesh = lsgp.remesh_to_quads(surface(mesh), target=500)
    assert remesh.layout.seamless.feature_share > 0.9


def test_without_straight_sides_creases_are_not_followed() -> None:
    mesh = STRAIGHT["flat box"]
    turned = meshes.transform(mesh, seed=1)
    options = lsgp.Options(seamless=lsgp.Seamless())
    found = lsgp.remesh_to_quads(surface(turned), target=300, options=options)
    assert found.layout.seamless.feature_share is None
    assert carried_share(turned, found.mesh) < 0.9


@pytest.mark.slow
@pytest.mark.parametrize("target", [400, *nightly(2000, marks=[pytest.mark.many_solves])])
@pytest.mark.parametrize(
    "name",
    [
        "gear of 5 teeth",
        *many_solves("spool"),
        *nightly("gear of 7 teeth", "joint", marks=[pytest.mark.many_solves]),
    ],
)
def test_creases_cost_stretch_by_the_share_that_is_followed(name: str, target: int) -> None:
    teeth = {"gear of 5 teeth": 5, "gear of 7 teeth": 7}.get(name)
    given = surface(hard_mesh(name) if teeth is None else closed.gear(teeth, 0.3, 2))
    along = lsgp.remesh_to_quads(given, target=target).layout
    plain = lsgp.remesh_to_quads(given, target=target, options=lsgp.Options(seamless=lsgp.Seamless())).layout
    share = along.seamless.feature_share or 0.0
    assert along.distortion.l2_stretch <= (1 + 0.2 * share + ROUNDED) * plain.distortion.l2_stretch


# --- dividing -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("longest", [0.5, 0.3, 0.2])
@pytest.mark.parametrize("name", ["cylinder", "L", "cube of twelve triangles"])
def test_a_divided_surface_is_the_same_surface_without_long_edges(name: str, longest: float) -> None:
    mesh = SOLIDS[name]
    found = divide_long_edges(surface(mesh), longest)
    positions, triangles = found.surface.positions, found.surface.triangles
    assert np.array_equal(positions[: len(mesh.positions)], mesh.positions)
    corners = positions[triangles]
    assert np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max() <= longest
    once = sides(triangles)
    assert set(once.values()) == {1} and all((b, a) in once for a, b in once)
    places = mesh.positions[mesh.triangles][found.triangles]
    np.testing.assert_allclose(np.einsum("tck,tkx->tcx", found.corners, places), corners, atol=1e-14)
    np.testing.assert_allclose(
        np.bincount(found.triangles, areas(corners)), areas(mesh.positions[mesh.triangles]), rtol=1e-12
    )


def areas(corners: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1) / 2


def test_parts_are_named_as_what_they_are_parts_of() -> None:
    mesh = closed.box(1, (1, 1, 1))
    features = mesh.triangles[:3, :2]
    found = divide_long_edges(replace(surface(mesh), features=features), 0.3)
    named = found.elements(lsgp.Elements("edges", found.surface.features))
    assert named.indices.tolist() == sorted(np.sort(features, axis=1).tolist())
    divided = found.surface.positions[found.surface.features]
    length = np.linalg.norm(np.diff(divided, axis=1), axis=2).sum()
    given = np.linalg.norm(np.diff(mesh.positions[features], axis=1), axis=2).sum()
    assert length == pytest.approx(given)
    every = lsgp.Elements("triangles", np.arange(len(found.surface.triangles), dtype=np.int32))
    assert found.elements(every).indices.tolist() == list(range(12))
    vertices = lsgp.Elements("vertices", np.arange(len(found.surface.positions), dtype=np.int32))
    assert found.elements(vertices).indices.tolist() == list(range(8))


def test_needles_are_not_divided_without_end() -> None:
    mesh = closed.box(1, (1, 1, 1))
    needles = mesh._replace(positions=mesh.positions * (1e5, 1, 1))
    found = divide_long_edges(surface(needles), 1.0)
    assert len(found.surface.triangles) <= 20_000


def test_warnings_name_the_given_edges() -> None:
    mesh = closed.gear(6, 0.3, 1)
    found = lsgp.remesh_to_quads(surface(mesh), target=300)
    assert any(finding.elements.kind == "edges" for finding in found.warnings)
    edges = {tuple(sorted(pair)) for t in mesh.triangles.tolist() for pair in zip(t, t[1:] + t[:1], strict=True)}
    for finding in found.warnings:
        if finding.elements.kind == "edges":
            assert {tuple(sorted(pair)) for pair in finding.elements.indices.tolist()} <= edges
    assert found.mesh.triangles.max() < len(mesh.triangles)
    assert found.mesh.surface_vertices.max() < len(mesh.positions)


def test_distances_of_irregular_vertices_from_features() -> None:
    """Of an equator that is marked on a ball, as to samples of it."""
    ball = meshes.icosphere(3)
    on_equator = np.abs(ball.positions[:, 2]) < 1e-9
    edges = np.unique(np.sort(ball.triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1), axis=0)
    marked = edges[on_equator[edges].all(axis=1)]
    remesh = lsgp.remesh_to_quads(replace(surface(ball), features=marked), target=400)
    ends = remesh.surface.positions[remesh.surface.features]
    part = np.linspace(0, 1, 101)[:, np.newaxis, np.newaxis]
    samples = (ends[:, 0] + part * (ends[:, 1] - ends[:, 0])).reshape(-1, 3)
    distance = cKDTree(samples).query(remesh.surface.positions[remesh.layout.cones])[0]
    step = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).max() / 100
    measured = remesh.feature_distances() * remesh.layout.seamless.tile_size
    assert len(measured) == len(remesh.mesh.irregular) > 0
    assert (measured <= distance + 1e-12).all() and (distance <= np.hypot(measured, step) + 1e-12).all()
    assert measured.max() > 0.1
    assert len(lsgp.remesh_to_quads(surface(ball), target=400).feature_distances()) == 0
