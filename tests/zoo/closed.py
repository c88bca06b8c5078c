# SPDX-License-Identifier: GPL-3.0-or-later
"""Closed bodies: boxes, prisms, pyramids, stars, gears, cones, cylinders, balls."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from meshes import Mesh, bumpy_sphere, cube, ellipsoid, flower, icosahedron, icosphere, make, octahedron, subdivide
from meshes import tetrahedron as regular_tetrahedron

from .member import Member, each, family


def lathe(radius: np.ndarray, height: np.ndarray, around: int, *, caps: tuple[bool, bool]) -> Mesh:
    """A profile turned about z, from the bottom up; caps close it with a fan about a vertex on the axis.

    A radius of 0 at an end is a tip there.
    """
    rings = radius > 0
    angle = 2 * np.pi * np.arange(around) / around
    circle = np.stack([np.cos(angle), np.sin(angle)], 1)
    r, z = radius[rings], height[rings]
    positions = np.concatenate([np.column_stack([a * circle, np.full(around, b)]) for a, b in zip(r, z, strict=True)])
    i = np.arange(around)
    k = (i + 1) % around
    triangles = []
    for low in range(len(r) - 1):
        a, b, c, d = low * around + i, low * around + k, (low + 1) * around + k, (low + 1) * around + i
        triangles += [np.stack([a, b, c], 1), np.stack([a, c, d], 1)]
    tips = []
    if caps[0] or not rings[0]:
        tips.append(len(positions))
        triangles.append(np.stack([k, i, np.full(around, tips[-1])], 1))
        positions = np.concatenate([positions, [[0, 0, height[0]]]])
    if caps[1] or not rings[-1]:
        top = (len(r) - 1) * around
        tips.append(len(positions))
        triangles.append(np.stack([top + i, top + k, np.full(around, tips[-1])], 1))
        positions = np.concatenate([positions, [[0, 0, height[-1]]]])
    return make(positions, np.concatenate(triangles), tips)


def cylinder(around: int, along: int, length: float, caps: int) -> Mesh:
    """caps: how many of its ends are closed."""
    return lathe(np.ones(along + 1), np.linspace(0, length, along + 1), around, caps=(caps > 0, caps > 1))


def cone(around: int, along: int, height: float, base: bool) -> Mesh:
    radius = np.linspace(1, 0, along + 1)
    return lathe(radius, height * (1 - radius), around, caps=(base, False))


def pyramid(sides: int, height: float) -> Mesh:
    return lathe(np.array([1.0, 0.0]), np.array([0.0, height]), sides, caps=(True, False))


def bipyramid(sides: int, height: float) -> Mesh:
    """Two pyramids base to base: two vertices of valence `sides`."""
    return lathe(np.array([0.0, 1.0, 0.0]), np.array([-height, 0.0, height]), sides, caps=(False, False))


def prism(sides: int, layers: int, height: float) -> Mesh:
    return lathe(np.ones(layers + 1), np.linspace(0, height, layers + 1), sides, caps=(True, True))


def with_polygon_caps(sides: int, radius: tuple[float, float], height: float) -> Mesh:
    """A prism, or a cone or a part of one, whose caps are cut into triangles without a vertex inside."""
    body = lathe(np.array(radius), np.array([0.0, height]), sides, caps=(False, False))
    rims = [[*range(sides - 1, -1, -1)], [*range(sides, 2 * sides)]] if radius[1] > 0 else [[*range(sides - 1, -1, -1)]]
    caps = [[rim[0], rim[i], rim[i + 1]] for rim in rims for i in range(1, sides - 1)]
    return make(body.positions, np.concatenate([body.triangles, caps]))


def star(points: int, inner: float, height: float) -> Mesh:
    """A star-shaped outline, extruded."""
    body = prism(2 * points, 1, height)
    inward = np.where(np.arange(len(body.positions)) % 2 == 1, inner, 1.0)
    inward[4 * points :] = 1.0
    return body._replace(positions=body.positions * np.stack([inward, inward, np.ones_like(inward)], 1))


def gear(teeth: int, depth: float, layers: int) -> Mesh:
    """A wheel with square teeth: four points of its outline a tooth."""
    body = prism(4 * teeth, layers, 0.4)
    tooth = np.where(np.arange(len(body.positions)) % 4 < 2, 1.0, 1 - depth)
    tooth[-2:] = 1.0
    return body._replace(positions=body.positions * np.stack([tooth, tooth, np.ones_like(tooth)], 1))


def toothed_wheel(teeth: int, depth: float) -> Mesh:
    """A wheel with square teeth: its caps are rings around a fan, so that cones have room inside."""
    around = 4 * teeth
    radius = np.array([0, 0.3, 0.6, 1, 1, 1, 0.6, 0.3, 0])
    body = lathe(radius, np.array([0, 0, 0, 0, 0.2, 0.4, 0.4, 0.4, 0.4]), around, caps=(False, False))
    is_low = (np.arange(len(body.positions)) % 4 >= 2) & (np.hypot(*body.positions[:, :2].T) > 0.9)
    return body._replace(positions=body.positions * np.where(is_low, 1 - depth, 1.0)[:, None] ** [1, 1, 0])


def beveled_box(cells: int, bevel: float, size: tuple[float, float, float]) -> Mesh:
    """A box whose edges are rounded by a bevel that is narrow against its faces."""
    box = cube(cells)
    x = 2 * box.positions - 1
    core = np.clip(x, -1 + bevel, 1 - bevel)
    out = x - core
    length = np.linalg.norm(out, axis=1, keepdims=True)
    moved = core + bevel * np.divide(out, length, where=length > 0, out=np.zeros_like(out))
    return box._replace(positions=moved * np.asarray(size))


def noise_sphere(levels: int, amount: float, seed: int) -> Mesh:
    """Every vertex of a sphere moved in or out at random."""
    ball = icosphere(levels)
    factor = np.exp(amount * np.random.default_rng(seed).normal(size=(len(ball.positions), 1)))
    return ball._replace(positions=ball.positions * factor)


def spiked_sphere(levels: int, spikes: int, height: float) -> Mesh:
    """A sphere with long spikes at some of the icosahedron's corners."""
    ball = icosphere(levels)
    factor = np.ones((len(ball.positions), 1))
    factor[:spikes] = 1 + height
    return ball._replace(positions=ball.positions * factor)


