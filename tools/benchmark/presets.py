# SPDX-License-Identifier: GPL-3.0-or-later
"""The presets Bake and Paint beside xatlas and Blender's Smart UV Project, as Markdown tables.

    PYTHONPATH=tests python tools/benchmark/presets.py [--each] [--picture FOLDER] [FOLDER]

FOLDER holds NAME.obj and hard/NAME.off (default: ../shared/meshes); those that are missing are left out. Other models
are generated. xatlas and Smart UV Project have their defaults, without a margin; the latter needs a Python with bpy, in
BPY_PYTHON. The first table has medians; with --each, one for each method has the figures of each model. With
--picture, that folder gets MODEL.png with all layouts beside each other. Needs scipy, xatlas, the lsgp wheel and, for
pictures, matplotlib.

- covered: fraction of the texels of a texture of 1024 by 1024 whose centers an island covers;
- L2: the stretch of the whole surface;
- cuts: their length, in square roots of the surface's area;
- overlap: the area that triangles share, in percent of the layout's area;
- margin: the least distance, in texels of 1024, of two islands, or of an island and the square's border if it is less.
"""

from __future__ import annotations

import argparse
import os
import statistics
import subprocess
import tempfile
from collections.abc import Iterator
from dataclasses import astuple, dataclass
from pathlib import Path

import lsgp
import numpy as np
import oracle
import xatlas
from island_gaps import border_edges, least_gap
from lsgp.images.texel_raster import covering_triangles, to_pixels
from numpy.typing import NDArray
from overlap_check import overlaps
from placement_quality import SHARED, read_surface
from zoo import closed, swept

FloatArray = NDArray[np.float64]

SIZE = 1024  # of the texture
REACH = 64  # texels; wider margins count as this
FILES = (
    "bird.obj",
    "hand-5k.obj",
    "igea-16k.obj",
    "camel-head-disk.obj",
    "kitten-genus1.obj",
    "fandisk.obj",
    "hard/cow.off",
    "hard/triceratops.off",
    "hard/joint.off",
    "hard/pinion.off",
    "hard/anchor.off",
)
GENERATED = {
    "box": lambda: closed.box(4, (1, 1.5, 2)),
    "beveled block": lambda: closed.beveled_box(8, 0.1, (1, 1.5, 2)),
    "gear": lambda: closed.gear(12, 0.3, 2),
    "spring": lambda: swept.spring(4, 10, True),
    "knot": lambda: swept.knot(2, 3, 10),
}
METHODS = ("Bake", "Paint", "xatlas", "Smart UV Project")
TITLES = ("covered", "L2", "islands", "cuts", "overlap, %", "margin")
FORMATS = (".2f", ".4f", ".1f", ".1f", ".2f", ".1f")


@dataclass(frozen=True)
class Row:
    """The figures of one layout, in the order of the titles."""

    covered: float
    l2_stretch: float
    islands: int
    cut_length: float
    overlap: float
    margin: float


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", metavar="FOLDER", nargs="?", type=Path, default=SHARED)
    parser.add_argument("--each", action="store_true", help="print the figures of each model as well")
    parser.add_argument("--picture", metavar="FOLDER", type=Path, help="write the layouts into this folder")
    arguments = parser.parse_args()
    rows: dict[str, dict[str, Row]] = {}
    for name, surface in models(arguments.folder):
        layouts = dict(layouts_of(surface))
        rows[name] = {method: measure(surface, uv) for method, uv in layouts.items()}
        if arguments.picture:
            draw(arguments.picture / f"{name}.png".replace(" ", "-"), surface, layouts)
    print_table(f"medians of {len(rows)} models", medians(rows))
    if arguments.each:
        for method in METHODS:
            print()
            print_table(method, {name: of.get(method) for name, of in rows.items()})


def models(folder: Path) -> Iterator[tuple[str, lsgp.Surface]]:
    for file in FILES:
        if (folder / file).is_file():
            yield Path(file).stem, read_surface(folder / file)
    for name, make in GENERATED.items():
        mesh = make()
        yield name, lsgp.Surface(mesh.positions, mesh.triangles)


def layouts_of(surface: lsgp.Surface) -> Iterator[tuple[str, FloatArray]]:
    """The coordinates, (m, 3, 2), of each method that is installed."""
    for method in METHODS[:2]:
        yield method, lsgp.auto_unwrap(surface, preset=method.lower(), pack="tight").corner_uv
    yield METHODS[2], by_xatlas(surface)
    if "BPY_PYTHON" in os.environ:
        yield METHODS[3], by_blender(os.environ["BPY_PYTHON"], surface)


