# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether meshes of quads are valid, by checks that do not use the library: a Markdown table.

    PYTHONPATH=tests python tools/benchmark/quad_validity.py [PATH ...] [--quads N ...] [--limit SECONDS] [--once]

PATH is an OBJ or OFF file, or a folder of them (default: ../shared/meshes and its folder hard). Every mesh is made in
processes of their own with one thread and with two, each of which is ended after SECONDS; seconds are CPU time of the
first. --once leaves out the second. *Valid*: quads of four vertices, every edge in two of them with opposite
directions, one fan of quads at each vertex, the surface's Euler characteristic, vertices on the surface, and irregular
ones exactly at the cones of the layout, with their quarter turns as valences; otherwise what is not so. Needs the lsgp
wheel and scipy.
"""

from __future__ import annotations

import argparse
import hashlib
import time
from collections.abc import Callable
from dataclasses import fields
from pathlib import Path
from typing import NamedTuple

import lsgp
import numpy as np
from numpy.typing import NDArray
from own_process import in_own_process
from placement_quality import SHARED, read_surface
from quad_checks import require_closed_quads, require_on_surface
from quad_meshes import mesh_files
from scipy.spatial import cKDTree

COLUMNS = ("mesh", "triangles", "asked", "quads", "irregular", "valid", "same bytes", "s", "told")
NEAR = 1e-9  # of the diagonal
WHOLE = 1e-3  # quarter turns


class Found(NamedTuple):
    """What a remesh has found.  digest: of all arrays of the mesh, empty if there is none"""

    quads: int | None = None
    irregular: int | None = None
    valid: str = ""
    seconds: float | None = None
    told: str = ""
    digest: str = ""


def remesh(surface: lsgp.Surface, quads: int, threads: int) -> Found:
    options = lsgp.Options(seamless=lsgp.Seamless(), straighten=True, threads=threads)
    begin = time.process_time()
    try:
        made = lsgp.remesh_to_quads(surface, target=quads, options=options)
    except lsgp.LsgpError as error:
        return Found(seconds=time.process_time() - begin, told=error.code)
    seconds = time.process_time() - begin
    digest = hashlib.sha256()
    for field in fields(made.mesh):
        digest.update(np.ascontiguousarray(getattr(made.mesh, field.name)).tobytes())
    return Found(
        quads=len(made.mesh.quads),
        irregular=len(made.mesh.irregular),
        valid=defects(surface, made) or "yes",
        seconds=seconds,
        told=", ".join(sorted({finding.code for finding in made.warnings})),
        digest=digest.hexdigest(),
    )


def defects(surface: lsgp.Surface, made: lsgp.QuadRemesh) -> str:
    """The checks that the mesh does not pass."""
    checks = {
        "no closed manifold": lambda: require_closed_quads(surface, made.mesh),
        "off the surface": lambda: require_on_surface(surface, made.mesh),
        "irregular elsewhere": lambda: require_cones_of_layout(made),
    }
    return ", ".join(name for name, check in checks.items() if not passes(check))


def passes(check: Callable[[], None]) -> bool:
    try:
        check()
    except AssertionError:
        return False
    return True


def require_cones_of_layout(made: lsgp.QuadRemesh) -> None:
    """By place, since cones may be at vertices that the given surface does not have."""
    size = np.linalg.norm(np.ptp(made.surface.positions, axis=0))
    turns = quarter_turns(made.surface, made.layout.corner_uv)
    cones = np.flatnonzero((turns != 4) & np.isin(np.arange(len(turns)), made.surface.triangles))
    irregular = made.mesh.irregular
    assert len(cones) == len(irregular)
    if not len(cones):
        return
    away, at = cKDTree(made.surface.positions[cones]).query(made.mesh.positions[irregular])
    assert sorted(at.tolist()) == list(range(len(cones))) and away.max() <= NEAR * size
    assert np.array_equal(turns[cones][at], made.mesh.valences[irregular])


def quarter_turns(surface: lsgp.Surface, corner_uv: NDArray[np.float64]) -> NDArray[np.int64]:
    """Around each vertex of a layout, of which triangles may be given in either orientation."""
    ahead, back = np.roll(corner_uv, -1, axis=1) - corner_uv, np.roll(corner_uv, 1, axis=1) - corner_uv
    across = np.abs(ahead[..., 0] * back[..., 1] - ahead[..., 1] * back[..., 0])
    angles = np.arctan2(across, (ahead * back).sum(axis=-1)).ravel() / (np.pi / 2)
    sums = np.bincount(surface.triangles.ravel(), angles, len(surface.positions))
    turns = np.round(sums)
    assert np.abs(sums - turns).max() < WHOLE
    return turns.astype(np.int64)


def row(surface: lsgp.Surface, quads: int, limit: float, once: bool) -> list[str]:
    ends = Found(told=f"> {limit:g} s"), Found(told="crash")
    first = in_own_process(lambda: remesh(surface, quads, 1), limit, *ends)
    same = ""
    if first.digest and not once:
        second = in_own_process(lambda: remesh(surface, quads, 2), limit, *ends)
        same = "yes" if second.digest == first.digest else second.told if not second.digest else "no"
    figures = ["" if value is None else str(value) for value in (first.quads, first.irregular)]
    seconds = "" if first.seconds is None else f"{first.seconds:.1f}"
    return [str(len(surface.triangles)), str(quads), *figures, first.valid, same, seconds, first.told]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("paths", nargs="*", metavar="PATH", type=Path, default=[SHARED, SHARED / "hard"])
    parser.add_argument("--quads", metavar="N", type=int, nargs="+", default=[500, 2000, 10000])
    parser.add_argument("--limit", metavar="SECONDS", type=float, default=240, help="of each process (default: 240)")
    parser.add_argument("--once", action="store_true", help="with one thread alone")
    arguments = parser.parse_args()
    print(f"| {' | '.join(COLUMNS)} |")
    print("|---|" + "--:|" * 4 + "---|---|--:|---|")
    for file in mesh_files(arguments.paths):
        surface = read_surface(file)
        for quads in arguments.quads:
            cells = row(surface, quads, arguments.limit, arguments.once)
            print(f"| {file.stem} | {' | '.join(cells)} |", flush=True)


if __name__ == "__main__":
    main()
