# SPDX-License-Identifier: GPL-3.0-or-later
"""How the time of a press grows with size on every kind of a library of generated meshes, as a table.

    python tools/library/library_growth.py [--preset paint] [--sizes 1000 3000 10000 30000] [--defects 0.05] [kind ...]

The same random numbers make a mesh of each kind at each size. Times are CPU seconds of choosing and packing; the power
is the exponent by which they grow, by least squares. Needs numpy and lsgp.
"""

from __future__ import annotations

import argparse
import time

import lsgp
import numpy as np
from library_kinds import KINDS
from library_shapes import Random, triangles_of, with_defects

SEED = [0xC0DE, 5]


def surface_of(kind: str, count: int, defects: float) -> lsgp.Surface:
    """A mesh of a kind, without triangles that repeat a vertex."""
    random = Random(SEED)
    mesh = KINDS[kind](random, count)
    if defects:
        mesh = with_defects(mesh, defects, random)
    triangles = triangles_of(mesh).astype(np.int32)
    has_corners = (triangles != np.roll(triangles, 1, axis=1)).all(axis=1)
    return lsgp.Surface(mesh.positions, triangles[has_corners])


def seconds_and_size(kind: str, count: int, preset: str, defects: float) -> tuple[float, int]:
    surface = surface_of(kind, count, defects)
    begin = time.process_time()
    lsgp.auto_unwrap(surface, preset=preset)
    return time.process_time() - begin, len(surface.triangles)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("kinds", nargs="*", metavar="kind")
    parser.add_argument("--preset", default="paint")
    parser.add_argument("--sizes", type=int, nargs="+", default=[1000, 3000, 10_000, 30_000])
    parser.add_argument("--defects", type=float, default=0.0, help="the share of faces with defects")
    arguments = parser.parse_args()
    print(f"| kind | {' | '.join(f'{size:,}' for size in arguments.sizes)} | power |")
    print(f"|---|{'--:|' * (len(arguments.sizes) + 1)}")
    for kind in arguments.kinds or KINDS:
        found = np.array(
            [seconds_and_size(kind, size, arguments.preset, arguments.defects) for size in arguments.sizes]
        )
        power = np.polyfit(np.log(found[:, 1]), np.log(np.maximum(found[:, 0], 1e-3)), 1)[0]
        print(f"| {kind} | {' | '.join(f'{seconds:.2f}' for seconds in found[:, 0])} | {power:.2f} |", flush=True)


if __name__ == "__main__":
    main()
