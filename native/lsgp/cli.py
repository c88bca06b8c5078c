# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line: `lsgp unwrap`, `lsgp cones`, `lsgp batch` and `lsgp measure`.

Exit code 0: a result, with warnings or not; 2: wrong usage, a file that is missing or cannot be written; 3: the input
was refused, with a code and a sentence that says what to do; 130: interrupted, with Ctrl-C for instance.  Of a batch 0:
all assets have a result, 4: some, 3: none.  Files are written at the end, each as a whole or not at all.
"""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from . import __version__
from . import report as reports
from .api import Surface, measure_distortion
from .batch.command import EXIT_CODES, add_batch_options, add_scheduler_option, run_batch
from .certificate import certificate_table
from .errors import Elements, Finding, InputError, LsgpError
from .exit_codes import OK, REFUSED, ended
from .mesh_files import write_whole
from .place_file import add_placement_options, place_file, summary
from .polygons import Triangulation
from .side_files import UsageError
from .terminal import ProgressLine, say
from .unwrap_file import Run, out_of_memory, read_file, unwrap_file
from .unwrap_options import add_unwrap_options, texture_size


def main(argv: Sequence[str] | None = None) -> int:
    """Run a command line, without the program's name, and return its exit code."""
    parser = _parser()
    try:
        args = parser.parse_args(argv)
        if args.version:
            say(sys.stdout, f"lsgp {__version__}")
            return OK
        if args.command is None:
            parser.error("a command is needed: unwrap, cones, batch or measure")
    except SystemExit as end:  # argparse has said why
        return int(end.code or 0)
    return ended(lambda: args.run(args))


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="lsgp",
        description="Unwrap triangle and polygon meshes through cones, continuous across every cut.",
        epilog="Exit code: 0 a result, 2 wrong usage or a file missing or not writable, 3 input refused, 130 "
        "interrupted.",
        allow_abbrev=False,
    )
    parser.add_argument("--version", action="store_true", help="print the version and exit")
    commands = parser.add_subparsers(dest="command", metavar="command")

    unwrap = commands.add_parser(
        "unwrap",
        allow_abbrev=False,
        help="write a mesh with texture coordinates",
        description="Cut a mesh through its cones, unfold it, and write it as OBJ with texture coordinates. Vertices, "
        "polygons and their order stay; materials and normals are not kept.",
    )
    unwrap.add_argument("input", metavar="IN", type=Path, help="OBJ, OFF or PLY; polygons of any size")
    unwrap.add_argument("-o", "--output", metavar="OUT.obj", type=Path, required=True)
    add_unwrap_options(unwrap)
    unwrap.set_defaults(run=_reported, make=_unwrap, output_is="OBJ")

    cones = commands.add_parser(
        "cones",
        allow_abbrev=False,
        help="place cones and find their angles",
        description="Place cones where they lower the stretch of a mesh most, and write them with their angles into a "
        "file for lsgp unwrap --cones.",
    )
    cones.add_argument("input", metavar="IN", type=Path, help="OBJ, OFF or PLY; polygons of any size")
    cones.add_argument("-o", "--output", metavar="OUT.json", type=Path, required=True)
    add_placement_options(cones)
    cones.set_defaults(run=_reported, make=_cones, output_is="JSON")

    batch = commands.add_parser(
        "batch",
        allow_abbrev=False,
        help="unwrap many meshes",
        description="Unwrap all meshes of a folder or a list, each as `lsgp unwrap` does it. Every asset gets a line "
        "in DIR/journal.jsonl when it has ended; DIR/summary.txt and DIR/contact-sheet.html are written at the end. In "
        "the names of files for --cones, --seam-edges and --importance, {} stands for a mesh's path without its "
        "suffix.",
        epilog=EXIT_CODES,
    )
    add_batch_options(batch)
    add_scheduler_option(batch)
    add_unwrap_options(batch)
    batch.set_defaults(run=run_batch)

    measure = commands.add_parser(
        "measure",
        allow_abbrev=False,
        help="measure the texture coordinates of an OBJ",
        description="Print the quality of the texture coordinates of an OBJ file.",
    )
    measure.add_argument("input", metavar="FILE.obj", type=Path)
    measure.set_defaults(run=_reported, make=_measure, output=None)
    for command in (unwrap, cones, measure):
        command.add_argument("--report", metavar="FILE.json", type=Path, help="write a report, also when refused")
    return parser


