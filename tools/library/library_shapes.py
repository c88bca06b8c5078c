# SPDX-License-Identifier: GPL-3.0-or-later
"""Building blocks of generated meshes: polygons, and how to sweep, extrude, join and spoil them."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from itertools import product
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
IndexArray = NDArray[np.int64]
Random = np.random.RandomState
TAU = 2 * math.pi


class Polygons(NamedTuple):
    """positions: (n, 3). faces: arrays (f, k) of k-gons, counter-clockwise seen from outside."""

    positions: FloatArray
    faces: list[IndexArray]

    def triangle_count(self) -> int:
        return sum(len(block) * (block.shape[1] - 2) for block in self.faces)


def polygons(positions: object, *faces: object) -> Polygons:
    blocks = [np.asarray(block, np.int64) for block in faces]
    return Polygons(np.asarray(positions, float), [block for block in blocks if len(block)])


def joined(meshes: Iterable[Polygons]) -> Polygons:
    positions, blocks, first = [np.empty((0, 3))], [], 0
    for mesh in meshes:
        positions.append(mesh.positions)
        blocks += [block + first for block in mesh.faces]
        first += len(mesh.positions)
    sides = sorted({block.shape[1] for block in blocks})
    faces = [np.concatenate([block for block in blocks if block.shape[1] == k]) for k in sides]
    return Polygons(np.concatenate(positions), faces)


def moved(mesh: Polygons, scale: object = 1.0, by: object = 0.0, turn: FloatArray | None = None) -> Polygons:
    positions = mesh.positions * scale
    return mesh._replace(positions=(positions if turn is None else positions @ turn.T) + by)


def random_turn(random: Random) -> FloatArray:
    turn, _ = np.linalg.qr(random.normal(size=(3, 3)))
    return turn * np.linalg.det(turn)


def triangles_of(mesh: Polygons) -> IndexArray:
    """The faces as fans."""
    fans = [block[:, [0, i, i + 1]] for block in mesh.faces for i in range(1, block.shape[1] - 1)]
    return np.concatenate(fans) if fans else np.empty((0, 3), np.int64)


def net(rows: int, columns: int, *, closed: bool = False) -> IndexArray:
    """Quads of a net of vertices, row after row. closed: the last column is beside the first."""
    number = np.arange(rows * columns).reshape(rows, columns)
    if closed:
        number = np.concatenate([number, number[:, :1]], axis=1)
    around = [number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1]]
    return np.stack([corner.ravel() for corner in around], axis=1)


def round_cube(cells: int) -> Polygons:
    """A unit ball of quads without poles."""
    step = np.tan(np.linspace(-math.pi / 4, math.pi / 4, cells + 1))
    u, v = (part.ravel() for part in np.meshgrid(step, step, indexing="ij"))
    sides = []
    for axis, sign in product(range(3), (1, -1)):
        side = np.empty((len(u), 3))
        side[:, axis], side[:, (axis + 1) % 3], side[:, (axis + 2) % 3] = sign, u, v
        quads = net(cells + 1, cells + 1)[:, ::-1]
        sides.append(polygons(side, quads if sign > 0 else quads[:, ::-1]))
    whole = welded(joined(sides))
    return whole._replace(positions=whole.positions / np.linalg.norm(whole.positions, axis=1, keepdims=True))


def welded(mesh: Polygons) -> Polygons:
    """Vertices at one place, to nine digits, become one."""
    _, first, number = np.unique(np.round(mesh.positions, 9), axis=0, return_index=True, return_inverse=True)
    return Polygons(mesh.positions[first], [number.ravel()[block] for block in mesh.faces])


def tube(path: FloatArray, radius: FloatArray | float, sides: int, *, caps: bool = False) -> Polygons:
    """A tube around a path (k, 3). caps: with polygons at its ends."""
    step = np.gradient(path, axis=0)
    along = step / np.linalg.norm(step, axis=1, keepdims=True)
    frames = [np.cross(along[0], [0.31, 0.22, 1.0])]
    for direction in along[1:]:
        frames.append(frames[-1] - direction * (frames[-1] @ direction))
        frames[-1] /= np.linalg.norm(frames[-1])
    frames[0] /= np.linalg.norm(frames[0])
    one = np.array(frames)
    other = np.cross(along, one)
    angle = TAU * np.arange(sides) / sides
    wide = np.broadcast_to(radius, len(path))[:, None, None]
    ring = np.cos(angle)[:, None] * one[:, None] + np.sin(angle)[:, None] * other[:, None]
    positions = (path[:, None] + wide * ring).reshape(-1, 3)
    rows = len(path)
    quads = net(rows, sides, closed=True)
    ends = [np.arange(sides)[None, ::-1], (rows - 1) * sides + np.arange(sides)[None]] if caps else []
    return polygons(positions, quads, *ends)


def lathe(radius: FloatArray, height: FloatArray, sides: int) -> Polygons:
    """A surface of revolution with polygons as caps."""
    angle = TAU * np.arange(sides) / sides
    circle = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    rings = [np.insert(r * circle, 2, h, axis=1) for r, h in zip(radius, height, strict=True)]
    last = (len(radius) - 1) * sides + np.arange(sides)
    walls = net(len(radius), sides, closed=True)
    return polygons(np.concatenate(rings), walls, np.arange(sides)[None, ::-1], last[None])


def extruded(outline: FloatArray, depth: float, layers: int = 1) -> Polygons:
    """A prism over a polygon (k, 2), with polygons as caps."""
    levels = np.linspace(0, depth, layers + 1)
    rings = [np.insert(outline, 2, z, axis=1) for z in levels]
    sides = len(outline)
    top = layers * sides + np.arange(sides)
    return polygons(np.concatenate(rings), net(layers + 1, sides, closed=True), np.arange(sides)[None, ::-1], top[None])


def pierced(outer: FloatArray, inner: FloatArray, depth: float) -> Polygons:
    """A prism over a polygon with a hole, both counter-clockwise; its caps are polygons with a bridge to the hole."""
    near = int(np.argmin(np.linalg.norm(inner - outer[0], axis=1)))
    inner = np.roll(inner, -near, axis=0)
    ring = np.concatenate([outer, inner])
    count, out, hole = len(ring), np.arange(len(outer)), len(outer) + np.arange(len(inner))
    cap = np.concatenate([out, out[:1], hole[:1], hole[::-1]])[None]
    walls = [
        np.stack([rim, np.roll(rim, -1), np.roll(rim, -1) + count, rim + count], axis=1) for rim in (out, hole[::-1])
    ]
    positions = np.concatenate([np.insert(ring, 2, z, axis=1) for z in (0.0, depth)])
    return polygons(positions, *walls, cap[:, ::-1], cap + count)


def zero_set(field: Callable[[FloatArray], FloatArray], triangles: int, extent: float = 1.3) -> Polygons:
    """The surface where a field of points (p, 3) is zero, positive outside, of about so many triangles, as quads."""
    cells = 20
    found = _zero_set(field, cells, extent).triangle_count()
    cells = max(6, round(cells * math.sqrt(triangles / max(found, 1))))
    while not len((mesh := _zero_set(field, cells, extent)).positions):  # it lies between the points
        cells *= 2
    return mesh


def _zero_set(field: Callable[[FloatArray], FloatArray], cells: int, extent: float) -> Polygons:
    """A vertex in the middle of what the surface crosses of a cell's edges, and a quad around each of these."""
    line = np.linspace(-extent, extent, cells + 1)
    grid = np.stack(np.meshgrid(line, line, line, indexing="ij"), axis=-1)
    value = field(grid.reshape(-1, 3)).reshape((cells + 1,) * 3)
    value[[0, -1]] = value[:, [0, -1]] = value[:, :, [0, -1]] = np.abs(value).max()
    sums, count = np.zeros((cells, cells, cells, 3)), np.zeros((cells, cells, cells))
    crossings = []
    for axis in range(3):
        low, high = (np.take(value, range(i, cells + i), axis=axis) for i in (0, 1))
        at = np.argwhere((low < 0) != (high < 0))
        a, b = low[tuple(at.T)], high[tuple(at.T)]
        point = at.astype(float)
        point[:, axis] += a / (a - b)
        others = [(axis + 1) % 3, (axis + 2) % 3]
        corners = []
        for back, left in ((0, 0), (1, 0), (1, 1), (0, 1)):
            cell = at.copy()
            cell[:, others[0]] -= back
            cell[:, others[1]] -= left
            np.add.at(sums, tuple(cell.T), point)
            np.add.at(count, tuple(cell.T), 1)
            corners.append(np.ravel_multi_index(tuple(cell.T), count.shape))
        quads = np.stack(corners, axis=1)
        quads[a >= 0] = quads[a >= 0][:, ::-1]
        crossings.append(quads)
    used = np.flatnonzero(count)
    number = np.full(count.size, -1)
    number[used] = np.arange(len(used))
    positions = (sums.reshape(-1, 3)[used] / count.ravel()[used, None]) * (2 * extent / cells) - extent
    return polygons(positions, number[np.concatenate(crossings)])


