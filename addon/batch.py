# SPDX-License-Identifier: GPL-3.0-or-later
"""The work on one file of a batch: open it, unwrap all its meshes, write it as a whole."""

from __future__ import annotations

import argparse
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import bpy

from . import gathering, mesh_write, native, reporting, unwrapping, welding
from .angles import ConeAngles, Kind
from .identifiers import CONE_GROUP
from .operators.common import require_region

if TYPE_CHECKING:
    from lsgp.batch.records import Record
    from lsgp.batch.tasks import Settings, Task

SUFFIXES = (".blend", ".glb", ".gltf", ".fbx")
IMPORTANCE_GROUP = "uv_importance"


class Unreadable(Exception):
    """A file that Blender cannot read; the message says why."""


def output_name(name: str) -> str:
    """A .gltf, which is several files, becomes one."""
    return f"{name}.glb" if name.lower().endswith(".gltf") else name


def unwrap_asset(task: Task, settings: Settings) -> Record:
    """Unwrap the meshes of a file, write its files, and say how it ended."""
    records = native.part("batch.records")
    try:
        return _unwrap(task, settings)
    except native.lsgp.LsgpError as error:
        return records.ending(records.REFUSED, error.code, str(error))
    except native.part("side_files").UsageError as error:
        return records.ending(records.REFUSED, "WRONG_USAGE", str(error))
    except Unreadable as error:
        return records.ending(records.REFUSED, "MALFORMED_FILE", str(error))
    except OSError as error:
        return records.ending(records.FAILED, "FILE_ERROR", native.part("exit_codes").describe(error))


def _unwrap(task: Task, settings: Settings) -> Record:
    with open(task.input, "rb"):
        pass  # Blender does not say whether a file is there
    args = argparse.Namespace(**settings.options_for(task))
    _require_no_files(args)
    _open(task.input)
    objects = _objects()
    gathered, failures = [], {}
    for obj in objects:
        try:
            gathered.append((obj, _gather(obj, args)))
        except (native.lsgp.LsgpError, reporting.Refused, MemoryError) as error:
            failures[obj.name] = error
    outcomes = unwrapping.unwrap_all([task for _, task in gathered])
    solved = []
    for (obj, _), outcome in zip(gathered, outcomes, strict=True):
        if isinstance(outcome, Exception):
            failures[obj.name] = outcome
        else:
            solved.append((obj, outcome))
    if not solved:
        return _nothing_solved(failures)
    for obj, unwrapped in solved:
        mesh_write.write_uv(obj, unwrapped.region, unwrapped.result.solved, unwrapped.corner_uv)
    output = Path(task.out, task.output)
    output.parent.mkdir(parents=True, exist_ok=True)
    with native.part("mesh_files").whole_file(output, output.suffix) as partial:
        _save(str(partial))
    record = _record([unwrapped for _, unwrapped in solved], failures) | {"output": task.output}
    if settings.pictures:
        largest = max((unwrapped for _, unwrapped in solved), key=lambda found: len(found.region.surface.triangles))
        pictures = native.part("batch.pictures")
        pictures.write_picture(Path(task.out, task.picture), largest.region.surface, largest.result)
        record["picture"] = task.picture
    return record


def _require_no_files(args: argparse.Namespace) -> None:
    """Raise UsageError where options name files of vertices and edges, which would be those of one mesh."""
    named = {"cones": native.part("unwrap_options").cones_file(args), "seam-edges": args.seam_edges}
    for name, value in (named | {"importance": args.importance}).items():
        if value is not None:
            raise native.part("side_files").UsageError(
                f"--{name} with a file is for lsgp batch; here cones, seams and importance are those on the meshes"
            )


def _open(path: str) -> None:
    """Raises Unreadable."""
    read = _READERS.get(Path(path).suffix.lower())
    if read is None:
        raise Unreadable(f"'{path}' is no {', '.join(SUFFIXES)} file. Save it as one of these.")
    try:
        read(path)
    except RuntimeError as error:  # how Blender's operators say that they did not do it
        raise Unreadable(f"Blender cannot read it: {' '.join(str(error).split())}") from error
    if bpy.context.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")


