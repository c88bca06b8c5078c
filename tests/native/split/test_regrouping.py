# SPDX-License-Identifier: GPL-3.0-or-later
"""Pieces that move between islands after overlaps are split: fewer islands for the same map."""

from __future__ import annotations

from functools import cache

import lsgp
import meshes
import numpy as np
import oracle
import pytest
from map_checks import pairs
from meshes import Mesh
from test_overlaps import faults

SPLIT = lsgp.Options(overlaps="split")


@cache
def with_limbs(seed: int) -> Mesh:
    """A ball with six to eight thin limbs in random directions, and its automatic cones."""
    random = np.random.RandomState(seed)
    ball = meshes.icosphere(3)
    radius = np.ones(len(ball.positions))
    tips: list[np.ndarray] = []
    while len(tips) < 6 + seed % 3:
        tip = random.standard_normal(3)
        tip /= np.linalg.norm(tip)
        if all(tip @ other < 0.6 for other in tips):
            tips.append(tip)
            radius += random.uniform(1.5, 2.5) * np.exp(random.uniform(15, 30) * (ball.positions @ tip - 1))
    mesh = ball._replace(positions=ball.positions * radius[:, None])
    placed = lsgp.place_cones(lsgp.Surface(mesh.positions, mesh.triangles))
    return mesh._replace(cones=np.array(placed.cones, np.int32))


def split(mesh: Mesh, **surface: object) -> lsgp.Result:
    return lsgp.parameterize(lsgp.Surface(mesh.positions, mesh.triangles, **surface), mesh.cones, options=SPLIT)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(3))
def test_regrouped_pieces_are_the_same_map(seed: int) -> None:
    mesh = with_limbs(seed)
    kept = lsgp.parameterize(lsgp.Surface(mesh.positions, mesh.triangles), mesh.cones)
    result = split(mesh)
    assert len(kept.overlapping) > 0 and len(result.overlapping) == 0
    assert faults(mesh, result, SPLIT) == []
    assert oracle.metric_gap(kept.corner_uv, result.corner_uv) <= 1e-9
    assert np.array_equal(result.cones, kept.cones) and np.array_equal(result.cone_angles, kept.cone_angles)
    assert pairs(result.required_cuts) <= pairs(result.cut_edges)


@pytest.mark.nightly
@pytest.mark.many_solves
def test_bodies_with_limbs_come_apart_in_few_islands() -> None:
    """By splitting and merging whole islands alone they have 43."""
    islands = [int(split(with_limbs(seed)).island.max()) + 1 for seed in range(12)]
    assert sum(islands) <= 20


def test_islands_whose_cuts_are_marked_are_not_regrouped() -> None:
    mesh = with_limbs(0)
    seams = split(mesh).cut_edges
    again = split(mesh, seams=seams)
    assert pairs(seams) <= pairs(again.cut_edges)
