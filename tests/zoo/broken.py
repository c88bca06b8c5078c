# SPDX-License-Identifier: GPL-3.0-or-later
"""Invalid surfaces: fins, bow ties, duplicate or flipped faces, no area, one-sided ones, loose vertices."""

from __future__ import annotations

from collections.abc import Iterator

import meshes
import numpy as np
from meshes import Mesh, grid, klein_bottle, make, moebius_strip
from scipy.spatial import Delaunay

from .member import Member, each, family
from .scaled import SHAPES

SHAPE_NAMES = tuple(SHAPES)


def finned(shape: str) -> Mesh:
    return meshes.with_fin(SHAPES[shape]())[0]


def pocketed(shape: str) -> Mesh:
    return meshes.with_pocket(SHAPES[shape]())


def book(pages: int, cells: int) -> Mesh:
    """Sheets that all share one edge line, their spine."""
    sheets = []
    for page in range(pages):
        angle = np.pi * page / pages
        mesh = grid(cells, cells)
        x, y = mesh.positions[:, 0], mesh.positions[:, 1]
        sheets.append(np.stack([x * np.cos(angle), y, x * np.sin(angle)], 1))
    mesh = grid(cells, cells)
    count = len(mesh.positions)
    triangles = np.concatenate([mesh.triangles + page * count for page in range(pages)])
    spine = np.flatnonzero(mesh.positions[:, 0] == 0)
    same = np.arange(pages * count)
    for page in range(1, pages):
        same[spine + page * count] = spine
    return meshes.compact(make(np.concatenate(sheets), same[triangles]))


def bow_tie(n: int) -> Mesh:
    return meshes.bow_tie(n)[0]


def flower_of_patches(petals: int) -> Mesh:
    """Patches that all share one vertex."""
    mesh = grid(2, 2)
    count = len(mesh.positions)
    triangles = np.concatenate([mesh.triangles + petal * count for petal in range(petals)])
    triangles[triangles % count == 0] = 0
    turns = 2 * np.pi * np.arange(petals) / petals
    positions = [
        np.stack([x * np.cos(t) - y * np.sin(t), x * np.sin(t) + y * np.cos(t), z + 0 * t], 1)
        for t in turns
        for x, y, z in [mesh.positions.T]
    ]
    return meshes.compact(make(np.concatenate(positions), triangles))


def with_twice(shape: str, count: int, turned: bool) -> Mesh:
    """Some faces twice, the second time turned over or not."""
    mesh = SHAPES[shape]()
    again = mesh.triangles[: 2 * count : 2]
    return make(mesh.positions, np.concatenate([mesh.triangles, again[:, ::-1] if turned else again]), mesh.cones)


def with_turned(shape: str, share: float, seed: int) -> Mesh:
    """Some faces inside out."""
    mesh = SHAPES[shape]()
    return meshes.with_flipped(mesh, np.flatnonzero(np.random.default_rng(seed).random(len(mesh.triangles)) < share))


def with_isolated(shape: str, count: int) -> Mesh:
    return meshes.with_isolated_vertices(SHAPES[shape](), count)


def with_t_junctions(shape: str, count: int) -> Mesh:
    mesh = SHAPES[shape]()
    for i in range(count):
        mesh = meshes.with_zero_area(mesh, 3 * i)
    return mesh


def with_zero_edges(shape: str, count: int, seed: int) -> Mesh:
    """Some edges of length 0: one vertex moved onto the other."""
    mesh = SHAPES[shape]()
    positions = mesh.positions.copy()
    for a, b, _ in np.random.default_rng(seed).permutation(mesh.triangles)[:count]:
        positions[a] = positions[b]
    return mesh._replace(positions=positions)


def with_flattened(shape: str, axis: int) -> Mesh:
    """All in one plane: a solid without inside, with faces of no area."""
    mesh = SHAPES[shape]()
    return mesh._replace(positions=mesh.positions * (np.arange(3) != axis))


def collapsed(shape: str) -> Mesh:
    """All in one point."""
    mesh = SHAPES[shape]()
    return mesh._replace(positions=np.zeros_like(mesh.positions))


def with_wild_vertex(shape: str, value: float) -> Mesh:
    mesh = SHAPES[shape]()
    return meshes.with_coordinate(mesh, int(mesh.triangles[0, 0]), value)


