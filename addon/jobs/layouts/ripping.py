# SPDX-License-Identifier: GPL-3.0-or-later
"""Selected faces of a UV map as islands of their own, where there is room for them.  Nothing is written."""

from __future__ import annotations

import numpy as np

from ...core.islands import Islands, Place
from ...core.text import counted
from ..uv_maps.islands import ChangedMap, Map, changed_map, ripped_patches
from .packing import pack_in_place


def ripped(found: Map, margin: float) -> ChangedMap:
    """margin: around each island, of the height of the image.  Raises LsgpError, Refused."""
    number = ripped_patches(found)
    taken, mapped = number >= 0, found.island >= 0
    region = found.region
    pinned = np.zeros((int(taken.sum()), 3), bool)
    part = Islands(region.surface.triangles[taken], found.corner_uv[taken], number[taken], pinned, 1.0)
    place = Place(found.corner_uv[mapped & ~taken], None, keeps_density=True)
    (packed,) = pack_in_place([part], margin, place, turned=False)
    uv = found.corner_uv.copy()
    uv[taken] = packed
    return changed_map(found, uv, taken, f"{counted(int(number.max()) + 1, 'island')} ripped")
