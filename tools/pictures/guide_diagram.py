# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws what the figures of the quality table mean.

python tools/pictures/guide_diagram.py docs/images/guide-quality.svg
"""

from __future__ import annotations

import sys
from itertools import accumulate
from pathlib import Path

PAPER, INK, SURFACE, LAYOUT, CUT = "#f6f4ee", "#282e38", "#8a93a0", "#7796a8", "#d6336c"
WIDTH, HEIGHT, TOP = 960, 270, 128
HEADINGS = ((165, "quasi-conformal"), (480, "area"), (792, "seam length mismatch"))


def text(x: float, y: float, words: str, size: int = 15, weight: str = "normal") -> str:
    return (
        f'<text x="{x:g}" y="{y:g}" font-size="{size}" font-weight="{weight}" fill="{INK}" '
        f'text-anchor="middle" font-family="sans-serif">{words}</text>'
    )


def ellipse(x: float, y: float, rx: float, ry: float, turn: float = 0) -> str:
    return f'<ellipse cx="{x:g}" cy="{y:g}" rx="{rx:g}" ry="{ry:g}" transform="rotate({turn:g} {x:g} {y:g})" {FILLED}/>'


def square(x: float, y: float, side: float, style: str) -> str:
    return f'<rect x="{x - side / 2:g}" y="{y - side / 2:g}" width="{side:g}" height="{side:g}" {style}/>'


def arrow(x: float, y: float) -> str:
    return f'<path d="M{x - 14:g} {y:g}h22m-7 -6l7 6l-7 6" fill="none" stroke="{INK}" stroke-width="2"/>'


def cut(x: float, *sides: list[float]) -> str:
    """Both sides of a cut, their edges one below the other; stripes of a texture lead from vertex to sister vertex."""
    places = [[(x + k * 70 + y / 5, TOP - 60 + y) for y in accumulate(side, initial=0)] for k, side in enumerate(sides)]
    marks = [f'<path d="M{a:g} {b:g}L{c:g} {d:g}" {DASHED}/>' for (a, b), (c, d) in zip(*places, strict=True)]
    for side in places:
        marks.append(f'<polyline points="{" ".join(f"{u:g},{v:g}" for u, v in side)}" fill="none" {STROKE}/>')
        marks += [f'<circle cx="{u:g}" cy="{v:g}" r="5.5" fill="{CUT}"/>' for u, v in side]
    return "".join(marks)


DASHED = f'fill="none" stroke="{SURFACE}" stroke-width="2.5" stroke-dasharray="5 4"'
FILLED = f'fill="{LAYOUT}" fill-opacity="0.75" stroke="{INK}" stroke-width="1.5"'
STROKE = f'stroke="{CUT}" stroke-width="5" stroke-linecap="round"'


def diagram() -> str:
    parts = [
        *(
            text(x, 32, words, 18, "bold")
            for x, words in ((165, "quasi-conformal"), (480, "area"), (795, "seam length mismatch"))
        ),
        f'<circle cx="80" cy="{TOP}" r="40" {DASHED}/>',
        arrow(150, TOP),
        ellipse(235, TOP, 49, 33, -25),
        text(165, 222, "A small circle on the surface becomes"),
        text(165, 244, "an ellipse in the layout, 1.5 times as long"),
        *(square(390, TOP + dy, 44, DASHED) for dy in (-32, 32)),
        *(arrow(455, TOP + dy) for dy in (-32, 32)),
        square(545, TOP - 32, 68, FILLED),
        square(545, TOP + 40, 26, FILLED),
        text(480, 222, "Squares of one size get more"),
        text(480, 244, "or less room than their share"),
        cut(655, [38, 45, 36], [38, 45, 36]),
        text(702, 222, "0: both sides fit,"),
        text(702, 244, "stripes run on"),
        cut(822, [38, 45, 36], [38 / 1.4, 45 / 1.2, 36 * 1.4]),
        text(870, 222, "0.4: each stripe"),
        text(870, 244, "meets another place"),
    ]
    head = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" width="{WIDTH}" height="{HEIGHT}">'
    paper = f'<rect width="{WIDTH}" height="{HEIGHT}" rx="8" fill="{PAPER}"/>'
    return "\n".join([head, paper, *parts, "</svg>"]) + "\n"


if __name__ == "__main__":
    Path(sys.argv[1]).write_text(diagram(), encoding="utf-8")
