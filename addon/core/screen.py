# SPDX-License-Identifier: GPL-3.0-or-later
"""Projection between points of a mesh and pixels of a view."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Screen:
    """A view of a mesh.  matrix: (4, 4), from the mesh's own space to clip space. width, height: in pixels."""

    matrix: FloatArray
    width: int
    height: int

    def pixels(self, points: ArrayLike) -> FloatArray:
        """(k, 3) pixel coordinates and depth of (k, 3) points; NaN where they lie behind the viewer."""
        clip = _homogeneous(points) @ self.matrix.T
        clip[clip[:, 3] <= 0] = np.nan
        cube = clip[:, :3] / clip[:, 3:]
        return np.c_[(cube[:, 0] + 1) * self.width / 2, (cube[:, 1] + 1) * self.height / 2, cube[:, 2]]

    def ray(self, x: float, y: float) -> tuple[FloatArray, FloatArray]:
        """Start and unit direction of the line of sight through a pixel."""
        across, up = 2 * x / self.width - 1, 2 * y / self.height - 1
        ends = np.array([(across, up, -1, 1), (across, up, 1, 1)]) @ np.linalg.inv(self.matrix).T
        near, far = ends[:, :3] / ends[:, 3:]
        return near, (far - near) / np.linalg.norm(far - near)


def _homogeneous(points: ArrayLike) -> FloatArray:
    points = np.asarray(points, np.float64).reshape(-1, 3)
    return np.c_[points, np.ones(len(points))]
