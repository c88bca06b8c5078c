# SPDX-License-Identifier: GPL-3.0-or-later
"""Cuts of a finished layout moved by hand: a piece of the layout moves rigidly from one side of a cut to the other."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _lsgp
from .base import arguments
from .base.arguments import FloatArray, IndexArray
from .base.equality import EqualByContent
from .base.short_repr import ShortRepr
from .errors import Elements, TopologyError
from .surface import Surface, surface_arrays

# Both sides of a cut may differ from one motion by this share of the cut's size and of the largest coordinate, since
# layouts may have been rounded to single precision.
_OF_SIZE, _OF_COORDINATES = 1e-6, 4 * float(np.finfo(np.float32).eps)


@dataclass(frozen=True, slots=True)
class Transition:
    """The motion z -> rotation * z + translation, z = u + iv. exact: by quarter turns, without any rounding."""

    rotation: complex
    translation: complex
    exact: bool

    def power(self, exponent: int) -> Transition:
        """This motion repeated, or its inverse.  Raises InputError."""
        left = arguments.whole_number("exponent", exponent, -(2**31), "pass how often the motion is repeated")
        step = self if left >= 0 else self._inverse()
        left = abs(left)
        out = Transition(1 + 0j, 0j, self.exact)
        while left:
            if left % 2:
                out = step._after(out)
            step, left = step._after(step), left // 2
        return out

    def _after(self, first: Transition) -> Transition:
        return Transition(self.rotation * first.rotation, self(first.translation), self.exact)

    def _inverse(self) -> Transition:
        back = self.rotation.conjugate()
        return Transition(back, -(back * self.translation), self.exact)

    def __call__(self, z: complex) -> complex:
        return self.rotation * z + self.translation


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class MovedCut(EqualByContent, ShortRepr):
    """A cut on another way, and the piece of the layout that moved with it.

    path: (p,) int32 vertices, from the first to the last of the cut as it was grabbed. triangles: (t,) int32, those
        with new coordinates. corner_uv: (t, 3, 2) float64, these; all other triangles keep theirs.
    """

    path: IndexArray
    triangles: IndexArray
    corner_uv: FloatArray


class CutMover:
    """Moves cuts of layouts of one surface, for instance while one is dragged; no layout is computed again.

    Keeps the surface's topology. Cuts run along `Surface.edges`, as cheaply as `Surface.cut_costs` permit; seams and
    borders have no meaning here.  Raises InputError.
    """

    def __init__(self, surface: Surface) -> None:
        self._router = _lsgp.CutRouter(surface_arrays(surface))
        self._triangles = surface.triangles

    def grab(self, corner_uv: ArrayLike, cuts: ArrayLike, path: ArrayLike, nodes: ArrayLike = ()) -> GrabbedCut:
        """The cut, or part of a cut, that is to be moved.

        corner_uv: (m, 3, 2), the layout. cuts: (c, 2), the edges of all its cuts, as `Result.cut_edges`. path: (p,),
        the vertices of the one to move, as one of `split_into_paths`; its ends stay. nodes: (k,), vertices that no cut
        is moved across, as cones.
        Raises InputError; TopologyError (CUT_NOT_MOVABLE) along a boundary, and if the two sides are not related by one
        rotation and one translation.
        """
        uv = arguments.corner_coordinates("corner_uv", corner_uv, len(self._triangles))
        vertices = arguments.index_vector("path", path)
        nodes_apart = arguments.index_vector("nodes", nodes)
        grabbed = self._router.grab(arguments.index_rows("cuts", cuts, 2), vertices, nodes_apart)
        return GrabbedCut(grabbed, vertices, uv, self._triangles)


class GrabbedCut:
    """A cut that is being moved, in the layout that it was grabbed in.

    transition: from its left to its right side, seen from its first vertex to its last.
    """

    def __init__(
        self, grabbed: _lsgp.GrabbedCut, path: IndexArray, corner_uv: FloatArray, triangles: IndexArray
    ) -> None:
        self._grabbed, self._triangles = grabbed, triangles
        self._z = corner_uv.copy().view(np.complex128).reshape(-1)
        self.transition = _fitted(self._z[grabbed.left], self._z[grabbed.right], path)

    def through(self, vertex: int, *, single: bool = False) -> MovedCut:
        """The cut by way of a vertex: the cheapest way there from its first end, and on to its last.

        single: vertices on the new way of an exact transition are rounded, on both sides alike and by half a unit in
        the last place at most, so that the transition stays exact if coordinates are stored in float32.
        Raises TopologyError (CUT_NOT_MOVABLE) if another cut, a cone, a handle or a boundary is in the way or between
        both ways.
        """
        at = arguments.whole_number("vertex", vertex, 0, "pass a vertex of the surface")
        rounds = arguments.flag("single", single) and self.transition.exact
        moved = self._grabbed.through(at)
        triangles, powers = moved["triangles"], moved["powers"]
        old = self._z.reshape(-1, 3)[triangles]
        new = np.empty_like(old)
        for exponent in np.unique(powers).tolist():
            rows = powers == exponent
            new[rows] = self.transition.power(exponent)(old[rows])
        if not self.transition.exact:
            self._join(moved, old, new)
        if rounds:
            triangles, new = self._rounded(moved["path"], triangles, new)
        # Adding zero makes negative zeros positive.
        return MovedCut(moved["path"], triangles, (new + 0j).view(np.float64).reshape(-1, 3, 2))

    def _rounded(
        self, path: IndexArray, triangles: IndexArray, new: NDArray[np.complex128]
    ) -> tuple[IndexArray, NDArray[np.complex128]]:
        """Triangles and their new coordinates, with vertices inside the path where float32 holds both sides."""
        around = np.flatnonzero(np.isin(self._triangles, path[1:-1]).any(axis=1)).astype(np.int32)
        every = np.union1d(triangles, around)
        z = self._z.reshape(-1, 3)[every]
        z[np.searchsorted(every, triangles)] = new
        vertices = self._triangles[every]
        for vertex in path[1:-1].tolist():
            corners = vertices == vertex
            first, second = np.unique(z[corners])
            if self.transition(first) != second:
                first, second = second, first
            digit = np.spacing(np.float32(np.abs(np.array([first, second]).view(np.float64)).max()))
            place = complex(*(np.round(np.array([first.real, first.imag]) / digit) * digit))
            z[corners] = np.where(z[corners] == first, place, self.transition(place))
        return every, z

    def _join(self, moved: dict[str, NDArray], old: NDArray[np.complex128], new: NDArray[np.complex128]) -> None:
        """Where the cut was, corners of the piece get the very coordinates of what they now lie beside."""
        power_of = np.zeros(len(self._triangles), np.int64)
        power_of[moved["triangles"]] = moved["powers"]
        row_of = np.full(len(self._triangles), -1)
        row_of[moved["triangles"]] = np.arange(len(moved["triangles"]))
        vertices = self._triangles[moved["triangles"]].ravel()
        flat, before = new.reshape(-1), old.reshape(-1)
        beside = np.flatnonzero(np.isin(vertices, self._triangles.ravel()[moved["joins"]]))
        fans: dict[tuple[int, int, complex], list[int]] = {}
        # Corners of one vertex that had one position and move alike have one again.
        of_corner = [(int(vertices[at]), int(moved["powers"][at // 3]), complex(before[at])) for at in beside]
        for at, fan in zip(beside.tolist(), of_corner, strict=True):
            fans.setdefault(fan, []).append(at)
        for pair in moved["joins"].tolist():
            still, mover = sorted(pair, key=lambda corner: abs(power_of[corner // 3]))
            row, at = row_of[still // 3], 3 * row_of[mover // 3] + mover % 3
            place = self._z[still] if row < 0 else flat[3 * row + still % 3]
            flat[fans[int(vertices[at]), int(moved["powers"][at // 3]), complex(before[at])]] = place


def overlapping_triangles(corner_uv: ArrayLike) -> IndexArray:
    """The triangles of a layout that overlap others, (t,) int32, ascending.

    corner_uv: (m, 3, 2); triangles with a coordinate that is not finite are left out.  Raises InputError.
    """
    array = arguments.as_array("corner_uv", corner_uv)
    return _lsgp.overlapping_triangles(arguments.corner_coordinates("corner_uv", array, len(np.atleast_1d(array))))


def _fitted(left: NDArray[np.complex128], right: NDArray[np.complex128], path: IndexArray) -> Transition:
    """The motion from the positions on one side to those on the other.  Raises TopologyError."""
    exact = _quarter_turn(left, right)
    if exact is not None:
        return exact
    centers = left.mean(), right.mean()
    product = np.vdot(left - centers[0], right - centers[1])
    rotation = complex(product / abs(product)) if product else 1 + 0j
    found = Transition(rotation, complex(centers[1] - rotation * centers[0]), False)
    sides = np.concatenate([left, right])
    size = max(np.abs(left - centers[0]).max(), np.abs(right - centers[1]).max())
    most = _OF_SIZE * size + _OF_COORDINATES * np.abs(sides).max()
    # Also where a coordinate is not finite.
    if not np.abs(right - found(left)).max() <= most:
        message = (
            "The two sides of this cut are not related by one rotation and one translation. Unwrap from cones first, "
            "or move the parts between its cones one by one."
        )
        raise TopologyError("CUT_NOT_MOVABLE", message, Elements("edges", np.c_[path[:-1], path[1:]]))
    return found


def _quarter_turn(left: NDArray[np.complex128], right: NDArray[np.complex128]) -> Transition | None:
    """The motion by a multiple of a quarter turn that holds without any rounding; None if there is none."""
    for rotation in (1 + 0j, 1j, -1 + 0j, -1j):
        translation = complex(right[0] - rotation * left[0])
        found = Transition(rotation, translation, True)
        if np.array_equal(found(left), right):
            return found
    return None
