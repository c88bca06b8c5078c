# SPDX-License-Identifier: GPL-3.0-or-later
"""Gutters of an image that one or several meshes show."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...core import native
from ...core.errors import Refused
from ...core.region import Region
from ...core.text import counted

# Coordinates are in single precision.
_ROUNDING = 1e-6


@dataclass(frozen=True, slots=True)
class Mapped:
    """Triangles of one mesh that show an image.  triangles: (m, 3). corner_uv: (m, 3, 2), in the unit square."""

    triangles: NDArray[np.int32]
    corner_uv: NDArray[np.float64]


def mapped_faces(region: Region, shows: NDArray[np.bool_]) -> Mapped:
    """The faces of a mesh, shows: (f,), that show an image.  Raises Refused where they leave the unit square."""
    used = shows[region.triangle_faces]
    uv = region.corner_uv[used]
    outside = ((uv < -_ROUNDING) | (uv > 1 + _ROUNDING)).any(axis=(1, 2))
    if outside.any():
        faces = len(np.unique(region.triangle_faces[used][outside]))
        raise Refused(
            f"{counted(faces, 'face')} of {int(shows.sum())} reach out of the UV square, where the image repeats and "
            "gutters cannot be beside all of its copies; pack the islands first, seamless layouts need no gutters"
        )
    return Mapped(region.surface.triangles[used], uv)


def extended(pixels: NDArray[Any], parts: list[Mapped], margin: float, *, normal_map: bool) -> NDArray[Any]:
    """The pixels of an image with the gutters of all these meshes.  Raises LsgpError.

    pixels: (height, width, channels), the top row first.
    """
    first, count = [], 0
    for part in parts:
        first.append(count)
        count += int(part.triangles.max(initial=-1)) + 1
    triangles = np.concatenate([part.triangles + start for part, start in zip(parts, first, strict=True)])
    surface = native.lsgp.Surface(np.zeros((count, 3)), triangles.astype(np.int32))
    corner_uv = np.concatenate([part.corner_uv for part in parts])
    return native.lsgp.pad_image(pixels, surface, corner_uv, margin, normal_map=normal_map)
