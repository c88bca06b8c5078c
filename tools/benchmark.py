# SPDX-License-Identifier: GPL-3.0-or-later
"""Time of `lsgp.parameterize` as Markdown tables: beside libigl's LSCM on the same cut, what rounding for seamless
layouts adds to it, the shares of checks and repair, and low stretch beside Blender's Minimum Stretch.

All get arrays and give texture coordinates. lsgp also finds the cut, prescribes the cone angles and measures the map;
LSCM gets the surface cut open along lsgp's cut and two pins, Blender the surface with that cut marked as seams.
Times are CPU seconds of all threads together (the stages' are wall-clock), medians over repetitions that take turns, so
that a busy machine hurts both alike; Blender's are taken one after the other. Needs numpy, scipy and libigl beside
lsgp, and for the last table a Python with bpy, named by BPY_PYTHON or where tools/test puts it.

    python tools/benchmark.py [--repetitions 9] [mesh ...]
"""

from __future__ import annotations

import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import igl
import lsgp
import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

MESHES = ("cube-768", "hand-5k", "bird", "fandisk", "octa-flower", "igea-16k", "max-planck-25k")
ROOT = Path(__file__).resolve().parents[1]
SHARED = ROOT.parent / "shared" / "meshes"
DENSE_TRIANGLES = 50_000


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
    print(
        "\nShares of the whole unwrap, by wall-clock time: checks of flips, angle sums and seams are to take at "
        "most 5 %, local repair at most 20 %; overlaps are only searched for where the border crosses itself:\n"
    )
    print_table([measure_shares(*case, arguments.repetitions) for case in cases])
    print(
        "\nLow stretch beside Blender's Minimum Stretch with 10 iterations, on the same cut; sisters: largest ratio of "
        "the two sides of a cut edge:\n"
    )
    blender = find_blender()
    if blender is None:
        print("Blender is left out: no Python with bpy. Run tools/test once or name one in BPY_PYTHON.\n")
    print_table([measure_low_stretch(*case, min(3, arguments.repetitions), blender) for case in dense_cases()])


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


def dense_cases() -> list[tuple[str, np.ndarray, np.ndarray, np.ndarray]]:
    """Surfaces of about 50,000 triangles with their cones: one smoothly subdivided and decimated, one as it is."""
    if not SHARED.is_dir():
        return [("bumpy sphere 6", *bumpy_sphere(6))]
    coarse, triangles, cones = read_case("igea-16k")
    positions, triangles = igl.loop(coarse, triangles)
    positions, triangles, _, _ = igl.decimate(positions, triangles, DENSE_TRIANGLES)
    nearest = [int(np.argmin(np.linalg.norm(positions - coarse[cone], axis=1))) for cone in cones]
    igea = ("igea-16k, Loop subdivided and decimated", positions, triangles, np.array(nearest, np.int32))
    return [igea, ("elephant-genus3", *read_case("elephant-genus3"))]


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


def measure_shares(
    name: str, positions: np.ndarray, triangles: np.ndarray, cones: np.ndarray, repetitions: int
) -> dict[str, object]:
    surface = lsgp.Surface(positions, triangles.astype(np.int32))
    results = [lsgp.parameterize(surface, cones) for _ in range(repetitions)]
    whole = [sum(result.stage_seconds.values()) for result in results]
    row: dict[str, object] = {
        "mesh": name,
        "triangles": f"{len(triangles):,}",
        "unwrap ms": f"{1e3 * statistics.median(whole):.1f}",
        "flips before repair": results[0].repair.flipped_before,
    }
    for stage in ("check", "overlaps", "repair"):
        seconds = [result.stage_seconds.get(stage, 0.0) for result in results]
        row[f"{stage} ms"] = f"{1e3 * statistics.median(seconds):.2f}"
        row[f"{stage} %"] = f"{100 * statistics.median(s / w for s, w in zip(seconds, whole, strict=True)):.1f}"
    return row


def measure_low_stretch(
    name: str,
    positions: np.ndarray,
    triangles: np.ndarray,
    cones: np.ndarray,
    repetitions: int,
    blender: str | None,
) -> dict[str, object]:
    surface = lsgp.Surface(positions, triangles.astype(np.int32))
    options = lsgp.Options(mode="low-stretch")
    result = lsgp.parameterize(surface, cones, options=options)
    own = statistics.median(
        cpu_seconds(lambda: lsgp.parameterize(surface, cones, options=options)) for _ in range(repetitions)
    )
    row: dict[str, object] = {
        "mesh": name,
        "triangles": f"{len(triangles):,}",
        "cones": len(cones),
        "lsgp s": f"{own:.2f}",
        "lsgp L2": f"{result.distortion.l2_stretch:.4f}",
        "lsgp sisters": f"{result.seams.sister_ratio_max:.3f}",
    }
    if blender is None:
        return row
    corner_uv, seconds = minimum_stretch(blender, positions, triangles, result.cut_edges, repetitions)
    theirs = statistics.median(seconds)
    measured = lsgp.measure_distortion(surface, corner_uv)
    return row | {
        "Blender s": f"{theirs:.2f}",
        "Blender L2": f"{measured.distortion.l2_stretch:.4f}",
        "Blender sisters": f"{measured.seams.sister_ratio_max:.3f}",
        "Blender / lsgp": f"{theirs / own:.1f}",
    }


def find_blender() -> str | None:
    """A Python with bpy."""
    python = Path(os.environ.get("BPY_PYTHON") or ROOT / "build" / "bpy" / "bin" / "python")
    return str(python) if python.is_file() else None


def minimum_stretch(
    blender: str, positions: np.ndarray, triangles: np.ndarray, seams: np.ndarray, repetitions: int
) -> tuple[np.ndarray, np.ndarray]:
    """Blender's texture coordinates and the CPU seconds of each repetition."""
    with tempfile.TemporaryDirectory() as folder:
        source, target = Path(folder, "surface.npz"), Path(folder, "map.npz")
        np.savez(source, positions=positions, triangles=triangles, seams=seams)
        script = Path(__file__).with_name("benchmark_in_blender.py")
        command = [blender, str(script), str(source), str(target), str(repetitions)]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL, timeout=600)
        with np.load(target) as arrays:
            return arrays["corner_uv"], arrays["seconds"]


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
