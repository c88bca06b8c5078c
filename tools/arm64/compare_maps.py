# SPDX-License-Identifier: GPL-3.0-or-later
"""Maps of one machine compared with those of another: same cuts, and texture coordinates that differ by rounding only.

    python tools/arm64/compare_maps.py --write maps.npz       # on one
    python tools/arm64/compare_maps.py --compare maps.npz     # on the other

The exit code is 1 if any map differs by more than `MOST`, relative to the unit square that holds it."""

from __future__ import annotations

import argparse
import platform
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[2] / "tests"))

import meshes
from map_checks import unwrap

MOST = 1e-12
SURFACES = {
    "bumpy sphere": meshes.bumpy_sphere(3),
    "cube, many equal paths": meshes.cube(4),
    "two cubes": meshes.merge([meshes.cube(3)] * 2),
    "parts": meshes.merge([meshes.flower(2), meshes.disk_with_holes(12, 2), meshes.cylinder(8, 3)]),
    "equal islands": meshes.merge([meshes.cylinder(8, 3)] * 3),
}
OPTIONS: dict[str, dict[str, str]] = {
    "default": {},
    "spectral": {"unfold": "spectral"},
    "harmonic": {"prescription": "harmonic"},
    "low stretch": {"mode": "low-stretch"},
    "lscm": {"method": "lscm"},
}


def maps() -> Iterator[tuple[str, np.ndarray, np.ndarray]]:
    """Name, corner_uv and sorted cut_edges of every surface with every set of options."""
    for surface, mesh in SURFACES.items():
        for options, values in OPTIONS.items():
            result = unwrap(mesh, **values)
            yield f"{surface}, {options}", result.corner_uv, np.sort(result.cut_edges, axis=1)


def write(path: Path) -> None:
    arrays = {}
    for name, uv, cuts in maps():
        arrays |= {f"{name}/uv": uv, f"{name}/cuts": cuts}
    np.savez(path, **arrays)


def compare(path: Path) -> int:
    """The number of maps that differ."""
    differing = 0
    with np.load(path) as other:
        for name, uv, cuts in maps():
            same_cuts = np.array_equal(cuts, other[f"{name}/cuts"])
            gap = float(np.abs(uv - other[f"{name}/uv"]).max())
            differs = not (same_cuts and gap <= MOST)
            differing += differs
            verdict = "DIFFERS" if differs else "same"
            print(f"{verdict:8} {gap:8.1e} {'' if same_cuts else 'other cuts '}{name}", flush=True)
    print(f"{platform.machine()}: {differing} maps differ by more than {MOST}")
    return differing


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    task = parser.add_mutually_exclusive_group(required=True)
    task.add_argument("--write", type=Path, metavar="FILE", help="write this machine's maps")
    task.add_argument("--compare", type=Path, metavar="FILE", help="compare this machine's maps with written ones")
    arguments = parser.parse_args()
    if arguments.write:
        write(arguments.write)
    else:
        sys.exit(compare(arguments.compare) > 0)


if __name__ == "__main__":
    main()
