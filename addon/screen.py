# SPDX-License-Identifier: GPL-3.0-or-later
"""Between places on a mesh and pixels of a view."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Screen:
    """A view of a mesh.  matrix: (4, 4), from the mesh's own space to the view's cube. width, height: in pixels."""

    matrix: FloatArray
    width: int
    height: int

    def pixels(self, places: ArrayLike) -> FloatArray:
        """(k, 3) pixels and depth of (k, 3) places; NaN where they lie behind the view."""
        points = _with_one(places) @ self.matrix.T
        points[points[:, 3] <= 0] = np.nan
        cube = points[:, :3] / points[:, 3:]
        return np.c_[(cube[:, 0] + 1) * self.width / 2, (cube[:, 1] + 1) * self.height / 2, cube[:, 2]]

    def ray(self, x: float, y: float) -> tuple[FloatArray, FloatArray]:
        """Where the line of sight through a pixel begins, and its direction."""
        across, up = 2 * x / self.width - 1, 2 * y / self.height - 1
        ends = np.array([(across, up, -1, 1), (across, up, 1, 1)]) @ np.linalg.inv(self.matrix).T
        near, far = ends[:, :3] / ends[:, 3:]
        return near, (far - near) / np.linalg.norm(far - near)


def _with_one(places: ArrayLike) -> FloatArray:
    places = np.asarray(places, np.float64).reshape(-1, 3)
    return np.c_[places, np.ones(len(places))]
