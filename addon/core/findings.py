# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors and warnings: their wording, and those of the last run on each mesh with the elements they name.

They are kept in memory by mesh, whose indices they hold; objects may share a mesh.
"""

from __future__ import annotations

import logging
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from enum import IntEnum
from typing import TYPE_CHECKING, Any

import bpy
import numpy as np
from numpy.typing import NDArray

from . import native, redraw
from .errors import Refused
from .per_mesh import kept_by_mesh
from .text import counted
from .wording import for_artists

if TYPE_CHECKING:
    from .region import Region

_logger = logging.getLogger("cone_unwrap")


class Severity(IntEnum):
    """INFORMATION: nothing needs to be done. ATTENTION: there is a result to look at. BROKEN: there is none."""

    INFORMATION = 0
    ATTENTION = 1
    BROKEN = 2


INFORMATION = frozenset(
    {
        "BORDERS_STITCHED",
        "CONE_ON_BOUNDARY",
        "CONES_MERGED",
        "CUTS_ADDED",
        "CUTS_NOT_MIRRORED",
        "DEGENERATE_FACES",
        "DUPLICATE_FACE",
        "FEATURES_OFF_LATTICE",
        "FEATURES_RELEASED",
        "FLAT_CONES",
        "GRID_REFINED",
        "ISLANDS_HIDDEN",
        "ISLANDS_STACKED",
        "ISOLATED_VERTICES",
        "JUNCTION_SHARE",
        "NON_MANIFOLD_EDGE",
        "REORIENTED",
        "SEAMS_OPENED",
        "SPECTRAL_NEEDS_CLOSED",
        "SPLIT_VERTEX",
        "TILE_SIZE_DIFFERS",
        "UV_ACROSS_SEAMS",
    }
)
"""Codes of warnings after which nothing needs to be done."""

ONLY_LISTED = frozenset({"BORDERS_STITCHED", "FEATURES_OFF_LATTICE", "UV_ACROSS_SEAMS"})
"""Codes of warnings that are in the list of the last run alone: the one-line summary of an object covers them, or shows
that they did no harm."""

MOST_NAMES = 3
"""Of objects in one sentence."""

Problem = Any
"""An LsgpError or Finding of the library, a Refused or a MemoryError."""


def explain(problem: Problem) -> str:
    """What is wrong and what to do, as an artist reads it."""
    if isinstance(problem, MemoryError):
        return "there is not enough memory; unwrap fewer faces at once"
    if isinstance(problem, Refused):
        return str(problem)
    return for_artists(problem.message)


def severity(problem: Problem) -> Severity:
    if isinstance(problem, Exception):
        return Severity.BROKEN
    return Severity.INFORMATION if problem.code in INFORMATION else Severity.ATTENTION


def relevant(region: Region, problems: Iterable[Problem]) -> list[Problem]:
    """Those that are true of the model: vertices of faces that are not selected are not isolated, nor are those that
    are stitched to others, which is told in their place. Of pieces that touch where a Mirror modifier merges a half
    with its image nothing is told, since it would merge them again.
    """
    stitching = native.part("stitching")
    own = np.where(region.vertex_used[region.stitched], region.stitched, np.arange(len(region.stitched)))
    true = stitching.without_stitched(region.stitched, problems)
    kept = [
        problem
        for problem in true
        if (region.is_whole or problem.code != "ISOLATED_VERTICES")
        and (problem.code != "SPLIT_VERTEX" or not region.in_mirror_plane[problem.elements.indices].all())
    ]
    return [*stitching.stitched_finding(own), *kept]


def in_groups(found: Mapping[str, Iterable[Problem]]) -> list[tuple[Severity, str]]:
    """Each sentence once, with the objects it is about and how often it was said; the most severe ones last.

    found: by name of the object.
    """
    names: dict[tuple[Severity, str], list[str]] = {}
    for name, problems in found.items():
        for problem in problems:
            if getattr(problem, "code", None) in ONLY_LISTED:
                continue
            names.setdefault((severity(problem), explain(problem)), []).append(name)
    lines = []
    for (how, text), said in sorted(names.items(), key=lambda group: group[0][0]):
        about = list(dict.fromkeys(said))
        who = ", ".join(about[:MOST_NAMES])
        if len(about) > MOST_NAMES:
            who += f" and {counted(len(about) - MOST_NAMES, 'more object')}"
        lines.append((how, f"{who}: {text}" + (f" ({len(said)} times)" if len(said) > len(about) else "")))
    return lines


@dataclass(frozen=True, slots=True)
class MeshElements:
    """Vertices (k,), edges (k, 2) as vertex pairs and faces (k,) of a mesh, all int32."""

    vertices: NDArray[np.int32]
    edges: NDArray[np.int32]
    faces: NDArray[np.int32]

    @classmethod
    def none(cls) -> MeshElements:
        return cls(np.empty(0, np.int32), np.empty((0, 2), np.int32), np.empty(0, np.int32))

    def count(self) -> int:
        return len(self.vertices) + len(self.edges) + len(self.faces)


@dataclass(frozen=True, slots=True)
class KeptFinding:
    """An error or warning: its sentence, the elements it names, the size the mesh had then, how often it was said."""

    text: str
    severity: Severity
    elements: MeshElements
    mesh_size: tuple[int, int, int]
    times: int = 1


_last: dict[int, list[KeptFinding]] = kept_by_mesh()


def keep(obj: bpy.types.Object, region: Region | None, problems: Iterable[Problem]) -> None:
    """Keep an object's errors and warnings in place of the previous ones, and log them with their codes.

    region: what the library was given, which relates its triangles to faces; None where it was given nothing.
    """
    size = mesh_size(obj.data)
    said: dict[tuple[Severity, str], list[MeshElements]] = {}
    for problem in problems:
        _log(obj, problem)
        said.setdefault((severity(problem), explain(problem)), []).append(_elements(region, problem))
    _last[obj.data.session_uid] = [
        KeptFinding(text, how, joined(elements), size, len(elements))
        for (how, text), elements in sorted(said.items(), key=lambda group: -group[0][0])
    ]
    redraw.views()


def _log(obj: bpy.types.Object, problem: Problem) -> None:
    level = logging.INFO if severity(problem) == Severity.INFORMATION else logging.WARNING
    code = getattr(problem, "code", type(problem).__name__)
    _logger.log(level, "%s: %s: %s", obj.name, code, getattr(problem, "message", problem))


def last(obj: bpy.types.Object) -> list[KeptFinding]:
    """The findings of the last run on this object."""
    return _last.get(obj.data.session_uid, [])


def joined(parts: Iterable[MeshElements]) -> MeshElements:
    """The elements of all parts, each once."""
    parts = [MeshElements.none(), *parts]
    return MeshElements(
        vertices=np.unique(np.concatenate([part.vertices for part in parts])),
        edges=np.unique(np.concatenate([part.edges for part in parts]), axis=0),
        faces=np.unique(np.concatenate([part.faces for part in parts])),
    )


def mesh_size(mesh: bpy.types.Mesh) -> tuple[int, int, int]:
    """Numbers of vertices, edges and faces; where one of them differs, indices mean other elements."""
    return len(mesh.vertices), len(mesh.edges), len(mesh.polygons)


def _elements(region: Region | None, finding: Any) -> MeshElements:
    elements, none = getattr(finding, "elements", None), MeshElements.none()
    if elements is None or not len(elements.indices):
        return none
    indices = np.asarray(elements.indices, np.int32)
    if elements.kind == "faces":
        return MeshElements(none.vertices, none.edges, indices)
    if region is None:
        return none
    if elements.kind == "triangles":
        return MeshElements(none.vertices, none.edges, np.unique(region.triangle_faces[indices]))
    if elements.kind == "edges":
        return MeshElements(none.vertices, region.edges_in_mesh(indices), none.faces)
    return MeshElements(np.flatnonzero(np.isin(region.stitched, region.stitched[indices])), none.edges, none.faces)
