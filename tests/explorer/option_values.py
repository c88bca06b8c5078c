# SPDX-License-Identifier: GPL-3.0-or-later
"""Values of every option of every verb that are worth trying: all choices, usual numbers and their limits."""

from __future__ import annotations

import dataclasses
from typing import Any

import lsgp

Values = dict[str, list[Any]]

LATTICES = ["square", "stripe", "translation", "triangle", "hexagon"]

# Those of a seamless layout; `None` in `OPTIONS["seamless"]` is a layout that is none.
SEAMLESS: Values = {
    "lattice": LATTICES,
    "tiles": [None, 1, 4, 12, 48, 0.3],
    "tile_size": [None, 0.1, 1.0],
    "parity": [False, True],
    "feature_places": ["anywhere", "half", "whole"],
    "coarse_grid": ["refine", "merge", "relax"],
    "cell": [1.0, 0.125, 2.0**-10],
}

OPTIONS: Values = {
    "prescription": [None, "least-distortion", "harmonic", "straightness", "manual"],
    "unfold": ["poisson", "spectral"],
    "method": ["lsgp", "lscm"],
    "seams": ["follow", "boundary", "ignore"],
    "border": ["free", "straight", "strips"],
    "loop_turning": ["none", "flat", "any", "elsewhere"],
    "seamless": ["none", "asked for"],
    "mode": ["conformal", "low-stretch"],
    "stretch": [1.0, 0.5, 0.0],
    "straighten": [False, True],
    "repair": [True, False],
    "overlaps": ["keep", "split"],
    "compact": ["off", "sparing", "full"],
    "mirrored_cuts": [False, True],
    "follow_strokes": [True, False],
    "square_share": [1.0, 0.1, 4.0],
    "factorization": ["automatic", "cut", "sparse"],
    "threads": [0, 1, 3],
}

# Now and then: numbers at the limits of what makes sense, and beyond.
RARE_OPTIONS: Values = {
    "stretch": [-0.1, 1.5, float("nan"), float("inf"), 1e-300],
    "square_share": [0.0, -1.0, 1e-300, 100.5, float("nan")],
    "threads": [1024, 1025],
}
RARE_SEAMLESS: Values = {
    "tiles": [0, -3, float("nan"), float("inf"), 0.01, 1e4, 1e9],
    "tile_size": [0.0, -1.0, float("nan"), 1e-9, 1e9],
    "cell": [0.0, 0.3, 8.0, -1.0, float("nan"), 2.0**-40, 2.0**40],
}

PLACEMENT: Values = {
    "count": [None, 0, 1, 3, 8],
    "target": [1.05, 1.01, 1.5],
    "lattice": [None, *LATTICES],
    "prefer_sharp": [False, True],
    "follow_strokes": [True, False],
    "symmetric": [False, True],
    "mirror": ["none", "through the middle"],
    "seams": ["follow", "boundary", "ignore"],
    "border": ["free", "strips"],
    "threads": [0, 1, 3],
}
RARE_PLACEMENT: Values = {
    "target": [1.0, 0.0, -1.0, float("nan"), float("inf"), 1.0001, 1e9],
    "count": [-1, 100, 2**31 - 1],
}

AUTO: Values = {
    "preset": ["paint", "bake", "tile"],
    "count": [None, 0, 1, 5],
    "target": [1.05, 1.01, 1.5],
    "symmetric": [True, False],
    "creases": [True, False],
    "pack": [None, "tight", "shelves"],
    "effort": [None, "quick"],
    "udim": [None, 1, 2, 7],
    "stack": [None, "same", "mirrored"],
    "up": ["none", "random"],
    "weights": ["usual", "random", "extreme"],
    "seconds": [None, 1e9],
}
RARE_AUTO: Values = {
    "count": [-1, 100],
    "target": [1.0, float("nan"), 1.0001, 1e9],
    "udim": [0, 100, 101],
    "seconds": [0.0, 1e-9, float("nan")],
}


def _names(options: type) -> set[str]:
    return {field.name for field in dataclasses.fields(options)}


assert set(OPTIONS) == _names(lsgp.Options), "an option of parameterize has no values to try"
assert set(SEAMLESS) == _names(lsgp.Seamless), "an option of seamless layouts has no values to try"
