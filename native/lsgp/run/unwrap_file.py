# SPDX-License-Identifier: GPL-3.0-or-later
"""A mesh file in, the same mesh with texture coordinates out."""

from __future__ import annotations

import argparse
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..api import parameterize
from ..base.counted import counted
from ..base.progress import Progress, share_of
from ..base.unique_rows import unique_rows
from ..errors import Finding, InputError, LsgpError, SolverError
from ..io.mesh_files import MeshFile, format_mesh, parse_mesh
from ..io.mesh_formats import output_format
from ..io.polygons import Triangulation
from ..io.safe_files import is_same_file, is_standard_stream, read_input, require_separate
from ..io.side_files import cones_in, load_importance, load_json, pairs_in
from ..io.whole_files import content_digest, write_output
from ..layouts.packing import Pack, laid_out
from ..layouts.texels import TexelDensity, at_texel_density, texel_density, with_tiny_findings
from ..options import Options
from ..presets.auto_unwrap import PACKING, TIME_LIMIT, choose_map, in_time
from ..results import Placement, Result
from ..surface import Surface
from ..triangles import uv_area
from .direction_options import Strokes, load_directions, strokes_of
from .feature_options import features_of
from .missing_faces import MissingFaces, missing_faces
from .named_files import NamedFile, require_apart_from, written_files
from .unwrap_options import (
    cone_count,
    cones_file,
    cut_costs_of,
    library_options,
    packing_of,
    stitches,
    texel_layout,
    tries_symmetry,
    up_of,
    weights_of,
)

# What a file that took longer to read still has.
LEAST_SECONDS = 1e-9

# Warnings of results that are not what was asked for, which --strict refuses.
FLAWS = frozenset(
    {
        "FLIPPED_TRIANGLES",
        "WRONG_ANGLE_SUMS",
        "INEXACT_ANGLES",
        "INEXACT_SEAMS",
        "ISLANDS_TINY",
        "COMPONENT_SKIPPED",
        "FACES_LEFT_OUT",
        "PLACEMENT_NOT_REACHED",
    }
)


@dataclass(frozen=True, slots=True)
class Packed:
    """How islands were packed, in how many UDIM tiles, and the part of these, or of the unit square, that they
    cover."""

    pack: Pack
    coverage: float
    tiles: int = 1


@dataclass
class Run:
    """The intermediate results of a command; enough to report on a refusal at any point."""

    triangulation: Triangulation | None = None
    surface: Surface | None = None
    placement: Placement | None = None
    packed_quickly: NDArray[np.float64] | None = None  # (m, 3, 2), as of `choose_map`
    strokes: Strokes | None = None
    packed: Packed | None = None
    texels: TexelDensity | None = None
    missing: MissingFaces | None = None
    stage_seconds: dict[str, float] = field(default_factory=dict)

    @contextmanager
    def stage(self, name: str) -> Iterator[None]:
        begin = time.perf_counter()
        yield
        self.add_seconds({name: time.perf_counter() - begin})

    def add_seconds(self, of_stages: Mapping[str, float]) -> None:
        """Where several maps are compared, a stage has the time of all."""
        for name, seconds in of_stages.items():
            self.stage_seconds[name] = self.stage_seconds.get(name, 0.0) + seconds


def unwrap_file(
    args: argparse.Namespace,
    run: Run,
    progress: Progress | None = None,
    given_format: str | None = None,
    *,
    makes_folder: bool = False,
) -> Result:
    """Unwrap args.input into args.output.  Raises OSError, UsageError, LsgpError.

    args: these two, either of which may be "-", threads, and the values of the options of an unwrap.
    given_format: of what has no suffix that tells it. makes_folder: whether that of args.output is made if it is
    missing, once there is something to write.

    The warnings of the result are also those of the files.
    """
    begin = time.monotonic()
    options = replace(library_options(args), threads=args.threads)
    target = None if is_standard_stream(args.output) else args.output
    form = output_format(target, given_format)
    require_separate(args.input, args.output, in_place=args.in_place)
    packing, layout = packing_of(args), texel_layout(args)
    is_tight = packing is not None and packing.is_tight
    mapping = share_of(progress, 0.0, PACKING) if is_tight else progress
    file, result = _map(args, options, run, mapping, given_format, begin)
    if packing is not None:
        packing = in_time(packing, is_late=_seconds_left(args, begin) == 0)
        with run.stage("pack"):
            placing = share_of(progress, PACKING, 1.0)
            laid = laid_out(run.surface, result, packing, layout, placing, packed_quickly=run.packed_quickly)
        result = laid.result
        seen = result.solved & ~laid.stacked & ~_duplicates(result)
        tiles = 1 if packing.udim is None else _tiles_in_use(result.corner_uv[seen])
        run.packed = Packed(laid.pack, uv_area(result.corner_uv[seen]) / tiles, tiles)
    elif layout is not None:
        result = at_texel_density(run.surface, result, layout)
    result = with_tiny_findings(result)
    if args.texel_density is not None:
        run.texels = texel_density(run.surface, result.corner_uv, args.texture_size)
    if args.strict:
        require_flawless([*file.findings, *result.warnings])
    run.missing = missing_faces(file, result.solved)
    with run.stage("write_file"):
        data, findings = format_mesh(file, result.corner_uv, form, None if target is None else target.parent)
        is_itself = args.in_place and is_same_file(args.input, args.output)  # a batch may write elsewhere
        was = content_digest(file.data) if is_itself else None
        if makes_folder and target is not None:
            target.parent.mkdir(parents=True, exist_ok=True)
        write_output(args.output, data, keep_backup=args.in_place, was=was)
    return replace(result, warnings=file.told([*findings, *result.warnings]))


