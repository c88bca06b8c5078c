# SPDX-License-Identifier: GPL-3.0-or-later
"""Faces that have no coordinates in a result, and how much of the area they are."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..io.mesh_files import MeshFile

# The area of a face, relative to that of the box around it, below which it is a line: rounding of coordinates alone.
_NO_AREA = 1e-14


@dataclass(frozen=True, slots=True)
class MissingFaces:
    """Faces without coordinates.

    faces: (f,) int32, those that could have some. area_percent: theirs, of the area of all faces.
    impossible: (g,) int32, those that cannot, as they have no area or no triangles. impossible_area_percent: theirs.
    """

    faces: NDArray[np.int32]
    area_percent: float
    impossible: NDArray[np.int32]
    impossible_area_percent: float


def missing_faces(file: MeshFile, solved: NDArray[np.bool_]) -> MissingFaces | None:
    """None where all faces have coordinates.  solved: (m,), the triangles that have."""
    triangulation, count = file.triangulation, len(file.mesh.sizes)
    has_triangles = np.zeros(count, bool)
    has_triangles[triangulation.polygon] = True
    is_missing = ~has_triangles
    is_missing[triangulation.polygon[~solved]] = True
    if not is_missing.any():
        return None
    return _of_sizes(is_missing, has_triangles, *_areas(file))


def missing_of_triangles(
    corners: NDArray[np.float64], face: NDArray[np.integer], solved: NDArray[np.bool_]
) -> MissingFaces | None:
    """As `missing_faces`, of faces that all have triangles.

    corners: (m, 3, 3), where these are. face: (m,), from 0 without gaps.  solved: (m,).
    """
    count = int(face.max(initial=-1)) + 1
    is_missing = np.zeros(count, bool)
    is_missing[face[~solved]] = True
    if not is_missing.any():
        return None
    first = np.zeros((count, 3))
    first[face[::-1]] = corners[::-1, 0]
    extents = np.zeros(count)
    np.maximum.at(extents, face, np.abs(corners - first[face][:, None]).max(axis=(1, 2)))
    return _of_sizes(is_missing, np.ones(count, bool), _sums_of_areas(corners, face, count), extents**2)


def _of_sizes(
    is_missing: NDArray[np.bool_],
    has_triangles: NDArray[np.bool_],
    areas: NDArray[np.float64],
    boxes: NDArray[np.float64],
) -> MissingFaces:
    impossible = is_missing & (~has_triangles | (areas <= _NO_AREA * boxes))
    possible = is_missing & ~impossible
    whole = areas.sum()
    percent = [float(100 * areas[which].sum() / whole) if whole > 0 else 0.0 for which in (possible, impossible)]
    return MissingFaces(
        np.flatnonzero(possible).astype(np.int32), percent[0], np.flatnonzero(impossible).astype(np.int32), percent[1]
    )


def _areas(file: MeshFile) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """(f,) each: the areas of the faces, by triangles or, where they have none, as closed curves, and the squares of
    their extents; in a common unit."""
    mesh, triangulation = file.mesh, file.triangulation
    corners = mesh.positions[mesh.corners]
    corners = corners - corners.min(axis=0)
    corners /= np.abs(corners).max() or 1.0
    polygon = np.repeat(np.arange(len(mesh.sizes)), mesh.sizes)
    following = np.arange(1, len(corners) + 1)
    following[mesh.starts + mesh.sizes - 1] = mesh.starts
    from_first = corners - corners[mesh.starts][polygon]
    curve = np.zeros((len(mesh.sizes), 3))
    np.add.at(curve, polygon, np.cross(from_first, from_first[following]))
    areas = 0.5 * np.linalg.norm(curve, axis=1)
    extents = np.zeros(len(mesh.sizes))
    np.maximum.at(extents, polygon, np.abs(from_first).max(axis=1))
    of_triangles = _sums_of_areas(corners[triangulation.corner], triangulation.polygon, len(areas))
    has_triangles = np.zeros(len(areas), bool)
    has_triangles[triangulation.polygon] = True
    return np.where(has_triangles, of_triangles, areas), extents**2


def _sums_of_areas(corners: NDArray[np.float64], face: NDArray[np.integer], count: int) -> NDArray[np.float64]:
    """(count,), of the triangles of each face.  corners: (m, 3, 3). face: (m,)."""
    a, b, c = corners.transpose(1, 0, 2)
    return np.bincount(face, 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1), count)
