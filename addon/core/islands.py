# SPDX-License-Identifier: GPL-3.0-or-later
"""Islands on their way to the packer."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

# Across the axis, of an edge's length: less is rounding.
_TILT = 1e-3


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

    def border_edges(self) -> NDArray[np.complex128]:
        """(b,), from end to end, u + iv: those that one triangle of an island alone has."""
        z = self.corner_uv @ (1, 1j)
        ends = np.sort(np.stack([z, np.roll(z, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
        edges, uses = np.unique(np.column_stack([np.repeat(self.island, 3), ends]), axis=0, return_counts=True)
        return np.diff(edges[uses == 1, 1:]).ravel()


def lie_along_axes(parts: Sequence[Islands]) -> bool:
    """Whether most of the islands' borders is parallel to one of the axes, as where straight sides were aligned."""
    edges = np.concatenate([part.border_edges() for part in parts])
    length = np.abs(edges)
    aligned = np.minimum(np.abs(edges.real), np.abs(edges.imag)) <= _TILT * length
    return bool(2 * length[aligned].sum() >= length.sum())
