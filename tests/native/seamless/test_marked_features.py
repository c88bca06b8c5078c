# SPDX-License-Identifier: GPL-3.0-or-later
"""Edges that are marked as features run straight along u or v of a seamless layout; those that do not are named."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import lsgp
import meshes
import numpy as np
import oracle
import pytest
from map_checks import codes, only, surface
from meshes import Mesh
from nightly import nightly
from numpy.typing import NDArray
from result_check import undeclared_faults
from sanitized_run import many_solves
from zoo import closed

TILE = lsgp.preset_options("tile")
# No creases: what runs along the lattice is marked.
PLAIN = replace(TILE, straighten=False)
BOX = closed.box(4, (1, 1.37, 2.11))


def on_lattice(kind: lsgp.api.Lattice, options: lsgp.Options = PLAIN) -> lsgp.Options:
    return replace(options, seamless=replace(options.seamless, lattice=kind))


def edges_at(mesh: Mesh, is_on: NDArray[np.bool_]) -> NDArray[np.int64]:
    """Edges both of whose ends are among these vertices."""
    edges = meshes.edges_of(mesh.triangles)
    return edges[is_on[edges].all(axis=1)]


def around_the_middle() -> NDArray[np.int64]:
    """A closed loop across the flat sides of the box, half way between its ends."""
    height = BOX.positions[:, 2]
    return edges_at(BOX, np.isclose(height, (height.min() + height.max()) / 2))


def marked(mesh: Mesh, edges: NDArray[np.integer]) -> lsgp.Surface:
    return replace(surface(mesh), features=edges)


def ends(mesh: Mesh, result: lsgp.Result, edges: NDArray[np.integer]) -> NDArray[np.float64]:
    """(s, 2, 2) both ends in the layout, as float32 stores them, of every side of these edges."""
    uv = result.corner_uv.astype(np.float32).astype(float)
    sides = np.stack([mesh.triangles, np.roll(mesh.triangles, -1, axis=1)], axis=-1).reshape(-1, 2)
    both = np.stack([uv, np.roll(uv, -1, axis=1)], axis=-2).reshape(-1, 2, 2)
    count = len(mesh.positions)
    keys, wanted = (np.sort(pairs, axis=1).astype(int) @ [count, 1] for pairs in (sides, edges))
    return both[np.isin(keys, wanted)]


def is_along_axis(both: NDArray[np.float64]) -> NDArray[np.bool_]:
    return (both[:, 0] == both[:, 1]).any(axis=1)


@cache
def box_around_the_middle(kind: lsgp.api.Lattice) -> lsgp.Result:
    return lsgp.auto_unwrap(marked(BOX, around_the_middle()), preset="tile", options=on_lattice(kind))


@pytest.mark.parametrize("kind", ["square", "stripe"])
def test_a_marked_loop_runs_along_an_axis(kind: lsgp.api.Lattice) -> None:
    result = box_around_the_middle(kind)
    assert is_along_axis(ends(BOX, result, around_the_middle())).all()
    assert result.features == lsgp.FeatureReport(1.0, [])
    assert "FEATURES_RELEASED" not in codes(result.warnings)
    assert undeclared_faults(marked(BOX, around_the_middle()), result, on_lattice(kind)) == []


def test_without_marks_it_does_not() -> None:
    result = lsgp.auto_unwrap(surface(BOX), preset="tile", options=PLAIN)
    assert not is_along_axis(ends(BOX, result, around_the_middle())).all()
    assert result.features is None


def test_a_marked_loop_around_a_tube_without_cones() -> None:
    mesh = meshes.torus()
    loop = edges_at(mesh, np.isclose(np.arctan2(mesh.positions[:, 1], mesh.positions[:, 0]), 0))
    assert len(loop) > 2
    options = on_lattice("translation")
    result = lsgp.parameterize(marked(mesh, loop), (), options=options)
    assert is_along_axis(ends(mesh, result, loop)).all()
    assert result.features.share == 1
    assert undeclared_faults(marked(mesh, loop), result, options) == []


def test_triangles_have_no_axes() -> None:
    result = box_around_the_middle("hexagon")
    assert {feature.reason for feature in result.features.released} == {"unsupported"}


def test_marked_borders_are_straight() -> None:
    """The border of a tent is bent in space and in the free map."""
    mesh = meshes.grid(6, 8, lambda x, y: 2 - 0.2 * (x - 3) ** 2 - 0.1 * (y - 4) ** 2)
    edges = lsgp.feature_edges(surface(mesh), borders=True)
    assert len(edges) == 28
    tent = marked(mesh, edges)
    free, result = (lsgp.auto_unwrap(each, preset="tile", options=PLAIN) for each in (surface(mesh), tent))
    assert not is_along_axis(ends(mesh, free, edges)).all()
    assert is_along_axis(ends(mesh, result, edges)).all()
    assert result.features.share == 1
    assert undeclared_faults(tent, result, PLAIN) == []


def test_rims_of_a_cone_run_along_the_lattice() -> None:
    """In the free map they are arcs, without a corner where they could turn."""
    mesh = closed.lathe(np.linspace(1, 0.4, 6), np.linspace(0, 2, 6), 24, caps=(True, True))
    edges = lsgp.feature_edges(surface(mesh), angle=0.7)
    frustum = marked(mesh, edges)
    result = lsgp.auto_unwrap(frustum, preset="tile", options=PLAIN, creases=False)
    assert len(edges) == 48
    assert is_along_axis(ends(mesh, result, edges)).all()
    assert result.features.share == 1
    assert undeclared_faults(frustum, result, PLAIN) == []


@pytest.mark.slow
@pytest.mark.parametrize(
    "teeth, depth",
    [(5, 0.25), *many_solves((7, 0.25)), *nightly((8, 0.25), (10, 0.15), marks=[pytest.mark.many_solves])],
)
def test_all_edges_of_toothed_wheels_run_along_the_lattice(teeth: int, depth: float) -> None:
    mesh = closed.toothed_wheel(teeth, depth)
    edges = lsgp.feature_edges(surface(mesh), angle=0.7)
    wheel = marked(mesh, edges)
    result = lsgp.auto_unwrap(wheel, preset="tile", options=PLAIN, creases=False)
    assert is_along_axis(ends(mesh, result, edges)).all()
    assert result.features == lsgp.FeatureReport(1.0, [])
    assert undeclared_faults(wheel, result, PLAIN) == []


@pytest.mark.parametrize("teeth, depth", [(5, 0.4), *nightly((12, 0.2), marks=[pytest.mark.many_solves])])
def test_the_share_of_deep_teeth_is_that_of_the_edges_along_the_lattice(teeth: int, depth: float) -> None:
    """A few of them fold the layout, and are released where they do: how many hangs on rounding."""
    mesh = closed.toothed_wheel(teeth, depth)
    edges = lsgp.feature_edges(surface(mesh), angle=0.7)
    wheel = marked(mesh, edges)
    free, result = (
        lsgp.auto_unwrap(each, preset="tile", options=PLAIN, creases=False) for each in (surface(mesh), wheel)
    )
    lengths = np.linalg.norm(np.diff(mesh.positions[edges], axis=1)[:, 0], axis=1)

    def straight_share(of: lsgp.Result) -> float:
        is_straight = [is_along_axis(ends(mesh, of, edge[None])).all() for edge in edges]
        return lengths[is_straight].sum() / lengths.sum()

    assert straight_share(result) == pytest.approx(result.features.share, abs=1e-9)
    assert straight_share(result) > 2 * straight_share(free)
    assert undeclared_faults(wheel, result, PLAIN) == []


@pytest.mark.parametrize("teeth, depth", [(6, 0.4), *nightly((7, 0.4), (9, 0.4), marks=[pytest.mark.many_solves])])
def test_parts_end_at_creases_where_marked_features_gain_by_that(teeth: int, depth: float) -> None:
    mesh = closed.toothed_wheel(teeth, depth)
    edges = lsgp.feature_edges(surface(mesh), angle=0.7)
    wheel = marked(mesh, edges)
    joined, ended = (lsgp.auto_unwrap(wheel, preset="tile", creases=creases) for creases in (False, True))
    assert not len(joined.borders) and len(ended.borders)
    assert is_along_axis(ends(mesh, ended, edges)).all() and ended.features.share == 1
    assert ended.seamless.tile_size > 2 * joined.seamless.tile_size
    assert ended.distortion.l2_stretch < joined.distortion.l2_stretch
    assert undeclared_faults(replace(wheel, borders=ended.borders), ended, TILE) == []


def test_released_features_are_named_with_their_shares() -> None:
    mesh = meshes.icosphere(2)
    edges = meshes.edges_of(mesh.triangles)[::3]
    ball = marked(mesh, edges)
    result = lsgp.auto_unwrap(ball, preset="tile", options=PLAIN)
    twice = np.sort(edges, axis=1) @ [len(mesh.positions), 1]
    released = np.concatenate([np.stack([f.path[:-1], f.path[1:]], axis=1) for f in result.features.released])
    off = {tuple(edge) for edge in edges.tolist() if not is_along_axis(ends(mesh, result, np.array([edge]))).all()}
    assert off and {tuple(sorted(edge)) for edge in released.tolist()} == {tuple(sorted(edge)) for edge in off}
    length = np.linalg.norm(np.diff(mesh.positions[edges], axis=1)[:, 0], axis=1)
    is_off = np.isin(twice, np.sort(released, axis=1).astype(int) @ [len(mesh.positions), 1])
    assert result.features.share == pytest.approx(1 - length[is_off].sum() / length.sum(), abs=1e-9)
    assert sum(f.share for f in result.features.released) == pytest.approx(1 - result.features.share, abs=1e-9)
    named = only(result.warnings, "FEATURES_RELEASED").elements
    assert {tuple(sorted(edge)) for edge in named.indices.tolist()} == {tuple(sorted(edge)) for edge in off}
    assert undeclared_faults(ball, result, PLAIN) == []


def test_features_have_to_be_edges() -> None:
    far = np.array([[0, len(BOX.positions) - 1]])
    with pytest.raises(lsgp.InputError) as refused:
        lsgp.parameterize(marked(BOX, far), ())
    assert refused.value.code == "EDGE_NOT_IN_MESH"
    assert refused.value.elements.indices.tolist() == far.tolist()
    with pytest.raises(lsgp.InputError) as refused:
        lsgp.parameterize(marked(BOX, far + len(BOX.positions)), ())
    assert refused.value.code == "INDEX_OUT_OF_RANGE"


def bent_edges(mesh: Mesh, least: float) -> set[tuple[int, int]]:
    corners = mesh.positions[mesh.triangles]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    twin = oracle.halfedges(mesh.triangles)[2]
    corner, out = mesh.triangles.ravel(), set()
    for h in np.flatnonzero(twin >= 0):
        if np.arccos(np.clip(normal[h // 3] @ normal[twin[h] // 3], -1, 1)) >= least:
            out.add(tuple(sorted((int(corner[h]), int(corner[h // 3 * 3 + (h + 1) % 3])))))
    return out


@pytest.mark.parametrize("mesh", [BOX, meshes.bumpy_sphere(2), meshes.saddle(5)])
def test_feature_edges_by_angle(mesh: Mesh) -> None:
    found = lsgp.feature_edges(surface(mesh), angle=0.2)
    assert found.dtype == np.int32
    assert list(map(tuple, found.tolist())) == sorted(bent_edges(mesh, 0.2))
    turned = mesh.triangles.copy()
    turned[::3] = turned[::3, ::-1]
    np.testing.assert_array_equal(lsgp.feature_edges(surface(mesh._replace(triangles=turned)), angle=0.2), found)


def test_feature_edges_that_are_marked_otherwise() -> None:
    mesh = meshes.saddle(5)
    twin = oracle.halfedges(mesh.triangles)[2]
    open_sides = np.flatnonzero(twin < 0)
    corner = mesh.triangles.ravel()
    border = {tuple(sorted((int(corner[h]), int(corner[h // 3 * 3 + (h + 1) % 3])))) for h in open_sides}
    seams = meshes.edges_of(mesh.triangles)[:4]
    seamed = surface(mesh, seams=seams)
    assert lsgp.feature_edges(seamed).shape == (0, 2)
    assert set(map(tuple, lsgp.feature_edges(seamed, borders=True).tolist())) == border
    both = border | {tuple(sorted(edge)) for edge in seams.tolist()}
    assert set(map(tuple, lsgp.feature_edges(seamed, borders=True, seams=True).tolist())) == both
    followed = surface(mesh, edges=seams)
    angles = lsgp.feature_edges(followed, angle=1e-9)
    assert set(map(tuple, angles.tolist())) <= {tuple(sorted(edge)) for edge in seams.tolist()}
