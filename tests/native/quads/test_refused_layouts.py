# SPDX-License-Identifier: GPL-3.0-or-later
"""Layouts and surfaces that no quads can be extracted from: refused as a whole, by code and elements."""

from __future__ import annotations

import re
from collections.abc import Callable

import lsgp
import meshes
import numpy as np
import pytest
from large_meshes import comb, of_polygons
from map_checks import surface
from numpy.typing import NDArray
from quad_checks import flat_torus, layout_area, require_quads_of

BALL = meshes.bumpy_sphere(3)
LAYOUT = lsgp.parameterize(surface(BALL), BALL.cones, options=lsgp.Options(seamless=lsgp.Seamless(tiles=24)))


def lay_out(mesh: meshes.Mesh, **seamless: object) -> lsgp.Result:
    options = lsgp.Options(seamless=lsgp.Seamless(tiles=24, **seamless))
    return lsgp.parameterize(surface(mesh), mesh.cones, options=options)


def flipped(uv: NDArray[np.float64]) -> NDArray[np.float64]:
    """One inner vertex moved far across its neighbors."""
    out = uv.copy()
    out[BALL.triangles == 100] += 5.3
    return out


def without_one(uv: NDArray[np.float64]) -> NDArray[np.float64]:
    out = uv.copy()
    out[17] = np.nan
    return out


BROKEN: dict[str, tuple[Callable[[NDArray[np.float64]], NDArray[np.float64]], str]] = {
    "scaled": (lambda uv: uv * 1.01, "INEXACT_SEAMS"),
    "one island moved off the grid": (lambda uv: uv + 0.25 * (np.arange(len(uv)) < 40)[:, None, None], "INEXACT_SEAMS"),
    "turned a little": (
        lambda uv: uv @ np.array([[np.cos(0.1), np.sin(0.1)], [-np.sin(0.1), np.cos(0.1)]]),
        "INEXACT_SEAMS",
    ),
    "moved by half a cell": (lambda uv: uv + 0.5, "INEXACT_SEAMS|CONES_NOT_SNAPPED"),
    "mirrored": (lambda uv: uv * [-1, 1], "FLIPPED_TRIANGLES"),
    "a vertex folded over": (flipped, "FLIPPED_TRIANGLES"),
    "collapsed": (np.zeros_like, "FLIPPED_TRIANGLES"),
    "without coordinates": (without_one, "WRONG_PARAMETER"),
    "too large": (lambda uv: uv * 2.0**24, "WRONG_PARAMETER"),
}


@pytest.mark.parametrize("kind", BROKEN)
def test_layouts_that_are_not_valid_are_refused_whole(kind: str) -> None:
    change, code = BROKEN[kind]
    with pytest.raises(lsgp.InputError) as caught:
        lsgp.extract_quads(surface(BALL), change(LAYOUT.corner_uv))
    assert caught.value.code in code.split("|")
    assert len(caught.value.elements.indices) or kind == "too large"


def test_cones_in_the_middle_of_cells_are_refused() -> None:
    layout = lay_out(BALL, parity=True)
    with pytest.raises(lsgp.InputError) as caught:
        lsgp.extract_quads(surface(BALL), layout.corner_uv)
    assert caught.value.code == "CONES_NOT_SNAPPED"
    assert sorted(caught.value.elements.indices.tolist()) == sorted(layout.cones.tolist())
    require_quads_of(BALL, layout.corner_uv, lsgp.extract_quads(surface(BALL), layout.corner_uv + 0.5))


def test_other_lattices_are_refused() -> None:
    layout = lay_out(BALL, lattice="hexagon")
    with pytest.raises(lsgp.InputError) as caught:
        lsgp.extract_quads(surface(BALL), layout.corner_uv)
    assert caught.value.code == "INEXACT_SEAMS"


def test_borders_are_refused_and_named() -> None:
    mesh = meshes.cylinder()
    layout = lay_out(mesh)
    sides_of_triangles = np.concatenate([mesh.triangles[:, [i, (i + 1) % 3]] for i in range(3)])
    edges, uses = np.unique(np.sort(sides_of_triangles, axis=1), axis=0, return_counts=True)
    for refused in (
        lambda: lsgp.extract_quads(surface(mesh), layout.corner_uv),
        lambda: lsgp.remesh_to_quads(surface(mesh), target=100),
    ):
        with pytest.raises(lsgp.TopologyError) as caught:
            refused()
        assert caught.value.code == "OPEN_SURFACE"
        named = {tuple(sorted(edge)) for edge in caught.value.elements.indices.tolist()}
        assert named == {tuple(edge) for edge in edges[uses == 1].tolist()}


def test_surfaces_of_one_side_are_refused() -> None:
    with pytest.raises(lsgp.TopologyError) as caught:
        lsgp.remesh_to_quads(surface(meshes.klein_bottle()), target=100)
    assert caught.value.code == "NOT_ORIENTABLE"


