# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's QuadriFlow on one surface, for `quad_meshes.py`; needs a Python with bpy.

    python tools/benchmark/quads_in_blender.py SURFACE.npz QUADS MESH.npz

SURFACE.npz: positions (n, 3), triangles (m, 3). MESH.npz receives positions (v, 3), faces (q, 4) of four vertices,
others, the number of the rest, and seconds, of wall time; there are no faces if QuadriFlow gives up.
"""

from __future__ import annotations

import sys
import time
from pathlib import Path

import bpy
import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))
from bpy_program import run_as_program


def remesh(positions: np.ndarray, triangles: np.ndarray, quads: int) -> tuple[bpy.types.Mesh, float]:
    """Creases and borders are kept, as QuadriFlow can; no symmetry."""
    mesh = bpy.data.meshes.new("surface")
    mesh.from_pydata(positions.tolist(), [], triangles.tolist())
    surface = bpy.data.objects.new("surface", mesh)
    bpy.context.scene.collection.objects.link(surface)
    bpy.context.view_layer.objects.active = surface
    surface.select_set(True)
    before = time.perf_counter()
    done = bpy.ops.object.quadriflow_remesh(
        mode="FACES", target_faces=quads, use_preserve_sharp=True, use_preserve_boundary=True
    )
    seconds = time.perf_counter() - before
    return (surface.data if "FINISHED" in done else bpy.data.meshes.new("none")), seconds


def main(source: str, quads: str, target: str) -> None:
    arrays = np.load(source)
    mesh, seconds = remesh(arrays["positions"], arrays["triangles"], int(quads))
    positions = np.array([vertex.co for vertex in mesh.vertices]).reshape(-1, 3)
    faces = np.array([list(face.vertices) for face in mesh.polygons if len(face.vertices) == 4], np.int64)
    others = len(mesh.polygons) - len(faces)
    np.savez(target, positions=positions, faces=faces.reshape(-1, 4), others=others, seconds=seconds)


if __name__ == "__main__":
    run_as_program(lambda: main(*sys.argv[1:]))
