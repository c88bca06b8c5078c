# SPDX-License-Identifier: GPL-3.0-or-later
"""Marked edges become straight lines along u or v of maps of low stretch, inside islands and at their borders."""

from __future__ import annotations

from dataclasses import replace

import lsgp
import meshes
import numpy as np
import pytest
from map_checks import assert_angles_met, assert_exact_transitions, codes, surface
from meshes import Mesh
from numpy.typing import NDArray
from result_check import undeclared_faults
from shared_meshes import shared_mesh
from zoo import closed

PAINT = lsgp.preset_options("paint")
LOW_STRETCH = lsgp.Options(mode="low-stretch")
MOST_L2 = 1.1  # of the stretch without


def edges_at(mesh: Mesh, is_on: NDArray[np.bool_]) -> NDArray[np.int64]:
    """Edges both of whose ends are among these vertices."""
    edges = meshes.edges_of(mesh.triangles)
    return edges[is_on[edges].all(axis=1)]


def distance_off_axes(mesh: Mesh, result: lsgp.Result, edges: NDArray[np.integer]) -> NDArray[np.float64]:
    """(e,) the most that a side of each edge is off u and v, as stored in float32.

    edges: the lower vertex first, sorted.
    """
    uv = result.corner_uv.astype(np.float32).astype(float)
    sides = np.stack([mesh.triangles, np.roll(mesh.triangles, -1, axis=1)], axis=-1).reshape(-1, 2)
    both = np.stack([uv, np.roll(uv, -1, axis=1)], axis=-2).reshape(-1, 2, 2)
    keys, wanted = (np.sort(pairs, axis=1).astype(int) @ [len(mesh.positions), 1] for pairs in (sides, edges))
    is_side = np.isin(keys, wanted)
    out = np.zeros(len(edges))
    np.maximum.at(
        out, np.searchsorted(wanted, keys[is_side]), np.abs(np.diff(both[is_side], axis=1)).min(axis=-1)[:, 0]
    )
    return out


def off_axis(mesh: Mesh, result: lsgp.Result, edges: NDArray[np.integer]) -> float:
    """The most of all edges."""
    return float(distance_off_axes(mesh, result, edges).max())


def dome(cells: int = 10) -> Mesh:
    return meshes.grid(cells, cells, lambda x, y: np.sin(np.pi * x / cells) * np.sin(np.pi * y / cells))


def test_a_path_across_a_dome_is_straight() -> None:
    mesh = dome()
    path = edges_at(mesh, np.isclose(mesh.positions[:, 0], 3))
    marked = replace(surface(mesh), features=path)
    plain, along = (lsgp.parameterize(each, (), options=LOW_STRETCH) for each in (surface(mesh), marked))
    assert off_axis(mesh, plain, path) > 1e-3
    assert off_axis(mesh, along, path) == 0
    assert along.features == lsgp.FeatureReport(1.0, [])
    assert along.distortion.l2_stretch <= MOST_L2 * plain.distortion.l2_stretch
    assert_angles_met(mesh, along)


def test_marked_borders_are_straight() -> None:
    mesh = dome()
    edges = lsgp.feature_edges(surface(mesh), borders=True)
    marked = replace(surface(mesh), features=edges)
    result = lsgp.parameterize(marked, (), options=LOW_STRETCH)
    assert off_axis(mesh, result, edges) == 0 and result.features.share == 1


def test_a_loop_around_a_closed_surface_with_cones_is_straight() -> None:
    """In parts, one on each side of every cut that turns the texture."""
    mesh = closed.box(5, (1, 1.37, 2.11))
    loop = edges_at(mesh, np.isclose(mesh.positions[:, 2], np.unique(mesh.positions[:, 2])[2]))
    marked = replace(surface(mesh), features=loop)
    plain, along = (
        lsgp.auto_unwrap(each, preset="paint", options=PAINT, creases=False) for each in (surface(mesh), marked)
    )
    assert along.features.share > 0.9
    assert along.distortion.l2_stretch <= MOST_L2 * plain.distortion.l2_stretch
    assert_exact_transitions(mesh, along)
    assert_angles_met(mesh, along)


SWAYED = pytest.mark.parametrize("size, sway", [((1, 1, 1), 0.4), ((0.8, 1.5, 1.2), 0.3), ((1, 1, 1.5), 0.3)])


def swayed(size: tuple[float, float, float], sway: float) -> tuple[Mesh, NDArray[np.integer], NDArray[np.bool_]]:
    """A bent box with bevels, the creases at these, and which of them ran along the box; the others are diagonals."""
    box = closed.beveled_box(4, 0.15, size)
    bent = box.positions.copy()
    bent[:, 0] += sway * np.sin(1.5 * bent[:, 2])
    mesh = box._replace(positions=bent)
    creases = lsgp.feature_edges(surface(mesh), angle=0.6)
    edges = np.diff(box.positions[creases], axis=1)[:, 0]
    return mesh, creases, np.abs(edges).max(axis=1) > (1 - 1e-9) * np.linalg.norm(edges, axis=1)


def assert_whole_quarters(result: lsgp.Result) -> None:
    quarters = result.cone_angles / (np.pi / 2)
    np.testing.assert_allclose(quarters, np.round(quarters), atol=1e-9)


@SWAYED
def test_cones_are_such_that_marked_edges_can_be_straight(size: tuple[float, float, float], sway: float) -> None:
    """Around cones of other angles than whole quarter turns, creases cannot all run along u and v."""
    mesh, creases, is_side = swayed(size, sway)
    marked = replace(surface(mesh), features=creases[is_side])
    plain, along = (lsgp.auto_unwrap(each, preset="paint", creases=False) for each in (surface(mesh), marked))
    quarters = plain.cone_angles / (np.pi / 2)
    assert (np.abs(quarters - np.round(quarters)) > 1e-3).any()
    assert_whole_quarters(along)
    assert off_axis(mesh, along, creases[is_side]) == 0 and along.features == lsgp.FeatureReport(1.0, [])
    assert along.distortion.l2_stretch <= MOST_L2 * plain.distortion.l2_stretch
    assert undeclared_faults(marked, along, PAINT) == []


