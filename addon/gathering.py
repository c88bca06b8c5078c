# SPDX-License-Identifier: GPL-3.0-or-later
"""From an object and what the artist chose to the task that is solved: all that is read of Blender is read here."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import bpy
import numpy as np

from .angles import read_angles
from .image_aspect import image_aspect
from .mesh_read import Region, vertex_weights
from .reporting import Refused
from .unwrapping import Task

if TYPE_CHECKING:
    import lsgp


@dataclass(frozen=True, slots=True)
class Settings:
    """What the artist chose.

    group: the vertex group of the cones. weight_group: that of the importance of stretch, None where all vertices weigh
    alike. weight_factor: what a weight of 1 adds to an importance of 1. The others as in the operator.
    """

    options: lsgp.Options
    group: str
    weight_group: str | None
    weight_factor: float
    use_pins: bool
    keep_placement: bool
    correct_aspect: bool


def gather(obj: bpy.types.Object, region: Region, settings: Settings) -> Task:
    """What the map of the region is computed from.  Raises Refused."""
    marked = read_angles(obj, settings.group).on(region.vertex_used)
    weights = vertex_weights(obj, settings.weight_group) if settings.weight_group is not None else None
    if weights is not None and settings.weight_factor:
        weighted = replace(region.surface, importance=1.0 + settings.weight_factor * weights)
        region = replace(region, surface=weighted)
    return Task(
        region=region,
        cones=marked,
        options=_options_on(obj, settings.options),
        pinned=region.pinned if settings.use_pins else np.zeros_like(region.pinned),
        keep_placement=settings.keep_placement,
        aspect=image_aspect(obj) if settings.correct_aspect else 1.0,
    )


def _options_on(obj: bpy.types.Object, options: lsgp.Options) -> lsgp.Options:
    """Tiles have their size on the object as it is scaled, the mesh knows of no scale.  Raises Refused."""
    seamless = options.seamless
    if seamless is None or seamless.tile_size is None:
        return options
    scale = obj.matrix_world.median_scale
    if not scale:
        raise Refused("the object is scaled to nothing, where no tile has a size; scale it up or give a count of tiles")
    return replace(options, seamless=replace(seamless, tile_size=seamless.tile_size / scale))