def filled(cells: NDArray[np.bool_], size: float = 1.0) -> Polygons:
    """The surface of cells of a block: quads that share corners."""
    solid = np.pad(cells, 1)
    corners = []
    for axis, sign in product(range(3), (1, -1)):
        at = np.argwhere(solid & ~np.roll(solid, -sign, axis=axis))
        at[:, axis] += sign > 0
        one, other = np.eye(3, dtype=int)[[(axis + 1) % 3, (axis + 2) % 3]]
        around = np.stack([at, at + one, at + one + other, at + other], axis=1)
        corners.append(around if sign > 0 else around[:, ::-1])
    quads = np.concatenate(corners)
    points, number = np.unique(quads.reshape(-1, 3), axis=0, return_inverse=True)
    return polygons(size * points, number.reshape(-1, 4))


def with_defects(mesh: Polygons, share: float, random: Random) -> Polygons:
    """Of some of the faces, a share of all, each gets a fin on an edge, is there twice, or once more turned around."""
    corners = triangles_of(mesh)
    a, b, c = np.moveaxis(mesh.positions[corners], 1, 0)
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    with_area = np.flatnonzero(area > 1e-6 * area.mean())
    count = min(int(share * len(corners)), len(with_area))
    if count == 0:
        return mesh
    chosen = corners[random.choice(with_area, count, replace=False)]
    finned, twice, turned = np.split(chosen, [int(0.8 * count), int(0.95 * count)])
    a, b, c = (mesh.positions[finned[:, i]] for i in range(3))
    normal = np.cross(b - a, c - a)
    length = np.linalg.norm(normal, axis=1, keepdims=True)
    height = random.uniform(0.3, 1.2, (len(finned), 1)) * np.sqrt(length)
    tips = (a + b) / 2 + height * normal / np.where(length > 0, length, 1)
    first = len(mesh.positions)
    fins = np.stack([finned[:, 0], finned[:, 1], first + np.arange(len(finned))], axis=1)
    return joined([Polygons(np.concatenate([mesh.positions, tips]), [*mesh.faces, fins, twice, turned[:, ::-1]])])


def waves(points: FloatArray, random: Random, count: int, most: float) -> FloatArray:
    """A smooth sum of waves at points (p, 3)."""
    out = np.zeros(len(points))
    for _ in range(count):
        out += np.cos(points @ random.normal(0, most, 3) + random.uniform(0, TAU))
    return out / max(count, 1)


def shared_out(count: int, parts: int) -> Sequence[int]:
    """A count in nearly equal parts."""
    return [count * (i + 1) // parts - count * i // parts for i in range(parts)]