def scrap(corners: int, depth: float, seed: int) -> Mesh:
    """A few triangles over a disk, crumpled: in the plane they fold over and areas of both signs may cancel."""
    rng = np.random.default_rng(seed)
    flat = rng.random((corners, 2))
    triangles = Delaunay(flat).simplices
    a, b, c = flat[triangles[:, 0]], flat[triangles[:, 1]], flat[triangles[:, 2]]
    left = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0] > 0
    triangles = np.where(left[:, None], triangles, triangles[:, ::-1])
    positions = np.column_stack([flat, np.zeros(corners)]) + depth * rng.normal(size=(corners, 3))
    return make(positions, triangles)


def scrap_beside_model(corners: int, seed: int) -> Mesh:
    return meshes.merge([scrap(corners, 2.0, seed), meshes.hill(6)])


def folded_scrap(angle: float, size: float) -> Mesh:
    """Four triangles about one vertex, two of them folded back over the others."""
    out, back = np.cos(angle), np.sin(angle)
    rim = [[1, 0, 0], [out, back, 0.01], [1, 0.01, 0.02], [out, -back, -0.01]]
    return make(size * np.array([[0, 0, 0], *rim]), [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1]])


def random_complex(vertices: int, triangles: int, seed: int) -> Mesh:
    """Triangles between random vertices: no surface at all."""
    rng = np.random.default_rng(seed)
    picked = np.array([rng.permutation(vertices)[:3] for _ in range(triangles)])
    return make(rng.normal(size=(vertices, 3)), picked)


def members() -> Iterator[Member]:
    def broken(name: str, make: object, small: list, large: tuple | list = ()) -> Iterator[Member]:
        return family(name, make, small, large, ordinary=False)

    yield from broken("fin", finned, each(shape=SHAPE_NAMES))
    yield from broken("pocket", pocketed, each(shape=SHAPE_NAMES))
    yield from broken("book", book, each(pages=(3, 5), cells=(1, 3)), [{"pages": 50, "cells": 10}])
    yield from broken("bow-tie", bow_tie, each(n=(1, 3)), each(n=(30,)))
    yield from broken("patches-about-a-vertex", flower_of_patches, each(petals=(3, 8)), each(petals=(1000,)))
    yield from broken("faces-twice", with_twice, each(shape=SHAPE_NAMES, count=(1, 4), turned=(False, True)))
    yield from broken("turned-faces", with_turned, each(shape=SHAPE_NAMES, share=(0.1, 0.5), seed=(0,)))
    yield from family("isolated-vertices", with_isolated, each(shape=SHAPE_NAMES, count=(1, 7)))
    yield from broken("t-junctions", with_t_junctions, each(shape=SHAPE_NAMES, count=(1, 4)))
    yield from broken("zero-edges", with_zero_edges, each(shape=SHAPE_NAMES, count=(1, 5), seed=(0,)))
    yield from broken("flattened", with_flattened, each(shape=SHAPE_NAMES, axis=(2,)))
    yield from broken("collapsed", collapsed, each(shape=("box", "hill")))
    yield from broken(
        "wild-vertex", with_wild_vertex, each(shape=("box", "hill"), value=(float("nan"), float("inf"), 1e200, 1e20))
    )
    yield from broken(
        "scrap",
        scrap,
        each(corners=(4, 5, 6, 8, 12), depth=(0.2, 2.0), seed=(0, 1, 2)),
        [{"corners": 2000, "depth": 0.02, "seed": 3}],
    )
    yield from broken("scrap-beside-hill", scrap_beside_model, each(corners=(4, 5, 6), seed=(0, 1, 2, 3)))
    yield from broken("folded-scrap", folded_scrap, each(angle=(0.3, 1.2, 2.5), size=(1.0,)))
    yield from broken("moebius", moebius_strip, each(around=(5, 16), across=(1, 3)), each(around=(200,), across=(10,)))
    yield from broken("klein-bottle", klein_bottle, each(around=(6, 10), along=(5, 8)), each(around=(60,), along=(30,)))
    yield from broken("random-complex", random_complex, each(vertices=(5, 9), triangles=(4, 12), seed=(0, 1, 2)))
