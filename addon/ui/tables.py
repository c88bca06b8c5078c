# SPDX-License-Identifier: GPL-3.0-or-later
"""The tables of the sidebar as rows of texts."""

from __future__ import annotations

import math
from typing import Any

import bpy

from ..core.length_units import length_unit
from ..core.text import counted, square_in_percent, stretch_in_percent
from ..mesh.reports import Report

Row = tuple[str, ...]

QUALITY_HEADER = ("", "Value", "Ideal")
SEAM_HEADER = ("Rotation", "Translation", "Texels")

# Further cuts are only counted.
SHOWN_CUTS = 8

EXACT = "exact"
# Smaller errors are those of the numbers that it was computed with.
ROUNDING = 1e-9


def in_one_line(report: Report) -> str:
    """As "3 islands, 1.6 % stretch, 52 % of the square used"."""
    parts = [counted(report.islands, "island"), stretch_in_percent(report.distortion["l2_stretch"])]
    if report.square_used is not None:
        parts.append(square_in_percent(report.square_used))
    return ", ".join(parts)


def quality_rows(report: Report) -> list[Row]:
    """The figures of a map, each with its ideal value."""
    figures, seams = report.distortion, report.seams
    rows = [
        ("Angles", f"{figures['quasi_conformal']:.3f}", "1"),
        ("Areas", f"{figures['area']:.3f}", "1"),
        ("Areas, 10 %", f"{figures['area_p10']:.3f}", "1"),
        ("Areas, 90 %", f"{figures['area_p90']:.3f}", "1"),
        ("Stretch", f"{figures['l2_stretch']:.3f}", "1"),
        ("Sides of Cuts", _small(seams["sister_ratio_max"] - 1), EXACT),
        ("Rotations of Cuts", _small(math.degrees(seams["rotation_residual"]), "°"), EXACT),
        ("Translations of Cuts", _small(seams["translation_residual"]), EXACT),
        ("Flipped Faces", str(len(report.flipped)), "0"),
        ("Overlapping Faces", str(len(report.overlapping)) if report.overlaps_known else "?", "0"),
    ]
    if report.drawn:
        rows.append(("Texture Up, Largest Error", f"{math.degrees(max(report.drawn_errors)):.2f}°", "0"))
    return rows


def texel_rows(report: Report, scene: bpy.types.Scene, size: tuple[int, int]) -> list[Row]:
    """The texel density of a map, (label, value, ""), in the scene's unit.  size: of the texture, in pixels."""
    if report.texel_density is None:
        return []
    unit = length_unit(scene)
    pixels = math.sqrt(size[0] * size[1]) * unit.size
    labels = (f"px/{unit.name}, {name}" for name in ("Least", "Median", "Most"))
    return [(label, f"{value * pixels:.4g}", "") for label, value in zip(labels, report.texel_density, strict=True)]


def seam_summary(certificate: dict[str, Any]) -> str:
    """One sentence on how well the cuts of a seamless layout match."""
    count = len(certificate["cuts"])
    if not count:
        return "No cuts, so no seam"
    cuts = "The cut matches" if count == 1 else f"All {count} cuts match"
    if certificate["error"] == 0:
        return f"{cuts} exactly"
    size = certificate["texture_size"]
    return f"{cuts} up to {_small(certificate['error_texels'])} texels of {size} x {size}"


def seam_rows(certificate: dict[str, Any]) -> list[Row]:
    """The cuts, the worst first, with the map from one side to the other."""
    rotation_order = certificate["rotation_order"]
    cuts = sorted(certificate["cuts"], key=lambda cut: -cut["error_texels"])
    return [
        (
            f"{cut['turns'] * 360 // rotation_order}°",
            f"{cut['translation'][0]}, {cut['translation'][1]}",
            _small(cut["error_texels"]),
        )
        for cut in cuts[:SHOWN_CUTS]
    ]


def _small(value: float, unit: str = "") -> str:
    """An error that should be 0."""
    return EXACT if value < ROUNDING else f"{value:.0e}".replace("e-0", "e-").replace("e+0", "e+") + unit
