# SPDX-License-Identifier: GPL-3.0-or-later
"""The distortion of each face."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...core import native
from ...core.identifiers import DISTORTION_ATTRIBUTES
from ...core.region import Region


def measure_faces(region: Region) -> dict[str, NDArray[np.float32]]:
    """(f,) values of each measure: a face has the area-weighted mean of its triangles, 0 without any.

    region: all faces of the mesh.  Raises InputError.
    """
    found = native.lsgp.triangle_distortion(region.surface, region.corner_uv)
    corners = region.surface.positions[region.surface.triangles]
    areas = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    face_count, largest = len(region.face_loop_start), np.finfo(np.float32).max
    means = {}
    for measure in DISTORTION_ATTRIBUTES:
        values = getattr(found, measure)
        weights = np.where(np.isnan(values), 0.0, areas)
        values = np.minimum(np.nan_to_num(values, posinf=largest), largest)
        total = np.bincount(region.triangle_faces, weights, minlength=face_count)
        summed = np.bincount(region.triangle_faces, weights * values, minlength=face_count)
        mean = np.divide(summed, total, out=np.zeros(face_count), where=total > 0)
        means[measure] = np.minimum(mean, largest).astype(np.float32)
    return means
