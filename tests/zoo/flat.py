# SPDX-License-Identifier: GPL-3.0-or-later
"""Open sheets: single faces, strips, fans, terrains, plates with holes, needles, polygons."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from lsgp.io import polygons
from meshes import IndexArray, Mesh, compact, grid, hill, make, saddle

from .member import Member, each, family


def face(corners: int, bend: float) -> Mesh:
    """One polygon as a fan of triangles, every second corner lifted."""
    angle = 2 * np.pi * np.arange(corners) / corners
    lift = bend * (np.arange(corners) % 2)
    around = np.arange(1, corners - 1)
    return make(np.stack([np.cos(angle), np.sin(angle), lift], 1), np.stack([0 * around, around, around + 1], 1))


def strip(length: int, twist: float, curl: float) -> Mesh:
    """One row of cells, twisted about its middle line and curled up."""
    mesh = grid(length, 1)
    x, y = mesh.positions[:, 0], mesh.positions[:, 1] - 0.5
    turn, bend = twist * x, curl * x
    radius = np.where(curl > 0, 1 / max(curl, 1e-9), 0)
    middle = np.stack([radius * np.sin(bend), radius * (1 - np.cos(bend)), 0 * x], 1)
    if curl == 0:
        middle = np.stack([x, 0 * x, 0 * x], 1)
    across = np.stack([-np.sin(bend) * np.sin(turn), np.cos(bend) * np.sin(turn), np.cos(turn)], 1)
    return mesh._replace(positions=np.ascontiguousarray(middle + y[:, None] * across))


def fan(valence: int, height: float) -> Mesh:
    """Triangles all around one vertex, the rim a zigzag of this height."""
    angle = 2 * np.pi * np.arange(valence) / valence
    rim = np.stack([np.cos(angle), np.sin(angle), height * (np.arange(valence) % 2)], 1)
    i = np.arange(valence)
    return make(np.concatenate([[[0, 0, 0]], rim]), np.stack([0 * i, i + 1, (i + 1) % valence + 1], 1))


def terrain(cells: int, roughness: float, seed: int) -> Mesh:
    """Hills from a few random waves."""
    rng = np.random.default_rng(seed)
    waves = [(rng.normal(size=2), rng.uniform(0, 6), rng.normal()) for _ in range(12)]

    def height(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        total = sum(a * np.sin(k[0] * x + k[1] * y + phase) for k, phase, a in waves)
        return roughness * total

    return grid(cells, cells, height)


def holed_plate(across: int, along: int, bend: float) -> Mesh:
    """A sheet with across x along square holes, a cell between each two of them."""
    nx, ny = 2 * across + 1, 2 * along + 1
    mesh = grid(nx, ny, lambda x, y: bend * np.sin(0.7 * x + 0.2) * np.cos(0.5 * y))
    cell = np.concatenate([np.arange(nx * ny)] * 2)
    hole = (cell % nx % 2 == 1) & (cell // nx % 2 == 1)
    return compact(make(mesh.positions, mesh.triangles[~hole]))


def gappy_grid(cells: int, share: float, seed: int) -> Mesh:
    """A sheet that has lost some of its triangles at random."""
    mesh = grid(cells, cells, lambda x, y: 0.2 * np.sin(x + 0.5 * y))
    kept = np.random.default_rng(seed).random(len(mesh.triangles)) >= share
    return compact(make(mesh.positions, mesh.triangles[kept]))


def narrow_grid(cells: int, aspect: float) -> Mesh:
    """A sheet whose cells are `aspect` times as long as wide, slightly bent."""
    mesh = grid(cells, cells, lambda x, y: 0.1 * np.sin(x))
    return mesh._replace(positions=mesh.positions * np.array([aspect, 1.0, 1.0]))


def needle(aspect: float) -> Mesh:
    """Two triangles, `aspect` times as long as wide."""
    return make([[0, 0, 0], [aspect, 0, 0], [aspect, 1, 0], [0, 1, 0.1]], [[0, 1, 2], [0, 2, 3]])


def random_sheet(cells: int, shear: float, seed: int) -> Mesh:
    """A sheet of badly shaped triangles: vertices moved about at random in all directions."""
    mesh = grid(cells, cells)
    return mesh._replace(
        positions=mesh.positions + shear * np.random.default_rng(seed).normal(size=mesh.positions.shape)
    )


def polygon_sheet(cells: int, corners: int) -> tuple[Mesh, IndexArray]:
    """Polygons of four corners and more, side by side: cuts may not follow their diagonals."""
    width = corners // 2 - 1
    rows, columns = cells + 1, cells * width + 1
    x, y = (a.ravel().astype(float) for a in np.meshgrid(np.arange(columns), np.arange(rows)))
    faces = []
    for j in range(cells):
        for i in range(cells):
            low = np.arange(width + 1) + j * columns + i * width
            faces.append([*low.tolist(), *(low + columns)[::-1].tolist()])
    return _of_polygons(np.stack([x, y, 0.3 * np.sin(0.8 * x) * np.cos(0.9 * y)], 1), faces)


def polygon_box(cells: int, size: tuple[float, float, float]) -> tuple[Mesh, IndexArray]:
    """A box of quads."""
    points: dict[tuple[int, ...], int] = {}
    axes, faces = np.eye(3, dtype=int), []
    for k in range(3):
        u, v, w = axes[(k + 1) % 3], axes[(k + 2) % 3], axes[k]
        for origin, a, b in ((0 * w, v, u), (cells * w, u, v)):
            for i in range(cells):
                for j in range(cells):
                    p = origin + i * a + j * b
                    corners = [tuple(int(x) for x in q) for q in (p, p + a, p + a + b, p + b)]
                    faces.append([points.setdefault(q, len(points)) for q in corners])
    return _of_polygons(np.array(list(points), float) / cells * size, faces)


def _of_polygons(positions: np.ndarray, faces: list[list[int]]) -> tuple[Mesh, IndexArray]:
    corners = np.array([v for one in faces for v in one], np.int32)
    sizes = np.array([len(one) for one in faces], np.int64)
    cut = polygons.triangulate(polygons.PolygonMesh(positions, corners, sizes))
    return make(positions, cut.triangles), cut.edges


def members() -> Iterator[Member]:
    yield from family("face", face, each(corners=(3, 4, 5, 6, 12), bend=(0.0, 0.3))[1:])
    yield from family("triangle", face, [{"corners": 3, "bend": 0.0}])
    yield from family(
        "strip",
        strip,
        each(length=(2, 9, 40), twist=(0.0, 0.2), curl=(0.0, 0.3)),
        [{"length": 5000, "twist": 0.01, "curl": 0.0}],
    )
    yield from family(
        "fan", fan, each(valence=(3, 4, 7, 64), height=(0.0, 0.4)), each(valence=(1000, 50000), height=(0.0, 0.01))
    )
    yield from family(
        "terrain",
        terrain,
        each(cells=(6, 10), roughness=(0.05, 0.3, 1.0), seed=(0, 1)),
        each(cells=(80,), roughness=(0.1, 0.5), seed=(2,)),
    )
    yield from family(
        "holed-plate",
        holed_plate,
        each(across=(1, 2, 4), along=(1, 3), bend=(0.0, 0.3)),
        [
            {"across": 20, "along": 15, "bend": 0.2},
            {"across": 60, "along": 50, "bend": 0.0},
        ],
    )
    yield from family(
        "gappy-grid",
        gappy_grid,
        each(cells=(6, 10), share=(0.05, 0.2, 0.5), seed=(0, 1)),
        [{"cells": 60, "share": 0.1, "seed": 2}],
        ordinary=False,
    )
    yield from family(
        "narrow-grid", narrow_grid, each(cells=(3, 8), aspect=(1e-3, 1e2, 1e4)), [{"cells": 60, "aspect": 1e3}]
    )
    yield from family("very-narrow-grid", narrow_grid, each(cells=(3,), aspect=(1e-9, 1e-6, 1e8, 1e12)), ordinary=False)
    yield from family("needle", needle, each(aspect=(1e2, 1e4, 1e6)))
    yield from family("sharp-needle", needle, each(aspect=(1e8, 1e10, 1e12)), ordinary=False)
    yield from family(
        "random-sheet",
        random_sheet,
        each(cells=(2, 5), shear=(0.1, 0.5, 3.0), seed=(0, 1, 2)),
        [{"cells": 40, "shear": 0.3, "seed": 3}],
        ordinary=False,
    )
    yield from family(
        "polygon-sheet", polygon_sheet, each(cells=(1, 4), corners=(4, 6, 10)), [{"cells": 30, "corners": 4}]
    )
    yield from family(
        "polygon-box",
        polygon_box,
        each(cells=(1, 3), size=((1, 1, 1), (1, 5, 0.5))),
        [{"cells": 20, "size": (1, 2, 3)}],
    )
    yield from family("hill", hill, each(n=(6, 10), height=(0.5, 2.5, 10.0)), [{"n": 60, "height": 20.0}])
    yield from family("saddle", saddle, each(n=(4, 8), bend=(0.02, 0.2)), [{"n": 60, "bend": 0.02}])
