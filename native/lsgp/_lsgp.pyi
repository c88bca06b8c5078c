# SPDX-License-Identifier: GPL-3.0-or-later
"""Native verbs; call them through `lsgp.api`, which checks and converts."""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

_Floats = NDArray[np.float64]
_Indices = NDArray[np.int32]
_Places = NDArray[np.int64]
_Flags = NDArray[np.bool_]
_Surface = tuple[_Floats, _Indices, _Indices | None, _Indices, _Floats, _Floats, _Indices, _Floats]
"""Positions, triangles, edges, seams, importance, costs of cuts along the edges, borders, and directions."""
_Cones = tuple[_Indices, _Floats, _Flags]
"""Vertices, angles, and which of them are given."""
_Pins = tuple[_Indices, _Floats]
"""Corners and their positions."""
_CreaseOptions = tuple[float, _Indices, int]
"""Angle, sharp edges and the number of corners."""
_CutPreferences = tuple[tuple[float, float, float] | None, bool, _Indices, _Floats]
"""Front, creases, sharp edges and paint."""
_Progress = Callable[[float], bool | None] | None

def parameterize(
    surface: _Surface,
    cones: _Cones,
    options: dict[str, Any],
    pins: _Pins,
    progress: _Progress,
) -> dict[str, Any]: ...

class Solver:
    def __init__(
        self,
        surface: _Surface,
    ) -> None: ...
    def parameterize(
        self,
        cones: _Cones,
        options: dict[str, Any],
        pins: _Pins,
        progress: _Progress,
    ) -> dict[str, Any]: ...
    def place_cones(
        self,
        cones: _Cones,
        options: dict[str, Any],
        progress: _Progress,
    ) -> dict[str, Any]: ...

class GrabbedCut:
    @property
    def left(self) -> _Indices: ...
    @property
    def right(self) -> _Indices: ...
    def through(self, vertex: int) -> dict[str, Any]: ...

class CutRouter:
    def __init__(
        self,
        surface: _Surface,
    ) -> None: ...
    def grab(
        self,
        cuts: _Indices,
        path: _Indices,
        nodes: _Indices,
    ) -> GrabbedCut: ...

def overlapping_triangles(corner_uv: _Floats) -> _Indices: ...
def find_cuts(
    surface: _Surface,
    cones: _Indices,
    options: dict[str, Any],
    progress: _Progress,
) -> dict[str, Any]: ...
def crease_borders(
    surface: _Surface,
    cones: _Indices,
    options: _CreaseOptions,
    progress: _Progress,
) -> _Indices: ...
def feature_cones(surface: _Surface, progress: _Progress) -> tuple[_Indices, NDArray[np.float64]]: ...
def cut_costs(
    surface: _Surface,
    preferences: _CutPreferences,
    progress: _Progress,
) -> _Floats: ...
def prescribe_curvature(
    surface: _Surface,
    cones: _Cones,
    options: dict[str, Any],
    progress: _Progress,
) -> dict[str, Any]: ...
def build_ledger(
    surface: _Surface,
    cones: _Cones,
    options: dict[str, Any],
    gets_cones: bool,
) -> list[dict[str, Any]]: ...
def place_cones(
    surface: _Surface,
    cones: _Cones,
    options: dict[str, Any],
    progress: _Progress,
) -> dict[str, Any]: ...
def cone_gains(
    surface: _Surface,
    cones: _Cones,
    seam_mode: str,
    progress: _Progress,
) -> dict[str, Any]: ...
def measure_distortion(
    surface: _Surface,
    corner_uv: _Floats,
    cones: _Indices | None,
    progress: _Progress,
) -> dict[str, Any]: ...
def require_closed(surface: _Surface) -> None: ...
def extract_quads(
    surface: _Surface,
    corner_uv: _Floats,
    cell: float,
    progress: _Progress,
) -> dict[str, Any]: ...
def split_rows(data: bytes, comments: bool, continued: bool) -> tuple[_Places, _Places, _Places, _Places]: ...
def parse_floats(data: bytes, begins: _Places, ends: _Places, picks: _Places) -> tuple[_Floats, int]: ...
def parse_integers(data: bytes, begins: _Places, ends: _Places, picks: _Places) -> tuple[_Places, int]: ...
def slash_parts(data: bytes, begins: _Places, ends: _Places, picks: _Places, part: int) -> tuple[_Places, _Places]: ...
def distinct_tokens(data: bytes, begins: _Places, ends: _Places, picks: _Places) -> tuple[list[bytes], _Places]: ...
def format_rows(keyword: bytes, rows: _Floats, ending: bytes) -> bytes: ...
def format_faces(sizes: _Places, mapped: _Flags, vertices: _Places, coordinates: _Places) -> bytes: ...
def plain_lines(data: bytes, at: int, most: int) -> tuple[str, int, int]: ...
def replace_references(lines: bytes, numbers: _Places) -> bytes: ...
def polygon_edges(corners: _Indices, sizes: _Places, vertex_count: int) -> _Indices: ...
