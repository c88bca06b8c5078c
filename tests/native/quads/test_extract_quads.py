# SPDX-License-Identifier: GPL-3.0-or-later
"""Quads traced from the grid of a layout: what they have to be, and which layouts are refused."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import lsgp
import meshes
import numpy as np
import pytest
from map_checks import codes, surface
from meshes import Mesh
from numpy.typing import NDArray
from quad_checks import distances, flat_torus, require_quads_of, sides
from shared_meshes import shared_mesh

BALL = meshes.bumpy_sphere(3)
SINGLE = 1e-5  # cells: what layouts of some dozen cells lose in single precision
PAIR = meshes.merge([meshes.cube(3), meshes.torus()])
SURFACES = {
    "cube": meshes.cube(4),
    "cube of twelve triangles": meshes.cube(1),
    "tetrahedron": meshes.tetrahedron(),
    "octahedron": meshes.octahedron(),
    "bumpy sphere": BALL,
    "flower": meshes.flower(3),
    "torus": meshes.torus(),
    "torus with cones": meshes.torus()._replace(cones=np.array([0, 5, 90, 95, 140], np.int32)),
    "double torus": meshes.double_torus(),
    "two parts": PAIR._replace(cones=meshes.cube(3).cones),
}


def lay_out(mesh: Mesh, tiles: float = 24, **seamless: object) -> lsgp.Result:
    """A seamless layout through the mesh's cones, or automatic ones where it has none and needs some."""
    whole, options = surface(mesh), lsgp.Options(seamless=lsgp.Seamless(tiles=tiles, **seamless))
    return lsgp.auto_unwrap(whole, mesh.cones, options=options)


@cache
def layout_of(name: str) -> lsgp.Result:
    return lay_out(SURFACES[name])


# --- what quads have to be ------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", SURFACES)
def test_quads_are_a_closed_manifold_on_the_surface_with_the_cones_as_irregular_vertices(name: str) -> None:
    mesh, layout = SURFACES[name], layout_of(name)
    found = lsgp.extract_quads(surface(mesh), layout.corner_uv)
    require_quads_of(mesh, layout.corner_uv, found)
    turns = np.round(layout.cone_angles / (np.pi / 2)).astype(int)
    irregular = dict(
        zip(found.surface_vertices[found.irregular].tolist(), found.valences[found.irregular], strict=True)
    )
    assert irregular == {c: t for c, t in zip(layout.cones.tolist(), turns.tolist(), strict=True) if t != 4}


@pytest.mark.parametrize("name", ["cube", "torus", "bumpy sphere"])
def test_positions_are_on_the_surface_by_all_its_triangles(name: str) -> None:
    mesh = SURFACES[name]
    found = lsgp.extract_quads(surface(mesh), layout_of(name).corner_uv)
    assert distances(mesh, found.positions[::3]).max() <= 1e-13


@pytest.mark.parametrize("k", [1, 2, 3, 4, 5, 8, 13])
@pytest.mark.parametrize("n", [1, 3, 4])
def test_a_cube_becomes_a_cube_of_squares(n: int, k: int) -> None:
    """Its vertices are all points of a grid on its faces, also where those are vertices and edges of the mesh."""
    mesh = meshes.cube(n)
    side = float(np.ptp(mesh.positions[:, 0]))
    upright = replace(surface(mesh), directions=(0.0, 0.0, 1.0))
    found = lsgp.remesh_to_quads(upright, mesh.cones, size=side / k).mesh
    assert len(found.quads) == 6 * k * k
    steps = (found.positions - mesh.positions.min(axis=0)) / (side / k)
    assert np.abs(steps - np.round(steps)).max() <= SINGLE
    assert len(np.unique(np.round(steps), axis=0)) == len(found.positions) == 6 * k * k + 2
    quality = lsgp.quad_quality(found.positions, found.quads)
    assert quality.worst_angle_error <= SINGLE and quality.longest_edge - quality.shortest_edge <= SINGLE


