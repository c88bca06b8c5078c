# SPDX-License-Identifier: GPL-3.0-or-later
"""Moves of islands by whole cells: they lead to lattice points, and both sides of a cut match exactly afterward."""

from __future__ import annotations

import numpy as np
import pytest
from lsgp import lattice

ROOT_3 = np.sqrt(3)


def cells_of(shifts: np.ndarray, rotation_order: int, cell: float) -> np.ndarray:
    """The shifts in the lattice's own two vectors; whole numbers for lattice points."""
    basis = np.array([[1, 0.5], [0, ROOT_3 / 2]] if rotation_order in (3, 6) else np.eye(2))
    return np.linalg.solve(basis, shifts.T / cell).T


def is_whole(values: np.ndarray) -> bool:
    return bool((np.abs(values - np.round(values)) < 1e-9).all())


@pytest.mark.parametrize("rotation_order", [1, 2, 3, 4, 6])
@pytest.mark.parametrize("cell", [1.0, 2.0, 2.0**-6])
def test_moves_are_whole_cells_near_what_was_asked_for(rotation_order, cell):
    asked = np.random.default_rng(rotation_order).uniform(-40, 40, (500, 2))
    found = lattice.whole_cells(asked, rotation_order, cell)
    assert is_whole(cells_of(found, rotation_order, cell))
    # No farther than half a row and half a cell in it.
    row = ROOT_3 / 2 if rotation_order in (3, 6) else 1.0
    assert (np.abs(found - asked) <= np.array([0.5, row / 2]) * cell + 1e-9).all()


@pytest.mark.parametrize("rotation_order", [4, 6])
def test_islands_go_back_to_where_they_were(rotation_order):
    rng = np.random.default_rng(1)
    uv = rng.random((30, 3, 2)) * 5
    island = np.repeat([0, 1, -1, 2], [10, 10, 5, 5]).astype(np.int32)
    moves = lattice.whole_cells(rng.uniform(-90, 90, (3, 2)), rotation_order, 0.5)
    old = uv + np.append(moves, [[7.3, 7.3]], axis=0)[island][:, None, :] + rng.uniform(-0.05, 0.05, uv.shape)
    old[28] = np.nan
    found = lattice.nearest_places(uv, old, island, rotation_order, 0.5)
    assert np.allclose(found[:2], moves[:2], atol=1e-12)
    assert (found[2] == 0).all()


@pytest.mark.parametrize("rotation_order", [2, 3, 4, 6])
@pytest.mark.parametrize("cell", [1.0, 2.0**-4])
def test_boxes_on_shelves_do_not_overlap_and_fill_a_square(rotation_order, cell):
    rng = np.random.default_rng(2)
    least = rng.uniform(-30, 30, (60, 2))
    boxes = np.concatenate([least, least + rng.uniform(1, 9, (60, 2))], axis=1)
    shifts = lattice.shelf_places(boxes, rotation_order, cell)
    assert is_whole(cells_of(shifts, rotation_order, cell))
    placed = boxes + np.tile(shifts, 2)
    assert placed.min() >= 0
    gap = np.maximum(placed[:, None, :2] - placed[None, :, 2:], placed[None, :, :2] - placed[:, None, 2:]).max(axis=2)
    assert (gap[~np.eye(60, dtype=bool)] >= 0).all()
    # Shelves and whole cells waste some of a square, but not most.
    area = (boxes[:, 2:] - boxes[:, :2] + cell).prod(axis=1).sum()
    assert placed.max() < 1.4 * np.sqrt(area)


def test_one_box_goes_to_the_origin_and_none_is_no_problem():
    assert lattice.shelf_places([[-3.5, 2.25, 4.0, 8.0]], 4, 1.0).tolist() == [[4.0, -2.0]]
    assert lattice.shelf_places(np.empty((0, 4)), 4, 1.0).shape == (0, 2)


def test_boxes_of_islands():
    uv = np.array([[[0, 1], [2, 3], [1, 1]], [[np.nan] * 2] * 3, [[5, 5], [4, 6], [7, 5]], [[-1, 0], [0, 0], [0, 2]]])
    assert lattice.island_boxes(uv, np.array([0, -1, 1, 0])).tolist() == [[-1, 0, 2, 3], [4, 5, 7, 6]]


