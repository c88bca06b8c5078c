# SPDX-License-Identifier: GPL-3.0-or-later
"""Islands of finished maps turned, aligned and joined, each moved as a whole."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..base import arguments
from ..base.arguments import FloatArray, IndexArray
from ..base.equality import EqualByContent
from ..base.places import lowest_linked
from ..base.short_repr import ShortRepr
from ..base.unique_rows import unique_rows
from ..edge_directions import sides_of_edges
from ..lattice import island_boxes
from ..surface import Surface, require_vertices
from ..triangles import uv_areas

Side = Literal["left", "right", "bottom", "top", "center", "middle"]

# Of an island's area: below this, upward directions cancel out.
_NO_DIRECTION = 0.02
# Relative to the length of a joint: what rounding to single precision leaves of a match, and what is seen.
_MATCH = 1e-4
_FIRST_AXES = np.eye(3)[[2, 1, 0]]
"""What is up where a direction is across the island: z, or else y, or else x."""


def upright_turns(surface: Surface, corner_uv: ArrayLike, island: ArrayLike, up: ArrayLike) -> FloatArray:
    """The turn of each island, (islands,) in radians, after which v runs along a direction in space on the average.

    corner_uv: (m, 3, 2). island: (m,), -1 for none. up: (3,); islands that it is across, as the upper side of a table,
    are turned by z, or else y, or else x. 0 where all of them are across it, as of a closed surface.  Raises
    InputError.
    """
    require_vertices(surface)
    uv, island, count = numbered_islands(corner_uv, island)
    if len(island) != len(surface.triangles):
        arguments.refuse("island", len(island), "pass a number for each triangle")
    axis = require_up(up)
    inside = island >= 0
    turns = np.zeros(count)
    open_ones = np.ones(count, bool)
    places, of = surface.positions[surface.triangles[inside]], island[inside]
    area = np.linalg.norm(np.cross(places[:, 1] - places[:, 0], places[:, 2] - places[:, 0]), axis=1)
    total = np.bincount(of, area, minlength=count)
    for direction in (axis / math.hypot(*axis), *_FIRST_AXES):
        image = _image_of(direction, places, uv[inside])
        sums = np.bincount(of, area * image.real, minlength=count) + 1j * np.bincount(
            of, area * image.imag, minlength=count
        )
        found = open_ones & (abs(sums) > _NO_DIRECTION * total)
        turns[found] = [math.pi / 2 - math.atan2(z.imag, z.real) for z in sums[found].tolist()]
        open_ones &= ~found
    return (turns + math.pi) % (2 * math.pi) - math.pi


def require_up(up: ArrayLike) -> FloatArray:
    """Raises InputError."""
    axis = arguments.floats_of_shape("up", up, (3,))
    if not (np.isfinite(axis).all() and axis.any()):
        arguments.refuse("up", up, "pass finite numbers that are not all 0")
    return axis


def _image_of(direction: FloatArray, places: FloatArray, uv: FloatArray) -> NDArray[np.complex128]:
    """(k,) where the part of a direction in each triangle's plane points in the map, as long as that part."""
    first, second = places[:, 1] - places[:, 0], places[:, 2] - places[:, 0]
    aa, bb, ab = (first**2).sum(1), (second**2).sum(1), (first * second).sum(1)
    da, db = first @ direction, second @ direction
    determinant = aa * bb - ab**2
    valid = determinant > 0
    scale = np.where(valid, 1 / np.where(valid, determinant, 1.0), 0.0)
    x, y = scale * (bb * da - ab * db), scale * (aa * db - ab * da)
    length = np.sqrt(np.maximum(x * da + y * db, 0.0))
    mapped = x[:, None] * (uv[:, 1] - uv[:, 0]) + y[:, None] * (uv[:, 2] - uv[:, 0])
    image = mapped[:, 0] + 1j * mapped[:, 1]
    size = abs(image)
    return np.where(size > 0, image * length / np.where(size > 0, size, 1.0), 0.0)