def _read_blend(path: str) -> None:
    bpy.ops.wm.open_mainfile(filepath=path, load_ui=False, use_scripts=False)


def _read_gltf(path: str) -> None:
    _empty()
    bpy.ops.import_scene.gltf(filepath=path)
    for mesh in bpy.data.meshes:
        welding.weld(mesh)


def _read_fbx(path: str) -> None:
    _empty()
    bpy.ops.import_scene.fbx(filepath=path)


def _empty() -> None:
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)


_READERS: dict[str, Callable[[str], None]] = {
    ".blend": _read_blend,
    ".glb": _read_gltf,
    ".gltf": _read_gltf,
    ".fbx": _read_fbx,
}


def _save(path: str) -> None:
    suffix = Path(path).suffix.lower()
    if suffix == ".blend":
        bpy.ops.wm.save_as_mainfile(filepath=path, copy=True)
    elif suffix == ".glb":
        bpy.ops.export_scene.gltf(filepath=path, export_format="GLB")
    else:
        bpy.ops.export_scene.fbx(filepath=path)


def _objects() -> list[bpy.types.Object]:
    """An object of each mesh that has faces and is this file's own, by name."""
    one_per_mesh: dict[bpy.types.Mesh, bpy.types.Object] = {}
    for obj in sorted(bpy.data.objects, key=lambda obj: obj.name_full):
        if obj.type == "MESH" and obj.data.is_editable and obj.data.polygons:
            one_per_mesh.setdefault(obj.data, obj)
    return list(one_per_mesh.values())


def _gather(obj: bpy.types.Object, args: argparse.Namespace) -> unwrapping.Task:
    """What the map of an object is computed from, with the operator's settings where there are no options for them."""
    unwrap_options = native.part("unwrap_options")
    options = unwrap_options.library_options(args)
    settings = gathering.Settings(
        options=options,
        group=CONE_GROUP,
        weight_group=IMPORTANCE_GROUP,
        weight_factor=1.0,
        use_pins=options.seamless is None,
        keep_placement=False,
        correct_aspect=options.seamless is None,
    )
    task = gathering.gather(obj, require_region(obj), settings)
    if len(task.cones.cones):
        return task
    placed = native.lsgp.place_cones(
        task.region.surface,
        count=unwrap_options.cone_count(args),
        lattice=None if options.seamless is None else options.seamless.lattice,
        seams=options.seams,
    )
    order = placed.cones.argsort()
    angles = [float(placed.cone_angles[i]) for i in order]
    return replace(task, cones=ConeAngles(placed.cones[order], angles, [Kind.FOUND] * len(order)))


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
    return "; ".join(f"{name}: {reporting.explain(error)}" for name, error in failures.items())


def _record(solved: Sequence[unwrapping.Unwrapped], failures: dict[str, Exception]) -> Record:
    """Sums over the meshes, and the distortion of the one with the highest stretch.  A mesh that was refused beside
    others is a warning."""
    results = [unwrapped.result for unwrapped in solved]
    warnings: Counter[str] = Counter()
    for result in results:
        warnings.update({finding.code: len(finding.elements.indices) for finding in result.warnings})
    if failures:
        warnings["OBJECTS_REFUSED"] = len(failures)
    worst = max((result.distortion for result in results), key=lambda distortion: distortion.l2_stretch)
    return native.part("batch.records").EMPTY | {
        "message": _reasons(failures) or None,
        "warnings": dict(warnings),
        "triangles": sum(len(result.solved) for result in results),
        "cones": sum(len(result.cones) for result in results),
        "islands": sum(int(result.island.max(initial=-1)) + 1 for result in results),
        "distortion": _fields(worst),
        "flipped": sum(len(result.flipped) for result in results),
        "wrong_angle_sums": sum(len(result.wrong_angle_sums) for result in results),
        "overlapping": sum(len(result.overlapping) for result in results),
        "overlap_area": max(result.overlap_area for result in results),
    }


def _fields(figures: Any) -> dict[str, float]:
    return {name: getattr(figures, name) for name in figures.__dataclass_fields__}
