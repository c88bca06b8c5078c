# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line: `lsgp unwrap` and `lsgp measure`.

Exit code 0: a result, with warnings or not; 2: wrong usage, a file that is missing or cannot be written; 3: the input
was refused, with a code and a sentence that says what to do; 130: interrupted, with Ctrl-C for instance.  Files are
written at the end, each as a whole or not at all.
"""

from __future__ import annotations

import argparse
import os
import sys
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from . import __version__
from . import report as reports
from .api import Options, Result, Seamless, Surface, measure_distortion, parameterize, place_cones
from .certificate import certificate_table
from .errors import Elements, Finding, InputError, LsgpError
from .mesh_files import read_mesh, write_obj, write_whole
from .polygons import PolygonMesh, Triangulation, triangulate
from .side_files import UsageError, cones_in, load_importance, load_json, seam_edges_in
from .terminal import ProgressLine, say

OK, USAGE, REFUSED, INTERRUPTED = 0, 2, 3, 130

DEFAULT_TEXTURE_SIZE = 1024
LARGEST_TEXTURE_SIZE = 65536


@dataclass
class Run:
    """What a command has found out so far; enough to report on a refusal at any point."""

    triangulation: Triangulation | None = None
    stage_seconds: dict[str, float] = field(default_factory=dict)

    @contextmanager
    def stage(self, name: str) -> Iterator[None]:
        begin = time.perf_counter()
        yield
        self.stage_seconds[name] = time.perf_counter() - begin


def main(argv: Sequence[str] | None = None) -> int:
    """Run a command line, without the program's name, and return its exit code."""
    parser = _parser()
    try:
        args = parser.parse_args(argv)
        if args.version:
            say(sys.stdout, f"lsgp {__version__}")
            return OK
        if args.command is None:
            parser.error("a command is needed: unwrap or measure")
    except SystemExit as end:  # argparse has said why
        return int(end.code or 0)
    try:
        return _reported(args)
    except UsageError as error:
        say(sys.stderr, f"lsgp: error: {error}")
    except OSError as error:
        where = "" if error.filename is None else f": '{os.fsdecode(error.filename)}'"
        say(sys.stderr, f"lsgp: error: {error.strerror or error}{where}")
    except KeyboardInterrupt:
        say(sys.stderr, "lsgp: interrupted")
        return INTERRUPTED
    return USAGE


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
    unwrap.add_argument(
        "--cones",
        metavar="FILE.json|auto|auto:N",
        type=_cones_option,
        default="auto",
        help='{"cones": [vertices, from 0], "cone_angles": [radians or null], "angles_over_pi_2": [quarter turns]}, '
        "angles optional; or cones placed automatically, N on each component (default: auto)",
    )
    unwrap.add_argument(
        "--prescription",
        choices=["least-distortion", "harmonic", "straightness", "manual"],
        help="how cone angles are chosen (default: the cone_angles of the cones file where it has them, otherwise "
        "least-distortion)",
    )
    unwrap.add_argument("--unfold", choices=["poisson", "spectral"], default="poisson", help="default: poisson")
    unwrap.add_argument("--method", choices=["lsgp", "lscm"], default="lsgp", help="default: lsgp")
    unwrap.add_argument(
        "--seam-edges", metavar="FILE.json", type=Path, help="[[a, b], ...]: marked edges; --seams says what they mean"
    )
    unwrap.add_argument(
        "--seams",
        choices=["follow", "boundary", "ignore"],
        default="follow",
        help="cuts follow marked edges wherever they can, marked edges are open borders, or they mean nothing "
        "(default: follow)",
    )
    unwrap.add_argument(
        "--border",
        choices=["free", "straight"],
        default="free",
        help="borders take the shape of least distortion, or run straight from cone to cone (default: free)",
    )
    unwrap.add_argument(
        "--mode",
        choices=["conformal", "low-stretch"],
        default="conformal",
        help="keep angles, or lengths as far as the cone angles let it (default: conformal)",
    )
    unwrap.add_argument(
        "--no-repair",
        dest="repair",
        action="store_false",
        help="leave flipped triangles and angles off by a turn as they come out",
    )
    unwrap.add_argument(
        "--overlaps",
        choices=["keep", "split"],
        default="keep",
        help="keep islands that lie on themselves, or split them along further cuts (default: keep)",
    )
    _add_low_stretch_options(unwrap)
    _add_seamless_options(unwrap)
    unwrap.set_defaults(run=_unwrap)

    measure = commands.add_parser(
        "measure",
        allow_abbrev=False,
        help="measure the texture coordinates of an OBJ",
        description="Print the quality of the texture coordinates of an OBJ file.",
    )
    measure.add_argument("input", metavar="FILE.obj", type=Path)
    measure.set_defaults(run=_measure, output=None)
    for command in (unwrap, measure):
        command.add_argument("--report", metavar="FILE.json", type=Path, help="write a report, also when refused")
    return parser


