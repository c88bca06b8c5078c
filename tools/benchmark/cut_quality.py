# SPDX-License-Identifier: GPL-3.0-or-later
"""How maps are cut and how many islands result, as a Markdown table.

    PYTHONPATH=tests python tools/benchmark/cut_quality.py [--cones given 24 ...] [--seamless] [--front X Y Z] [--hide]
                                                           [--zoo N] [--limit SECONDS] [FOLDER ...]

FOLDER holds OBJ or OFF files (default: ../shared/meshes and its folder hard), with the cones of NAME.cones.json beside
them where these are asked for. N ordinary members of the zoo follow, one of each family as far as there are so many.
Every map is made in a process of its own, which is ended after SECONDS. Needs scipy and the lsgp wheel.

- overlap: the area of overlapping pairs before islands are split, in percent of the layout's area;
- islands: before and after;
- cut, added: length of the cuts after splitting, and by how much that is more than before, in square roots of the area;
- visible, crease: shares of that length, weighted by how many of the views around the front see the edge, and where the
  surface bends by 30 degrees or more;
- mirrored: share of that length whose mirror image is cut as well, where the mesh has one;
- defects: flipped triangles, wrong angle sums and overlapping triangles that are left;
- CPU s: of the map with split islands, by all threads.
"""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import lsgp
import numpy as np
import oracle
from own_process import in_own_process
from placement_quality import SHARED, of_zoo, read_surface
from scipy.spatial import cKDTree

FIGURES = (
    "triangles",
    "cones",
    "overlap",
    "islands",
    "cut",
    "added",
    "visible",
    "crease",
    "mirrored",
    "defects",
    "CPU s",
)
BEND = np.deg2rad(30)
UNSEEN = 0.1  # the cost of an edge that no view sees


@dataclass(frozen=True)
class Task:
    """cones: the number of automatic ones, "auto" for the default, or the file of given ones."""

    read: Callable[[], lsgp.Surface]
    cones: str | Path
    seamless: bool
    front: tuple[float, float, float]
    hide: bool


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folders", nargs="*", metavar="FOLDER", type=Path, default=[SHARED, SHARED / "hard"])
    parser.add_argument("--cones", nargs="+", default=["auto"], help="auto, given, or numbers (default: auto)")
    parser.add_argument("--seamless", action="store_true", help="seamless layouts instead of low stretch")
    parser.add_argument("--front", nargs=3, type=float, default=(0, 0, 1), metavar=("X", "Y", "Z"))
    parser.add_argument("--hide", action="store_true", help="cuts keep out of sight from the front and follow creases")
    parser.add_argument("--zoo", metavar="N", type=int, default=40, help="members of the zoo (default: 40)")
    parser.add_argument("--limit", metavar="SECONDS", type=float, default=120, help="for each map (default: 120)")
    arguments = parser.parse_args()
    print(f"| mesh | {' | '.join(FIGURES)} |\n|---|{'--:|' * len(FIGURES)}")
    for name, task in tasks(arguments):
        print(f"| {name} | {' | '.join(within(arguments.limit, task))} |", flush=True)


def tasks(arguments: argparse.Namespace) -> Iterator[tuple[str, Task]]:
    common = (arguments.seamless, tuple(arguments.front), arguments.hide)
    for cones in arguments.cones:
        for path in (
            path for folder in arguments.folders for path in sorted([*folder.glob("*.obj"), *folder.glob("*.off")])
        ):
            given = path.with_suffix(".cones.json")
            if cones != "given":
                yield f"{path.stem}, {cones}", Task(lambda path=path: read_surface(path), cones, *common)
            elif given.is_file():
                yield f"{path.stem}, given", Task(lambda path=path: read_surface(path), given, *common)
        if cones != "given":
            for name, read in of_zoo(arguments.zoo):
                yield f"{name}, {cones}", Task(read, cones, *common)


def within(limit: float, task: Task) -> list[str]:
    """The figures of a map, or why there are none."""
    told = in_own_process(lambda: figures_or_code(task), limit, [f"> {limit:g} s"], ["crash"])
    return told + [""] * (len(FIGURES) - len(told))


def figures_or_code(task: Task) -> list[str]:
    try:
        return figures(task)
    except lsgp.LsgpError as error:
        return [error.code]


