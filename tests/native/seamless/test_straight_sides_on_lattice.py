# SPDX-License-Identifier: GPL-3.0-or-later
"""Pieces without cuts, such as those of hard parts that end at their creases, have straight sides on a lattice, too."""

from __future__ import annotations

from dataclasses import replace

import lsgp
import meshes
import numpy as np
import pytest
from map_checks import surface
from meshes import Mesh
from numpy.typing import NDArray

TILE = lsgp.preset_options("tile")
CELLS = (9, 6)


def domed_panel(height: float, seed: int) -> Mesh:
    """A rectangle whose inside is raised and that is twisted slightly, turned in space."""
    flat = meshes.grid(*CELLS, lambda x, y: 0 * x)
    low, high = flat.positions.min(axis=0), flat.positions.max(axis=0)
    x, y = ((2 * flat.positions - low - high)[:, :2] / (high - low)[:2]).T
    positions = flat.positions.copy()
    positions[:, 2] = height * (high - low).max() * ((1 - x**2) * (1 - y**2) + 0.3 * x * y)
    return meshes.transform(flat._replace(positions=positions), seed=seed)


def bends(result: lsgp.Result, mesh: Mesh) -> NDArray[np.float64]:
    """How far each of the four sides is from a line along u or v, (4,), as stored, relative to its length."""
    uv = np.empty((len(mesh.positions), 2))
    uv[mesh.triangles.ravel()] = result.corner_uv.reshape(-1, 2).astype(np.float32)
    rows = np.arange(len(mesh.positions)).reshape(CELLS[1] + 1, CELLS[0] + 1)
    extents = np.array([np.ptp(uv[side], axis=0) for side in (rows[0], rows[-1], rows[:, 0], rows[:, -1])])
    return extents.min(axis=1) / extents.max(axis=1)


@pytest.mark.parametrize("height", [0.02, 0.05, 0.1])
@pytest.mark.parametrize("mode", ["conformal", "low-stretch"])
@pytest.mark.parametrize("seed", range(3))
def test_nearly_straight_sides_are_straight_and_along_the_lattice(seed: int, mode: lsgp.Mode, height: float) -> None:
    mesh = domed_panel(height, seed)
    options = replace(TILE, mode=mode)
    result = lsgp.auto_unwrap(surface(mesh), preset="tile", options=options)
    plain = lsgp.auto_unwrap(surface(mesh), preset="tile", options=replace(options, straighten=False))
    assert bends(result, mesh).max() == 0
    assert bends(plain, mesh).max() > 1e-4
    assert not len(result.flipped)
    assert result.distortion.l2_stretch <= plain.distortion.l2_stretch + 0.002
