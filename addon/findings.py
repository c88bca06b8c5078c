# SPDX-License-Identifier: GPL-3.0-or-later
"""The elements that the last errors and warnings of each object named, kept in memory until its next run.

They are kept by mesh, whose indices they are; objects may share one.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import bpy
import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from .mesh_read import Region


@dataclass(frozen=True, slots=True)
class Reported:
    """Vertices (k,), edges (k, 2) as vertex pairs and faces (k,) of a mesh, all int32, and the mesh's size then."""

    vertices: NDArray[np.int32]
    edges: NDArray[np.int32]
    faces: NDArray[np.int32]
    mesh_size: tuple[int, int, int]


# By session_uid, which stays the same through undo.
_last: dict[int, Reported] = {}


def keep(obj: bpy.types.Object, region: Region | None, findings: Iterable[Any]) -> None:
    """Remember the elements of an object's findings; what was remembered of it before is forgotten.

    region: what the library was given, to tell faces from its triangles; None where it was given nothing.
    """
    _last.pop(obj.data.session_uid, None)
    found: dict[str, list[NDArray]] = {"vertices": [], "edges": [], "triangles": []}
    for finding in findings:
        elements = getattr(finding, "elements", None)
        if elements is not None and len(elements.indices):
            found[elements.kind].append(elements.indices)
    if region is None or not any(found.values()):
        return
    none = np.empty(0, np.int32)
    _last[obj.data.session_uid] = Reported(
        vertices=np.unique(np.concatenate([none, *found["vertices"]])),
        edges=np.unique(np.sort(np.concatenate([none.reshape(0, 2), *found["edges"]]), axis=1), axis=0),
        faces=np.unique(region.triangle_faces[np.concatenate([none, *found["triangles"]])]),
        mesh_size=mesh_size(obj.data),
    )


def last(obj: bpy.types.Object) -> Reported | None:
    """What the last run on this object named; None where it named nothing."""
    return _last.get(obj.data.session_uid)


def mesh_size(mesh: bpy.types.Mesh) -> tuple[int, int, int]:
    """Numbers of vertices, edges and faces; indices of another mesh size mean other elements."""
    return len(mesh.vertices), len(mesh.edges), len(mesh.polygons)
