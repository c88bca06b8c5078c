# SPDX-License-Identifier: GPL-3.0-or-later
"""What threads, seamless layouts, checks, repair and low stretch cost; a part of `benchmark.py`."""

from __future__ import annotations

import statistics
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import lsgp
import numpy as np
from benchmark_cases import Case, cut_open
from benchmark_workers import blender_worker
from lsgp.triangles import singular_values, triangle_areas
from scipy import sparse
from scipy.sparse.linalg import splu

MOST_STEPS_OF_SLIM = 100
SAME_ENERGY = 1.02


def measure_rounding(case: Case, repetitions: int) -> dict[str, object]:
    surface = lsgp.Surface(case.positions, case.triangles)
    grids = {"32 tiles": 32, "64 tiles": 64, "automatic": None}
    options = [lsgp.Options()] + [lsgp.Options(seamless=lsgp.Seamless(tiles=tiles)) for tiles in grids.values()]
    runs = [lambda chosen=chosen: lsgp.parameterize(surface, case.cones, options=chosen) for chosen in options]
    for run in runs:
        run()
    times = [[cpu_seconds(run) for run in runs] for _ in range(repetitions)]
    plain, *seamless = (statistics.median(column) for column in zip(*times, strict=True))
    row: dict[str, object] = {"mesh": case.name, "cones": len(case.cones), "unwrap ms": f"{1e3 * plain:.1f}"}
    return row | {grid: f"{(time - plain) / plain:.2f}" for grid, time in zip(grids, seamless, strict=True)}


def measure_shares(case: Case, repetitions: int) -> dict[str, object]:
    surface = lsgp.Surface(case.positions, case.triangles)
    results = [lsgp.parameterize(surface, case.cones) for _ in range(repetitions)]
    whole = [sum(result.stage_seconds.values()) for result in results]
    row: dict[str, object] = {
        "mesh": case.name,
        "triangles": f"{len(case.triangles):,}",
        "unwrap ms": f"{1e3 * statistics.median(whole):.1f}",
        "flips before repair": results[0].repair.flipped_before,
        "overlapping": len(results[0].overlapping),
    }
    for stage in ("check", "overlaps", "repair"):
        seconds = [result.stage_seconds.get(stage, 0.0) for result in results]
        row[f"{stage} ms"] = f"{1e3 * statistics.median(seconds):.2f}"
        row[f"{stage} %"] = f"{100 * statistics.median(s / w for s, w in zip(seconds, whole, strict=True)):.1f}"
    return row


def measure_low_stretch(case: Case, repetitions: int, blender: str | None) -> dict[str, object]:
    surface = lsgp.Surface(case.positions, case.triangles)
    options = lsgp.Options(mode="low-stretch")
    result = lsgp.parameterize(surface, case.cones, options=options)
    own = statistics.median(
        cpu_seconds(lambda: lsgp.parameterize(surface, case.cones, options=options)) for _ in range(repetitions)
    )
    row: dict[str, object] = {
        "mesh": case.name,
        "triangles": f"{len(case.triangles):,}",
        "cones": len(case.cones),
        "lsgp s": f"{own:.2f}",
        "lsgp L2": f"{result.distortion.l2_stretch:.4f}",
        "lsgp mismatch": f"{result.seams.sister_ratio_max - 1:.3f}",
    }
    if blender is None:
        return row
    corner_uv, seconds = minimum_stretch(blender, case, result.cut_edges, repetitions)
    theirs = statistics.median(seconds)
    measured = lsgp.measure_distortion(surface, corner_uv)
    return row | {
        "Blender s": f"{theirs:.2f}",
        "Blender L2": f"{measured.distortion.l2_stretch:.4f}",
        "Blender mismatch": f"{measured.seams.sister_ratio_max - 1:.3f}",
        "Blender / lsgp": f"{theirs / own:.1f}",
    }


def minimum_stretch(blender: str, case: Case, seams: np.ndarray, repetitions: int) -> tuple[np.ndarray, list[float]]:
    """Blender's texture coordinates and the CPU seconds of each repetition."""
    with tempfile.TemporaryDirectory() as folder:
        target = Path(folder, "map.npz")
        worker = blender_worker(blender, case, seams, "MINIMUM_STRETCH", Path(folder), target)
        runs = [worker.run() for _ in range(repetitions)]
        worker.close()
        if None in runs:
            raise SystemExit(f"benchmark: Blender did not survive {case.name}")
        with np.load(target) as arrays:
            return arrays["corner_uv"], [run["seconds"] for run in runs]


