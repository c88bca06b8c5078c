# SPDX-License-Identifier: GPL-3.0-or-later
"""The distortion of the active UV map on every face, as attributes that are added and taken away together."""

from __future__ import annotations

import bmesh
import bpy
import numpy as np
from numpy.typing import NDArray

from . import changes, native
from .identifiers import DISTORTION_ATTRIBUTES
from .mesh_read import Region
from .probe import probe

# Digests of UV maps measured since Blender started; undo in edit mode brings back attributes, but no mesh properties.
_measured: set[str] = set()


def measure(region: Region, face_count: int) -> dict[str, NDArray[np.float32]]:
    """(f,) values of each measure, for attributes; a face has the mean of its triangles by their area, 0 without any.

    region: all faces of the mesh.  Raises InputError.
    """
    found = native.lsgp.triangle_distortion(region.surface, region.corner_uv)
    place = region.surface.positions[region.surface.triangles]
    areas = np.linalg.norm(np.cross(place[:, 1] - place[:, 0], place[:, 2] - place[:, 0]), axis=1)
    largest = np.finfo(np.float32).max
    means = {}
    for measure in DISTORTION_ATTRIBUTES:
        values = getattr(found, measure)
        weights = np.where(np.isnan(values), 0.0, areas)
        values = np.minimum(np.nan_to_num(values, posinf=largest), largest)
        total = np.bincount(region.triangle_faces, weights, minlength=face_count)
        summed = np.bincount(region.triangle_faces, weights * values, minlength=face_count)
        mean = np.divide(summed, total, out=np.zeros(face_count), where=total > 0)
        means[measure] = np.minimum(mean, largest).astype(np.float32)
    return means


def write(mesh: bpy.types.Mesh, values: dict[str, NDArray[np.float32]]) -> None:
    """Set the attributes of all measures, and remember of which UV map they are."""
    for measure, of_face in values.items():
        name = DISTORTION_ATTRIBUTES[measure]
        if mesh.is_editmode:
            bm = bmesh.from_edit_mesh(mesh)
            layer = bm.faces.layers.float.get(name) or bm.faces.layers.float.new(name)
            for face, value in zip(bm.faces, of_face.tolist(), strict=True):
                face[layer] = value
        else:
            attribute = mesh.attributes.get(name) or mesh.attributes.new(name, "FLOAT", "FACE")
            attribute.data.foreach_set("value", of_face)
    _update(mesh)
    mesh.cone_unwrap_measured = probe(mesh)
    _measured.add(mesh.cone_unwrap_measured)


def clear(mesh: bpy.types.Mesh) -> bool:
    """Take the attributes away, and what is remembered of them.  Returns whether there were any."""
    present = is_measured(mesh)
    for name in DISTORTION_ATTRIBUTES.values():
        if mesh.is_editmode:
            layers = bmesh.from_edit_mesh(mesh).faces.layers.float
            if (layer := layers.get(name)) is not None:
                layers.remove(layer)
        elif (attribute := mesh.attributes.get(name)) is not None:
            mesh.attributes.remove(attribute)
    mesh.property_unset("cone_unwrap_measured")
    if present:
        _update(mesh)
    return present


def is_measured(mesh: bpy.types.Mesh) -> bool:
    """Whether the mesh has an attribute of ours."""
    names = set(DISTORTION_ATTRIBUTES.values())
    if mesh.is_editmode:
        return not names.isdisjoint(bmesh.from_edit_mesh(mesh).faces.layers.float.keys())
    return not names.isdisjoint(mesh.attributes.keys())


def is_current(mesh: bpy.types.Mesh) -> bool:
    """Whether the attributes are of the active UV map as it is."""
    if not is_measured(mesh):
        return False
    digest = probe(mesh)
    return digest == mesh.cone_unwrap_measured or digest in _measured


def _update(mesh: bpy.types.Mesh) -> None:
    if mesh.is_editmode:
        bmesh.update_edit_mesh(mesh, loop_triangles=False, destructive=False)
    else:
        mesh.update_tag()
    changes.mark_changed(mesh)


def register() -> None:
    bpy.types.Mesh.cone_unwrap_measured = bpy.props.StringProperty(
        name="Cone Unwrap Measured", description="The UV map that the distortion is of", options={"HIDDEN"}
    )


def unregister() -> None:
    del bpy.types.Mesh.cone_unwrap_measured
    _measured.clear()
