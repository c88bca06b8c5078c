# SPDX-License-Identifier: GPL-3.0-or-later
"""Where a half model meets its image in a Mirror modifier."""

from __future__ import annotations

import bpy
import numpy as np
from numpy.typing import NDArray


def in_mirror_plane(obj: bpy.types.Object, places: NDArray[np.floating]) -> NDArray[np.bool_]:
    """(n,), which of these places, (n, 3) in the object's space, a shown Mirror modifier merges with their images."""
    inside = np.zeros(len(places), bool)
    for modifier in obj.modifiers:
        if modifier.type != "MIRROR" or not (modifier.show_viewport and modifier.use_mirror_merge):
            continue
        other = modifier.mirror_object
        # The planes are those of the other object where there is one; its scale counts, as it does in Blender.
        to_planes = np.eye(4) if other is None else np.array(other.matrix_world.inverted_safe() @ obj.matrix_world)
        seen = places @ to_planes[:3, :3].T + to_planes[:3, 3]
        for axis in np.flatnonzero(modifier.use_axis):
            inside |= 2 * np.abs(seen[:, axis]) <= modifier.merge_threshold
    return inside
