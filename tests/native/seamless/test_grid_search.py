# SPDX-License-Identifier: GPL-3.0-or-later
"""Rounding to a lattice ends, can be stopped, and keeps its bound on distortion or says that it does not."""

from __future__ import annotations

import re

import lsgp
import meshes
import numpy as np
import pytest
from map_checks import codes, only, surface
from meshes import Mesh
from opened_surface import named_by
from result_check import undeclared_faults
from shared_meshes import hard_mesh

ACCEPTABLE = 1.1  # of the energy
SQUARE = lsgp.Options(seamless=lsgp.Seamless())


def box(length: float) -> Mesh:
    return meshes.cube(1, (1, length, 1))


def rough(mesh: Mesh, seed: int, cones: int) -> Mesh:
    """So coarse and uneven that its map is far from conformal."""
    rng = np.random.default_rng(seed)
    noise = rng.normal(size=mesh.positions.shape) * 0.03 * np.ptp(mesh.positions)
    return mesh._replace(
        positions=mesh.positions + noise, cones=rng.choice(len(mesh.positions), cones, replace=False).astype(np.int32)
    )


@pytest.mark.parametrize("length", [1e2, 1e3, 1e5])
def test_rounding_angles_on_long_boxes_ends(length: float) -> None:
    """Their log scale has so large a variance that rounding of it looks like a gain."""
    mesh = box(length)
    try:
        result = lsgp.parameterize(surface(mesh), np.arange(8), None, lsgp.Options(seamless=lsgp.Seamless(tiles=8000)))
    except lsgp.SolverError as refused:  # the sides are thinner than any cell: it hangs on rounding whether they fit
        assert length > 1e4 and refused.code == "GRID_TOO_COARSE"
        return
    assert result.cone_angles == pytest.approx(np.full(8, 1.5 * np.pi), abs=1e-12)
    assert undeclared_faults(surface(mesh), result, SQUARE) == []


@pytest.mark.parametrize("lengths", [(1, 1e3, 1), (1, 1e6, 1e-6)])
def test_placing_cones_for_a_lattice_on_long_boxes_ends(lengths: tuple[float, float, float]) -> None:
    mesh = meshes.cube(2, lengths)
    placed = lsgp.place_cones(surface(mesh), lattice="square")
    turns = placed.cone_angles / (np.pi / 2)
    assert turns == pytest.approx(np.round(turns), abs=1e-9)
    assert (4 - turns).sum() == pytest.approx(8)


def test_rounding_many_angles_can_be_stopped() -> None:
    """With so many cones their rounding takes longest by far: it has to be there that progress is told."""
    mesh = meshes.icosphere(4)
    cones = np.arange(0, len(mesh.positions), 2)
    told: list[float] = []

    def stop_late(done: float) -> bool:
        told.append(done)
        return len(told) < 12

    with pytest.raises(lsgp.Cancelled):
        lsgp.parameterize(surface(mesh), cones, None, SQUARE, progress=stop_late)
    assert told[-1] < 0.5, "in the first half, before the layout is rounded"


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("shape", ["double torus", "torus", "cube"])
def test_automatic_grids_keep_their_bound_where_maps_are_strained(shape: str, seed: int) -> None:
    base = {"double torus": meshes.double_torus(), "torus": meshes.torus(12, 5, 2, 1.2), "cube": meshes.cube(2)}[shape]
    mesh = rough(base, seed, 6)
    result = lsgp.parameterize(surface(mesh), mesh.cones, None, SQUARE)
    assert undeclared_faults(surface(mesh), result, SQUARE) == []
    assert result.seamless.energy_after <= ACCEPTABLE * result.seamless.energy_before
    assert "GRID_DISTORTS" not in codes(result.warnings)


@pytest.mark.parametrize("name", ["pipe", "joint", pytest.param("pinion", marks=pytest.mark.many_solves)])
def test_automatic_grids_keep_their_bound_on_hard_meshes(name: str) -> None:
    mesh = hard_mesh(name)
    placed = lsgp.place_cones(surface(mesh), lattice="square")
    result = lsgp.parameterize(surface(mesh), placed.cones, None, SQUARE)
    assert result.seamless.energy_after <= ACCEPTABLE * result.seamless.energy_before
    assert "GRID_DISTORTS" not in codes(result.warnings)