def test_cones_of_a_quarter_turn_are_refused() -> None:
    """Two of 90 and one of 180 degrees on a sphere."""
    mesh = meshes.icosphere(2)
    angles = [np.pi / 2, np.pi / 2, np.pi]
    layout = lsgp.parameterize(surface(mesh), [0, 3, 7], angles, lsgp.Options(seamless=lsgp.Seamless(tiles=16)))
    with pytest.raises(lsgp.CurvatureError) as caught:
        lsgp.extract_quads(surface(mesh), layout.corner_uv)
    assert caught.value.code == "CONE_ANGLE_RANGE"
    assert caught.value.elements.indices.tolist() == [0, 3]


@pytest.mark.parametrize("cells", [(1, 3), (2, 3), (5, 2), (1, 1)])
def test_cells_too_large_for_a_mesh_are_refused(cells: tuple[int, int]) -> None:
    """Around a tube of two cells, two edges join the same vertices."""
    mesh, uv = flat_torus(cells)
    assert round(layout_area(uv)) == cells[0] * cells[1]
    with pytest.raises(lsgp.SolverError) as caught:
        lsgp.extract_quads(surface(mesh), uv)
    assert caught.value.code == "GRID_TOO_COARSE"
    assert len(caught.value.elements.indices)


def with_close_cones(distance: float) -> tuple[lsgp.Surface, NDArray[np.int32], NDArray[np.float64]]:
    """Cones of opposite curvature, of whose distance even the coarsest grid makes a cell."""
    mesh = meshes.with_close_cones(distance)
    return surface(mesh), mesh.cones, meshes.CLOSE_CONE_ANGLES


def test_millions_of_quads_that_nobody_asked_for_are_refused() -> None:
    with pytest.raises(lsgp.SolverError) as caught:
        lsgp.remesh_to_quads(*with_close_cones(1e-6))
    assert caught.value.code == "TOO_MANY_QUADS"


def test_as_many_quads_as_the_refusal_names_are_made_on_request(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("lsgp.quads.remeshing._MANY_QUADS", 500)
    with pytest.raises(lsgp.SolverError) as caught:
        lsgp.remesh_to_quads(*with_close_cones(1e-3))
    named = int(re.search(r"has (\d+) quads", caught.value.message)[1])
    made = lsgp.remesh_to_quads(*with_close_cones(1e-3), target=named).mesh
    assert len(made.quads) == pytest.approx(named, rel=0.1)


@pytest.mark.parametrize("asked", [{}, {"target": 2000}, {"size": 0.05}])
@pytest.mark.parametrize("ratio", [0.1, 1e-3, 1e-6])
def test_a_small_part_has_smaller_quads_than_others(ratio: float, asked: dict) -> None:
    small = BALL._replace(positions=BALL.positions * ratio)
    alone = lsgp.remesh_to_quads(surface(BALL), BALL.cones, **asked)
    both = meshes.merge([BALL, small])
    found = lsgp.remesh_to_quads(surface(both), both.cones, **asked)
    require_quads_of(both, found.layout.corner_uv, found.mesh)
    assert len(found.mesh.quads) < 2 * len(alone.mesh.quads) + 600


def test_it_can_be_cancelled() -> None:
    with pytest.raises(lsgp.Cancelled):
        lsgp.extract_quads(surface(BALL), LAYOUT.corner_uv, progress=lambda done: False)


def test_a_fine_grid_can_be_cancelled_all_the_time() -> None:
    """Every step over a cell is counted as work of hundreds of multiplications at least."""
    mesh, uv = flat_torus((600, 600))
    asked = []
    lsgp.extract_quads(surface(mesh), uv, progress=lambda done: not asked.append(done))
    assert len(asked) > 600 * 600 * 700 / 5e7


@pytest.mark.parametrize("teeth", [125, 188])
def test_a_comb_is_refused_with_the_number_of_its_corners(teeth: int) -> None:
    """Each of its vertices is a corner of a quarter turn or more, by the angles of the triangles there."""
    mesh = of_polygons(comb(teeth))
    points = mesh.positions[mesh.triangles]
    to_next, to_last = np.roll(points, -1, axis=1) - points, np.roll(points, 1, axis=1) - points
    cosine = (to_next * to_last).sum(axis=2) / np.linalg.norm(to_next, axis=2) / np.linalg.norm(to_last, axis=2)
    angles = np.arccos(np.clip(cosine, -1, 1))
    defect = 2 * np.pi - np.bincount(mesh.triangles.ravel(), angles.ravel(), len(mesh.positions))
    with pytest.raises(lsgp.SolverError) as caught:
        lsgp.remesh_to_quads(mesh)
    assert "No cones were found" in str(caught.value)
    assert f"more than 45 degrees at {(abs(defect) > np.pi / 4).sum()} vertices" in str(caught.value)
