# SPDX-License-Identifier: GPL-3.0-or-later
"""Lookups at both sides of cuts of a noise texture baked by Blender, for gutters of several kinds, as a Markdown table.

    PYTHONPATH=tests python tools/benchmark/gutter_noise.py --blender-python PYTHON [--margin N] [--size N ...]

The mean difference of bilinear lookups at both sides of all cuts, divided by that of adjacent texels inside islands at
the same mip level: the median of six meshes and the largest. Needs the lsgp wheel with xatlas, scipy, and a Python with
bpy, whose Cycles bakes.
"""

from __future__ import annotations

import argparse
import subprocess
import tempfile
from pathlib import Path

import lsgp
import meshes
import numpy as np
from gutter_checks import both_sides, difference_of_neighbors, lookup, mips, smeared
from map_checks import surface

FloatArray = np.ndarray

MESHES = (
    *(meshes.bumpy_sphere(3), meshes.flower(3), meshes.torus()),
    *(meshes.double_torus(), meshes.forked(3), meshes.ellipsoid(3)),
)
LEVELS = 4
WORKER = Path(__file__).with_name("gutters_in_blender.py")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--blender-python", metavar="PYTHON", required=True)
    parser.add_argument("--margin", type=int, default=16, help="of the gutters (default: 16)")
    parser.add_argument("--size", type=int, nargs="+", default=[1024, 2048], help="of textures (default: 1024 2048)")
    arguments = parser.parse_args()
    columns = [f"{size}: {level}" for size in arguments.size for level in range(LEVELS)]
    print(f"| gutters | {' | '.join(columns)} |")
    print(f"|---|{'--:|' * len(columns)}")
    found: dict[str, list[list[float]]] = {}
    for mesh in MESHES:
        of_mesh: dict[str, list[float]] = {}
        for size in arguments.size:
            for kind, ratios in compared(surface(mesh), size, arguments).items():
                of_mesh.setdefault(kind, []).extend(ratios)
        for kind, ratios in of_mesh.items():
            found.setdefault(kind, []).append(ratios)
    for kind, ratios in found.items():
        median, most = np.median(ratios, axis=0), np.max(ratios, axis=0)
        print(f"| {kind} | {' | '.join(map(shown, median, most))} |")


def compared(whole: lsgp.Surface, size: int, arguments: argparse.Namespace) -> dict[str, list[float]]:
    """The ratios at all levels, by kind of gutters."""
    uv = lsgp.auto_unwrap(whole, preset="bake", pack="tight", margin=arguments.margin / size).corner_uv
    baked = bake(whole, uv, size, arguments)
    empty, covered = baked["empty"].astype(np.float64), baked["covered"]
    # On edges the texels that a baker covers may differ from the library's by one: it is given those with a margin.
    extended = baked["extend"].astype(np.float64)
    wide = [arguments.margin / 2**level for level in range(LEVELS)]
    pyramids = {
        "empty": boxes(empty),
        "nearest texel": boxes(smeared(empty, covered, arguments.margin)),
        "Blender, *Extend*": boxes(extended),
        "Blender, *Adjacent Faces*": boxes(baked["adjacent"].astype(np.float64)),
        "beyond the cut": boxes(lsgp.pad_image(extended, whole, uv, arguments.margin)),
        "the same, each level": lsgp.pad_mip_levels(extended, whole, uv, wide),
    }
    inside = [
        difference_of_neighbors(level, share == 1)
        for level, share in zip(boxes(empty), boxes(covered.astype(float)), strict=True)
    ]
    left, right, _ = both_sides(whole, uv, 1 / size)
    return {
        kind: [
            float(np.abs(lookup(level, left) - lookup(level, right)).mean()) / neighbors
            for level, neighbors in zip(levels, inside, strict=True)
        ]
        for kind, levels in pyramids.items()
    }


def bake(whole: lsgp.Surface, uv: FloatArray, size: int, arguments: argparse.Namespace) -> dict[str, FloatArray]:
    """What the worker writes."""
    with tempfile.TemporaryDirectory() as folder:
        source, target = Path(folder, "surface.npz"), Path(folder, "images.npz")
        np.savez(source, positions=whole.positions, triangles=whole.triangles, corner_uv=uv)
        call = [arguments.blender_python, WORKER, source, str(size), str(arguments.margin), target]
        subprocess.run(call, check=True, stdout=subprocess.DEVNULL)
        with np.load(target) as images:
            return dict(images)


def boxes(image: FloatArray) -> list[FloatArray]:
    """The mip levels that are looked at."""
    return [level for level, _ in zip(mips(image), range(LEVELS), strict=False)]


def shown(*ratios: float) -> str:
    return ", ".join(f"{ratio:.2f}" if ratio < 10 else f"{ratio:.0f}" for ratio in ratios)


if __name__ == "__main__":
    main()
