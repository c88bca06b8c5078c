# SPDX-License-Identifier: GPL-3.0-or-later
"""Puts pictures below each other, each under its heading: python guide_sheet.py OUT.jpg HEADING PICTURE ..."""

import sys

from PIL import Image, ImageDraw, ImageFont

PAPER, INK = (246, 244, 238), (40, 46, 56)
WIDTH, HEADING, LETTERS = 800, 44, 24

out, *rest = sys.argv[1:]
headings, pictures = rest[::2], [Image.open(path).convert("RGB") for path in rest[1::2]]
height = round(WIDTH * pictures[0].height / pictures[0].width)
sheet = Image.new("RGB", (WIDTH, len(pictures) * (HEADING + height)), PAPER)
draw, font = ImageDraw.Draw(sheet), ImageFont.load_default(LETTERS)
for number, (heading, picture) in enumerate(zip(headings, pictures, strict=True)):
    top = number * (HEADING + height)
    draw.text((WIDTH / 2, top + HEADING / 2), heading, INK, font, anchor="mm")
    sheet.paste(picture.resize((WIDTH, height), Image.Resampling.LANCZOS), (0, top + HEADING))
sheet.save(out, quality=82, optimize=True)
