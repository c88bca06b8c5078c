# SPDX-License-Identifier: GPL-3.0-or-later
"""The tables of the sidebar, as rows of texts."""

from __future__ import annotations

import math
from typing import Any

from ..reports import Report

Row = tuple[str, ...]

QUALITY_HEADER = ("", "Value", "Ideal")
SEAM_HEADER = ("Turn", "Shift", "Texels")

# The other cuts are summed up in a line.
SHOWN_CUTS = 8


def quality_rows(report: Report) -> list[Row]:
    """The figures of a map, each with its ideal."""
    figures, seams = report.distortion, report.seams
    return [
        ("Angles", f"{figures['quasi_conformal']:.3f}", "1"),
        ("Areas", f"{figures['area']:.3f}", "1"),
        ("Areas, 10 %", f"{figures['area_p10']:.3f}", "1"),
        ("Areas, 90 %", f"{figures['area_p90']:.3f}", "1"),
        ("Stretch", f"{figures['l2_stretch']:.3f}", "1"),
        ("Sides of Cuts", _small(seams["sister_ratio_max"] - 1), "0"),
        ("Turns of Cuts", f"{_small(math.degrees(seams['rotation_residual']))}°", "0°"),
        ("Shifts of Cuts", _small(seams["translation_residual"]), "0"),
        ("Flipped Faces", str(len(report.flipped)), "0"),
        ("Overlapping Faces", str(len(report.overlapping)), "0"),
    ]


def seam_summary(certificate: dict[str, Any]) -> str:
    """How well the cuts of a seamless layout match, in a sentence."""
    count = len(certificate["cuts"])
    if not count:
        return "No cuts, so no seam"
    cuts = "The cut matches" if count == 1 else f"All {count} cuts match"
    if certificate["error"] == 0:
        return f"{cuts} exactly"
    size = certificate["texture_size"]
    return f"{cuts} up to {_small(certificate['error_texels'])} texels of {size} x {size}"


def seam_rows(certificate: dict[str, Any]) -> list[Row]:
    """The cuts, the worst first: how one side lies to the other."""
    symmetry = certificate["symmetry"]
    cuts = sorted(certificate["cuts"], key=lambda cut: -cut["error_texels"])
    return [
        (
            f"{cut['turns'] * 360 // symmetry}°",
            f"{cut['translation'][0]}, {cut['translation'][1]}",
            _small(cut["error_texels"]),
        )
        for cut in cuts[:SHOWN_CUTS]
    ]


def _small(value: float) -> str:
    return "0" if value == 0 else f"{value:.0e}".replace("e-0", "e-").replace("e+0", "e+")
