# SPDX-License-Identifier: GPL-3.0-or-later
"""The angle of each cone and where it comes from, kept in two attributes on points.

So they are saved and copied with the mesh, and joined, mirrored and decimated as all attributes are. Subdividing and
bevelling share out attributes and weights alike: a vertex that got a share of a cone's weight got a share of its angle,
which means nothing. Angles therefore count where the weight is 1; cones of less weight are automatic.

The attribute has single precision, in which angles do not add up as exactly as they have to: whole degrees are read as
such, and found angles make up for each other's rounding when they are held.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from enum import IntEnum
from typing import TYPE_CHECKING

import bmesh
import bpy
import numpy as np
from numpy.typing import NDArray

from . import native
from .identifiers import CONE_ANGLE_ATTRIBUTE, CONE_ANGLE_KIND_ATTRIBUTE
from .mesh_read import vertex_weights
from .reporting import Refused

if TYPE_CHECKING:
    import lsgp

FULL_WEIGHT = 1.0 - 1e-6


class Kind(IntEnum):
    """Where an angle comes from; the values are stored."""

    PRESCRIBED = 0
    FOUND = 1
    """By Place Cones or Spread the Rest, for the cones as they were then."""
    SNAPPED = 2


# Name, item of the attributes, and their layers in edit mode.
_ATTRIBUTES = ((CONE_ANGLE_ATTRIBUTE, "FLOAT", "float"), (CONE_ANGLE_KIND_ATTRIBUTE, "INT", "int"))


@dataclass(frozen=True, slots=True)
class ConeAngles:
    """Cones (k,) int32, ascending, the angle of each in radians, None for automatic, and where it comes from."""

    cones: NDArray[np.int32]
    angles: list[float | None]
    kinds: list[Kind]

    def on(self, accepted: NDArray[np.bool_]) -> ConeAngles:
        """Those at accepted vertices.  accepted: (n,) bool."""
        rows = np.flatnonzero(accepted[self.cones])
        return ConeAngles(self.cones[rows], [self.angles[i] for i in rows], [self.kinds[i] for i in rows])

    @property
    def tentative(self) -> NDArray[np.bool_]:
        """(k,) bool, the angles that were found."""
        return np.array([kind == Kind.FOUND for kind in self.kinds], bool)

    def fixed(self) -> list[float | None]:
        """The angles that the artist chose; None for the others."""
        return [None if kind == Kind.FOUND else angle for angle, kind in zip(self.angles, self.kinds, strict=True)]

    def held(self, surface: lsgp.Surface, options: lsgp.Options) -> ConeAngles:
        """With found angles only where they still are a complete set, automatic elsewhere."""
        angles = native.lsgp.hold_complete(surface, self.cones, self.angles, self.tentative, options)
        return replace(self, angles=angles)


def read_angles(obj: bpy.types.Object, group_name: str) -> ConeAngles:
    """The cones of a group and their angles."""
    weights = vertex_weights(obj, group_name)
    if weights is None:
        return ConeAngles(np.empty(0, np.int32), [], [])
    cones = np.flatnonzero(weights > 0.0).astype(np.int32)
    values, kinds = _read(obj.data, cones.tolist())
    known = [kind if kind in list(Kind) else Kind.PRESCRIBED for kind in kinds]
    full = weights[cones] >= FULL_WEIGHT
    return ConeAngles(
        cones,
        [_exact(value) if counts and value != 0.0 else None for value, counts in zip(values, full, strict=True)],
        [Kind(kind) for kind in known],
    )


def write_angles(
    obj: bpy.types.Object, vertices: Iterable[int], angles: Sequence[float | None], kinds: Sequence[Kind]
) -> None:
    """Store the angles of cones of full weight, None for automatic.  Raises Refused before anything is changed."""
    mesh = obj.data
    require_attributes(mesh)
    rows = [
        (int(vertex), angle or 0.0, int(kind if angle else Kind.PRESCRIBED))
        for vertex, angle, kind in zip(vertices, angles, kinds, strict=True)
    ]
    if mesh.is_editmode:
        bm = bmesh.from_edit_mesh(mesh)
        # A new layer moves what is held of the others.
        for name, _, layers in _ATTRIBUTES:
            collection = getattr(bm.verts.layers, layers)
            if collection.get(name) is None:
                collection.new(name)
        angle_layer, kind_layer = (getattr(bm.verts.layers, layers)[name] for name, _, layers in _ATTRIBUTES)
        bm.verts.ensure_lookup_table()
        for vertex, angle, kind in rows:
            bm.verts[vertex][angle_layer] = angle
            bm.verts[vertex][kind_layer] = kind
        bmesh.update_edit_mesh(mesh, loop_triangles=False, destructive=False)
        return
    for column, (name, item, _) in enumerate(_ATTRIBUTES, 1):
        attribute = mesh.attributes.get(name) or mesh.attributes.new(name, item, "POINT")
        # All at once: single values would be written into arrays that copies and steps of undo share.
        values = np.empty(len(mesh.vertices), np.float32 if item == "FLOAT" else np.int32)
        attribute.data.foreach_get("value", values)
        for row in rows:
            values[row[0]] = row[column]
        attribute.data.foreach_set("value", values)
    mesh.update_tag()


def forget_angles(obj: bpy.types.Object, vertices: Sequence[int]) -> None:
    """Leave no angle at vertices that are no cones any more; attributes of ours that are not there are not made."""
    rows = _read(obj.data, [int(vertex) for vertex in vertices])
    if any(rows[0]) or any(rows[1]):
        write_angles(obj, vertices, [None] * len(vertices), [Kind.PRESCRIBED] * len(vertices))


def require_attributes(mesh: bpy.types.Mesh) -> None:
    """Raise Refused where the attributes' names are taken by other ones."""
    for name, item, _ in _ATTRIBUTES:
        attribute = mesh.attributes.get(name)
        if attribute is not None and (attribute.domain, attribute.data_type) != ("POINT", item):
            raise Refused(f'the attribute "{name}" is no {item.lower()} on points; rename it')


def _exact(angle: float) -> float:
    """The whole number of degrees that an angle is the nearest single-precision number to, if it is one."""
    degrees = math.radians(round(math.degrees(angle))) if math.isfinite(angle) else angle
    return degrees if np.float32(degrees) == np.float32(angle) else angle


def _read(mesh: bpy.types.Mesh, vertices: list[int]) -> tuple[list[float], list[int]]:
    """Both attributes at vertices, 0 where they are missing."""
    if mesh.is_editmode:
        bm = bmesh.from_edit_mesh(mesh)
        bm.verts.ensure_lookup_table()
        columns = []
        for name, _, layers in _ATTRIBUTES:
            layer = getattr(bm.verts.layers, layers).get(name)
            columns.append([0 if layer is None else bm.verts[vertex][layer] for vertex in vertices])
        return columns[0], columns[1]
    columns = []
    for name, item, _ in _ATTRIBUTES:
        attribute = mesh.attributes.get(name)
        present = attribute is not None and (attribute.domain, attribute.data_type) == ("POINT", item)
        columns.append([attribute.data[vertex].value if present else 0 for vertex in vertices])
    return columns[0], columns[1]