def turn_islands(corner_uv: ArrayLike, island: ArrayLike, turns: ArrayLike) -> FloatArray:
    """Turn each island about the middle of its box; returns (m, 3, 2).

    corner_uv: (m, 3, 2). island: (m,), -1 for none. turns: (islands,) radians; quarter turns are exact.  Raises
    InputError.
    """
    uv, island, count = numbered_islands(corner_uv, island)
    angles = arguments.floats_of_shape("turns", turns, (count,))
    if not np.isfinite(angles).all():
        arguments.refuse("turns", turns, "pass finite angles")
    boxes = island_boxes(uv, island)
    middle = (boxes[:, :2] + boxes[:, 2:]) / 2
    cosine, sine = np.array([_cosine_and_sine(angle) for angle in angles.tolist()]).reshape(-1, 2).T
    out, inside = uv.copy(), island >= 0
    of = island[inside]
    away = uv[inside] - middle[of, None]
    c, s = cosine[of, None], sine[of, None]
    turned = np.stack([c * away[..., 0] - s * away[..., 1], s * away[..., 0] + c * away[..., 1]], axis=-1)
    out[inside] = np.where((angles[of] == 0)[:, None, None], uv[inside], middle[of, None] + turned)
    return out


def _cosine_and_sine(angle: float) -> tuple[float, float]:
    quarters = round(angle / (math.pi / 2))
    if abs(angle - quarters * math.pi / 2) < 1e-12:
        return ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0))[quarters % 4]
    return math.cos(angle), math.sin(angle)


def align_islands(boxes: ArrayLike, side: Side, *, fixed: ArrayLike | None = None) -> FloatArray:
    """The moves of islands, (k, 2), after which one side of all boxes, or their middles, lie on one line.

    boxes: (k, 4), the least u and v and the largest u and v of each, as of `lattice.island_boxes`. side: "left",
    "right", "bottom", "top"; "center": their middles one above the other; "middle": side by side. fixed: (k,) bool, the
    islands that stay, by whose boxes the line is chosen; None: it is that of all boxes.  Raises InputError.
    """
    arguments.require_choice("side", side, get_args(Side))
    rows = arguments.float_rows("boxes", boxes, 4)
    stays = np.zeros(len(rows), bool) if fixed is None else arguments.flags("fixed", fixed, len(rows))
    moves = np.zeros((len(rows), 2))
    if not len(rows):
        return moves
    of = rows[stays] if stays.any() else rows
    low, high = of[:, :2].min(axis=0), of[:, 2:].max(axis=0)
    axis = 0 if side in ("left", "right", "center") else 1
    at = {"left": 0.0, "bottom": 0.0, "right": 1.0, "top": 1.0}.get(side, 0.5)
    line = (1 - at) * low[axis] + at * high[axis]
    moves[:, axis] = line - ((1 - at) * rows[:, axis] + at * rows[:, 2 + axis])
    moves[stays] = 0.0
    return moves


@dataclass(frozen=True, eq=False, repr=False)
class StitchedMap(EqualByContent, ShortRepr):
    """A map of which some islands were joined.

    corner_uv: (m, 3, 2) float64. moved: (m,) bool, the triangles with other coordinates. joined: how many islands were
    moved onto others. inexact: of them those whose sides did not match by a rotation and a translation: they were
    scaled, or the vertices between them moved. within: (e,) bool, the edges that were not joined as both sides belong
    to one island already.  pinned: those between islands that are both fixed.
    """

    corner_uv: FloatArray
    moved: NDArray[np.bool_]
    joined: int
    inexact: int
    within: NDArray[np.bool_]
    pinned: NDArray[np.bool_]


@dataclass
class _Joint:
    """A path of edges between two islands: their rows, and corners of both ends on the side of each island."""

    rows: NDArray[np.intp]
    first: NDArray[np.intp]
    second: NDArray[np.intp]


