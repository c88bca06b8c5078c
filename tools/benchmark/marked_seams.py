# SPDX-License-Identifier: GPL-3.0-or-later
"""Edges cut beyond the marked seams, on seamed models; --write makes docs/reference/seams.md.

    PYTHONPATH=tests python tools/benchmark/marked_seams.py [--write] [NAME ...]

Some models have seams by formula: four kinds at three sizes, ten more of each kind with other measures, and others; on
the rest the islands of xatlas, uvunwrap, Paint and Bake are turned into seams, and those of Blender's Smart UV Project.
NAME chooses some. Blender's Unwrap with Minimum Stretch goes by the same seams; it needs a Python
with bpy, in BPY_PYTHON, and what needs it is left out otherwise. Needs the lsgp wheel, scipy, uvunwrap and xatlas.
"""

from __future__ import annotations

import argparse
import os
import statistics
import subprocess
import tempfile
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import lsgp
import meshes
import numpy as np
import zoo
from beside_peers import by_uvunwrap
from numpy.typing import NDArray
from presets import by_xatlas
from zoo.swept import circle, sweep

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "reference" / "seams.md"
DUCK = ROOT / "examples" / "model.obj"
TARGET = 1.05
Edges = NDArray[np.integer]
FloatArray = NDArray[np.float64]


class Map(NamedTuple):
    """A layout.  extra, unmarked: edges cut beyond the marked ones, and marked ones that are not cut."""

    extra: int
    left: int
    cones: int
    islands: int
    l2: float


class Row(NamedTuple):
    name: str
    triangles: int
    marked: int
    charts: int
    suffices: bool
    exact: Map
    default: Map
    blender: Map | None


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("names", metavar="NAME", nargs="*", help="of models")
    parser.add_argument("--write", action="store_true", help=f"the table to {PAGE.relative_to(ROOT)}")
    arguments = parser.parse_args()
    rows = []
    for name, surface in models():
        if not arguments.names or name in arguments.names:
            rows.append(measure(name, surface))
            print(line(rows[-1]), flush=True)
    print(summary(rows))
    if arguments.write:
        PAGE.write_text(page(rows))


def models() -> Iterator[tuple[str, lsgp.Surface]]:
    yield from by_formula()
    yield from further_by_formula()
    yield from by_islands("xatlas", by_xatlas)
    yield from by_islands("uvunwrap", by_uvunwrap)
    yield from by_islands("Paint", lambda surface: lsgp.auto_unwrap(surface, preset="paint").corner_uv)
    yield from by_islands("Bake", lambda surface: lsgp.auto_unwrap(surface, preset="bake").corner_uv)
    if "BPY_PYTHON" in os.environ:
        yield from by_islands("Smart UV", lambda surface: in_blender(surface, "SMART_PROJECT"))


def by_formula() -> Iterator[tuple[str, lsgp.Surface]]:
    for around, along in ((9, 1), (32, 1), (90, 1), (9, 8), (32, 8), (90, 8)):
        yield f"cylinder of {around} by {along}", capped(straight(along), around, 1.0)
    yield "cone frustum", capped(straight(6), 24, np.linspace(1, 0.4, 7))
    for along in (24, 80, 200):
        yield f"bent pipe of 12 by {along}", along_tube(bend(along), 12)
    yield "bent pipe with caps", capped(bend(60), 12, 0.25)
    yield "spring", along_tube(helix(4, 160), 10)
    for along in (20, 40, 80):
        yield f"bumpy tyre of {along} by 16, in four", tyre(along, 16, 4)
    cube = meshes.cube(8)
    yield "cube, all sides", lsgp.Surface(cube.positions, cube.triangles, seams=folds(cube, 1.0))
    ball = meshes.bumpy_sphere(4)
    yield "bumpy ball in eight", lsgp.Surface(ball.positions, ball.triangles, seams=between_octants(ball))


