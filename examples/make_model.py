# SPDX-License-Identifier: GPL-3.0-or-later
"""Make model.obj, the rubber duck of the documentation: python examples/make_model.py

Boxes of a grid, stacked to a duck; two steps of Catmull-Clark subdivision make them a smooth closed surface of quads,
mirror-symmetric in x. Y is up, the duck faces +Z, lengths are meters. Needs numpy alone.
"""

from __future__ import annotations

from itertools import product
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
Box = tuple[int, int, int]

STEPS = 2  # of subdivision
# Where the grid's planes are, meters.
ACROSS = (-0.3, -0.13, 0.13, 0.3)
UP = (-0.05, 0.3, 0.4, 0.52, 0.7)
ALONG = (-0.45, -0.2, 0.08, 0.36, 0.56)
# First and last box of every part, both included, by column, row and place along.
PARTS: tuple[tuple[Box, Box], ...] = (
    ((0, 0, 0), (2, 0, 2)),  # body
    ((1, 1, 0), (1, 1, 0)),  # tail
    ((1, 1, 2), (1, 3, 2)),  # head
    ((1, 2, 3), (1, 2, 3)),  # beak
)


def boxes() -> set[Box]:
    """All boxes of all parts."""
    found: set[Box] = set()
    for first, last in PARTS:
        columns, rows, places = (range(low, high + 1) for low, high in zip(first, last, strict=True))
        found |= set(product(columns, rows, places))
    return found


def cage() -> tuple[FloatArray, IntArray]:
    """Corners (n, 3) and quads (q, 4), counter-clockwise from outside: the sides of boxes that no other box covers."""
    solid = boxes()
    sides: list[list[Box]] = []
    for box, axis, step in product(sorted(solid), range(3), (-1, 1)):
        if tuple(np.add(box, step * np.eye(3, dtype=int)[axis])) not in solid:
            sides.append(_side(box, axis, step))
    corners = sorted({corner for side in sides for corner in side})
    index = {corner: at for at, corner in enumerate(corners)}
    positions = [(ACROSS[x], UP[y], ALONG[z]) for x, y, z in corners]
    return np.array(positions), np.array([[index[corner] for corner in side] for side in sides])


def _side(box: Box, axis: int, step: int) -> list[Box]:
    """Corners of a box's side, counter-clockwise from outside."""
    first, second = (axis + 1) % 3, (axis + 2) % 3
    ring = ((0, 0), (1, 0), (1, 1), (0, 1)) if step > 0 else ((0, 0), (0, 1), (1, 1), (1, 0))
    corners: list[Box] = []
    for along_first, along_second in ring:
        corner = list(box)
        corner[axis] += step > 0
        corner[first] += along_first
        corner[second] += along_second
        corners.append((corner[0], corner[1], corner[2]))
    return corners


def subdivided(positions: FloatArray, quads: IntArray) -> tuple[FloatArray, IntArray]:
    """One step of Catmull and Clark's subdivision of a closed mesh of quads (Computer-Aided Design 1978)."""
    n, count = len(positions), len(quads)
    following = np.roll(quads, -1, axis=1)
    edges, edge = np.unique(np.sort(np.stack([quads, following], axis=-1).reshape(-1, 2)), axis=0, return_inverse=True)
    edge = edge.reshape(quads.shape)
    of_face = positions[quads].mean(axis=1)
    beside = _sums(edge, np.repeat(of_face[:, None], 4, axis=1), len(edges))
    of_edge = (positions[edges].sum(axis=1) + beside) / 4
    valence = np.bincount(quads.ravel(), minlength=n)[:, None]
    around = _sums(quads, np.repeat(of_face[:, None], 4, axis=1), n) / valence
    middles = _sums(edges, np.repeat(positions[edges].mean(axis=1)[:, None], 2, axis=1), n) / valence
    of_vertex = (around + 2 * middles + (valence - 3) * positions) / valence
    face_vertex = np.broadcast_to(n + len(edges) + np.arange(count)[:, None], quads.shape)
    parts = np.stack([quads, n + edge, face_vertex, n + np.roll(edge, 1, axis=1)], axis=-1)
    return np.concatenate([of_vertex, of_edge, of_face]), parts.reshape(-1, 4)


def _sums(index: IntArray, values: FloatArray, n: int) -> FloatArray:
    """(n, 3) sums of the values (..., 3) by their index (...)."""
    total = np.zeros((n, 3))
    np.add.at(total, index.ravel(), values.reshape(-1, 3))
    return total


def model() -> tuple[FloatArray, IntArray]:
    """Vertices (n, 3) and quads (q, 4) of the duck, on the ground."""
    positions, quads = cage()
    for _ in range(STEPS):
        positions, quads = subdivided(positions, quads)
    return positions - (0.0, positions[:, 1].min(), 0.0), quads


def as_obj(positions: FloatArray, quads: IntArray) -> str:
    lines = [
        "# The rubber duck of Cone Unwrap's documentation, made by examples/make_model.py. GPL-3.0-or-later",
        "o duck",
    ]
    # Zero has no sign.
    lines += [f"v {x:.5f} {y:.5f} {z:.5f}" for x, y, z in (positions.round(5) + 0.0).tolist()]
    lines += ["f " + " ".join(map(str, quad)) for quad in (quads + 1).tolist()]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    Path(__file__).with_name("model.obj").write_text(as_obj(*model()), encoding="utf-8", newline="\n")
