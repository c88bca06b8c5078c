# SPDX-License-Identifier: GPL-3.0-or-later
"""What seamless layouts, checks, repair and low stretch cost; a part of `benchmark.py`."""

from __future__ import annotations

import statistics
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import lsgp
import numpy as np
from benchmark_cases import Case
from benchmark_workers import blender_worker


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


def cpu_seconds(run: Callable[[], object]) -> float:
    before = time.process_time()
    run()
    return time.process_time() - before
