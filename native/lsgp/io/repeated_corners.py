# SPDX-License-Identifier: GPL-3.0-or-later
"""Faces that name a vertex twice or have fewer than three corners: usable ones are simplified and the others left out,
instead of refusing the file. A face with holes, which edges to and fro join to its outline, is usable as it is."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..base.counted import counted
from ..errors import Elements, Finding, InputError
from .polygons import PolygonMesh, Triangulation

_NONE = np.empty(0, np.int32)
# Of a triangle's area to that of its face.
ROUNDING = 1e-12


@dataclass(frozen=True)
class Places:
    """Where the parts of a mesh are in the whole of it.

    corner, polygon: the index of each. repeats: (r, 2) int64, corners of the whole mesh that were left out of a face,
    and those that they repeat.
    """

    corner: NDArray[np.int64]
    polygon: NDArray[np.int32]
    repeats: NDArray[np.int64]


@dataclass(frozen=True)
class Usable:
    """The part of a mesh that has no repeated corners. places: None where that is all of it. findings: what was left
    out."""

    mesh: PolygonMesh
    places: Places | None = None
    findings: tuple[Finding, ...] = ()

    def places_of(self, polygons: NDArray[np.intp]) -> NDArray[np.int32]:
        """Polygons of the part as they are numbered in the whole mesh."""
        return polygons.astype(np.int32) if self.places is None else self.places.polygon[polygons]

    def in_whole_mesh(self, triangulation: Triangulation) -> Triangulation:
        """A triangulation of the part with the indices of the whole mesh."""
        if self.places is None:
            return triangulation
        return replace(
            triangulation,
            polygon=self.places.polygon[triangulation.polygon],
            corner=self.places.corner[triangulation.corner],
            repeats=self.places.repeats,
        )


def without_repeated_corners(mesh: PolygonMesh, others: NDArray[np.int32] = _NONE) -> Usable:
    """Of corners that name the vertex of the one before the first stays; a face that has less than three then is left
    out.

    others: faces that are left out as well.  Raises InputError: BAD_FACE where no face is left.
    """
    owner = np.repeat(np.arange(len(mesh.sizes)), mesh.sizes)
    follows = np.arange(-1, len(mesh.corners) - 1)
    follows[mesh.starts] = mesh.starts + mesh.sizes - 1
    is_repeat = mesh.corners == mesh.corners[follows]
    sizes = np.bincount(owner[~is_repeat], minlength=len(mesh.sizes))
    left_out = sizes < 3
    left_out[others] = True
    if not (is_repeat.any() or left_out.any()):
        return Usable(mesh)

    if left_out.all():
        raise InputError(
            "BAD_FACE",
            f"All {len(left_out)} faces name a vertex twice or are edges. Merge doubled vertices and delete faces "
            "without area.",
            Elements("faces", np.flatnonzero(left_out).astype(np.int32)),
        )
    corner = np.flatnonzero(~is_repeat & ~left_out[owner])
    polygon = np.flatnonzero(~left_out).astype(np.int32)
    corner_uv = None if mesh.corner_uv is None else mesh.corner_uv[corner]
    part = PolygonMesh(mesh.positions, mesh.corners[corner], sizes[polygon], corner_uv)
    repeats = np.flatnonzero(is_repeat & ~left_out[owner])
    # The corner that stayed is the last one before that is no repeat; before the face's first comes its last.
    latest = np.maximum.accumulate(np.where(is_repeat, -1, np.arange(len(is_repeat))))
    stayed, face = latest[repeats], owner[repeats]
    stayed = np.where(stayed < mesh.starts[face], latest[(mesh.starts + mesh.sizes - 1)[face]], stayed)
    places = Places(corner, polygon, np.stack([repeats, stayed], axis=1))
    return Usable(part, places, _findings(owner, repeats, left_out))


def not_covered(mesh: PolygonMesh, triangulation: Triangulation) -> NDArray[np.intp]:
    """The polygons that name a vertex twice and are no region with its holes joined to its outline, each by an edge to
    and from it: some of their triangles name a vertex twice or face the other way, or a corner is in none."""
    touching = _touching_themselves(mesh)
    if not len(touching):
        return touching
    mine = np.flatnonzero(np.isin(triangulation.polygon, touching))
    polygon, vertices = triangulation.polygon[mine], triangulation.triangles[mine]
    a, b, c = mesh.positions[vertices].transpose(1, 0, 2)
    with np.errstate(all="ignore"):  # coordinates that overflow are refused by the library, by name
        normal = np.cross(b - a, c - a)
        whole = np.zeros((len(mesh.sizes), 3))
        np.add.at(whole, polygon, normal)
        toward = (normal * whole[polygon]).sum(axis=1)
        covers = toward >= -ROUNDING * (whole[polygon] ** 2).sum(axis=1)
    covers &= (vertices != np.roll(vertices, 1, axis=1)).all(axis=1) & whole[polygon].any(axis=1)
    owner = np.repeat(np.arange(len(mesh.sizes)), mesh.sizes)
    is_used = np.zeros(len(mesh.corners), bool)
    is_used[triangulation.corner[mine]] = True
    incomplete = np.intersect1d(touching, owner[~is_used])
    return np.union1d(polygon[~covers], incomplete)


def _touching_themselves(mesh: PolygonMesh) -> NDArray[np.intp]:
    """The polygons that name a vertex at two corners."""
    owner = np.repeat(np.arange(len(mesh.sizes)), mesh.sizes)
    corners = np.flatnonzero((mesh.sizes > 3)[owner])
    order = corners[np.lexsort((mesh.corners[corners], owner[corners]))]
    again = (np.diff(mesh.corners[order]) == 0) & (np.diff(owner[order]) == 0)
    return np.unique(owner[order][1:][again])


def _findings(owner: NDArray[np.int64], repeats: NDArray[np.int64], left_out: NDArray[np.bool_]) -> tuple[Finding, ...]:
    findings = []
    shortened = np.unique(owner[repeats]).astype(np.int32)
    if len(shortened):
        findings.append(
            Finding(
                "REPEATED_CORNERS",
                f"{counted(len(shortened), 'face names', 'faces name')} a vertex twice in a row; this was ignored.",
                Elements("faces", shortened),
            )
        )
    faces = np.flatnonzero(left_out).astype(np.int32)
    if len(faces):
        findings.append(
            Finding(
                "FACES_LEFT_OUT",
                f"{counted(len(faces), 'face was', 'faces were')} left out and got no texture coordinates: there are "
                "fewer than three vertices, or one is named twice and the face is no region with holes. Delete such "
                "faces.",
                Elements("faces", faces),
            )
        )
    return tuple(findings)
