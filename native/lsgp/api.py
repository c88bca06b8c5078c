# SPDX-License-Identifier: GPL-3.0-or-later
"""The functions of the library over numpy arrays: validation of the call, the native core, typed results."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _lsgp
from .base import arguments
from .base.arguments import FloatArray, IndexArray
from .base.progress import Progress
from .options import BorderMode, Lattice, Options, SeamMode, thread_count
from .results import (
    Chart,
    ConeGains,
    CutPaths,
    Distortion,
    FeatureReport,
    Measurement,
    Placement,
    Prescription,
    ReleasedFeature,
    RepairReport,
    Result,
    SeamlessReport,
    SeamQuality,
    Tubes,
)
from .surface import Pins, Surface, surface_arrays


def parameterize(
    surface: Surface,
    cones: ArrayLike,
    angles: Sequence[float | None] | FloatArray | None = None,
    options: Options = Options(),
    pins: Pins | None = None,
    progress: Progress | None = None,
) -> Result:
    """Cut the surface through its cones and unfold it with exact transitions across every cut.

    cones: (k,) int32 vertex indices. angles: one total angle in radians per cone, None = automatic.
    pins: two or more on a component determine its position, size and rotation, and its map meets all of them; one
        determines its position.
    Components that cannot be solved are named in a warning if others can; otherwise the first error is raised.
    progress: called at intervals with the fraction done, 0 to 1; if it returns False, Cancelled is raised; its own
        exceptions propagate.
    Raises InputError, TopologyError, CurvatureError, SolverError, Cancelled.

    >>> result = lsgp.parameterize(surface, cones=[0, 1, 2, 3], angles=[math.pi, math.pi, None, None])
    >>> result.cone_angles.round(3)
    array([3.142, 3.142, 3.142, 3.142])
    >>> len(result.flipped), len(result.warnings)
    (0, 0)
    """
    arrays = surface_arrays(surface)
    out = _lsgp.parameterize(arrays, *_call(cones, angles, options, pins, progress))
    return to_result(out, surface.borders)


class Solver:
    """Parameterizes one surface repeatedly, for instance while a cone is dragged or an angle is tried, or once cones
    are placed.

    Every call returns the same as the function of that name and caches data for the next one: the surface's topology
    and geometry, and, as long as a component's cones do not move, its factored linear systems, also those of the cones
    that `place_cones` has placed. Angles and all options except `seams`, `border` and `factorization`, including those
    of seamless layouts, can then change without a new factorization. A seamless layout that differs from the previous
    one only in the size of its tiles takes only their rounding: the map, and which creases run along the lattice, are
    kept. The map is kept, too, if only `straighten` differs. The latest few placements on each component are kept, and
    so are its maps that are seamless or split; they serve calls that differ on other components.
    A call during another one, from another thread or from its progress callback, raises SolverError (SOLVER_BUSY).

    surface: the one to parameterize. earlier: solver of a similar surface, as with other borders: what either finds on
        components that are the same on both serves the other as well. Both are busy during a call of one of them.
    """

    def __init__(self, surface: Surface, earlier: Solver | None = None) -> None:
        if earlier is not None:
            arguments.require_type("earlier", earlier, Solver)
        self._solver = _lsgp.Solver(surface_arrays(surface), None if earlier is None else earlier._solver)
        self._surface = surface

    @property
    def surface(self) -> Surface:
        return self._surface

    def parameterize(
        self,
        cones: ArrayLike,
        angles: Sequence[float | None] | FloatArray | None = None,
        options: Options = Options(),
        pins: Pins | None = None,
        progress: Progress | None = None,
    ) -> Result:
        """Arguments, result and errors as for `lsgp.parameterize`."""
        out = self._solver.parameterize(*_call(cones, angles, options, pins, progress))
        return to_result(out, self._surface.borders)

    def place_cones(
        self,
        cones: ArrayLike = (),
        angles: Sequence[float | None] | FloatArray | None = None,
        *,
        progress: Progress | None = None,
        **options: Any,
    ) -> Placement:
        """Arguments, result and errors as for `lsgp.place_cones`, whose others are options here."""
        return place_cones(self, cones, angles, progress=progress, **options)


class Preview:
    """Approximates the maps of a large surface at the speed of a small one, for instance while a cone is dragged.

    The surface is reduced to few triangles once, which takes about as long as a map. Boundaries, seams, borders,
    features, and vertices and edges that are not manifold stay as they are.

    surface: the one to parameterize. triangles: about how many it is reduced to; if it has no more, maps are exact.
    progress: as for `parameterize`.  Raises InputError, SolverError (OUT_OF_MEMORY), Cancelled.
    """

    def __init__(self, surface: Surface, *, triangles: int = 8_000, progress: Progress | None = None) -> None:
        arguments.require_callable(progress)
        count = arguments.whole_number("triangles", triangles, 1, "pass a number of triangles from 1")
        self._preview = _lsgp.Preview(surface_arrays(surface), count, progress)
        self._surface = surface

    @property
    def surface(self) -> Surface:
        return self._surface

    def parameterize(
        self,
        cones: ArrayLike,
        angles: Sequence[float | None] | FloatArray | None = None,
        options: Options = Options(),
        progress: Progress | None = None,
    ) -> Result:
        """Arguments and errors as for `lsgp.parameterize`, without `pins` and seamless layouts, which must be exact.

        The result is that of the reduced surface with the cones, carried over to the whole one: `corner_uv`,
        `log_scale`, and `cut_edges` along edges beside the cuts there. What is measured is measured there, overlaps are
        not; `flipped`, `wrong_angle_sums` and `overlapping` are empty, and findings name no triangles. Calls may run at
        the same time.

        >>> preview = lsgp.Preview(surface)
        >>> preview.parameterize([0, 1, 2, 3]).cone_angles.round(3)
        array([3.142, 3.142, 3.142, 3.142])
        """
        arguments.require_callable(progress)
        out = self._preview.parameterize(*cone_arrays(cones, angles, options), progress)
        return to_result(out, self._surface.borders)


def _call(
    cones: ArrayLike,
    angles: Sequence[float | None] | FloatArray | None,
    options: Options,
    pins: Pins | None,
    progress: Progress | None,
) -> tuple[Any, ...]:
    arguments.require_callable(progress)
    return *cone_arrays(cones, angles, options), pin_arrays(pins), progress


def pin_arrays(pins: Pins | None) -> tuple[IndexArray, FloatArray]:
    if not (pins is None or isinstance(pins, Pins)):
        arguments.refuse("pins", pins, "pass Pins, or None")
    return (np.empty(0, np.int32), np.empty((0, 2))) if pins is None else (pins.corners, pins.uv)


def to_result(out: dict[str, Any], borders: IndexArray) -> Result:
    out["repair"] = RepairReport(**out["repair"])
    out["distortion"] = Distortion(**out["distortion"])
    out["seams"] = SeamQuality(**out["seams"])
    out["seamless"] = None if out["seamless"] is None else SeamlessReport(**out["seamless"])
    out["features"] = None if out["features"] is None else _to_feature_report(out["features"])
    return Result(borders=borders, **out)


def _to_feature_report(out: dict[str, Any]) -> FeatureReport:
    return FeatureReport(out["share"], [ReleasedFeature(**feature) for feature in out["released"]])


def find_cuts(
    surface: Surface, cones: ArrayLike, options: Options = Options(), progress: Progress | None = None
) -> CutPaths:
    """Cuts that join all cones and boundary loops and open every handle, as short as a local search finds them.

    If the surface has cut costs, these are minimized instead. A map may need fewer cuts: holes about which the metric
    turns once are not cut.

    progress: as for `parameterize`.  Raises InputError, TopologyError, Cancelled.
    """
    arguments.require_callable(progress)
    (vertices, _, _), values = cone_arrays(cones, None, options)
    return CutPaths(**_lsgp.find_cuts(surface_arrays(surface), vertices, values, progress))


def measure_charts(surface: Surface, options: Options = Options(), progress: Progress | None = None) -> list[Chart]:
    """The charts that the surface's marked seams bound: which of them are disks, what cuts the others lack, and how
    good their maps are without cones and further cuts.

    options: of these maps, but for `seams`, which is "exact". progress: as for `parameterize`.
    Raises InputError, SolverError, Cancelled.

    >>> marked = lsgp.Surface(surface.positions, surface.triangles, seams=[[0, 1], [0, 2], [0, 3]])
    >>> [(chart.is_disk, round(chart.l2_stretch, 3)) for chart in lsgp.measure_charts(marked)]
    [(True, 1.0)]
    """
    arguments.require_callable(progress)
    _, values = cone_arrays((), None, options)
    return [Chart(**chart) for chart in _lsgp.measure_charts(surface_arrays(surface), values, progress)]


def crease_borders(
    surface: Surface,
    cones: ArrayLike = (),
    *,
    angle: float = 0.7,
    sharp: ArrayLike | None = None,
    most_corners: int = 0,
    least_share: float = 0.8,
    progress: Progress | None = None,
) -> IndexArray:
    """Edges for `Surface.borders`, (b, 2) int32, with which hard surfaces unfold without stretch and without cones.

    The regions between creases are patches. Patches are unfolded together across shared boundary segments that are
    straight and not short, and a tube is opened from end to end: a cylinder becomes a rectangle and two disks.
    Narrow bevels that turn the surface by `angle` are creases along their middle; edges of coarse round shapes, of less
    than 1.27 radians and like their neighbors, are none. Components with cones or marked seams, and those with less
    than `least_share` of their curvature on creases, or 98 % on creases and bevels, have no such edges; half of it may
    be at one or two apexes, which remain for cones.
    angle: least angle between the normals at a crease, radians.
    sharp: (s, 2) int32, edges that are creases whatever their angle.
    most_corners: components with their curvature at no more vertices than this have none, since cones there serve as
        well.
    least_share: of the curvature, from 0 to 1; with less than 0.8 the pieces are stretched.
    progress: as for `parameterize`.  Raises InputError, TopologyError, Cancelled.
    """
    arguments.require_callable(progress)
    marked = np.empty((0, 2), np.int32) if sharp is None else arguments.index_rows("sharp", sharp, 2)
    start = arguments.positive("angle", angle, "pass an angle above 0, at most pi")
    corners = arguments.whole_number("most_corners", most_corners, 0, "pass a whole number from 0")
    share = arguments.number("least_share", least_share, "pass a number from 0 to 1")
    if not 0 <= share <= 1:
        arguments.refuse("least_share", least_share, "pass a number from 0 to 1")
    vertices = arguments.index_vector("cones", cones)
    return _lsgp.crease_borders(surface_arrays(surface), vertices, (start, marked, corners, share), progress)


def find_tubes(surface: Surface, cones: ArrayLike = (), *, progress: Progress | None = None) -> Tubes:
    """The tubes of components that consist of them for four fifths of their area or more, and handles of others.

    Between its borders a tube unfolds into a strip with `Options.border` "strips". It ends where other faces than quads
    follow, or where the cone that a ring lies on develops into more than half a disk; one that is closed on itself, as
    a knot is, ends nowhere. A quad is two triangles on both sides of an edge that is not among `Surface.edges`; if that
    is None, on both sides of the longest edge of both. Handles and what is closed on itself are tubes only if their
    strips would be stretched by no more than 1.05, the latter of even girth; components of 30,000 triangles or more are
    not searched for handles. Components with cones or marked seams have none, but for tubes that seams open from one
    end to the other.
    progress: as for `parameterize`.  Raises InputError, TopologyError, Cancelled.
    """
    arguments.require_callable(progress)
    vertices = arguments.index_vector("cones", cones)
    return Tubes(*_lsgp.find_tubes(surface_arrays(surface), vertices, progress))


def cut_costs(
    surface: Surface,
    front: ArrayLike | None = None,
    *,
    creases: bool = True,
    sharp: ArrayLike | None = None,
    paint: ArrayLike | None = None,
    progress: Progress | None = None,
) -> FloatArray:
    """The cost per length of a cut along each of the surface's `edges`, (e,) float64, for `Surface.cut_costs`.

    front: (3,), the direction from the surface to the viewer; cuts are hidden from the views around it: a cost is
        0.1 + 30 s³ where a share s of the views sees the edge. None: visibility has no effect.
    creases: costs fall to 0.12 of that, and what sight adds once more as much, along edges where the surface bends by
        50 degrees or more, not below 30.
    sharp: (s, 2) int32, edges that are creases whatever their angle.
    paint: (n,) float64, from 0 at vertices that attract cuts, for a tenth of the cost, to 1 at vertices that repel
        them, for ten times the cost. None: no effect.
    progress: as for `parameterize`.  Raises InputError, Cancelled.
    """
    arguments.require_callable(progress)
    arrays = surface_arrays(surface)
    direction = None if front is None else tuple(arguments.floats_of_shape("front", front, (3,)).tolist())
    marked = np.empty((0, 2), np.int32) if sharp is None else arguments.index_rows("sharp", sharp, 2)
    painted = np.empty(0) if paint is None else arguments.floats_of_shape("paint", paint, (len(surface.positions),))
    bends = arguments.flag("creases", creases)
    return _lsgp.cut_costs(arrays, (direction, bends, marked, painted), progress)


def prescribe_curvature(
    surface: Surface,
    cones: ArrayLike,
    angles: Sequence[float | None] | FloatArray | None = None,
    options: Options = Options(),
    progress: Progress | None = None,
) -> Prescription:
    """Cone angles and log scale without unfolding.  Arguments and errors as in `parameterize`.

    A map has other angles where it follows strokes, or where it was repaired, which ANGLES_ADJUSTED tells.
    """
    arguments.require_callable(progress)
    out = _lsgp.prescribe_curvature(surface_arrays(surface), *cone_arrays(cones, angles, options), progress)
    return Prescription(**out)


def place_cones(
    surface: Surface | Solver,
    cones: ArrayLike = (),
    angles: Sequence[float | None] | FloatArray | None = None,
    *,
    count: int | None = None,
    target: float = 1.05,
    lattice: Lattice | None = None,
    prefer_sharp: bool = False,
    symmetric: bool = False,
    mirror: tuple[ArrayLike, ArrayLike] | None = None,
    follow_strokes: bool = True,
    seams: SeamMode = "follow",
    border: BorderMode = "free",
    threads: int = 0,
    progress: Progress | None = None,
) -> Placement:
    """Place cones where they lower the stretch most, with their angles.

    surface: a `Surface`, or a `Solver` of one, which caches data for later calls.
    cones, angles: existing cones and their fixed angles, which are kept; None = automatic.
    count: cones per component, including existing ones; a component without room for so many gets fewer, and a warning
        names it. If the map with this number is unusable, the error or warning says how many None gives. None: the
        fewest that bring the L2 stretch of the map to `target`.
    lattice: angles become multiples of its rotation, for a seamless layout. If the surface has directions and no
        `count` is given, cones are placed only where directions are not parallel, provided that the texture is then at
        most 7 degrees off them, or half as far as otherwise, and the stretch within 1.2: around the bottom of a vase,
        and none in a sleeve.
    prefer_sharp: prefer sharp corners to smooth regions if that costs little.
    symmetric: the same cones on both sides of a plane, given by `mirror`, a point on it and its normal, or, if that is
        None, detected; also on surfaces that are symmetric only up to 2 % of their extent, and on components that
        mirror each other.
    follow_strokes: angles are chosen for several directions, as in `Options`.
    seams, progress: as for `parameterize`, which treats the placed cones and angles as assumed here: with "follow" a
        component that gets cones is not opened along its seams. border: as in `Options`; with "strips", tubes
        between two boundaries get no cones. threads: as in `Options`.
    If the surface has cut_costs, cones are placed where cuts reach them cheaply, provided that the stretch stays within
    the target or that of as many cones elsewhere; without `count` there may be a quarter more of them.
    No cone is placed on a boundary, at a vertex that cuts cannot reach, or, if the mesh has room, within two rings of
    another.
    Raises InputError, TopologyError, CurvatureError, SolverError, Cancelled.

    >>> placed = lsgp.place_cones(surface)
    >>> placed.cones.tolist(), placed.reached
    ([0, 1, 2, 3], True)
    """
    arguments.require_callable(progress)
    if count is not None:
        count = arguments.whole_number("count", count, 0, "pass a number of cones, or None for automatic")
    if lattice is not None:
        arguments.require_choice("lattice", lattice, get_args(Lattice))
    arguments.require_choice("seams", seams, get_args(SeamMode))
    arguments.require_choice("border", border, get_args(BorderMode))
    options = {
        "count": count,
        "target": arguments.number("target", target, "pass an L2 stretch, a number above 1"),
        "lattice": lattice,
        "prefer_sharp": arguments.flag("prefer_sharp", prefer_sharp),
        "symmetric": arguments.flag("symmetric", symmetric),
        "mirror": None if mirror is None else _mirror_numbers(mirror),
        "follow_strokes": arguments.flag("follow_strokes", follow_strokes),
        "seams": seams,
        "border": border,
        "threads": thread_count(threads),
    }
    given = given_cones(cones, angles)
    if isinstance(surface, Solver):
        return Placement(**surface._solver.place_cones(given, options, progress))
    return Placement(**_lsgp.place_cones(surface_arrays(surface), given, options, progress))


def cone_gains(
    surface: Surface,
    cones: ArrayLike = (),
    angles: Sequence[float | None] | FloatArray | None = None,
    *,
    seams: SeamMode = "follow",
    progress: Progress | None = None,
) -> ConeGains:
    """The predicted stretch with one more cone, for every vertex.  Arguments and errors as in `place_cones`."""
    arguments.require_callable(progress)
    arguments.require_choice("seams", seams, get_args(SeamMode))
    return ConeGains(**_lsgp.cone_gains(surface_arrays(surface), given_cones(cones, angles), seams, progress))


def measure_distortion(
    surface: Surface, corner_uv: ArrayLike, cones: ArrayLike | None = None, progress: Progress | None = None
) -> Measurement:
    """Measure given texture coordinates, (m, 3, 2) float64, one (u, v) per triangle corner; triangles with a
    coordinate that is not finite are left out.

    cones: (k,) int32, the vertices at which a cut may change its rotation; None: every vertex whose angles do not add
    up to a full turn. progress: as for `parameterize`.  Raises InputError, Cancelled.

    >>> corner_uv = surface.positions[surface.triangles][:, :, :2]  # seen from above
    >>> measured = lsgp.measure_distortion(surface, corner_uv)
    >>> len(measured.flipped), measured.distortion.l2_stretch > 1
    (2, True)
    """
    arguments.require_callable(progress)
    arrays = surface_arrays(surface)
    uv = arguments.corner_coordinates("corner_uv", corner_uv, len(surface.triangles))
    vertices = None if cones is None else arguments.index_vector("cones", cones)
    out = _lsgp.measure_distortion(arrays, uv, vertices, progress)
    out["distortion"] = Distortion(**out["distortion"])
    out["seams"] = SeamQuality(**out["seams"])
    return Measurement(**out)


def given_cones(
    cones: ArrayLike, angles: Sequence[float | None] | FloatArray | None
) -> tuple[IndexArray, FloatArray, NDArray[np.bool_]]:
    """Vertices, angles, and which of them are given."""
    vertices = arguments.index_vector("cones", cones)
    given = arguments.cone_angles("angles", angles, len(vertices))
    has_angle = np.array([angle is not None for angle in given], bool)
    values = np.array([0.0 if angle is None else angle for angle in given], np.float64)
    return vertices, values, has_angle


def _mirror_numbers(mirror: tuple[ArrayLike, ArrayLike]) -> list[float]:
    """A point on the plane and its normal."""
    return arguments.floats_of_shape("mirror", mirror, (2, 3), ", a point and a normal").ravel().tolist()


def cone_arrays(
    cones: ArrayLike, angles: Sequence[float | None] | FloatArray | None, options: Options
) -> tuple[tuple[IndexArray, FloatArray, NDArray[np.bool_]], dict[str, Any]]:
    """The cones, and the options with the rule for the angles that are not given."""
    arguments.require_type("options", options, Options)
    given = given_cones(cones, angles)
    rule = options.prescription or ("manual" if given[2].any() else "least-distortion")
    return given, {**option_values(options), "prescription": rule}


def option_values(options: Options) -> dict[str, Any]:
    """Where its rule for the angles is None, it follows from the cones."""
    return {**vars(options), "seamless": None if options.seamless is None else vars(options.seamless)}
