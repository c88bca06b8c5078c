# SPDX-License-Identifier: GPL-3.0-or-later
"""One of Blender's unwraps on one surface, for `benchmark.py` and `presets.py`; needs a Python with bpy.

    python tools/benchmark/benchmark_in_blender.py SURFACE.npz METHOD [MAP.npz]

SURFACE.npz: positions (n, 3), triangles (m, 3), seams (s, 2). METHOD: ANGLE_BASED, CONFORMAL, MINIMUM_STRETCH, or
SMART_PROJECT, which takes no seams. For every line "run" on the standard input it unwraps once and writes
"RESULT {"seconds": S}", the CPU seconds of all threads. MAP.npz receives corner_uv (m, 3, 2).
"""

from __future__ import annotations

import json
import sys
import time
from pathlib import Path

import bpy
import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))
from bpy_program import run_as_program

ITERATIONS = 10


def add_mesh(positions: np.ndarray, triangles: np.ndarray, seams: np.ndarray) -> bpy.types.Object:
    """An object in edit mode, all of it selected, with marked seams."""
    if bpy.context.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")
    mesh = bpy.data.meshes.new("surface")
    mesh.from_pydata(positions.tolist(), [], triangles.tolist())
    ends = np.empty(2 * len(mesh.edges), np.int32)
    mesh.edges.foreach_get("vertices", ends)
    keys = np.sort(ends.reshape(-1, 2), axis=1).astype(np.int64) @ [len(positions), 1]
    mesh.edges.foreach_set("use_seam", np.isin(keys, np.sort(seams, axis=1).astype(np.int64) @ [len(positions), 1]))
    mesh.uv_layers.new(name="uv")
    surface = bpy.data.objects.new("surface", mesh)
    bpy.context.scene.collection.objects.link(surface)
    bpy.context.view_layer.objects.active = surface
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    return surface


def unwrap(method: str) -> float:
    chosen = {"iterations": ITERATIONS} if method == "MINIMUM_STRETCH" else {}
    before = time.process_time()
    if method == "SMART_PROJECT":
        bpy.ops.uv.smart_project()
    else:
        bpy.ops.uv.unwrap(method=method, **chosen)
    return time.process_time() - before


def read_map(surface: bpy.types.Object) -> np.ndarray:
    bpy.ops.object.mode_set(mode="OBJECT")
    corner_uv = np.empty(2 * len(surface.data.loops), np.float32)
    surface.data.uv_layers.active.uv.foreach_get("vector", corner_uv)
    bpy.ops.object.mode_set(mode="EDIT")
    return corner_uv.reshape(-1, 3, 2).astype(np.float64)


def main(source: str, method: str, target: str | None = None) -> None:
    arrays = np.load(source)
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    add_mesh(np.eye(3), np.array([[0, 1, 2]]), np.empty((0, 2), int))
    unwrap(method)  # the first one in a process takes longer
    surface = add_mesh(arrays["positions"], arrays["triangles"], arrays["seams"])
    for _ in sys.stdin:
        seconds = unwrap(method)
        if target is not None:
            np.savez(target, corner_uv=read_map(surface))
        print("RESULT " + json.dumps({"seconds": seconds}), flush=True)


if __name__ == "__main__":
    run_as_program(lambda: main(*sys.argv[1:]))
