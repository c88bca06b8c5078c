# SPDX-License-Identifier: GPL-3.0-or-later
"""One file of a batch: open it, unwrap all its meshes, write it as a whole."""

from __future__ import annotations

import argparse
from collections import Counter
from collections.abc import Sequence
from dataclasses import asdict, replace
from pathlib import Path
from typing import TYPE_CHECKING

import bpy
import numpy as np
from numpy.typing import NDArray

from ...core import native
from ...core.errors import Refused, object_errors
from ...core.findings import explain, relevant
from ...core.identifiers import CONE_GROUP, IMPORTANCE_GROUP
from ...core.region import Region
from ...mesh.region_read import Faces, Groups, read_region
from ...mesh.uv_write import write_uv
from ..layouts.densities import at_density
from ..layouts.maps import PackSettings, placed_maps, tiny_findings
from ..tasks.cuts import cut_choice
from ..tasks.directions import direction_choice
from ..tasks.unwrapped import Unwrapped
from ..tasks.unwrapping import UnwrapSettings, UnwrapTask, unwrap_all, unwrap_task
from .files import Unreadable, mesh_objects, open_file, save_file

if TYPE_CHECKING:
    import lsgp
    from lsgp.batch.records import Record
    from lsgp.batch.tasks import Settings, Task

MARGIN = 4 / 1024
"""Around islands that a preset packs, as a part of the texture: four texels of 1024."""


def unwrap_asset(task: Task, settings: Settings) -> Record:
    """Unwrap the meshes of a file and write its results; returns the record for the journal."""
    records = native.part("batch.records")
    try:
        return _unwrap(task, settings)
    except native.lsgp.LsgpError as error:
        return records.ending(records.REFUSED, error.code, str(error))
    except native.part("io.side_files").UsageError as error:
        return records.ending(records.REFUSED, "WRONG_USAGE", str(error))
    except Refused as error:
        return records.ending(records.REFUSED, _code(error), str(error))
    except Unreadable as error:
        return records.ending(records.REFUSED, "MALFORMED_FILE", str(error))
    except OSError as error:
        return records.ending(records.FAILED, "FILE_ERROR", native.part("run.exit_codes").describe(error))


def _unwrap(task: Task, settings: Settings) -> Record:
    whole_files, output = native.part("io.whole_files"), Path(task.out, task.output)
    data = Path(task.input).read_bytes()  # Blender does not tell a missing file from other failures
    args = argparse.Namespace(**settings.options_for(task))
    is_itself = args.in_place and native.part("io.safe_files").is_same_file(task.input, output)
    was = whole_files.content_digest(data) if is_itself else None
    del data
    _require_fitting(args)
    open_file(task.input)
    gathered: list[tuple[bpy.types.Object, UnwrapTask]] = []
    failures: dict[str, Exception] = {}
    for obj in mesh_objects():
        try:
            gathered.append((obj, _unwrap_task(obj, args)))
        except object_errors() as error:
            failures[obj.name] = error
    outcomes = unwrap_all([task for _, task in gathered])
    solved = []
    for (obj, _), outcome in zip(gathered, outcomes, strict=True):
        if isinstance(outcome, Exception):
            failures[obj.name] = outcome
        else:
            solved.append((obj, outcome))
    if not solved:
        return _nothing_solved(failures)
    layouts, findings = _layouts([unwrapped for _, unwrapped in solved], args)
    if args.strict:
        flaws = [flaw for _, unwrapped in solved for flaw in unwrapped.result.warnings]
        native.part("run.unwrap_file").require_flawless([*flaws, *findings])
    for (obj, unwrapped), corner_uv in zip(solved, layouts, strict=True):
        write_uv(obj, unwrapped.region, unwrapped.result.solved, corner_uv)
    output.parent.mkdir(parents=True, exist_ok=True)
    with whole_files.whole_file(output, output.suffix, keep_backup=args.in_place, was=was) as partial:
        save_file(str(partial))
    regions = [unwrap_task.region for _, unwrap_task in gathered]
    record = _record([unwrapped for _, unwrapped in solved], findings, failures)
    record |= {"output": task.output} | _missing(regions, outcomes)
    if settings.pictures:
        largest = max((unwrapped for _, unwrapped in solved), key=lambda found: len(found.region.surface.triangles))
        pictures = native.part("batch.pictures")
        pictures.write_picture(Path(task.out, task.picture), largest.region.surface, largest.result)
        record["picture"] = task.picture
    return record


def _require_fitting(args: argparse.Namespace) -> None:
    """Raise UsageError where options name files with vertices or edges, which can only belong to a single mesh, and
    where they are for another way to place islands."""
    cones = native.part("run.unwrap_options").cones_file(args)
    features = args.features if isinstance(args.features, str) else None
    others = ("seam_edges", "directions", "importance", "cut_costs")
    for name, value in (
        {"cones": cones, "features": features} | {name.replace("_", "-"): getattr(args, name) for name in others}
    ).items():
        if value is not None:
            raise native.part("io.side_files").UsageError(
                f"--{name} with a file is for lsgp batch; here cones, seams, features and weights are those of the "
                "meshes"
            )
    if args.pack == "shelves" or (args.pack is not None and args.texel_density is not None):
        raise native.part("io.side_files").UsageError(
            f"--pack {args.pack}{'' if args.texel_density is None else ' at a texel density'} is for lsgp batch; leave "
            "it out"
        )
    if args.time_limit is not None:
        raise native.part("io.side_files").UsageError("--time-limit is for lsgp batch; here files have a --timeout")