def further_by_formula() -> Iterator[tuple[str, lsgp.Surface]]:
    rng = np.random.default_rng(0)
    for _ in range(10):
        around, along = int(rng.integers(5, 60)), int(rng.integers(1, 14))
        taper, height = rng.uniform(0.4, 1.0), rng.uniform(0.05, 3.0)
        path = straight(along) * [1, 1, height]
        name = f"cylinder of {around} by {along}, {2 * height:.1f} high, narrowing to {taper:.2f}"
        yield name, capped(path, around, np.linspace(1, taper, along + 1))
    for _ in range(10):
        around, along = int(rng.integers(6, 20)), int(rng.integers(20, 120))
        t, wave = np.linspace(0, 1, along), rng.uniform(0, 1.5, 2)
        path = np.stack([2 * t, wave[0] * np.sin(3 * t), 0.4 * wave[1] * np.cos(5 * t)], 1)
        name = f"pipe of {around} by {along}, waves of {wave[0]:.2f} and {wave[1]:.2f}"
        yield name, along_tube(path, around)
    for _ in range(10):
        parts = int(rng.integers(3, 6))
        along, around, bumps = parts * int(rng.integers(4, 12)), int(rng.integers(8, 20)), rng.uniform(0, 0.25)
        name = f"tyre of {along} by {around}, in {parts}, bumps of {bumps:.2f}"
        yield name, tyre(along, around, parts, bumps)


def straight(along: int) -> FloatArray:
    return np.stack([np.zeros(along + 1), np.zeros(along + 1), np.linspace(0, 2, along + 1)], 1)


def bend(count: int) -> FloatArray:
    t = np.linspace(0, 1, count)
    return np.stack([2 * t, np.sin(3.1 * t), 0.6 * np.cos(5.2 * t)], 1)


def helix(turns: float, count: int) -> FloatArray:
    t = np.linspace(0, 1, count)
    angle = 2 * np.pi * turns * t
    return np.stack([np.cos(angle), np.sin(angle), 3 * t], 1)


def tube(path: FloatArray, around: int, radius: FloatArray | float, *, caps: bool, closed: bool = False) -> meshes.Mesh:
    made = sweep(path, circle(1.0, around), closed=closed, caps=caps)
    positions = made.positions.copy()
    axis = np.repeat(path, around, axis=0)
    factor = np.repeat(np.broadcast_to(radius, len(path)), around)[:, None]
    positions[: len(axis)] = axis + factor * (positions[: len(axis)] - axis)
    return made._replace(positions=positions)


def line_along(count: int, around: int) -> Edges:
    at = around * np.arange(count)
    return np.stack([at[:-1], at[1:]], 1)


def ring_at(place: int, around: int) -> Edges:
    at = place * around + np.arange(around)
    return np.stack([at, np.roll(at, -1)], 1)


def along_tube(path: FloatArray, around: int) -> lsgp.Surface:
    mesh = tube(path, around, 0.25, caps=False)
    return lsgp.Surface(mesh.positions, mesh.triangles, seams=line_along(len(path), around))


def capped(path: FloatArray, around: int, radius: FloatArray | float) -> lsgp.Surface:
    mesh = tube(path, around, radius, caps=True)
    seams = [ring_at(0, around), ring_at(len(path) - 1, around), line_along(len(path), around)]
    return lsgp.Surface(mesh.positions, mesh.triangles, seams=np.concatenate(seams))


