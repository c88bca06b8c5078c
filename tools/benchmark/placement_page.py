# SPDX-License-Identifier: GPL-3.0-or-later
"""What automatic cones predict, and what their maps measure; --write makes the tables of docs/reference/placement.md.

    PYTHONPATH=tests python tools/benchmark/placement_page.py [--write] [--jobs N] [part ...]

Parts are `meshes`, those of placement_sweep.py with a target and with eight cones; `misses`, a line for each of these
that is not as predicted or has no map; `flat`, bodies with flat faces; `plates` with many tunnels; and `tips`, bodies
and animals with limbs. Needs scipy and the lsgp wheel, and the shared meshes if they are to be included.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterable, Iterator
from functools import cache
from pathlib import Path

import lsgp
import meshes
import numpy as np
from extremities import body_with_limbs, distances_to_cones, extremities, largest_component, with_cones_at
from meshes import Mesh
from placement_quality import SHARED, of_plates, read_surface, within
from placement_sweep import Ending, all_meshes, is_off, sweep, table
from zoo import closed

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs" / "reference" / "placement.md"
RUNS = ("auto", "auto:8")
EACH, LIMIT = 2, 120  # members of each family of the zoo; seconds of a run
GENERA = (20, 40, 54, 72, 100, 200)
FLAT = {
    "cube": closed.box(1, (1, 1, 1)),
    "box of 1 by 30 by 0.2": closed.box(1, (1, 30, 0.2)),
    "prism on a 12-gon": closed.prism(12, 2, 1.5),
    "bar of L": meshes.voxels(np.array([[[1], [1], [1]], [[1], [0], [0]]], bool)),
    "stairs": meshes.voxels(np.tril(np.ones((3, 3), bool))[:, :, None]),
}
SUBDIVISIONS = (0, 2)
COUNTS_AT_TIPS, NEAR = (8, 14), 2  # edges


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("parts", nargs="*", metavar="part", help=f"of {', '.join(PARTS)}; all by default")
    parser.add_argument("--write", action="store_true", help=f"the tables to {PAGE.relative_to(ROOT)}")
    parser.add_argument("--jobs", metavar="N", type=int, default=2, help="processes at once (default: 2)")
    arguments = parser.parse_args()
    for part in arguments.parts or PARTS:
        heading, rows_of = PARTS[part]
        found = rows_of(arguments.jobs)
        print(f"{heading}\n\n{found}", flush=True)
        if arguments.write:
            write(heading, found)


def write(heading: str, rows: str) -> None:
    """Replaces the table below a heading of the page."""
    page = PAGE.read_text(encoding="utf-8")
    begin = page.index("\n|", page.index(f"## {heading}\n")) + 1
    end = page.index("\n\n", begin) + 1
    PAGE.write_text(page[:begin] + rows + page[end:], encoding="utf-8")


def as_table(columns: Iterable[str], texts: int, rows: Iterable[Iterable[object]]) -> str:
    """texts: so many columns at the left are no numbers."""
    columns = list(columns)
    lines = [columns, [*["---"] * texts, *["--:"] * (len(columns) - texts)], *rows]
    return "".join(f"| {' | '.join(map(str, line))} |\n" for line in lines)


@cache
def endings(jobs: int) -> list[tuple[str, str, Ending]]:
    return sweep(RUNS, all_meshes(EACH), LIMIT, jobs)


def of_meshes(jobs: int) -> str:
    return table(endings(jobs))


def of_misses(jobs: int) -> str:
    rows = []
    for run, name, ending in endings(jobs):
        if ending.end == "valid" and not is_off(ending):
            continue
        is_map = ending.end in ("valid", "named")
        figures = [figure(ending.predicted), figure(ending.l2)] if is_map else ["", ""]
        told = [code for code in ending.told if code in TOLD or not is_map]
        rows.append([run, name, ending.end, ", ".join(told), *figures])
    return as_table(["cones", "mesh", "end", "told", "predicted L2", "map L2"], 4, rows)


TOLD = ("HIGH_DISTORTION", "PLACEMENT_NOT_REACHED")  # what there is to say about the stretch of a map


def figure(l2: float) -> str:
    return f"{l2:.3f}" if l2 < 100 else f"{l2:.1e}"


def of_flat(_: int) -> str:
    rows = []
    for name, mesh in FLAT.items():
        for levels in SUBDIVISIONS:
            rows.append([name, *unfolded(subdivided(mesh, levels))])
    return as_table(["body", "triangles", "cones", "predicted L2", "map L2", "largest change of an angle"], 1, rows)


def subdivided(mesh: Mesh, levels: int) -> Mesh:
    for _ in range(levels):
        mesh = meshes.subdivide(mesh)
    return mesh


def unfolded(mesh: Mesh) -> list[str]:
    surface = lsgp.Surface(mesh.positions, mesh.triangles)
    placed = lsgp.place_cones(surface)
    result = lsgp.parameterize(surface, placed.cones, placed.cone_angles)
    turned = corner_angles(result.corner_uv) - corner_angles(mesh.positions[mesh.triangles])
    stretch = [f"{placed.predicted_l2:.4f}", f"{result.distortion.l2_stretch:.4f}"]
    return [f"{len(mesh.triangles):,}", str(len(placed.cones)), *stretch, f"{np.abs(turned).max():.0e}°"]


def corner_angles(corners: np.ndarray) -> np.ndarray:
    """(m, 3) degrees, of triangles in the plane or in space, (m, 3, d)."""
    to_next, to_last = np.roll(corners, -1, axis=1) - corners, np.roll(corners, 1, axis=1) - corners
    lengths = np.linalg.norm(to_next, axis=2) * np.linalg.norm(to_last, axis=2)
    return np.degrees(np.arccos(np.clip((to_next * to_last).sum(axis=2) / lengths, -1, 1)))


def of_tunnels(_: int) -> str:
    found = ((name.rpartition(" ")[2], within(LIMIT, read)) for name, read in of_plates(list(GENERA)))
    rows = ([genus, *figures[:7]] for genus, figures in found)
    return as_table(["genus", "triangles", "cones", "predicted L2", "map L2", "defects", "maps", "place s"], 0, rows)


def of_tips(_: int) -> str:
    rows = []
    for name, mesh in with_limbs():
        whole = largest_component(mesh)
        tips = extremities(whole)
        for count in COUNTS_AT_TIPS:
            placed = lsgp.place_cones(lsgp.Surface(whole.positions, whole.triangles), count=count)
            away = distances_to_cones(whole, tips, placed).min(axis=1)
            moved = with_cones_at(whole, tips, placed)
            near = f"{(away <= NEAR).sum()} of {len(tips)}"
            rows.append([name, count, near, f"{away.max():.1f}", f"{placed.mapped_l2:.3f}", f"{moved.mapped_l2:.3f}"])
    return as_table(["mesh", "cones", "at extremities", "farthest", "map L2", "moved there"], 1, rows)


def with_limbs() -> Iterator[tuple[str, Mesh]]:
    for count in (3, 5, 7):
        yield f"ball with {count} limbs", body_with_limbs(count, 1.5, 20, 0)[0]
    yield "ball with horns and a snout", meshes.two_horned(4)
    yield "flower", meshes.flower(4)
    for name in ("hand-5k", "bird", "igea-16k", "suzanne-messy"):
        if (path := SHARED / f"{name}.obj").is_file():
            found = read_surface(path)
            yield name, meshes.make(found.positions, found.triangles)


PARTS: dict[str, tuple[str, Callable[[int], str]]] = {
    "meshes": ("Meshes of every kind", of_meshes),
    "misses": ("Not as predicted", of_misses),
    "flat": ("Flat faces", of_flat),
    "plates": ("Many tunnels", of_tunnels),
    "tips": ("Extremities", of_tips),
}


if __name__ == "__main__":
    main()
