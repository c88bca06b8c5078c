# SPDX-License-Identifier: GPL-3.0-or-later
"""Straight walks over a map that go on across its cuts, by unfolding one triangle after the other.

Both copies of an edge determine one similarity of the plane; across cuts of our maps it is the cut's transition, a turn
and a shift (Vintescu et al. 2017, eq. 1), and inside islands the identity. A walk is moved by those of its edges.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..base.arguments import IndexArray
from ..base.progress import Steps
from ..base.unique_rows import unique_rows
from .texel_raster import ON_EDGE, ComplexArray, Indices, cross, edge_distances, has_area

# Walks over more triangles are given up; they happen only where triangles are far smaller than texels.
_MOST_STEPS = 1000
# So many walks at once are told of often enough, and take little memory.
_AT_ONCE = 1 << 17
# In pixels: copies of an edge that are this near to each other are no cut.
_SAME = 1e-6


@dataclass(frozen=True, eq=False)
class Seams:
    """How a map goes on across edges. Edge 3 t + c of triangle t is from its corner c to the next.

    corners: (m, 3), places. partner: (3m,), the same edge in the other triangle, -1 where the map ends. turn, shift:
    (3m,), beyond an edge the place z is turn z + shift. is_border: (3m,), whether islands end there.
    """

    corners: ComplexArray
    partner: Indices
    turn: ComplexArray
    shift: ComplexArray
    is_border: NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class Walked:
    """Ends of walks. arrived: (k,), whether they ended in a triangle. place: (k,), there. turn: (k,), all turns of the
    way, of length 1."""

    arrived: NDArray[np.bool_]
    place: ComplexArray
    turn: ComplexArray


def find_seams(triangles: IndexArray, corners: ComplexArray) -> Seams:
    """The seams of a map.  triangles: (m, 3). corners: (m, 3), places; not finite or without area: not mapped."""
    mapped = has_area(corners)
    start, end = corners.ravel(), corners[:, [1, 2, 0]].ravel()
    partner = _partners(triangles, mapped, _orientation(corners))
    other = np.maximum(partner, 0)
    # The partner runs the other way.
    with np.errstate(divide="ignore", invalid="ignore"):
        turn = (start[other] - end[other]) / (end - start)
        shift = end[other] - turn * start
    partner[~(np.isfinite(turn) & (turn != 0))] = -1
    apart = (np.abs(end[other] - start) > _SAME) | (np.abs(start[other] - end) > _SAME)
    return Seams(corners, partner, turn, shift, np.repeat(mapped, 3) & ((partner < 0) | apart))


def walk(seams: Seams, edge: Indices, start: ComplexArray, goal: ComplexArray, steps: Steps) -> Walked:
    """Walk from places on edges across these and straight on to goals.  All (k,). steps: told of.  Raises Cancelled."""
    begins = range(0, max(len(edge), 1), _AT_ONCE)
    some = [slice(begin, begin + _AT_ONCE) for begin in begins]
    walked = [_walk_at_once(seams, edge[of], start[of], goal[of], steps) for of in some]
    return Walked(
        np.concatenate([of.arrived for of in walked]),
        np.concatenate([of.place for of in walked]),
        np.concatenate([of.turn for of in walked]),
    )


def _walk_at_once(seams: Seams, edge: Indices, start: ComplexArray, goal: ComplexArray, steps: Steps) -> Walked:
    place, begin = goal.copy(), start.copy()
    turn, arrived = np.ones(len(edge), complex), np.zeros(len(edge), bool)
    edge, active = edge.copy(), np.arange(len(edge))
    for _ in range(_MOST_STEPS):
        steps.tell()
        active = active[seams.partner[edge[active]] >= 0]
        if not len(active):
            break
        crossed = edge[active]
        factor, shift = seams.turn[crossed], seams.shift[crossed]
        place[active] = factor * place[active] + shift
        begin[active] = factor * begin[active] + shift
        turn[active] *= factor / np.abs(factor)
        leaves, way_out = _way_out(seams, seams.partner[crossed], begin[active], place[active])
        arrived[active[~leaves]] = True
        edge[active] = way_out
        active = active[leaves]
    return Walked(arrived, place, turn)


def _way_out(
    seams: Seams, entered: Indices, begin: ComplexArray, place: ComplexArray
) -> tuple[NDArray[np.bool_], Indices]:
    """Whether straight ways leave the triangles that they entered by these edges, and by which edge."""
    triangle, rows = entered // 3, np.arange(len(entered))
    corners = seams.corners[triangle]
    inside = edge_distances(corners, place)
    outside = inside < -ON_EDGE
    outside[rows, entered % 3] = False
    from_start = np.maximum(edge_distances(corners, begin), 0.0)
    share = np.where(outside, from_start / np.where(outside, from_start - inside, 1.0), np.inf)
    return outside.any(axis=1), 3 * triangle + np.argmin(share, axis=1)


def _orientation(corners: ComplexArray) -> NDArray[np.float64]:
    return np.sign(cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))


def _partners(triangles: IndexArray, mapped: NDArray[np.bool_], orientation: NDArray[np.float64]) -> Indices:
    """(3m,), the same edge in the other triangle; -1 where there is none, more than one, or a mirrored one."""
    first, second = triangles.ravel().astype(np.int64), triangles[:, [1, 2, 0]].ravel().astype(np.int64)
    edges = np.flatnonzero(np.repeat(mapped, 3))
    pair = np.sort(np.stack([first, second], axis=1)[edges], axis=1)
    _, _, group, sizes = unique_rows(pair)
    order = np.argsort(group, kind="stable")
    order = edges[order[sizes[group[order]] == 2]].reshape(-1, 2)
    same_side = orientation[order[:, 0] // 3] == orientation[order[:, 1] // 3]
    one, other = order[same_side & (first[order[:, 0]] == second[order[:, 1]])].T
    partner = np.full(len(first), -1, np.int64)
    partner[one], partner[other] = other, one
    return partner
