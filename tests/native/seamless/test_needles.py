# SPDX-License-Identifier: GPL-3.0-or-later
"""Needles in seamless layouts: triangles far lower than single precision resolves keep their orientation in it.

A vertex beside an edge, where meshes were joined, closes it with such a triangle; rounding its corners one by one
would flip it, or leave it without an area. `undeclared_faults` reads cuts and orientations off the stored coordinates.
"""

from __future__ import annotations

import lsgp
import meshes
import numpy as np
import pytest
from map_checks import codes, surface
from meshes import Mesh
from result_check import undeclared_faults

LATTICES = ("square", "stripe", "translation", "triangle", "hexagon")
MESHES = {
    "cube": meshes.cube(4),
    "ball": meshes.bumpy_sphere(3),
    "torus": meshes.torus(),
    "disk with a cone": meshes.hill(),
    "holes": meshes.disk_with_holes(12, 2),
}


def upright(result: lsgp.Result) -> np.ndarray:
    """Which triangles are the right way round as float32 stores them."""
    z = result.corner_uv.astype(np.float32).astype(float) @ (1, 1j)
    return np.imag((z[:, 1] - z[:, 0]).conj() * (z[:, 2] - z[:, 0])) > 0


def heights(corner: np.ndarray) -> np.ndarray:
    """Of triangles (m, 3, d) above their longest edge, to 1e-16 of it."""
    a, b = (np.pad(corner[:, k] - corner[:, 0], ((0, 0), (0, 3 - corner.shape[2]))) for k in (1, 2))
    doubled = np.linalg.norm(np.cross(a, b), axis=1)
    return doubled / np.linalg.norm(corner - np.roll(corner, 1, axis=1), axis=2).max(axis=1)


def checked(mesh: Mesh, **wanted: object) -> lsgp.Result:
    """A layout without any fault, and without any that a warning would name."""
    options = lsgp.Options(seamless=lsgp.Seamless(**wanted))
    result = lsgp.parameterize(surface(mesh), mesh.cones, None, options)
    assert undeclared_faults(surface(mesh), result, options) == []
    assert upright(result).all()
    assert not {"FLIPPED_TRIANGLES", "WRONG_ANGLE_SUMS", "COMPONENT_SKIPPED"} & set(codes(result.warnings))
    return result


@pytest.mark.parametrize("height", [1e-5, 1e-7])
@pytest.mark.parametrize("name", MESHES)
def test_needles_are_upright_in_single_precision(name: str, height: float) -> None:
    mesh = meshes.with_needles(MESHES[name], range(0, len(MESHES[name].triangles), 7), height)
    result = checked(mesh, tiles=64)
    assert result.seamless.error == 0
    assert np.isfinite(result.distortion.l2_stretch)


@pytest.mark.parametrize("count", [2, 5, 12])
def test_needles_beside_each_other_are_upright(count: int) -> None:
    mesh = meshes.with_needles(meshes.bumpy_sphere(3), range(0, 600, 50), 1e-6, count)
    assert checked(mesh, tiles=256).seamless.error == 0


@pytest.mark.parametrize("lattice", LATTICES)
def test_needles_are_upright_on_every_lattice(lattice: str) -> None:
    plain = meshes.torus() if lattice == "translation" else meshes.bumpy_sphere(3)
    mesh = meshes.with_needles(plain, range(0, len(plain.triangles), 11), 1e-7)
    result = checked(mesh, tiles=128, lattice=lattice)
    assert (result.seamless.error == 0) == (lattice in ("square", "stripe", "translation"))


@pytest.mark.parametrize("name", ["cube", "ball", "torus"])
def test_needles_hardly_grow(name: str) -> None:
    """Vertices move by a few times what single precision resolves in the layout."""
    mesh = meshes.with_needles(MESHES[name], range(0, len(MESHES[name].triangles), 7), 1e-7)
    result = checked(mesh, tiles=64)
    size = 2.0 ** np.ceil(np.log2(np.abs(result.corner_uv).max() + 1))
    height = heights(result.corner_uv.astype(np.float32).astype(float))[heights(mesh.positions[mesh.triangles]) < 1e-6]
    assert height.min() > 0 and height.max() < 16 * size * 2.0**-23


def test_creases_beside_needles_run_along_the_lattice() -> None:
    """Those of the cube itself; of what a needle adds to a crease, its middle may leave it."""
    plain = meshes.cube(4)
    mesh = meshes.with_needles(plain, range(0, len(plain.triangles), 5), 1e-7)
    options = lsgp.Options(seamless=lsgp.Seamless(tiles=64), straighten=True)
    result = lsgp.parameterize(surface(mesh), mesh.cones, None, options)
    assert upright(result).all()
    off = {tuple(edge) for w in result.warnings if w.code == "FEATURES_OFF_LATTICE" for edge in w.elements.indices}
    assert all(max(edge) >= len(plain.positions) for edge in off)
    stored = result.corner_uv.astype(np.float32).astype(float)
    sides = np.roll(stored, -1, axis=1) - stored
    ends = np.stack([mesh.triangles, np.roll(mesh.triangles, -1, axis=1)], axis=2)
    at_crease = (np.isin(mesh.positions, (0, 1)).sum(axis=1) >= 2)[ends].all(axis=2) & (
        ends < len(plain.positions)
    ).all(axis=2)
    between = mesh.positions[ends].mean(axis=2)
    at_crease &= np.isin(between, (0, 1)).sum(axis=2) == 2
    assert at_crease.sum() > 40
    assert ((sides[at_crease] == 0).sum(axis=1) == 1).all()
