# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces on their way into the compiled library, with coordinates moved by units in the last place.

Other processors, compilers and C libraries round differently, as if the input were another one in its last bits.
"""

from __future__ import annotations

import hashlib
import os
import sys
from typing import Any

import numpy as np
from lsgp import surface
from numpy.typing import NDArray

VARIABLE = "LSGP_TEST_JITTER"


def moved(positions: NDArray[np.float64], seed: str) -> NDArray[np.float64]:
    """Each coordinate by -1, 0 or 1 unit in the last place, depending on the seed and on the vertex's place: copies of
    a vertex stay in one place, and its number has no part in it. Zeros, and what is not finite, stay."""
    places = np.ascontiguousarray(positions) + 0.0  # no -0
    key = np.frombuffer(hashlib.sha256(seed.encode()).digest(), np.uint64)[0]
    mixed = np.full(len(places), key)
    for column in places.view(np.uint64).T:
        mixed = _mixed(mixed ^ column)
    steps = np.stack([_mixed(mixed + np.uint64(k)) % np.uint64(3) for k in range(3)], axis=1).astype(np.float64) - 1
    with np.errstate(invalid="ignore", over="ignore", under="ignore"):
        found = places + steps * np.spacing(np.abs(places))
    return np.where((places != 0) & np.isfinite(found), found, positions)


def _mixed(values: NDArray[np.uint64]) -> NDArray[np.uint64]:
    """Bits of which all depend on all (the finalizer of SplitMix64)."""
    values = (values ^ (values >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    values = (values ^ (values >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return values ^ (values >> np.uint64(31))


_unmoved = surface.surface_arrays


def _surface_arrays(given: surface.Surface) -> tuple[Any, ...]:
    positions, *others = _unmoved(given)
    seed = os.environ.get(VARIABLE)
    return (moved(positions, seed) if seed else positions, *others)


def move_inputs() -> None:
    """From now on, while the variable has a value, which is the seed."""
    for module in list(sys.modules.values()):
        if getattr(module, "surface_arrays", None) is _unmoved:  # also where it has been imported by its name
            module.surface_arrays = _surface_arrays
