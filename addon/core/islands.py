# SPDX-License-Identifier: GPL-3.0-or-later
"""Islands on their way to the packer."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, slots=True)
class Surroundings:
    """Faces beside a selection, of all objects, whose UVs stay.

    corner_uv: (k, 3, 2) float64, their triangles. size: square root of their area in the world, by density weights.
    """

    corner_uv: NDArray[np.float64]
    size: float


@dataclass(frozen=True, slots=True)
class Place:
    """Where the islands of a selection go.

    others: (k, 3, 2) float64, the triangles that stay beside them. box: (2, 2), the low and the high corner of the
    rectangle that the islands had; None: they had none. keeps_density: whether their size is that which they are to
    have, if there is room.
    """

    others: NDArray[np.float64]
    box: NDArray[np.float64] | None
    keeps_density: bool


@dataclass(frozen=True, slots=True)
class Islands:
    """Islands of one mesh that are to be packed.

    triangles: (m, 3) int32, vertices. corner_uv: (m, 3, 2) float64. island: (m,) int32, at least 0.
    pinned: (m, 3) bool; an island with a pinned corner is not moved.
    aspect: width over height of the image that the coordinates are for; 1 where they are not corrected for one.
    """

    triangles: NDArray[np.int32]
    corner_uv: NDArray[np.float64]
    island: NDArray[np.int32]
    pinned: NDArray[np.bool_]
    aspect: float

    @property
    def stays(self) -> NDArray[np.bool_]:
        """(m,), the triangles of islands with a pinned corner."""
        return np.isin(self.island, self.island[self.pinned.any(axis=1)])