def energy(mesh: Mesh, uv: np.ndarray, faces: np.ndarray) -> float:
    """Symmetric Dirichlet energy of a map, area-weighted, at its best scale; 1 is isometric."""
    corners = mesh.positions[mesh.triangles[faces]]
    x, rest = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    length = np.linalg.norm(x, axis=1)
    along = np.einsum("fi,fi->f", x, rest) / length
    across = np.linalg.norm(rest - along[:, None] * x / length[:, None], axis=1)
    z = uv[faces, :, 0] + 1j * uv[faces, :, 1]
    u = (z[:, 1] - z[:, 0]) / length
    v = (z[:, 2] - z[:, 0] - along * u) / across
    grown = np.abs(u) ** 2 + np.abs(v) ** 2
    determinant = np.imag(u.conj() * v)
    area = length * across / 2
    return float(np.sqrt((area * grown).sum() * (area * grown / determinant**2).sum()) / (2 * area.sum()))


@pytest.mark.parametrize("mode", ["conformal", "low-stretch"])
@pytest.mark.parametrize("tiles", [None, 12])
def test_the_energy_is_that_of_the_layout_that_is_returned(tiles: float | None, mode: str) -> None:
    mesh = meshes.flower(2)
    options = lsgp.Options(seamless=lsgp.Seamless(tiles=tiles), mode=mode)
    result = lsgp.parameterize(surface(mesh), mesh.cones, None, options)
    found = energy(mesh, result.corner_uv, np.arange(len(mesh.triangles)))
    assert result.seamless.energy_after == pytest.approx(found, rel=1e-9)


@pytest.mark.parametrize("scale", [1e-2, 1e-3, 1e-4])
def test_small_parts_have_grids_of_their_own(scale: float) -> None:
    """Which keep the bound, while the others have tiles of an ordinary size."""
    ball = meshes.bumpy_sphere(2)
    small = meshes.transform(meshes.bumpy_sphere(1), 1, scale)
    mesh = meshes.merge([ball, small])
    result = lsgp.parameterize(surface(mesh), mesh.cones, None, SQUARE)
    assert undeclared_faults(surface(mesh), result, SQUARE) == []
    part = np.arange(len(ball.triangles), len(mesh.triangles))
    fine = lsgp.parameterize(
        surface(small), small.cones, None, lsgp.Options(seamless=lsgp.Seamless(tiles=16384))
    ).seamless.energy_after
    assert energy(mesh, result.corner_uv, part) <= ACCEPTABLE * fine
    assert "GRID_DISTORTS" not in codes(result.warnings)
    assert named_by(result, "HIGH_DISTORTION").tolist() == part.tolist()
    assert result.seamless.tiles <= 64


@pytest.mark.parametrize("scale", [0.1, 0.06, 0.03])
@pytest.mark.parametrize("body", [meshes.bumpy_sphere(2), meshes.cube(2)], ids=["ball", "cube"])
def test_small_parts_do_not_choose_the_tiles_of_all(body: Mesh, scale: float) -> None:
    """They have less than a twentieth of the area; tiles are finer than without them where the layout gains by it."""
    mesh = meshes.merge([body, meshes.transform(meshes.bumpy_sphere(1), 1, scale)])
    alone, both = (lsgp.parameterize(surface(of), of.cones, None, SQUARE).seamless for of in (body, mesh))
    assert alone is not None and both is not None
    assert both.tile_size >= alone.tile_size / 4
    assert both.energy_after <= ACCEPTABLE * both.energy_before


@pytest.mark.parametrize("distance", [1e-2, 1e-5, 1.5e-8])
def test_a_grid_beyond_the_bound_says_so(distance: float) -> None:
    """Cones of opposite curvature, of whose distance even the finest grid makes a cell."""
    mesh = meshes.with_close_cones(distance)
    result = lsgp.parameterize(surface(mesh), mesh.cones, meshes.CLOSE_CONE_ANGLES, SQUARE)
    assert undeclared_faults(surface(mesh), result, SQUARE) == []
    growth = result.seamless.energy_after / result.seamless.energy_before
    assert (growth > ACCEPTABLE) == (distance < 1e-7) == ("GRID_DISTORTS" in codes(result.warnings))
    if growth > ACCEPTABLE:
        assert result.seamless.tiles > 8192
        told = re.search(r"component by (\d+(?:\.\d+)?)", only(result.warnings, "GRID_DISTORTS").message)
        assert told and float(told[1]) == pytest.approx(growth, rel=0.02)


