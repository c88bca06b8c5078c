# SPDX-License-Identifier: GPL-3.0-or-later
"""Islands that nothing outside their object can see, which may do with fewer texels."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ...core import native
from ...core.islands import Islands
from ..tasks.unwrapping import Unwrapped


def with_less_inside(solved: Sequence[Unwrapped], parts: Sequence[Islands], share: float) -> tuple[list[Islands], int]:
    """The islands of each map, those that are hidden at this share of their size, and how many these are; those with
    pins keep theirs."""
    inside = native.part("layouts.inside")
    out, count = [], 0
    for unwrapped, part in zip(solved, parts, strict=True):
        is_solved = unwrapped.result.solved
        is_hidden = inside.find_hidden(unwrapped.region.surface, unwrapped.result.island)[is_solved] & ~part.stays
        if is_hidden.any():
            count += len(np.unique(part.island[is_hidden]))
            smaller = inside.made_smaller(part.corner_uv, part.island, is_hidden, share)
            part = replace(part, corner_uv=smaller)
        out.append(part)
    return out, count