def measure_threads(case: Case, repetitions: int) -> dict[str, object]:
    """Wall-clock seconds of the whole map on one thread and on two."""
    surface = lsgp.Surface(case.positions, case.triangles)
    seconds: dict[int, list[float]] = {1: [], 2: []}
    maps = {}
    for _ in range(repetitions):
        for threads, found in seconds.items():
            begin = time.perf_counter()
            options = lsgp.Options(repair=False, threads=threads)
            maps[threads] = lsgp.parameterize(surface, case.cones, options=options).corner_uv
            found.append(time.perf_counter() - begin)
    one, two = (statistics.median(found) for found in seconds.values())
    return {
        "mesh": case.name,
        "triangles": f"{len(case.triangles):,}",
        "cones": len(case.cones),
        "one thread s": f"{one:.2f}",
        "two threads s": f"{two:.2f}",
        "ratio": f"{one / two:.2f}",
        "same bytes": maps[1].tobytes() == maps[2].tobytes(),
    }


def measure_slim(case: Case) -> dict[str, object]:
    """libigl's SLIM (Rabinovich et al. 2017) from Tutte's map of the same disk, until its energy is within 2 % of that
    of lsgp, whose map is continuous across the cuts besides."""
    surface = lsgp.Surface(case.positions, case.triangles)
    result: lsgp.Result | None = None

    def unwrap() -> None:
        nonlocal result
        result = lsgp.parameterize(surface, case.cones, options=lsgp.Options(mode="low-stretch"))

    own = cpu_seconds(unwrap)
    energy = symmetric_dirichlet(surface, result.corner_uv)
    steps, theirs, reached = run_slim(*cut_open(case, result.cut_edges), SAME_ENERGY * energy)
    return {
        "mesh": case.name,
        "triangles": f"{len(case.triangles):,}",
        "cones": len(case.cones),
        "lsgp s": f"{own:.2f}",
        "lsgp energy": f"{energy:.4f}",
        "SLIM s": f"{theirs:.2f}",
        "SLIM steps": steps,
        "SLIM energy": f"{reached:.4f}",
        "SLIM / lsgp": f"{theirs / own:.1f}",
    }


def run_slim(positions: np.ndarray, triangles: np.ndarray, wanted: float) -> tuple[int, float, float]:
    """Steps, CPU seconds, and the energy after them."""
    import igl

    positions = positions * np.sqrt(np.pi / triangle_areas(lsgp.Surface(positions, triangles)).sum())  # as the disk
    faces = triangles.astype(np.int32)
    surface = lsgp.Surface(positions, faces)
    border = igl.boundary_loop(faces.astype(np.int64))
    around = 2 * np.pi * np.arange(len(border)) / len(border)
    disk = tutte(faces, border, np.stack([np.cos(around), np.sin(around)], axis=1))
    none, nowhere = np.empty(0, np.int32), np.empty((0, 2), order="F")
    begin = time.process_time()
    data = igl.slim_precompute(
        np.asfortranarray(positions), np.asfortranarray(faces), disk, igl.SYMMETRIC_DIRICHLET, none, nowhere, 0.0
    )
    seconds, energy, steps = time.process_time() - begin, np.inf, 0
    while energy > wanted and steps < MOST_STEPS_OF_SLIM:
        steps += 1
        begin = time.process_time()
        places = igl.slim_solve(data, 1)
        seconds += time.process_time() - begin
        energy = symmetric_dirichlet(surface, places[faces, :2])
    return steps, seconds, energy


def tutte(triangles: np.ndarray, border: np.ndarray, places: np.ndarray) -> np.ndarray:
    """(n, 2) column-major: every inner vertex at the mean of its neighbors."""
    ends = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    count = int(triangles.max()) + 1
    joined = sparse.coo_array((np.ones(len(ends)), ends.T), (count, count)).tocsr()
    joined = ((joined + joined.T) > 0).astype(float)
    out = np.empty((count, 2), order="F")
    out[border] = places
    inner = np.setdiff1d(np.arange(count), border)
    form = (sparse.diags_array(joined.sum(axis=1)) - joined).tocsr()[inner]
    out[inner] = splu(form[:, inner].tocsc()).solve(-(form[:, border] @ places))
    return out


def symmetric_dirichlet(surface: lsgp.Surface, corner_uv: np.ndarray) -> float:
    """Of the map at the scale that suits it best, per area; 4 without any stretch."""
    areas = triangle_areas(surface)
    largest, smallest = singular_values(surface, corner_uv)
    grown = np.average(largest**2 + smallest**2, weights=areas)
    shrunk = np.average(largest**-2.0 + smallest**-2.0, weights=areas)
    return float(2 * np.sqrt(grown * shrunk))


def cpu_seconds(run: Callable[[], object]) -> float:
    before = time.process_time()
    run()
    return time.process_time() - before