@pytest.mark.parametrize("cells", [(9, 5), (18, 10), (3, 3), (7, 13), (100, 4)])
def test_a_rectangle_becomes_its_unit_squares(cells: tuple[int, int]) -> None:
    """Also where the grid runs along the edges and through the vertices of the mesh."""
    mesh, uv = flat_torus(cells)
    found = lsgp.extract_quads(surface(mesh), uv)
    require_quads_of(mesh, uv, found)
    places = np.einsum("vc,vcx->vx", found.weights, uv[found.triangles])
    rounded = np.round(places).astype(int)
    np.testing.assert_allclose(places, rounded, rtol=0, atol=1e-6)
    ids = rounded % cells @ (1, cells[0])
    assert sorted(ids.tolist()) == list(range(cells[0] * cells[1]))
    squares = [
        [(x + dx) % cells[0] + cells[0] * ((y + dy) % cells[1]) for dx, dy in ((0, 0), (1, 0), (1, 1), (0, 1))]
        for x in range(cells[0])
        for y in range(cells[1])
    ]
    assert canonical(ids[found.quads]) == canonical(np.array(squares))


def canonical(quads: NDArray[np.integer]) -> list[list[int]]:
    """Each from its lowest vertex on, in order."""
    return sorted(np.roll(quad, -int(np.argmin(quad))).tolist() for quad in quads)


@pytest.mark.parametrize("seed", range(20))
def test_lines_of_the_grid_through_vertices_and_along_edges(seed: int) -> None:
    """Vertices on multiples of half a cell: every kind of touching, many times."""
    random = np.random.default_rng(seed)
    mesh, uv = flat_torus((36, 20))
    moves = random.integers(-1, 2, (len(mesh.positions), 2)) / 2
    uv = uv + moves[mesh.triangles]
    require_quads_of(mesh, uv, lsgp.extract_quads(surface(mesh), uv))


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("name", ["cube", "torus with cones", "bumpy sphere", "double torus"])
def test_quads_do_not_depend_on_where_a_layout_is_cut(name: str, seed: int) -> None:
    """Every triangle moved by itself, by a quarter turn and whole cells: the same grid on the surface."""
    mesh, uv = SURFACES[name], layout_of(name).corner_uv
    random = np.random.default_rng(seed)
    turns = np.array([1, 1j, -1, -1j])[random.integers(0, 4, len(uv))]
    moved = (uv @ (1, 1j)) * turns[:, None] + (random.integers(-1000, 1000, (len(uv), 2)) @ (1, 1j))[:, None]
    scattered = np.stack([moved.real, moved.imag], axis=2)
    one, other = (lsgp.extract_quads(surface(mesh), layout) for layout in (uv, scattered))
    require_quads_of(mesh, scattered, other)
    where = {tuple(np.round(position, 9)): i for i, position in enumerate(one.positions.tolist())}
    ids = np.array([where[tuple(np.round(position, 9))] for position in other.positions.tolist()])
    assert canonical(ids[other.quads]) == canonical(one.quads)


def test_cells_of_any_side_are_the_same_quads() -> None:
    mesh, layout = BALL, layout_of("bumpy sphere")
    fine = lay_out(mesh, cell=2.0**-4)
    expected = lsgp.extract_quads(surface(mesh), layout.corner_uv)
    assert lsgp.extract_quads(surface(mesh), fine.corner_uv, 2.0**-4) == expected
    assert lsgp.extract_quads(surface(mesh), layout.corner_uv / 3, 1 / 3).quads.tolist() == expected.quads.tolist()


@pytest.mark.parametrize("lattice", ["stripe", "translation"])
def test_layouts_of_fewer_turns_are_traced_as_well(lattice: str) -> None:
    mesh = meshes.torus()
    layout = lay_out(mesh, lattice=lattice)
    require_quads_of(mesh, layout.corner_uv, lsgp.extract_quads(surface(mesh), layout.corner_uv))


@pytest.mark.slow
@pytest.mark.parametrize(
    "name",
    [
        "cube-768",
        pytest.param("eight-genus2", marks=pytest.mark.many_solves),
        pytest.param("kitten-genus1", marks=pytest.mark.many_solves),
    ],
)
def test_quads_of_real_meshes(name: str) -> None:
    mesh = shared_mesh(name)
    remesh = lsgp.remesh_to_quads(surface(mesh), target=500)
    require_quads_of(mesh, remesh.layout.corner_uv, remesh.mesh)


