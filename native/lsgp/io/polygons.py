# SPDX-License-Identifier: GPL-3.0-or-later
"""Polygon meshes as files hold them, and their triangles as the library wants them."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from .. import _lsgp
from ..base.ear_clipping import clip_ears
from ..base.edge_keys import edge_keys
from ..base.equality import EqualByContent
from ..base.short_repr import ShortRepr
from ..errors import Elements, InputError
from .mesh_text import ranges

# The corners of the triangles of a quad.
ON_FIRST_DIAGONAL = np.array([[0, 1, 2], [0, 2, 3]])
ON_SECOND_DIAGONAL = np.array([[0, 1, 3], [1, 2, 3]])

# Rounding of a polygon's area where it has the size of 1.
ROUNDING = 1e-14

# Polygon corners worked on at once: bounds the memory of the triangulation.
CHUNK = 1 << 19


@dataclass(frozen=True, eq=False, repr=False)
class PolygonMesh(EqualByContent, ShortRepr):
    """Vertices and polygons of a file, in its order.

    positions: (n, 3) float64. corners: (c,) int32, the vertices of all polygons one after the other.
    sizes: (f,) int64, the number of corners of each polygon.
    corner_uv: (c, 2) float64, NaN at corners without texture coordinates; None where the file was not asked for them.
    extras: what else the file has, in its own words.
    named: the names of other files that belong to it, as they stand there.
    """

    positions: NDArray[np.float64]
    corners: NDArray[np.int32]
    sizes: NDArray[np.int64]
    corner_uv: NDArray[np.float64] | None = None
    extras: tuple[str, ...] = ()
    named: tuple[str, ...] = ()

    @property
    def starts(self) -> NDArray[np.int64]:
        """(f,) int64, where in `corners` each polygon begins."""
        return np.cumsum(self.sizes) - self.sizes


@dataclass(frozen=True, eq=False, repr=False)
class Triangulation(EqualByContent, ShortRepr):
    """Triangles of a polygon mesh; those of one polygon stand together, polygons in their order.

    triangles: (m, 3) int32 vertices, turning the way of their polygon. polygon: (m,) int32.
    corner: (m, 3) int64, the polygon corner (index into `PolygonMesh.corners`) that each triangle corner is.
    edges: (e, 2) int32, the edges of the polygons, each once, the smaller vertex first; diagonals are not among them.
    repeats: (r, 2) int64, polygon corners that were left out, as they repeat a vertex, and the ones they repeat.
    """

    triangles: NDArray[np.int32]
    polygon: NDArray[np.int32]
    corner: NDArray[np.int64]
    edges: NDArray[np.int32]
    repeats: NDArray[np.int64] = field(default_factory=lambda: np.empty((0, 2), np.int64))

    def to_polygon_corners(self, triangle_values: NDArray[np.float64], corner_count: int) -> NDArray[np.float64]:
        """Values at triangle corners, (m, 3, d), brought to polygon corners, (c, d); NaN at all corners of a polygon
        any triangle of which has a NaN."""
        values = np.full((corner_count, triangle_values.shape[-1]), np.nan)
        values[self.corner] = triangle_values
        missing = np.isnan(triangle_values).any(axis=(1, 2))
        if missing.any():
            values[self.corner[np.isin(self.polygon, self.polygon[missing])]] = np.nan
        values[self.repeats[:, 0]] = values[self.repeats[:, 1]]
        return values

    def at_vertices(self, named: NDArray[np.int32]) -> Triangulation:
        """The same with other vertices, without edges between equal ones.  named: (n,) the one that stands for each."""
        if np.array_equal(named, np.arange(len(named))):
            return self
        edges = np.sort(named[self.edges], axis=1)
        edges = edges[edges[:, 0] != edges[:, 1]]
        _, first = np.unique(edge_keys(*edges.T, len(named)), return_index=True)
        return replace(self, triangles=named[self.triangles], edges=edges[first])

    def polygons_of(self, triangles: NDArray[np.int32]) -> NDArray[np.int32]:
        """The polygons that given triangles belong to, ascending, each once."""
        return np.unique(self.polygon[triangles])


def require_polygons(
    vertex_count: int,
    corners: NDArray[np.int64],
    sizes: NDArray[np.int64],
    place: Callable[[int], str] = lambda polygon: "",
) -> None:
    """Refuse polygons that name vertices the file has not or have no corners, and meshes without any of three corners.

    place: says where in the file a polygon stands, for the message, e.g. " (line 12)".
    Raises InputError: INDEX_OUT_OF_RANGE, BAD_FACE, with the polygons as elements of kind "faces".
    """
    polygon_of_corner = np.repeat(np.arange(len(sizes)), sizes)
    outside = (corners < 0) | (corners >= vertex_count)
    if outside.any():
        faces = np.unique(polygon_of_corner[outside])
        valid = f"valid are 0 to {vertex_count - 1}" if vertex_count else "the file has no vertices"
        raise InputError(
            "INDEX_OUT_OF_RANGE",
            f"{_faces(faces, place)} with a vertex index that is not in the file: {corners[outside][0]}, counted from "
            f"0; {valid}. Export the mesh again.",
            Elements("faces", faces.astype(np.int32)),
        )
    empty = np.flatnonzero(sizes == 0)
    if len(empty):
        raise InputError(
            "BAD_FACE",
            f"{_faces(empty, place)} without corners. Export the mesh again.",
            Elements("faces", empty.astype(np.int32)),
        )
    small = np.flatnonzero(sizes < 3)
    if len(small) and len(small) == len(sizes):
        raise InputError(
            "BAD_FACE",
            f"{_faces(small, place)} with fewer than three corners. Remove such faces: loose edges are not faces.",
            Elements("faces", small.astype(np.int32)),
        )


def triangulate(mesh: PolygonMesh) -> Triangulation:
    """Cut polygons into triangles that turn the way their polygon does.

    Triangles pass as they are. Quads get a diagonal on both sides of which the triangles agree with the polygon's
    normal (Newell's), the shorter one where both do. Larger polygons lose ear after ear in the plane of that normal,
    the one with the shortest diagonal first, so that concave ones come out right; what is left of a degenerate polygon
    becomes a fan. No diagonal doubles an edge or another diagonal where that can be avoided: it would join more than
    two triangles.

    mesh: one that `require_polygons` accepts, without repeated corners. Coordinates may be anything, also not finite.
    """
    counts = mesh.sizes - 2
    firsts = np.cumsum(counts) - counts
    corner = np.empty((int(counts.sum()), 3), np.int64)
    with np.errstate(all="ignore"):  # coordinates that overflow are refused by the library, by name
        for polygons, rows in _equal_polygons(mesh):
            size = rows.shape[1]
            if size == 3:
                local = np.broadcast_to(np.arange(3), (len(rows), 1, 3))
            elif size == 4:
                on_first = _lsgp.quad_diagonals(mesh.positions, mesh.corners[rows])
                local = np.where(on_first[:, None, None], ON_FIRST_DIAGONAL, ON_SECOND_DIAGONAL)
            else:
                local = clip_ears(_in_plane(mesh.positions[mesh.corners[rows]]))
            target = firsts[polygons][:, None] + np.arange(size - 2)
            corner[target] = rows[np.arange(len(rows))[:, None, None], local]
        edges = _polygon_edges(mesh)
        separate_diagonals(mesh, corner, edges)
    return Triangulation(
        triangles=mesh.corners[corner],
        polygon=np.repeat(np.arange(len(mesh.sizes), dtype=np.int32), counts),
        corner=corner,
        edges=edges,
    )


def separate_diagonals(mesh: PolygonMesh, corner: NDArray[np.int64], edges: NDArray[np.int32]) -> None:
    """Triangulate anew, in `corner`, the polygons with a diagonal between vertices that an edge or another polygon's
    diagonal joins already (two quads back to back, for example). A polygon that is given again stays
    alike: its triangles are duplicates, which get the coordinates of the first.

    corner: (m, 3), as in `Triangulation`; of every polygon two triangles less than it has corners. edges: (e, 2).
    """
    if (mesh.sizes == 3).all():
        return
    n = len(mesh.positions)
    redo = _lsgp.doubled_diagonals(corner, mesh.corners, mesh.sizes, edges, n)
    if not len(redo):
        return
    counts = mesh.sizes - 2
    firsts = np.cumsum(counts) - counts
    following = np.roll(corner, -1, axis=1)
    step = following - corner
    diagonal = (step > 1) & (step < np.repeat(mesh.sizes, counts)[:, None] - 1)
    keys = edge_keys(mesh.corners[corner[diagonal]], mesh.corners[following[diagonal]], n)
    of_edges = edge_keys(edges[:, 0], edges[:, 1], n)
    polygon = np.repeat(np.arange(len(mesh.sizes)), counts)
    owner = np.broadcast_to(polygon[:, None], corner.shape)[diagonal]
    # Only edges and diagonals between vertices of these polygons can be in their way.
    near = np.zeros(n, bool)
    near[mesh.corners[ranges(mesh.starts[redo], mesh.sizes[redo])]] = True
    joined = np.concatenate([of_edges, keys[~np.isin(owner, redo)]])
    joined = set(joined[near[joined // n] & near[joined % n]].tolist())
    starts = mesh.starts
    first_alike: dict[tuple[int, ...], list[list[int]]] = {}  # its triangles
    for chosen in redo.tolist():
        count = int(mesh.sizes[chosen])
        row = starts[chosen] + np.arange(count)
        own = mesh.corners[row].tolist()
        least = own.index(min(own))
        alike = (*own[least:], *own[:least])
        if alike in first_alike:
            local = [sorted(own.index(vertex) for vertex in triangle) for triangle in first_alike[alike]]
            corner[firsts[chosen] : firsts[chosen] + count - 2] = row[np.array(local)]
            continue

        def is_taken(p: int, q: int, own: list[int] = own) -> bool:
            a, b = own[p], own[q]
            return (a * n + b if a < b else b * n + a) in joined

        (local,) = clip_ears(_in_plane(mesh.positions[mesh.corners[row]][None]), is_taken)
        corner[firsts[chosen] : firsts[chosen] + count - 2] = row[local]
        vertices = mesh.corners[row[local]]
        first_alike[alike] = vertices.tolist()
        joined.update(edge_keys(vertices, np.roll(vertices, -1, axis=1), n).ravel().tolist())


def _faces(faces: NDArray[np.int64], place: Callable[[int], str]) -> str:
    """The subject of a refusal: how many faces, and the first of them with its place."""
    if len(faces) == 1:
        return f"Face {faces[0]}{place(int(faces[0]))}"
    return f"{len(faces)} faces, first face {faces[0]}{place(int(faces[0]))},"


def _equal_polygons(mesh: PolygonMesh) -> Iterator[tuple[NDArray[np.int64], NDArray[np.int64]]]:
    """Polygons of equal size together: their indices (k,) and their corners (k, size), indices into `corners`."""
    order = np.argsort(mesh.sizes, kind="stable")
    sizes, begins = np.unique(mesh.sizes[order], return_index=True)
    starts = mesh.starts
    ends = np.append(begins, len(order))[1:]
    for size, begin, end in np.stack([sizes, begins, ends], axis=1).tolist():
        for chunk in range(begin, end, max(1, CHUNK // size)):
            polygons = order[chunk : min(end, chunk + max(1, CHUNK // size))]
            yield polygons, starts[polygons][:, None] + np.arange(size)


def _unit_size(points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Polygons (k, n, 3) moved to the origin and scaled to 1, so that no product of coordinates over- or underflows."""
    points = points - points[:, :1]
    extent = np.abs(points).max(axis=(1, 2), keepdims=True)
    return points / np.where(extent > 0, extent, 1.0)


def _in_plane(points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Polygons (k, n, 3) seen along Newell's normal, (k, n, 2): counter-clockwise, of the size of 1."""
    points = _unit_size(points)
    normal = np.cross(points, np.roll(points, -1, axis=1)).sum(axis=1)
    length = np.linalg.norm(normal, axis=1, keepdims=True)
    normal = np.where(length > ROUNDING, normal / np.where(length > 0, length, 1.0), 0.0)
    helper = np.eye(3)[np.abs(normal).argmin(axis=1)]
    first = np.cross(helper, normal)
    norm = np.linalg.norm(first, axis=1, keepdims=True)
    first = first / np.where(norm > 0, norm, 1.0)
    second = np.cross(normal, first)
    return np.stack([_dot(points, first[:, None]), _dot(points, second[:, None])], axis=2)


def _polygon_edges(mesh: PolygonMesh) -> NDArray[np.int32]:
    """Every polygon edge once, the smaller vertex first, in order."""
    return _lsgp.polygon_edges(mesh.corners, mesh.sizes, len(mesh.positions))


def _dot(a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
    return (a * b).sum(axis=-1)
