# SPDX-License-Identifier: GPL-3.0-or-later
"""Islands that nothing outside the unwrapped faces of their object can see, which may do with fewer texels."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ...core import native
from ...core.islands import Islands
from ..tasks.unwrapped import Unwrapped

if TYPE_CHECKING:
    from ..tasks.solving import Progress


def find_hidden(
    solved: Sequence[Unwrapped], parts: Sequence[Islands], progress: Progress | None = None
) -> list[NDArray[np.bool_]]:
    """(m,) of each map, the triangles of islands that are hidden, but for those with pins.  Raises Cancelled."""
    find, share_of = native.part("layouts.inside").find_hidden, native.part("base.progress").share_of
    out = []
    for i, (unwrapped, part) in enumerate(zip(solved, parts, strict=True)):
        result, own = unwrapped.result, share_of(progress, i / len(solved), (i + 1) / len(solved))
        is_hidden = find(unwrapped.region.surface, result.island, own)
        is_hidden[result.solved] &= ~part.stays
        out.append(is_hidden)
    return out


def with_less_inside(
    solved: Sequence[Unwrapped], parts: Sequence[Islands], hidden: Sequence[NDArray[np.bool_]], share: float
) -> tuple[list[Unwrapped], list[Islands], int]:
    """The maps, with ISLANDS_HIDDEN where that is so; the islands of each, those that are hidden at this share of their
    size; and how many these are."""
    inside = native.part("layouts.inside")
    maps, smaller, count = [], [], 0
    for unwrapped, part, is_hidden in zip(solved, parts, hidden, strict=True):
        result, one, changed = unwrapped.result, unwrapped, part
        if is_hidden.any():
            count += len(np.unique(result.island[is_hidden]))
            one = replace(one, placing=(*one.placing, inside.hidden_finding(result.island, is_hidden, share)))
            uv = inside.made_smaller(part.corner_uv, part.island, is_hidden[result.solved], share)
            changed = replace(part, corner_uv=uv)
        maps.append(one)
        smaller.append(changed)
    return maps, smaller, count
