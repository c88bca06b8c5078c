# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes of which one feature becomes as frequent as the mesh is large: holes, handles, needles, islands and others.

Every function takes the approximate number of triangles that it returns, and is deterministic.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import lsgp
import meshes
import numpy as np
from large_meshes import comb, of_polygons
from meshes import Mesh
from zoo.tunnels import tunneled_plate

SEED = 0

# Of the edges of a surface, as many are features.
FEATURE_SHARE = 0.3
# Of the cells of a block, as many are filled: most of them touch others in an edge or a corner.
FILLED_SHARE = 0.35


def surface_of(mesh: Mesh) -> lsgp.Surface:
    return lsgp.Surface(mesh.positions, mesh.triangles)


def genus(count: int) -> lsgp.Surface:
    """A plate of cells with square tunnels, 20 triangles each."""
    across = max(1, round(math.sqrt(count / 20)))
    return surface_of(tunneled_plate(across, across, 1))


def pinches(count: int) -> lsgp.Surface:
    """Random cells of a block, which touch in edges and corners."""
    side = round((count / (12 * FILLED_SHARE * (1 - FILLED_SHARE))) ** (1 / 3))
    return surface_of(meshes.voxels(np.random.default_rng(SEED).random((side,) * 3) < FILLED_SHARE))


def holes(count: int) -> lsgp.Surface:
    """A curved plate with square holes, 30 triangles each."""
    return surface_of(meshes.plate(max(1, round(math.sqrt(count / 30)))))


def corners(count: int) -> lsgp.Surface:
    """Towers of different heights on a plate, 24 triangles each: four convex and four saddle-shaped corners a tower."""
    towers = max(1, round(math.sqrt(count / 24)))
    side = 2 * towers + 1
    heights = np.ones((side, side))
    heights[1::2, 1::2] = np.random.default_rng(SEED).uniform(1.5, 3, (towers, towers))
    return surface_of(_terraces(heights))


def _terraces(heights: np.ndarray) -> Mesh:
    """A closed solid of columns of these heights, (side, side): 1, or more where none of those around is more."""
    side = len(heights)
    grid = meshes.grid(side, side)
    low = np.arange(len(grid.positions))
    floor = low + len(low)
    positions = [grid.positions + np.array([0, 0, 1]), grid.positions]
    j, i = np.divmod(np.arange(side * side), side)
    is_tower = np.tile(heights[j, i] > 1, 2)
    rim = _around(low.reshape(side + 1, side + 1))
    triangles = [grid.triangles[~is_tower], floor[grid.triangles[:, ::-1]], _walls(floor[rim], rim)]
    for number, (j, i) in enumerate(np.argwhere(heights > 1)):
        foot = low.reshape(side + 1, side + 1)[j : j + 2, i : i + 2].ravel()[[0, 1, 3, 2]]
        head = 2 * len(low) + 4 * number + np.arange(4)
        positions.append(grid.positions[foot] + [0, 0, heights[j, i]])
        triangles += [_walls(foot, head), head[[[0, 1, 2], [0, 2, 3]]]]
    return meshes.make(np.concatenate(positions), np.concatenate(triangles))


def _around(number: np.ndarray) -> np.ndarray:
    """The vertices around a grid of them, counter-clockwise."""
    return np.concatenate([number[0, :-1], number[:-1, -1], number[-1, :0:-1], number[:0:-1, 0]])


def _walls(low: np.ndarray, high: np.ndarray) -> np.ndarray:
    """Between two loops, counter-clockwise seen from above."""
    next_low, next_high = np.roll(low, -1), np.roll(high, -1)
    return np.concatenate([np.stack([low, next_low, next_high], 1), np.stack([low, next_high, high], 1)])


def round_cube(count: int) -> Mesh:
    """A ball with bumps, of any number of triangles."""
    mesh = meshes.cube(max(1, round(math.sqrt(count / 12))))
    ball = mesh.positions - 0.5
    ball /= np.linalg.norm(ball, axis=1, keepdims=True)
    x, y, z = ball.T
    bump = np.sin(2.3 * x + 0.7) * np.cos(1.9 * y - 0.3) + 0.6 * np.sin(3.1 * z + 1.1 * x)
    return mesh._replace(positions=ball * (1 + 0.2 * bump)[:, None])


def features(count: int) -> lsgp.Surface:
    """A ball of which edges chosen at random are marked as features."""
    mesh = round_cube(count)
    edges = meshes.edges_of(mesh.triangles)
    marked = edges[np.random.default_rng(SEED).random(len(edges)) < FEATURE_SHARE]
    return lsgp.Surface(mesh.positions, mesh.triangles, features=marked)


