# SPDX-License-Identifier: GPL-3.0-or-later
"""Adds an object with a mesh of quads beside its source."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import bpy
import numpy as np
from mathutils.bvhtree import BVHTree
from numpy.typing import NDArray

from ..core.cone_angles import Kind
from ..core.region import Region
from .angles import write_angles
from .carried import SurfacePoints, carry_face_values, carry_groups, carry_point_values
from .cones import mark_cones
from .stored_mesh import StoredMesh
from .texture import material_of

if TYPE_CHECKING:
    import lsgp

SUFFIX = " Quads"


def add_quad_object(obj: bpy.types.Object, region: Region, quads: lsgp.QuadMesh, cone_group: str) -> bpy.types.Object:
    """A selected object in the collections of a mesh object in object mode; the active one if that was active.

    It has the transform, parent and materials of the object, no modifiers, and what can be carried over of its mesh.
    Irregular vertices are cones in the group that is named.
    """
    points = SurfacePoints(region.surface.triangles[quads.triangles], quads.weights)
    mesh = _make_mesh(obj, region, points, quads.quads)
    made = obj.copy()
    made.name = mesh.name
    made.data = mesh
    made.modifiers.clear()
    _restore_materials(obj, made)
    carry_groups(obj, made, points, without=cone_group)
    if len(quads.irregular):
        mark_cones(made, cone_group, quads.irregular)
        angles = quads.valences[quads.irregular] * (math.pi / 2)
        write_angles(made, quads.irregular, angles.tolist(), [Kind.FOUND] * len(angles))
    _show_beside(obj, made)
    return made


def _make_mesh(
    obj: bpy.types.Object, region: Region, points: SurfacePoints, quads: NDArray[np.int32]
) -> bpy.types.Mesh:
    source = obj.data
    # In the mesh's own coordinates: those of the region are in the shape that the object's transform gives them.
    places = StoredMesh(source).places.astype(np.float64)
    positions = points.mean(places)
    mesh = bpy.data.meshes.new(obj.name + SUFFIX)
    mesh.from_pydata(positions.tolist(), [], quads.tolist(), shade_flat=False)
    for slot in range(len(source.materials)):
        mesh.materials.append(source.materials[slot])
    carry_point_values(source, mesh, points)
    carry_face_values(source, mesh, _faces_below(region, places, positions[quads].mean(axis=1)))
    mesh.update()
    return mesh


def _faces_below(region: Region, places: NDArray[np.float64], middles: NDArray[np.float64]) -> NDArray[np.int32]:
    """(q,) the face of the region that each point, (q, 3), is nearest to.  places: (n, 3) of the mesh's vertices."""
    tree = BVHTree.FromPolygons(places.tolist(), region.surface.triangles.tolist(), all_triangles=True)
    nearest = [tree.find_nearest(middle)[2] for middle in middles.tolist()]
    return region.triangle_faces[nearest]


def _restore_materials(obj: bpy.types.Object, made: bpy.types.Object) -> None:
    """Give it the object's own materials where a texture that shows the UV map is in their place."""
    for index, slot in enumerate(made.material_slots):
        slot.material = material_of(obj, index)
    made.property_unset("cone_unwrap_replaced")


def _show_beside(obj: bpy.types.Object, made: bpy.types.Object) -> None:
    for collection in obj.users_collection:
        collection.objects.link(made)
    made.select_set(True)
    objects = bpy.context.view_layer.objects
    if objects.active == obj:
        objects.active = made