class Fan:
    """Triangles all around a cone of three quarter turns at `center`, cut along one ray from it to the border.

    The two sides of the cut are related by a quarter turn about the cone. The other vertices lie on a grid that float32
    resolves only near the origin.
    """

    def __init__(self, center: complex, rings: int = 5) -> None:
        rng = np.random.default_rng(7)
        rays = 3 * rings  # steps of 270 degrees; the last ray is the first one's other side
        step = 2.0**-20
        spokes = np.exp(0.5j * np.pi * np.arange(rays + 1) / rings) / 1.5
        place = np.outer(np.arange(1, rings + 1), spokes)
        place = (np.round(place.real / step) + 1j * np.round(place.imag / step)) * step
        place[:, :-1] += (rng.integers(-9, 9, place[:, :-1].shape) + 1j) * step
        place[:, -1] = -1j * place[:, 0]
        triangles, uv = [], []

        def number(ring: int, ray: int) -> int:
            return 1 + ring * rays + ray % rays

        for ray in range(rays):
            triangles.append([0, number(0, ray), number(0, ray + 1)])
            uv.append([0, place[0, ray], place[0, ray + 1]])
            for ring in range(rings - 1):
                a, b, c, d = (ring, ray), (ring + 1, ray), (ring + 1, ray + 1), (ring, ray + 1)
                for corners in ((a, b, c), (a, c, d)):
                    triangles.append([number(*corner) for corner in corners])
                    uv.append([place[corner] for corner in corners])
        z = np.array(uv) + center
        self.triangles = np.array(triangles, np.int32)
        self.uv = np.stack([z.real, z.imag], axis=-1)
        chain = [0] + [number(ring, 0) for ring in range(rings)]
        self.cut = np.stack([chain[:-1], chain[1:]], axis=1).astype(np.int32)
        self.island = np.zeros(len(triangles), np.int32)
        self.center = center

    def mismatch(self, uv: np.ndarray, center: complex) -> float:
        """Largest distance of a vertex of the cut, as float32 stores it, from its sister turned about the center."""
        z = uv.astype(np.float32).astype(np.float64) @ (1, 1j) - center
        worst = 0.0
        for vertex in np.unique(self.cut):
            copies = np.unique(z[self.triangles == vertex])
            assert len(copies) == (1 if vertex == 0 else 2)
            ends = copies if vertex else np.array([copies[0], copies[0]])
            worst = max(worst, min(abs(ends[1] + 1j * ends[0]), abs(ends[0] + 1j * ends[1])))
        return worst


@pytest.mark.parametrize("shift", [(0, 0), (3, -2), (40, 11), (-700, 5000)])
def test_both_sides_of_a_cut_match_exactly_wherever_an_island_goes(shift):
    fan = Fan(3 + 3j)
    assert fan.mismatch(fan.uv, fan.center) == 0
    moved = lattice.shift_islands(fan.triangles, fan.uv, fan.island, fan.cut, np.array([shift], float))
    assert fan.mismatch(moved, fan.center + complex(*shift)) == 0
    assert (moved == moved.astype(np.float32)).all()
    # Rounding of a place that float32 can only half or quarter resolve.
    assert np.abs(moved - fan.uv - shift).max() <= np.spacing(np.float32(2 * np.abs(moved).max()))


def test_a_plain_shift_of_what_is_far_away_would_not_match():
    fan = Fan(3 + 3j)
    assert fan.mismatch(fan.uv + np.array([-700, 5000]), fan.center + (-700 + 5000j)) > 0


def test_islands_that_stay_keep_their_bytes_and_faces_without_a_map_stay_without():
    fan = Fan(3 + 3j)
    fan.uv[4], fan.island[4] = np.nan, -1
    moved = lattice.shift_islands(fan.triangles, fan.uv, fan.island, fan.cut, np.zeros((1, 2)))
    assert moved.tobytes() == fan.uv.tobytes()


@pytest.mark.parametrize("turned", [0, 7])
def test_triangles_turned_the_other_way_count_as_sides(turned):
    """A surface whose triangles are not all turned alike has a cut between two that run along it the same way."""
    fan = Fan(3 + 3j)
    fan.triangles[turned::3] = fan.triangles[turned::3, ::-1]
    fan.uv[turned::3] = fan.uv[turned::3, ::-1]
    moved = lattice.shift_islands(fan.triangles, fan.uv, fan.island, fan.cut, np.array([[-700.0, 5000.0]]))
    assert fan.mismatch(moved, fan.center + (-700 + 5000j)) == 0
