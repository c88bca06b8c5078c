# SPDX-License-Identifier: GPL-3.0-or-later
"""Native verbs; call them through `lsgp.api`, which checks and converts."""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

_Floats = NDArray[np.float64]
_Indices = NDArray[np.int32]
_Flags = NDArray[np.bool_]

def parameterize(
    positions: _Floats,
    triangles: _Indices,
    edges: _Indices | None,
    seams: _Indices,
    importance: _Floats,
    cones: _Indices,
    angles: _Floats,
    has_angle: _Flags,
    options: dict[str, Any],
    pinned_corners: _Indices,
    pinned_uv: _Floats,
    progress: Callable[[float], bool | None] | None,
) -> dict[str, Any]: ...

class Solver:
    def __init__(
        self,
        positions: _Floats,
        triangles: _Indices,
        edges: _Indices | None,
        seams: _Indices,
        importance: _Floats,
    ) -> None: ...
    def parameterize(
        self,
        cones: _Indices,
        angles: _Floats,
        has_angle: _Flags,
        options: dict[str, Any],
        pinned_corners: _Indices,
        pinned_uv: _Floats,
        progress: Callable[[float], bool | None] | None,
    ) -> dict[str, Any]: ...

def find_cuts(
    positions: _Floats,
    triangles: _Indices,
    edges: _Indices | None,
    seams: _Indices,
    cones: _Indices,
    options: dict[str, Any],
) -> dict[str, Any]: ...
def prescribe_curvature(
    positions: _Floats,
    triangles: _Indices,
    edges: _Indices | None,
    seams: _Indices,
    cones: _Indices,
    angles: _Floats,
    has_angle: _Flags,
    options: dict[str, Any],
) -> dict[str, Any]: ...
def place_cones(
    positions: _Floats,
    triangles: _Indices,
    edges: _Indices | None,
    seams: _Indices,
    cones: _Indices,
    angles: _Floats,
    has_angle: _Flags,
    options: dict[str, Any],
    progress: Callable[[float], bool | None] | None,
) -> dict[str, Any]: ...
def cone_gains(
    positions: _Floats,
    triangles: _Indices,
    edges: _Indices | None,
    seams: _Indices,
    cones: _Indices,
    angles: _Floats,
    has_angle: _Flags,
    seam_mode: str,
    progress: Callable[[float], bool | None] | None,
) -> dict[str, Any]: ...
def measure_distortion(
    positions: _Floats,
    triangles: _Indices,
    edges: _Indices | None,
    seams: _Indices,
    corner_uv: _Floats,
    cones: _Indices | None,
) -> dict[str, Any]: ...
