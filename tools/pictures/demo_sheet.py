# SPDX-License-Identifier: GPL-3.0-or-later
"""Joins pictures into one row with headings: python demo_sheet.py OUT.png HEADING ... PICTURE.png ...

As many in a row as there are headings, one above each column; pictures of a column have the same size.
"""

import sys
from itertools import accumulate
from pathlib import Path

from PIL import Image, ImageDraw, ImageFont

PAPER, INK = (246, 244, 238), (40, 46, 56)
GAP, HEADING, LETTERS = 10, 52, 28

out, *rest = sys.argv[1:]
headings = [text for text in rest if Path(text).suffix != ".png"]
pictures = [Image.open(path).convert("RGBA") for path in rest[len(headings) :]]
columns = len(headings)
widths = [picture.width for picture in pictures[:columns]]
lefts = list(accumulate((width + GAP for width in widths[:-1]), initial=0))
step = pictures[0].height + GAP
sheet = Image.new("RGBA", (lefts[-1] + widths[-1], HEADING + len(pictures) // columns * step - GAP), PAPER)
draw, font = ImageDraw.Draw(sheet), ImageFont.load_default(LETTERS)
for heading, left, width in zip(headings, lefts, widths, strict=True):
    draw.text((left + width / 2, HEADING / 2), heading, INK, font, anchor="mm")
for number, picture in enumerate(pictures):
    row, column = divmod(number, columns)
    sheet.alpha_composite(picture, (lefts[column], HEADING + row * step))
sheet.convert("RGB").save(out)