@SWAYED
def test_through_such_cones_more_is_straight_than_through_the_usual_ones(
    size: tuple[float, float, float], sway: float
) -> None:
    """By a twentieth of the length at least, or they would not replace these. Which diagonals contradict others hangs
    on rounding."""
    mesh, creases, _ = swayed(size, sway)
    usual = lsgp.auto_unwrap(surface(mesh), preset="paint", creases=False)
    marked = replace(surface(mesh), features=creases)
    chosen = lsgp.auto_unwrap(marked, preset="paint", creases=False)
    given = lsgp.auto_unwrap(marked, usual.cones, usual.cone_angles, preset="paint", creases=False)
    assert_whole_quarters(chosen)
    assert chosen.features.share > given.features.share + 0.05
    assert {feature.reason for feature in chosen.features.released} <= {"contradiction"}
    assert chosen.distortion.l2_stretch <= MOST_L2 * usual.distortion.l2_stretch
    assert undeclared_faults(marked, chosen, PAINT) == []


@pytest.mark.slow
@pytest.mark.parametrize("preset", ["paint", "bake"])
def test_features_stay_straight_when_islands_are_split(preset: lsgp.Preset) -> None:
    """The creases of the fandisk are straight in a map that overlaps, and in its islands as well."""
    mesh = shared_mesh("fandisk")
    marked = replace(surface(mesh), features=lsgp.feature_edges(surface(mesh), angle=np.radians(40)))
    result = lsgp.auto_unwrap(marked, preset=preset)
    assert not len(result.overlapping) and not len(result.flipped)
    assert result.features.share > 0.95
    assert undeclared_faults(replace(marked, borders=result.borders), result, lsgp.preset_options(preset)) == []
    assert result.distortion.l2_stretch < MOST_L2


def test_what_the_other_options_do_with_marked_edges() -> None:
    mesh = dome(6)
    path = edges_at(mesh, np.isclose(mesh.positions[:, 0], 3))
    marked = replace(surface(mesh), features=path)
    conformal = lsgp.parameterize(marked, ())
    assert [feature.reason for feature in conformal.features.released] == ["unsupported"]
    assert conformal.features.share == pytest.approx(0, abs=1e-12) and "FEATURES_RELEASED" in codes(conformal.warnings)
    np.testing.assert_array_equal(conformal.corner_uv, lsgp.parameterize(surface(mesh), ()).corner_uv)
    for options in (replace(LOW_STRETCH, straighten=True), replace(PAINT, compact="full")):
        result = lsgp.parameterize(marked, (), options=options)
        assert off_axis(mesh, result, path) == 0 and result.features.share == 1


@pytest.mark.slow
@pytest.mark.parametrize(
    "transform, least",
    [([[1, 0, 1.5], [0, 1, 0.5], [0, 0, 1]], 0.8), pytest.param("taper", 0.93, marks=pytest.mark.many_solves)],
    ids=["oblique", "tapered"],
)
def test_edges_at_small_angles_get_different_axes(transform: list[list[float]] | str, least: float) -> None:
    """Both are nearest to the same axis, along which the face between them would have no area."""
    wheel = closed.toothed_wheel(8, 0.25)
    x, y, z = wheel.positions.T
    narrow = 1 - 0.6 * z
    moved = (
        np.stack([x * narrow, y * narrow, z], axis=1)
        if transform == "taper"
        else wheel.positions @ np.array(transform).T
    )
    mesh = wheel._replace(positions=moved)
    edges = lsgp.feature_edges(surface(mesh), angle=np.radians(40))
    marked = replace(surface(mesh), features=edges)
    result = lsgp.auto_unwrap(marked, preset="paint", options=PAINT)
    free = lsgp.auto_unwrap(surface(mesh), preset="paint", options=PAINT)
    length = np.linalg.norm(np.diff(mesh.positions[edges], axis=1)[:, 0], axis=1)
    is_straight = distance_off_axes(mesh, result, edges) == 0
    assert result.features.share == pytest.approx(length[is_straight].sum() / length.sum(), abs=1e-9)
    assert result.features.share > least
    assert result.distortion.l2_stretch < MOST_L2 * free.distortion.l2_stretch
    assert undeclared_faults(replace(marked, borders=result.borders), result, PAINT) == []


@pytest.mark.slow
@pytest.mark.parametrize(
    "mesh", [closed.gear(6, 0.3, 2), pytest.param(closed.gear(12, 0.3, 2), marks=pytest.mark.many_solves)]
)
def test_the_share_counts_edges_between_islands_once(mesh: Mesh) -> None:
    """The preset cuts these parts at creases, which are then boundaries of two components."""
    edges = lsgp.feature_edges(surface(mesh), angle=np.radians(40))
    result = lsgp.auto_unwrap(replace(surface(mesh), features=edges), preset="paint", options=PAINT)
    length = np.linalg.norm(np.diff(mesh.positions[edges], axis=1)[:, 0], axis=1)
    is_straight = distance_off_axes(mesh, result, edges) == 0
    share = length[is_straight].sum() / length.sum()
    assert 0.5 < share < 1
    assert result.features.share == pytest.approx(share, abs=1e-9)
    released = sum(feature.share for feature in result.features.released)
    assert released == pytest.approx(1 - share, abs=1e-9)
