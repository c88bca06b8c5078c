# SPDX-License-Identifier: GPL-3.0-or-later
"""How well quads have the density that is asked for: a Markdown table.

    PYTHONPATH=tests python tools/benchmark/quad_density.py [PATH ...] [--quads N]

PATH is an OBJ or OFF file of a closed surface (default: some of ../shared/meshes, and generated ones). *Ramp*: from 1
to 16 along the longest axis. *Spot*: up to 16 times as many around the last point on it. Sizes are the areas of quads
times the density: their standard deviation relative to the mean. *Valid* as in quad_validity.py. Needs the lsgp wheel
and scipy.
"""

from __future__ import annotations

import argparse
import time
from pathlib import Path

import lsgp
import meshes
import numpy as np
from numpy.typing import NDArray
from placement_quality import SHARED, read_surface
from quad_validity import defects

Floats = NDArray[np.float64]
FILES = ("kitten-genus1", "hand-5k", "igea-16k", "bird", "eight-genus2", "fandisk", "cube-768")
MADE = {"sphere": lambda: meshes.icosphere(4), "torus": lambda: meshes.torus(72, 36)}
SPREAD = 0.15  # of the spot, of the diagonal
COLUMNS = ("mesh", "density", "quads", "irregular", "L2 stretch", "sizes, without", "with", "valid", "s")


def densities(surface: lsgp.Surface) -> dict[str, Floats]:
    size = np.ptp(surface.positions, axis=0)
    along = surface.positions[:, np.argmax(size)]
    away = np.linalg.norm(surface.positions - surface.positions[np.argmax(along)], axis=1) / np.linalg.norm(size)
    return {"ramp": 16 ** ((along - along.min()) / size.max()), "spot": 1 + 15 * np.exp(-((away / SPREAD) ** 2))}


def deviation(surface: lsgp.Surface, density: Floats, mesh: lsgp.QuadMesh) -> float:
    """Of the areas of quads times the density."""
    a, b, c, d = mesh.positions[mesh.quads].transpose(1, 0, 2)
    at_vertices = (mesh.weights * np.log(density)[surface.triangles[mesh.triangles]]).sum(axis=1)
    sizes = np.linalg.norm(np.cross(c - a, d - b), axis=1) / 2 * np.exp(at_vertices[mesh.quads].mean(axis=1))
    return float(sizes.std() / sizes.mean())


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("paths", nargs="*", metavar="PATH", type=Path)
    parser.add_argument("--quads", metavar="N", type=int, default=2000)
    arguments = parser.parse_args()
    paths = arguments.paths or [SHARED / f"{name}.obj" for name in FILES]
    surfaces = {path.stem: read_surface(path) for path in paths}
    if not arguments.paths:
        surfaces |= {name: lsgp.Surface(*make()[:2]) for name, make in MADE.items()}
    print(f"| {' | '.join(COLUMNS)} |\n|---|---|{'--:|' * 5}---|--:|")
    for name, surface in surfaces.items():
        plain = lsgp.remesh_to_quads(surface, target=arguments.quads)
        for kind, density in densities(surface).items():
            begin = time.process_time()
            made = lsgp.remesh_to_quads(surface, target=arguments.quads, density=density)
            seconds = time.process_time() - begin
            without, with_density = (deviation(surface, density, of.mesh) for of in (plain, made))
            irregular = f"{len(plain.mesh.irregular)} → {len(made.mesh.irregular)}"
            figures = f"{made.layout.distortion.l2_stretch:.3f} | {without:.2f} | {with_density:.2f}"
            valid = defects(surface, made) or "yes"
            cells = f"{name} | {kind} | {len(made.mesh.quads)} | {irregular} | {figures} | {valid} | {seconds:.1f}"
            print(f"| {cells} |", flush=True)


if __name__ == "__main__":
    main()
