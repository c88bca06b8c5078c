# SPDX-License-Identifier: GPL-3.0-or-later
"""One stroke on every island: the angle between the texture and the stroke, in plain and seamless layouts, as Markdown.

    PYTHONPATH=tests python tools/benchmark/texture_direction.py [FOLDER]

On each island one triangle, drawn with a fixed seed, gets a random direction in its plane. The angle is measured anew
from the coordinates. In the seamless layout it is measured for the layout turned by none to three quarters; the least
and the second of these angles are printed, and the result has to report the least. Tiles are automatic, and then 64
along the layout. FOLDER holds OBJ files (default: ../shared/meshes); those that are missing are left out. Needs the
lsgp wheel and the tests' scipy.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import lsgp
import meshes
import numpy as np
import oracle
from numpy.typing import NDArray
from placement_quality import SHARED
from zoo import closed, swept

FILES = ("fandisk", "bird", "hand-5k", "max-planck-25k", "eight-genus2", "kitten-genus1")
FINE = 64  # tiles
SAME = 1e-6  # degrees


def generated() -> dict[str, lsgp.Surface]:
    shapes = {
        "beveled block": closed.beveled_box(8, 0.1, (1, 1.5, 2)),
        "hollow pipe": swept.pipe(24, 8, 0.0, True),
        "hill": meshes.hill(20),
        "three boxes": meshes.merge([closed.box(4, (1, 1, 1 + k)) for k in range(3)]),
    }
    return {name: lsgp.Surface(mesh.positions, mesh.triangles) for name, mesh in shapes.items()}


def models(folder: Path) -> Iterator[tuple[str, lsgp.Surface]]:
    for name in FILES:
        if (folder / f"{name}.obj").is_file():
            yield name, lsgp.read_mesh_file(str(folder / f"{name}.obj")).surface()
    yield from generated().items()


def stroked(surface: lsgp.Surface, layout: lsgp.Result, rng: np.random.Generator) -> lsgp.Surface:
    """A stroke on each island of the layout."""
    directions = np.zeros(surface.triangles.shape)
    for island in np.unique(layout.island[layout.solved]):
        f = rng.choice(np.flatnonzero(layout.island == island))
        a, b, c = surface.positions[surface.triangles[f]]
        turn = rng.uniform(0, 2 * np.pi)
        side = (b - a) / np.linalg.norm(b - a)
        directions[f] = np.cos(turn) * side + np.sin(turn) * np.cross(normal_of(a, b, c), side)
    return replace(surface, directions=directions)


def normal_of(a: NDArray[np.float64], b: NDArray[np.float64], c: NDArray[np.float64]) -> NDArray[np.float64]:
    normal = np.cross(b - a, c - a)
    return normal / np.linalg.norm(normal)


def angles(surface: lsgp.Surface, result: lsgp.Result) -> NDArray[np.float64]:
    """At each stroke, from v to its image, degrees."""
    out = []
    for f in np.flatnonzero(np.any(surface.directions != 0, axis=1)):
        place = surface.positions[surface.triangles[f]]
        z = oracle.as_complex(result.corner_uv)[f]
        weights = np.linalg.lstsq((place[1:] - place[0]).T, surface.directions[f], rcond=None)[0]
        out.append(np.degrees(np.angle(weights @ (z[1:] - z[0]) / 1j)))
    return np.array(out)


def off_by_quarter(angle: NDArray[np.float64]) -> NDArray[np.float64]:
    """(strokes, 4) deviations, ascending, if the layout is turned by none, one, two and three quarters."""
    turned = angle[:, None] + 90 * np.arange(4)
    return np.sort(np.abs((turned + 180) % 360 - 180), axis=1)


def cells(surface: lsgp.Surface) -> Iterator[str]:
    placed = lsgp.place_cones(surface)
    plain = lsgp.parameterize(surface, placed.cones, placed.cone_angles)
    surface = stroked(surface, plain, np.random.default_rng(1))
    plain = lsgp.parameterize(surface, placed.cones, placed.cone_angles)
    yield str(len(placed.cones))
    yield str(int(np.any(surface.directions != 0, axis=1).sum()))
    yield f"{np.abs(angles(surface, plain)).max():.0e}°"
    for tiles in (None, FINE):
        options = lsgp.Options(seamless=lsgp.Seamless(tiles=tiles) if tiles else lsgp.Seamless())
        result = lsgp.parameterize(surface, placed.cones, options=options)
        quarters = off_by_quarter(angles(surface, result))
        worst = int(quarters[:, 0].argmax())
        assert abs(quarters[worst, 0] - np.degrees(np.nanmax(result.direction_errors))) < SAME
        yield f"{result.seamless.tiles:g}"
        yield f"{quarters[worst, 0]:.2f}°"
        yield f"{quarters[worst, 1]:.1f}°"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", metavar="FOLDER", nargs="?", type=Path, default=SHARED)
    seamless = ("tiles", "seamless", "next quarter")
    print("| | cones | strokes | plain | " + " | ".join(2 * seamless) + " |")
    print("|---|" + "--:|" * 9)
    for name, surface in models(parser.parse_args().folder):
        print(f"| {' | '.join([name, *cells(surface)])} |", flush=True)


if __name__ == "__main__":
    main()