def _seconds_left(args: argparse.Namespace, begin: float) -> float | None:
    """Of --time-limit; None without."""
    return None if args.time_limit is None else max(args.time_limit - (time.monotonic() - begin), 0.0)


def _limited(progress: Progress | None, seconds: float | None) -> Progress | None:
    """Progress that raises SolverError after some time."""
    if seconds is None:
        return progress
    end = time.monotonic() + seconds

    def limited(done: float) -> bool | None:
        if time.monotonic() > end:
            raise SolverError(TIME_LIMIT, "No map was made within the time limit. Allow more time.")
        return None if progress is None else progress(done)

    return limited


def _duplicates(result: Result) -> NDArray[np.bool_]:
    """Of the triangles, those that have the coordinates of the one they coincide with."""
    out = np.zeros(len(result.corner_uv), bool)
    for finding in result.warnings:
        if finding.code == "DUPLICATE_FACE":
            out[finding.elements.indices] = True
    return out


def _tiles_in_use(uv: NDArray[np.float64]) -> int:
    """uv: (m, 3, 2), each triangle inside one tile."""
    return len(unique_rows(np.floor(uv.mean(axis=1))).rows)


def require_flawless(warnings: Sequence[Finding]) -> None:
    """Raise LsgpError for the first warning that --strict does not permit."""
    for finding in warnings:
        if finding.code in FLAWS:
            raise LsgpError(finding.code, finding.message, finding.elements)


def out_of_memory() -> LsgpError:
    """The library's error that reports a MemoryError."""
    return LsgpError(
        "OUT_OF_MEMORY", "There is not enough memory for this mesh. Use a machine with more or fewer faces."
    )


def read_file(
    path: Path,
    run: Run,
    given_format: str | None = None,
    *,
    with_uv: bool = False,
    stitch: bool = True,
    written: Sequence[NamedFile] = (),
) -> MeshFile:
    """A mesh file, or standard input.

    stitch: as of `read_mesh_file`. written: what no file that belongs to this one may be.
    Raises OSError, UsageError, InputError.
    """
    source = None if is_standard_stream(path) else path
    with run.stage("read_file"):
        data = read_input(path)
        form, mesh = parse_mesh(source, data, given_format, with_uv=with_uv)
    if with_uv and mesh.corner_uv is None:
        raise InputError("NO_UV", f"{form.name} is not read with texture coordinates. Convert the file to OBJ.")
    if len(mesh.sizes) == 0:
        name, number = "Standard input" if source is None else repr(str(source)), len(mesh.positions)
        content = f"{counted(number, 'vertex', 'vertices')} and no faces" if number else "no mesh"
        raise InputError("EMPTY_MESH", f"{name} has {content}. Export the mesh again, with its faces.")
    with run.stage("triangulate"):
        file = MeshFile.of(source, form, data, mesh, stitch)
    require_apart_from(written, path, file.named_files)
    run.triangulation = file.triangulation
    return file


def uv_of(file: MeshFile, purpose: str) -> NDArray[np.float64]:
    """(m, 3, 2), the texture coordinates of a file read with them.  purpose: a verb.  Raises InputError: NO_UV."""
    corner_uv = file.triangle_uv
    if corner_uv is None or (len(file.mesh.sizes) and np.isnan(corner_uv).any(axis=(1, 2)).all()):
        raise InputError("NO_UV", f"The file has no texture coordinates to {purpose}. Unwrap it first: lsgp unwrap.")
    return corner_uv


def _map(
    args: argparse.Namespace,
    options: Options,
    run: Run,
    progress: Progress | None,
    given_format: str | None,
    begin: float,
) -> tuple[MeshFile, Result]:
    """The mesh that was given and its map.  begin: when the time of --time-limit began."""
    cones_path = cones_file(args)
    seams_path = None if args.seam_edges is None else Path(args.seam_edges)
    cones_json = None if cones_path is None else load_json(cones_path)
    seams_json = [] if seams_path is None else load_json(seams_path)
    directions_json = load_directions(args)
    importance = None if args.importance is None else load_importance(Path(args.importance))
    file = read_file(args.input, run, given_format, stitch=stitches(args), written=written_files(args))
    if importance is not None and len(importance) != len(file.mesh.positions):
        raise InputError(
            "WRONG_PARAMETER",
            f"'{args.importance}' has {len(importance)} numbers for {len(file.mesh.positions)} vertices. "
            "Give one for each.",
        )
    run.strokes = strokes_of(args, directions_json, file)
    directions = up_of(args) if run.strokes is None else run.strokes.directions
    surface = replace(file.surface(pairs_in(seams_json, seams_path, "seam vertex"), importance), directions=directions)
    surface = replace(surface, features=features_of(args.features, surface, file.stitched))
    with run.stage("cut_costs"):
        surface = run.surface = replace(surface, cut_costs=cut_costs_of(args, surface, file.stitched))
    given = ((), None) if cones_path is None else file.cones(*cones_in(cones_json, cones_path, args.prescription))
    left = _seconds_left(args, begin)
    left = None if left is None else max(left, LEAST_SECONDS)
    if cones_path is not None and args.preset is None:
        result = parameterize(surface, *given, options, progress=_limited(progress, left))
        run.add_seconds(result.stage_seconds)
        return file, result
    with run.stage("choose"):
        found = choose_map(
            *(surface, *given),
            preset=args.preset or "paint",
            options=options,
            count=cone_count(args),
            symmetric=tries_symmetry(args),
            charts=args.preset is not None,
            creases=args.preset is not None and args.creases,
            weights=weights_of(args),
            seconds=left,
            progress=progress,
        )
    run.surface, run.placement, run.packed_quickly = found.surface, found.placement, found.packed_quickly
    return file, found.result
