# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes of quads: the grid of a seamless layout traced over its surface, and how square the quads are."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from .. import _lsgp
from ..base import arguments
from ..base.angles import arctan2
from ..base.arguments import FloatArray, IndexArray
from ..base.equality import EqualByContent
from ..base.progress import Progress
from ..base.short_repr import ShortRepr
from ..errors import InputError
from ..surface import Surface, surface_arrays
from .density import require_density


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class QuadMesh(EqualByContent, ShortRepr):
    """A closed manifold quad mesh, and the positions of its vertices on the surface.

    positions: (v, 3) float64, on the surface. quads: (q, 4) int32, four distinct vertices each, oriented like the
        surface's triangles. No two vertices share more than one edge.
    valences: (v,) int32, the number of quads at each vertex: the angle of a cone in quarter turns, 4 elsewhere.
    triangles: (v,) int32, the surface's triangle that contains each vertex. weights: (v, 3) float64, barycentric
        coordinates in that triangle, at least 0, with sum 1.
    surface_vertices: (v,) int32, the surface's vertex at each vertex, -1 for none.
    """

    positions: FloatArray
    quads: IndexArray
    valences: IndexArray
    triangles: IndexArray
    weights: FloatArray
    surface_vertices: IndexArray

    @property
    def irregular(self) -> IndexArray:
        """The vertices whose valence is not 4, ascending: those at cones."""
        return np.flatnonzero(self.valences != 4).astype(np.int32)


@dataclass(frozen=True, slots=True)
class QuadQuality:
    """The deviation of quads from squares of one size.

    angle_error: mean deviation of their corners from a right angle, radians; worst_angle_error: the largest.
    edge_deviation: standard deviation of the edges' lengths, relative to their mean; shortest_edge, longest_edge:
        relative to it as well.
    """

    angle_error: float
    worst_angle_error: float
    edge_deviation: float
    shortest_edge: float
    longest_edge: float


def extract_quads(
    surface: Surface, corner_uv: ArrayLike, cell: float = 1.0, progress: Progress | None = None
) -> QuadMesh:
    """Trace the grid of a seamless layout over a closed surface: its corners become vertices, its cells quads.

    corner_uv: (m, 3, 2), of a layout on the square lattice without parity, such as `Result.corner_uv` of a `Seamless`.
        Transitions across cuts are quarter turns and whole cells, cones are at corners of cells, and no triangle is
        flipped or without area. Sides of cuts that deviate by less than a thousandth of a cell are made to match.
    cell: side of a cell in texture coordinates, that of the `Seamless`.
    progress: as for `parameterize`.

    All decisions are exact, and an invalid layout is refused as a whole. The number of quads is the layout's area in
    cells. The mesh does not depend on seams and cuts.
    Raises InputError: WRONG_PARAMETER, INEXACT_SEAMS, FLIPPED_TRIANGLES, CONES_NOT_SNAPPED; TopologyError:
    OPEN_SURFACE, NOT_ORIENTABLE; CurvatureError: CONE_ANGLE_RANGE for cones of 90 degrees; SolverError: GRID_TOO_COARSE
    if cells are too large for a mesh; Cancelled.
    """
    arguments.require_callable(progress)
    arrays = surface_arrays(surface)
    uv = arguments.corner_coordinates("corner_uv", corner_uv, len(surface.triangles))
    return QuadMesh(**_lsgp.extract_quads(arrays, uv, arguments.positive("cell", cell), progress))


def quad_quality(positions: ArrayLike, quads: ArrayLike, density: ArrayLike | None = None) -> QuadQuality:
    """Measure quads.  positions: (v, 3). quads: (q, 4) vertices, at least one.

    density: (v,) that of quads at each vertex, such as `QuadRemesh.density`: lengths of edges count times its square
        root, the mean of that at their ends; None: 1.  Raises InputError.
    """
    positions = arguments.float_rows("positions", positions, 3)
    quads = arguments.index_rows("quads", quads, 4)
    if not len(quads):
        raise InputError("EMPTY_MESH", "There are no quads to measure. Pass those of a mesh.")
    arguments.require_indices("quads", quads, len(positions))
    wanted = None if density is None else require_density(density, len(positions))
    size = np.abs(positions).max()
    if not (math.isfinite(size) and size > 0):
        raise InputError("NON_FINITE_POSITION", "Positions are not finite, or all are 0. Pass those of a mesh.")
    corners = (positions / size)[quads]
    ahead = np.roll(corners, -1, axis=1) - corners
    back = np.roll(corners, 1, axis=1) - corners
    doubled_area = np.linalg.norm(np.cross(ahead, back), axis=2)
    errors = np.abs(arctan2(doubled_area, (ahead * back).sum(axis=2)) - math.pi / 2)
    # A mesh's edge is in two quads, so that all count alike.
    lengths = np.linalg.norm(ahead, axis=2)
    if wanted is not None:
        scale = np.sqrt(wanted)[quads]
        lengths *= (scale + np.roll(scale, -1, axis=1)) / 2
    mean = lengths.mean()
    if mean == 0:
        raise InputError("DEGENERATE_MESH", "All quads are points. Pass those of a mesh.")
    return QuadQuality(
        angle_error=float(errors.mean()),
        worst_angle_error=float(errors.max()),
        edge_deviation=float(lengths.std() / mean),
        shortest_edge=float(lengths.min() / mean),
        longest_edge=float(lengths.max() / mean),
    )


def scale_at(surface: Surface, mesh: QuadMesh) -> FloatArray:
    """(v,) the scale of the surface's metric at the vertices of a mesh on it."""
    if surface.scale is None:
        return np.ones(len(mesh.positions))
    return (mesh.weights * surface.scale[surface.triangles[mesh.triangles]]).sum(axis=1)
