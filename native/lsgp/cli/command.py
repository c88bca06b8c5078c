# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line: `lsgp unwrap`, `lsgp cones`, `lsgp quads`, `lsgp batch`, `lsgp measure` and `lsgp pad`.

`run.exit_codes` has how they end. Files are written at the end, each as a whole or not at all.
"""

from __future__ import annotations

import argparse
import os
import re
import sys
from collections.abc import Callable, Sequence
from difflib import get_close_matches
from pathlib import Path
from typing import Any, NoReturn, TextIO

import numpy as np

from .. import __version__
from ..api import measure_distortion
from ..base.counted import counted
from ..batch.command import EXIT_CODES, add_batch_options, add_scheduler_options, expand_options, run_batch
from ..certificate import certificate_table
from ..errors import Elements, Finding, LsgpError
from ..images.layout_picture import draw_layout
from ..io.mesh_formats import BY_KEY, formats_table
from ..io.png_files import write_png
from ..io.polygons import Triangulation
from ..io.safe_files import is_standard_stream
from ..io.standard_streams import complain, hold_standard_descriptors, say
from ..io.whole_files import write_output
from ..layouts.texels import texel_density
from ..quads.quad_mesh import quad_quality
from ..run import report as reports
from ..run.exit_codes import OF_A_RUN, OK, REFUSED, SOME, USAGE, ended, flushed, listed
from ..run.named_files import Reads, Writes, written_files
from ..run.pad_file import add_pad_options, pad_file
from ..run.place_file import add_placement_options, place_file, summary
from ..run.quads_file import add_quads_options, quads_file
from ..run.quads_file import summary as summary_of_quads
from ..run.terminal import ProgressLine
from ..run.unwrap_file import Run, out_of_memory, read_file, unwrap_file, uv_of
from ..run.unwrap_options import add_threads_option, add_unwrap_options, texture_size, texture_size_option
from .examples import Formatter, with_examples
from .output_paths import require_usable_paths

INPUT = "OBJ, OFF, PLY, glTF, GLB or STL, or - for standard input; polygons of any size"
OUTPUT = "the file, or - for standard output"


class _Parser(argparse.ArgumentParser):
    """Help that cannot be printed is an error; argparse itself ignores that of a help longer than a buffer. A message
    that cannot be printed is none; argparse of Python 3.11.2 fails where standard error is closed. It has two lines:
    argparse's own has thirty of usage before the reason. Negative numbers may have exponents; to argparse these are
    options."""

    def __init__(self, **further: Any) -> None:
        super().__init__(**further)
        self._negative_number_matcher = re.compile(r"-(\d+\.?\d*|\.\d+)(e[-+]?\d+)?$", re.IGNORECASE)

    def print_help(self, file: TextIO | None = None) -> None:
        say(sys.stdout if file is None else file, self.format_help().rstrip("\n"))

    def error(self, message: str) -> NoReturn:
        complain(f"{self.prog}: error: {message}\n{self.prog} --help lists what it takes")
        raise SystemExit(USAGE)

    def refuse_unknown(self, unknown: Sequence[str]) -> NoReturn:
        """End with the words that nothing takes, and the option that the first of them may mean."""
        known = [option for action in self._actions for option in action.option_strings]
        meant = get_close_matches(unknown[0].partition("=")[0], known, 1, 0.8)  # not --report for --preset
        self.error(f"unrecognized arguments: {' '.join(unknown)}" + (f"; is {meant[0]} meant?" if meant else ""))


class _Command(_Parser):
    """The parser of one command."""

    def __init__(self, **further: Any) -> None:
        super().__init__(allow_abbrev=False, formatter_class=Formatter, **further)
        self.set_defaults(parser=self)

    def add_paths(self, output: str) -> None:
        """The mesh to read and the file to write."""
        self.add_argument("input", metavar="IN", action=Reads, type=Path, help=INPUT)
        self.add_argument("-o", "--output", metavar=output, action=Writes, type=Path, required=True, help=OUTPUT)

    def add_format(self) -> None:
        self.add_argument(
            "--format",
            metavar="F",
            choices=list(BY_KEY),
            help="format of standard input and output and of files without a suffix: "
            f"{', '.join(BY_KEY)} (default: by the first bytes, otherwise obj)",
        )

    def add_reported(self, make: Callable[..., object], **defaults: Any) -> None:
        """What a run on one file, by `make`, is reported with."""
        self.add_format()
        self.add_argument(
            "--report",
            metavar="FILE.json",
            action=Writes,
            type=Path,
            help="write a report, also when refused; - for standard output",
        )
        self.set_defaults(run=_reported, make=make, **defaults)


def main(argv: Sequence[str] | None = None) -> int:
    """Run a command line, without the program's name, and return its exit code."""
    hold_standard_descriptors()
    return ended(lambda: _run(list(sys.argv[1:] if argv is None else argv)))


