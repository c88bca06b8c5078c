# SPDX-License-Identifier: GPL-3.0-or-later
"""The surfaces `benchmark.py` measures on, all of them closed."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import igl
import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

ROOT = Path(__file__).resolve().parents[2]
SHARED = ROOT.parent / "shared" / "meshes"
MESHES = ("cube-768", "hand-5k", "bird", "fandisk", "octa-flower", "igea-16k", "max-planck-25k")
# Triangles, how often they are subdivided for that, and numbers of random cones.
SIZES = ((50_000, 1, (100, 500)), (200_000, 2, (100, 500)), (1_000_000, 3, ()))


@dataclass(frozen=True)
class Case:
    """positions: (n, 3) float64. triangles: (m, 3) int32. cones: (k,) int32 vertices.

    is_random: cones at random, not where they distort least.
    """

    name: str
    positions: np.ndarray
    triangles: np.ndarray
    cones: np.ndarray
    is_random: bool = False


def read_case(name: str) -> Case:
    """A shared mesh with its cones."""
    positions, triangles = igl.read_triangle_mesh(str(SHARED / f"{name}.obj"))
    cones = json.loads((SHARED / f"{name}.cones.json").read_text(encoding="utf-8"))["cones"]
    return Case(name, positions, triangles.astype(np.int32), np.array(cones, np.int32))


def bumpy_sphere(level: int) -> Case:
    """An octahedron with its edges halved `level` times, on a sphere with six bumps; those are the cones."""
    positions = np.vstack([np.eye(3), -np.eye(3)])
    triangles = np.array([(0, 1, 2), (1, 3, 2), (3, 4, 2), (4, 0, 2), (1, 0, 5), (3, 1, 5), (4, 3, 5), (0, 4, 5)])
    for _ in range(level):
        halves = np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
        edges, middle = np.unique(halves, axis=0, return_inverse=True)
        a, b, c = triangles.T
        ab, bc, ca = middle.reshape(-1, 3).T + len(positions)
        triangles = np.vstack([np.column_stack(t) for t in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))])
        positions = np.vstack([positions, positions[edges].mean(axis=1)])
    positions /= np.linalg.norm(positions, axis=1)[:, None]
    radius = 1 + 0.5 * np.abs(positions).max(axis=1) ** 12
    name = f"bumpy sphere {level}"
    return Case(name, positions * radius[:, None], triangles.astype(np.int32), np.arange(6, dtype=np.int32))


def resized(case: Case, triangles: int, subdivisions: int = 0) -> Case:
    """Decimated, then subdivided (Loop) to about so many triangles; cones are moved to the nearest vertices."""
    coarse = triangles >> 2 * subdivisions
    positions, faces, _, _ = igl.decimate(case.positions, case.triangles.astype(np.int64), coarse)
    nearest = [int(np.argmin(np.linalg.norm(positions - cone, axis=1))) for cone in case.positions[case.cones]]
    for _ in range(subdivisions):
        positions, faces = igl.loop(positions, faces)  # old vertices keep their numbers
    return Case(f"{case.name}, resized", positions, faces.astype(np.int32), np.array(nearest, np.int32))


def with_random_cones(case: Case, count: int) -> Case:
    cones = np.random.default_rng(count).choice(len(case.positions), count, replace=False).astype(np.int32)
    return Case(case.name, case.positions, case.triangles, cones, is_random=True)


def small_cases(names: Sequence[str]) -> list[Case]:
    if not SHARED.is_dir():
        return [bumpy_sphere(level) for level in (3, 4, 5)]
    return [read_case(name) for name in names or MESHES]


def dense_cases() -> list[Case]:
    """About 50,000 triangles: a head, and a surface of genus 3."""
    if not SHARED.is_dir():
        return [bumpy_sphere(6)]
    return [resized(read_case("igea-16k"), 50_000, 1), read_case("elephant-genus3")]


def growing_cases(largest: int) -> Iterator[Case]:
    """From 5,000 to a million triangles, one by one: the last ones fill memory."""
    if not SHARED.is_dir():
        yield from (bumpy_sphere(level) for level in range(5, 9) if 8 * 4**level <= largest)
        return
    yield from (case for case in map(read_case, ("hand-5k", "fandisk")) if len(case.triangles) <= largest)
    head = read_case("max-planck-25k")
    for triangles, subdivisions, cone_counts in SIZES:
        if triangles <= largest:
            case = resized(head, triangles, subdivisions)
            yield case
            yield from (with_random_cones(case, count) for count in cone_counts)


def cut_open(case: Case, cut_edges: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Positions and triangles of the surface opened along its cuts, which must leave one disk.

    Corners stay one vertex where a triangle's neighbor across an uncut edge shares them.
    """
    count = len(case.triangles)
    corner = np.arange(3 * count).reshape(count, 3)
    start, end = corner.ravel(), np.roll(corner, -1, axis=1).ravel()
    vertex = case.triangles.ravel().astype(np.int64)
    vertices = len(case.positions)
    low, high = np.minimum(vertex[start], vertex[end]), np.maximum(vertex[start], vertex[end])
    is_cut = np.isin(low * vertices + high, np.sort(cut_edges, axis=1).astype(np.int64) @ [vertices, 1])
    # An edge and its neighbor's run in opposite directions, so each one's start meets the other's end.
    order = np.lexsort((high, low))
    order = order[~is_cut[order]]
    twin = (low[order][:-1] == low[order][1:]) & (high[order][:-1] == high[order][1:])
    one, other = order[:-1][twin], order[1:][twin]
    glued = np.concatenate([start[one], end[one]]), np.concatenate([end[other], start[other]])
    graph = coo_array((np.ones(len(glued[0]), bool), glued), shape=(3 * count, 3 * count))
    copies, new_vertex = connected_components(graph, directed=False)
    old_vertex = np.empty(copies, np.int64)
    old_vertex[new_vertex] = vertex
    edges = (3 * count + int(is_cut.sum())) // 2
    if copies - edges + count != 1:
        raise SystemExit(f"benchmark: the cut of {case.name} does not open it into one disk, so LSCM is no comparison")
    return case.positions[old_vertex], new_vertex.reshape(count, 3).astype(np.int32)
