# SPDX-License-Identifier: GPL-3.0-or-later
"""Unwraps a thousand meshes with automatic cones and checks every result as the tests do:
PYTHONPATH=tests python tools/benchmark/ordinary_meshes.py [COUNT]

The shared meshes where they are there, the small members of the zoo, then random mixtures up to COUNT. Prints how many
are unwrapped as the checks confirm, how many are refused and why, and every contradiction; the exit code is 1 with one.
"""

from __future__ import annotations

import sys
import time
from collections import defaultdict
from collections.abc import Iterator
from itertools import count, islice

import lsgp
import zoo
from outcome_check import error_faults, result_faults
from shared_meshes import shared_folder

LARGEST = 30000  # triangles
# There is nothing to unwrap: no face, none with an area, or no side of the surface.
NOTHING_THERE = {"EMPTY_MESH", "DEGENERATE_MESH", "NOT_ORIENTABLE"}


def surfaces() -> Iterator[tuple[str, lsgp.Surface]]:
    folder = shared_folder() / "meshes"
    for path in sorted([*folder.glob("*.obj"), *folder.glob("hard/*.off")]):
        yield path.stem, lsgp.read_mesh_file(path).surface()
    members = zoo.members("small")
    mixtures = (zoo.member(f"mixture-seed={seed}") for seed in count())
    for members_of in (members, mixtures):
        for member in members_of:
            mesh = member.mesh()
            yield member.name, lsgp.Surface(mesh.positions, mesh.triangles)


def main() -> int:
    wanted = int(sys.argv[1]) if len(sys.argv) > 1 else 1000
    refused: dict[str, list[str]] = defaultdict(list)
    contradicted: list[str] = []
    missed = confirmed = 0
    begin = time.perf_counter()
    small = ((name, surface) for name, surface in surfaces() if len(surface.triangles) <= LARGEST)
    for name, surface in islice(small, wanted):
        try:
            placed = lsgp.place_cones(surface)
            result = lsgp.parameterize(surface, placed.cones, placed.cone_angles)
            faults = result_faults(surface, result, lsgp.Options())
            missed += not placed.reached
        except lsgp.LsgpError as error:
            refused[error.code].append(name)
            faults = error_faults(surface, error)
        else:
            confirmed += not faults
        contradicted += [f"{name}: {fault}" for fault in faults]
    print(f"{confirmed} confirmed, {missed} of them said to miss the target, in {time.perf_counter() - begin:.0f} s")
    for code, names in sorted(refused.items()):
        kind = "nothing to unwrap" if code in NOTHING_THERE else "refused"
        print(f"{len(names)} {kind}, {code}: {', '.join(names[:12])}{' …' if len(names) > 12 else ''}")
    print(*contradicted, sep="\n")
    return bool(contradicted)


if __name__ == "__main__":
    sys.exit(main())
