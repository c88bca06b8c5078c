# SPDX-License-Identifier: GPL-3.0-or-later
"""Islands too small for single precision: whatever files and programs would spoil is named, and nothing else."""

from __future__ import annotations

import lsgp
import meshes
import numpy as np
import pytest
from lsgp import TexelLayout
from map_checks import surface
from sanitized_run import many_solves

SHAPES = {"hill": meshes.hill(5), "cube": meshes.cube(2), "ball": meshes.icosphere(1), "bowl": meshes.saddle(4)}
# Layouts of every kind: how they are asked for.
WAYS = [
    {"preset": "paint", "pack": "shelves"},
    {"preset": "bake", "pack": "shelves", "texels": TexelLayout(20.0, 1024)},
    {"preset": "bake", "texels": TexelLayout(20.0, 1024, udim=100)},
]


def with_speck(shape: str, exponent: int) -> lsgp.Surface:
    """A bumpy ball, and beside it a shape whose size is this power of ten."""
    ball, small = meshes.bumpy_sphere(1), SHAPES[shape]
    positions = np.concatenate([ball.positions, small.positions * 10.0**exponent])
    return surface(meshes.make(positions, np.concatenate([ball.triangles, small.triangles + len(ball.positions)])))


def spoiled(result: lsgp.Result) -> np.ndarray:
    """(m,) triangles that are flipped, or points or lines, when their coordinates are stored in single precision."""
    stored = result.corner_uv.astype(np.float32).astype(np.float64)
    first, second = stored[:, 1] - stored[:, 0], stored[:, 2] - stored[:, 0]
    return ~(first[:, 0] * second[:, 1] > first[:, 1] * second[:, 0])


@pytest.mark.slow
@pytest.mark.parametrize("way", WAYS, ids=["square", "texel density", "tiles"])
@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("exponent", [0, -9, *many_solves(-3, -12)])
def test_islands_that_single_precision_spoils_are_named(few_tries, shape: str, exponent: int, way: dict) -> None:
    result = lsgp.auto_unwrap(with_speck(shape, exponent), **way)
    said = [finding for finding in result.warnings if finding.code == "ISLANDS_TINY"]
    named = np.unique(np.concatenate([finding.elements.indices for finding in said]) if said else np.zeros(0, int))
    # The speck, as far as it is not on the ball's island, which it never is; from the last places on all of it.
    of_ball = len(meshes.bumpy_sphere(1).triangles)
    assert (named >= of_ball).all()
    assert set(np.flatnonzero(spoiled(result))) <= set(named)
    if exponent <= -9:
        assert set(range(of_ball, len(result.island))) == set(named) and spoiled(result).any()
    else:
        assert not said


@pytest.mark.parametrize("density", [1.0, 1e-10, 1e-30])
def test_a_density_at_which_islands_collapse_beside_margins_names_them(density: float) -> None:
    box = surface(meshes.cube(2))
    result = lsgp.auto_unwrap(box, pack="shelves")
    placed = lsgp.at_texel_density(box, result, TexelLayout(density, 1024, 4))
    named = [finding.elements.indices.tolist() for finding in placed.warnings if finding.code == "ISLANDS_TINY"]
    assert named == ([] if density == 1 else [list(range(len(result.island)))])
    assert density < 1 or not spoiled(placed).any()
    # Without margins all coordinates are as small.
    assert lsgp.at_texel_density(box, result, TexelLayout(density, 1024)).warnings == result.warnings
