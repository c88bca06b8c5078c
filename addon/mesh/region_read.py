# SPDX-License-Identifier: GPL-3.0-or-later
"""From Blender to the arrays of computations: everything that is read about a mesh's faces is read here, at once."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from enum import Enum, auto

import bmesh
import bpy
import numpy as np
from numpy.typing import NDArray

from ..core import native
from ..core.cone_angles import ConeAngles
from ..core.errors import Refused
from ..core.identifiers import SEAM_COST_GROUP
from ..core.islands import Surroundings
from ..core.region import Region
from .angles import angles_in
from .cones import weights_in
from .image_aspect import image_aspect
from .mirror_planes import in_mirror_plane
from .reader import readable_mesh
from .stored_mesh import StoredMesh
from .subdivided import Subdivided, subdivide
from .texel_settings import density_weight

# Ratios of the sizes of an object's axes, which Blender has in single precision.
FLAT = 1e-6
UNIFORM = 1e-5
# What is left of the area of a cage that is made round; of one whose edges stay sharp hardly anything is lost.
ROUNDED = 0.93


class Faces(Enum):
    """Which faces of a mesh to read."""

    ALL = auto()
    SELECTED = auto()
    """The selected, visible ones in edit mode; all in object mode."""
    UV_SELECTED = auto()
    """Of the selected ones those with all UVs selected in the UV editor."""


@dataclass(frozen=True, slots=True)
class Groups:
    """The vertex groups to read: that of the cones and that of other weights; None for neither."""

    cones: str | None = None
    weights: str | None = None


def read_region(obj: bpy.types.Object, faces: Faces, groups: Groups, *, subdivided: bool = False) -> Region | None:
    """The faces of an object's mesh; None where none of them is selected.

    subdivided: with its vertices where the Subdivision Surface modifier puts them, and each connected part with the
        area that it has there.
    Raises Refused where the mesh has no faces or is linked from another file.
    """
    require_editable(obj)
    with readable_mesh(obj) as mesh:
        smooth = subdivide(obj, mesh) if subdivided else None
        return build_region(obj, StoredMesh(mesh), faces, groups, smooth)


def read_chosen(obj: bpy.types.Object, faces: Faces) -> tuple[Region, NDArray[np.bool_]] | None:
    """All faces of an object's mesh, as the Subdivision Surface modifier shows them, and (m,) bool, the triangles of
    those that are asked for; None where none is.

    Raises Refused as `read_region`.
    """
    require_editable(obj)
    with readable_mesh(obj) as mesh:
        stored = StoredMesh(mesh)
        whole = build_region(obj, stored, Faces.ALL, Groups(), subdivide(obj, mesh))
        chosen = _chosen_faces(stored, faces, obj.mode)
        return (whole, chosen[whole.triangle_faces]) if chosen.any() else None


def read_surroundings(objects: Iterable[bpy.types.Object], faces: Faces) -> Surroundings | None:
    """The faces of meshes in edit mode that are not asked for; None where all are.  Those without a UV map, and UVs
    that are not finite, count for nothing."""
    is_part, corners, size = False, [np.empty((0, 3, 2))], 0.0
    for obj in objects:
        if obj.mode != "EDIT":
            continue
        with readable_mesh(obj) as mesh:
            stored = StoredMesh(mesh)
            chosen = _chosen_faces(stored, faces, obj.mode)
            is_part |= not chosen.all()
            if stored.uv is None or chosen.all():
                continue
            loops = stored.triangle_loops[~chosen[stored.triangle_faces]]
            uv, places = stored.uv[loops].astype(np.float64), stored.places[stored.loop_vertices[loops]]
            kept = np.isfinite(uv).all(axis=(1, 2)) & np.isfinite(places).all(axis=(1, 2))
            corners.append(uv[kept])
            first, second = (
                np.moveaxis(places[kept][:, 1:] - places[kept][:, :1], 1, 0)
                @ np.array(obj.matrix_world.to_3x3(), np.float64).T
            )
            size += np.linalg.norm(np.cross(first, second), axis=1).sum() / 2 * density_weight(obj) ** 2
    return Surroundings(np.concatenate(corners), float(np.sqrt(size))) if is_part else None


def build_region(
    obj: bpy.types.Object,
    mesh: StoredMesh,
    faces: Faces,
    groups: Groups,
    subdivided: Subdivided | None = None,
) -> Region | None:
    """As `read_region`, of a mesh that is readable already.  subdivided: None for the mesh as it is."""
    chosen = _chosen_faces(mesh, faces, obj.mode)
    if not chosen.any():
        if faces is Faces.ALL or obj.mode != "EDIT":
            raise Refused("the mesh has no faces; add some or select another object")
        return None
    inside = chosen[mesh.triangle_faces]
    triangle_loops = mesh.triangle_loops[inside]
    triangles = mesh.surface_loops[triangle_loops]
    is_rounded = subdivided is not None and (
        _areas(subdivided.places, triangles).sum() < ROUNDED * _areas(mesh.places, triangles).sum()
    )
    vertex_used = np.zeros(len(mesh.places), bool)
    vertex_used[triangles] = True
    edge_used = np.zeros(len(mesh.edges), bool)
    edge_used[mesh.loop_edges[chosen[mesh.loop_faces]]] = True
    edges = mesh.surface_edges
    shape, axes, size = _object_shape(obj)
    places = (mesh.places.astype(np.float64) if subdivided is None else _enlarged(mesh, subdivided)) @ shape
    uv = np.full((len(mesh.loop_vertices), 2), np.nan) if mesh.uv is None else mesh.uv.astype(np.float64)
    return Region(
        surface=native.lsgp.Surface(
            places,
            triangles,
            edges=edges[edge_used],
            seams=edges[edge_used & mesh.is_seam],
            features=edges[edge_used & mesh.is_feature],
            may_collapse=True,
        ),
        triangle_loops=triangle_loops,
        triangle_faces=mesh.triangle_faces[inside],
        face_loop_start=mesh.loop_start,
        vertex_used=vertex_used,
        corner_uv=uv[triangle_loops],
        pinned=mesh.pinned[triangle_loops],
        cones=ConeAngles.none() if groups.cones is None else angles_in(obj, groups.cones, mesh),
        sharp=edges[edge_used & mesh.is_sharp],
        active_edge=_active_edge(obj, mesh, edges[edge_used]),
        drawn_up=_drawn_up(mesh, inside, shape),
        along=_along(edges[edge_used & mesh.is_along]),
        cut_paint=weights_in(obj, SEAM_COST_GROUP, mesh, outside=0.5),
        axes=axes,
        weights=None if groups.weights is None else weights_in(obj, groups.weights, mesh),
        image_aspect=image_aspect(obj),
        object_scale=size,
        density_weight=density_weight(obj),
        is_rounded=is_rounded,
        stitched=mesh.stitched,
        mesh_edges=mesh.edges[edge_used],
        in_mirror_plane=in_mirror_plane(obj, mesh.places),
    )


def _enlarged(mesh: StoredMesh, subdivided: Subdivided) -> NDArray[np.float64]:
    """(n, 3) places of the vertices, each connected part enlarged about its middle to the area of its subdivided faces:
    flat ones between the same vertices have less, and texels are those of the surface that is seen."""
    count = len(subdivided.places)
    part = native.part("base.places").lowest_linked(mesh.surface_edges, count)
    triangles = mesh.surface_loops[mesh.triangle_loops]
    flat = np.bincount(part[triangles[:, 0]], _areas(subdivided.places, triangles), minlength=count)
    curved = np.bincount(part[mesh.surface_loops[mesh.loop_start]], subdivided.areas, minlength=count)
    factor = np.sqrt(np.divide(curved, flat, out=np.ones(count), where=(flat > 0) & (curved > 0)))
    sums = np.stack([np.bincount(part, column, minlength=count) for column in subdivided.places.T], axis=1)
    middle = (sums / np.maximum(np.bincount(part, minlength=count), 1)[:, None])[part]
    return middle + factor[part, None] * (subdivided.places - middle)


def _areas(places: NDArray[np.float32], triangles: NDArray[np.int32]) -> NDArray[np.float64]:
    """(m,)"""
    return native.part("triangles").triangle_areas(native.lsgp.Surface(places.astype(np.float64), triangles))


def _active_edge(obj: bpy.types.Object, mesh: StoredMesh, edges: NDArray[np.int32]) -> tuple[int, int] | None:
    """The vertices of the active edge; None outside edit mode, or where it is none of these edges of the surface."""
    active = bmesh.from_edit_mesh(obj.data).select_history.active if obj.mode == "EDIT" else None
    if not isinstance(active, bmesh.types.BMEdge):
        return None
    ends = sorted(mesh.stitched[vertex.index] for vertex in active.verts)
    return tuple(ends) if (np.sort(edges, axis=1) == ends).all(axis=1).any() else None


def _drawn_up(mesh: StoredMesh, inside: NDArray[np.bool_], shape: NDArray[np.float64]) -> NDArray[np.float64] | None:
    """Of the triangles inside, stretched as they are; None where nothing is drawn on them."""
    if mesh.drawn_up is None:
        return None
    drawn = mesh.drawn_up[mesh.triangle_faces[inside]].astype(np.float64) @ shape
    return drawn if drawn.any() else None


def _along(edges: NDArray[np.int32]) -> NDArray[np.int32]:
    """Those of the surface that have a length, each once."""
    return np.unique(np.sort(edges[edges[:, 0] != edges[:, 1]], axis=1), axis=0)


def _object_shape(obj: bpy.types.Object) -> tuple[NDArray[np.float64], NDArray[np.float64], float]:
    """How the object's transform stretches places along the mesh's axes, (3, 3), which they are to be multiplied with
    on the right, how it turns these axes, (3, 3), and how much it enlarges.

    A transform that enlarges alike in all directions changes no shape, and one that flattens leaves none: then places
    are as in the mesh.
    """
    turned, sizes, axes = np.linalg.svd(np.array(obj.matrix_world.to_3x3(), np.float64))
    if sizes[-1] <= FLAT * sizes[0] or sizes[0] <= (1 + UNIFORM) * sizes[-1]:
        return np.eye(3), turned @ axes, obj.matrix_world.median_scale
    size = float(np.cbrt(sizes.prod()))
    return (axes.T * (sizes / size)) @ axes, turned @ axes, size


def is_editable(obj: bpy.types.Object) -> bool:
    """Whether the mesh belongs to this file.  Of an override of another file's mesh Blender saves no changes."""
    return obj.data.is_editable and obj.data.override_library is None


def require_editable(obj: bpy.types.Object) -> None:
    """Raise Refused where the mesh belongs to another file."""
    if not is_editable(obj):
        raise Refused("the mesh is linked from another file and cannot be changed; make it local (Object > Relations)")


def require_uv_map(obj: bpy.types.Object) -> None:
    """Raise Refused where the mesh has none."""
    if obj.data.uv_layers.active is None:
        raise Refused("the mesh has no UV map; unwrap it first")


def _chosen_faces(mesh: StoredMesh, faces: Faces, mode: str) -> NDArray[np.bool_]:
    if faces is Faces.ALL or mode != "EDIT":
        chosen = np.ones(len(mesh.loop_start), bool)
    else:
        chosen = mesh.is_selected & ~mesh.is_hidden
    if faces is Faces.UV_SELECTED:
        chosen[mesh.loop_faces[~mesh.uv_selected]] = False
    return chosen
