# SPDX-License-Identifier: GPL-3.0-or-later
"""Seamless layouts placed and packed by whole cells, which keeps them seamless."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ...core import native

if TYPE_CHECKING:
    import lsgp

    from ...core.region import Region
    from .unwrapped import Unwrapped


def step(options: lsgp.Seamless) -> float:
    """Side of the cells by which islands may be moved: two tiles with parity, so that black squares stay black."""
    return options.cell * (2 if options.parity else 1)


def keep_places(region: Region, result: lsgp.Result, step: float) -> NDArray[np.float64]:
    """The layout with each island moved by whole cells as near as possible to where its faces were, (m, 3, 2)."""
    lattice = native.lsgp.lattice
    shifts = lattice.nearest_places(
        result.corner_uv, region.corner_uv, result.island, result.seamless.rotation_order, step
    )
    return _moved(region, result, shifts)


def pack(solved: Sequence[Unwrapped]) -> list[NDArray[np.float64]]:
    """The coordinates of each map, (m, 3, 2), with all islands moved side by side by whole cells."""
    lattice = native.lsgp.lattice
    boxes = [lattice.island_boxes(unwrapped.corner_uv, unwrapped.result.island) for unwrapped in solved]
    # The lattice and its cell are the same for all objects.
    shifts = lattice.shelf_places(np.concatenate(boxes), solved[0].result.seamless.rotation_order, solved[0].step)
    of_object = np.split(shifts, np.cumsum([len(part) for part in boxes])[:-1])
    return [_moved(unwrapped.region, unwrapped.result, part) for unwrapped, part in zip(solved, of_object, strict=True)]


def inexact_cuts(unwrapped: Unwrapped) -> int:
    """How many cuts of a seamless layout do not match up to the rounding of 32-bit UVs."""
    report = unwrapped.result.seamless
    # Two roundings of the largest coordinate, in cells.
    rounding = 2 * np.spacing(np.float32(np.nanmax(np.abs(unwrapped.corner_uv)))) / report.cell
    return int((report.cut_errors > rounding).sum()) if report.error > rounding else 0


def _moved(region: Region, result: lsgp.Result, shifts: NDArray[np.float64]) -> NDArray[np.float64]:
    return native.lsgp.lattice.shift_islands(
        region.surface.triangles, result.corner_uv, result.island, result.cut_edges, shifts
    )