def _add_low_stretch_options(unwrap: argparse.ArgumentParser) -> None:
    low_stretch = unwrap.add_argument_group("with --mode low-stretch")
    low_stretch.add_argument(
        "--stretch",
        metavar="S",
        type=float,
        help="from 0, the conformal map, to 1, that of least stretch (default: 1)",
    )
    low_stretch.add_argument(
        "--importance",
        metavar="FILE",
        type=Path,
        help="how much stretch at each vertex weighs, numbers from 0 up, as text or [number, ...] (default: all alike)",
    )


def _add_seamless_options(unwrap: argparse.ArgumentParser) -> None:
    unwrap.add_argument(
        "--seamless",
        action="store_true",
        help="round angles and translations so that a tileable texture shows no seam; coordinates are in tiles",
    )
    seamless = unwrap.add_argument_group("with --seamless")
    scale = seamless.add_mutually_exclusive_group()
    scale.add_argument(
        "--tiles",
        metavar="N",
        type=float,
        help="tiles along the layout's longer side (default: as few as cost at most a tenth in distortion)",
    )
    scale.add_argument("--tile-size", metavar="X", type=float, help="side of a tile on the surface, in its unit")
    seamless.add_argument(
        "--lattice",
        choices=["square", "stripe", "translation", "triangle", "hexagon"],
        help="what leaves the texture as it is: quarter turns, half turns or none of squares, third or sixth turns of "
        "triangles (default: square)",
    )
    seamless.add_argument(
        "--parity", action="store_true", default=None, help="the black and white squares of a checker match as well"
    )
    seamless.add_argument(
        "--coarse-grid",
        choices=["refine", "merge", "relax"],
        help="where the tiles are too large for a valid layout: take smaller ones, merge cones less than a tile apart, "
        "or leave cones off the grid (default: refine)",
    )
    seamless.add_argument(
        "--texture-size",
        metavar="T",
        type=_texture_size_option,
        help=f"texels of the texture's side, a power of two; errors are told in them (default: {DEFAULT_TEXTURE_SIZE})",
    )
    seamless.add_argument(
        "--mip-levels",
        metavar="L",
        type=int,
        help="cells of 2^L texels instead of whole tiles, for a texture that repeats in them; its first L mipmaps "
        "match as well",
    )


def _texture_size_option(text: str) -> int:
    size = int(text) if text.isascii() and text.isdigit() and len(text) < 10 else 0
    if not (1 <= size <= LARGEST_TEXTURE_SIZE and size.bit_count() == 1):
        raise argparse.ArgumentTypeError(f"'{text}': T is a power of two, at most {LARGEST_TEXTURE_SIZE}")
    return size


def _cones_option(text: str) -> str | int | Path:
    """ "auto", a number of cones, or the path of a cones file."""
    if text == "auto":
        return text
    if text.startswith("auto:"):
        count = text.removeprefix("auto:")
        if not (count.isascii() and count.isdigit() and len(count) < 10):
            raise argparse.ArgumentTypeError(f"'{text}': N in auto:N is a number of cones, 0 or more")
        return int(count)
    return Path(text)


def _reported(args: argparse.Namespace) -> int:
    """Run the command; on a refusal say why and write that into the report."""
    _require_writable(args)
    run = Run()
    try:
        report = args.run(args, run)
        code = OK
    except LsgpError as error:
        report, code = _refusal(error, run), REFUSED
    except MemoryError:
        error = LsgpError(
            "OUT_OF_MEMORY", "There is not enough memory for this mesh. Use a machine with more or fewer faces."
        )
        report, code = _refusal(error, run), REFUSED
    if args.report is not None:
        write_whole(args.report, reports.to_json(report))
    return code


def _refusal(error: LsgpError, run: Run) -> reports.Report:
    say(sys.stderr, f"lsgp: refused: {error.code}: {error.message}{_where(error.elements, run.triangulation)}")
    return reports.refusal_report(error, run.triangulation)


