# SPDX-License-Identifier: GPL-3.0-or-later
"""Faces of a finished map in another shape."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, get_args

from numpy.typing import ArrayLike

from . import _lsgp
from .base import arguments
from .base.arguments import FloatArray, IndexArray
from .base.equality import EqualByContent
from .base.progress import Progress
from .base.short_repr import ShortRepr
from .errors import Finding
from .surface import Surface, surface_arrays

PatchShape = Literal["grid", "even-grid", "strip", "rectangle"]


@dataclass(frozen=True, eq=False, repr=False)
class ShapedMap(EqualByContent, ShortRepr):
    """A map of which some patches have another shape.

    corner_uv: (m, 3, 2) float64. moved: (k,) int32, the triangles with other coordinates. patches: how many got the
    shape. warnings: SHAPE_IMPOSSIBLE for each patch that did not, with its triangles, and FLIPPED_TRIANGLES beside
    those that did.
    """

    corner_uv: FloatArray
    moved: IndexArray
    patches: int
    warnings: list[Finding]


def shape_patches(
    surface: Surface,
    corner_uv: ArrayLike,
    triangles: ArrayLike,
    shape: PatchShape,
    *,
    corners: ArrayLike = (),
    pinned: ArrayLike = (),
    progress: Progress | None = None,
) -> ShapedMap:
    """Give the patches of some triangles of a map, those that are joined in it, another shape, along the axes.

    They keep their area and their middle, and are turned as little as that takes. The other triangles of their islands
    follow with least stretch.

    corner_uv: (m, 3, 2) float64; triangles with a coordinate that is not finite have no island. triangles: (k,) int32.
    shape: "grid": rows and columns of quads, each as wide as its quads are on the surface, on the average;
        "even-grid": rows all of one width, and columns as well; "strip": a grid of a single row; "rectangle": of a
        disk, whose boundary gets straight between four corners, with the lengths that it has on the surface. Quads are
        as of `find_tubes`.
    corners: of rectangles, vertices: those on the boundary of a patch, which have to be four; none there: where it
        turns most. pinned: corners, 3 * triangle + corner, that stay where they are; patches whose pins do not permit
        the shape do not get it. progress: as for `parameterize`.
    Raises InputError: SHAPE_IMPOSSIBLE where no patch gets the shape, and what `measure_distortion` raises; Cancelled.
    """
    arguments.require_callable(progress)
    arguments.require_choice("shape", shape, get_args(PatchShape))
    arrays = surface_arrays(surface)
    uv = arguments.corner_coordinates("corner_uv", corner_uv, len(surface.triangles))
    numbers = [
        arguments.index_vector(name, values)
        for name, values in (("triangles", triangles), ("corners", corners), ("pinned", pinned))
    ]
    return ShapedMap(**_lsgp.shape_patches(arrays, uv, numbers[0], shape, *numbers[1:], progress))