def by_xatlas(surface: lsgp.Surface) -> FloatArray:
    """Charts of xatlas in its rectangle, scaled so that it is no wider than 1."""
    atlas = xatlas.Atlas()
    atlas.add_mesh(surface.positions.astype(np.float32), surface.triangles.astype(np.uint32))
    atlas.generate()
    _, corners, uv = atlas[0]
    size = np.array([atlas.width, atlas.height], float)
    return (uv * (size / size.max()))[corners].astype(float)


def by_blender(python: str, surface: lsgp.Surface) -> FloatArray:
    with tempfile.TemporaryDirectory() as folder:
        source, target = Path(folder, "surface.npz"), Path(folder, "map.npz")
        np.savez(source, positions=surface.positions, triangles=surface.triangles, seams=np.empty((0, 2), np.int32))
        command = [python, str(Path(__file__).with_name("benchmark_in_blender.py"))]
        command += [str(source), "SMART_PROJECT", str(target)]
        subprocess.run(command, input="run\n", text=True, stdout=subprocess.DEVNULL, check=True)
        return np.load(target)["corner_uv"]


def measure(surface: lsgp.Surface, uv: FloatArray) -> Row:
    found = lsgp.measure_distortion(surface, uv)
    places = to_pixels(uv, (SIZE, SIZE))
    areas = np.abs(oracle.signed_areas(uv)).sum()
    size = np.sqrt(oracle.triangle_areas(surface.positions, surface.triangles).sum())
    ends = surface.positions[found.cut_edges]
    return Row(
        float((covering_triangles(places, (SIZE, SIZE)) >= 0).mean()),
        found.distortion.l2_stretch,
        int(found.island.max()) + 1,
        float(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).sum() / size),
        float(100 * overlaps(uv @ [1, 1j])[1].sum() / areas),
        min(least_margin(places, found.island), float(SIZE * min(uv.min(), 1 - uv.max()))),
    )


def least_margin(places: NDArray[np.complex128], island: NDArray[np.integer]) -> float:
    """In texels, between two islands."""
    # Corners of one island at one place are one vertex.
    keys = np.stack([places.real.ravel(), places.imag.ravel(), np.repeat(island, 3)], axis=1)
    vertices = np.unique(keys, axis=0, return_inverse=True)[1].reshape(-1, 3)
    triangle, corner = border_edges(vertices)
    segments = np.stack([places[triangle, corner], places[triangle, (corner + 1) % 3]], axis=1)
    return min(least_gap(segments, island[triangle].astype(np.int64), REACH), REACH)


def medians(rows: dict[str, dict[str, Row]]) -> dict[str, Row | None]:
    out: dict[str, Row | None] = {}
    for method in METHODS:
        of_method = [astuple(of[method]) for of in rows.values() if method in of]
        out[method] = Row(*map(statistics.median, zip(*of_method, strict=True))) if of_method else None
    return out


def print_table(first: str, rows: dict[str, Row | None]) -> None:
    print(f"| {first} | {' | '.join(TITLES)} |\n|---|{'--:|' * len(TITLES)}")
    for name, row in rows.items():
        if row is not None:
            cells = [format(value, form) for value, form in zip(astuple(row), FORMATS, strict=True)]
            print(f"| {name} | {' | '.join(cells)} |", flush=True)


def draw(file: Path, surface: lsgp.Surface, layouts: dict[str, FloatArray]) -> None:
    from matplotlib import pyplot as plt
    from matplotlib.collections import PolyCollection

    figure, axes = plt.subplots(1, len(layouts), figsize=(6 * len(layouts), 6.4))
    for one, (method, uv) in zip(axes, layouts.items(), strict=True):
        island = lsgp.measure_distortion(surface, uv).island
        colors = plt.get_cmap("tab20")(island % 20)
        one.add_collection(PolyCollection(uv, facecolors=colors, edgecolors="black", linewidths=0.1))
        one.set(xlim=(0, 1), ylim=(0, 1), aspect="equal", title=method)
    file.parent.mkdir(parents=True, exist_ok=True)
    figure.tight_layout()
    figure.savefig(file, dpi=70)
    plt.close(figure)


if __name__ == "__main__":
    main()
