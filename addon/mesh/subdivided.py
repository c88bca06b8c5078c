# SPDX-License-Identifier: GPL-3.0-or-later
"""A mesh once its Subdivision Surface modifier is applied, as `uv.unwrap` has it too."""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np
from numpy.typing import NDArray

from .arrays import read_array

NAME = "Cone Unwrap subdivision"
# Attributes with the numbers that elements had before.
VERTEX = "cone_unwrap_vertex"
FACE = "cone_unwrap_face"
SETTINGS = {
    "MIRROR": ("use_axis", "mirror_object", "use_clip", "use_mirror_merge", "merge_threshold"),
    "SUBSURF": ("subdivision_type", "levels", "quality", "boundary_smooth", "use_creases", "use_limit_surface"),
}


@dataclass(frozen=True, slots=True)
class Subdivided:
    """places: (n, 3) of the mesh's vertices. areas: (f,) of what becomes of its faces; 0 of those that Mirror drops, as
    one of two faces between the same vertices."""

    places: NDArray[np.float32]
    areas: NDArray[np.float64]


def subdivide(obj: bpy.types.Object, mesh: bpy.types.Mesh) -> Subdivided | None:
    """None where the object shows no such modifier.

    mesh: the object's, out of edit mode. Of other modifiers only Mirror counts, if it comes before: half a figure is
    subdivided together with the other half. Shape keys do not count.
    """
    shown = [entry for entry in obj.modifiers if entry.show_viewport and entry.type in SETTINGS]
    smooth = next((i for i, entry in enumerate(shown) if entry.type == "SUBSURF"), None)
    if smooth is None or not len(mesh.polygons):
        return None
    scene = bpy.data.scenes.new(NAME)
    copy = mesh.copy()
    keys = None if copy.shape_keys is None else copy.shape_keys.session_uid
    stand_in = bpy.data.objects.new(NAME, copy)
    try:
        stand_in.shape_key_clear()
        stand_in.matrix_world = obj.matrix_world
        for name, domain, count in ((VERTEX, "POINT", len(mesh.vertices)), (FACE, "FACE", len(mesh.polygons))):
            number = copy.attributes.new(name, "INT", domain)
            number.data.foreach_set("value", np.arange(count, dtype=np.int32))
        for entry in shown[: smooth + 1]:
            own = stand_in.modifiers.new(NAME, entry.type)
            for name in SETTINGS[entry.type]:
                setattr(own, name, getattr(entry, name))
        scene.collection.objects.link(stand_in)
        layer = scene.view_layers[0]
        layer.update()
        evaluated = stand_in.evaluated_get(layer.depsgraph).data
        return Subdivided(_places(evaluated), _areas(evaluated, len(mesh.polygons)))
    finally:
        # Blender keeps what `shape_key_clear` took from the copy.
        left = [key for key in bpy.data.shape_keys if key.session_uid == keys]
        bpy.data.batch_remove([scene, stand_in, copy, *left])


def _places(subdivided: bpy.types.Mesh) -> NDArray[np.float32]:
    """Those of the vertices that were there before.

    Mirror puts images behind them, of which those in the plane replace them; Subdivision Surface puts the vertices of
    edges and faces behind all.
    """
    number = read_array(subdivided.attributes[VERTEX].data, "value", np.int32)
    first = np.unique(number, return_index=True)[1]
    return read_array(subdivided.vertices, "co", np.float32, 3)[first]


def _areas(subdivided: bpy.types.Mesh, count: int) -> NDArray[np.float64]:
    """Mirror puts images of all faces behind them, as large as these."""
    face = read_array(subdivided.attributes[FACE].data, "value", np.int32)
    images = 1 + int((np.diff(face) < 0).sum())
    return np.bincount(face, read_array(subdivided.polygons, "area", np.float32), minlength=count) / images
