# SPDX-License-Identifier: GPL-3.0-or-later
"""Packed islands turned upright, as far as quarter turns take no room."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ...core import native
from ...core.islands import Islands
from ..tasks.directions import UP
from ..tasks.unwrapped import Unwrapped

FloatArray = NDArray[np.float64]


def standing(
    solved: Sequence[Unwrapped], parts: Sequence[Islands], packed: Sequence[FloatArray], margin: float
) -> list[FloatArray]:
    """The packed coordinates of the islands of each map, with the world's up pointing up in the image.

    As they are where some are pinned, or an image is not square.
    """
    if any(part.stays.any() or part.aspect != 1.0 for part in parts):
        return list(packed)
    turns, island, count = [], [], 0
    for unwrapped, part, uv in zip(solved, parts, packed, strict=True):
        surface = unwrapped.region.surface
        mapped = replace(surface, triangles=surface.triangles[unwrapped.result.solved], directions=None)
        own = native.lsgp.upright_turns(mapped, uv, part.island, np.array(UP) @ unwrapped.region.axes)
        turns.append(own)
        island.append(part.island + count)
        count += len(own)
    together = native.lsgp.stand_upright(
        np.concatenate(packed), np.concatenate(island).astype(np.int32), np.concatenate(turns), margin=margin
    )
    return np.split(together, np.cumsum([len(uv) for uv in packed])[:-1])
