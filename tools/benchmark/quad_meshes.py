# SPDX-License-Identifier: GPL-3.0-or-later
"""Quad meshes beside those of Blender's QuadriFlow: a Markdown table.

    PYTHONPATH=tests python tools/benchmark/quad_meshes.py [PATH ...] [--bpy PYTHON] [--quads N ...] [--limit SECONDS]

PATH is an OBJ or OFF file, or a folder of them (default: ../shared/meshes and its folder hard); open and one-sided
surfaces are left out. --bpy names a Python with bpy; without it only our meshes are measured. Each mesh is made in a
process of its own, which is ended after SECONDS of wall time. *Valid*: only quads of four vertices, every edge in two
of them with opposite directions, one fan of quads at each vertex, the surface's Euler characteristic; otherwise what is
not so. Needs the lsgp wheel and scipy.
"""

from __future__ import annotations

import argparse
import subprocess
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NamedTuple

import lsgp
import numpy as np
import oracle
from meshes import euler_characteristic
from numpy.typing import NDArray
from own_process import in_own_process
from placement_quality import SHARED, read_surface
from quad_checks import fans, sides
from scipy.spatial import cKDTree

IN_BLENDER = Path(__file__).with_name("quads_in_blender.py")
NOT_CLOSED = ("OPEN_SURFACE", "NOT_ORIENTABLE")
SUFFIXES = (".obj", ".off")
COLUMNS = (
    *("mesh", "asked", "", "s", "quads", "valid", "irregular", "corners off, mean / worst", "edges"),
    *("distance, mean", "worst", "creases"),
)
SAMPLES = 12  # along a side of a quad, and along a crease
SHARP, PARALLEL, NEAR = np.radians(40), np.radians(20), 0.1

Points = NDArray[np.float64]


class Quads(NamedTuple):
    """Faces of four vertices, the number of other ones, and seconds of wall time."""

    positions: Points
    faces: NDArray[np.int64]
    others: int
    seconds: float


Made = Quads | str  # or why there are none


def mesh_files(paths: list[Path]) -> list[Path]:
    """These files, and those in these folders."""
    found = []
    for path in paths:
        inside = sorted(file for file in path.iterdir() if file.suffix in SUFFIXES) if path.is_dir() else [path]
        found.extend(inside)
    return found


def ours(surface: lsgp.Surface, quads: int, limit: float) -> Made:
    def remesh() -> Made:
        before = time.perf_counter()
        try:
            mesh = lsgp.remesh_to_quads(surface, target=quads).mesh
        except lsgp.LsgpError as error:
            return error.code
        return Quads(mesh.positions, mesh.quads.astype(np.int64), 0, time.perf_counter() - before)

    return in_own_process(remesh, limit, f"> {limit:g} s", "crash")


def quadriflow(python: str) -> Callable[[lsgp.Surface, int, float], Made]:
    def remesh(surface: lsgp.Surface, quads: int, limit: float) -> Made:
        with tempfile.TemporaryDirectory() as folder:
            source, target = Path(folder, "surface.npz"), Path(folder, "mesh.npz")
            np.savez(source, positions=surface.positions, triangles=surface.triangles)
            command = [python, str(IN_BLENDER), str(source), str(quads), str(target)]
            try:
                subprocess.run(command, check=True, capture_output=True, timeout=limit)
            except subprocess.TimeoutExpired:
                return f"> {limit:g} s"
            except subprocess.CalledProcessError:
                return "crash"
            found = np.load(target)
            if not len(found["faces"]):
                return "none"
            return Quads(found["positions"], found["faces"], int(found["others"]), float(found["seconds"]))

    return remesh


def defects(surface: lsgp.Surface, quads: Quads) -> str:
    """What makes the mesh invalid."""
    found = []
    if quads.others:
        found.append(f"{quads.others} no quads")
    if any(len(set(quad)) < 4 for quad in quads.faces.tolist()):
        found.append("repeated vertices")
    once = sides(quads.faces)
    is_closed = set(once.values()) == {1} and all((b, a) in once for a, b in once)
    used = len(np.unique(quads.faces))
    if not is_closed or fans(quads.faces) != used:
        found.append("no closed manifold")
    edges = len({(min(side), max(side)) for side in once})
    euler, kept = euler_characteristic(surface.triangles), used - edges + len(quads.faces)
    if not quads.others and kept != euler:
        found.append(f"Euler {kept} for {euler}")
    return ", ".join(found)


def irregular(quads: Quads) -> int:
    """The number of vertices not in four quads."""
    return int((np.bincount(quads.faces.ravel(), minlength=len(quads.positions))[np.unique(quads.faces)] != 4).sum())


def sampled(quads: Quads) -> tuple[Points, Points]:
    """Points distributed over the quads, as bilinear patches, and the unit normals there."""
    s, t = (part.ravel() for part in np.meshgrid(*[(np.arange(SAMPLES) + 0.5) / SAMPLES] * 2))
    a, b, c, d = (quads.positions[quads.faces[:, k], None] for k in range(4))
    s, t = s[:, None], t[:, None]
    points = (1 - s) * (1 - t) * a + s * (1 - t) * b + s * t * c + (1 - s) * t * d
    normals = np.cross((1 - t) * (b - a) + t * (c - d), (1 - s) * (d - a) + s * (c - b))
    normals /= np.maximum(np.linalg.norm(normals, axis=2, keepdims=True), np.finfo(float).tiny)
    return points.reshape(-1, 3), normals.reshape(-1, 3)


