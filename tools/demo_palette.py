# SPDX-License-Identifier: GPL-3.0-or-later
"""Reduces a PNG to a palette of 256 colours in place, light enough for a README: python demo_palette.py FILE.png

Plain median cut counts pixels and so gives the thin coloured lines of a large pale picture no entries of their own;
here colourful pixels count several times.
"""

import sys

import numpy as np
from PIL import Image

WEIGHT_OF_COLOUR = 4
COLOURFUL = 60  # spread between the largest and the smallest channel, of 255

path = sys.argv[1]
picture = Image.open(path).convert("RGB")
pixels = np.asarray(picture).reshape(-1, 3)
colourful = pixels[np.ptp(pixels, axis=1) > COLOURFUL]
sample = np.vstack([pixels, np.repeat(colourful, WEIGHT_OF_COLOUR, axis=0)])
palette = Image.fromarray(sample[None]).quantize(256)
picture.quantize(palette=palette, dither=Image.Dither.NONE).save(path, optimize=True)
