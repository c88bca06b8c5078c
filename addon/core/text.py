# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers in sentences."""

from __future__ import annotations

import math


def counted(number: int, noun: str, plural: str | None = None) -> str:
    """Number and noun: "1 cone", "8 cones", "2 meshes".  plural: where it is not the noun with an s."""
    return f"{number} {noun}" if number == 1 else f"{number} {plural or noun + 's'}"


def degrees(angle: float, *, signed: bool = False) -> str:
    """An angle in radians as text in degrees."""
    shown = round(math.degrees(angle), 1) + 0.0  # never "-0.0"
    return f"{shown:+.1f}°" if signed else f"{shown:.1f}°"


def stretch_in_percent(l2_stretch: float) -> str:
    """As "1.6 % stretch"."""
    return f"{max(100 * (l2_stretch - 1), 0.0):.1f} % stretch"


def square_in_percent(used: float) -> str:
    """As "52 % of the square used"."""
    return f"{100 * used:.0f} % of the square used"
