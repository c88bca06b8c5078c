# SPDX-License-Identifier: GPL-3.0-or-later
"""Unwrap a mesh in several ways, keep the best map, and say why: python best_map.py model.obj best.obj

An example of the Python interface, checked with mypy --strict and pyright.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import lsgp
import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class Candidate:
    """A map and how it was made."""

    name: str
    result: lsgp.Result

    @property
    def cost(self) -> tuple[int, float]:
        """Defects first, then stretch."""
        defects = len(self.result.flipped) + len(self.result.wrong_angle_sums) + len(self.result.overlapping)
        return defects, self.result.distortion.l2_stretch


def show(done: float) -> bool:
    """Progress from 0 to 1; False would cancel."""
    print(f"\r{100 * done:3.0f} %", end="", file=sys.stderr)
    return True


def candidates(surface: lsgp.Surface) -> Iterator[Candidate]:
    """Maps of the surface, by one `Solver` where they share their cones."""
    placed = lsgp.place_cones(surface, target=1.05, progress=show)
    solver = lsgp.Solver(surface)
    options = {
        "conformal": lsgp.Options(overlaps="split"),
        "low stretch": lsgp.Options(mode="low-stretch", overlaps="split"),
        "seamless": lsgp.Options(seamless=lsgp.Seamless(tiles=16)),
    }
    for name, chosen in options.items():
        try:
            yield Candidate(name, solver.parameterize(placed.cones, placed.cone_angles, chosen))
        except lsgp.LsgpError as error:
            print(f"{name}: {error.code}: {error.message}", file=sys.stderr)
    yield Candidate("paint", lsgp.auto_unwrap(surface, preset="paint"))


def longest_edge(surface: lsgp.Surface) -> float:
    """On the surface."""
    corners: NDArray[np.float64] = surface.positions[surface.triangles]
    return float(np.linalg.norm(corners - np.roll(corners, -1, axis=1), axis=2).max())


def main(source: Path, target: Path) -> None:
    file = lsgp.read_mesh_file(source)
    surface = file.surface()
    best = min(candidates(surface), key=lambda candidate: candidate.cost)
    for finding in best.result.warnings:
        print(f"{finding.code}: {finding.message}", file=sys.stderr)
    lsgp.write_mesh_file(target, file, best.result.corner_uv)
    texels = lsgp.texel_density(surface, best.result.corner_uv, 2048)
    measured = lsgp.measure_distortion(surface, best.result.corner_uv)
    print(f"{target}: {best.name}, L2 stretch {measured.distortion.l2_stretch:.3f}, {texels.mean:.0f} texels per unit")
    print(f"the longest edge has {texels.mean * longest_edge(surface):.0f} texels")


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
