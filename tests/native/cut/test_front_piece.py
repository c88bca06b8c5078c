# SPDX-License-Identifier: GPL-3.0-or-later
"""The front as one piece: components end at the outline of what it sees, where cuts into it would cost more."""

from __future__ import annotations

from dataclasses import replace

import lsgp
import meshes
import numpy as np
import pytest
from lsgp.run.report import choice_lines
from map_checks import pairs, surface
from meshes import Mesh

FRONT = (0, 0, 1)
UNSEEN, IN_FULL_SIGHT = 0.1, 30.1  # the costs of an edge that no view sees, and of one that all do


def head(width: float = 1.0, height: float = 1.3, depth: float = 0.5) -> Mesh:
    """A flat ball with a nose in front."""
    ball = meshes.icosphere(4)
    p = ball.positions
    return meshes.make(p * (1 + np.exp(60 * (p[:, 2:] - 1))) * [width, height, depth], ball.triangles)


def facing(mesh: Mesh, front: tuple[float, float, float] = FRONT) -> lsgp.Surface:
    given = surface(mesh, edges=meshes.edges_of(mesh.triangles))
    return replace(given, cut_costs=lsgp.cut_costs(given, front))


def seen_of_ends(given: lsgp.Surface, result: lsgp.Result) -> float:
    """The largest share of the views around the front that see a cut or a border."""
    bare = replace(given, cut_costs=None)
    views = np.cbrt((lsgp.cut_costs(bare, FRONT, creases=False) - UNSEEN) / (IN_FULL_SIGHT - UNSEEN))
    ends = pairs(result.cut_edges) | pairs(result.borders)
    assert given.edges is not None
    return float(max(v for v, (a, b) in zip(views, given.edges.tolist(), strict=True) if (a, b) in ends))


@pytest.mark.parametrize(("width", "height", "depth"), [(1, 1.3, 0.5), (0.8, 1.2, 0.6)])
def test_no_cut_leads_to_a_nose(width: float, height: float, depth: float) -> None:
    given = facing(head(width, height, depth))
    result = lsgp.auto_unwrap(given)
    usual = lsgp.auto_unwrap(given, creases=False)
    assert len(result.borders) and not len(result.cones) and len(usual.cones)
    assert seen_of_ends(given, result) < 0.75 <= seen_of_ends(given, usual)
    assert result.distortion.l2_stretch <= 1.05
    assert len(np.unique(result.island)) == 2
    assert not len(result.flipped) and not len(result.overlapping)


def test_the_outline_encloses_the_front() -> None:
    given = facing(head())
    result = lsgp.auto_unwrap(given)
    tip, nape = given.positions[:, 2].argmax(), given.positions[:, 2].argmin()
    at = [np.unique(result.island[(given.triangles == v).any(axis=1)]) for v in (tip, nape)]
    assert len(at[0]) == len(at[1]) == 1 and at[0] != at[1]
    # A closed line: as many edges as vertices, each at two of them.
    _, count = np.unique(result.borders, return_counts=True)
    assert (count == 2).all()


def test_only_cuts_in_sight_are_a_reason() -> None:
    nosed = head()
    assert not len(lsgp.auto_unwrap(replace(facing(nosed), cut_costs=None)).borders)
    assert not len(lsgp.auto_unwrap(facing(nosed, (0, 0, -1))).borders)
    assert not len(lsgp.auto_unwrap(facing(nosed), weights=replace(lsgp.Weights(), cuts=0.0)).borders)
    names = [choice.name for choice in lsgp.auto_unwrap(facing(nosed)).choices]
    assert "the front in one piece" in names


def test_a_front_that_is_stretched_too_much_is_told() -> None:
    given = facing(head())
    result = lsgp.auto_unwrap(given, target=1.015)
    (refused,) = [choice for choice in result.choices if choice.name == "the front in one piece"]
    assert not len(result.borders) and refused.cost is None and not refused.is_best
    assert refused.reason.startswith("is stretched by ")
    (line,) = [line for line in choice_lines(result.choices) if refused.name in line]
    assert line.split(refused.name)[1].split() == refused.reason.split()


def test_what_is_given_has_precedence() -> None:
    given = facing(head())
    seams = given.triangles[:1, :2]
    placed = lsgp.place_cones(given)
    assert not len(lsgp.auto_unwrap(given, placed.cones).borders)
    assert not len(lsgp.auto_unwrap(given, count=6).borders)
    assert not len(lsgp.auto_unwrap(replace(given, seams=seams)).borders)
    assert not len(lsgp.auto_unwrap(given, preset="tile").borders)


@pytest.mark.parametrize("seed", range(3))
def test_the_order_of_vertices_and_triangles_changes_no_outline(seed: int) -> None:
    mesh = head()
    rng = np.random.default_rng(seed)
    vertex, triangle = rng.permutation(len(mesh.positions)), rng.permutation(len(mesh.triangles))
    other = meshes.make(mesh.positions[np.argsort(vertex)], vertex[mesh.triangles[triangle]])
    here, there = (lsgp.auto_unwrap(facing(one)) for one in (mesh, other))
    assert {tuple(sorted(pair)) for pair in vertex[here.borders].tolist()} == pairs(there.borders)


def test_of_two_heads_the_one_that_faces_the_front_ends_at_its_outline() -> None:
    nosed = head()
    averted = meshes.make(nosed.positions * [1, 1, -1], nosed.triangles[:, ::-1])
    given = facing(meshes.merge([nosed, averted]))
    result = lsgp.auto_unwrap(given)
    assert len(result.borders) and result.borders.max() < len(nosed.positions)
