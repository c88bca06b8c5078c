# SPDX-License-Identifier: GPL-3.0-or-later
"""Mixtures: a few meshes of other families as parts of one, with random noise, sizes and damage by a seed."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import cache

import numpy as np
from meshes import Mesh, grid, icosphere, make, merge, torus, voxels

from . import closed, flat, parts, scaled, swept, tunnels
from .member import Member, each, family

PREFIX = "mixture-seed="
MOST = 150  # triangles of a part

Random = np.random.Generator


@cache
def _pool() -> list[Member]:
    rooms = (flat, closed, swept, tunnels, parts, scaled)
    small = [one for room in rooms for one in room.members() if one.size == "small"]
    return [one for one in small if len(one.mesh().triangles) <= MOST]


def mixture(seed: int) -> Mesh:
    rng = np.random.default_rng(seed)
    picked = [_part(rng) for _ in range(rng.choice([1, 1, 1, 2, 3]))]
    mesh = merge([one._replace(positions=one.positions * rng.choice([1, 1, 1, 1e-3, 1e3])) for one in picked])
    for _ in range(rng.choice([0, 1, 1, 2])):
        mesh = DAMAGE[rng.integers(len(DAMAGE))](mesh, rng)
    return mesh


def _part(rng: Random) -> Mesh:
    kind = rng.integers(4)
    if kind == 0:
        return _lattice(rng)
    mesh = _pool()[rng.integers(len(_pool()))].mesh()
    size = np.abs(mesh.positions).max() or 1.0
    return mesh._replace(positions=mesh.positions / size)


def _lattice(rng: Random) -> Mesh:
    """Grids, rings and balls of any fineness, and heaps of cells, which may meet in edges and corners only."""
    kind = rng.integers(4)
    if kind == 0:
        return grid(int(rng.integers(1, 9)), int(rng.integers(1, 9)))
    if kind == 1:
        return torus(int(rng.integers(3, 12)), int(rng.integers(3, 8)))
    if kind == 2:
        return icosphere(int(rng.integers(0, 2)))
    filled = rng.random((int(rng.integers(1, 4)),) * 3) < rng.choice([0.3, 0.5, 0.7])
    filled[0, 0, 0] = True
    return voxels(filled)


def _noise(mesh: Mesh, rng: Random) -> Mesh:
    amount = rng.choice([0.01, 0.1, 0.5])
    return mesh._replace(positions=mesh.positions + amount * rng.normal(size=mesh.positions.shape))


def _squash(mesh: Mesh, rng: Random) -> Mesh:
    return mesh._replace(positions=mesh.positions * rng.choice([1, 1, 0, 1e-6, 1e-2, 1e2], 3))


def _drop(mesh: Mesh, rng: Random) -> Mesh:
    kept = rng.random(len(mesh.triangles)) < rng.choice([0.5, 0.8, 0.95])
    kept[0] = True
    return mesh._replace(triangles=np.ascontiguousarray(mesh.triangles[kept]))


def _turn(mesh: Mesh, rng: Random) -> Mesh:
    chosen = rng.random(len(mesh.triangles)) < rng.choice([0.05, 0.5])
    return mesh._replace(triangles=np.where(chosen[:, None], mesh.triangles[:, ::-1], mesh.triangles))


def _weld(mesh: Mesh, rng: Random) -> Mesh:
    """Some vertices become one with others, wherever those are; triangles that have a vertex twice go."""
    total = len(mesh.positions)
    same = np.arange(total)
    same[rng.integers(total, size=rng.integers(1, 4))] = rng.integers(total)
    t = same[mesh.triangles]
    whole = (t[:, 0] != t[:, 1]) & (t[:, 1] != t[:, 2]) & (t[:, 2] != t[:, 0])
    return make(mesh.positions, t[whole] if whole.any() else mesh.triangles)


def _collapse(mesh: Mesh, rng: Random) -> Mesh:
    """Some vertices at the places of their neighbors."""
    positions = mesh.positions.copy()
    for a, b, _ in mesh.triangles[rng.integers(len(mesh.triangles), size=3)]:
        positions[a] = positions[b]
    return mesh._replace(positions=positions)


def _double(mesh: Mesh, rng: Random) -> Mesh:
    again = mesh.triangles[rng.integers(len(mesh.triangles), size=rng.integers(1, 4))]
    again = again[:, :: rng.choice([-1, 1])]
    return make(mesh.positions, np.concatenate([mesh.triangles, again]))


def _strange_triangles(mesh: Mesh, rng: Random) -> Mesh:
    """Triangles between any vertices."""
    more = np.array([rng.choice(len(mesh.positions), 3, replace=False) for _ in range(rng.integers(1, 4))])
    return make(mesh.positions, np.concatenate([mesh.triangles, more]))


DAMAGE: list[Callable[[Mesh, Random], Mesh]] = [
    *(_noise, _squash, _drop, _turn, _weld, _collapse, _double, _strange_triangles)
]


def members() -> Iterator[Member]:
    yield from family("mixture", mixture, each(seed=tuple(range(60))), ordinary=False)


def member_of(seed: int) -> Member:
    """Any mixture, whether it is listed or not."""
    return Member(f"{PREFIX}{seed}", "mixture", {"seed": seed}, False, "small", mixture)