def figures(task: Task) -> list[str]:
    surface = task.read()
    edges = inner_edges(surface)
    views = lsgp.cut_costs(replace(surface, edges=edges), task.front, creases=False) - UNSEEN
    if task.hide:
        surface = replace(surface, edges=edges if surface.edges is None else surface.edges)
        surface = replace(surface, cut_costs=lsgp.cut_costs(surface, task.front))
    cones, angles = cones_of(surface, task.cones)
    options = lsgp.Options(seamless=lsgp.Seamless()) if task.seamless else lsgp.Options(mode="low-stretch")
    kept = lsgp.parameterize(surface, cones, angles, options)
    begin = time.process_time()
    split = lsgp.parameterize(surface, cones, angles, replace(options, overlaps="split"))
    seconds = time.process_time() - begin
    length = np.linalg.norm(np.diff(surface.positions[edges], axis=1), axis=2).ravel()
    cut = is_in(edges, split.cut_edges) * length
    shares = [cut @ views, cut @ (bends(surface, edges) >= BEND)]
    mirrored = mirror_images(surface.positions)
    if mirrored is not None:
        shares.append(cut @ is_in(mirrored[edges], split.cut_edges))
    size = np.sqrt(oracle.triangle_areas(surface.positions, surface.triangles).sum())
    defects = len(split.flipped) + len(split.wrong_angle_sums) + len(split.overlapping)
    return [
        str(len(surface.triangles)),
        str(len(split.cones)),
        f"{100 * kept.overlap_area:.1f}",
        f"{kept.island.max() + 1} → {split.island.max() + 1}",
        f"{cut.sum() / size:.2f}",
        f"{(cut.sum() - is_in(edges, kept.cut_edges) @ length) / size:.2f}",
        *(f"{share / max(cut.sum(), 1e-300):.2f}" for share in shares),
        *[""] * (3 - len(shares)),
        str(defects),
        f"{seconds:.2f}",
    ]


def cones_of(surface: lsgp.Surface, cones: str | Path) -> tuple[object, object]:
    if isinstance(cones, Path):
        return json.loads(cones.read_text(encoding="utf-8"))["cones"], None
    placed = lsgp.place_cones(surface, count=None if cones == "auto" else int(cones))
    return placed.cones, placed.cone_angles


def inner_edges(surface: lsgp.Surface) -> np.ndarray:
    """Edges between two triangles, (e, 2), the lower vertex first."""
    sides = np.sort(surface.triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    edges, count = np.unique(sides, axis=0, return_counts=True)
    return edges[count == 2].astype(np.int32)


def is_in(edges: np.ndarray, some: np.ndarray) -> np.ndarray:
    """Whether each edge is among some, (e,) bool."""
    base = 1 + max(edges.max(initial=0), some.max(initial=0))
    first, second = (np.sort(one, axis=1).astype(np.int64) @ [base, 1] for one in (edges, some))
    return np.isin(first, second)


def bends(surface: lsgp.Surface, edges: np.ndarray) -> np.ndarray:
    """The angles by which the surface bends at edges, (e,) radians."""
    corners = surface.positions[surface.triangles]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-300)
    sides = np.sort(surface.triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1).astype(np.int64)
    base = 1 + sides.max()
    key, wanted = sides @ [base, 1], edges.astype(np.int64) @ [base, 1]
    order = np.argsort(key, kind="stable")
    first = order[np.searchsorted(key[order], wanted)] // 3
    second = order[np.searchsorted(key[order], wanted, "right") - 1] // 3
    return np.arccos(np.clip((normal[first] * normal[second]).sum(axis=1), -1, 1))


def mirror_images(positions: np.ndarray) -> np.ndarray | None:
    """The vertex opposite each one, (n,), of the first of three planes through the middle that leaves none out."""
    tree = cKDTree(positions)
    middle = (positions.min(axis=0) + positions.max(axis=0)) / 2
    for axis in range(3):
        opposite = positions.copy()
        opposite[:, axis] = 2 * middle[axis] - opposite[:, axis]
        distance, image = tree.query(opposite)
        if distance.max() <= 1e-4 * np.ptp(positions, axis=0).max():
            return image
    return None


if __name__ == "__main__":
    main()
