# SPDX-License-Identifier: GPL-3.0-or-later
"""Time of `lsgp.parameterize` beside libigl's LSCM on the same cut, and what rounding for seamless layouts adds to it,
as Markdown tables.

Both get arrays and give texture coordinates. lsgp also finds the cut, prescribes the cone angles and measures the map;
LSCM gets the surface cut open along lsgp's cut and two pins. Times are CPU seconds of all threads together (the stages'
are wall-clock), medians over repetitions that take turns, so that a busy machine hurts both alike. Needs numpy, scipy
and libigl beside lsgp.

    python tools/benchmark.py [--repetitions 9] [mesh ...]
"""

from __future__ import annotations

import argparse
import json
import os
import statistics
import sys
import time
from collections.abc import Callable
from pathlib import Path

import igl
import lsgp
import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

MESHES = ("cube-768", "hand-5k", "bird", "fandisk", "octa-flower", "igea-16k", "max-planck-25k")
SHARED = Path(__file__).resolve().parents[2] / "shared" / "meshes"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("meshes", nargs="*", metavar="mesh", help=f"of {', '.join(MESHES)}; all by default")
    parser.add_argument("--repetitions", type=int, default=9)
    arguments = parser.parse_args()
    os.environ["IGL_NUM_THREADS"] = "1"  # read at libigl's first parallel loop
    if SHARED.is_dir():
        cases = [(name, *read_case(name)) for name in arguments.meshes or MESHES]
    else:
        print(f"{SHARED} is not there: made surfaces instead.", file=sys.stderr)
        cases = [(f"bumpy sphere {level}", *bumpy_sphere(level)) for level in (3, 4, 5)]
    print_table([measure_case(*case, arguments.repetitions) for case in cases])
    print("\nRounding angles and translations, repair included, as a multiple of the whole unwrap without it:\n")
    print_table([measure_rounding(*case, arguments.repetitions) for case in cases])


def read_case(name: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Positions, triangles and cones of a shared mesh."""
    positions, triangles = igl.read_triangle_mesh(str(SHARED / f"{name}.obj"))
    cones = json.loads((SHARED / f"{name}.cones.json").read_text(encoding="utf-8"))["cones"]
    return positions, triangles, np.array(cones, np.int32)


def bumpy_sphere(level: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
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
    return positions * radius[:, None], triangles, np.arange(6, dtype=np.int32)


def cut_open(triangles: np.ndarray, cut_edges: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Triangles of the surface opened along its cuts, and the old vertex of every new one.

    Corners stay one vertex where a triangle's neighbour across an uncut edge shares them.
    """
    count = len(triangles)
    corner = np.arange(3 * count).reshape(count, 3)
    start, end = corner.ravel(), np.roll(corner, -1, axis=1).ravel()
    vertex = triangles.ravel().astype(np.int64)
    vertices = int(vertex.max()) + 1
    low, high = np.minimum(vertex[start], vertex[end]), np.maximum(vertex[start], vertex[end])
    is_cut = np.isin(low * vertices + high, np.sort(cut_edges, axis=1).astype(np.int64) @ [vertices, 1])
    # An edge and its neighbour's run in opposite directions, so each one's start meets the other's end.
    order = np.lexsort((high, low))
    order = order[~is_cut[order]]
    twin = (low[order][:-1] == low[order][1:]) & (high[order][:-1] == high[order][1:])
    one, other = order[:-1][twin], order[1:][twin]
    glued = np.concatenate([start[one], end[one]]), np.concatenate([end[other], start[other]])
    graph = coo_array((np.ones(len(glued[0]), bool), glued), shape=(3 * count, 3 * count))
    copies, new_vertex = connected_components(graph, directed=False)
    old_vertex = np.empty(copies, np.int64)
    old_vertex[new_vertex] = vertex
    return new_vertex.reshape(count, 3).astype(np.int64), old_vertex


def far_pins(positions: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Two border vertices far from each other, as libigl's own examples pin."""
    border = igl.boundary_loop(triangles)
    first = border[0]
    second = border[np.argmax(np.linalg.norm(positions[border] - positions[first], axis=1))]
    return np.array([first, second], np.int64)


def measure_case(
    name: str, positions: np.ndarray, triangles: np.ndarray, cones: np.ndarray, repetitions: int
) -> dict[str, object]:
    surface = lsgp.Surface(positions, triangles.astype(np.int32))
    stages: list[dict[str, float]] = []

    def ours() -> None:
        stages.append(lsgp.parameterize(surface, cones).stage_seconds)

    result = lsgp.parameterize(surface, cones)
    disk, old_vertex = cut_open(triangles, result.cut_edges)
    opened = np.ascontiguousarray(positions[old_vertex])
    if len(opened) - len(igl.edges(disk)) + len(disk) != 1:
        raise SystemExit(f"benchmark: the cut of {name} does not open it into one disk, so LSCM is no comparison")
    pins, targets = far_pins(opened, disk), np.array([[0.0, 0.0], [1.0, 0.0]])

    def theirs() -> None:
        igl.lscm(opened, disk, pins, targets)

    theirs()
    times = [(cpu_seconds(ours), cpu_seconds(theirs)) for _ in range(repetitions)]
    own, lscm = (statistics.median(column) for column in zip(*times, strict=True))
    return {
        "mesh": name,
        "triangles": f"{len(triangles):,}",
        "cones": len(cones),
        "lsgp ms": f"{1e3 * own:.1f}",
        "igl.lscm ms": f"{1e3 * lscm:.1f}",
        "ratio": f"{own / lscm:.2f}",
        **{f"{stage} ms": f"{1e3 * statistics.median(s[stage] for s in stages):.1f}" for stage in stages[0]},
    }


def measure_rounding(
    name: str, positions: np.ndarray, triangles: np.ndarray, cones: np.ndarray, repetitions: int
) -> dict[str, object]:
    surface = lsgp.Surface(positions, triangles.astype(np.int32))
    grids = {"32 tiles": 32, "64 tiles": 64, "automatic": None}
    options = [lsgp.Options()] + [lsgp.Options(seamless=lsgp.Seamless(tiles=tiles)) for tiles in grids.values()]
    runs = [lambda chosen=chosen: lsgp.parameterize(surface, cones, options=chosen) for chosen in options]
    for run in runs:
        run()
    times = [[cpu_seconds(run) for run in runs] for _ in range(repetitions)]
    plain, *seamless = (statistics.median(column) for column in zip(*times, strict=True))
    row: dict[str, object] = {"mesh": name, "cones": len(cones), "unwrap ms": f"{1e3 * plain:.1f}"}
    return row | {grid: f"{(time - plain) / plain:.2f}" for grid, time in zip(grids, seamless, strict=True)}


def cpu_seconds(run: Callable[[], None]) -> float:
    before = time.process_time()
    run()
    return time.process_time() - before


def print_table(rows: list[dict[str, object]]) -> None:
    columns = list(dict.fromkeys(column for row in rows for column in row))
    print("| " + " | ".join(columns) + " |")
    print("|---" + "|--:" * (len(columns) - 1) + "|")
    for row in rows:
        print("| " + " | ".join(str(row.get(column, "")) for column in columns) + " |")


if __name__ == "__main__":
    main()
