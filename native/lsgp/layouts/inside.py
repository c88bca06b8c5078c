# SPDX-License-Identifier: GPL-3.0-or-later
"""Islands that nothing outside can see, which may do with fewer texels."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from .. import _lsgp
from ..base.arguments import FloatArray, IndexArray
from ..base.progress import Progress
from ..errors import Elements, Finding
from ..lattice import island_boxes
from ..results import Result
from ..surface import Surface, surface_arrays

LEAST_SHARE: float = _lsgp.least_inside()  # of the others' texel density


def find_hidden(surface: Surface, island: IndexArray, progress: Progress | None = None) -> NDArray[np.bool_]:
    """(m,) bool, triangles of islands that nothing outside can see: no ray from them leaves the surface.

    island: (m,), -1 for none.  Raises Cancelled.
    """
    return np.isin(island, _lsgp.hidden_islands(surface_arrays(surface), island, progress))


def made_smaller(corner_uv: FloatArray, island: IndexArray, is_chosen: NDArray[np.bool_], share: float) -> FloatArray:
    """The coordinates, (m, 3, 2), with the chosen islands at this share of their size, around the middles of their
    boxes."""
    boxes = island_boxes(corner_uv, island)
    middles = (boxes[:, None, :2] + boxes[:, None, 2:])[island[is_chosen]] / 2
    out = corner_uv.copy()
    out[is_chosen] = middles + share * (out[is_chosen] - middles)
    return out


def with_less_inside(surface: Surface, result: Result, share: float, progress: Progress | None = None) -> Result:
    """The result with islands that nothing outside can see at this share of their texel density.

    ISLANDS_HIDDEN is among the warnings where there are any.  Raises Cancelled.
    """
    hidden = find_hidden(surface, result.island, progress)
    if not hidden.any():
        return result
    uv = made_smaller(result.corner_uv, result.island, hidden, share)
    return replace(result, corner_uv=uv, warnings=[*result.warnings, hidden_finding(result.island, hidden, share)])


def hidden_finding(island: IndexArray, is_hidden: NDArray[np.bool_], share: float) -> Finding:
    """ISLANDS_HIDDEN. is_hidden: (m,), some of the triangles."""
    count = len(np.unique(island[is_hidden]))
    message = (
        f"Of {int(island.max()) + 1} islands {count} {'lies' if count == 1 else 'lie'} where nothing outside "
        f"can see {'it' if count == 1 else 'them'}, with {share:g} of the texel density."
    )
    return Finding("ISLANDS_HIDDEN", message, Elements("triangles", np.flatnonzero(is_hidden).astype(np.int32)))
