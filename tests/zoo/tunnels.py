# SPDX-License-Identifier: GPL-3.0-or-later
"""Closed surfaces of any genus: plates and blocks with tunnels, sponges, chains of rings."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from meshes import Mesh, bumpy_sphere, cube, make, subdivide, voxels

from .member import Member, each, family


def tunneled_plate(across: int, along: int, thickness: int) -> Mesh:
    """A block of cells with across x along straight tunnels through it: as many handles."""
    filled = np.ones((2 * across + 1, 2 * along + 1, thickness), bool)
    filled[1::2, 1::2] = False
    return voxels(filled)


def smooth_tunneled_plate(across: int, along: int) -> Mesh:
    """The same with finer triangles and a gentle bend."""
    mesh = subdivide(tunneled_plate(across, along, 1))
    x, y, z = mesh.positions.T
    return mesh._replace(positions=np.stack([x, y, z + 0.1 * np.sin(0.6 * x) * np.cos(0.5 * y)], 1))


def sponge(cells: int) -> Mesh:
    """A frame of beams in all three directions."""
    odd = np.indices((2 * cells + 1,) * 3) % 2
    return voxels(odd.sum(axis=0) <= 1)


def random_sponge(cells: int, seed: int) -> Mesh:
    """A frame that has lost some of its beams."""
    odd = np.indices((2 * cells + 1,) * 3) % 2
    beams = odd.sum(axis=0) == 1
    lost = np.random.default_rng(seed).random(beams.shape) < 0.25
    joints = odd.sum(axis=0) == 0
    return voxels(joints | (beams & ~lost))


def tube_between(mesh: Mesh, handles: int, seed: int) -> Mesh:
    """Handles from one triangle to another far from it, by prisms between their two rims."""
    rng = np.random.default_rng(seed)
    free = np.ones(len(mesh.triangles), bool)
    triangles, dropped = [], []
    for _ in range(handles):
        ends = []
        for _ in range(2):
            choice = int(rng.choice(np.flatnonzero(free)))
            ends.append(choice)
            free &= ~np.isin(mesh.triangles, mesh.triangles[choice]).any(axis=1)
        one, other = (mesh.triangles[end] for end in ends)
        # The other rim is passed the other way round.
        other = other[::-1]
        turns = [np.roll(other, k) for k in range(3)]
        other = min(turns, key=lambda rim: float(np.abs(mesh.positions[one] - mesh.positions[rim]).sum()))
        for k in range(3):
            a, b, c, d = one[k], one[(k + 1) % 3], other[(k + 1) % 3], other[k]
            triangles += [[a, b, c], [a, c, d]]
        dropped += ends
    return make(mesh.positions, np.concatenate([np.delete(mesh.triangles, dropped, axis=0), triangles]))


def ball_with_handles(levels: int, handles: int, seed: int) -> Mesh:
    """Straight tubes through a ball from triangle to triangle: they cross each other in space."""
    return tube_between(bumpy_sphere(levels, 0.1), handles, seed)


def box_with_handles(cells: int, handles: int, seed: int) -> Mesh:
    return tube_between(cube(cells), handles, seed)


def members() -> Iterator[Member]:
    yield from family(
        "tunneled-plate",
        tunneled_plate,
        each(across=(1, 2, 4), along=(1, 3), thickness=(1, 3)),
        [
            {"across": 10, "along": 5, "thickness": 1},
            {"across": 20, "along": 10, "thickness": 1},
            {"across": 20, "along": 10, "thickness": 4},
        ],
    )
    yield from family(
        "bent-tunneled-plate", smooth_tunneled_plate, each(across=(1, 2), along=(1, 2)), [{"across": 10, "along": 10}]
    )
    yield from family("sponge", sponge, each(cells=(1, 2)), each(cells=(4, 5)))
    yield from family(
        "random-sponge", random_sponge, each(cells=(1, 2), seed=(0, 1)), each(cells=(4,), seed=(0,)), ordinary=False
    )
    yield from family(
        "ball-with-handles",
        ball_with_handles,
        each(levels=(2,), handles=(1, 3, 8), seed=(0, 1)),
        [
            {"levels": 5, "handles": 50, "seed": 0},
            {"levels": 6, "handles": 200, "seed": 0},
        ],
    )
    yield from family(
        "box-with-handles",
        box_with_handles,
        each(cells=(5, 6), handles=(1, 3), seed=(0,)),
        [{"cells": 30, "handles": 60, "seed": 0}],
    )
