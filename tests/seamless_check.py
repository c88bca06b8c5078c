# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether a layout is seamless and its certificate true, judged from its coordinates as float32 stores them.

Transitions are read off the two sides of each cut edge.  Numbers of float32 have so few digits that their sums and
products in float64 are exact or, where not, known not to be: on square lattices nothing here is a tolerance.  On
triangular ones, whose points are irrational, all bounds are units in the last place of the largest coordinate.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from fractions import Fraction

import lsgp
import numpy as np
from numpy.typing import NDArray
from opened_surface import Opened, edge_keys, labels, named_by, next_corner

TURN = 2 * np.pi
ROTATION_ORDER = {"square": 4, "stripe": 2, "translation": 1, "triangle": 3, "hexagon": 6}
TWELFTHS = np.array([1, 0, 0, 1j, 0, 0, -1, 0, 0, -1j, 0, 0]) + np.sqrt(0.75) * np.array(
    [0, 1, 1j, 0, 1j, -1, 0, -1, -1j, 0, -1j, 1]
)
TWELFTHS += 0.5 * np.array([0, 1j, 1, 0, -1, 1j, 0, -1j, -1, 0, 1, -1j])  # e^(2 pi i k / 12), quarter turns exact
RELAXED = 1e-3  # cells: beside cones off the lattice, where nothing is exact
CERTIFIED = 1e-11  # cells: what the certificate and this module may compute differently on triangular lattices


