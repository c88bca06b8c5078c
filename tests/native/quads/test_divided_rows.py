# SPDX-License-Identifier: GPL-3.0-or-later
"""Quads too large for a mesh: only rows through narrow places are divided, and the warning says where and why."""

from __future__ import annotations

import lsgp
import meshes
import numpy as np
import pytest
from lsgp.quads.quad_rows import QuadLines
from map_checks import surface
from meshes import Mesh
from quad_checks import fans, flat_torus, layout_area, require_closed_quads, require_cones, sides
from zoo import tunnels

RING = meshes.torus(16, 8, 1.0, 0.4)


def beside(ball: Mesh, ratio: float) -> Mesh:
    return meshes.merge([ball, RING._replace(positions=ratio * RING.positions + 5)])


# By name: a mesh, a number of quads that it has no mesh of, and the most that are made instead.
NARROW = {
    "ball with a thin handle": (tunnels.ball_with_handles(4, 1, 0), 200, 2),
    "ball with three": (tunnels.ball_with_handles(4, 3, 1), 200, 9),
    "ball with two": (tunnels.ball_with_handles(4, 2, 5), 300, 9),
    "ball and a small ring": (beside(meshes.bumpy_sphere(3), 0.1), 200, 1.1),
}
LONG = ("ball with two", "ball with three")


@pytest.mark.slow
@pytest.mark.parametrize(
    "name", [name if name not in LONG else pytest.param(name, marks=pytest.mark.many_solves) for name in NARROW]
)
def test_rows_are_divided_where_quads_are_too_large(name: str) -> None:
    mesh, target, most = NARROW[name]
    remesh = lsgp.remesh_to_quads(surface(mesh), target=target)
    require_closed_quads(mesh, remesh.mesh)
    require_cones(mesh, remesh.layout.corner_uv, remesh.mesh)
    cells = layout_area(remesh.layout.corner_uv) / remesh.layout.seamless.cell**2
    assert round(cells) < len(remesh.mesh.quads) <= most * target
    refined = [finding for finding in remesh.warnings if finding.code == "GRID_REFINED"]
    assert len(refined) == 1
    assert refined[0].message.startswith(f"There are {len(remesh.mesh.quads)} quads instead of {target}: ")
    assert refined[0].elements.kind == "triangles"
    assert 0 < len(refined[0].elements.indices) < len(mesh.triangles)


def test_a_small_part_does_not_refine_the_others() -> None:
    ball = meshes.bumpy_sphere(3)
    remesh = lsgp.remesh_to_quads(surface(beside(ball, 0.1)), target=200).mesh
    on_ball = int((remesh.triangles[remesh.quads[:, 0]] < len(ball.triangles)).sum())
    assert on_ball <= 220


def lines_of(cells: tuple[int, int], stays: bool = False) -> QuadLines:
    mesh, uv = flat_torus(cells)
    quads = lsgp.extract_quads(surface(mesh), uv).quads
    return QuadLines(quads, np.full(quads.max() + 1, stays))


@pytest.mark.parametrize("cells", [(3, 3), (5, 3), (8, 9), (4, 20)])
def test_a_torus_keeps_three_rows_each_way(cells: tuple[int, int]) -> None:
    lines = lines_of(cells)
    lines.leave_out(0)
    quads, kept = lines.mesh()
    assert len(quads) == len(kept) == fans(quads) == 9
    assert set(sides(quads).values()) == {1}


@pytest.mark.parametrize("most", [63, 60, 40, 20, 12])
def test_no_more_lines_are_left_out_than_are_asked_for(most: int) -> None:
    lines = lines_of((7, 9))
    lines.leave_out(most)
    quads, _ = lines.mesh()
    assert most - 9 < len(quads) <= most


def test_lines_through_vertices_that_stay_are_kept() -> None:
    lines = lines_of((7, 9), stays=True)
    lines.leave_out(0)
    quads, kept = lines.mesh()
    assert len(quads) == 63 and kept.tolist() == list(range(63))