def distances(surface: lsgp.Surface, quads: Quads) -> Points:
    """From points distributed evenly over the surface to the quads."""
    corners = surface.positions[surface.triangles]
    area = oracle.triangle_areas(surface.positions, surface.triangles)
    rng = np.random.default_rng(1)
    drawn = corners[rng.choice(len(corners), 20000, p=area / area.sum())]
    weights = rng.dirichlet((1, 1, 1), len(drawn))
    points, (samples, normals) = (weights[..., None] * drawn).sum(axis=1), sampled(quads)
    away, nearest = cKDTree(samples).query(points)
    across = np.abs(((points - samples[nearest]) * normals[nearest]).sum(axis=1))
    return np.minimum(away, across)


def creases(surface: lsgp.Surface) -> tuple[Points, Points]:
    """Both ends of every sharp edge."""
    triangles = surface.triangles.astype(np.int64)
    corners = surface.positions[triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), np.finfo(float).tiny)
    edges = np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=2).reshape(-1, 2)
    order = np.lexsort(np.sort(edges, axis=1).T)
    first, second = order[::2], order[1::2]  # closed: every edge has two triangles
    bend = np.arccos(np.clip((normals[first // 3] * normals[second // 3]).sum(axis=1), -1, 1))
    sharp = edges[first[bend > SHARP]]
    return surface.positions[sharp[:, 0]], surface.positions[sharp[:, 1]]


def kept_share(surface: lsgp.Surface, quads: Quads) -> float:
    """Of the length of creases: within a tenth of a quad's side of an edge that runs along; NaN without creases."""
    begin, end = creases(surface)
    if not len(begin):
        return float("nan")
    ends = quads.positions[np.stack([quads.faces, np.roll(quads.faces, -1, axis=1)], axis=2).reshape(-1, 2)]
    edge = ends[:, 1] - ends[:, 0]
    length = np.linalg.norm(edge, axis=1)
    steps = (np.arange(4 * SAMPLES) + 0.5) / (4 * SAMPLES)
    samples = (ends[:, :1] + steps[:, None] * edge[:, None]).reshape(-1, 3)
    crease = end - begin
    points = (begin[:, None] + (np.arange(3) + 0.5)[:, None] / 3 * crease[:, None]).reshape(-1, 3)
    weight = np.repeat(np.linalg.norm(crease, axis=1), 3)
    kept = np.zeros(len(points), bool)
    away, nearest = cKDTree(samples).query(points, k=8)  # points of a crossing edge may be nearer
    for k in range(away.shape[1]):
        along = edge[nearest[:, k] // len(steps)]
        cosine = np.abs((along * np.repeat(crease, 3, axis=0)).sum(axis=1))
        cosine /= np.maximum(np.linalg.norm(along, axis=1) * weight, np.finfo(float).tiny)
        kept |= (away[:, k] < NEAR * length.mean()) & (cosine > np.cos(PARALLEL))
    return float(weight[kept].sum() / weight.sum())


def cells(surface: lsgp.Surface, quads: Made) -> Iterator[str]:
    if isinstance(quads, str):
        yield quads
        yield from ["-"] * 8
        return
    quality, away = lsgp.quad_quality(quads.positions, quads.faces), distances(surface, quads)
    size = np.linalg.norm(np.ptp(surface.positions, axis=0))
    yield f"{quads.seconds:.1f}"
    yield str(len(quads.faces))
    yield defects(surface, quads) or "yes"
    yield str(irregular(quads))
    yield f"{np.degrees(quality.angle_error):.1f} / {np.degrees(quality.worst_angle_error):.0f}"
    yield f"{quality.edge_deviation:.2f}"
    yield f"{away.mean() / size:.1e}"
    yield f"{away.max() / size:.1e}"
    kept = kept_share(surface, quads)
    yield "-" if np.isnan(kept) else f"{kept:.2f}"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("paths", nargs="*", metavar="PATH", type=Path, default=[SHARED, SHARED / "hard"])
    parser.add_argument("--bpy", metavar="PYTHON", help="a Python with bpy")
    parser.add_argument("--quads", metavar="N", type=int, nargs="+", default=[500, 2000, 10000])
    parser.add_argument("--limit", metavar="SECONDS", type=float, default=150, help="of each process (default: 150)")
    arguments = parser.parse_args()
    makers = {"ours": ours}
    if arguments.bpy:
        makers["QuadriFlow"] = quadriflow(arguments.bpy)
    print(f"| {' | '.join(COLUMNS)} |")
    print("|---|--:|---|--:|--:|---|" + "--:|" * 6)
    for file in mesh_files(arguments.paths):
        surface = read_surface(file)
        for quads in arguments.quads:
            for maker, make in makers.items():
                made = make(surface, quads, arguments.limit)
                if made in NOT_CLOSED:
                    break
                print(f"| {' | '.join([file.stem, str(quads), maker, *cells(surface, made)])} |", flush=True)


if __name__ == "__main__":
    main()
