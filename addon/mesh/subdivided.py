# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the vertices of a mesh are once its Subdivision Surface modifier is applied, as `uv.unwrap` has it too."""

from __future__ import annotations

import bpy
import numpy as np
from numpy.typing import NDArray

from .arrays import read_array

NAME = "Cone Unwrap subdivision"
SETTINGS = {
    "MIRROR": ("use_axis", "mirror_object", "use_clip", "use_mirror_merge", "merge_threshold"),
    "SUBSURF": ("subdivision_type", "levels", "quality", "boundary_smooth", "use_creases", "use_limit_surface"),
}


def places_on_subdivision(obj: bpy.types.Object, mesh: bpy.types.Mesh) -> NDArray[np.float32] | None:
    """(n, 3) places of the vertices; None where the object shows no such modifier.

    mesh: the object's, out of edit mode. Of other modifiers only Mirror counts, if it comes before: half a figure is
    subdivided together with the other half. Shape keys do not count.
    """
    shown = [entry for entry in obj.modifiers if entry.show_viewport and entry.type in SETTINGS]
    smooth = next((i for i, entry in enumerate(shown) if entry.type == "SUBSURF"), None)
    if smooth is None or not len(mesh.polygons):
        return None
    scene = bpy.data.scenes.new(NAME)
    copy = mesh.copy()
    stand_in = bpy.data.objects.new(NAME, copy)
    try:
        stand_in.shape_key_clear()
        stand_in.matrix_world = obj.matrix_world
        number = copy.attributes.new(NAME, "INT", "POINT")
        number.data.foreach_set("value", np.arange(len(mesh.vertices), dtype=np.int32))
        for entry in shown[: smooth + 1]:
            own = stand_in.modifiers.new(NAME, entry.type)
            for name in SETTINGS[entry.type]:
                setattr(own, name, getattr(entry, name))
        scene.collection.objects.link(stand_in)
        layer = scene.view_layers[0]
        layer.update()
        return _places(stand_in.evaluated_get(layer.depsgraph).data, number.name)
    finally:
        bpy.data.batch_remove([scene, stand_in, copy])


def _places(subdivided: bpy.types.Mesh, numbers: str) -> NDArray[np.float32]:
    """Those of the vertices that were there before, by an attribute with their numbers.

    Mirror puts images behind them, of which those in the plane replace them; Subdivision Surface puts the vertices of
    edges and faces behind all.
    """
    number = read_array(subdivided.attributes[numbers].data, "value", np.int32)
    first = np.unique(number, return_index=True)[1]
    return read_array(subdivided.vertices, "co", np.float32, 3)[first]
