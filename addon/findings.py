# SPDX-License-Identifier: GPL-3.0-or-later
"""What the last errors and warnings of each object said and named, kept in memory until its next run.

They are kept by mesh, whose indices they are; objects may share one.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import bpy
import numpy as np
from numpy.typing import NDArray

from . import redraw
from .reporting import explain

if TYPE_CHECKING:
    from .mesh_read import Region


@dataclass(frozen=True, slots=True)
class Named:
    """Vertices (k,), edges (k, 2) as vertex pairs and faces (k,) of a mesh, all int32."""

    vertices: NDArray[np.int32]
    edges: NDArray[np.int32]
    faces: NDArray[np.int32]

    def count(self) -> int:
        return len(self.vertices) + len(self.edges) + len(self.faces)


@dataclass(frozen=True, slots=True)
class Reported:
    """One error or warning: its sentence, what it names, and the mesh's size then."""

    text: str
    is_error: bool
    named: Named
    mesh_size: tuple[int, int, int]


# By session_uid, which stays the same through undo.
_last: dict[int, list[Reported]] = {}


def keep(obj: bpy.types.Object, region: Region | None, findings: Iterable[Any]) -> None:
    """Remember an object's findings, errors or warnings; what was remembered of it before is forgotten.

    region: what the library was given, to tell faces from its triangles; None where it was given nothing.
    """
    size = mesh_size(obj.data)
    _last[obj.data.session_uid] = [
        Reported(explain(finding), isinstance(finding, Exception), _named(region, finding), size)
        for finding in findings
    ]
    redraw.views()


def last(obj: bpy.types.Object) -> list[Reported]:
    """What the last run on this object said."""
    return _last.get(obj.data.session_uid, [])


def joined(named: Iterable[Named]) -> Named:
    """All of their elements, each once."""
    named = list(named)
    none = _nothing()
    return Named(
        vertices=np.unique(np.concatenate([none.vertices, *(part.vertices for part in named)])),
        edges=np.unique(np.concatenate([none.edges, *(part.edges for part in named)]), axis=0),
        faces=np.unique(np.concatenate([none.faces, *(part.faces for part in named)])),
    )


def mesh_size(mesh: bpy.types.Mesh) -> tuple[int, int, int]:
    """Numbers of vertices, edges and faces; indices of another mesh size mean other elements."""
    return len(mesh.vertices), len(mesh.edges), len(mesh.polygons)


def _named(region: Region | None, finding: Any) -> Named:
    elements, nothing = getattr(finding, "elements", None), _nothing()
    if region is None or elements is None or not len(elements.indices):
        return nothing
    indices = np.asarray(elements.indices, np.int32)
    if elements.kind == "triangles":
        return Named(nothing.vertices, nothing.edges, np.unique(region.triangle_faces[indices]))
    if elements.kind == "edges":
        return Named(nothing.vertices, np.unique(np.sort(indices, axis=1), axis=0), nothing.faces)
    return Named(np.unique(indices), nothing.edges, nothing.faces)


def _nothing() -> Named:
    none = np.empty(0, np.int32)
    return Named(none, none.reshape(0, 2), none)
