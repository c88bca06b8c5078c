# SPDX-License-Identifier: GPL-3.0-or-later
"""Puts pictures below each other, each under its heading: python guide_sheet.py OUT WIDTH HEADING PICTURE ...

WIDTH: of the sheet, pixels.
"""

import sys

from PIL import Image, ImageDraw, ImageFont

PAPER, INK = (246, 244, 238), (40, 46, 56)
HEADING, LETTERS = 0.055, 0.03  # heights, as shares of the width

out, width, *rest = sys.argv[1:]
headings, pictures = rest[::2], [Image.open(path).convert("RGB") for path in rest[1::2]]
wide = int(width)
high, above = round(wide * pictures[0].height / pictures[0].width), round(HEADING * wide)
sheet = Image.new("RGB", (wide, len(pictures) * (above + high)), PAPER)
draw, font = ImageDraw.Draw(sheet), ImageFont.load_default(LETTERS * wide)
for number, (heading, picture) in enumerate(zip(headings, pictures, strict=True)):
    top = number * (above + high)
    draw.text((wide / 2, top + above / 2), heading, INK, font, anchor="mm")
    sheet.paste(picture.resize((wide, high), Image.Resampling.LANCZOS), (0, top + above))
sheet.save(out, quality=82, optimize=True)
