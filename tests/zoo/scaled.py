# SPDX-License-Identifier: GPL-3.0-or-later
"""Ordinary shapes at extraordinary scales, places and numberings."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from meshes import Mesh, bumpy_sphere, cube, disk_with_holes, hill, renumber, subdivide, torus, transform

from .member import Member, each, family

SHAPES: dict[str, Callable[[], Mesh]] = {
    "box": lambda: cube(2),
    "ball": lambda: bumpy_sphere(1),
    "hill": lambda: hill(5),
    "ring": lambda: torus(8, 5),
    "holes": lambda: disk_with_holes(8, 2),
}


def at_scale(shape: str, exponent: int) -> Mesh:
    mesh = SHAPES[shape]()
    return mesh._replace(positions=mesh.positions * 10.0**exponent)


def off_center(shape: str, distance: float) -> Mesh:
    """Far from the origin, where coordinates have fewer digits left for the shape."""
    mesh = SHAPES[shape]()
    return mesh._replace(positions=mesh.positions + distance)


def turned(shape: str, seed: int) -> Mesh:
    return transform(SHAPES[shape](), seed, 3.0)


def shuffled(shape: str, seed: int) -> Mesh:
    return renumber(SHAPES[shape](), seed)[0]


def finer(shape: str, levels: int) -> Mesh:
    """Coarse facets, each cut into many flat triangles."""
    mesh = SHAPES[shape]()
    for _ in range(levels):
        mesh = subdivide(mesh)
    return mesh


def members() -> Iterator[Member]:
    shapes = tuple(SHAPES)
    yield from family("scale", at_scale, each(shape=shapes, exponent=(-6, -3, 3, 6)))
    yield from family("extreme-scale", at_scale, each(shape=shapes, exponent=(-30, -12, 12, 30)), ordinary=False)
    yield from family("off-center", off_center, each(shape=shapes, distance=(1e3, 1e5)))
    yield from family("lost-digits", off_center, each(shape=shapes, distance=(1e10, 1e15)), ordinary=False)
    yield from family("turned", turned, each(shape=shapes, seed=(0,)))
    yield from family("shuffled", shuffled, each(shape=shapes, seed=(0,)))
    yield from family("finer", finer, each(shape=shapes, levels=(1,)), each(shape=shapes, levels=(4,)))
