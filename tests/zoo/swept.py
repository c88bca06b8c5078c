# SPDX-License-Identifier: GPL-3.0-or-later
"""Tubes along curves: pipes, bends, springs, screws, rings, torus knots."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from meshes import Mesh, make, torus

from .member import Member, each, family


def sweep(path: np.ndarray, outline: np.ndarray, *, closed: bool, caps: bool) -> Mesh:
    """An outline (k, 2) carried along a curve (n, 3) without turning about it; closed curves meet their start again."""
    n, k = len(path), len(outline)
    following = np.roll(path, -1, axis=0) - np.roll(path, 1, axis=0)
    if not closed:
        following[0], following[-1] = path[1] - path[0], path[-1] - path[-2]
    tangent = following / np.linalg.norm(following, axis=1, keepdims=True)
    normal = np.empty_like(tangent)
    normal[0] = np.cross(tangent[0], np.eye(3)[np.abs(tangent[0]).argmin()])
    for i in range(1, n):
        normal[i] = normal[i - 1] - (normal[i - 1] @ tangent[i]) * tangent[i]
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    side = np.cross(tangent, normal)
    positions = (
        path[:, None] + outline[None, :, 0, None] * normal[:, None] + outline[None, :, 1, None] * side[:, None]
    ).reshape(-1, 3)
    i, j = (a.ravel() for a in np.meshgrid(np.arange(n if closed else n - 1), np.arange(k), indexing="ij"))
    i1, j1 = (i + 1) % n, (j + 1) % k
    a, b, c, d = i * k + j, i * k + j1, i1 * k + j1, i1 * k + j
    triangles = [np.stack([a, b, c], 1), np.stack([a, c, d], 1)]
    if caps and not closed:
        rim, count = np.arange(k), len(positions)
        positions = np.concatenate([positions, path[[0, -1]]])
        triangles.append(np.stack([np.roll(rim, -1), rim, np.full(k, count)], 1))
        last = (n - 1) * k + rim
        triangles.append(np.stack([last, np.roll(last, -1), np.full(k, count + 1)], 1))
    return make(positions, np.concatenate(triangles))


def circle(radius: float, around: int) -> np.ndarray:
    angle = 2 * np.pi * np.arange(around) / around
    return radius * np.stack([np.cos(angle), np.sin(angle)], 1)


def pipe(around: int, along: int, bend: float, caps: bool) -> Mesh:
    """A round tube that bends by so many radians in its middle."""
    t = np.linspace(-1, 1, along + 1)
    turn = bend * np.clip(2 * t, -0.5, 0.5)
    steps = np.stack([np.cos(turn), np.sin(turn), 0 * t], 1)
    return sweep(np.cumsum(8 / along * steps, axis=0), circle(0.5, around), closed=False, caps=caps)


def hollow_pipe(around: int, along: int, wall: float) -> Mesh:
    """A straight tube with a wall: inside, outside and both rims, of genus 1."""
    height = np.concatenate([np.linspace(0, 5, along + 1), np.linspace(5, 0, along + 1)])
    radius = np.concatenate([np.ones(along + 1), np.full(along + 1, 1 - wall)])
    angle = 2 * np.pi * np.arange(around) / around
    rings = len(radius)
    positions = np.stack(
        [np.outer(radius, np.cos(angle)), np.outer(radius, np.sin(angle)), np.outer(height, np.ones(around))], 2
    ).reshape(-1, 3)
    i, j = (a.ravel() for a in np.meshgrid(np.arange(rings), np.arange(around), indexing="ij"))
    i1, j1 = (i + 1) % rings, (j + 1) % around
    a, b, c, d = i * around + j, i * around + j1, i1 * around + j1, i1 * around + j
    return make(positions, np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)]))


def spring(turns: int, around: int, caps: bool) -> Mesh:
    t = np.linspace(0, 2 * np.pi * turns, 12 * turns + 1)
    return sweep(np.stack([2 * np.cos(t), 2 * np.sin(t), 0.25 * t], 1), circle(0.4, around), closed=False, caps=caps)


def screw(turns: int, sides: int, ridge: float) -> Mesh:
    """A rod with a helical thread, closed at both ends by pyramids."""
    along, around = 6 * turns, sides
    angle = 2 * np.pi * np.arange(around) / around
    level = np.arange(along + 1)
    thread = 1 + ridge * np.cos(angle[None, :] - 2 * np.pi * level[:, None] / 6)
    positions = np.stack(
        [thread * np.cos(angle), thread * np.sin(angle), np.repeat(level[:, None] / 4, around, axis=1)], 2
    ).reshape(-1, 3)
    tube = sweep(
        np.stack([0 * level, 0 * level, level / 4], 1).astype(float), circle(1, around), closed=False, caps=True
    )
    out = tube.positions.copy()
    out[: len(positions)] = positions
    return tube._replace(positions=out)


def knot(p: int, q: int, around: int) -> Mesh:
    """A tube along a torus knot, closed, of genus 1."""
    t = 2 * np.pi * np.arange(14 * max(p, q)) / (14 * max(p, q))
    ring = 2 + 0.8 * np.cos(q * t)
    return sweep(
        np.stack([ring * np.cos(p * t), ring * np.sin(p * t), 0.8 * np.sin(q * t)], 1),
        circle(0.3, around),
        closed=True,
        caps=False,
    )


def members() -> Iterator[Member]:
    yield from family(
        "pipe",
        pipe,
        each(around=(4, 8), along=(4, 10), bend=(0.0, 1.5, 3.0), caps=(False, True)),
        [{"around": 48, "along": 100, "bend": 1.5, "caps": True}],
    )
    yield from family(
        "hollow-pipe",
        hollow_pipe,
        each(around=(6, 12), along=(1, 4), wall=(0.05, 0.5)),
        [{"around": 64, "along": 40, "wall": 0.1}],
    )
    yield from family(
        "spring",
        spring,
        each(turns=(1, 3), around=(4, 6), caps=(False, True)),
        [{"turns": 20, "around": 16, "caps": True}],
    )
    yield from family(
        "screw", screw, each(turns=(2, 5), sides=(6, 12), ridge=(0.1, 0.3)), [{"turns": 40, "sides": 24, "ridge": 0.2}]
    )
    yield from family(
        "ring",
        torus,
        each(around=(6, 14), along=(4, 8), major=(2.0, 6.0)),
        [{"around": 120, "along": 60, "major": 2.0}],
    )
    yield from family(
        "knot",
        knot,
        [{"p": p, "q": q, "around": 4} for p, q in ((2, 3), (3, 2), (2, 5))],
        [{"p": 3, "q": 5, "around": 16}],
    )
