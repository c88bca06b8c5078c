# SPDX-License-Identifier: GPL-3.0-or-later
"""One method on one surface in a process of its own, for `benchmark.py`; needs numpy, and lsgp or libigl.

    python tools/benchmark/benchmark_worker.py SURFACE.npz lsgp|edit|move|lscm CUT.npy

SURFACE.npz: positions (n, 3) and triangles (m, 3), and cones (k,) for all but lscm. For every line "run" on the
standard input it runs once and writes "RESULT {...}": seconds, the CPU seconds of all threads together; peak_mb, the
most memory this process has taken; stages, the wall-clock seconds of lsgp's stages, and flips and turns, what is wrong
with its map. CUT.npy receives the edges (c, 2) of lsgp's cut.
"""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Callable, Mapping
from itertools import cycle
from pathlib import Path

import numpy as np


def prepare_lsgp(arrays: Mapping[str, np.ndarray]) -> Callable[[], object]:
    """Least distortion, the Poisson map and its check; no repair."""
    import lsgp

    surface = lsgp.Surface(arrays["positions"], arrays["triangles"])
    return lambda: lsgp.parameterize(surface, arrays["cones"], options=lsgp.Options(repair=False))


def prepare_edit(arrays: Mapping[str, np.ndarray]) -> Callable[[], object]:
    """A twentieth of a turn is moved from one cone to another, and back."""
    import lsgp

    solver = lsgp.Solver(lsgp.Surface(arrays["positions"], arrays["triangles"]))
    first = solver.parameterize(arrays["cones"], options=lsgp.Options(repair=False))
    shift = np.zeros(len(first.cones))
    shift[:2] = np.pi / 10, -np.pi / 10
    edits = cycle([first.cone_angles + shift, first.cone_angles])
    return lambda: solver.parameterize(first.cones, next(edits).tolist(), lsgp.Options(repair=False))


def prepare_move(arrays: Mapping[str, np.ndarray]) -> Callable[[], object]:
    """One cone is moved to a neighboring vertex, and back; angles of least distortion."""
    import lsgp

    triangles, cones = arrays["triangles"], arrays["cones"]
    around = triangles[(triangles == cones[0]).any(axis=1)].ravel()
    moved = np.concatenate([np.setdiff1d(around, cones)[:1], cones[1:]])
    solver = lsgp.Solver(lsgp.Surface(arrays["positions"], triangles))
    solver.parameterize(cones, options=lsgp.Options(repair=False))
    places = cycle([moved, cones])
    return lambda: solver.parameterize(next(places), options=lsgp.Options(repair=False))


def prepare_lscm(arrays: Mapping[str, np.ndarray]) -> Callable[[], object]:
    """libigl's LSCM of a disk, pinned at two border vertices far from each other, as its own examples do."""
    import igl

    positions, triangles = np.ascontiguousarray(arrays["positions"]), arrays["triangles"].astype(np.int64)
    border = igl.boundary_loop(triangles)
    far = border[np.argmax(np.linalg.norm(positions[border] - positions[border[0]], axis=1))]
    pins, targets = np.array([border[0], far], np.int64), np.array([[0.0, 0.0], [1.0, 0.0]])
    return lambda: igl.lscm(positions, triangles, pins, targets)


PREPARE = {"lsgp": prepare_lsgp, "edit": prepare_edit, "move": prepare_move, "lscm": prepare_lscm}


def peak_mb() -> float | None:
    """Of this process alone: the maximum of getrusage includes the parent's."""
    status = Path("/proc/self/status")
    if not status.is_file():
        return None
    return next(int(line.split()[1]) for line in status.read_text().splitlines() if line.startswith("VmHWM")) / 1024


def main(source: str, method: str, cut: str) -> None:
    with np.load(source) as arrays:
        run = PREPARE[method](dict(arrays))
    for _ in sys.stdin:
        before = time.process_time()
        result = run()
        found = {"seconds": time.process_time() - before, "peak_mb": peak_mb()}
        if method == "lsgp":
            np.save(cut, result.cut_edges)
        if method != "lscm":
            found |= {"stages": result.stage_seconds, "flips": len(result.flipped)}
            found |= {"turns": len(result.wrong_angle_sums)}
        print("RESULT " + json.dumps(found), flush=True)


if __name__ == "__main__":
    main(*sys.argv[1:])
