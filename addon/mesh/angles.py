# SPDX-License-Identifier: GPL-3.0-or-later
"""The angle of each cone and its origin, stored in two point attributes.

Attributes are saved and copied with the mesh, and kept by joining, mirroring and decimating. Subdividing and beveling
interpolate attributes and weights alike: a vertex that got a fraction of a cone's weight also got a fraction of its
angle, which means nothing. Angles therefore count only where the weight is 1; cones of less weight are automatic.

The attribute has single precision, in which angles do not add up exactly enough: values that are whole degrees up to
rounding are read as whole degrees, and computed angles are corrected for each other's rounding when they are used.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

import bmesh
import bpy
import numpy as np

from ..core.cone_angles import ConeAngles, Kind
from ..core.identifiers import CONE_ANGLE_ATTRIBUTE, CONE_ANGLE_KIND_ATTRIBUTE
from .attributes import require_type
from .cones import cones_among, weights_in
from .mesh_reader import MeshReader
from .reader import reader

FULL_WEIGHT = 1.0 - 1e-6

# Names and types of the attributes.
_ATTRIBUTES = ((CONE_ANGLE_ATTRIBUTE, "FLOAT"), (CONE_ANGLE_KIND_ATTRIBUTE, "INT"))


def read_angles(obj: bpy.types.Object, group_name: str) -> ConeAngles:
    """The cones of a vertex group and their angles."""
    return angles_in(obj, group_name, reader(obj.data))


def angles_in(obj: bpy.types.Object, group_name: str, mesh: MeshReader) -> ConeAngles:
    """As `read_angles`, of a mesh that is readable already."""
    weights = weights_in(obj, group_name, mesh)
    if weights is None:
        return ConeAngles.none()
    cones = cones_among(weights)
    on_surface, first = np.unique(mesh.stitched[cones], return_index=True)
    cones = cones[first]
    values, kinds = (mesh.point_values(name, item, cones.tolist()) for name, item in _ATTRIBUTES)
    full = weights[cones] >= FULL_WEIGHT
    return ConeAngles(
        on_surface,
        [_exact(value) if counts and value != 0.0 else None for value, counts in zip(values, full, strict=True)],
        [Kind(kind) if kind in list(Kind) else Kind.PRESCRIBED for kind in kinds],
    )


def write_angles(
    obj: bpy.types.Object, vertices: Iterable[int], angles: Sequence[float | None], kinds: Sequence[Kind]
) -> None:
    """Store the angles of cones with full weight, None for automatic.  Raises Refused before anything is changed."""
    require_attributes(obj.data)
    rows = [
        (int(vertex), angle or 0.0, int(kind if angle else Kind.PRESCRIBED))
        for vertex, angle, kind in zip(vertices, angles, kinds, strict=True)
    ]
    if obj.data.is_editmode:
        _write_edit_mesh(obj.data, rows)
    else:
        _write_mesh(obj.data, rows)


def forget_angles(obj: bpy.types.Object, vertices: Sequence[int]) -> None:
    """Remove the angles of vertices that are no longer cones, without creating missing attributes."""
    mesh, vertices = reader(obj.data), [int(vertex) for vertex in vertices]
    if any(any(mesh.point_values(name, item, vertices)) for name, item in _ATTRIBUTES):
        write_angles(obj, vertices, [None] * len(vertices), [Kind.PRESCRIBED] * len(vertices))


def require_attributes(mesh: bpy.types.Mesh) -> None:
    """Raise Refused where other attributes have the names of ours."""
    for name, item in _ATTRIBUTES:
        require_type(mesh, name, item)


def _write_edit_mesh(mesh: bpy.types.Mesh, rows: list[tuple[int, float, int]]) -> None:
    bm = bmesh.from_edit_mesh(mesh)
    collections = [(getattr(bm.verts.layers, item.lower()), name) for name, item in _ATTRIBUTES]
    # A new layer invalidates references to the others.
    for layers, name in collections:
        if layers.get(name) is None:
            layers.new(name)
    angle_layer, kind_layer = (layers[name] for layers, name in collections)
    bm.verts.ensure_lookup_table()
    for vertex, angle, kind in rows:
        bm.verts[vertex][angle_layer] = angle
        bm.verts[vertex][kind_layer] = kind
    bmesh.update_edit_mesh(mesh, loop_triangles=False, destructive=False)


def _write_mesh(mesh: bpy.types.Mesh, rows: list[tuple[int, float, int]]) -> None:
    for column, (name, item) in enumerate(_ATTRIBUTES, 1):
        attribute = mesh.attributes.get(name) or mesh.attributes.new(name, item, "POINT")
        # All values at once: single ones would be written into arrays shared with copies and undo steps.
        values = np.empty(len(mesh.vertices), np.float32 if item == "FLOAT" else np.int32)
        attribute.data.foreach_get("value", values)
        for row in rows:
            values[row[0]] = row[column]
        attribute.data.foreach_set("value", values)
    mesh.update_tag()


def _exact(angle: float) -> float:
    """The whole number of degrees that rounds to this single-precision angle, if there is one."""
    degrees = math.radians(round(math.degrees(angle))) if math.isfinite(angle) else angle
    return degrees if np.float32(degrees) == np.float32(angle) else angle