def test_turned_triangles_come_out_turned_like_the_others() -> None:
    """A mesh whose triangles are turned at random has the quads of the majority's orientation."""
    mesh = meshes.with_flipped(BALL, range(0, 100, 7))
    layout = lay_out(mesh)
    found = lsgp.extract_quads(surface(mesh), layout.corner_uv)
    assert set(sides(found.quads).values()) == {1}
    center = found.positions[found.quads].mean(axis=1)
    ahead = found.positions[found.quads[:, 2]] - found.positions[found.quads[:, 0]]
    across = found.positions[found.quads[:, 3]] - found.positions[found.quads[:, 1]]
    assert ((np.cross(ahead, across) * center).sum(axis=1) > 0).mean() > 0.95


def test_seams_leave_no_trace() -> None:
    mesh = meshes.torus()
    options = lsgp.Options(seamless=lsgp.Seamless(coarse_grid="merge"))
    plain, seamed = (
        lsgp.remesh_to_quads(surface(mesh, seams=seams), target=150, options=options).mesh
        for seams in (None, mesh.triangles[::9, :2])
    )
    assert plain == seamed


@pytest.mark.parametrize("target", [100, 1000])
def test_the_number_of_quads_comes_near_the_target(target: int) -> None:
    found = lsgp.remesh_to_quads(surface(BALL), target=target)
    assert abs(len(found.mesh.quads) - target) <= 0.1 * target
    sides_of_triangles = np.diff(BALL.positions[BALL.triangles], axis=1)
    area = np.linalg.norm(np.cross(sides_of_triangles[:, 0], sides_of_triangles[:, 1]), axis=1).sum() / 2
    assert found.layout.seamless.tile_size == pytest.approx(np.sqrt(area / target), rel=0.1)


def test_placed_cones_of_a_quarter_turn_are_held_at_two() -> None:
    """On a spike cones for a seamless layout have 90 degrees, where no quads could meet."""
    ball = meshes.icosphere(3)
    spike = 1 + 2.5 * np.exp(4 * (ball.positions[:, 2:] - 1))
    mesh = ball._replace(positions=ball.positions * np.concatenate([np.ones((len(spike), 2)), spike], axis=1))
    placed = lsgp.place_cones(surface(mesh), lattice="square")
    narrow = placed.cones[placed.cone_angles < 2]
    assert len(narrow)
    remesh = lsgp.remesh_to_quads(surface(mesh), target=400)
    require_quads_of(mesh, remesh.layout.corner_uv, remesh.mesh)
    held = np.isin(remesh.mesh.surface_vertices, narrow)
    assert remesh.mesh.valences[held].tolist() == [2] * len(narrow)


@pytest.mark.parametrize(("around", "options"), [(8, lsgp.Options(seamless=lsgp.Seamless())), (12, None)])
def test_quads_too_large_for_a_mesh_are_made_smaller(around: int, options: lsgp.Options | None) -> None:
    """A tube of two quads around would have two edges between the same vertices. One of twelve sides has no creases."""
    mesh = meshes.torus(24, around, 3.0, 0.4)
    remesh = lsgp.remesh_to_quads(surface(mesh), size=1.2, options=options)
    assert codes(remesh.warnings) == ["GRID_REFINED"]
    assert remesh.layout.seamless.tile_size < 1.2
    require_quads_of(mesh, remesh.layout.corner_uv, remesh.mesh)


def test_the_same_bytes_every_time_and_for_any_number_of_threads() -> None:
    whole, seen = surface(meshes.bumpy_sphere(4)), []
    for threads in (1, 2, 2):
        options = lsgp.Options(seamless=lsgp.Seamless(), threads=threads)
        seen.append(lsgp.remesh_to_quads(whole, target=400, options=options).mesh)
    for found in seen[1:]:
        for name in ("positions", "quads", "valences", "triangles", "weights", "surface_vertices"):
            assert getattr(found, name).tobytes() == getattr(seen[0], name).tobytes()
