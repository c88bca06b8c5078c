# SPDX-License-Identifier: GPL-3.0-or-later
"""Quadrangulation: the grid of a seamless layout, traced over a closed surface (the paper's section 8)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from . import _lsgp, arguments
from .api import Options, Progress, Result, Seamless, Solver, Surface, surface_arrays
from .arguments import FloatArray, IndexArray
from .auto_unwrap import CompletedCones, complete_cones, part_of
from .equality import EqualByContent
from .errors import Finding, InputError, SolverError
from .triangles import uv_area

# Of the time that a remesh takes, where placing the cones and where the layouts end.
_PLACED, _LAID_OUT = 0.6, 0.95
# What layouts are warned of does not matter to the grid on the surface.
_OF_LAYOUTS_ALONE = frozenset({"OVERLAPPING_TRIANGLES"})
_MOST_QUADS = 2**28
# A number of quads further than this from what was asked for, as a share of it, gets a second try.
_NEAR = 0.02


@dataclass(frozen=True, slots=True, eq=False)
class QuadMesh(EqualByContent):
    """A closed manifold mesh whose faces all are quads, and where its vertices are on the surface.

    positions: (v, 3) float64, on the surface. quads: (q, 4) int32, four different vertices each, which turn as the
    surface's triangles do. No two vertices have more than one edge between them.
    valences: (v,) int32, how many quads meet at each vertex: the angle of a cone in quarter turns, 4 elsewhere.
    triangles: (v,) int32, the surface's triangle that each vertex is on. weights: (v, 3) float64, those of the corners
        of that triangle, at least 0, their sum 1.
    surface_vertices: (v,) int32, the surface's vertex that each vertex is at, -1 for none.
    """

    positions: FloatArray
    quads: IndexArray
    valences: IndexArray
    triangles: IndexArray
    weights: FloatArray
    surface_vertices: IndexArray

    @property
    def irregular(self) -> IndexArray:
        """The vertices, ascending, at which not four quads meet: those at cones."""
        return np.flatnonzero(self.valences != 4).astype(np.int32)


@dataclass(frozen=True, slots=True)
class QuadQuality:
    """How far the quads of a mesh are from squares of one size.

    angle_error: mean deviation of their corners from a right angle, radians; worst_angle_error: the largest.
    edge_deviation: standard deviation of the edges' lengths, relative to their mean; shortest_edge, longest_edge:
        relative to it as well.
    """

    angle_error: float
    worst_angle_error: float
    edge_deviation: float
    shortest_edge: float
    longest_edge: float


@dataclass(frozen=True, slots=True, eq=False)
class QuadRemesh(EqualByContent):
    """A quadrangulation and what it was made from.

    mesh: the quads. layout: the seamless layout whose grid they are; its `cones` are the irregular vertices, its
        `seamless.tile_size` is the side of a quad.
    warnings: findings that leave the mesh usable, those of placing cones and of the layout.
    """

    mesh: QuadMesh
    layout: Result
    warnings: list[Finding]


def extract_quads(
    surface: Surface, corner_uv: ArrayLike, cell: float = 1.0, progress: Progress | None = None
) -> QuadMesh:
    """Trace the grid of a seamless layout over a closed surface: its corners become vertices, its cells quads.

    corner_uv: (m, 3, 2), of a layout on the square lattice without parity, such as `Result.corner_uv` of a `Seamless`.
        What crosses a cut is turned by quarter turns and moved by whole cells, cones are at corners of cells, and no
        triangle is flipped or without area. Sides of cuts that miss that by less than a thousandth of a cell are made
        equal.
    cell: side of a cell in texture coordinates, that of the `Seamless`.
    progress: as for `parameterize`.

    All decisions are exact, and a layout that is not valid is refused as a whole. The number of quads is the layout's
    area in cells. Seams and cuts leave no trace in the mesh.
    Raises InputError: WRONG_PARAMETER, INEXACT_SEAMS, FLIPPED_TRIANGLES, CONES_NOT_SNAPPED; TopologyError:
    OPEN_SURFACE, NOT_ORIENTABLE; CurvatureError: CONE_ANGLE_RANGE for cones of 90 degrees; SolverError: GRID_TOO_COARSE
    where cells are too large for a mesh; Cancelled.
    """
    arguments.require_callable(progress)
    arrays = surface_arrays(surface)
    uv = arguments.corner_coordinates("corner_uv", corner_uv, len(surface.triangles))
    return QuadMesh(**_lsgp.extract_quads(arrays, uv, arguments.positive("cell", cell), progress))


def remesh_to_quads(
    surface: Surface,
    cones: ArrayLike = (),
    angles: Sequence[float | None] | None = None,
    *,
    target: int | None = None,
    size: float | None = None,
    options: Options | None = None,
    count: int | None = None,
    progress: Progress | None = None,
) -> QuadRemesh:
    """Cover a closed surface with quads whose irregular vertices are the cones.

    cones, angles: as of `parameterize`; they are kept. Components without cones, or whose cones cannot take up their
        curvature, get some, as by `auto_unwrap`. count: how many on each component that gets some.
    target: how many quads there are to be; the number comes near it, or is more where so few leave no valid layout.
        size: or the side of a quad on the surface, in its unit. Neither: the coarsest grid that costs at most a tenth
        in distortion.
    options: of the layout, as of `parameterize`; None: `Options(seamless=Seamless())`. Its `seamless` has no size of
        its own, and lies on squares without parity.
    Where the surface has `directions`, rows of quads run along them as far as the cones let them; its seams do not
    matter.
    progress: as for `parameterize`.  Raises as `parameterize` and `extract_quads` do, OPEN_SURFACE before any work is
    done; COMPONENT_SKIPPED where a part has no layout.
    """
    arguments.require_callable(progress)
    arguments.require_type("surface", surface, Surface)
    surface = replace(surface, seams=None)
    chosen = _options(options)
    chosen = replace(chosen, seamless=replace(chosen.seamless, tile_size=_side(surface, target, size)))
    _lsgp.require_closed(surface_arrays(surface))
    completed = complete_cones(surface, cones, angles, chosen, count, part_of(progress, 0.0, _PLACED))
    layout = _lay_out(surface, completed, chosen, target, part_of(progress, _PLACED, _LAID_OUT))
    _require_whole(layout)
    layout = completed.told(layout, chosen)
    rest = part_of(progress, _LAID_OUT, 1.0)
    mesh = extract_quads(surface, layout.corner_uv, chosen.seamless.cell, rest)
    return QuadRemesh(mesh, layout, [finding for finding in layout.warnings if finding.code not in _OF_LAYOUTS_ALONE])


def quad_quality(positions: ArrayLike, quads: ArrayLike) -> QuadQuality:
    """Measure quads.  positions: (v, 3). quads: (q, 4) vertices, at least one.  Raises InputError."""
    positions = arguments.float_rows("positions", positions, 3)
    quads = arguments.index_rows("quads", quads, 4)
    if not len(quads):
        raise InputError("EMPTY_MESH", "There are no quads to measure. Pass those of a mesh.")
    arguments.require_indices("quads", quads, len(positions))
    size = np.abs(positions).max()
    if not (math.isfinite(size) and size > 0):
        raise InputError("NON_FINITE_POSITION", "Positions are not finite, or all are 0. Pass those of a mesh.")
    corners = (positions / size)[quads]
    ahead = np.roll(corners, -1, axis=1) - corners
    back = np.roll(corners, 1, axis=1) - corners
    doubled_area = np.linalg.norm(np.cross(ahead, back), axis=2)
    errors = np.abs(np.arctan2(doubled_area, (ahead * back).sum(axis=2)) - math.pi / 2)
    # A mesh's edge is in two quads, so that all count alike.
    lengths = np.linalg.norm(ahead, axis=2)
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


def _options(options: Options | None) -> Options:
    """Those of a layout whose grid can be traced."""
    chosen = Options(seamless=Seamless()) if options is None else options
    arguments.require_type("options", chosen, Options)
    seamless = chosen.seamless
    remedy = "pass seamless=Seamless() on squares, without parity, tiles and tile_size"
    if seamless is None or seamless.lattice != "square" or seamless.parity or seamless.coarse_grid == "relax":
        arguments.refuse("options.seamless", seamless, remedy)
    if seamless.tiles is not None or seamless.tile_size is not None:
        arguments.refuse("options.seamless", seamless, f"{remedy}; target or size says how many quads there are")
    return chosen


def _side(surface: Surface, target: int | None, size: float | None) -> float | None:
    """The side of a quad; None where the grid is to be the coarsest one."""
    if target is not None and size is not None:
        raise InputError(
            "WRONG_PARAMETER", "target and size both say how many quads there are to be; pass one of them."
        )
    if size is not None:
        return arguments.positive("size", size)
    if target is None:
        return None
    target = arguments.whole_number("target", target, 1, f"pass how many quads there are to be, up to {_MOST_QUADS}")
    if target > _MOST_QUADS:
        arguments.refuse("target", target, f"pass how many quads there are to be, up to {_MOST_QUADS}")
    corners = surface.positions[surface.triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    return math.sqrt(0.5 * float(np.linalg.norm(normals, axis=1).sum()) / target)


def _lay_out(
    surface: Surface, completed: CompletedCones, options: Options, target: int | None, progress: Progress | None
) -> Result:
    """The layout, on a grid of another size where rounding has taken the first one away from its target."""
    solver = Solver(surface)
    layout = solver.parameterize(completed.cones, completed.angles, options, progress=part_of(progress, 0.0, 0.5))
    if target is None:
        return layout
    quads = _quad_count(layout)
    if abs(quads - target) <= _NEAR * target or any(finding.code == "GRID_REFINED" for finding in layout.warnings):
        return layout
    side = options.seamless.tile_size * math.sqrt(quads / target)
    again = replace(options, seamless=replace(options.seamless, tile_size=side))
    second = solver.parameterize(completed.cones, completed.angles, again, progress=part_of(progress, 0.5, 1.0))
    return min(layout, second, key=lambda found: abs(_quad_count(found) - target))


def _require_whole(layout: Result) -> None:
    """Raises SolverError with why a part has no layout."""
    for finding in layout.warnings:
        if finding.code == "COMPONENT_SKIPPED":
            raise SolverError(finding.code, finding.message, finding.elements)


def _quad_count(layout: Result) -> int:
    """The cells of the part that is laid out."""
    return round(uv_area(layout.corner_uv[layout.solved]) / layout.seamless.cell**2)