def stitch_islands(
    surface: Surface, corner_uv: ArrayLike, island: ArrayLike, edges: ArrayLike, *, fixed: ArrayLike = ()
) -> StitchedMap:
    """Join the islands on both sides of cut edges, the longest joint first: of two the one with less area in the map
    moves.

    corner_uv: (m, 3, 2). island: (m,), -1 for none. edges: (e, 2) vertices; those that are not cut, or borders, count
    for nothing. fixed: islands that do not move. Where both sides match by a rotation and a translation, islands keep
    their shape; otherwise they are moved and scaled as fits best, and the vertices on the edges put together.  Raises
    InputError: EDGE_NOT_IN_MESH.
    """
    require_vertices(surface)
    uv, island, count = numbered_islands(corner_uv, island)
    pairs = arguments.index_rows("edges", edges, 2)
    arguments.require_indices("edges", pairs, len(surface.positions))
    stays = np.zeros(count, bool)
    numbers = arguments.index_vector("fixed", fixed)
    arguments.require_indices("fixed", numbers, count)
    stays[numbers] = True
    joints, within = _joints(surface, uv, island, pairs)
    z = uv[..., 0].ravel() + 1j * uv[..., 1].ravel()
    of_corner = np.repeat(island, 3)
    sizes = np.bincount(island[island >= 0], uv_areas(uv[island >= 0]), minlength=count)
    group = np.arange(count)
    pinned = np.zeros(len(pairs), bool)
    joined = inexact = 0
    before = z.copy()
    for joint in sorted(joints, key=lambda joint: -_length(z, joint.first)):
        one, other = group[of_corner[joint.first[0, 0]]], group[of_corner[joint.second[0, 0]]]
        if one == other:
            within[joint.rows] = True
            continue
        onto, moving = joint.first, joint.second
        if (stays[other], sizes[other]) > (stays[one], sizes[one]):
            one, other, onto, moving = other, one, moving, onto
        if stays[other]:
            pinned[joint.rows] = True
            continue
        inside = np.isin(of_corner, np.flatnonzero(group == other))
        exact = _move_onto(z, inside, onto.ravel(), moving.ravel())
        _weld(surface, z, inside, onto.ravel(), moving.ravel())
        joined, inexact = joined + 1, inexact + (not exact)
        group[group == other] = one
        stays[one] |= stays[other]
        sizes[one] += sizes[other]
    out = np.stack([z.real, z.imag], axis=1).reshape(uv.shape)
    return StitchedMap(out, (z != before).reshape(-1, 3).any(axis=1) & (island >= 0), joined, inexact, within, pinned)


def _joints(
    surface: Surface, uv: FloatArray, island: IndexArray, edges: IndexArray
) -> tuple[list[_Joint], NDArray[np.bool_]]:
    """Those between islands, and the edges that are cut within one."""
    row, triangle, tail = sides_of_edges(surface, edges)
    kept = island[triangle] >= 0
    row, triangle, tail = row[kept], triangle[kept], tail[kept]
    two = np.flatnonzero(np.bincount(row, minlength=len(edges)) == 2)
    at = np.flatnonzero(np.isin(row, two)).reshape(-1, 2)
    ends = np.stack([3 * triangle + tail, 3 * triangle + (tail + 1) % 3], axis=1)
    turned = surface.triangles.ravel()[ends[:, 0]] != edges[row, 0]
    ends[turned] = ends[turned, ::-1]
    first, second = ends[at[:, 0]], ends[at[:, 1]]
    flat = uv.reshape(-1, 2)
    is_cut = (flat[first] != flat[second]).any(axis=(1, 2))
    of = np.repeat(island, 3)
    a, b = of[first[:, 0]], of[second[:, 0]]
    within = np.zeros(len(edges), bool)
    within[row[at[is_cut & (a == b), 0]]] = True
    # By islands, the lower number first.
    cut = np.flatnonzero(is_cut & (a != b))
    reverse = a[cut] > b[cut]
    first, second = (np.where(reverse[:, None], y[cut], x[cut]) for x, y in ((first, second), (second, first)))
    low, high = of[first[:, 0]], of[second[:, 0]]
    # Edges that meet at both of their sides are one joint.
    vertex = surface.triangles.ravel()
    places = np.concatenate([vertex[first][..., None], low[:, None, None] + 0 * first[..., None], flat[first]], axis=-1)
    places = np.concatenate([places, high[:, None, None] + 0 * first[..., None], flat[second]], axis=-1)
    node = unique_rows(places.reshape(-1, places.shape[-1])).index.reshape(-1, 2)
    chain = lowest_linked(node, int(node.max(initial=-1)) + 1)[node[:, 0]]
    rows = row[at[cut, 0]]
    z = flat[:, 0] + 1j * flat[:, 1]
    joints = []
    for number in np.unique(chain).tolist():
        of_chain = chain == number
        joints += _by_transition(z, _Joint(rows[of_chain], first[of_chain], second[of_chain]))
    return joints, within


