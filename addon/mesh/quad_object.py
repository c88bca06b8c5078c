# SPDX-License-Identifier: GPL-3.0-or-later
"""Adds an object with a mesh of quads beside its source."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import bpy
import numpy as np
from mathutils.bvhtree import BVHTree
from numpy.typing import NDArray

from ..core import native
from ..core.cone_angles import Kind
from ..core.region import Region
from .angles import write_angles
from .carried import SurfacePoints, carry_face_values, carry_groups, carry_point_values
from .carried_edges import carry_edge_values
from .carried_uv import carry_uv_maps
from .cones import mark_cones
from .stored_mesh import StoredMesh
from .texture import material_of

if TYPE_CHECKING:
    import lsgp
    from lsgp.quads.quad_map import QuadCenters

SUFFIX = " Quads"


def add_quad_object(
    obj: bpy.types.Object, region: Region, quads: lsgp.QuadMesh, cone_group: str
) -> tuple[bpy.types.Object, NDArray[np.int32]]:
    """A selected object in the collections of a mesh object in object mode; the active one if that was active. And the
    quads that lie across seams of a UV map, which are its faces.

    It has the transform, parent and materials of the object, no modifiers, and what can be carried over of its mesh.
    Irregular vertices are cones in the group that is named.
    """
    points = SurfacePoints(region.surface.triangles[quads.triangles], quads.weights)
    mesh, across = _make_mesh(obj, region, points, quads)
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
    return made, across


def _make_mesh(
    obj: bpy.types.Object, region: Region, points: SurfacePoints, quads: lsgp.QuadMesh
) -> tuple[bpy.types.Mesh, NDArray[np.int32]]:
    source = obj.data
    # In the mesh's own coordinates: those of the region are in the shape that the object's transform gives them.
    positions = points.mean(StoredMesh(source).places.astype(np.float64))
    mesh = bpy.data.meshes.new(obj.name + SUFFIX)
    mesh.from_pydata(positions.tolist(), [], quads.quads.tolist(), shade_flat=False)
    for slot in range(len(source.materials)):
        mesh.materials.append(source.materials[slot])
    centers = _centers(region, quads)
    carry_point_values(source, mesh, points)
    carry_face_values(source, mesh, region.triangle_faces[centers.triangles])
    carry_edge_values(source, mesh, (region.surface.positions, quads.positions))
    across = carry_uv_maps(source, mesh, region, quads, centers)
    mesh.update()
    return mesh, across


def _centers(region: Region, quads: lsgp.QuadMesh) -> QuadCenters:
    """The points of the surface that the quads' centers are nearest to."""
    surface = region.surface
    whole = np.flatnonzero(~native.part("stitching").is_collapsed(surface.triangles))
    triangles = surface.triangles[whole].tolist()
    tree = BVHTree.FromPolygons(surface.positions.tolist(), triangles, all_triangles=True)
    middles = quads.positions[quads.quads].mean(axis=1)
    found = [tree.find_nearest(middle) for middle in middles.tolist()]
    positions = np.array([hit[0] for hit in found], np.float64)
    return native.part("quads.quad_map").QuadCenters(whole[[hit[2] for hit in found]], positions)


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
