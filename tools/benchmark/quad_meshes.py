# SPDX-License-Identifier: GPL-3.0-or-later
"""Quad meshes beside those of Blender's QuadriFlow: a Markdown table.

    PYTHONPATH=tests python tools/benchmark/quad_meshes.py [--bpy PYTHON] [--quads N ...] [FOLDER]

FOLDER holds closed meshes (default: ../shared/meshes); those that are missing are left out. --bpy names a Python with
bpy; without it only our meshes are measured. Needs the lsgp wheel and scipy.
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
from numpy.typing import NDArray
from placement_quality import SHARED
from scipy.spatial import cKDTree

MODELS = ("fandisk", "kitten-genus1", "hand-5k", "max-planck-25k", "elephant-genus3")
IN_BLENDER = Path(__file__).with_name("quads_in_blender.py")
LONGEST = 500  # seconds
SAMPLES = 12  # along a side of a quad, and along a crease
SHARP, PARALLEL, NEAR = np.radians(40), np.radians(20), 0.1

Points = NDArray[np.float64]


class Quads(NamedTuple):
    positions: Points
    faces: NDArray[np.int64]
    seconds: float


def ours(surface: lsgp.Surface, quads: int) -> Quads:
    before = time.perf_counter()
    mesh = lsgp.remesh_to_quads(surface, target=quads).mesh
    return Quads(mesh.positions, mesh.quads.astype(np.int64), time.perf_counter() - before)


def quadriflow(python: str) -> Callable[[lsgp.Surface, int], Quads]:
    def remesh(surface: lsgp.Surface, quads: int) -> Quads:
        with tempfile.TemporaryDirectory() as folder:
            source, target = Path(folder, "surface.npz"), Path(folder, "mesh.npz")
            np.savez(source, positions=surface.positions, triangles=surface.triangles)
            command = [python, str(IN_BLENDER), str(source), str(quads), str(target)]
            subprocess.run(command, check=True, capture_output=True, timeout=LONGEST)
            found = np.load(target)
            return Quads(found["positions"], found["faces"], float(found["seconds"]))

    return remesh


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


def cells(surface: lsgp.Surface, quads: Quads) -> Iterator[str]:
    if not len(quads.faces):
        yield from ["-"] * 8
        return
    quality, away = lsgp.quad_quality(quads.positions, quads.faces), distances(surface, quads)
    size = np.linalg.norm(np.ptp(surface.positions, axis=0))
    yield f"{quads.seconds:.1f}"
    yield str(len(quads.faces))
    yield str(irregular(quads))
    yield f"{np.degrees(quality.angle_error):.1f} / {np.degrees(quality.worst_angle_error):.0f}"
    yield f"{quality.edge_deviation:.2f}"
    yield f"{away.mean() / size:.1e}"
    yield f"{away.max() / size:.1e}"
    kept = kept_share(surface, quads)
    yield "-" if np.isnan(kept) else f"{kept:.2f}"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", metavar="FOLDER", nargs="?", type=Path, default=SHARED)
    parser.add_argument("--bpy", metavar="PYTHON", help="a Python with bpy")
    parser.add_argument("--quads", metavar="N", type=int, nargs="+", default=[500, 2000, 10000])
    arguments = parser.parse_args()
    makers = {"ours": ours}
    if arguments.bpy:
        makers["QuadriFlow"] = quadriflow(arguments.bpy)
    print(
        "| | asked | | s | quads | irregular | corners off, mean / worst | edges | distance, mean | worst | creases |"
    )
    print("|---|--:|---|" + "--:|" * 8)
    for name in MODELS:
        file = arguments.folder / f"{name}.obj"
        if not file.is_file():
            continue
        surface = lsgp.read_mesh_file(str(file)).surface()
        for quads in arguments.quads:
            for maker, make in makers.items():
                row = [name, str(quads), maker, *cells(surface, make(surface, quads))]
                print(f"| {' | '.join(row)} |", flush=True)


if __name__ == "__main__":
    main()