def islands(count: int) -> lsgp.Surface:
    """Boxes of different sizes apart from each other."""
    boxes = max(1, round(count / 12))
    box, random = meshes.cube(1), np.random.default_rng(SEED)
    across = math.isqrt(boxes) + 1
    place = 3.0 * np.stack([np.arange(boxes) % across, np.arange(boxes) // across, np.zeros(boxes)], axis=1)
    positions = box.positions * random.uniform(0.3, 1.5, (boxes, 1, 3)) + place[:, None]
    triangles = box.triangles + len(box.positions) * np.arange(boxes)[:, None, None]
    return surface_of(meshes.make(positions, triangles))


def teeth(count: int) -> lsgp.Surface:
    """A prism over a comb, whose two caps are single polygons: 32 triangles a tooth."""
    return of_polygons(comb(max(1, round(count / 16))))


def needles(count: int) -> lsgp.Surface:
    """A long cylinder of thin triangles from end to end, whose caps are fans."""
    around = max(3, round(count / 4))
    turn, low = 2 * np.pi * np.arange(around) / around, np.arange(around)
    circle = np.stack([np.cos(turn), np.sin(turn)], axis=1)
    rings = [np.insert(circle, 2, z, axis=1) for z in (0.0, 100.0)]
    positions = np.concatenate([*rings, [[0, 0, 0], [0, 0, 100]]])
    high, middle = low + around, np.full(around, 2 * around)
    caps = [np.stack([middle, np.roll(low, -1), low], 1), np.stack([middle + 1, high, np.roll(high, -1)], 1)]
    return surface_of(meshes.make(positions, np.concatenate([_walls(low, high), *caps])))


def strips(count: int) -> lsgp.Surface:
    """A band of one cell's width, wound around a cylinder."""
    band = meshes.grid(max(1, round(count / 2)), 1)
    turn, across = 0.1 * band.positions[:, 0], band.positions[:, 1]
    radius = 1 + 0.2 * across
    positions = np.stack([radius * np.cos(turn), radius * np.sin(turn), 0.03 * turn], axis=1)
    return surface_of(band._replace(positions=positions))


def fins(count: int) -> lsgp.Surface:
    """A plate with ribs on every second line of it, at which three triangles meet at each edge."""
    side = 2 * max(1, round(math.sqrt(count / 12)))
    plate = meshes.grid(side, side)
    foot = np.arange((side + 1) ** 2).reshape(side + 1, side + 1)[:, 1::2].T
    head = len(plate.positions) + np.arange(foot.size).reshape(foot.shape)
    ribs = [
        np.stack([a.ravel(), b.ravel(), c.ravel()], axis=1)
        for a, b, c in (
            (foot[:, :-1], foot[:, 1:], head[:, 1:]),
            (foot[:, :-1], head[:, 1:], head[:, :-1]),
        )
    ]
    positions = np.concatenate([plate.positions, plate.positions[foot.ravel()] + [0, 0, 1]])
    return surface_of(meshes.make(positions, np.concatenate([plate.triangles, *ribs])))


def scraps(count: int) -> lsgp.Surface:
    """A ring with another triangle on an edge of each third of its triangles."""
    along = max(4, round(math.sqrt(count / (2 * 1.8 * (1 + 1 / 3)))))
    body = meshes.torus(round(1.8 * along), along)
    feet = body.triangles[np.random.default_rng(SEED).permutation(len(body.triangles))[: len(body.triangles) // 3]]
    a, b, c = (body.positions[feet[:, i]] for i in range(3))
    normal = np.cross(b - a, c - a)
    length = np.linalg.norm(b - a, axis=1, keepdims=True)
    heads = (a + b) / 2 + normal / np.linalg.norm(normal, axis=1, keepdims=True) * length / 2
    numbers = len(body.positions) + np.arange(len(feet))
    triangles = np.concatenate([body.triangles, np.stack([feet[:, 0], feet[:, 1], numbers], axis=1)])
    return surface_of(meshes.make(np.concatenate([body.positions, heads]), triangles))


@dataclass(frozen=True)
class Family:
    """is_closed: others cannot become quads. options: of `auto_unwrap`. presets: those that these options go with."""

    what: str
    build: Callable[[int], lsgp.Surface]
    is_closed: bool = True
    options: dict[str, Any] = field(default_factory=dict)
    presets: tuple[str, ...] = ("paint", "bake", "tile")


FAMILIES = {
    "genus": Family("tunnels through a plate", genus),
    "pinches": Family("cells that touch in edges", pinches),
    "holes": Family("holes in a plate", holes, is_closed=False),
    "corners": Family("towers on a plate", corners),
    "features": Family("30 % of all edges are features", features),
    "islands": Family("boxes", islands),
    "udim": Family("boxes in 50 UDIM tiles", islands, False, {"udim": 50}, ("paint", "bake")),
    "teeth": Family("a comb whose caps are polygons", teeth),
    "needles": Family("a cylinder of needles", needles),
    "strips": Family("a spiral band", strips, is_closed=False),
    "fins": Family("ribs: edges of three triangles", fins, is_closed=False),
    "scraps": Family("a triangle on each third one of a ring", scraps, is_closed=False),
}