def box(cells: int, size: tuple[float, float, float]) -> Mesh:
    return cube(cells, size)


SOLIDS = {"tetrahedron": regular_tetrahedron, "octahedron": octahedron, "icosahedron": icosahedron}


def solid(name: str, levels: int) -> Mesh:
    """A regular solid with flat faces, subdivided."""
    mesh = SOLIDS[name]()
    for _ in range(levels):
        mesh = subdivide(mesh)
    return mesh


def members() -> Iterator[Member]:
    sizes = ((1, 1, 1), (1, 2, 3), (1, 10, 1), (1, 30, 0.2))
    yield from family("box", box, each(cells=(1, 3), size=sizes), [{"cells": 40, "size": (1, 2, 3)}])
    yield from family("long-box", box, each(cells=(1, 3), size=((1, 1000, 1), (1, 200, 1))))
    yield from family("solid", solid, each(name=tuple(SOLIDS), levels=(0, 1, 2)), each(name=tuple(SOLIDS), levels=(5,)))
    yield from family(
        "cylinder",
        cylinder,
        each(around=(3, 12), along=(1, 5), length=(0.5, 6.0), caps=(0, 1, 2)),
        [{"around": 64, "along": 80, "length": 4.0, "caps": 2}],
    )
    yield from family(
        "cone",
        cone,
        each(around=(5, 16), along=(1, 4), height=(0.5, 5.0), base=(False, True)),
        [{"around": 100, "along": 50, "height": 3.0, "base": True}],
    )
    yield from family("pyramid", pyramid, each(sides=(3, 4, 6, 9), height=(0.2, 1.0, 8.0)))
    yield from family(
        "bipyramid",
        bipyramid,
        each(sides=(3, 5, 24), height=(0.3, 2.0)),
        [
            {"sides": 1000, "height": 1.0},
            {"sides": 50000, "height": 1.0},
        ],
    )
    yield from family(
        "prism",
        prism,
        each(sides=(3, 6, 10), layers=(1, 4), height=(0.3, 5.0)),
        [{"sides": 200, "layers": 30, "height": 4.0}],
    )
    yield from family("star", star, each(points=(3, 5, 8), inner=(0.3, 0.7), height=(0.2, 2.0)))
    yield from family(
        "gear", gear, each(teeth=(6, 12), depth=(0.15, 0.4), layers=(1, 3)), [{"teeth": 80, "depth": 0.1, "layers": 10}]
    )
    yield from family(
        "beveled-box",
        beveled_box,
        each(cells=(4, 6), bevel=(0.05, 0.3), size=((1, 1, 1), (1, 4, 0.5))),
        [{"cells": 40, "bevel": 0.1, "size": (1, 2, 3)}],
    )
    yield from family("ball", icosphere, each(levels=(1, 2)), each(levels=(4, 5)))
    yield from family("ellipsoid", ellipsoid, each(levels=(1, 2), axes=((1, 1.3, 0.7), (1, 5, 1), (1, 8, 0.1))))
    yield from family(
        "bumpy-ball", bumpy_sphere, each(levels=(1, 2), height=(0.1, 0.25)), each(levels=(5,), height=(0.25,))
    )
    yield from family("flower", flower, each(levels=(1, 2), height=(0.35,)), each(levels=(4,), height=(0.35,)))
    yield from family(
        "noise-ball",
        noise_sphere,
        each(levels=(1, 2), amount=(0.05, 0.3, 1.0), seed=(0, 1)),
        [{"levels": 4, "amount": 0.2, "seed": 2}],
    )
    yield from family(
        "spiked-ball",
        spiked_sphere,
        each(levels=(1, 2), spikes=(1, 4, 12), height=(1.0, 10.0)),
        [{"levels": 4, "spikes": 12, "height": 5.0}],
    )
