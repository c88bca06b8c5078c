# SPDX-License-Identifier: GPL-3.0-or-later
"""Carries the UV maps of a mesh over to quads on its surface."""

from __future__ import annotations

from typing import TYPE_CHECKING

import bpy
import numpy as np
from numpy.typing import NDArray

from ..core import native
from ..core.region import Region
from ..core.text import counted
from .arrays import read_array

if TYPE_CHECKING:
    import lsgp
    from lsgp.quads.quad_map import QuadCenters


def carry_uv_maps(
    source: bpy.types.Mesh, target: bpy.types.Mesh, region: Region, quads: lsgp.QuadMesh, centers: QuadCenters
) -> NDArray[np.int32]:
    """Give the target, whose faces are the quads, the source's UV maps.  region: all of the source.

    Returns the faces that lie across seams of one of the maps.
    """
    across = [np.empty(0, np.int32)]
    for layer in source.uv_layers:
        corner_uv = read_array(layer.uv, "vector", np.float32, 2)[region.triangle_loops]
        carried = native.part("quads.quad_map").map_on_quads(region.surface, quads, centers, corner_uv)
        made = target.uv_layers.new(name=layer.name, do_init=False)
        made.uv.foreach_set("vector", carried.corner_uv.astype(np.float32).ravel())
        made.active_render = layer.active_render
        across.append(carried.across)
    if source.uv_layers:
        target.uv_layers.active_index = source.uv_layers.active_index
    return np.unique(np.concatenate(across))


def uv_findings(across: NDArray[np.int32]) -> list[lsgp.Finding]:
    """What is told of the faces that lie across seams; nothing where there are none."""
    if not len(across):
        return []
    lsgp = native.lsgp
    lie = counted(len(across), "quad lies", "quads lie")
    text = (
        f"{lie} across seams of a UV map, which was continued beyond them there. Unwrap the new mesh, or let rows of "
        "quads run along these seams by marking them as features."
    )
    return [lsgp.Finding("UV_ACROSS_SEAMS", text, lsgp.Elements("faces", across))]
