# SPDX-License-Identifier: GPL-3.0-or-later
"""Quads that follow the creases of hard surfaces beside quads that do not: a Markdown table.

    PYTHONPATH=tests python tools/benchmark/quad_creases.py [--quads N] [FOLDER]

FOLDER holds closed meshes (default: ../shared/meshes); those that are missing are left out. Needs the lsgp wheel and
scipy.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Iterator
from pathlib import Path

import lsgp
import numpy as np
from meshes import Mesh
from placement_quality import SHARED
from quad_meshes import Quads, irregular, kept_share
from zoo import closed, swept

FILES = ("fandisk.obj", "hard/joint.off", "hard/spool.off", "hard/pinion.off", "hard/anchor.off")


def turned(radius: np.ndarray, height: float, around: int) -> Mesh:
    return closed.lathe(radius, np.linspace(0, height, len(radius)), around, caps=(True, True))


SOLIDS = {
    "cylinder": closed.prism(24, 4, 2),
    "frustum": turned(np.linspace(1, 0.6, 5), 2, 24),
    "barrel": turned(1 + 0.15 * np.sin(np.linspace(0, np.pi, 13)), 2.4, 32),
    "hexagonal prism": closed.prism(6, 4, 2),
    "beveled block": closed.beveled_box(6, 0.15, (1, 1.3, 0.8)),
    "gear of five teeth": closed.gear(5, 0.3, 2),
    "gear of twelve teeth": closed.gear(12, 0.25, 2),
    "bent pipe": swept.pipe(24, 16, 1.2, True),
}


def models(folder: Path) -> Iterator[tuple[str, lsgp.Surface]]:
    for file in FILES:
        if (folder / file).is_file():
            yield Path(file).stem, lsgp.read_mesh_file(str(folder / file)).surface()
    for name, mesh in SOLIDS.items():
        yield name, lsgp.Surface(mesh.positions, mesh.triangles)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", metavar="FOLDER", nargs="?", type=Path, default=SHARED)
    parser.add_argument("--quads", metavar="N", type=int, default=2000)
    arguments = parser.parse_args()
    for name, surface in models(arguments.folder):
        kept, counts, corners, edges = [], [], [], []
        for straighten in (False, True):
            options = lsgp.Options(seamless=lsgp.Seamless(), straighten=straighten)
            begin = time.process_time()
            mesh = lsgp.remesh_to_quads(surface, target=arguments.quads, options=options).mesh
            seconds = time.process_time() - begin
            quads = Quads(mesh.positions, mesh.quads.astype(np.int64), 0, seconds)
            quality = lsgp.quad_quality(quads.positions, quads.faces)
            kept.append(f"{kept_share(surface, quads):.2f}")
            counts.append(str(irregular(quads)))
            corners.append(f"{np.degrees(quality.angle_error):.1f}°, {np.degrees(quality.worst_angle_error):.0f}°")
            edges.append(f"{100 * quality.edge_deviation:.0f} %")
        print(f"| {' | '.join([name, *kept, *counts, *corners, *edges, f'{seconds:.1f}'])} |", flush=True)


if __name__ == "__main__":
    main()
