# SPDX-License-Identifier: GPL-3.0-or-later
"""By how much lookups on the two sides of cuts differ, for gutters of several kinds, as a Markdown table.

    PYTHONPATH=tests python tools/benchmark/gutter_table.py [--size PIXELS] [--margin PIXELS] [--picture FOLDER]

A smooth function of space is baked onto generated meshes; the table has mean differences in units of 1e-4 at the mip
levels 0 to 3, and of neighboring texels inside islands. With --picture, FOLDER gets MESH-KIND.png of each image. Needs
the lsgp wheel, scipy, and OpenCV for pictures.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import lsgp
import meshes
import numpy as np
from gutter_checks import bake, difference_across_cuts, difference_of_neighbors, inset, smeared, unwrapped
from numpy.typing import NDArray

MESHES = {
    "bumpy_sphere(3)": meshes.bumpy_sphere(3),
    "flower(3)": meshes.flower(3),
    "torus()": meshes.torus(),
}
LEVELS = 4


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--size", type=int, default=512, help="of the texture (default: 512)")
    parser.add_argument("--margin", type=int, default=16, help="of the gutters (default: 16)")
    parser.add_argument("--picture", metavar="FOLDER", type=Path, help="write the images into this folder")
    arguments = parser.parse_args()
    print(f"| mesh | gutters | {' | '.join(map(str, range(LEVELS)))} | neighbors |")
    print(f"|---|---|{'--:|' * (LEVELS + 1)}")
    for name, mesh in MESHES.items():
        whole, uv = unwrapped(mesh)
        uv = inset(uv, arguments.margin / arguments.size)
        image, covered = bake(whole, uv, arguments.size)
        padded = {
            "empty": image,
            "nearest texel": smeared(image, covered, arguments.margin),
            "beyond the cut": lsgp.pad_image(image, whole, uv, arguments.margin),
        }
        neighbors = in_units(difference_of_neighbors(image, covered))
        for kind, pixels in padded.items():
            found = map(in_units, difference_across_cuts(whole, uv, pixels, LEVELS))
            first = kind == "empty"
            print(f"| {f'`{name}`' if first else ''} | {kind} | {' | '.join(found)} | {neighbors if first else ''} |")
            if arguments.picture is not None:
                save(arguments.picture / f"{name}-{kind}.png".replace("()", ""), pixels)


def in_units(difference: float) -> str:
    value = difference * 1e4
    return f"{value:.1f}" if value < 10 else f"{value:.0f}"


def save(path: Path, pixels: NDArray[np.float64]) -> None:
    import cv2

    path.parent.mkdir(parents=True, exist_ok=True)
    cv2.imwrite(str(path), np.rint(pixels * 255).astype(np.uint8))


if __name__ == "__main__":
    main()
