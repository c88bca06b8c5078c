# SPDX-License-Identifier: GPL-3.0-or-later
"""One mesh from its region to a finished map: pins in, the library's result, aspect and placement, nothing written."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import bpy
import numpy as np
from numpy.typing import NDArray

from . import cells, cones, native
from .image_aspect import image_aspect
from .mesh_read import Region
from .packing import Islands
from .reporting import Refused

if TYPE_CHECKING:
    import lsgp


@dataclass(frozen=True, slots=True)
class Settings:
    """What the artist chose.  group: the vertex group of the cones; the others as in the operator."""

    options: lsgp.Options
    group: str
    use_pins: bool
    keep_placement: bool
    correct_aspect: bool


@dataclass(frozen=True, slots=True)
class Unwrapped:
    """A finished map of one object's region.

    corner_uv: (m, 3, 2) float64 as they are to be written, NaN where not solved. pinned: (m, 3) bool, the corners that
    were held. aspect: of the image they are for; 1 where they are not corrected for one. step: the side of the cells
    that islands of a seamless layout may be moved by; None for other layouts.
    """

    obj: bpy.types.Object
    region: Region
    result: lsgp.Result
    corner_uv: NDArray[np.float64]
    pinned: NDArray[np.bool_]
    aspect: float
    step: float | None

    def islands(self) -> Islands:
        """The solved islands as the packer takes them."""
        solved = self.result.solved
        region, island = self.region, self.result.island
        return Islands(
            region.surface.triangles[solved], self.corner_uv[solved], island[solved], self.pinned[solved], self.aspect
        )


def unwrap(obj: bpy.types.Object, region: Region, settings: Settings) -> Unwrapped:
    """Solve the region.  Raises the library's errors and Refused."""
    lsgp = native.lsgp
    marked = cones.marked_cones(obj, settings.group)
    marked = marked[region.vertex_used[marked]]
    angles = cones.given_angles(obj.data, marked)

    aspect = image_aspect(obj) if settings.correct_aspect else 1.0
    # The library solves where lengths are equal both ways.
    squeeze = lsgp.correct_aspect((1.0, 1.0), aspect)
    pinned = region.pinned if settings.use_pins else np.zeros_like(region.pinned)
    options = _options_on(obj, settings.options)
    result = lsgp.parameterize(
        region.surface, marked, angles, options, _pins(region, pinned, region.corner_uv / squeeze)
    )
    uv = result.corner_uv
    step = None if result.seamless is None else cells.step(options.seamless)
    if settings.keep_placement and step is not None:
        uv = cells.keep_places(region, result, step)
    elif settings.keep_placement:
        old = region.corner_uv / squeeze
        # Pins have placed their island already.
        old[np.isin(result.island, result.island[pinned.any(axis=1)])] = np.nan
        uv = lsgp.fit_placement(uv, old, result.island)
    uv = lsgp.correct_aspect(uv, aspect)
    # A pinned UV keeps its bytes; it would return from double precision up to rounding.
    held = pinned & result.solved[:, None]
    uv[held] = region.corner_uv[held]
    return Unwrapped(obj, region, result, uv, held, aspect, step)


def _options_on(obj: bpy.types.Object, options: lsgp.Options) -> lsgp.Options:
    """Tiles have their size on the object as it is scaled, the mesh knows of no scale.  Raises Refused."""
    seamless = options.seamless
    if seamless is None or seamless.tile_size is None:
        return options
    scale = obj.matrix_world.median_scale
    if not scale:
        raise Refused("the object is scaled to nothing, where no tile has a size; scale it up or give a count of tiles")
    return replace(options, seamless=replace(seamless, tile_size=seamless.tile_size / scale))


def _pins(region: Region, pinned: NDArray[np.bool_], uv: NDArray[np.float64]) -> lsgp.Pins | None:
    """Each pinned loop once; the triangles of a polygon share loops."""
    corners = np.flatnonzero(pinned)
    if not len(corners):
        return None
    _, first = np.unique(region.triangle_loops.ravel()[corners], return_index=True)
    corners = corners[np.sort(first)]
    return native.lsgp.Pins(corners.astype(np.int32), uv.reshape(-1, 2)[corners])
