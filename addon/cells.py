# SPDX-License-Identifier: GPL-3.0-or-later
"""Seamless layouts placed and packed by whole cells, which leaves them seamless, and what is said of them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from . import native, reporting

if TYPE_CHECKING:
    import lsgp

    from .mesh_read import Region
    from .unwrapping import Unwrapped


def step(options: lsgp.Seamless) -> float:
    """The side of the cells that islands may be moved by: black squares of a checker stay black."""
    return options.cell * (2 if options.parity else 1)


def keep_places(region: Region, result: lsgp.Result, step: float) -> NDArray[np.float64]:
    """The layout with every island moved by whole cells to where its faces were, as nearly as that can be."""
    lattice = native.lsgp.lattice
    shifts = lattice.nearest_places(result.corner_uv, region.corner_uv, result.island, result.seamless.symmetry, step)
    return _moved(region, result, shifts)


def pack(solved: Sequence[Unwrapped]) -> list[NDArray[np.float64]]:
    """The coordinates of each object, the islands of all of them moved side by side by whole cells."""
    lattice = native.lsgp.lattice
    boxes = [lattice.island_boxes(unwrapped.corner_uv, unwrapped.result.island) for unwrapped in solved]
    # The lattice and its cell are the same for all objects.
    shifts = lattice.shelf_places(np.concatenate(boxes), solved[0].result.seamless.symmetry, solved[0].step)
    of_object = np.split(shifts, np.cumsum([len(part) for part in boxes])[:-1])
    return [_moved(unwrapped.region, unwrapped.result, part) for unwrapped, part in zip(solved, of_object, strict=True)]


def certified(unwrapped: Unwrapped) -> str:
    """What the certificate comes to: the tiles, the cuts, and how exactly both sides of them match."""
    result = unwrapped.result
    report = result.seamless
    tiles = f"{report.tiles:.4g} tiles across"
    count = len(report.cut_errors)
    if not count:
        return f"{tiles}, no cuts"
    # Two roundings of the largest coordinate, in cells.
    rounding = 2 * np.spacing(np.float32(np.nanmax(np.abs(unwrapped.corner_uv)))) / report.cell
    if report.error == 0:
        exact = "all exact"
    elif report.error <= rounding:
        exact = "all exact to the rounding of UVs"
    else:
        exact = f"{int((report.cut_errors > rounding).sum())} of them off by up to {report.error:.2g} tiles"
    return f"{tiles}, {reporting.counted(count, 'cut')}, {exact}"


def _moved(region: Region, result: lsgp.Result, shifts: NDArray[np.float64]) -> NDArray[np.float64]:
    return native.lsgp.lattice.shift_islands(
        region.surface.triangles, result.corner_uv, result.island, result.cut_edges, shifts
    )