def tyre(along: int, around: int, parts: int, bumps: float = 0.15) -> lsgp.Surface:
    angle = 2 * np.pi * np.arange(along) / along
    path = np.stack([3 * np.cos(angle), 3 * np.sin(angle), 0.4 * np.sin(2 * angle)], 1)
    mesh = tube(path, around, 0.8 * (1 + bumps * np.sin(3 * angle)), caps=False, closed=True)
    rings = [ring_at(place, around) for place in range(0, along, along // parts)]
    whole = np.concatenate([line_along(along, around), [[(along - 1) * around, 0]], *rings])
    return lsgp.Surface(mesh.positions, mesh.triangles, seams=whole)


def folds(mesh: meshes.Mesh, angle: float) -> Edges:
    return lsgp.feature_edges(lsgp.Surface(mesh.positions, mesh.triangles), angle=angle)


def between_octants(mesh: meshes.Mesh) -> Edges:
    octant = (mesh.positions[mesh.triangles].mean(axis=1) > 0) @ [1, 2, 4]
    return between(mesh.triangles, octant)


def between(triangles: Edges, label: Edges) -> Edges:
    """The edges between triangles with different labels."""
    sides = np.sort(np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
    of_side = np.repeat(label, 3)
    order = np.lexsort(sides.T)
    sides, of_side = sides[order], of_side[order]
    is_pair = (sides[1:] == sides[:-1]).all(axis=1) & (of_side[1:] != of_side[:-1])
    return sides[1:][is_pair]


def by_islands(program: str, unwrap: Callable[[lsgp.Surface], FloatArray]) -> Iterator[tuple[str, lsgp.Surface]]:
    """Models whose seams are where a program cuts them."""
    for name, surface in ordinary():
        cut = lsgp.measure_distortion(surface, unwrap(surface)).cut_edges
        yield f"{name}, {program}", replace(surface, seams=cut)


def ordinary() -> Iterator[tuple[str, lsgp.Surface]]:
    yield "duck", lsgp.read_mesh_file(DUCK).surface()
    chosen = [member for room in (zoo.closed, zoo.swept, zoo.tunnels, zoo.parts) for member in room.members()]
    chosen = [member for member in chosen if member.size == "small"]
    for member in chosen[:: max(1, len(chosen) // 9)][:9]:
        mesh = member.mesh()
        yield member.name, lsgp.Surface(mesh.positions, mesh.triangles)


def measure(name: str, surface: lsgp.Surface) -> Row:
    exact = replace(lsgp.preset_options("paint"), seams="exact")
    charts = lsgp.measure_charts(surface, exact)
    suffices = all(
        chart.is_mapped and chart.l2_stretch <= TARGET and not chart.flipped and not chart.overlapping
        for chart in charts
    )
    only = lsgp.auto_unwrap(surface, options=exact)
    usual = lsgp.auto_unwrap(surface)
    blender = None
    if "BPY_PYTHON" in os.environ:
        uv = in_blender(surface, "MINIMUM_STRETCH")
        blender = map_of(surface, uv, lsgp.measure_distortion(surface, uv).cut_edges, 0)
    return Row(
        name,
        len(surface.triangles),
        len(pairs(surface.seams)),
        len(charts),
        suffices,
        map_of(surface, only.corner_uv, only.cut_edges, len(only.cones)),
        map_of(surface, usual.corner_uv, usual.cut_edges, len(usual.cones)),
        blender,
    )


def map_of(surface: lsgp.Surface, uv: FloatArray, cut: Edges, cones: int) -> Map:
    marked, found = pairs(surface.seams), pairs(cut)
    island = lsgp.measure_distortion(surface, uv).island
    return Map(len(found - marked), len(marked - found), cones, int(island.max()) + 1, stretch(surface, uv, island))


def stretch(surface: lsgp.Surface, uv: FloatArray, island: Edges) -> float:
    """The L2 stretch, each island at a scale of its own, since programs scale them by different rules."""
    largest, smallest = lsgp.singular_values(surface, uv)
    corners = surface.positions[surface.triangles]
    area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1) / 2
    kept = (island >= 0) & (area > 0)
    with np.errstate(divide="ignore", invalid="ignore"):
        spread = area * (1 / largest**2 + 1 / smallest**2) / 2
    sums = [np.bincount(island[kept], values[kept]) for values in (area, area * largest * np.abs(smallest), spread)]
    of_island = sums[2] * sums[1] / sums[0]  # squared stretches times areas
    return float(np.sqrt(of_island.sum() / sums[0].sum()))


def pairs(edges: Edges) -> set[tuple[int, int]]:
    return {(min(a, b), max(a, b)) for a, b in np.asarray(edges).tolist()}


def in_blender(surface: lsgp.Surface, method: str) -> FloatArray:
    with tempfile.TemporaryDirectory() as folder:
        source, target = Path(folder, "surface.npz"), Path(folder, "map.npz")
        seams = np.asarray(surface.seams, np.int32).reshape(-1, 2)
        np.savez(source, positions=surface.positions, triangles=surface.triangles, seams=seams)
        program = str(Path(__file__).with_name("benchmark_in_blender.py"))
        command = [os.environ["BPY_PYTHON"], program, str(source), method, str(target)]
        subprocess.run(command, input="run\n", text=True, stdout=subprocess.DEVNULL, check=True)
        return np.load(target)["corner_uv"]


HEAD = (
    "| model | triangles | marked | charts | *Mine Only*: beyond | islands | L2 | default: beyond | cones | islands "
    "| L2 | Blender: islands | L2 |\n|---|" + "--:|" * 12
)


def line(row: Row) -> str:
    cells: list[object] = [row.name, row.triangles, row.marked, row.charts]
    cells += [row.exact.extra + row.exact.left, row.exact.islands, f"{row.exact.l2:.4f}"]
    beyond = f"{row.default.extra}" + ("" if row.suffices else " *")
    cells += [beyond, row.default.cones, row.default.islands, f"{row.default.l2:.4f}"]
    cells += ["", ""] if row.blender is None else [row.blender.islands, f"{row.blender.l2:.4f}"]
    return f"| {' | '.join(map(str, cells))} |"


def summary(rows: list[Row]) -> str:
    sufficing = [row for row in rows if row.suffices]
    text = (
        f"Of {len(rows)} models the seams of {len(sufficing)} suffice. Beyond the marked edges *Mine Only* cuts "
        f"{sum(row.exact.extra for row in rows)} edges in all and leaves {sum(row.exact.left for row in rows)} of them "
        f"uncut; the default cuts {sum(row.default.extra for row in sufficing)} where the seams suffice."
    )
    beside = [row for row in rows if row.blender is not None]
    if beside:
        least = [row.exact.l2 <= row.blender.l2 + 5e-4 for row in beside]
        alike = [row.exact.islands == row.blender.islands for row in beside]
        ratio = statistics.median((row.exact.l2 - 1 + 1e-4) / (row.blender.l2 - 1 + 1e-4) for row in beside)
        text += (
            f" Beside Blender's *Unwrap* with *Minimum Stretch*, *Mine Only* is stretched no more on {sum(least)} of "
            f"{len(beside)} models and has as many islands on {sum(alike)}; the median of its excess of L2 stretch is "
            f"{ratio:.2f} of Blender's. Where it is stretched more, by up to "
            f"{max(row.exact.l2 - row.blender.l2 for row in beside):.4f}, sides of islands were made straight, "
            "or tubes strips."
        )
    return text


def page(rows: list[Row]) -> str:
    return f"""# Marked seams

Written by `python tools/benchmark/marked_seams.py --write`. What is cut besides the seams that are marked, with
*Auto Unwrap*, *Paint*, and *Seams ▸ Mine Only* or *Mine and Automatic*, the default
([what they mean](../how-to/cuts.md#marked-seams)). On some models seams are marked by formula, on the others the
islands of xatlas, uvunwrap, *Paint*, *Bake* or Blender's *Smart UV Project* are turned into seams. Blender's own
*Unwrap* with *Minimum Stretch* goes by the same seams. L2 stretch is measured with each island at a scale of its own.

*Beyond* counts edges that are cut and not marked, with *Mine Only* also those marked and not cut. An asterisk marks
models whose seams do not suffice: a chart is stretched by more than 5 % without cones, is no disk and stretched, or
overlaps itself.

{HEAD}
{chr(10).join(map(line, rows))}

{summary(rows)}
"""


if __name__ == "__main__":
    main()