def _run(arguments: list[str]) -> int:
    parser = _parser()
    try:
        _require_words(parser, arguments)
        args, unknown = parser.parse_known_args(expand_options(arguments) if arguments[:1] == ["batch"] else arguments)
        if unknown:
            vars(args).get("parser", parser).refuse_unknown(unknown)
        if args.command is None and not (args.version or args.formats):
            parser.error("a command is needed: unwrap, cones, quads, batch, measure or pad")
    except SystemExit as end:  # argparse has said why
        return flushed(int(end.code or 0))
    if args.version or args.formats:
        say(sys.stdout, f"lsgp {__version__}" if args.version else formats_table())
        return OK
    return args.run(args)


def _require_words(parser: _Parser, arguments: list[str]) -> None:
    """End with an error where a program passes what no shell can."""
    for word in arguments:
        try:
            has_text = b"\0" not in os.fsencode(word)
        except UnicodeEncodeError:
            has_text = False
        if not has_text:
            parser.error(f"{word!a} has a character that no path can have; leave it out")


def _parser() -> _Parser:
    parser = _Parser(
        prog="lsgp",
        description="Unwrap triangle and polygon meshes through cones, continuous across every cut.",
        epilog=listed(OF_A_RUN),
        allow_abbrev=False,
    )
    parser.add_argument("--version", action="store_true", help="print the version and exit")
    parser.add_argument(
        "--formats", action="store_true", help="print which formats of meshes are read and written here, and exit"
    )
    commands = parser.add_subparsers(dest="command", metavar="command", parser_class=_Command)
    for add in (_add_unwrap, _add_cones, _add_quads, _add_batch, _add_measure, _add_pad):
        add(commands)
    for name, command in commands.choices.items():
        command.epilog = with_examples(name, command.epilog)
    return parser


def _add_unwrap(commands: argparse._SubParsersAction[_Command]) -> None:
    unwrap = commands.add_parser(
        "unwrap",
        help="write a mesh with texture coordinates",
        description="Cut a mesh through its cones, unfold it, and write it with texture coordinates. OBJ, PLY and glTF "
        "files written in the same format keep all other content.",
    )
    unwrap.add_argument("input", metavar="IN", action=Reads, type=Path, help=INPUT)
    unwrap.add_argument(
        "-o",
        "--output",
        metavar="OUT",
        action=Writes,
        type=Path,
        help="OBJ, PLY, glTF or GLB, by its suffix, or - for standard output; the messages then go to standard error",
    )
    add_unwrap_options(unwrap)
    add_threads_option(unwrap)
    unwrap.add_argument(
        "--picture", metavar="FILE.png", action=Writes, type=Path, help="draw the layout, its cuts and its cones"
    )
    unwrap.add_argument(
        "--explain", action="store_true", help="with --preset: print what it chose from, what each would cost and why"
    )
    unwrap.add_reported(_unwrap)


def _add_cones(commands: argparse._SubParsersAction[_Command]) -> None:
    cones = commands.add_parser(
        "cones",
        help="place cones and find their angles",
        description="Place cones where they lower the stretch of a mesh most, and write them with their angles into a "
        "file for lsgp unwrap --cones.",
    )
    cones.add_paths("OUT.json")
    add_placement_options(cones)
    add_threads_option(cones)
    cones.add_reported(_cones, in_place=False)


def _add_quads(commands: argparse._SubParsersAction[_Command]) -> None:
    quads = commands.add_parser(
        "quads",
        help="cover a closed mesh with quads",
        description="Cover a closed mesh with quads: the squares of a seamless layout, traced over its surface. Every "
        "face is a quad, every vertex lies on the surface, and irregular vertices are at the cones.",
    )
    quads.add_paths("OUT.obj")
    add_quads_options(quads)
    add_threads_option(quads)
    quads.add_reported(_quads, in_place=False)


def _add_batch(commands: argparse._SubParsersAction[_Command]) -> None:
    batch = commands.add_parser(
        "batch",
        help="unwrap many meshes",
        description="Unwrap all meshes of a folder or a list, or a single one, each as `lsgp unwrap` does it. Every "
        "asset gets a line in DIR/journal.jsonl when it is done; DIR/summary.txt and DIR/contact-sheet.html are "
        "written at the end. In the names of files for --cones, --seam-edges, --directions, --importance, "
        "--features and --cut-costs, {} stands for a mesh's path without its suffix.",
        epilog=EXIT_CODES,
    )
    add_batch_options(batch)
    add_scheduler_options(batch)
    add_unwrap_options(batch)
    batch.set_defaults(run=run_batch)


def _add_measure(commands: argparse._SubParsersAction[_Command]) -> None:
    measure = commands.add_parser(
        "measure",
        help="measure the texture coordinates of a file",
        description="Print the quality of the texture coordinates of an OBJ, glTF or GLB file.",
    )
    measure.add_argument(
        "input", metavar="FILE", action=Reads, type=Path, help="OBJ, glTF or GLB, or - for standard input"
    )
    measure.add_argument(
        "--texture-size",
        metavar="T",
        type=texture_size_option,
        help="texels of the texture's side, a power of two, to measure the texel density as well",
    )
    measure.add_reported(_measure, output=None)


