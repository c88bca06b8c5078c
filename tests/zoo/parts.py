# SPDX-License-Identifier: GPL-3.0-or-later
"""Several loose parts in one mesh: many, of mixed kinds, of mixed sizes, one inside or on the other."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
from meshes import (
    Mesh,
    bumpy_sphere,
    cube,
    cylinder,
    grid,
    hill,
    icosahedron,
    make,
    merge,
    moebius_strip,
    tetrahedron,
    torus,
    triangle_soup,
)

from .flat import face
from .member import Member, each, family

KINDS: dict[str, Callable[[], Mesh]] = {
    "triangle": lambda: face(3, 0.0),
    "quad": lambda: face(4, 0.3),
    "grid": lambda: grid(2, 2),
    "hill": lambda: hill(4, 1.0),
    "tetrahedron": tetrahedron,
    "box": lambda: cube(1),
    "icosahedron": icosahedron,
    "tube": lambda: cylinder(5, 2),
    "ring": lambda: torus(6, 4),
    "ball": lambda: bumpy_sphere(1),
}


def equal_parts(kind: str, count: int) -> Mesh:
    return merge([KINDS[kind]()] * count)


def mixed_parts(count: int, spread: float, seed: int) -> Mesh:
    """Parts of random kinds, their sizes over so many powers of ten."""
    rng = np.random.default_rng(seed)
    picked = [KINDS[str(kind)]() for kind in rng.choice(list(KINDS), count)]
    return merge([one._replace(positions=one.positions * 10 ** rng.uniform(-spread, 0)) for one in picked])


def speck(kind: str, exponent: int) -> Mesh:
    """A large sheet and a part smaller by so many powers of ten beside it."""
    small = KINDS[kind]()
    return merge([grid(4, 4), small._replace(positions=small.positions * 10.0**exponent)])


def far_parts(distance: float) -> Mesh:
    """Two parts far from each other."""
    first, second = bumpy_sphere(1), hill(4, 1.0)
    both = merge([first, second])
    both.positions[len(first.positions) :] += distance
    return both


def doubled_sheet(cells: int, joined: bool) -> Mesh:
    """A sheet and its back at the same place; joined along the border they are a pillow."""
    mesh = grid(cells, cells, lambda x, y: 0.1 * np.sin(x + y))
    back = mesh.triangles[:, ::-1]
    if not joined:
        return make(np.concatenate([mesh.positions] * 2), np.concatenate([mesh.triangles, back + len(mesh.positions)]))
    x, y = mesh.positions[:, 0], mesh.positions[:, 1]
    inside = (x > 0) & (x < cells) & (y > 0) & (y < cells)
    other = np.arange(len(mesh.positions))
    other[inside] = len(mesh.positions) + np.arange(int(inside.sum()))
    return make(np.concatenate([mesh.positions, mesh.positions[inside]]), np.concatenate([mesh.triangles, other[back]]))


def nested_balls(count: int) -> Mesh:
    """Balls around one middle, each half as large as the one outside."""
    balls = [bumpy_sphere(1) for _ in range(count)]
    triangles = [ball.triangles + i * len(ball.positions) for i, ball in enumerate(balls)]
    return make(np.concatenate([ball.positions * 0.5**i for i, ball in enumerate(balls)]), np.concatenate(triangles))


def soup(levels: int) -> Mesh:
    """Every triangle a part of its own."""
    return triangle_soup(bumpy_sphere(levels))


def with_unsolvable(kind: str) -> Mesh:
    """A part beside a band that is not orientable and cannot be unwrapped."""
    return merge([KINDS[kind](), moebius_strip(8, 1)])


def members() -> Iterator[Member]:
    yield from family(
        "equal-parts",
        equal_parts,
        each(kind=tuple(KINDS), count=(2, 6)),
        [
            {"kind": "triangle", "count": 2000},
            {"kind": "box", "count": 2000},
            {"kind": "grid", "count": 2000},
            {"kind": "tetrahedron", "count": 500},
        ],
    )
    yield from family(
        "mixed-parts",
        mixed_parts,
        each(count=(2, 5), spread=(0.0, 2.0), seed=(0, 1, 2, 3)),
        [
            {"count": 300, "spread": 1.0, "seed": 4},
            {"count": 2000, "spread": 1.0, "seed": 5},
        ],
    )
    yield from family(
        "wide-spread-parts", mixed_parts, each(count=(4,), spread=(6.0, 12.0), seed=(0, 1)), ordinary=False
    )
    yield from family("speck", speck, each(kind=("triangle", "box", "hill"), exponent=(-2, -4)))
    yield from family("tiny-speck", speck, each(kind=("triangle", "box", "hill"), exponent=(-8, -15)), ordinary=False)
    yield from family("far-parts", far_parts, each(distance=(1e3, 1e6)))
    yield from family("very-far-parts", far_parts, each(distance=(1e12, 1e20)), ordinary=False)
    yield from family(
        "doubled-sheet",
        doubled_sheet,
        each(cells=(1, 3, 6), joined=(False, True)),
        [{"cells": 40, "joined": True}],
        ordinary=False,
    )
    yield from family("nested-balls", nested_balls, each(count=(2, 4)))
    yield from family("soup", soup, each(levels=(0, 1)), each(levels=(3,)))
    yield from family("part-beside-a-band", with_unsolvable, each(kind=("triangle", "box", "ring")), ordinary=False)
