# SPDX-License-Identifier: GPL-3.0-or-later
"""Flat faces stay whole beside rounded edges and bores, however their slivers of triangles lie."""

from __future__ import annotations

import itertools
from collections.abc import Sequence

import lsgp
import numpy as np
import pytest

manifold3d = pytest.importorskip("manifold3d")
Manifold = manifold3d.Manifold


def rounded_box(size: Sequence[float], radius: float, segments: int = 3) -> Manifold:
    ball = Manifold.sphere(radius, 4 * segments)
    corners = np.array(list(itertools.product((-0.5, 0.5), repeat=3))) * (np.asarray(size) - 2 * radius)
    return Manifold.batch_hull([ball.translate(corner) for corner in corners.tolist()])


def bore(radius: float, sides: int, turn: Sequence[float], at: Sequence[float]) -> Manifold:
    return Manifold.cylinder(20, radius, radius, sides, True).rotate(turn).translate(at)


def surface_of(body: Manifold) -> lsgp.Surface:
    mesh = body.to_mesh()
    return lsgp.Surface(np.asarray(mesh.vert_properties, float)[:, :3], np.asarray(mesh.tri_verts, np.int32))


def block(sides: int) -> lsgp.Surface:
    """Three bores, two of which touch from inside, so that the edge between them fades out."""
    body = rounded_box((3, 2, 1.4), 0.15)
    body -= bore(0.45, sides, (0, 0, 0), (-0.6, 0.2, 0))
    body -= bore(0.4, sides, (90, 0, 0), (0.3, 0, 0.15))
    return surface_of(body - bore(0.3, sides - 4, (0, 90, 0), (0, 0.35, -0.1)))


def blocks(seed: int) -> lsgp.Surface:
    rng = np.random.default_rng(seed)
    size = rng.uniform(1.2, 3.5, 3)
    body = rounded_box(size, rng.uniform(0.05, 0.11) * size.min(), int(rng.integers(2, 5)))
    for _ in range(int(rng.integers(1, 4))):
        turn = ((0, 0, 0), (90, 0, 0), (0, 90, 0))[rng.integers(3)]
        at = rng.uniform(-0.2, 0.2, 3) * size
        body -= bore(rng.uniform(0.12, 0.3) * size.min(), int(rng.integers(12, 40)), turn, at.tolist())
    if seed % 3 == 2:
        body -= Manifold.cube((size / 2).tolist(), True).translate((0.45 * size).tolist())
    return surface_of(body)


def plate(seed: int) -> lsgp.Surface:
    rng = np.random.default_rng(seed)
    body = Manifold.cube([3, 2, 0.3], True)
    for _ in range(int(rng.integers(3, 9))):
        at = [rng.uniform(-1.1, 1.1), rng.uniform(-0.7, 0.7), 0.0]
        body -= bore(rng.uniform(0.08, 0.3), int(rng.integers(6, 40)), (0, 0, 0), at)
    return surface_of(body)


def islands_of(result: lsgp.Result) -> int:
    return len(np.unique(result.island[result.solved]))


@pytest.mark.parametrize("preset", ["paint", "bake", "tile"])
@pytest.mark.parametrize("sides", [12, 24, 48])
def test_a_rounded_block_with_bores_has_whole_faces_and_no_cones(sides: int, preset: lsgp.Preset) -> None:
    result = lsgp.auto_unwrap(block(sides), preset=preset)
    assert islands_of(result) <= 14 and not len(result.cones)
    assert result.distortion.l2_stretch < 1.01


@pytest.mark.parametrize("preset", ["paint", "bake"])
@pytest.mark.parametrize("seed", range(10))
def test_rounded_blocks_unfold_hardly_stretched(seed: int, preset: lsgp.Preset) -> None:
    result = lsgp.auto_unwrap(blocks(seed), preset=preset)
    assert islands_of(result) <= 14 and result.distortion.l2_stretch < 1.01


@pytest.mark.parametrize("preset", ["paint", "bake"])
@pytest.mark.parametrize("seed", range(5))
def test_plates_with_bores_unfold_exactly(seed: int, preset: lsgp.Preset) -> None:
    mesh = plate(seed)
    result = lsgp.auto_unwrap(mesh, preset=preset)
    assert not len(result.cones) and result.distortion.l2_stretch < 1 + 1e-5
    # Triangles of one plane that meet are on one island, but where Bake divides a face to fill the square.
    normal = np.cross(*(mesh.positions[mesh.triangles[:, c]] - mesh.positions[mesh.triangles[:, 0]] for c in (1, 2)))
    for side in (1, -1):
        cap = side * normal[:, 2] > 0.999 * np.linalg.norm(normal, axis=1)
        assert len(np.unique(result.island[cap])) == 1 or preset == "bake"