def _unwrap_task(obj: bpy.types.Object, args: argparse.Namespace) -> UnwrapTask:
    """What the map of an object is computed from.  Settings without an option are as in the operator.

    Raises LsgpError, Refused.
    """
    unwrap_options = native.part("run.unwrap_options")
    options = unwrap_options.library_options(args)
    settings = UnwrapSettings(
        options=options,
        cone_group=CONE_GROUP,
        weight_group=IMPORTANCE_GROUP,
        weight_factor=1.0,
        # Pins would have to move with the layout's size.
        use_pins=options.seamless is None and args.texel_density is None,
        keep_placement=False,
        correct_aspect=options.seamless is None,
        cuts=cut_choice(args),
        direction=direction_choice(args),
        features=args.features,
        subdivided=args.preset is not None,
    )
    groups = Groups(settings.cone_group, settings.weight_group)
    region = read_region(obj, Faces.ALL, groups, subdivided=settings.subdivided)
    task = unwrap_task(region, settings)
    if len(task.cones.cones) and args.preset is None:
        return task
    return replace(
        task,
        completes=True,
        count=unwrap_options.cone_count(args),
        symmetric=unwrap_options.tries_symmetry(args),
        weights=unwrap_options.weights_of(args),
        creases_of=args.preset if args.creases else None,
    )


def _layouts(
    solved: Sequence[Unwrapped], args: argparse.Namespace
) -> tuple[list[NDArray[np.float64]], list[lsgp.Finding]]:
    """The coordinates of each map as they are written, and findings about them: packed together with a preset,
    then at a texel density if that is asked for.  Raises InputError, Refused."""
    unwrap_options = native.part("run.unwrap_options")
    layouts, findings = [unwrapped.corner_uv for unwrapped in solved], []
    packing = unwrap_options.packing_of(args)
    if args.preset is not None or packing is not None:
        pack = PackSettings(
            True,
            solved[0].result.seamless is not None,
            MARGIN if packing is None or packing.margin is None else packing.margin,
            udim=1 if packing is None or packing.udim is None else packing.udim,
        )
        effort = pack.effort if packing is None or packing.effort is None else packing.effort
        inside = 1.0 if args.inside is None else args.inside
        placed = placed_maps(solved, replace(pack, stack=args.stack, effort=effort, inside=inside))
        layouts = [unwrapped.corner_uv for unwrapped in placed]
        findings = [finding for unwrapped in placed for finding in unwrapped.placing]
    texels = unwrap_options.texel_layout(args)
    if texels is not None:
        layouts, findings = at_density(solved, layouts, texels, share=args.preset is not None)
    for unwrapped, corner_uv in zip(solved, layouts, strict=True):
        findings = [*findings, *tiny_findings(unwrapped, corner_uv)]
    return layouts, findings


def _missing(regions: Sequence[Region], outcomes: Sequence[Unwrapped | Exception]) -> Record:
    """The columns of the record about faces without coordinates: all those of a mesh that was refused, too."""
    corners, faces, solved, count = [], [], [], 0
    for region, outcome in zip(regions, outcomes, strict=True):
        surface = region.surface
        corners.append(surface.positions[surface.triangles] * region.object_scale)
        own, face = np.unique(region.triangle_faces, return_inverse=True)
        faces.append(count + face)
        count += len(own)
        refused = isinstance(outcome, Exception)
        solved.append(np.zeros(len(surface.triangles), bool) if refused else outcome.result.solved)
    missing = native.part("run.missing_faces").missing_of_triangles(
        np.concatenate(corners), np.concatenate(faces), np.concatenate(solved)
    )
    columns = native.part("batch.records").missing_columns
    return columns(0, 0.0) if missing is None else columns(len(missing.faces), missing.area_percent)


def _nothing_solved(failures: dict[str, Exception]) -> Record:
    records = native.part("batch.records")
    if not failures:
        return records.ending(records.REFUSED, "NO_MESH", "The file has no mesh with faces. Leave it out.")
    codes = {_code(error) for error in failures.values()}
    status = records.FAILED if "OUT_OF_MEMORY" in codes else records.REFUSED
    return records.ending(status, codes.pop() if len(codes) == 1 else "OBJECTS_REFUSED", _reasons(failures))


def _code(error: Exception) -> str:
    return "OUT_OF_MEMORY" if isinstance(error, MemoryError) else getattr(error, "code", "OBJECT_REFUSED")


def _reasons(failures: dict[str, Exception]) -> str:
    return "; ".join(f"{name}: {explain(error)}" for name, error in failures.items())


def _record(solved: Sequence[Unwrapped], findings: Sequence[lsgp.Finding], failures: dict[str, Exception]) -> Record:
    """Sums over the meshes, with the distortion of the one with the highest stretch.  Meshes that were refused beside
    others count as a warning.  findings: about their layouts."""
    results = [unwrapped.result for unwrapped in solved]
    warnings: Counter[str] = Counter()
    told = [finding for unwrapped in solved for finding in relevant(unwrapped.region, unwrapped.result.warnings)]
    for finding in (*told, *findings):
        warnings[finding.code] += len(finding.elements.indices)
    if failures:
        warnings["OBJECTS_REFUSED"] = len(failures)
    worst = max((result.distortion for result in results), key=lambda distortion: distortion.l2_stretch)
    return native.part("batch.records").EMPTY | {
        "message": _reasons(failures) or None,
        "warnings": dict(warnings),
        "triangles": sum(len(result.solved) for result in results),
        "cones": sum(len(result.cones) for result in results),
        "islands": sum(int(result.island.max(initial=-1)) + 1 for result in results),
        "distortion": asdict(worst),
        "flipped": sum(len(result.flipped) for result in results),
        "wrong_angle_sums": sum(len(result.wrong_angle_sums) for result in results),
        "overlapping": sum(len(result.overlapping) for result in results),
        "overlap_area": max(result.overlap_area for result in results),
    }
