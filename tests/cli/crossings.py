# SPDX-License-Identifier: GPL-3.0-or-later
"""The cuts of a layout read from an OBJ file alone, in the single precision in which programs store coordinates."""

from __future__ import annotations

import math
from collections.abc import Iterable
from itertools import pairwise
from pathlib import Path

import numpy as np
from lsgp.io.mesh_files import read_mesh
from polygon_meshes import faces_of

Edge = tuple[int, int]


class Crossings:
    """sides: for each directed edge of a face, its two ends in that face as complex numbers, from float32.

    cuts: the edges, both directions, whose two faces have different coordinates.
    """

    def __init__(self, path: Path) -> None:
        mesh = read_mesh(path, with_uv=True)
        self.uv = mesh.corner_uv
        z = mesh.corner_uv.astype(np.float32).astype(np.float64) @ (1, 1j)
        self.sides: dict[Edge, tuple[complex, complex]] = {}
        for start, face in zip(mesh.starts.tolist(), faces_of(mesh), strict=True):
            for i, vertex in enumerate(face):
                j = (i + 1) % len(face)
                self.sides[vertex, face[j]] = (complex(z[start + i]), complex(z[start + j]))
        both = [(a, b) for a, b in self.sides if (b, a) in self.sides]
        self.cuts = [(a, b) for a, b in both if self.sides[a, b] != self.sides[b, a][::-1]]

    def paths(self, nodes: Iterable[int]) -> list[list[int]]:
        """The cuts from node to node, each once in each direction."""
        after: dict[int, list[int]] = {}
        for a, b in self.cuts:
            after.setdefault(a, []).append(b)
        ends = set(nodes)
        found = []
        for node in sorted(ends & set(after)):
            for second in after[node]:
                path = [node, second]
                while path[-1] not in ends:
                    (following,) = set(after[path[-1]]) - {path[-2]}
                    path.append(following)
                found.append(path)
        return found

    def off(self, path: list[int], turn: complex, shift: complex) -> float:
        """Largest distance of a vertex right of a path from turn * (the same vertex left of it) + shift."""
        worst = 0.0
        for a, b in pairwise(path):
            sisters = zip(self.sides[a, b], self.sides[b, a][::-1], strict=True)
            worst = max(worst, *(abs(right - (turn * left + shift)) for left, right in sisters))
        return worst


def turn_of(turns: int, rotation_order: int) -> complex:
    """e^(2 pi i turns / rotation_order), exact where it is a quarter turn."""
    quarters = 4 * turns / rotation_order
    if quarters.is_integer():
        return (1, 1j, -1, -1j)[int(quarters) % 4]
    return complex(math.cos(2 * math.pi * turns / rotation_order), math.sin(2 * math.pi * turns / rotation_order))


def require_certified(path: Path, certificate: dict) -> float:
    """Every cut of the file is one of the certificate, crossed as that says, and the other way round.

    Returns the largest distance of a vertex from the image of its sister, in texture coordinates.
    """
    crossings = Crossings(path)
    cuts = certificate["cuts"]
    paths = crossings.paths(node for cut in cuts for node in (cut["tail"], cut["head"]))
    assert len(paths) == 2 * len(cuts)
    assert sum(map(len, paths)) - len(paths) == len(crossings.cuts)
    basis = np.array(certificate["basis"]) @ (1, 1j)
    worst = 0.0
    for cut in cuts:
        turn = turn_of(cut["turns"], certificate["rotation_order"])
        shift = complex(certificate["cell"] * (np.array(cut["translation"]) @ basis))
        between = [p for p in paths if (p[0], p[-1]) == (cut["tail"], cut["head"])]
        best = min(between, key=lambda p: crossings.off(p, turn, shift))
        worst = max(worst, crossings.off(best, turn, shift))
        paths.remove(best)
        if best[::-1] in paths:
            paths.remove(best[::-1])
    assert paths == []
    return worst