def _unwrap(args: argparse.Namespace, run: Run) -> reports.Report:
    if args.prescription == "manual" and not isinstance(args.cones, Path):
        raise UsageError("--prescription manual needs a cones file with angles; give one with --cones FILE.json")
    if args.mode != "low-stretch":
        for name in ("stretch", "importance"):
            if getattr(args, name) is not None:
                raise UsageError(f"--{name} is for maps of low stretch; add --mode low-stretch")
    texture_size = DEFAULT_TEXTURE_SIZE if args.texture_size is None else args.texture_size
    options = Options(
        prescription=args.prescription,
        unfold=args.unfold,
        method=args.method,
        seams=args.seams,
        border=args.border,
        seamless=_seamless(args, _cell(args, texture_size)),
        mode=args.mode,
        stretch=Options.stretch if args.stretch is None else args.stretch,
        repair=args.repair,
        overlaps=args.overlaps,
    )
    with ProgressLine(sys.stderr) as progress:
        mesh, result = _map(args, options, run, progress)
        with run.stage("write_file"):
            corner_uv = run.triangulation.to_polygon_corners(result.corner_uv, len(mesh.corners))
            write_obj(args.output, mesh, corner_uv)
    _warn(result.warnings, run.triangulation)
    islands = reports.island_count(result.island)
    lines = [
        f"{args.output}: {int(result.solved.sum())} of {len(result.solved)} triangles unwrapped, "
        f"{len(result.cones)} cones, {islands} {'island' if islands == 1 else 'islands'}",
        reports.quality_table(result),
    ]
    if result.seamless is not None:
        lines.append(certificate_table(result.seamless, texture_size))
    say(sys.stdout, "\n".join(lines))
    return reports.unwrap_report(result, run.triangulation, run.stage_seconds, texture_size)


def _map(args: argparse.Namespace, options: Options, run: Run, progress: ProgressLine) -> tuple[PolygonMesh, Result]:
    """The mesh that was given and its map."""
    cones_json = load_json(args.cones) if isinstance(args.cones, Path) else None
    seams_json = [] if args.seam_edges is None else load_json(args.seam_edges)
    importance = None if args.importance is None else load_importance(args.importance)
    mesh, triangulation = _read(args.input, run)
    if importance is not None and len(importance) != len(mesh.positions):
        raise InputError(
            "WRONG_PARAMETER",
            f"'{args.importance}' has {len(importance)} numbers for {len(mesh.positions)} vertices. Give one for each.",
        )
    seams = seam_edges_in(seams_json, args.seam_edges)
    surface = Surface(mesh.positions, triangulation.triangles, triangulation.edges, seams, importance)
    if isinstance(args.cones, Path):
        cones, angles = cones_in(cones_json, args.cones, args.prescription)
    else:
        with run.stage("place_cones"):
            wanted = None if args.cones == "auto" else args.cones
            cones, angles = place_cones(surface, wanted, options=options), None
    result = parameterize(surface, cones, angles, options, progress=progress)
    run.stage_seconds.update(result.stage_seconds)
    return mesh, result


def _cell(args: argparse.Namespace, texture_size: int) -> float:
    """The side of a cell in texture coordinates.  Raises UsageError where the options for seamless do not fit."""
    if not args.seamless:
        for name in ("tiles", "tile_size", "lattice", "parity", "coarse_grid", "texture_size", "mip_levels"):
            if getattr(args, name) is not None:
                raise UsageError(f"--{name.replace('_', '-')} is for seamless layouts; add --seamless")
    if args.mip_levels is None:
        return 1.0
    most = texture_size.bit_length() - 1
    if not 0 <= args.mip_levels <= most:
        raise UsageError(
            f"--mip-levels {args.mip_levels}: a texture of {texture_size} texels a side has levels 0 to {most}"
        )
    return 2.0**args.mip_levels / texture_size


def _seamless(args: argparse.Namespace, cell: float) -> Seamless | None:
    if not args.seamless:
        return None
    wanted = {name: getattr(args, name) for name in ("lattice", "tiles", "tile_size", "parity", "coarse_grid")}
    return Seamless(**{name: value for name, value in wanted.items() if value is not None}, cell=cell)


def _measure(args: argparse.Namespace, run: Run) -> reports.Report:
    mesh, triangulation = _read(args.input, run, with_uv=True)
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


def _read(path: Path, run: Run, with_uv: bool = False) -> tuple[PolygonMesh, Triangulation]:
    with run.stage("read_file"):
        mesh = read_mesh(path, with_uv)
    if with_uv and mesh.corner_uv is None:
        raise InputError("NO_UV", "Only OBJ files are read with texture coordinates. Convert the file to OBJ.")
    with run.stage("triangulate"):
        run.triangulation = triangulate(mesh)
    return mesh, run.triangulation


def _require_writable(args: argparse.Namespace) -> None:
    """Say before the work, not after it, that its result cannot be written."""
    paths = [path for path in (args.output, args.report) if path is not None]
    if args.report is not None:
        for other, what in ((args.output, "the output"), (args.input, "the input")):
            if other is not None and os.path.realpath(other) == os.path.realpath(args.report):
                raise UsageError(f"{what} and the report cannot be the same file")
    if args.output is not None and args.output.suffix.lower() in (".off", ".ply"):
        raise UsageError(f"the output is OBJ; name it .obj, not '{args.output}'")
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
        where = _where(finding.elements, triangulation)
        say(sys.stderr, f"lsgp: warning: {finding.code}: {finding.message}{where}")


def _where(elements: Elements, triangulation: Triangulation | None) -> str:
    """The elements a message speaks of, in brackets and in the file's numbering."""
    named = str(reports.on_faces(elements, triangulation))
    return f" ({named})" if named else ""
