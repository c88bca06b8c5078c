# SPDX-License-Identifier: GPL-3.0-or-later
"""Hundreds of cones: what they cost is counted, and what they leave of the stretch falls with their number."""

from __future__ import annotations

from functools import cache
from itertools import pairwise

import lsgp
import meshes
import numpy as np
import oracle
import pytest
from map_checks import assert_curvature_adds_up, inner_vertices
from placement_checks import TURN, USUAL_REACH, curvature_of, imposed_scale, place, strength
from scipy.sparse.linalg import spsolve

MESH = meshes.bumpy_sphere(4)
COUNTS = (60, 61, 125, 250, 500, 1000)  # from 61 on in batches
every_count = pytest.mark.parametrize(
    "count", [pytest.param(count, marks=[pytest.mark.many_solves] if count > 61 else []) for count in COUNTS]
)


@cache
def placed(count: int) -> lsgp.Placement:
    return place(MESH, count=count)


@pytest.mark.slow
@every_count
def test_there_are_as_many_as_asked_for(count: int) -> None:
    cones = placed(count).cones
    assert len(cones) == len(set(cones.tolist())) == count
    assert np.isin(cones, inner_vertices(MESH)).all()
    assert_curvature_adds_up(MESH, cones, placed(count).cone_angles)


@every_count
def test_the_log_scale_is_that_of_the_angles(count: int) -> None:
    assert placed(count).log_scale == pytest.approx(imposed_scale(MESH, placed(count)), abs=1e-8)


@every_count
def test_curvatures_are_the_best_for_their_places(count: int) -> None:
    """The variance falls with no exchange of curvature between cones that are at no bound."""
    cones, share = placed(count).cones, oracle.vertex_shares(MESH.positions, MESH.triangles)
    matrix = oracle.cotan_laplacian(MESH.positions, MESH.triangles).tocsc()[1:, 1:]
    slope = np.append(0, spsolve(matrix, (share * placed(count).log_scale)[1:]))
    free = strength(MESH, placed(count)) < USUAL_REACH - 1e-6
    free &= curvature_of(placed(count)) < (1 - 0.35) * TURN - 1e-6
    assert free.sum() > count / 2
    assert np.ptp(slope[cones[free]]) <= 1e-6 * np.ptp(slope)


@pytest.mark.many_solves
def test_a_batch_is_about_as_good_as_one_by_one() -> None:
    excess = [placed(count).predicted_l2 - 1 for count in COUNTS]
    assert excess[1] <= 1.1 * excess[0]
    # Of cones spread evenly over a smooth surface, k leave a variance of the order of 1 / k^2.
    for before, after in pairwise(excess[1:]):
        assert after <= 0.5 * before, excess


@pytest.mark.many_solves
def test_back_substitutions_grow_with_the_cones() -> None:
    spent = np.array([placed(count).back_substitutions for count in COUNTS[1:]])
    a_cone = np.diff(spent) / np.diff(COUNTS[1:])
    # Two for its column, two a tenth for each round of exchanges, and those of some batches.
    assert (a_cone <= 3).all(), a_cone
    assert placed(1000).factorizations == 1
    assert placed(1000).back_substitutions <= 10 * place(MESH, count=25).back_substitutions


def test_curvatures_keep_their_bounds() -> None:
    assert strength(MESH, placed(250)).max() <= USUAL_REACH + 1e-9


def test_many_cones_that_are_there_already_stay() -> None:
    existing = placed(125).cones
    more = place(MESH, count=200, cones=existing)
    assert len(more.cones) == 200 and (more.cones[:125] == existing).all()
    alone = place(MESH, cones=existing)
    assert (alone.cones == existing).all()
    assert more.predicted_l2 < alone.predicted_l2


def test_images_in_a_mirror_plane_come_together() -> None:
    mesh = meshes.flower(4)
    both = place(mesh, count=150, symmetric=True)
    assert len(both.cones) <= 150
    assert both.predicted_l2 == pytest.approx(place(mesh, count=150).predicted_l2, abs=5e-3)


def test_no_more_than_there_is_room_for() -> None:
    mesh = meshes.bumpy_sphere(2)
    everywhere = place(mesh, count=10_000)
    assert len(everywhere.cones) == len(mesh.positions)
    assert everywhere.predicted_l2 < place(mesh, count=60).predicted_l2


def test_where_there_is_no_place_there_is_none() -> None:
    """A strip all of whose vertices are on its border."""
    assert len(place(meshes.grid(9, 1), count=100).cones) == 0


def test_the_same_ones_every_time() -> None:
    again = place(MESH, count=250)
    assert (again.cones == placed(250).cones).all()
    assert again.cone_angles.tobytes() == placed(250).cone_angles.tobytes()
