# SPDX-License-Identifier: GPL-3.0-or-later
"""Cones that nobody meant: subdividing makes one in the middle of every edge between two."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ...core import native
from ...core.text import counted

if TYPE_CHECKING:
    import lsgp

# From the middle, as a share of the distance of the two; fewer than twenty cones in a circle are further from it.
_NEAR = 0.01


def cones_between(surface: lsgp.Surface, cones: NDArray[np.integer]) -> NDArray[np.int32]:
    """Those in the middle between two others that edges join them to, ascending."""
    sides = np.concatenate([surface.triangles[:, [i, (i + 1) % 3]] for i in range(3)])
    sides = sides[np.isin(sides, cones).all(axis=1)]
    # Each cone with each of its neighbors, one cone after the other.
    cone, beside = np.unique(np.concatenate([sides, sides[:, ::-1]]), axis=0).reshape(-1, 2).T
    places, between = surface.positions, np.zeros(len(surface.positions), bool)
    for step in range(1, len(cone)):
        rows = np.flatnonzero(cone[step:] == cone[:-step])
        if not len(rows):
            break
        one, other = places[beside[rows]], places[beside[rows + step]]
        off = np.linalg.norm(places[cone[rows]] - (one + other) / 2, axis=1)
        between[cone[rows[off <= _NEAR * np.linalg.norm(one - other, axis=1)]]] = True
    return np.flatnonzero(between).astype(np.int32)


def told_between(surface: lsgp.Surface, cones: NDArray[np.integer]) -> list[lsgp.Finding]:
    """A warning that names them, if there are any."""
    between = cones_between(surface, cones)
    if not len(between):
        return []
    lie = "lies" if len(between) == 1 else "lie"
    message = (
        f"{counted(len(between), 'cone')} {lie} in the middle between two others, as subdividing makes them on edges "
        "between cones. Where they are not meant to be cones, select them and use Clear Cone."
    )
    return [native.lsgp.Finding("CONES_BETWEEN_CONES", message, native.lsgp.Elements("vertices", between))]
