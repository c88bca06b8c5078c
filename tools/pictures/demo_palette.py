# SPDX-License-Identifier: GPL-3.0-or-later
"""Reduces a PNG to a palette of 256 colors in place, light enough for a README: python demo_palette.py FILE.png

Median cut alone counts pixels and so leaves the thin colored lines of a large pale picture hardly any entries. Here a
color counts the square root of its pixels. Dithering hides the steps in the soft shadows.
"""

import sys

import numpy as np
from PIL import Image

path = sys.argv[1]
picture = Image.open(path).convert("RGB")
colors, count = np.unique(np.asarray(picture).reshape(-1, 3), axis=0, return_counts=True)
sample = np.repeat(colors, np.ceil(np.sqrt(count)).astype(int), axis=0)
palette = Image.fromarray(sample[None]).quantize(256, kmeans=3)
picture.quantize(palette=palette, dither=Image.Dither.FLOYDSTEINBERG).save(path, optimize=True)