@pytest.mark.parametrize("sides", [(1, 0.7), (1, 0.1), (1, 0.1, 0.01), (1, 1e-3, 2)])
def test_parts_larger_than_their_tiles_say_are_named(sides: tuple[float, ...]) -> None:
    """Cubes, each of whole tiles however small it is; 1 would be the scale of a layout in tiles."""
    cubes = [meshes.cube(2)._replace(positions=meshes.cube(2).positions * side) for side in sides]
    mesh = meshes.merge(cubes)
    result = lsgp.parameterize(surface(mesh), mesh.cones, None, SQUARE)
    part = np.repeat(np.arange(len(cubes)), len(cubes[0].triangles))
    corners = mesh.positions[mesh.triangles]
    area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    z = result.corner_uv @ (1, 1j)
    uv_area = np.imag((z[:, 1] - z[:, 0]).conj() * (z[:, 2] - z[:, 0]))
    scale = np.sqrt(np.bincount(part, uv_area) / np.bincount(part, area)) * result.seamless.tile_size
    assert scale.min() == pytest.approx(1, abs=0.3)
    too_large = np.flatnonzero(np.isin(part, np.flatnonzero(scale > 2)))
    if not len(too_large):
        assert "HIGH_DISTORTION" not in codes(result.warnings)
        return
    warning = only(result.warnings, "HIGH_DISTORTION")
    assert warning.elements.kind == "triangles" and warning.elements.indices.tolist() == too_large.tolist()
    assert float(re.search(r"up to (\S+) times", warning.message)[1]) == pytest.approx(scale.max(), rel=0.01)


# --- what single precision cannot hold --------------------------------------------------------------------------------


@pytest.mark.parametrize("lattice", ["square", "hexagon"])
@pytest.mark.parametrize("scale", [1e-5, 1e-7])
def test_triangles_that_single_precision_flips_are_named(scale: float, lattice: str) -> None:
    ring = meshes.disk_with_holes(8, 1)._replace(cones=np.empty(0, np.int32))
    mesh = meshes.merge([meshes.bumpy_sphere(2), meshes.transform(ring, 1, scale)])
    options = lsgp.Options(seamless=lsgp.Seamless(tiles=64, lattice=lattice))
    result = lsgp.parameterize(surface(mesh), mesh.cones, None, options)
    assert undeclared_faults(surface(mesh), result, options) == []
    assert (scale < 1e-6) == (len(named_by(result, "FLIPPED_TRIANGLES")) > 0)
    assert np.isfinite([result.seamless.energy_before, result.seamless.energy_after]).all()


def test_a_vertex_that_is_a_cone_of_one_part_is_not_named_as_flat() -> None:
    """Two parts meet in a vertex, which comes out flat on one of them and as a cone of the other."""
    cube = meshes.cube(2)
    corner = int(cube.cones[0])
    flat = int(np.setdiff1d(np.arange(len(cube.positions)), cube.cones)[0])
    shift = len(cube.positions)
    second = cube.triangles + shift
    second[cube.triangles == flat] = corner
    moved = cube.positions + cube.positions[corner] - cube.positions[flat]
    mesh = meshes.make(np.concatenate([cube.positions, moved]), np.concatenate([cube.triangles, second]))
    cones = np.concatenate([cube.cones, cube.cones + shift]).astype(np.int32)
    result = lsgp.parameterize(surface(mesh), cones, None, SQUARE)
    assert "SPLIT_VERTEX" in codes(result.warnings)
    assert corner in result.cones and corner not in result.seamless.flat_cones
    assert not np.isin(result.cones, named_by(result, "FLAT_CONES")).any()
    assert undeclared_faults(surface(mesh), result, SQUARE) == []
