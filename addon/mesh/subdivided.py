# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the vertices of a mesh are once its Subdivision Surface modifier is applied, as `uv.unwrap` has it too."""

from __future__ import annotations

import bpy
import numpy as np
from numpy.typing import NDArray

from .arrays import read_array

NAME = "Cone Unwrap subdivision"
SETTINGS = ("subdivision_type", "levels", "quality", "boundary_smooth", "use_creases", "use_limit_surface")


def places_on_subdivision(obj: bpy.types.Object, mesh: bpy.types.Mesh) -> NDArray[np.float32] | None:
    """(n, 3) places of the vertices; None where the object shows no such modifier.

    mesh: the object's, out of edit mode. Other modifiers do not count, nor do shape keys.
    """
    modifier = next((entry for entry in obj.modifiers if entry.type == "SUBSURF" and entry.show_viewport), None)
    if modifier is None or not len(mesh.polygons):
        return None
    scene = bpy.data.scenes.new(NAME)
    copy = mesh.copy()
    stand_in = bpy.data.objects.new(NAME, copy)
    try:
        stand_in.shape_key_clear()
        own = stand_in.modifiers.new(NAME, "SUBSURF")
        for name in SETTINGS:
            setattr(own, name, getattr(modifier, name))
        scene.collection.objects.link(stand_in)
        layer = scene.view_layers[0]
        layer.update()
        subdivided = stand_in.evaluated_get(layer.depsgraph).data
        # Blender puts the vertices of edges and faces behind those that there were.
        return read_array(subdivided.vertices, "co", np.float32, 3)[: len(mesh.vertices)].copy()
    finally:
        bpy.data.batch_remove([scene, stand_in, copy])
