# SPDX-License-Identifier: GPL-3.0-or-later
"""How much of the marked features runs straight along u or v, and what it costs: a Markdown table.

    PYTHONPATH=tests python tools/benchmark/straight_features.py [--preset tile] [FOLDER]

Features are all edges at which the surface bends by 40 degrees or more. Their sides are measured anew from the
coordinates as float32 stores them: one is along u or v if the other coordinate of its ends is the same number, and with
"tile" it is at whole or half tiles if that number is, without and with these as `Seamless.feature_places`. L2 stretch
is that of the same preset without features and straight sides, and with features. FOLDER holds OBJ or OFF
files (default: ../shared/meshes and its folder hard); those that are missing are left out. Needs the lsgp wheel and the
tests' scipy.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import lsgp
import numpy as np
from numpy.typing import NDArray
from straight_sides import GENERATED, SHARED, models
from zoo import closed, swept

ANGLE = np.radians(40)
REASONS = ("curved", "contradiction", "stretch", "lattice")
COLUMNS = ("cones", "along u or v", "off it", *REASONS, "L2 without", "with", "flips", "seconds")
STEPS = {"whole": 1.0, "half": 0.5}  # by their place, in tiles
OF_TILES = ("tiles", *(f"{place}: {what}" for place in STEPS for what in ("at such, without", "with", "tiles", "L2")))

MESHES = GENERATED | {
    "turned spool": closed.lathe(
        np.array([1.0, 1.0, 0.5, 0.5, 1.0, 1.0]), np.array([0.0, 0.2, 0.4, 1.4, 1.6, 1.8]), 32, caps=(True, True)
    ),
    "frustum": closed.lathe(np.array([1.0, 0.6]), np.array([0.0, 1.0]), 32, caps=(True, True)),
    "bent pipe": swept.pipe(24, 16, 1.2, True),
    "gear of 14 teeth": closed.gear(14, 0.3, 2),
}


def sides_of(surface: lsgp.Surface, result: lsgp.Result) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """(s, 2, 2) the ends in the layout, in float32, of every side of the features; (s,) half their lengths."""
    corners = result.corner_uv.astype(np.float32).astype(float)
    ends = np.stack([surface.triangles, np.roll(surface.triangles, -1, axis=1)], axis=-1).reshape(-1, 2)
    uv = np.stack([corners, np.roll(corners, -1, axis=1)], axis=-2).reshape(-1, 2, 2)
    keys, wanted = (
        np.sort(pairs, axis=1).astype(np.int64) @ [len(surface.positions), 1] for pairs in (ends, surface.features)
    )
    is_side = np.isin(keys, wanted)
    return uv[is_side], np.linalg.norm(np.diff(surface.positions[ends[is_side]], axis=1)[:, 0], axis=1) / 2


def share_at(step: float, surface: lsgp.Surface, result: lsgp.Result) -> float:
    """Of the length of both sides of the features, the part at multiples of a step."""
    uv, length = sides_of(surface, result)
    is_at = ((uv[:, 0] == uv[:, 1]) & (uv[:, 0] % step == 0)).any(axis=1)
    return length[is_at].sum() / length.sum()


def cells(surface: lsgp.Surface, preset: str) -> Iterator[str]:
    marked = replace(surface, features=lsgp.feature_edges(surface, angle=ANGLE))
    began = time.process_time()
    result = lsgp.auto_unwrap(marked, preset=preset)
    seconds = time.process_time() - began
    unaligned = replace(lsgp.preset_options(preset), straighten=False)
    free = lsgp.auto_unwrap(surface, preset=preset, options=unaligned)
    uv, length = sides_of(marked, result)
    is_along = (uv[:, 0] == uv[:, 1]).any(axis=1)
    share = length[is_along].sum() / length.sum()
    assert result.features.share <= share + 1e-9
    yield str(len(result.cones))
    yield f"{result.features.share:.3f}"
    yield f"{1 - share:.3f}"
    for reason in REASONS:
        lost = sum(feature.share for feature in result.features.released if feature.reason == reason)
        yield f"{lost:.3f}" if lost else ""
    yield f"{free.distortion.l2_stretch:.4f}"
    yield f"{result.distortion.l2_stretch:.4f}"
    yield str(len(result.flipped) + len(result.wrong_angle_sums))
    yield f"{seconds:.1f}"
    if preset != "tile":
        return
    yield f"{result.seamless.tiles:.4g}"
    for place, step in STEPS.items():
        options = lsgp.preset_options(preset)
        options = replace(options, seamless=replace(options.seamless, feature_places=place))
        found = lsgp.auto_unwrap(marked, preset=preset, options=options)
        yield from (f"{share_at(step, marked, other):.3f}" for other in (result, found))
        yield f"{found.seamless.tiles:.4g}"
        yield f"{found.distortion.l2_stretch:.4f}"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", metavar="FOLDER", nargs="?", type=Path, default=SHARED)
    parser.add_argument("--preset", choices=["paint", "tile", "bake"], default="tile")
    arguments = parser.parse_args()
    columns = COLUMNS + (OF_TILES if arguments.preset == "tile" else ())
    print(f"| | {' | '.join(columns)} |")
    print("|---|" + "--:|" * len(columns))
    for name, surface in models(arguments.folder, MESHES):
        print(f"| {name} | {' | '.join(cells(surface, arguments.preset))} |", flush=True)


if __name__ == "__main__":
    main()
