# SPDX-License-Identifier: GPL-3.0-or-later
"""A mesh file in, a file of cones placed on it and their angles out."""

from __future__ import annotations

import argparse
import json
from dataclasses import replace
from pathlib import Path
from typing import Any, get_args

from ..api import place_cones
from ..base.counted import counted
from ..base.progress import Progress
from ..io.side_files import UsageError, cones_in, load_json, pairs_in
from ..io.whole_files import write_output
from ..options import Lattice, SeamMode
from ..results import Placement
from .named_files import Reads, written_files
from .report import finite, placed_figures
from .unwrap_file import Run, read_file, require_flawless
from .unwrap_options import (
    add_cut_options,
    add_stitch_option,
    add_strict_option,
    cut_costs_of,
    require_cut_options,
    stitches,
)

DEFAULT_LATTICE = "square"


def add_placement_options(cones: argparse.ArgumentParser) -> None:
    """The options of placing cones, which args of `place_file` have."""
    number = cones.add_mutually_exclusive_group()
    number.add_argument("--count", metavar="N", type=int, help="cones on each component, including kept ones")
    number.add_argument(
        "--target",
        metavar="L2",
        type=float,
        help="the fewest cones with which each component's map has at most this L2 stretch, 1 being none "
        "(default: 1.05)",
    )
    cones.add_argument(
        "--keep", metavar="FILE.json", action=_Completes, help="a cones file to complete; its cone_angles are kept"
    )
    cones.add_argument(
        "--seamless", action="store_true", help="choose positions and angles together for a seamless layout"
    )
    cones.add_argument(
        "--lattice",
        choices=get_args(Lattice),
        help=f"with --seamless: angles are multiples of its rotation (default: {DEFAULT_LATTICE})",
    )
    cones.add_argument("--symmetric", action="store_true", help="the same cones on both sides of a mirror plane")
    cones.add_argument(
        "--mirror",
        metavar=("PX", "PY", "PZ", "NX", "NY", "NZ"),
        nargs=6,
        type=float,
        help="with --symmetric: a point on the plane and its normal (default: detected)",
    )
    cones.add_argument(
        "--prefer-sharp", action="store_true", help="prefer sharp corners to smooth regions if that costs little"
    )
    cones.add_argument(
        "--seam-edges", metavar="FILE.json", action=Reads, help="[[a, b], ...]: marked edges, as for lsgp unwrap"
    )
    cones.add_argument(
        "--seams", choices=get_args(SeamMode), default="follow", help="meaning of marked edges, as for lsgp unwrap"
    )
    add_cut_options(cones)
    add_stitch_option(cones, default=False)
    add_strict_option(cones, "set of cones")


class _Completes(Reads):
    """A file of cones that the output, which has them too, may replace."""

    completed_by = "--output"


def place_file(args: argparse.Namespace, run: Run, progress: Progress | None = None) -> Placement:
    """Place cones on args.input and write them into args.output.  Raises OSError, UsageError, LsgpError."""
    how = _placement(args)
    require_cut_options(args)
    kept_json = None if args.keep is None else load_json(Path(args.keep))
    seams_path = None if args.seam_edges is None else Path(args.seam_edges)
    seams_json = [] if seams_path is None else load_json(seams_path)
    file = read_file(args.input, run, args.format, stitch=stitches(args), written=written_files(args))
    kept, angles = ((), None) if kept_json is None else file.cones(*cones_in(kept_json, Path(args.keep), None))
    surface = file.surface(pairs_in(seams_json, seams_path, "seam vertex"))
    with run.stage("cut_costs"):
        surface = replace(surface, cut_costs=cut_costs_of(args, surface, file.stitched))
    with run.stage("place_cones"):
        placement = place_cones(surface, kept, angles, seams=args.seams, threads=args.threads, **how, progress=progress)
    if args.strict:
        require_flawless([*file.findings, *placement.warnings])
    with run.stage("write_file"):
        write_output(args.output, _cones_file(args.input, placement))
    return replace(placement, warnings=file.told(placement.warnings))


def summary(args: argparse.Namespace, placement: Placement) -> str:
    """The placed cones and their stretch, on one line."""
    told = f"{args.output}: {counted(len(placement.cones), 'cone')}"
    told += f", an L2 stretch of {placement.predicted_l2:.4f} predicted"
    told += f" and {placement.mapped_l2:.4f} in the map"
    if args.count is None:
        told += f", the target was {'' if placement.reached else 'not '}reached"
    told += f"; {counted(placement.maps, 'map')}, {counted(placement.factorizations, 'factorization')}"
    return f"{told}, {counted(placement.back_substitutions, 'back-substitution')}"


def _placement(args: argparse.Namespace) -> dict[str, Any]:
    """The options as the library takes them.  Raises UsageError where they do not go together."""
    if args.lattice is not None and not args.seamless:
        raise UsageError("--lattice is for seamless layouts; add --seamless")
    if args.mirror is not None and not args.symmetric:
        raise UsageError("--mirror is for symmetric cones; add --symmetric")
    how: dict[str, Any] = {"count": args.count, "prefer_sharp": args.prefer_sharp, "symmetric": args.symmetric}
    if args.target is not None:
        how["target"] = args.target
    if args.seamless:
        how["lattice"] = args.lattice or DEFAULT_LATTICE
    if args.mirror is not None:
        how["mirror"] = (args.mirror[:3], args.mirror[3:])
    return how


def _cones_file(mesh: Path, placement: Placement) -> bytes:
    """The cones and their angles as `lsgp unwrap --cones` reads them, and what they promise."""
    content = {
        "mesh": mesh.name,
        "cones": placement.cones.tolist(),
        "cone_angles": placement.cone_angles.tolist(),
        **placed_figures(placement),
    }
    return (json.dumps(finite(content), allow_nan=False) + "\n").encode("ascii")
