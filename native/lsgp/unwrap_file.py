# SPDX-License-Identifier: GPL-3.0-or-later
"""A mesh file in, the same mesh with texture coordinates out."""

from __future__ import annotations

import argparse
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

from .api import Options, Progress, Result, Surface, parameterize, place_cones
from .errors import InputError, LsgpError
from .mesh_files import read_mesh, write_obj
from .polygons import PolygonMesh, Triangulation, triangulate
from .side_files import cones_in, load_importance, load_json, seam_edges_in
from .unwrap_options import cone_count, cones_file, library_options

# The share of placing cones in the time of an unwrap.
PLACING = 0.6


@dataclass
class Run:
    """What a command has found out so far; enough to report on a refusal at any point."""

    triangulation: Triangulation | None = None
    surface: Surface | None = None
    stage_seconds: dict[str, float] = field(default_factory=dict)

    @contextmanager
    def stage(self, name: str) -> Iterator[None]:
        begin = time.perf_counter()
        yield
        self.stage_seconds[name] = time.perf_counter() - begin


def unwrap_file(args: argparse.Namespace, run: Run, progress: Progress | None = None) -> Result:
    """Unwrap args.input into args.output.  Raises OSError, UsageError, LsgpError.

    args: these two and the values of the options of an unwrap.
    """
    options = library_options(args)
    mesh, result = _map(args, options, run, progress)
    with run.stage("write_file"):
        corner_uv = run.triangulation.to_polygon_corners(result.corner_uv, len(mesh.corners))
        write_obj(args.output, mesh, corner_uv)
    return result


def part_of(progress: Progress | None, begin: float, end: float) -> Progress | None:
    """Tells progress of a part of the work, which lies between begin and end."""
    return None if progress is None else lambda done: progress(begin + (end - begin) * done)


def out_of_memory() -> LsgpError:
    """What a MemoryError is to the user."""
    return LsgpError(
        "OUT_OF_MEMORY", "There is not enough memory for this mesh. Use a machine with more or fewer faces."
    )


def read_file(path: Path, run: Run, with_uv: bool = False) -> tuple[PolygonMesh, Triangulation]:
    """The mesh of a file and its triangles.  Raises OSError, InputError."""
    with run.stage("read_file"):
        mesh = read_mesh(path, with_uv)
    if with_uv and mesh.corner_uv is None:
        raise InputError("NO_UV", "Only OBJ files are read with texture coordinates. Convert the file to OBJ.")
    with run.stage("triangulate"):
        run.triangulation = triangulate(mesh)
    return mesh, run.triangulation


def _map(args: argparse.Namespace, options: Options, run: Run, progress: Progress | None) -> tuple[PolygonMesh, Result]:
    """The mesh that was given and its map."""
    cones_path = cones_file(args)
    seams_path = None if args.seam_edges is None else Path(args.seam_edges)
    cones_json = None if cones_path is None else load_json(cones_path)
    seams_json = [] if seams_path is None else load_json(seams_path)
    importance = None if args.importance is None else load_importance(Path(args.importance))
    mesh, triangulation = read_file(args.input, run)
    if importance is not None and len(importance) != len(mesh.positions):
        raise InputError(
            "WRONG_PARAMETER",
            f"'{args.importance}' has {len(importance)} numbers for {len(mesh.positions)} vertices. Give one for each.",
        )
    seams = seam_edges_in(seams_json, seams_path)
    surface = Surface(mesh.positions, triangulation.triangles, triangulation.edges, seams, importance)
    run.surface = surface
    if cones_path is not None:
        cones, angles = cones_in(cones_json, cones_path, args.prescription)
    else:
        with run.stage("place_cones"):
            placed = place_cones(
                surface,
                count=cone_count(args),
                lattice=None if options.seamless is None else options.seamless.lattice,
                seams=options.seams,
                progress=part_of(progress, 0.0, PLACING),
            )
        # The angles are for free borders.
        as_placed = options.prescription is None and options.border == "free"
        cones, angles = placed.cones, placed.cone_angles if as_placed else None
        progress = part_of(progress, PLACING, 1.0)
    result = parameterize(surface, cones, angles, options, progress=progress)
    run.stage_seconds.update(result.stage_seconds)
    return mesh, result