def _add_pad(commands: argparse._SubParsersAction[_Command]) -> None:
    pad = commands.add_parser(
        "pad",
        help="fill the gutters of a texture",
        description="Fill the texels beside the islands of a texture with the content beyond the cuts, so that "
        "filtered lookups match there. Texels whose center is in an island do not change.",
    )
    add_pad_options(pad)
    pad.add_format()
    pad.set_defaults(run=_reported, make=_pad, report=None)


def _reported(args: argparse.Namespace) -> int:
    """Run the command; on a refusal say why and write that into the report."""
    require_usable_paths(args)
    run = Run()
    try:
        report, text = args.make(args, run)
        code = SOME if run.missing is not None and len(run.missing.faces) else OK
    except LsgpError as error:
        report, text, code = _refusal(error, run), None, REFUSED
    except MemoryError:
        report, text, code = _refusal(out_of_memory(), run), None, REFUSED
    if args.report is not None:
        write_output(args.report, reports.to_json(report))
    if text is not None and (is_standard_stream(args.output) or is_standard_stream(args.report)):
        complain(text)
    elif text is not None:
        say(sys.stdout, text)
    return code


def _refusal(error: LsgpError, run: Run) -> reports.Report:
    complain(f"lsgp: refused: {error.code}: {error.message}{reports.where(error.elements, run.triangulation)}")
    return reports.refusal_report(error, run.triangulation)


def _unwrap(args: argparse.Namespace, run: Run) -> tuple[reports.Report, str]:
    """The report and the lines for people."""
    with ProgressLine(sys.stderr) as progress:
        result = unwrap_file(args, run, progress, args.format)
    if args.picture is not None:
        write_png(args.picture, draw_layout(run.surface, result))
    _warn(result.warnings, run.triangulation)
    lines = [
        f"{args.output}: {int(result.solved.sum())} of {len(result.solved)} triangles unwrapped, "
        f"{counted(len(result.cones), 'cone')}, {counted(reports.island_count(result.island), 'island')}",
        reports.quality_table(result, run.texels, run.packed),
        *reports.missing_lines(run.missing),
        *reports.missed_strokes(result, run),
        *(reports.choice_lines(result.choices) if args.explain else []),
    ]
    if result.seamless is not None:
        lines.append(certificate_table(result.seamless, texture_size(args)))
    report = reports.unwrap_report(result, run, texture_size(args))
    return report, "\n".join(lines)


def _cones(args: argparse.Namespace, run: Run) -> tuple[reports.Report, str]:
    with ProgressLine(sys.stderr) as progress:
        placement = place_file(args, run, progress)
    _warn(placement.warnings, run.triangulation)
    return reports.placement_report(placement, run.triangulation, run.stage_seconds), summary(args, placement)


def _quads(args: argparse.Namespace, run: Run) -> tuple[reports.Report, str]:
    with ProgressLine(sys.stderr) as progress:
        remesh = quads_file(args, run, progress)
    _warn(remesh.warnings, run.triangulation)
    quality = quad_quality(remesh.mesh.positions, remesh.mesh.quads, remesh.density)
    return reports.quads_report(remesh, quality, run), summary_of_quads(args.output, remesh, quality)


def _measure(args: argparse.Namespace, run: Run) -> tuple[reports.Report, str]:
    file = read_file(args.input, run, args.format, with_uv=True, stitch=False, written=written_files(args))
    triangulation, corner_uv = file.triangulation, uv_of(file, "measure")
    without = np.flatnonzero(np.isnan(corner_uv).any(axis=(1, 2))).astype(np.int32)
    warnings = list(file.findings)
    if len(without):
        faces = Elements("faces", triangulation.polygons_of(without))
        which = counted(
            len(faces.indices), "face without texture coordinates was", "faces without texture coordinates were"
        )
        message = f"{which} left out. Unwrap all faces to measure them."
        warnings.append(Finding("FACES_WITHOUT_UV", message, faces))
    with run.stage("measure_distortion"), ProgressLine(sys.stderr) as progress:
        measurement = measure_distortion(file.surface(), corner_uv, progress=progress)
    texels = None if args.texture_size is None else texel_density(file.surface(), corner_uv, args.texture_size)
    _warn(warnings, triangulation)
    total = len(triangulation.triangles)
    text = f"{args.input}: {total - len(without)} of {total} triangles measured\n"
    text += reports.quality_table(measurement, texels)
    return reports.measure_report(measurement, warnings, run, args.texture_size, texels), text


def _pad(args: argparse.Namespace, run: Run) -> tuple[None, str]:
    with ProgressLine(sys.stderr) as progress:
        return None, pad_file(args, run, progress)


def _warn(findings: Sequence[Finding], triangulation: Triangulation) -> None:
    for finding in findings:
        where = reports.where(finding.elements, triangulation)
        complain(f"lsgp: warning: {finding.code}: {finding.message}{where}")
