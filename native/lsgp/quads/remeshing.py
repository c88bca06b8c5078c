# SPDX-License-Identifier: GPL-3.0-or-later
"""Quadrangulation: the grid of a seamless layout, traced over a closed surface (the paper's section 8)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, fields, replace

import numpy as np
from numpy.typing import ArrayLike

from .. import _lsgp
from ..api import Solver
from ..base import arguments
from ..base.arguments import FloatArray, IndexArray
from ..base.counted import counted
from ..base.equality import EqualByContent
from ..base.progress import Progress, Steps, share_of
from ..base.short_repr import ShortRepr
from ..errors import Elements, Finding, InputError, LsgpError, SolverError
from ..ledger import build_ledger, surface_of_triangles
from ..options import Options, Seamless
from ..results import Result
from ..stitching import is_collapsed
from ..surface import Surface, surface_arrays
from ..triangles import triangle_areas, uv_area
from .completed_cones import GivenCones, complete_cones, feature_cones, held_open, lay_out, or_none
from .density import at_density, even_density, require_density
from .divided_triangles import DividedSurface, divide_long_edges
from .followed_features import feature_share, releases_many_features, runs_along_features
from .polishing import polished
from .quad_mesh import QuadMesh, extract_quads, scale_at
from .quad_rows import QuadLines

# Of the time that a remesh takes, where placing the cones, the layouts and extraction before polishing end.
_PLACED, _LAID_OUT, _EXTRACTED = 0.6, 0.95, 0.97
# And, where long edges are divided, until then.
_DIVIDED = 0.02
# Of the time of placing, where cones for creases are placed, and of that of layouts, where the plain one and then those
# along creases through these cones end.
_FOR_FEATURES, _PLAIN, _ALONG = 0.1, 0.2, 0.6
# And of these layouts, where those on the given surface end, and those on one with long edges divided begin.
_ON_GIVEN = 0.6
# Rows of quads along all creases may cost as much L2 stretch, along some of them accordingly less.
_MOST_L2_ALONG = 1.2
# Edges longer than this, of the square root of the area, are divided where quads follow features, unless nearly all
# are followed with hardly any stretch. What that has to gain: more than a few features, or stretch, without more quads.
_LONGEST_EDGE = 0.06
_NEARLY_ALL, _NEARLY_ISOMETRIC = 0.95, 1.01
_FEW_FEATURES, _LESS_STRETCH, _MORE_QUADS = 0.05, 0.75, 1.25
# How many features, of those followed before, have to be followed on the first grid, for which another one is tried.
_PROMISING = 0.8
# What layouts are warned of does not matter to the grid on the surface.
_OF_LAYOUTS_ALONE = frozenset({"OVERLAPPING_TRIANGLES"})
_MOST_QUADS = 2**28
# How far, as a share of it, the number of quads may be from what was asked for without a second try, and a third, ...
_NEAR_ENOUGH = (0.02, 0.1, 0.1, 0.1)
# This far from it is as bad as following no features instead of all.
_WORTH_OF_FEATURES = 0.25
# Cones of a quarter turn are below this angle, radians; how often others are placed to do without.
_NARROW, _MOST_HOLDS = 0.75 * math.pi, 4
# Where quads are too large for a mesh: by how much smaller ones are tried, how often, and into how many parts rows of
# quads are divided. Smaller ones may be as many more than those of divided rows as above.
_FINER = 0.8
_MOST_REFINEMENTS = 12
_PARTS_OF_ROWS = (2, 3)
# More quads than this, and this many times what was asked for, are refused instead of made: parts of the surface differ
# so much in size that the grid of the smallest one covers the others with millions.
_MANY_QUADS, _FAR_ABOVE = 2**20, 2


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class QuadRemesh(EqualByContent, ShortRepr):
    """A quadrangulation and its seamless layout.

    mesh: the quads. layout: the seamless layout whose grid was traced; its `cones` are the irregular vertices, its
        `seamless.tile_size` is the side of a quad whose row is not divided.
    warnings: findings that leave the mesh usable, including those of the placement of cones and of the layout.
    surface: what the layout is of: the given surface without triangles that name a vertex twice, or where quads follow
        creases or a density and its triangles are large, the same with long edges divided. New vertices follow the
        given ones. Its `scale` is the metric in which quads are equal. The mesh and the warnings refer to the given
        surface.
    density: (v,) that of quads at each vertex of the mesh, as it was used; None if it is the same
        everywhere.
    """

    mesh: QuadMesh
    layout: Result
    warnings: list[Finding]
    surface: Surface
    density: FloatArray | None = None

    def feature_distances(self) -> FloatArray:
        """(k,) of the irregular vertices, `layout.cones`, from the nearest feature, in sides of a quad: marked edges,
        or creases where nothing is marked. Empty without features."""
        edges = self.surface.features if len(self.surface.features) else self.layout.seamless.creases
        if not len(edges):
            return np.empty(0)
        begin, end = self.surface.positions[edges].transpose(1, 0, 2)
        nearest = np.array([_distance(point, begin, end) for point in self.surface.positions[self.layout.cones]])
        scale = 1.0 if self.surface.scale is None else self.surface.scale[self.layout.cones]
        return nearest * scale / self.layout.seamless.tile_size


def _distance(point: FloatArray, begin: FloatArray, end: FloatArray) -> float:
    """From a point to the nearest of some segments, (e, 3) each."""
    along, away = end - begin, point - begin
    square = (along * along).sum(axis=1)
    part = np.clip((along * away).sum(axis=1) / np.where(square > 0, square, 1), 0, 1)
    return float(np.linalg.norm(away - part[:, np.newaxis] * along, axis=1).min())


def remesh_to_quads(
    surface: Surface,
    cones: ArrayLike = (),
    angles: Sequence[float | None] | FloatArray | None = None,
    *,
    target: int | None = None,
    size: float | None = None,
    options: Options | None = None,
    count: int | None = None,
    polish: bool = False,
    density: ArrayLike | None = None,
    progress: Progress | None = None,
) -> QuadRemesh:
    """Cover a closed surface with quads whose irregular vertices are the cones.

    cones, angles: as for `parameterize`; they are kept. Components without cones, or whose cones cannot take up their
        curvature, get some, as with `auto_unwrap`, but none of 90 degrees. count: the number on each component that
        gets some.
    target: the approximate number of quads; it is larger if so few have no valid layout or are not a mesh
        (GRID_REFINED): some rows of quads are then divided, or all are smaller. More than a million, and twice the
        target, are refused (TOO_MANY_QUADS).
        size: or the side of a quad on the surface, in its unit. Neither: the coarsest grid that costs at most a tenth
        in distortion.
    options: for the layout, as for `parameterize`; None: `Options(seamless=Seamless(), straighten=True)`. Its
        `seamless` must not have a size, and uses the square lattice without parity. With `straighten` creases of hard
        surfaces become rows of edges, and automatic cones are chosen for that.
    polish: whether vertices, but for irregular ones and those on features, then move over the surface, so that edges
        are more equal, with corners about as square as before; no quad gets a bad corner that had none.
    density: (n,) the number of quads per area at each vertex, relative to the others, 1e-12 to 1e12: four times as many
        are half as long. `size` is the side of a quad where the density is 1. Where triangles are too large for it to
        fall as fast as given it is raised (DENSITY_RAISED).
    If the surface has `directions`, rows of quads follow them as far as the cones permit; its seams have no effect.
    progress: as for `parameterize`.  Raises the errors of `parameterize` and `extract_quads`, OPEN_SURFACE before any
    work is done; COMPONENT_SKIPPED if a component has no layout; TOO_MANY_QUADS.

    >>> quads = lsgp.remesh_to_quads(surface, cones=[0, 1, 2, 3], target=100).mesh.quads
    >>> quads.shape[1], 50 < len(quads) < 200
    (4, True)
    """
    arguments.require_callable(progress)
    arguments.require_type("surface", surface, Surface)
    surface = replace(surface, seams=None)
    given = GivenCones.of(cones, angles, count)
    asked = _Asked(given, target, size, _options(options), arguments.flag("polish", polish))
    wanted = None if density is None else require_density(density, len(surface.positions))
    if not (surface.may_collapse and is_collapsed(surface.triangles).any()):
        return _with_density(surface, wanted, asked, progress)
    whole = np.flatnonzero(~is_collapsed(surface.triangles)).astype(np.int32)
    try:
        remesh = _with_density(surface_of_triangles(surface, whole), wanted, asked, progress)
    except LsgpError as error:
        error.elements = _among_all(error.elements, whole)
        raise
    mesh = replace(remesh.mesh, triangles=whole[remesh.mesh.triangles])
    warnings = [replace(finding, elements=_among_all(finding.elements, whole)) for finding in remesh.warnings]
    return replace(remesh, mesh=mesh, warnings=warnings)


def _among_all(elements: Elements, whole: IndexArray) -> Elements:
    """Elements of a surface of these triangles alone, as elements of all."""
    return Elements("triangles", whole[elements.indices]) if elements.kind == "triangles" else elements


@dataclass(frozen=True, slots=True)
class _Asked:
    """The arguments of `remesh_to_quads` but for the surface and the density."""

    given: GivenCones
    target: int | None
    size: float | None
    options: Options
    polish: bool


def _with_density(surface: Surface, density: FloatArray | None, asked: _Asked, progress: Progress | None) -> QuadRemesh:
    """Of a surface without seams whose triangles have three vertices each."""
    _lsgp.require_closed(surface_arrays(surface))
    if density is None:
        return _remeshed(surface, asked, progress)
    even = even_density(surface, density)
    if even is not None:
        if asked.size is not None:
            asked = replace(asked, size=arguments.positive("size", asked.size) / math.sqrt(even))
        return _remeshed(surface, asked, progress)
    build_ledger(surface, asked.given.cones, asked.given.angles)  # refuses cones that are no vertices of it
    finer, findings = at_density(surface, density, _LONGEST_EDGE, Steps(share_of(progress, 0.0, _DIVIDED)))
    try:
        remesh = _remeshed(finer.surface, asked, share_of(progress, _DIVIDED, 1.0))
    except LsgpError as error:
        error.elements = finer.elements(error.elements)
        raise
    warnings = [replace(finding, elements=finer.elements(finding.elements)) for finding in remesh.warnings]
    mesh = _undivided(remesh.mesh, finer)
    used = (scale_at(finer.surface, remesh.mesh) / scale_at(surface, mesh)) ** 2
    return QuadRemesh(mesh, remesh.layout, [*warnings, *findings], remesh.surface, used)


def _remeshed(surface: Surface, asked: _Asked, progress: Progress | None) -> QuadRemesh:
    """Of a closed surface."""
    given, target, size, chosen, polish = asked.given, asked.target, asked.size, asked.options, asked.polish
    side = _side(surface, target, size)
    chosen = replace(chosen, seamless=replace(chosen.seamless, tile_size=side))
    placing, laying_out = share_of(progress, 0.0, _PLACED), share_of(progress, _PLACED, _LAID_OUT)
    solver, along, finer = Solver(surface), None, None
    if given.is_free:
        along = feature_cones(solver, chosen, share_of(placing, 0.0, _FOR_FEATURES))
    completed = _wide_cones(solver, given, chosen, share_of(placing, _FOR_FEATURES, 1.0))
    if along is None:
        layouts, layout = _whole_or_between(solver, target, completed, chosen, laying_out)
    else:
        on_given, on_finer = share_of(laying_out, 0.0, _ON_GIVEN), share_of(laying_out, _ON_GIVEN, 1.0)
        layouts, layout = _along_features((solver, target, chosen), (along, completed), on_given)
        gained = None if _is_close(layout) else or_none(lambda: _gained(surface, target, chosen, layout, on_finer))
        if gained is not None:
            finer, layouts, layout = gained
    count = 0.0 if side is None else _area(surface) / side**2
    mesh, layout = layouts.extracted(layout, count, share_of(progress, _LAID_OUT, _EXTRACTED if polish else 1.0))
    if polish:
        opened = surface if finer is None else finer.surface
        features = opened.features if len(opened.features) else layout.seamless.creases
        mesh = polished(opened, mesh, features, share_of(progress, _EXTRACTED, 1.0))
    warnings = [finding for finding in layout.warnings if finding.code not in _OF_LAYOUTS_ALONE]
    if finer is None:
        return QuadRemesh(mesh, layout, warnings, surface)
    warnings = [replace(finding, elements=finer.elements(finding.elements)) for finding in warnings]
    return QuadRemesh(_undivided(mesh, finer), layout, warnings, finer.surface)


def _options(options: Options | None) -> Options:
    """Those of a layout whose grid can be traced."""
    chosen = Options(seamless=Seamless(), straighten=True) if options is None else options
    arguments.require_type("options", chosen, Options)
    seamless = chosen.seamless
    remedy = "pass seamless=Seamless() on squares, without parity, tiles and tile_size"
    if seamless is None or seamless.lattice != "square" or seamless.parity or seamless.coarse_grid == "relax":
        arguments.refuse("options.seamless", seamless, remedy)
    if seamless.tiles is not None or seamless.tile_size is not None:
        arguments.refuse("options.seamless", seamless, f"{remedy}; target or size determines the number of quads")
    return replace(chosen, seamless=replace(seamless, feature_places="whole"))


def _side(surface: Surface, target: int | None, size: float | None) -> float | None:
    """The side of a quad; None where the grid is to be the coarsest one."""
    if target is not None and size is not None:
        raise InputError("WRONG_PARAMETER", "target and size both determine the number of quads; pass one of them.")
    if size is not None:
        return arguments.positive("size", size)
    if target is None:
        return None
    target = arguments.whole_number("target", target, 1, f"pass the number of quads, up to {_MOST_QUADS}")
    if target > _MOST_QUADS:
        arguments.refuse("target", target, f"pass the number of quads, up to {_MOST_QUADS}")
    return math.sqrt(_area(surface) / target)


def _area(surface: Surface) -> float:
    with np.errstate(over="ignore", invalid="ignore"):  # the verbs refuse such a surface by name
        return float(triangle_areas(surface).sum())


def _wide_cones(solver: Solver, given: GivenCones, options: Options, progress: Progress | None) -> _lsgp.CompletedCones:
    """Those of `complete_cones`, but where it places one of 90 degrees that is held at 180, and others are placed
    besides."""
    completed = complete_cones(solver, given, options, share_of(progress, 0.0, 0.5))
    held, done = np.empty(0, np.int32), 0.5
    for _ in range(_MOST_HOLDS):
        is_narrow = [angle is not None and angle < _NARROW for angle in completed.angles]
        narrow = np.setdiff1d(completed.cones[np.array(is_narrow, bool)], given.cones)
        if not len(narrow):
            break
        held = np.union1d(held, narrow).astype(np.int32)
        begin, done = done, (1 + done) / 2
        again = complete_cones(solver, held_open(given, held), options, share_of(progress, begin, done))
        if again.placement is None:
            break  # there is no other place: what the narrow cones are refused for is said of them
        completed = again
    return completed


class _Layouts:
    """Layouts of one surface through the same cones, on grids of any size.

    solver: of the surface, which keeps what several of these have in common. options: seamless ones, with the side of
        the first grid's cells.
    """

    def __init__(self, solver: Solver, completed: _lsgp.CompletedCones, options: Options) -> None:
        self._solver, self._completed, self._options = solver, completed, options

    def nearest(self, target: int | None, progress: Progress | None, first: Result | None = None) -> Result:
        """On the first grid, or on one of a few other sizes where rounding has taken that away from its target, if that
        does not follow fewer features.  first: the layout on the first grid, if known."""
        side, done = self._options.seamless.tile_size, 0.5
        layout = nearest = self.first(share_of(progress, 0.0, done)) if first is None else first
        if target is None or _is_refined(layout):
            return layout
        sides: dict[bool, float] = {}  # the last one with fewer quads than the target, and with more
        for near in _NEAR_ENOUGH:
            if abs(_quad_count(nearest) - target) <= near * target:
                break
            quads = _quad_count(layout)
            sides[quads > target] = side
            # The number jumps where rounding changes, so that scaling may miss the target on both sides in turn.
            side = math.sqrt(math.prod(sides.values())) if len(sides) == 2 else side * math.sqrt(quads / target)
            begin, done = done, (1 + done) / 2
            layout = self._lay_out(side, share_of(progress, begin, done))
            nearest = min(nearest, layout, key=lambda found: _missed(found, target))
            if 0 < feature_share(nearest) < _NEARLY_ALL:
                break  # further sizes would follow other features
        return nearest

    def first(self, progress: Progress | None) -> Result:
        """On the first grid."""
        return self._lay_out(self._options.seamless.tile_size, progress)

    def extracted(self, layout: Result, asked: float, progress: Progress | None) -> tuple[QuadMesh, Result]:
        """The quads of a layout, and that layout. Where they are no mesh, those of the first finer grid on which they
        are, or of a coarser one with some rows divided, if there are far fewer of these.

        asked: the number of quads that was asked for, 0 for any. Raises SolverError: TOO_MANY_QUADS.
        """
        done, places, fewest = 0.0, None, None
        for refinement in range(_MOST_REFINEMENTS + 1):
            half = (1 + done) / 2
            try:
                mesh = self._extract(layout, asked, share_of(progress, done, half))
            except SolverError as error:
                if error.code != "GRID_TOO_COARSE" or refinement == _MOST_REFINEMENTS:
                    raise
                places = error.elements if places is None else places
            else:
                return mesh, _told(layout, mesh, asked, places)
            divided = self._with_divided_rows(layout, asked)
            if divided is not None and (fewest is None or len(divided.quads) < len(fewest[0].quads)):
                fewest = divided, layout
            if fewest is not None and _quad_count(layout) / _FINER**2 > _MORE_QUADS * len(fewest[0].quads):
                break
            done = (1 + half) / 2
            layout = self._lay_out(_FINER * layout.seamless.tile_size, share_of(progress, half, done))
        mesh, layout = fewest
        return mesh, _told(layout, mesh, asked, places)

    def _extract(self, layout: Result, asked: float, progress: Progress | None) -> QuadMesh:
        _refuse_far_above(asked, layout)
        return extract_quads(self._solver.surface, layout.corner_uv, self._options.seamless.cell, progress)

    def _with_divided_rows(self, layout: Result, asked: float) -> QuadMesh | None:
        """As few rows of the grid as possible divided in two or three, so that its quads are a mesh; None if even all
        of them are too few."""
        for parts in _PARTS_OF_ROWS:
            if parts**2 * _quad_count(layout) > _MANY_QUADS:
                return None
            cell = self._options.seamless.cell / parts
            try:
                mesh = extract_quads(self._solver.surface, layout.corner_uv, cell)
            except SolverError as error:
                if error.code != "GRID_TOO_COARSE":
                    raise
                continue
            uv = np.einsum("vc,vck->vk", mesh.weights, layout.corner_uv[mesh.triangles]) / cell
            lines = QuadLines(mesh.quads, (np.round(uv) % parts == 0).all(axis=1))
            lines.leave_out(math.ceil(asked))
            return _without_lines(mesh, lines)
        return None

    def _lay_out(self, side: float | None, progress: Progress | None) -> Result:
        options = replace(self._options, seamless=replace(self._options.seamless, tile_size=side))
        return lay_out(self._solver, self._completed, options, progress)


def _along_features(
    asked: tuple[Solver, int | None, Options],
    cones: tuple[_lsgp.CompletedCones, _lsgp.CompletedCones],
    progress: Progress | None,
) -> tuple[_Layouts, Result]:
    """Layouts along creases, and the nearest of them to the target: through the cones for creases, which are the first,
    or where these gain less, through the usual ones; plain layouts where both cost much more for what they follow."""
    solver, target, options = asked
    for_features, usual = cones
    plain = _Layouts(solver, usual, replace(options, straighten=False))
    first = plain.first(share_of(progress, 0.0, _PLAIN))
    along = share_of(progress, _PLAIN, _ALONG)
    found = or_none(lambda: _whole_or_between(solver, target, for_features, options, along))
    affordable = [found] if found is not None and _is_affordable(found[1], first) else []
    if affordable and not releases_many_features(affordable[0][1]):
        return affordable[0]
    others = _whole_or_between(solver, target, usual, options, share_of(progress, _ALONG, 1.0))
    if _is_affordable(others[1], first):
        affordable.insert(0, others)
    if not affordable:
        return plain, plain.nearest(target, share_of(progress, 1.0, 1.0), first)
    return max(affordable, key=lambda of: feature_share(of[1]))


def _whole_or_between(
    solver: Solver, target: int | None, cones: _lsgp.CompletedCones, options: Options, progress: Progress | None
) -> tuple[_Layouts, Result]:
    """Layouts through these cones, and the nearest to the target. On a coarse grid few features find a place on whole
    cells; quads nearly follow those that lie between."""
    layouts = _Layouts(solver, cones, options)
    layout = layouts.nearest(target, share_of(progress, 0.0, 0.5))
    has_features = layout.features is not None or layout.seamless.feature_share is not None
    # A grid that was refined for its cones is fine enough for the features that can be followed.
    if not has_features or runs_along_features(layout) or _is_refined(layout):
        return layouts, layout
    between = _Layouts(solver, cones, replace(options, seamless=replace(options.seamless, feature_places="anywhere")))
    other = between.nearest(target, share_of(progress, 0.5, 1.0))
    return (between, other) if feature_share(other) > feature_share(layout) else (layouts, layout)


def _missed(layout: Result, target: int) -> float:
    """How far a layout is from the target, as a share of it; less, the more features it follows."""
    return abs(_quad_count(layout) - target) / target - _WORTH_OF_FEATURES * feature_share(layout)


def _is_affordable(along: Result, plain: Result) -> bool:
    """Whether following creases costs little stretch for their share, and no further defects. Overlaps in the plane are
    none."""
    return (
        along.solved.tolist() == plain.solved.tolist()
        and len(along.flipped) + len(along.wrong_angle_sums) <= len(plain.flipped) + len(plain.wrong_angle_sums)
        and along.distortion.l2_stretch <= _most_stretch(feature_share(along)) * plain.distortion.l2_stretch
    )


def _most_stretch(share: float) -> float:
    """What following this share of the features may cost in L2 stretch, as a factor."""
    return 1 + (_MOST_L2_ALONG - 1) * max(0.0, share)


def _is_close(along: Result) -> bool:
    """Whether nothing is to be gained for features."""
    return feature_share(along) >= _NEARLY_ALL and along.distortion.l2_stretch <= _NEARLY_ISOMETRIC


def _divided(surface: Surface, steps: Steps) -> DividedSurface | None:
    """The surface with long edges divided; None if none is long. Cones, and what is between features, need vertices
    inside faces, of which models with flat faces have few."""
    if len(surface.borders):
        return None
    finer = divide_long_edges(surface, _LONGEST_EDGE * math.sqrt(_area(surface)), steps)
    return finer if len(finer.triangles) > len(surface.triangles) else None


def _gained(
    surface: Surface, target: int | None, options: Options, before: Result, progress: Progress | None
) -> tuple[DividedSurface, _Layouts, Result] | None:
    """The surface with long edges divided, and layouts along features on it, if they follow more of them than the one
    before, or as many at less stretch."""
    finer = _divided(surface, Steps(share_of(progress, 0.0, _DIVIDED)))
    if finer is None:
        return None
    progress = share_of(progress, _DIVIDED, 1.0)
    solver = Solver(finer.surface)
    cones = feature_cones(solver, options, share_of(progress, 0.0, _FOR_FEATURES))
    if cones is None:
        return None
    layouts = _Layouts(solver, cones, options)
    first = layouts.first(share_of(progress, _FOR_FEATURES, 0.5))
    if runs_along_features(before) and feature_share(first) < _PROMISING * feature_share(before):
        return None
    layout = layouts.nearest(target, share_of(progress, 0.5, 1.0), first)
    more = feature_share(layout) - feature_share(before)
    has_less_stretch = layout.distortion.l2_stretch - 1 < _LESS_STRETCH * (before.distortion.l2_stretch - 1)
    if not (more > _FEW_FEATURES or (more > -_FEW_FEATURES and has_less_stretch)):
        return None
    if layout.distortion.l2_stretch > _most_stretch(more) * before.distortion.l2_stretch:
        return None
    has_many = _quad_count(layout) > _MORE_QUADS * max(_quad_count(before), target or 0)
    return None if has_many else (finer, layouts, layout)


def _undivided(mesh: QuadMesh, finer: DividedSurface) -> QuadMesh:
    """The same mesh with its places on the surface that was divided."""
    weights = np.einsum("vc,vck->vk", mesh.weights, finer.corners[mesh.triangles])
    weights /= weights.sum(axis=1, keepdims=True)
    is_given = mesh.surface_vertices < len(finer.source.positions)
    vertices = np.where(is_given, mesh.surface_vertices, -1).astype(np.int32)
    return replace(mesh, triangles=finer.triangles[mesh.triangles], weights=weights, surface_vertices=vertices)


def _without_lines(mesh: QuadMesh, lines: QuadLines) -> QuadMesh:
    """The mesh without the lines that are left out."""
    quads, kept = lines.mesh()
    of_vertices = {field.name: getattr(mesh, field.name)[kept] for field in fields(mesh) if field.name != "quads"}
    return QuadMesh(quads=quads, **of_vertices)


def _told(layout: Result, mesh: QuadMesh, asked: float, places: Elements | None) -> Result:
    """The layout with a warning if it is finer, or its quads are more, than was asked for.  places: where quads as
    large as that are no mesh; None if they are one."""
    others = [finding for finding in layout.warnings if finding.code != "GRID_REFINED"]
    if places is None and len(others) == len(layout.warnings):
        return layout
    count = f"{len(mesh.quads)} quads" + (f" instead of {round(asked)}" if asked else "")
    if places is None:
        why = "cones are closer to each other than quads as large as requested, or a component is hardly larger"
    else:
        why = (
            f"at {counted(len(places.indices), 'triangle')} a quad as large as requested would have a vertex twice, or "
            "two vertices more than one edge, as around a handle or tube with less than three quads around it"
        )
    remedy = "Ask for more quads, use fewer cones, or close small tunnels."
    refined = Finding("GRID_REFINED", f"There are {count}: {why}. {remedy}", places or Elements())
    return replace(layout, warnings=[*others, refined])


def _refuse_far_above(asked: float, layout: Result) -> None:
    quads = _quad_count(layout)
    if quads <= max(_MANY_QUADS, _FAR_ABOVE * asked):
        return
    raise SolverError(
        "TOO_MANY_QUADS",
        f"The grid has {quads} quads: cones close to each other require small ones, and all large components have "
        f"quads of one size. Use fewer cones, ask for a number (target, or --target), {quads} for as many, or remesh "
        "components by themselves.",
    )


def _is_refined(layout: Result) -> bool:
    return any(finding.code == "GRID_REFINED" for finding in layout.warnings)


def _quad_count(layout: Result) -> int:
    """The cells of the part that is laid out."""
    return round(uv_area(layout.corner_uv[layout.solved]) / layout.seamless.cell**2)
