# SPDX-License-Identifier: GPL-3.0-or-later
"""What is mapped: a surface with what is marked on it, and pins."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from .base import arguments
from .base.arguments import FloatArray, IndexArray
from .base.equality import EqualByContent
from .base.frozen import set_field
from .base.short_repr import ShortRepr


@dataclass(frozen=True, eq=False, repr=False)
class Surface(EqualByContent, ShortRepr):
    """A triangulated surface, possibly of several components, and the edges its cuts may follow.

    positions: (n, 3) float64, any unit.
    triangles: (m, 3) int32, counter-clockwise seen from outside.
    edges: (e, 2) int32, the edges a cut may follow (mesh edges, not the diagonals of triangulated polygons);
        None for all edges of the triangles.
    seams: (s, 2) int32, marked edges, with the meaning given by `Options.seams`.
    importance: (n,) float64, at least 0: the weight of stretch at each vertex in the mode "low-stretch"; None: equal
        weights.
    cut_costs: (e,) float64, 0 to 1e6: cost per length of a cut along each of `edges`; None: 1. Costs determine the
        routes of cuts, which does not change the map, and the sites of cones that are placed.
    borders: (b, 2) int32, edges at which surface and texture end, whatever the meaning of seams.
    directions: (m, 3) float64, the desired direction of the texture's v at each triangle, in space: its component in
        the triangle's plane counts, with a weight given by its length, and (0, 0, 0) means none; or (3,), the same for
        all triangles; None: none. `edge_directions` has those along edges. Islands are rotated accordingly, which does
        not change the map; `Result.direction_errors` has the deviations.
    features: (f, 2) int32, edges, also of boundaries, that are to run straight along u or v; `feature_edges` finds
        some. They have precedence over creases that are straightened anyway; `Result.features` has those that do not.
    scale: (n,) float64, 1e-6 to 1e6: the factor by which lengths count at each vertex, that of an edge being the mean
        of its ends; None: 1. Maps, cones and grids are made, and their distortion is measured, as if the surface had
        these lengths; no side of a triangle may be longer than the others together then. Creases and directions are
        those of the positions.
    may_collapse: whether triangles may name a vertex twice, as those at edges without length do with the vertices of
        `stitch_borders`. They are no part of the surface, and get the coordinates of a neighbor.
    """

    positions: FloatArray
    triangles: IndexArray
    edges: IndexArray | None = None
    seams: IndexArray | None = None
    importance: FloatArray | None = None
    cut_costs: FloatArray | None = None
    borders: IndexArray | None = None
    directions: FloatArray | None = None
    features: IndexArray | None = None
    may_collapse: bool = False
    scale: FloatArray | None = None

    if TYPE_CHECKING:  # what may be passed, which becomes what the fields are

        def __init__(
            self,
            positions: ArrayLike,
            triangles: ArrayLike,
            edges: ArrayLike | None = None,
            seams: ArrayLike | None = None,
            importance: ArrayLike | None = None,
            cut_costs: ArrayLike | None = None,
            borders: ArrayLike | None = None,
            directions: ArrayLike | None = None,
            features: ArrayLike | None = None,
            may_collapse: bool = False,
            scale: ArrayLike | None = None,
        ) -> None: ...

    def __post_init__(self) -> None:
        set_field(self, "positions", arguments.float_rows("positions", self.positions, 3))
        set_field(self, "triangles", arguments.index_rows("triangles", self.triangles, 3))
        if self.edges is not None:
            set_field(self, "edges", arguments.index_rows("edges", self.edges, 2))
        for name in ("seams", "borders", "features"):
            marked = getattr(self, name)
            rows = np.empty((0, 2), np.int32) if marked is None else marked
            set_field(self, name, arguments.index_rows(name, rows, 2))
        for name in ("importance", "scale"):
            if getattr(self, name) is not None:
                shape = (len(self.positions),)
                set_field(self, name, arguments.floats_of_shape(name, getattr(self, name), shape))
        if self.cut_costs is not None:
            shape = (0 if self.edges is None else len(self.edges),)
            set_field(self, "cut_costs", arguments.floats_of_shape("cut_costs", self.cut_costs, shape))
        if self.directions is not None:
            set_field(self, "directions", _directions(self.directions, len(self.triangles)))
        set_field(self, "may_collapse", arguments.flag("may_collapse", self.may_collapse))


@dataclass(frozen=True, eq=False, repr=False)
class Pins(EqualByContent, ShortRepr):
    """Corners with fixed texture coordinates.

    corners: (p,) int32, 3 * triangle + corner. uv: (p, 2) float64.
    """

    corners: IndexArray
    uv: FloatArray

    if TYPE_CHECKING:

        def __init__(self, corners: ArrayLike, uv: ArrayLike) -> None: ...

    def __post_init__(self) -> None:
        set_field(self, "corners", arguments.index_vector("corners", self.corners))
        set_field(self, "uv", arguments.float_rows("uv", self.uv, 2))


def surface_arrays(surface: Surface) -> tuple[Any, ...]:
    arguments.require_type("surface", surface, Surface)
    of_elements = (surface.importance, surface.cut_costs, surface.scale)
    importance, cut_costs, scale = (np.empty(0) if values is None else values for values in of_elements)
    directions = np.empty((0, 3)) if surface.directions is None else surface.directions
    seams, borders, features = surface.seams, surface.borders, surface.features
    return (
        *(surface.positions, surface.triangles, surface.edges, seams, importance, cut_costs),
        *(borders, directions, features, surface.may_collapse, scale),
    )


def require_vertices(surface: Surface) -> None:
    """Raises InputError: INDEX_OUT_OF_RANGE where triangles or edges name vertices that the surface does not have."""
    arguments.require_type("surface", surface, Surface)
    for name in ("triangles", "edges", "seams", "borders", "features"):
        indices = getattr(surface, name)
        if indices is not None:
            arguments.require_indices(name, indices, len(surface.positions))


def has_strokes(surface: Surface) -> bool:
    """Whether several triangles have a direction of the texture, but not all."""
    if surface.directions is None:
        return False
    directed = np.count_nonzero(surface.directions.any(axis=1))
    return bool(1 < directed < len(surface.triangles))


def _directions(directions: ArrayLike, triangle_count: int) -> FloatArray:
    """One for each triangle."""
    if arguments.as_array("directions", directions).ndim != 1:
        return arguments.floats_of_shape("directions", directions, (triangle_count, 3))
    return np.tile(arguments.floats_of_shape("directions", directions, (3,)), (triangle_count, 1))
