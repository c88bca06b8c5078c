# SPDX-License-Identifier: GPL-3.0-or-later
"""Time of placing 25 cones, as a multiple of libigl's LSCM on the same mesh: a Markdown table.

LSCM gets the surface as it is and two pins. Times are CPU seconds of all threads together, the least of repetitions
that take turns. Needs numpy and libigl beside lsgp; denser surfaces are subdivided ones.

    python tools/benchmark/placement_benchmark.py [--repetitions 3] [mesh ...]
"""

from __future__ import annotations

import argparse
import os
from pathlib import Path

import igl
import lsgp
import numpy as np
from benchmark import as_table
from benchmark_cases import SHARED, bumpy_sphere, read_case
from benchmark_options import cpu_seconds

CONES = 25
MOST = 6  # times LSCM
SUBDIVISIONS = 2
MESH = "fandisk"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("meshes", nargs="*", metavar="mesh", help=f"of {Path('../shared/meshes')}; {MESH} by default")
    parser.add_argument("--repetitions", type=int, default=3)
    arguments = parser.parse_args()
    os.environ["IGL_NUM_THREADS"] = "1"  # read at libigl's first parallel loop
    cases = [read_case(name) for name in arguments.meshes or [MESH]] if SHARED.is_dir() else [bumpy_sphere(5)]
    rows = []
    for case in cases:
        positions, triangles = case.positions, case.triangles.astype(np.int64)
        for _ in range(SUBDIVISIONS + 1):
            rows.append(measure_placement(case.name, positions, triangles, arguments.repetitions))
            positions, triangles = igl.upsample(positions, triangles)
    print(f"Placing {CONES} cones is to cost at most {MOST} times LSCM:\n")
    print(as_table(rows))


def measure_placement(
    name: str, positions: np.ndarray, triangles: np.ndarray, repetitions: int = 3, cones: int = CONES
) -> dict[str, object]:
    surface = lsgp.Surface(positions, triangles)
    pins = np.array([0, len(positions) // 2], np.int64)
    ends = np.array([[0.0, 0.0], [1.0, 0.0]])
    placing, mapping = [], []
    for _ in range(repetitions):
        placing.append(cpu_seconds(lambda: lsgp.place_cones(surface, count=cones)))
        mapping.append(cpu_seconds(lambda: igl.lscm(positions, triangles, pins, ends)))
    placed = lsgp.place_cones(surface, count=cones)
    return {
        "mesh": name,
        "triangles": len(triangles),
        "place s": f"{min(placing):.3f}",
        "lscm s": f"{min(mapping):.3f}",
        "ratio": f"{min(placing) / min(mapping):.2f}",
        "back-substitutions": placed.back_substitutions,
        "predicted L2": f"{placed.predicted_l2:.4f}",
    }


if __name__ == "__main__":
    main()