@dataclass(frozen=True)
class Grid:
    """The lattice of a layout: q turns, the side of a cell, and where cones have to be in it."""

    rotation_order: int
    cell: float
    cone_shift: complex  # cells

    @property
    def square(self) -> bool:
        return self.rotation_order not in (3, 6)

    @property
    def generator(self) -> complex:
        return 1j if self.square else complex(0.5, np.sqrt(0.75))

    def unit(self, turns: NDArray[np.integer]) -> NDArray[np.complex128]:
        return TWELFTHS[np.asarray(turns) % self.rotation_order * (12 // self.rotation_order)]

    def nearest(self, cells: NDArray[np.complex128]) -> NDArray[np.int64]:
        """(..., 2) coordinates of the lattice points nearest to the given places."""
        b = cells.imag / self.generator.imag
        a = cells.real - b * self.generator.real
        low = np.floor(np.stack([a, b], axis=-1))
        tried = np.stack([low + corner for corner in ([0, 0], [0, 1], [1, 0], [1, 1])])
        best = np.abs(self.place(tried) - cells).argmin(axis=0)
        return np.take_along_axis(tried, best[None, ..., None], axis=0)[0].astype(np.int64)

    def place(self, coordinates: NDArray[np.number]) -> NDArray[np.complex128]:
        return coordinates[..., 0] + coordinates[..., 1] * self.generator

    def back(self, turns: int, translation: tuple[int, int]) -> tuple[int, int, int]:
        """The inverse of z -> unit(turns) z + translation, in whole numbers."""
        a, b = -translation[0], -translation[1]
        for _ in range(-turns % self.rotation_order * ((4 if self.square else 6) // self.rotation_order)):
            a, b = (-b, a) if self.square else (-b, a + b)  # times i, or e^(i pi / 3)
        return -turns % self.rotation_order, a, b


def seamless_faults(opened: Opened, result: lsgp.Result, asked: lsgp.Seamless) -> list[str]:
    """Everything that keeps a layout from being seamless, or its certificate from being true; empty for an honest one.

    A component with cones that the certificate lists as relaxed is excused from being exact; what the certificate says
    of its cuts has to be true all the same.
    """
    report = result.seamless
    if report is None:
        return ["no certificate of a seamless layout"]
    grid = Grid(ROTATION_ORDER[asked.lattice], asked.cell, 0.5 + 0.5j if asked.parity else 0)
    faults = []
    if (report.rotation_order, report.cell) != (grid.rotation_order, grid.cell):
        faults.append(f"the certificate is of another lattice: {report.rotation_order} turns, cells of {report.cell}")
    relaxed = np.isin(opened.vertex, report.relaxed_cones)
    exact = ~np.isin(np.repeat(opened.component, 3), np.repeat(opened.component, 3)[relaxed])
    given = np.stack([opened.z.real, opened.z.imag], axis=1)
    stored = given.astype(np.float32)
    if grid.square and (stored != given)[exact].any():
        faults.append("coordinates that float32 does not hold")
    z = stored[:, 0].astype(float) + 1j * stored[:, 1]
    last_place = float(np.spacing(np.abs(stored).max(initial=np.float32(0)))) / grid.cell  # cells

    flipped = opened.triangle[~_turn_left(z.reshape(-1, 3))]
    if not np.isin(flipped, named_by(result, "FLIPPED_TRIANGLES")).all():
        faults.append(f"{len(flipped)} triangles {flipped[:5].tolist()} are flipped in single precision")
    faults += _cones(opened, result, grid, z, exact, last_place)
    return faults + _cuts(opened, result, asked, grid, z, exact, last_place)


def _turn_left(corner: NDArray[np.complex128]) -> NDArray[np.bool_]:
    """Whether (m, 3) triangles of numbers from float32 are counter-clockwise, exactly."""
    a, b = corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]
    left, right = a.real * b.imag, a.imag * b.real
    area = left - right
    out = area > 0
    for f in np.flatnonzero(~(np.abs(area) > 1e-15 * (np.abs(left) + np.abs(right)))):
        (ax, ay), (bx, by), (cx, cy) = [(Fraction(p.real), Fraction(p.imag)) for p in corner[f].tolist()]
        out[f] = (bx - ax) * (cy - ay) > (by - ay) * (cx - ax)
    return out


def _minus(a: NDArray[np.float64], b: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """a - b and whether that is exact (Knuth's error term)."""
    difference = a - b
    part = difference - a
    return difference, (a - (difference - part)) + (-b - part) == 0


def _flat_sheets(opened: Opened, z: NDArray[np.complex128]) -> NDArray[np.bool_]:
    """Corners at a vertex of several sheets, which has one entry in the result, on those where its angle is a turn."""
    fans = len(opened.closed)
    corner = z.reshape(-1, 3)
    here = np.angle((corner[:, [2, 0, 1]] - corner) * (corner[:, [1, 2, 0]] - corner).conj())
    flat = np.abs(np.bincount(opened.fan, here.ravel(), fans) - TURN) < RELAXED
    vertex = np.zeros(fans, np.int64)
    vertex[opened.fan] = opened.vertex
    return (flat & (np.bincount(vertex)[vertex] > 1))[opened.fan]


def _cones(
    opened: Opened,
    result: lsgp.Result,
    grid: Grid,
    z: NDArray[np.complex128],
    exact: NDArray[np.bool_],
    last_place: float,
) -> list[str]:
    faults = []
    inner = opened.closed[opened.fan]
    flat = np.full(int(opened.vertex.max()) + 1, np.pi)
    flat[opened.vertex[inner]] = TURN
    known = result.cones < len(flat)
    cones, angles = result.cones[known], result.cone_angles[known]
    turns = (flat[cones] - angles) * grid.rotation_order / TURN
    if np.abs(turns - np.round(turns)).max(initial=0) > 1e-9:
        faults.append(f"cone angles are off the lattice's turns by {np.abs(turns - np.round(turns)).max():.1e}")
    if np.isin(cones, result.seamless.flat_cones).any() or (np.round(turns) == 0)[flat[cones] == TURN].any():
        faults.append("flat cones among the cones")
    for listed, code in (
        ("flat_cones", "FLAT_CONES"),
        ("merged_cones", "CONES_MERGED"),
        ("relaxed_cones", "CONES_NOT_SNAPPED"),
    ):
        if not np.array_equal(np.sort(getattr(result.seamless, listed)), np.sort(named_by(result, code))):
            faults.append(f"{code} does not name the {listed}")
    corners = np.flatnonzero(np.isin(opened.vertex, cones) & inner & exact & ~_flat_sheets(opened, z))
    place = z[corners] / grid.cell - grid.cone_shift
    off = np.abs(place - grid.place(grid.nearest(place)))
    if off.max(initial=0) > (0 if grid.square else last_place):
        worst = opened.vertex[corners[off.argmax()]]
        faults.append(f"{np.count_nonzero(off)} corners at cones off the lattice, {worst} by {off.max():.1e} cells")
    return faults


def _cuts(
    opened: Opened,
    result: lsgp.Result,
    asked: lsgp.Seamless,
    grid: Grid,
    z: NDArray[np.complex128],
    exact: NDArray[np.bool_],
    last_place: float,
) -> list[str]:
    """One lattice motion for each path of the cut between nodes, and the certificate lists just these."""
    cut_keys = edge_keys(*result.cut_edges.T)
    h = np.flatnonzero(opened.twin >= 0)
    h = h[np.isin(edge_keys(opened.vertex[h], opened.vertex[next_corner(h)]), cut_keys)]
    if not len(h):
        return ["the certificate lists cuts where none are"] if len(result.seamless.cut_nodes) else []
    exact = exact[h]

    other = opened.twin[h]
    left = np.stack([z[h], z[next_corner(h)]], axis=1)
    right = np.stack([z[next_corner(other)], z[other]], axis=1)
    along = (right[:, 1] - right[:, 0]) * (left[:, 1] - left[:, 0]).conj()
    turns = np.round(np.angle(along) * grid.rotation_order / TURN).astype(int) % grid.rotation_order
    image = grid.unit(turns)[:, None] * left
    real, exact_real = _minus(right.real, image.real)
    imag, exact_imag = _minus(right.imag, image.imag)
    shift = (real + 1j * imag) / grid.cell
    translation = grid.nearest(shift)
    off = np.abs(shift - grid.place(translation)).max(axis=1)
    tail, head = result.seamless.cut_nodes.T
    # A seam may close on itself without a node; the certificate says where it begins.
    nodes = np.union1d(result.cones, tail[tail == head])
    before, after = opened.straight_on(h, nodes, _flat_sheets(opened, z))
    path = labels(before, after, len(h))
    first, last = np.ones(len(h), bool), np.ones(len(h), bool)
    first[after] = last[before] = False
    if (np.bincount(path, first) != 1).any():
        return ["a cut without ends"]

    faults = []
    subtracted = (exact_real & exact_imag).all(axis=1)
    # Stored, each coordinate is off by half a unit at most, so each side by that times the root of 2.
    wrong = exact & (~subtracted | (off != 0) if grid.square else off > np.sqrt(2) * last_place)
    if wrong.any():
        at = np.flatnonzero(wrong)[off[wrong].argmax()]
        faults.append(
            f"{int(wrong.sum())} of {len(h)} sides of cuts are not a lattice motion apart, at "
            f"{opened.vertex[h[at]]}-{opened.vertex[next_corner(h)[at]]} they miss it by {off[at]:.1e} cells, "
            f"{off[at] / last_place:.2f} units in the last place"
        )
    begin, end = np.empty(int(path.max()) + 1, int), np.empty(int(path.max()) + 1, int)
    begin[path[first]], end[path[last]] = np.flatnonzero(first), np.flatnonzero(last)
    start = begin[path]
    alike = (translation == translation[start, :1]).all(axis=(1, 2))
    nearly = np.abs(shift - shift[start, :1]).max(axis=1) <= RELAXED
    same = (turns == turns[start]) & np.where(exact, alike, nearly)
    if not same.all():
        faults.append(f"{len(np.unique(path[~same]))} cuts are crossed by more than one motion")
    ends = opened.vertex[h[begin]], opened.vertex[next_corner(h)[end]]
    motions = np.column_stack([*ends, turns[begin], translation[begin, 0]])
    error = np.zeros(len(motions))
    np.maximum.at(error, path, off)
    faults += _certificate(result.seamless, grid, motions, error, exact[begin])
    if asked.parity:
        shifted = grid.place(translation[:, 0]) + (grid.unit(turns) - 1) * grid.cone_shift
        odd = exact & (np.round(shifted.real + shifted.imag).astype(int) % 2 != 0)
        if odd.any() or not np.array_equal(shifted, np.round(shifted)):
            faults.append(f"{int(odd.sum())} sides of cuts where black cells meet white ones")
    return faults


def _certificate(
    report: lsgp.SeamlessReport,
    grid: Grid,
    motions: NDArray[np.int64],
    error: NDArray[np.float64],
    exact: NDArray[np.bool_],
) -> list[str]:
    """motions: (paths, 5) tail, head, turns, a and b of every path, in both directions; error: (paths,) in cells."""
    stated = np.concatenate([report.cut_nodes, report.cut_turns[:, None], report.cut_translations], axis=1)
    back = [(head, tail, *grid.back(turns, (a, b))) for tail, head, turns, a, b in stated.tolist()]
    stated = np.concatenate([stated, np.array(back, int).reshape(-1, 5)])
    stated_error = np.tile(report.cut_errors, 2)
    if not exact.all():  # which lattice point is nearest to a translation half way between two is no matter
        motions, stated = motions[:, :3], stated[:, :3]
    found, listed = Counter(map(tuple, motions.tolist())), Counter(map(tuple, stated.tolist()))
    if found != listed:
        missing, extra = list((found - listed).elements()), list((listed - found).elements())
        return [f"the certificate lacks {len(missing)} cuts {missing[:3]} and invents {len(extra)} {extra[:3]}"]
    faults = []
    tolerance = 0.0 if grid.square and exact.all() else CERTIFIED if exact.all() else RELAXED
    order, stated_order = np.lexsort([error, *motions.T]), np.lexsort([stated_error, *stated.T])
    gap = np.abs(error[order] - stated_error[stated_order])
    if gap.max(initial=0) > tolerance:
        faults.append(f"the certificate's errors of cuts are wrong by up to {gap.max():.1e} cells")
    if report.error != report.cut_errors.max(initial=0):
        faults.append("the certificate's error is not that of its worst cut")
    return faults
