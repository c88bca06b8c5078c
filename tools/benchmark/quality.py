# SPDX-License-Identifier: GPL-3.0-or-later
"""Print the quality of our maps compared with the paper's Table 1, as Markdown.

    python tools/benchmark/quality.py [FOLDER]

FOLDER holds NAME.obj and NAME.cones.json (default: ../shared/meshes). Needs the lsgp wheel.
"""

from __future__ import annotations

import json
import sys
from dataclasses import dataclass
from pathlib import Path

import lsgp
from lsgp.io.mesh_files import read_mesh
from lsgp.io.polygons import triangulate

MESHES = ("cube-768", "fandisk", "octa-flower", "igea-16k", "max-planck-25k", "hand-5k", "bird")
RULES = ("least-distortion", "harmonic", "straightness")


@dataclass(frozen=True)
class Row:
    """The paper's measures, Table 1 of Vintescu et al. 2017; mismatch: its sister ratio minus 1."""

    quasi_conformal: float
    area: float
    area_p10: float
    area_p90: float
    mismatch: float
    l2_stretch: float


PAPER = {
    "fandisk": ("Fandisk", Row(1.017, 1.276, 0.606, 2.068, 1e-3, 1.132)),
    "octa-flower": ("Octa-flower", Row(1.016, 0.965, 0.808, 1.166, 2e-3, 1.010)),
    "igea-16k": ("Hygeia", Row(1.039, 1.235, 0.618, 2.123, 1.1e-2, 1.111)),
    "max-planck-25k": ("Planck, 47K", Row(1.026, 1.488, 0.516, 3.370, 7e-3, 1.273)),
}


def main() -> None:
    root = Path(__file__).resolve().parents[3]
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else root / "shared" / "meshes"
    print("| mesh, cones | angles | quasi-conformal | area | p10 | p90 | seam length mismatch | L2 | flips |")
    print("|---|---|--:|--:|--:|--:|--:|--:|--:|")
    for name in MESHES:
        mesh = read_mesh(folder / f"{name}.obj")
        split = triangulate(mesh)
        surface = lsgp.Surface(mesh.positions, split.triangles, split.edges)
        cones = json.loads((folder / f"{name}.cones.json").read_text())["cones"]
        label = f"{name}, {len(cones)}"
        if name in PAPER:
            title, row = PAPER[name]
            print(
                f"| {label} | paper ({title}) | {row.quasi_conformal:.3f} | {row.area:.3f} | {row.area_p10:.3f} | "
                f"{row.area_p90:.3f} | {row.mismatch:.0e} | {row.l2_stretch:.3f} | |"
            )
        for rule in RULES:
            result = lsgp.parameterize(surface, cones, options=lsgp.Options(prescription=rule))
            fallback = any(finding.code == "STRAIGHTNESS_FAILED" for finding in result.warnings)
            d = result.distortion
            print(
                f"| {label} | {rule}{' (fell back)' if fallback else ''} | {d.quasi_conformal:.3f} | {d.area:.3f} | "
                f"{d.area_p10:.3f} | {d.area_p90:.3f} | {result.seams.sister_ratio_max - 1:.0e} | "
                f"{d.l2_stretch:.3f} | {len(result.flipped)} |"
            )


if __name__ == "__main__":
    main()
