# SPDX-License-Identifier: GPL-3.0-or-later
"""Stitches boundaries that coincide, and closes edges without length: files for display repeat vertices
wherever normals or UVs differ, and the surface is open there without looking so; modelers leave a vertex for each face
at poles."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .base import arguments
from .base.arguments import FloatArray, IndexArray
from .base.counted import counted
from .base.edge_keys import edge_keys
from .base.places import first_at_place, lowest_linked
from .errors import Elements, Finding

# Of the cosine between the normals of faces on both sides: -1 where one is folded onto the other.
_FOLDED = -1 + 1e-6


def stitch_borders(positions: ArrayLike, triangles: ArrayLike) -> IndexArray:
    """The vertices with which boundaries that coincide are one, and edges without length a point:
    `Surface(positions, stitched[triangles], may_collapse=True)`.

    positions: (n, 3). triangles: (m, 3) vertices.
    Returns (n,) int32, for each vertex the one that takes its place, the first of those that become one; itself for
    most. Vertices become one along edges with a triangle on one side only, where exactly two such edges have exactly
    the same ends, in opposite order, unless their triangles are folded onto each other, as the two sides of a leaf are.
    So do the ends of an edge that are at exactly the same place; its triangles name a vertex twice then.
    Raises InputError for arrays that are none of these.
    """
    positions = arguments.float_rows("positions", positions, 3)
    triangles = arguments.index_rows("triangles", triangles, 3)
    arguments.require_indices("triangles", triangles, len(positions))
    return stitched_vertices(positions, triangles.ravel(), np.full(len(triangles), 3))


def stitched_vertices(positions: FloatArray, corners: NDArray[np.integer], sizes: NDArray[np.integer]) -> IndexArray:
    """As `stitch_borders`, of polygons.  corners: (c,) the vertices of all, one after the other. sizes: (f,)."""
    place = first_at_place(positions)
    is_shared = np.bincount(place, minlength=len(place))[place] > 1
    if not is_shared.any():
        return place
    face = np.repeat(np.arange(len(sizes)), sizes)
    following = np.arange(1, len(corners) + 1)
    following[np.cumsum(sizes)[sizes > 0] - 1] = (np.cumsum(sizes) - sizes)[sizes > 0]
    tail, head = corners, corners[following]
    is_point = is_shared[tail] & (place[tail] == place[head])
    points = np.stack([tail[is_point], head[is_point]], axis=1)
    closed = lowest_linked(points, len(positions))
    tail, head = closed[tail], closed[head]
    with_point = np.isin(face, face[is_point])
    is_line = _different(closed, corners[with_point], face[with_point], len(sizes)) < 3
    is_line &= np.bincount(face[with_point], minlength=len(sizes)) > 0
    side = np.flatnonzero((is_shared[tail] | is_shared[head]) & ~is_point & ~is_line[face])
    side = _once(side, edge_keys(tail[side], head[side], len(positions)))
    one, other = _opposite_pairs(side, place[tail[side]], place[head[side]], len(positions))
    normals = _normals(positions, tail, head, face, len(sizes))
    facing = (normals[face[one]] * normals[face[other]]).sum(axis=1)
    is_bridge = face[one] == face[other]  # from the outline of a face to one of its holes, and back
    meets = np.where(is_bridge, facing > 0, facing > _FOLDED)  # a face without area has none
    one, other, is_bridge = one[meets], other[meets], is_bridge[meets]
    pairs = np.stack([np.concatenate([tail[one], head[one]]), np.concatenate([head[other], tail[other]])], axis=1)
    bridged = lowest_linked(np.concatenate([points, pairs[np.tile(is_bridge, 2)]]), len(positions))
    stitched = lowest_linked(np.concatenate([points, pairs]), len(positions))
    # Vertices of faces that would touch themselves elsewhere stay what they are.
    moved = np.isin(face, face[stitched[corners] != bridged[corners]])
    count = [_different(named, corners[moved], face[moved], len(sizes)) for named in (stitched, bridged)]
    kept = np.isin(bridged, bridged[corners[(count[0] < count[1])[face]]])
    stitched[kept] = bridged[kept]
    return _with_lines_on_edges(stitched, place, tail, head, is_line[face])


def at_stitched(stitched: IndexArray, vertices: NDArray[np.integer]) -> NDArray[np.integer]:
    """The vertices that took the place of these, in an array of any shape; what is no vertex stays as it is."""
    out = vertices.copy()
    valid = (vertices >= 0) & (vertices < len(stitched))
    out[valid] = stitched[vertices[valid]]
    return out


def stitched_cones(stitched: IndexArray, cones: IndexArray) -> tuple[IndexArray, NDArray[np.intp]]:
    """Cones at the vertices that took the place of theirs, and their rows: where several became one, the first stays.

    What is no vertex, or listed twice to begin with, stays, to be refused by name.
    """
    new = at_stitched(stitched, cones)
    rows = np.flatnonzero(_is_first(new) | ~_is_first(cones))
    return new[rows], rows


def stitched_finding(stitched: IndexArray) -> list[Finding]:
    """What is told of vertices that took the place of others; nothing where none did."""
    moved = np.flatnonzero(stitched != np.arange(len(stitched))).astype(np.int32)
    if not len(moved):
        return []
    return [
        Finding(
            "BORDERS_STITCHED",
            f"{counted(len(moved), 'vertex repeats another', 'vertices repeat others')} where boundaries lie exactly "
            "on each other or edges have no length. They are one for the computation. Merge by distance to be rid of "
            "this note.",
            Elements("vertices", moved),
        )
    ]


def is_collapsed(triangles: IndexArray) -> NDArray[np.bool_]:
    """(m,) whether each of the triangles (m, 3) names a vertex twice."""
    a, b, c = triangles.T
    return (a == b) | (b == c) | (c == a)


def in_own_faces(corner_uv: FloatArray, triangles: IndexArray, faces: IndexArray) -> FloatArray:
    """Coordinates of triangles that are parts of faces: those that name a vertex twice, which have the coordinates of
    some neighbor, get those of their own face where it is more than a line.

    corner_uv: (m, 3, 2). triangles: (m, 3). faces: (m,) the face of each.
    """
    collapsed = is_collapsed(triangles)
    if not collapsed.any() or collapsed.all():
        return corner_uv
    key = faces[:, None].astype(np.int64) * (int(triangles.max()) + 1) + triangles
    known, first = np.unique(key[~collapsed], return_index=True)
    wanted = key[collapsed]
    at = np.minimum(np.searchsorted(known, wanted), len(known) - 1)
    own = corner_uv[~collapsed].reshape(-1, 2)[first[at]]
    out = corner_uv.copy()
    out[collapsed] = np.where((known[at] == wanted)[..., None], own, corner_uv[collapsed])
    return out


def without_stitched(stitched: IndexArray, warnings: Sequence[Finding]) -> list[Finding]:
    """Warnings on a surface, without the vertices that others took the place of among those that belong to no face."""
    rest = []
    for finding in warnings:
        if finding.code == "ISOLATED_VERTICES":
            vertices = finding.elements.indices
            loose = vertices[stitched[vertices] == vertices]
            if not len(loose):
                continue
            told = f"{counted(len(loose), 'vertex belongs', 'vertices belong')} to no face and got no coordinates."
            finding = replace(finding, message=told, elements=replace(finding.elements, indices=loose))
        rest.append(finding)
    return rest


def _with_lines_on_edges(
    stitched: IndexArray, place: IndexArray, tail: IndexArray, head: IndexArray, on_line: NDArray[np.bool_]
) -> IndexArray:
    """Lays faces of which only a line remains, if they share no vertex with others, on an edge at the same place.

    place: (n,) the first vertex at the place of each. tail, head: (c,) of the sides of faces. on_line: (c,) those of
    lines.
    """
    is_used = np.zeros(len(place), bool)
    is_used[tail[~on_line]] = True
    line = np.flatnonzero(on_line & (place[tail] != place[head]) & ~is_used[tail] & ~is_used[head])
    side = np.flatnonzero(~on_line)
    if not (len(line) and len(side)):
        return stitched
    known, first = np.unique(edge_keys(place[tail[side]], place[head[side]], len(place)), return_index=True)
    key = edge_keys(place[tail[line]], place[head[line]], len(place))
    at = np.minimum(np.searchsorted(known, key), len(known) - 1)
    line, side = line[known[at] == key], side[first[at[known[at] == key]]]
    ends = np.stack([tail[side], head[side]])
    turned = place[ends[0]] != place[tail[line]]
    stitched[tail[line]], stitched[head[line]] = stitched[np.where(turned, ends[::-1], ends)]
    return stitched[stitched]


def _is_first(values: IndexArray) -> NDArray[np.bool_]:
    """Which values are not among those before."""
    first = np.zeros(len(values), bool)
    first[np.unique(values, return_index=True)[1]] = True
    return first


def _once(sides: NDArray[np.intp], keys: NDArray[np.int64]) -> NDArray[np.intp]:
    """Those whose key no other has: edges of one face."""
    _, index, count = np.unique(keys, return_inverse=True, return_counts=True)
    return sides[count[index] == 1]


def _opposite_pairs(
    sides: NDArray[np.intp], tail: IndexArray, head: IndexArray, count: int
) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Sides, and the only other one of each between the same places, which runs from head to tail."""
    _, index, found = np.unique(edge_keys(tail, head, count), return_inverse=True, return_counts=True)
    order = np.argsort(index, kind="stable")
    order = order[found[index[order]] == 2]
    one, other = order[::2], order[1::2]
    opposite = tail[one] == head[other]
    return sides[one[opposite]], sides[other[opposite]]


def _normals(
    positions: FloatArray, tail: NDArray[np.integer], head: NDArray[np.integer], face: NDArray[np.intp], count: int
) -> FloatArray:
    """(f, 3) of length 1; 0 of faces without area."""
    first = np.full(count, -1)
    first[face[::-1]] = tail[::-1]
    origin = positions[first[face]]
    sums = np.zeros((count, 3))
    with np.errstate(invalid="ignore", over="ignore"):  # positions may be anything
        np.add.at(sums, face, np.cross(positions[tail] - origin, positions[head] - origin))
        length = np.linalg.norm(sums, axis=1, keepdims=True)
        return np.divide(sums, length, out=np.zeros_like(sums), where=length > 0)


def _different(
    named: IndexArray, corners: NDArray[np.integer], face: NDArray[np.intp], count: int
) -> NDArray[np.integer]:
    """(f,) how many different vertices faces have.  named: (n,) the one that stands for each. face: (c,) of corners."""
    return np.bincount(np.unique(face * len(named) + named[corners]) // len(named), minlength=count)