def _by_transition(z: NDArray[np.complex128], joint: _Joint) -> list[_Joint]:
    """The parts of a path that match by one rotation and one translation each, as on both sides of a cone, and the rest
    of it."""
    if _Fit.of(z, joint.first, joint.second).is_exact:
        return [joint]
    here, there = (z[ends[:, 1]] - z[ends[:, 0]] for ends in (joint.first, joint.second))
    turn = here * there.conj()
    angle = np.arctan2(turn.imag, turn.real)
    order = np.argsort(angle, kind="stable")
    alike = np.empty(len(order), int)
    alike[order] = np.cumsum(np.diff(angle[order], prepend=angle[order][:1]) > _MATCH)
    parts, rest = [], np.ones(len(order), bool)
    for number in range(int(alike.max()) + 1):
        of = alike == number
        if of.sum() > 1 and _Fit.of(z, joint.first[of], joint.second[of]).is_exact:
            parts.append(_Joint(joint.rows[of], joint.first[of], joint.second[of]))
            rest &= ~of
    return [*parts, _Joint(joint.rows[rest], joint.first[rest], joint.second[rest])] if rest.any() else parts


@dataclass
class _Fit:
    """How points come onto others: both about their middles, and the turn that fits best."""

    source: complex
    target: complex
    p: NDArray[np.complex128]
    q: NDArray[np.complex128]
    along: complex

    @classmethod
    def of(cls, z: NDArray[np.complex128], onto: NDArray[np.intp], moving: NDArray[np.intp]) -> _Fit:
        p, q = z[moving.ravel()], z[onto.ravel()]
        source, target = p.mean(), q.mean()
        p, q = p - source, q - target
        return cls(source, target, p, q, (p.conj() * q).sum())

    @property
    def turn(self) -> complex:
        return self.along / abs(self.along) if abs(self.along) > 0 else 1.0

    @property
    def is_exact(self) -> bool:
        return float(abs(self.turn * self.p - self.q).max()) <= _MATCH * float(abs(self.q).max())


def _length(z: NDArray[np.complex128], ends: NDArray[np.intp]) -> float:
    return float(abs(z[ends[:, 1]] - z[ends[:, 0]]).sum())


def _move_onto(
    z: NDArray[np.complex128], inside: NDArray[np.bool_], onto: NDArray[np.intp], moving: NDArray[np.intp]
) -> bool:
    """Move the corners inside so that some come onto others.  Returns whether a rotation and a translation did it."""
    fit = _Fit.of(z, onto, moving)
    exact, turn = fit.is_exact, fit.turn
    if not exact and abs(fit.along) > 0:
        turn = fit.along / (abs(fit.p) ** 2).sum()
    z[inside] = turn * (z[inside] - fit.source) + fit.target
    return exact


def _weld(
    surface: Surface,
    z: NDArray[np.complex128],
    inside: NDArray[np.bool_],
    onto: NDArray[np.intp],
    moving: NDArray[np.intp],
) -> None:
    """Give all corners inside that are one with a moving one the place of the one that this came onto."""
    vertex = surface.triangles.ravel()
    place = {(int(vertex[m]), z[m]): z[o] for o, m in zip(onto.tolist(), moving.tolist(), strict=True)}
    wanted = {v for v, _ in place}
    for corner in np.flatnonzero(inside & np.isin(vertex, list(wanted))).tolist():
        z[corner] = place.get((int(vertex[corner]), z[corner]), z[corner])


def numbered_islands(corner_uv: ArrayLike, island: ArrayLike) -> tuple[FloatArray, IndexArray, int]:
    """The coordinates, (m, 3, 2), the number of each triangle's island, and of islands.  Raises InputError."""
    numbers = arguments.islands("island", island)
    uv = arguments.corner_coordinates("corner_uv", corner_uv, len(numbers))
    return uv, numbers, int(numbers.max(initial=-1)) + 1
