# SPDX-License-Identifier: GPL-3.0-or-later
"""A library of meshes by formula, for long runs of `lsgp batch`: the same numbers give the same meshes.

    python tools/library/make_library.py FOLDER --count 10000
    python tools/library/make_library.py FOLDER --only 137 2048      # some of them again

Number by number each of ten kinds comes in turn, with 10 to 200,000 triangles, log-uniformly; three of ten meshes have
defects on up to 30 % of their faces: fins, faces that are there twice or turned around. The name of a file tells its
kind, its number and that share. Needs numpy.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np
from library_kinds import KINDS
from library_shapes import Polygons, Random, triangles_of, with_defects

LEAST, MOST = 10, 200_000
# Of the meshes have defects, of up to that share of their faces.
DEFECTIVE, MOST_DEFECTS = 0.3, 0.3
# One of so many is written as OFF, and one as STL, which tells no vertex from another.
OTHER_FORMAT = 10


def mesh_of(number: int, most: int = MOST) -> tuple[str, Polygons]:
    """The name, without a suffix, and the mesh of a number."""
    kind = list(KINDS)[number % len(KINDS)]
    random = Random([0xC0DE, number])
    count = int(LEAST * (most / LEAST) ** random.uniform())
    share = random.uniform(0, MOST_DEFECTS) if random.uniform() < DEFECTIVE else 0.0
    mesh = with_defects(KINDS[kind](random, count), share, random)
    defects = f"-{round(100 * share)}%" if share else ""
    return f"{kind}/{number:06}{defects}", mesh


def write(folder: Path, number: int, most: int) -> Path:
    name, mesh = mesh_of(number, most)
    suffix = {1: ".off", 2: ".stl"}.get(number // len(KINDS) % OTHER_FORMAT, ".obj")
    path = folder / f"{name}{suffix}"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes({".obj": obj, ".off": off, ".stl": stl}[suffix](mesh))
    return path


def obj(mesh: Polygons) -> bytes:
    lines = ["v {:.9g} {:.9g} {:.9g}".format(*at) for at in mesh.positions.tolist()]
    lines += ["f " + " ".join(map(str, face)) for block in mesh.faces for face in (block + 1).tolist()]
    return ("\n".join(lines) + "\n").encode()


def off(mesh: Polygons) -> bytes:
    lines = ["OFF", f"{len(mesh.positions)} {sum(map(len, mesh.faces))} 0"]
    lines += ["{:.9g} {:.9g} {:.9g}".format(*at) for at in mesh.positions.tolist()]
    lines += [f"{len(face)} " + " ".join(map(str, face)) for block in mesh.faces for face in block.tolist()]
    return ("\n".join(lines) + "\n").encode()


def stl(mesh: Polygons) -> bytes:
    corners = mesh.positions[triangles_of(mesh)].astype("<f4")
    record = np.zeros(len(corners), np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")]))
    record["corners"] = corners
    return bytes(80) + np.array(len(corners), "<u4").tobytes() + record.tobytes()


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--count", type=int, default=10_000, help="numbers from --first on (default: 10000)")
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--only", type=int, nargs="+", metavar="NUMBER", help="these numbers")
    parser.add_argument("--most", type=int, default=MOST, help=f"triangles (default: {MOST})")
    arguments = parser.parse_args()
    for number in arguments.only or range(arguments.first, arguments.first + arguments.count):
        print(write(arguments.folder, number, arguments.most))


if __name__ == "__main__":
    main()
