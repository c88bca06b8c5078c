# SPDX-License-Identifier: GPL-3.0-or-later
"""Vertices that lie at the same place are joined where they are apart for display only."""

import numpy as np
from installed import addon

welding = addon.mesh.welding


# Two triangles with a common side, each with its own vertices.
POSITIONS = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], np.float32)
TRIANGLES = np.array([[0, 1, 2], [3, 4, 5]], np.int32)


def test_a_common_side_is_joined():
    assert welding.joined_vertices(POSITIONS, TRIANGLES).tolist() == [0, 1, 2, 1, 4, 2]


def test_what_is_only_near_is_not():
    near = POSITIONS.copy()
    near[3:] = np.nextafter(near[3:], np.float32(2))
    assert welding.joined_vertices(near, TRIANGLES).tolist() == list(range(6))


def test_the_two_sides_of_a_leaf_and_triangles_without_a_side_are_left_alone():
    leaf = np.concatenate([POSITIONS, POSITIONS[:3]])
    both = np.concatenate([TRIANGLES, [[6, 8, 7]]]).astype(np.int32)
    joined = welding.joined_vertices(leaf, both)
    assert joined[[0, 1, 2, 6, 7, 8]].tolist() == [0, 1, 2, 6, 7, 8]
    flat = np.concatenate([POSITIONS, [[5, 5, 5], [5, 5, 5], [6, 5, 5]]]).astype(np.float32)
    assert welding.joined_vertices(flat, both)[6:].tolist() == [6, 7, 8]
