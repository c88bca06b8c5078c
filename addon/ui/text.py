# SPDX-License-Identifier: GPL-3.0-or-later
"""Texts in panels of any width."""

from __future__ import annotations

from collections.abc import Iterable

import blf
import bpy

# The font and size in points of Blender's panels.
FONT, POINTS = 0, 11
# Pixels besides the text, at a scale of 1: margins of panel and box with the tabs, and an icon.
MARGIN, ICON = 60, 40
# Width of an unknown region, and the least one, at a scale of 1.
WIDTH, LEAST = 240, 160


def wrapped(context: bpy.types.Context, text: str, indent: int = 0) -> list[str]:
    """The text in lines that fit into the region.  indent: pixels used by something else, at a scale of 1."""
    # It is 0 without a window.
    scale = context.preferences.system.ui_scale or 1.0
    blf.size(FONT, POINTS * scale)
    width = max(WIDTH if context.region is None else context.region.width / scale, LEAST) - MARGIN - indent
    lines: list[str] = []
    for word in text.split():
        longer = f"{lines[-1]} {word}" if lines else word
        if lines and blf.dimensions(FONT, longer)[0] <= width * scale:
            lines[-1] = longer
        else:
            lines.append(word)
    return lines


def draw_wrapped(layout: bpy.types.UILayout, context: bpy.types.Context, text: str, icon: str = "NONE") -> None:
    """The text as labels in a column of their own."""
    column = layout.column(align=True)
    column.scale_y = 0.8
    for number, line in enumerate(wrapped(context, text, 0 if icon == "NONE" else ICON)):
        column.label(text=line, icon="NONE" if icon == "NONE" else icon if number == 0 else "BLANK1")


def draw_table(
    layout: bpy.types.UILayout, header: tuple[str, ...], rows: Iterable[tuple[str, ...]], first: float = 0.5
) -> None:
    """Rows of texts, with the first column on the left and the others, of one width, aligned to the right.

    first: the share of the first column.
    """
    column = layout.column(align=True)
    column.scale_y = 0.85
    for row in [header, *rows]:
        rest = column.row(align=True)
        rest.active = row is not header
        for place, text in enumerate(row):
            columns_left = len(row) - place
            part = rest.split(factor=first if place == 0 else 1 / columns_left) if columns_left > 1 else rest
            cell = part.row()
            cell.alignment = "LEFT" if place == 0 else "RIGHT"
            cell.label(text=text)
            rest = part
