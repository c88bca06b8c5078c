# SPDX-License-Identifier: GPL-3.0-or-later
"""Results in one line, for Blender's reports."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from ...core.text import counted, square_in_percent, stretch_in_percent
from .cells import inexact_cuts

if TYPE_CHECKING:
    import lsgp

    from .unwrapped import Unwrapped


NOTICEABLE = math.radians(1.0)
"""The least deviation of the texture's direction that is reported."""


def unwrap_summary(unwrapped: Unwrapped) -> str:
    """Islands, stretch, the part of the square that is used, overlaps, and how well the cuts of a seamless layout
    match."""
    result = unwrapped.result
    parts = [
        counted(int(result.island.max()) + 1, "island"),
        stretch_in_percent(result.distortion.l2_stretch),
    ]
    if unwrapped.square_used is not None:
        parts.append(square_in_percent(unwrapped.square_used))
    if result.overlap_area > 0:
        parts.append(f"{100 * result.overlap_area:.2g} % overlapping")
    if result.direction_error is not None and result.direction_error > NOTICEABLE:
        parts.append(f"texture up missed by {math.degrees(result.direction_error):.0f}° on average")
    if result.features is not None:
        parts.append(f"{100 * result.features.share:.0f} % of features straight")
    if result.seamless is not None:
        parts.append(_seam_summary(unwrapped))
    return ", ".join(parts)


def placement_summary(placement: lsgp.Placement, new: int) -> str:
    """new: how many of the cones were not marked before."""
    count = counted(len(placement.cones), "cone")
    return f"{count}, {new} of them new, {stretch_in_percent(placement.mapped_l2)}"


def quad_summary(mesh: lsgp.QuadMesh, across: int) -> str:
    """across: how many of the quads lie across seams of UV maps."""
    irregular = counted(len(mesh.irregular), "irregular vertex", "irregular vertices")
    return f"{len(mesh.quads):,} quads, {irregular}" + (f", {across:,} across seams of UV maps" if across else "")


def _seam_summary(unwrapped: Unwrapped) -> str:
    report = unwrapped.result.seamless
    tiles = f"{report.tiles:.4g} tiles across"
    if report.feature_share is not None:
        tiles += f", {100 * report.feature_share:.0f} % of creases along them"
    count = len(report.cut_errors)
    if not count:
        return f"{tiles}, no cuts"
    inexact = inexact_cuts(unwrapped)
    if report.error == 0:
        exact = "all exact"
    elif not inexact:
        exact = "all exact up to the rounding of UVs"
    else:
        exact = f"{inexact} of them off by up to {report.error:.2g} tiles"
    return f"{tiles}, {counted(count, 'cut')}, {exact}"
