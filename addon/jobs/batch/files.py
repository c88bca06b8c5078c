# SPDX-License-Identifier: GPL-3.0-or-later
"""The files of a batch: opening them in Blender, which meshes they have, saving."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import bpy

from ...mesh.region_read import is_editable

SUFFIXES = (".blend", ".glb", ".gltf", ".fbx")


class Unreadable(Exception):
    """A file that Blender cannot read; the message says why."""


def output_name(name: str) -> str:
    """The name of the result: a .gltf, which consists of several files, becomes a .glb."""
    return f"{name}.glb" if name.lower().endswith(".gltf") else name


def open_file(path: str) -> None:
    """Replace what is open in Blender with this file.  Raises Unreadable."""
    read = _READERS.get(Path(path).suffix.lower())
    if read is None:
        raise Unreadable(f"'{path}' is not a {', '.join(SUFFIXES)} file. Save it as one of these.")
    try:
        read(path)
    except RuntimeError as error:  # how Blender's operators report a failure
        raise Unreadable(f"Blender cannot read it: {' '.join(str(error).split())}") from error
    if bpy.context.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")


def _read_blend(path: str) -> None:
    bpy.ops.wm.open_mainfile(filepath=path, load_ui=False, use_scripts=False)


def _read_gltf(path: str) -> None:
    _clear()
    bpy.ops.import_scene.gltf(filepath=path)


def _read_fbx(path: str) -> None:
    _clear()
    bpy.ops.import_scene.fbx(filepath=path)


def _clear() -> None:
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)


_READERS: dict[str, Callable[[str], None]] = {
    ".blend": _read_blend,
    ".glb": _read_gltf,
    ".gltf": _read_gltf,
    ".fbx": _read_fbx,
}


def save_file(path: str) -> None:
    """Write the open file in the format of this name's suffix."""
    suffix = Path(path).suffix.lower()
    if suffix == ".blend":
        bpy.ops.wm.save_as_mainfile(filepath=path, copy=True)
    elif suffix == ".glb":
        bpy.ops.export_scene.gltf(filepath=path, export_format="GLB")
    else:
        bpy.ops.export_scene.fbx(filepath=path)


def mesh_objects() -> list[bpy.types.Object]:
    """One object per mesh that has faces and belongs to this file, sorted by name."""
    one_per_mesh: dict[bpy.types.Mesh, bpy.types.Object] = {}
    for obj in sorted(bpy.data.objects, key=lambda obj: obj.name_full):
        if obj.type == "MESH" and is_editable(obj) and obj.data.polygons:
            one_per_mesh.setdefault(obj.data, obj)
    return list(one_per_mesh.values())