def _reported(args: argparse.Namespace) -> int:
    """Run the command; on a refusal say why and write that into the report."""
    _require_writable(args)
    run = Run()
    try:
        report = args.make(args, run)
        code = OK
    except LsgpError as error:
        report, code = _refusal(error, run), REFUSED
    except MemoryError:
        report, code = _refusal(out_of_memory(), run), REFUSED
    if args.report is not None:
        write_whole(args.report, reports.to_json(report))
    return code


def _refusal(error: LsgpError, run: Run) -> reports.Report:
    say(sys.stderr, f"lsgp: refused: {error.code}: {error.message}{reports.where(error.elements, run.triangulation)}")
    return reports.refusal_report(error, run.triangulation)


def _unwrap(args: argparse.Namespace, run: Run) -> reports.Report:
    with ProgressLine(sys.stderr) as progress:
        result = unwrap_file(args, run, progress)
    _warn(result.warnings, run.triangulation)
    islands = reports.island_count(result.island)
    lines = [
        f"{args.output}: {int(result.solved.sum())} of {len(result.solved)} triangles unwrapped, "
        f"{len(result.cones)} cones, {islands} {'island' if islands == 1 else 'islands'}",
        reports.quality_table(result),
    ]
    if result.seamless is not None:
        lines.append(certificate_table(result.seamless, texture_size(args)))
    say(sys.stdout, "\n".join(lines))
    return reports.unwrap_report(result, run.triangulation, run.stage_seconds, texture_size(args))


def _cones(args: argparse.Namespace, run: Run) -> reports.Report:
    with ProgressLine(sys.stderr) as progress:
        placement = place_file(args, run, progress)
    _warn(placement.warnings, run.triangulation)
    say(sys.stdout, summary(args, placement))
    return reports.placement_report(placement, run.triangulation, run.stage_seconds)


def _measure(args: argparse.Namespace, run: Run) -> reports.Report:
    mesh, triangulation = read_file(args.input, run, with_uv=True)
    without = np.flatnonzero(np.isnan(mesh.corner_uv[triangulation.corner]).any(axis=(1, 2))).astype(np.int32)
    if len(mesh.sizes) and len(without) == len(triangulation.triangles):
        raise InputError("NO_UV", "The file has no texture coordinates to measure. Unwrap it first: lsgp unwrap.")
    warnings = []
    if len(without):
        faces = Elements("faces", triangulation.polygons_of(without))
        message = (
            f"{len(faces.indices)} faces have no texture coordinates and were left out. Unwrap them to measure them."
        )
        warnings.append(Finding("FACES_WITHOUT_UV", message, faces))
    surface = Surface(mesh.positions, triangulation.triangles, triangulation.edges)
    with run.stage("measure_distortion"):
        measurement = measure_distortion(surface, mesh.corner_uv[triangulation.corner])
    _warn(warnings, triangulation)
    total = len(triangulation.triangles)
    say(
        sys.stdout,
        f"{args.input}: {total - len(without)} of {total} triangles measured\n" + reports.quality_table(measurement),
    )
    return reports.measure_report(measurement, warnings, triangulation, run.stage_seconds)


def _require_writable(args: argparse.Namespace) -> None:
    """Say before the work, not after it, that its result cannot be written."""
    paths = [path for path in (args.output, args.report) if path is not None]
    if args.report is not None:
        for other, what in ((args.output, "the output"), (args.input, "the input")):
            if other is not None and os.path.realpath(other) == os.path.realpath(args.report):
                raise UsageError(f"{what} and the report cannot be the same file")
    others = {"OBJ": (".off", ".ply"), "JSON": (".obj", ".off", ".ply")}
    if args.output is not None and args.output.suffix.lower() in others[args.output_is]:
        raise UsageError(f"the output is {args.output_is}; name it .{args.output_is.lower()}, not '{args.output}'")
    for path in paths:
        target = Path(os.path.realpath(path))
        if target.is_dir():
            raise UsageError(f"'{path}' is a folder")
        if not target.parent.is_dir():
            raise UsageError(f"there is no folder '{target.parent}' to write '{path.name}' to")
        # A file is replaced through its folder; a device is written to.
        touched = [target] if target.exists() else []
        if not touched or target.is_file():
            touched.append(target.parent)
        if not all(os.access(place, os.W_OK) for place in touched):
            raise UsageError(f"'{path}' cannot be written")


def _warn(findings: Sequence[Finding], triangulation: Triangulation) -> None:
    for finding in findings:
        where = reports.where(finding.elements, triangulation)
        say(sys.stderr, f"lsgp: warning: {finding.code}: {finding.message}{where}")
