# SPDX-License-Identifier: GPL-3.0-or-later
"""Two strokes on every model: how far the texture is off them with angles of least distortion, and with angles that
follow them, as Markdown.

    PYTHONPATH=tests python tools/benchmark/several_strokes.py [FOLDER]

Four times, two triangles drawn with a fixed seed get random directions in their planes. The angles are measured anew
from the coordinates; the table has their means, and the largest ratio of L2 stretches. FOLDER holds OBJ files (default:
../shared/meshes); those that are missing are left out. Needs the lsgp wheel and the tests' scipy.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Literal

import lsgp
import numpy as np
from placement_quality import SHARED
from texture_direction import angles, models, normal_of, off_by_quarter

TIMES = 4
STROKES = 2

Unwrap = Callable[[lsgp.Surface, bool], lsgp.Result]


def stroked(surface: lsgp.Surface, rng: np.random.Generator) -> lsgp.Surface:
    directions = np.zeros(surface.triangles.shape)
    for f in rng.choice(len(directions), STROKES, replace=False):
        a, b, c = surface.positions[surface.triangles[f]]
        turn = rng.uniform(0, 2 * np.pi)
        side = (b - a) / np.linalg.norm(b - a)
        directions[f] = np.cos(turn) * side + np.sin(turn) * np.cross(normal_of(a, b, c), side)
    return replace(surface, directions=directions)


def plain(surface: lsgp.Surface, follow: bool) -> lsgp.Result:
    placed = lsgp.place_cones(surface, follow_strokes=follow)
    return lsgp.parameterize(surface, placed.cones, placed.cone_angles, lsgp.Options(follow_strokes=follow))


def pressed(preset: Literal["paint", "tile"]) -> Unwrap:
    options = lsgp.preset_options(preset)
    return lambda surface, follow: lsgp.auto_unwrap(
        surface, preset=preset, options=replace(options, follow_strokes=follow)
    )


def cells(surface: lsgp.Surface, unwrap: Unwrap, in_quarters: bool) -> Iterator[str]:
    rng = np.random.default_rng(1)
    errors: dict[bool, list[float]] = {False: [], True: []}
    ratios = []
    for _ in range(TIMES):
        drawn = stroked(surface, rng)
        results = {follow: unwrap(drawn, follow) for follow in errors}
        for follow, result in results.items():
            off = angles(drawn, result)
            least = off_by_quarter(off)[:, 0] if in_quarters else np.abs(off)
            errors[follow].append(float(least.mean()))
        ratios.append(results[True].distortion.l2_stretch / results[False].distortion.l2_stretch)
    for found in errors.values():
        yield f"{np.mean(found):.1f}°"
    yield f"{max(ratios):.2f}"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", metavar="FOLDER", nargs="?", type=Path, default=SHARED)
    kinds: dict[str, tuple[Unwrap, bool]] = {
        "plain": (plain, False),
        "*Paint*": (pressed("paint"), False),
        "*Tile*": (pressed("tile"), True),
    }
    print("| | " + " | ".join(f"{kind}, rotated | followed | L2, at most" for kind in kinds) + " |")
    print("|---|" + "--:|" * 9)
    for name, surface in models(parser.parse_args().folder):
        row = [cell for unwrap, in_quarters in kinds.values() for cell in cells(surface, unwrap, in_quarters)]
        print(f"| {name} | {' | '.join(row)} |", flush=True)


if __name__ == "__main__":
    main()
