# SPDX-License-Identifier: GPL-3.0-or-later
"""The tables that the demos print: every column states its ideal value and which direction is better.

Knows nothing of Blender.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

LABEL, CELL = 26, 12  # least widths, characters


@dataclass(frozen=True)
class Column:
    """title: its lines, one below the other. ideal: the value without any defect. better: in words. digits: after the
    point; None for two significant ones."""

    title: tuple[str, ...]
    ideal: float
    better: str = "lower"
    digits: int | None = 3

    def cell(self, value: float) -> str:
        return f"{value:.2g}" if self.digits is None else f"{value:.{self.digits}f}"


ISLANDS = Column(("islands",), 1, digits=0)
CUT_LENGTH = Column(("cut", "length"), 0, digits=1)
ANGLES = Column(("quasi-", "conformal"), 1)
AREA = Column(("area",), 1, "closer to 1")
STRETCH = Column(("L2", "stretch"), 1)
MISMATCH = Column(("seam length", "mismatch"), 0, digits=None)
FLIPPED = Column(("flipped", "triangles"), 0, digits=0)
OVERLAPPING = Column(("overlapping", "faces"), 0, digits=0)


def table(label: str, columns: Sequence[Column], rows: Iterable[tuple[str, Sequence[float]]]) -> str:
    """The rows as Markdown, below titles, ideal values and the better direction of every column."""
    height = max(len(column.title) for column in columns)
    titles = [("",) * (height - len(column.title)) + column.title for column in columns]
    lines = [_line(label if at == height - 1 else "", [title[at] for title in titles]) for at in range(height)]
    lines.append("|" + "-" * (LABEL + 1) + ("|" + "-" * (CELL + 1) + ":") * len(columns) + "|")
    lines.append(_line("ideal", [f"{column.ideal:g}" for column in columns]))
    lines.append(_line("better", [column.better for column in columns]))
    for name, values in rows:
        cells = [column.cell(value) for column, value in zip(columns, values, strict=True)]
        lines.append(_line(name, cells))
    return "\n".join(lines)


def _line(label: str, cells: Iterable[str]) -> str:
    return f"| {label:{LABEL}}" + "".join(f"| {cell:>{CELL}} " for cell in cells) + "|"
