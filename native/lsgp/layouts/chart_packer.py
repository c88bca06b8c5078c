# SPDX-License-Identifier: GPL-3.0-or-later
"""Packs islands, without rotating them, into the smallest square that the packer of xatlas finds.

xatlas compares rasters of islands. It may mirror islands and scales each to whole texels, so only their places are
taken from it, and every island is moved as a whole. What comes out is measured, and counts if islands keep their
margin.

Places are complex numbers, u + iv.
"""

from __future__ import annotations

import math
import os
import time
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from .. import _lsgp
from ..base.progress import UNTOLD, Progress, Steps
from ..errors import InputError
from .coarse_islands import coarse_triangles, doubled_areas
from .island_gaps import ComplexArray, Indices, least_gap

# Texels of the raster's side, about: finer ones take time as its square, coarser ones waste space around islands. Of
# more islands it has twice as many.
_RASTER = 352
_FEW_ISLANDS = 64
# Between islands xatlas leaves twice the padding and more than this part of a texel, but for its widening of islands.
_LEFT_BESIDE = 0.375
# A layout has to be so much smaller than the best one to be looked for.
_GAIN = 0.992
# What of the square the first layout that is tried fills, and by how much the side grows until one is found.
_FIRST_FILL = 0.6
_GROWTH = 1.12
_MOST_GROWTHS = 12
# In texels of the raster: xatlas widens islands to whole ones, and by more only what it takes for several islands; one
# that is larger than the square it makes smaller.
_WIDENED = 2.5
_NARROWED = 0.01
# In texels: triangles of a smaller area it leaves where they are.
_NO_AREA = 1e-5
_LEAST_BOX = 0.01
_MOST_AROUND = 2000
# When an atlas is freed, xatlas wakes its threads without their lock, and waits for ever for one that is just falling
# asleep, as all are after the last chart. Nothing else can free it safely, or pack without threads: they are waited for
# where the system tells what threads do, up to so many seconds, and elsewhere for so many.
_MOST_SETTLING, _SETTLING = 1.0, 0.005
_TASKS = Path("/proc/self/task")
_TINY, _EPSILON = float(np.finfo(float).tiny), float(np.finfo(float).eps)
# Of a square around islands whose coordinates are about 1, or all 0.
_NO_SIZE = 1e-200


@dataclass(frozen=True, slots=True)
class Islands:
    """Islands as they are given.

    place: (n,) of vertices, which are joined within an island alone. triangles: (m, 3) vertices. island: (n,) of each
    vertex. borders: (s, 2) vertices, ends of edges that one triangle alone has. area: of all triangles.
    """

    place: ComplexArray
    triangles: Indices
    island: Indices
    borders: Indices
    area: float

    @property
    def count(self) -> int:
        return int(self.island.max()) + 1

    def boxes(self, place: ComplexArray) -> tuple[ComplexArray, ComplexArray]:
        """The middle and the width + i height of each island's box, (islands,)."""
        low, high = np.full((2, self.count), np.inf), np.full((2, self.count), -np.inf)
        for axis, of_vertex in enumerate((place.real, place.imag)):
            np.minimum.at(low[axis], self.island, of_vertex)
            np.maximum.at(high[axis], self.island, of_vertex)
        middle, size = (low + high) / 2, high - low
        return middle[0] + 1j * middle[1], size[0] + 1j * size[1]

    def gap(self, place: ComplexArray, reach: float, steps: Steps = UNTOLD) -> float:
        """The least distance between islands, infinite above `reach`.  Raises Cancelled."""
        return least_gap(place[self.borders], self.island[self.borders[:, 0]], reach, steps)


@dataclass(frozen=True, slots=True)
class Square:
    """The square to be filled.  margin: of its side where `fill` is true, otherwise in the islands' unit."""

    margin: float
    fill: bool

    def share(self, side: float) -> float:
        """The margin as a part of the side."""
        return self.margin if self.fill else self.margin / side

    def side(self, extent: float) -> float:
        """Of the square around islands that extend so far."""
        return extent / (1 - 2 * self.margin) if self.fill else extent + 2 * self.margin


@dataclass(frozen=True, slots=True)
class Layout:
    """Islands in a square: where their vertices are, (n,), its low corner, and its side."""

    place: ComplexArray
    low: complex
    side: float


