# SPDX-License-Identifier: GPL-3.0-or-later
"""The certificate of a seamless layout: the transition of every cut, as data for the report and as lines of text."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from .base import arguments
from .base.counted import counted
from .results import SeamlessReport

# Rows of the table; one line summarizes the remaining cuts.
SHOWN_CUTS = 12


def certificate(report: SeamlessReport, texture_size: int) -> dict[str, Any]:
    """The certificate as data.

    The left side of a cut is mapped to its right side by a rotation of `turns` / `rotation_order` full turns and then a
    translation by `translation`: integer multiples of the two vectors of `basis`, which are (u, v) in cells. `cell` is
    the side of a cell in texture coordinates, `error` the largest error of a cut in cells; error_texels refers to a
    texture of `texture_size` texels a side that covers the unit square.  Raises InputError.
    """
    texels = _texels(report, texture_size)
    cuts = zip(
        report.cut_nodes.tolist(),
        report.cut_turns.tolist(),
        report.cut_translations.tolist(),
        report.cut_errors.tolist(),
        strict=True,
    )
    return {
        "rotation_order": report.rotation_order,
        "basis": _basis(report.rotation_order),
        "tiles": report.tiles,
        "tile_size": report.tile_size,
        "cell": report.cell,
        "texture_size": texture_size,
        "energy_before": report.energy_before,
        "energy_after": report.energy_after,
        "error": report.error,
        "error_texels": report.error * texels,
        "cuts": [
            {"tail": tail, "head": head, "turns": turns, "translation": translation, "error_texels": error * texels}
            for (tail, head), turns, translation, error in cuts
        ],
        "flat_cones": report.flat_cones.tolist(),
        "merged_cones": report.merged_cones.tolist(),
        "relaxed_cones": report.relaxed_cones.tolist(),
        "feature_share": report.feature_share,
    }


def certificate_table(report: SeamlessReport, texture_size: int) -> str:
    """The certificate as lines of text: one row per cut, the worst first, and a summary of the rest."""
    texels = _texels(report, texture_size)
    unit = "tiles" if report.cell == 1 else "cells"
    count = len(report.cut_errors)
    lines = [
        f"seamless: {counted(count, 'cut')}, {_off(report.error * texels)} texels off at "
        f"{texture_size} x {texture_size}; {report.tiles:.4g} {unit} across, {report.tile_size:.4g} each on the "
        f"surface; energy {report.energy_before:.4f} before, {report.energy_after:.4f} after rounding",
    ]
    if not count:
        return lines[0]
    lines.append(
        f"{'from vertex':>11}{'to vertex':>11}{'rotation':>10}{f'translation in {unit}':>23}{'texels off':>12}"
    )
    order = np.argsort(-report.cut_errors, kind="stable")
    for cut in order[:SHOWN_CUTS].tolist():
        tail, head = report.cut_nodes[cut].tolist()
        turns = int(report.cut_turns[cut])
        rotation = f"{turns}/{report.rotation_order}" if turns else "0"
        a, b = report.cut_translations[cut].tolist()
        lines.append(f"{tail:>11}{head:>11}{rotation:>10}{f'{a}, {b}':>23}{_off(report.cut_errors[cut] * texels):>12}")
    rest = report.cut_errors[order[SHOWN_CUTS:]]
    if len(rest):
        worst = rest.max() * texels
        lines.append(f"... and {len(rest)} more, {'all exact' if worst == 0 else f'at most {_off(worst)} texels off'}")
    return "\n".join(lines)


def _texels(report: SeamlessReport, texture_size: int) -> float:
    """On the side of a cell."""
    arguments.require_type("report", report, SeamlessReport)
    return report.cell * arguments.whole_number("texture_size", texture_size, 1, "pass the number of texels of a side")


def _basis(rotation_order: int) -> list[list[float]]:
    """The vectors between neighboring lattice points: of unit squares, or of triangles of side 1."""
    return [[1.0, 0.0], [0.5, math.sqrt(3) / 2] if rotation_order in (3, 6) else [0.0, 1.0]]


def _off(texels: float) -> str:
    return "0" if texels == 0 else f"{texels:.1e}"
