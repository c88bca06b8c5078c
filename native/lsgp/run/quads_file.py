# SPDX-License-Identifier: GPL-3.0-or-later
"""A mesh file in, a file of quads that cover its surface out."""

from __future__ import annotations

import argparse
import math
from collections import Counter
from dataclasses import replace
from pathlib import Path

import numpy as np

from ..base.arguments import FloatArray
from ..base.progress import Progress
from ..io.mesh_formats import OBJ, output_format
from ..io.mesh_obj import format_obj
from ..io.polygons import PolygonMesh
from ..io.safe_files import is_standard_stream
from ..io.side_files import UsageError, cones_in, load_density, load_json
from ..io.whole_files import write_output
from ..options import Options, Seamless
from ..quads.quad_mesh import QuadQuality
from ..quads.remeshing import QuadRemesh, remesh_to_quads
from .direction_options import add_direction_options, load_directions, require_finite_up, strokes_of
from .feature_options import add_features_option, features_of
from .named_files import Reads, written_files
from .unwrap_file import Run, read_file
from .unwrap_options import (
    add_cones_option,
    add_mode_option,
    add_stitch_option,
    add_stretch_option,
    cone_count,
    cones_file,
    stitches,
)

_ON_FEATURE = 1e-6  # sides of a quad


def add_quads_options(quads: argparse.ArgumentParser) -> None:
    """The options of a remesh, which args of `quads_file` have."""
    number = quads.add_mutually_exclusive_group()
    number.add_argument(
        "--target",
        metavar="N",
        type=int,
        help="approximate number of quads; more if so few have no valid grid (default: the fewest that cost at most a "
        "tenth in distortion)",
    )
    number.add_argument("--size", metavar="X", type=float, help="side of a quad on the surface, in its unit")
    quads.add_argument(
        "--density",
        metavar="FILE",
        action=Reads,
        help="the number of quads per area at each vertex, relative to the others: a JSON list of one number for each "
        "vertex, [[vertex, number], ...] with 1 elsewhere, or numbers as text; 4 makes quads half as long. --size is "
        "the side where it is 1",
    )
    add_cones_option(quads)
    add_mode_option(quads)
    add_stretch_option(quads)
    add_direction_options(
        quads,
        "the grid is rotated so that rows of quads follow it, as far as the cones permit (default: any rotation)",
        "rows of quads",
    )
    add_features_option(
        quads,
        "edges that rows of quads follow, as far as they do not contradict each other and cost at most a fifth of L2 "
        "stretch; they have precedence over creases of hard surfaces, which are followed anyway",
    )
    quads.add_argument(
        "--no-straighten",
        dest="straighten",
        action="store_false",
        help="do not follow the creases of hard surfaces, which needs further irregular vertices and distorts quads; "
        "by default rows of quads run along them where that costs at most a fifth of L2 stretch",
    )
    quads.add_argument(
        "--polish",
        action="store_true",
        help="then move vertices over the surface, so that edges are more equal at corners about as square as before",
    )
    add_stitch_option(quads, default=True)
    quads.add_argument(
        "--coarse-grid",
        choices=["refine", "merge"],
        default="refine",
        help="if the quads are too large for a valid grid: use smaller ones, or merge cones less than a quad apart "
        "(default: refine)",
    )


def require_quads_output(args: argparse.Namespace) -> None:
    """Raises UsageError where args.output is no file of quads."""
    target = None if is_standard_stream(args.output) else args.output
    if output_format(target, None) != OBJ:
        raise UsageError(f"quads are written as OBJ; name the output .obj, not '{args.output}'")


def quads_file(args: argparse.Namespace, run: Run, progress: Progress | None = None) -> QuadRemesh:
    """Cover args.input with quads and write them into args.output.  Raises OSError, UsageError, LsgpError."""
    options = _options(args)
    require_finite_up(args)
    path = cones_file(args)
    cones_json = None if path is None else load_json(path)
    directions_json = load_directions(args)
    density = None if args.density is None else load_density(Path(args.density))
    file = read_file(args.input, run, args.format, stitch=stitches(args), written=written_files(args))
    given = ((), None) if path is None else file.cones(*cones_in(cones_json, path, None))
    surface, strokes = file.surface(), strokes_of(args, directions_json, file)
    directions = args.up if strokes is None else strokes.directions
    surface = replace(surface, directions=directions, features=features_of(args.features, surface, file.stitched))
    with run.stage("remesh_to_quads"):
        remesh = remesh_to_quads(
            surface,
            *given,
            target=args.target,
            size=args.size,
            options=options,
            count=cone_count(args),
            polish=args.polish,
            density=None if density is None else density.at_vertices(len(file.mesh.positions)),
            progress=progress,
        )
    mesh = PolygonMesh(remesh.mesh.positions, remesh.mesh.quads.ravel(), np.full(len(remesh.mesh.quads), 4, np.int64))
    with run.stage("write_file"):
        write_output(args.output, format_obj(mesh, np.full((len(mesh.corners), 2), np.nan)))
    return replace(remesh, warnings=file.told(remesh.warnings))


def summary(output: Path, remesh: QuadRemesh, quality: QuadQuality) -> str:
    """The result and its quality, as lines of text."""
    mesh = remesh.mesh
    irregular = Counter(mesh.valences[mesh.irregular].tolist())
    kinds = ", ".join(f"{irregular[valence]} of valence {valence}" for valence in sorted(irregular))
    distances = remesh.feature_distances()
    where, at_density = ("", "") if remesh.density is None else (" where the density is 1", " by the density")
    angle, worst = math.degrees(quality.angle_error), math.degrees(quality.worst_angle_error)
    return "\n".join(
        [
            f"{output}: {len(mesh.quads)} quads of side {remesh.layout.seamless.tile_size:.4g}{where}, "
            f"{len(mesh.positions)} vertices, {len(mesh.irregular)} irregular{f' ({kinds})' if kinds else ''}",
            f"corners off 90 degrees: {angle:.1f} on average, {worst:.1f} at most",
            f"edges{at_density}: {quality.edge_deviation:.1%} standard deviation, from {quality.shortest_edge:.2f} to "
            f"{quality.longest_edge:.2f} of the mean",
            *_place_of_irregular(distances),
        ]
    )


def _place_of_irregular(distances: FloatArray) -> list[str]:
    """distances: as of `QuadRemesh.feature_distances`."""
    if not len(distances):
        return []
    off = distances[distances > _ON_FEATURE]
    others = f"; the others {off.mean():.1f} quads from them on average" if len(off) else ""
    return [f"{len(distances) - len(off)} of {len(distances)} irregular vertices on creases or marked edges{others}"]


def _options(args: argparse.Namespace) -> Options:
    """Raises UsageError where they do not go together."""
    if args.stretch is not None and args.mode != "low-stretch":
        raise UsageError("--stretch is for maps of low stretch; add --mode low-stretch")
    return Options(
        seamless=Seamless(coarse_grid=args.coarse_grid),
        mode=args.mode or "conformal",
        stretch=1.0 if args.stretch is None else args.stretch,
        straighten=args.straighten,
        threads=args.threads,
    )