class Packer:
    """xatlas with the islands and the square to pack them into."""

    def __init__(self, islands: Islands, square: Square, progress: Progress | None = None) -> None:
        """progress: of preparing them.  Raises Cancelled."""
        self._islands, self._square = islands, square
        self._steps = UNTOLD
        self._covers = coarse_triangles(islands.place, islands.triangles, islands.island, islands.borders, progress)
        self._raster = _RASTER if islands.count <= _FEW_ISLANDS else 2 * _RASTER
        # Islands that are packed as their boxes: those without an area, those that xatlas takes for several, and those
        # with a vertex of so many triangles that it would take minutes, as it compares all of them.
        self._boxed = np.zeros(islands.count, bool)
        around = np.bincount(self._covers.ravel(), minlength=len(islands.island))
        self._boxed[islands.island[around > _MOST_AROUND]] = True

    def improved(self, turns: ComplexArray, best: Layout | None, steps: Steps, shorter: float = 1.0) -> Layout | None:
        """The smallest layout found of islands so turned, if it is smaller than `best`.  Raises InputError, Cancelled.

        turns: (islands,) of length 1. best: None: any is; there is one, or InputError is raised. shorter: the side that
        it has to have at most, relative to that of `best`.
        """
        self._steps = steps
        place = self._islands.place * turns[self._islands.island]
        found = self._first(place) if best is None else None
        most = (best or found).side * shorter
        while (smaller := self._fitted(place, most * _GAIN)) is not None and smaller.side < most:
            found, most = smaller, smaller.side
        return found

    def _first(self, place: ComplexArray) -> Layout:
        least, farthest = self._estimated_side(place), float(np.abs(place).max())
        if least <= max(self._raster * _EPSILON * farthest, _NO_SIZE):
            raise InputError(
                "WRONG_PARAMETER",
                f"The square that the islands fill is {least / max(farthest, least):.2g} of their distance from the "
                "origin, too small to place them in. Move them to the origin, or leave out those that are points.",
            )
        for _ in range(2 if self._have_room() else 0):
            side = least
            for _ in range(_MOST_GROWTHS):
                found = self._fitted(place, side)
                if found is not None:
                    return found
                side *= _GROWTH
            # Where parts without area reach out of islands, their margin is not kept; their boxes have all of them.
            self._boxed[:] = True
        raise InputError(
            "WRONG_PARAMETER",
            f"With a margin of {self._square.margin:.4g} the {self._islands.count} islands do not fit into a square. "
            "Pass a smaller margin.",
        )

    def _have_room(self) -> bool:
        """Whether the margins leave any room: disks around islands cover at most pi / sqrt(12) of a square."""
        return not (self._square.fill and self._islands.count * math.sqrt(12) * self._square.margin**2 >= 1)

    def _estimated_side(self, place: ComplexArray) -> float:
        """Of the square that islands with their margins would fill well."""
        size = self._islands.boxes(place)[1]
        widest = max(size.real.max(), size.imag.max())
        side = max(self._square.side(widest), math.sqrt(self._islands.area / _FIRST_FILL), _TINY)
        for _ in range(4):
            gap = 2 * self._square.share(side) * side
            filled = self._islands.area + gap * (size.real + size.imag).sum() + self._islands.count * gap**2
            side = max(self._square.side(widest), math.sqrt(filled / _FIRST_FILL), side)
        return side

    def _fitted(self, place: ComplexArray, side: float) -> Layout | None:
        """A layout in a square of this side or smaller; None where none is found."""
        share = self._square.share(side)
        padding = int(share * self._raster)
        # Margins of whole texels and what is left beside them; narrower ones are that alone, or one texel.
        raster = (padding + _LEFT_BESIDE) / share if padding else self._raster
        # As islands are put at whole texels, a gap may come out less than a texel too small.
        for more in (0, 1):
            layout = self._laid_out(place, side / raster, int(raster * (1 - 2 * share)), padding + more)
            if layout is None:
                return None
            gap = 2 * self._square.share(layout.side) * layout.side
            if self._islands.gap(layout.place, gap, self._steps) >= max(gap, _TINY):
                return layout
        return None

    def _laid_out(self, place: ComplexArray, texel: float, inside: int, padding: int) -> Layout | None:
        """texel: side of one. inside: texels of the square without its margin. padding: texels around each island."""
        middle, size = self._islands.boxes(place)
        if inside < 1 or max(size.real.max(), size.imag.max()) > inside * texel:
            return None
        local = (place - middle[self._islands.island]) / texel
        places = self._places(local, size / texel, inside, padding)
        if places is None:
            return None
        moved = place + (places * texel - middle)[self._islands.island]
        low, high = (of(moved.real) + 1j * of(moved.imag) for of in (np.min, np.max))
        extent = max((high - low).real, (high - low).imag)
        return Layout(moved, low, self._square.side(extent))

    def _places(self, local: ComplexArray, size: ComplexArray, inside: int, padding: int) -> ComplexArray | None:
        """(islands,), where the middles of boxes go, in texels; None where islands do not fit.

        local: (n,) vertices around the middle of their island. size: (islands,) of boxes.
        """
        for _ in range(2):
            charts = self._charts(local, size)
            found = _run(charts, inside, padding, self._steps)
            if found is None:
                return None
            middle, found_size = charts.boxes(found)
            given_middle, given_size = charts.boxes(charts.place)
            wider = found_size - given_size
            if min(wider.real.min(), wider.imag.min()) < -_NARROWED:
                return None  # made smaller to fit
            in_parts = np.maximum(wider.real, wider.imag) > _WIDENED
            if not in_parts.any():
                return middle - given_middle
            self._boxed |= in_parts
        return None

    def _charts(self, local: ComplexArray, size: ComplexArray) -> Islands:
        """What xatlas gets: triangles with an area, or the two of a box."""
        triangles = self._covers
        of_triangle = self._islands.island[triangles[:, 0]]
        kept = (np.abs(doubled_areas(local, triangles)) > _NO_AREA) & ~self._boxed[of_triangle]
        boxes = np.flatnonzero(np.bincount(of_triangle[kept], minlength=len(size)) == 0)
        half = np.maximum(size.real[boxes], _LEAST_BOX) / 2 + 0.5j * np.maximum(size.imag[boxes], _LEAST_BOX)
        corners = np.stack([-half, half.conj(), half, -half.conj()], axis=1)
        used, vertices = np.unique(triangles[kept], return_inverse=True)
        first = len(used) + 4 * np.arange(len(boxes))[:, None, None]
        return replace(
            self._islands,
            place=np.concatenate([local[used], corners.ravel()]),
            triangles=np.concatenate(
                [vertices.reshape(-1, 3), (first + np.array([[0, 1, 2], [0, 2, 3]])).reshape(-1, 3)]
            ),
            island=np.concatenate([self._islands.island[used], np.repeat(boxes, 4)]),
        )


def _run(charts: Islands, inside: int, padding: int, steps: Steps = UNTOLD) -> ComplexArray | None:
    """(n,), where xatlas puts vertices, in texels; None if they do not fit into the square.  Raises Cancelled."""
    steps.tell()
    positions = np.stack([charts.place.real, charts.place.imag], axis=1)
    owner = charts.island[charts.triangles[:, :1]]
    # Most layouts that are looked for are not there, which xatlas finds out at ten times the cost.
    if not _lsgp.islands_fit(positions[charts.triangles], owner.ravel().astype(np.int32), inside, padding):
        return None
    steps.tell()
    xatlas = find_xatlas()
    others = _threads()
    atlas = xatlas.Atlas()
    # As if each island had a material of its own, or those with corners at the same place would be one.
    atlas.add_uv_mesh(positions.astype(np.float32), charts.triangles.astype(np.uint32), owner.astype(np.uint32))
    options = xatlas.PackOptions()
    options.resolution, options.padding, options.texels_per_unit = inside, padding, 1.0
    options.bruteForce, options.bilinear, options.blockAlign = True, False, False
    # It would mirror islands where it exchanges u and v.
    options.rotate_charts = options.rotate_charts_to_axis = False
    atlas.generate(pack_options=options)
    found = None
    if atlas.atlas_count == 1 and max(atlas.width, atlas.height) <= inside:
        vertices, _, uv = atlas[0]
        found = np.empty(len(charts.place), np.complex128)
        found[vertices] = uv[:, 0].astype(np.float64) * atlas.width + 1j * (uv[:, 1].astype(np.float64) * atlas.height)
    _settle(others)
    return found


def _threads() -> frozenset[str]:
    """Of this process; empty where the system does not tell."""
    try:
        return frozenset(os.listdir(_TASKS))
    except OSError:
        return frozenset()


def _settle(others: frozenset[str]) -> None:
    """Wait until all threads but these sleep."""
    if not others:
        time.sleep(_SETTLING)
        return
    end = time.monotonic() + _MOST_SETTLING
    while not all(map(_is_asleep, _threads() - others)) and time.monotonic() < end:
        time.sleep(_SETTLING / 10)


def _is_asleep(thread: str) -> bool:
    try:
        state = (_TASKS / thread / "stat").read_text()
    except OSError:  # it has ended
        return True
    return state.rpartition(")")[2].split()[0] == "S"


def find_xatlas() -> Any:
    """The package; None where it is not installed."""
    try:
        import xatlas
    except ImportError:
        return None
    return xatlas
