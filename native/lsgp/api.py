# SPDX-License-Identifier: GPL-3.0-or-later
"""The verbs of the library over numpy arrays: validation of the call, the native core, typed results."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from numbers import Integral, Real
from typing import Any, Literal, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _lsgp
from .errors import Finding, InputError

FloatArray = NDArray[np.float64]
IndexArray = NDArray[np.int32]

PrescriptionRule = Literal["least-distortion", "harmonic", "straightness", "manual"]
UnfoldMethod = Literal["poisson", "spectral"]
Method = Literal["lsgp", "lscm"]
SeamMode = Literal["follow", "boundary", "ignore"]
BorderMode = Literal["free", "straight"]
Lattice = Literal["square", "stripe", "translation", "triangle", "hexagon"]
CoarseGrid = Literal["refine", "merge", "relax"]
Mode = Literal["conformal", "low-stretch"]
Overlaps = Literal["keep", "split"]
Factorization = Literal["automatic", "cut", "sparse"]

Progress = Callable[[float], bool | None]


def _require_choice(name: str, value: Any, choices: tuple[str, ...]) -> None:
    if value not in choices:
        raise InputError("WRONG_PARAMETER", f"{name} is {value!r}; choose one of {', '.join(choices)}.")


@dataclass(frozen=True)
class Surface:
    """A triangulated surface, possibly of several components, and the edges its cuts may follow.

    positions: (n, 3) float64, any unit.
    triangles: (m, 3) int32, counter-clockwise seen from outside.
    edges: (e, 2) int32, the edges a cut may follow (mesh edges, not the diagonals of triangulated polygons);
        None for all edges of the triangles.
    seams: (s, 2) int32, marked edges; `Options.seams` says what they mean.
    importance: (n,) float64, at least 0: how much stretch at each vertex weighs in the mode "low-stretch"; None: all
        vertices alike.
    """

    positions: FloatArray
    triangles: IndexArray
    edges: IndexArray | None = None
    seams: IndexArray | None = None
    importance: FloatArray | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "positions", _float_rows(self.positions, 3, "positions"))
        object.__setattr__(self, "triangles", _index_rows(self.triangles, 3, "triangles"))
        if self.edges is not None:
            object.__setattr__(self, "edges", _index_rows(self.edges, 2, "edges"))
        seams = np.empty((0, 2), np.int32) if self.seams is None else self.seams
        object.__setattr__(self, "seams", _index_rows(seams, 2, "seams"))
        if self.importance is not None:
            importance = np.asarray(self.importance)
            if importance.shape != (len(self.positions),):
                raise InputError(
                    "WRONG_SHAPE", f"importance has shape {importance.shape}; pass ({len(self.positions)},)."
                )
            object.__setattr__(self, "importance", _floats(importance, "importance"))


@dataclass(frozen=True)
class Pins:
    """Corners whose texture coordinates are to stay.

    corners: (p,) int32, 3 * triangle + corner. uv: (p, 2) float64.
    """

    corners: IndexArray
    uv: FloatArray

    def __post_init__(self) -> None:
        object.__setattr__(self, "corners", _index_vector(self.corners, "corners"))
        object.__setattr__(self, "uv", _float_rows(self.uv, 2, "uv"))


_CHOICES = {
    "prescription": PrescriptionRule,
    "unfold": UnfoldMethod,
    "method": Method,
    "seams": SeamMode,
    "border": BorderMode,
    "mode": Mode,
    "overlaps": Overlaps,
    "factorization": Factorization,
}


@dataclass(frozen=True)
class Seamless:
    """A layout in which a tileable texture shows no seam (the paper's section 8).

    Cone angles become multiples of the lattice's turn, and translations across cuts lead from lattice point to lattice
    point. Coordinates are exact in float32: do not scale them afterwards but by powers of two.

    lattice: "square": quarter turns of unit squares; "stripe": half turns of unit squares; "translation": unit squares
        without turns; "triangle": third turns of triangles of side 1; "hexagon": sixth turns of them.
    tiles: cells along the layout's longer side, before rounding. tile_size: or the side of a cell on the surface, in
        its unit. Neither: the coarsest grid that is valid and costs at most a tenth in distortion.
    parity: square lattice only: black and white cells match across cuts as well.
    coarse_grid: where no layout is valid on a grid as coarse as that: "refine" takes the next finer one, "merge" merges
        cones less than a cell apart, "relax" leaves cones off the grid that find no place on it.
    cell: side of a cell in texture coordinates, a power of two. 1 is a whole tile; 2**level / size makes translations
        multiples of 2**level texels of a texture of that size, so that its mipmaps match up to that level.
    """

    lattice: Lattice = "square"
    tiles: float | None = None
    tile_size: float | None = None
    parity: bool = False
    coarse_grid: CoarseGrid = "refine"
    cell: float = 1.0

    def __post_init__(self) -> None:
        _require_choice("lattice", self.lattice, get_args(Lattice))
        _require_choice("coarse_grid", self.coarse_grid, get_args(CoarseGrid))
        for name in ("tiles", "tile_size", "cell"):
            value = getattr(self, name)
            if value is None and name != "cell":
                continue
            if not isinstance(value, Real) or isinstance(value, bool):
                raise InputError("WRONG_PARAMETER", f"{name} is {value!r}; pass a number.")


@dataclass(frozen=True)
class Options:
    """How to prescribe the cone angles and how to unfold.

    prescription: the rule that chooses the automatic angles. None: "manual" where angles are given (those are kept,
        the other cones take up the rest with least distortion), "least-distortion" otherwise.
    unfold: "poisson" (robust, one linear solve) or "spectral" (the paper's, an eigenproblem; closed surfaces).
    method: "lsgp", or "lscm" for the paper's comparison: the same cuts without transitions.
    seams: "follow": cuts run along marked seams wherever they can, and seams that close off a part make it an island
        of its own; "boundary": every seam is an open border, as in Blender's own unwrap; "ignore".
        With "follow", a closed component without cones is opened along its seams.
    border: "free": angles along borders come out as they distort least, a cone there with an angle is a corner;
        "straight": borders run straight from marked cone to marked cone.
    loop_turning: total turning of borders, radians, by any vertex on each; others turn as they distort least. A free
        border about which the metric turns almost once, a hole, needs no cut and gets none.
    seamless: round angles and translations so that a tileable texture shows no seam; None: leave them.
    mode: "conformal" keeps angles; "low-stretch" keeps lengths as far as the cone angles let it.
    stretch: with "low-stretch", from 0, the conformal map, to 1, that of least stretch.
    repair: turn flipped triangles over and put angles right that are off by a turn.
    overlaps: "keep" islands that lie on themselves, or "split" them along further cuts until none does; transitions
        stay exact.
    factorization: how linear systems are solved, the maps being the same but for rounding: "cut" factors once and
        leaves dense problems of the size of the cut, "sparse" factors for every step, "automatic" takes the cheaper.
    """

    prescription: PrescriptionRule | None = None
    unfold: UnfoldMethod = "poisson"
    method: Method = "lsgp"
    seams: SeamMode = "follow"
    border: BorderMode = "free"
    loop_turning: Mapping[int, float] = field(default_factory=dict)
    seamless: Seamless | None = None
    mode: Mode = "conformal"
    stretch: float = 1.0
    repair: bool = True
    overlaps: Overlaps = "keep"
    factorization: Factorization = "automatic"

    def __post_init__(self) -> None:
        for name, choices in _CHOICES.items():
            value = getattr(self, name)
            if not (name == "prescription" and value is None):
                _require_choice(name, value, get_args(choices))
        if not (self.seamless is None or isinstance(self.seamless, Seamless)):
            raise InputError("WRONG_PARAMETER", f"seamless is {self.seamless!r}; pass a Seamless, or None.")
        if not isinstance(self.stretch, Real) or isinstance(self.stretch, bool):
            raise InputError("WRONG_PARAMETER", f"stretch is {self.stretch!r}; pass a number from 0 to 1.")
        if not isinstance(self.repair, bool):
            raise InputError("WRONG_PARAMETER", f"repair is {self.repair!r}; pass True or False.")
        if not isinstance(self.loop_turning, Mapping):
            raise InputError(
                "WRONG_PARAMETER", f"loop_turning is {self.loop_turning!r}; pass angles by vertices of borders."
            )
        for vertex, turning in self.loop_turning.items():
            if (
                not isinstance(vertex, Integral)
                or not isinstance(turning, Real)
                or abs(vertex) > np.iinfo(np.int32).max
            ):
                wrong = f"{vertex!r}: {turning!r}"
                raise InputError("WRONG_PARAMETER", f"loop_turning holds {wrong}; pass angles by vertices of borders.")


@dataclass(frozen=True, slots=True)
class Distortion:
    """Quality of a map (the paper's section 7.1), over all solved triangles.

    quasi_conformal: mean of sigma_1 / sigma_2 over triangles; 1 is conformal.
    quasi_conformal_area_weighted: the same, weighted by 3D area.
    area: mean of (share of the 3D area) / (share of the UV area) over triangles; area_p10, area_p90 its percentiles.
    l2_stretch: L2 stretch of Sander et al. 2001, normalised; 1 is isometric.
    """

    quasi_conformal: float
    quasi_conformal_area_weighted: float
    area: float
    area_p10: float
    area_p90: float
    l2_stretch: float


@dataclass(frozen=True, slots=True)
class SeamQuality:
    """How exactly the two sides of every cut are related by one rotation and one translation.

    sister_ratio_max: largest ratio of the longer to the shorter of two sister edges; 1 is exact.
    rotation_residual: largest angle between a cut edge's own turn and its cut's rotation, radians.
    translation_residual: largest distance between a vertex and the image of its sister, relative to the layout's size.
    """

    sister_ratio_max: float
    rotation_residual: float
    translation_residual: float


@dataclass(frozen=True, slots=True)
class SeamlessReport:
    """What makes a layout seamless, and at what cost: the certificate of its cuts.

    A cut is crossed from its left side to its right one by z -> e^(2 pi i turns / symmetry) z + cell (a + b g), where g
    is i on square lattices and e^(i pi / 3) on triangular ones and z = u + iv.

    symmetry: rotations are multiples of 2 pi / symmetry. tiles: cells along the layout's longer side, before rounding.
    tile_size: side of a cell on the surface. cell: the same in texture coordinates.
    energy_before, energy_after: symmetric Dirichlet energy, 1 is isometric, around the rounding of the translations.
    cut_nodes: (c, 2) int32 vertices at the cuts' tails and heads. cut_turns: (c,) int32, 0 .. symmetry - 1.
    cut_translations: (c, 2) int64, (a, b). cut_errors: (c,) float64, the largest distance of a vertex, as float32
        stores it, from the image of its sister, in cells. error: the largest of them, 0 on square lattices.
    flat_cones: cones that came out flat and are none any more. merged_cones: cones given up for another within a cell.
    relaxed_cones: cones off the lattice; the cuts to them show a seam.
    """

    symmetry: int
    tiles: float
    tile_size: float
    cell: float
    energy_before: float
    energy_after: float
    cut_nodes: IndexArray
    cut_turns: IndexArray
    cut_translations: NDArray[np.int64]
    cut_errors: FloatArray
    error: float
    flat_cones: IndexArray
    merged_cones: IndexArray
    relaxed_cones: IndexArray


@dataclass(frozen=True, slots=True)
class RepairReport:
    """What the unfolding left to repair, and the work of that and of relaxing the map.

    flipped_before, wrong_angle_sums_before: counts after the first unfolding. iterations: of Newton's method, those of
    the mode "low-stretch" included.
    """

    flipped_before: int
    wrong_angle_sums_before: int
    iterations: int


@dataclass(frozen=True, slots=True)
class Result:
    """A map and everything imposed on it and measured of it.

    corner_uv: (m, 3, 2) float64, one (u, v) per triangle corner; NaN where not solved. Islands have their 3D area
        up to one common factor, do not overlap each other and lie in the unit square.
    solved: (m,) bool.
    island: (m,) int32, the island of each triangle, -1 where not solved.
    cut_edges: (c, 2) int32 vertex pairs along which the layout is open (mesh boundaries not included).
    cones, cone_angles: (k,) int32 and (k,) float64, radians, the angles that were imposed.
    flipped: indices of triangles with UV area <= 0. wrong_angle_sums: vertices whose UV angles do not add up to their
        prescribed angle (a deviation is a whole turn). The map is valid when both are empty.
    overlapping: indices of triangles that lie on others. overlap_area: area of all pairs of them together, as a share
        of the layout's area.
    repair: what the unfolding left to repair.
    cone_angle_error: largest deviation of a cone's UV angle sum from its imposed angle, radians.
    log_scale: (n,) float64, predicted logarithm of the length scale at each vertex, area-weighted mean 0 on an island.
    seamless: the certificate of a seamless layout; None where none was asked for. Such a layout is not scaled into the
        unit square: one cell has the side `cell`.
    warnings: findings that leave the result usable.
    stage_seconds: wall-clock seconds of each stage.
    factorizations, back_substitutions: the linear algebra it took, of sparse matrices.
    """

    corner_uv: FloatArray
    solved: NDArray[np.bool_]
    island: IndexArray
    cut_edges: IndexArray
    cones: IndexArray
    cone_angles: FloatArray
    distortion: Distortion
    seams: SeamQuality
    flipped: IndexArray
    wrong_angle_sums: IndexArray
    overlapping: IndexArray
    overlap_area: float
    repair: RepairReport
    cone_angle_error: float
    log_scale: FloatArray
    seamless: SeamlessReport | None
    warnings: list[Finding]
    stage_seconds: dict[str, float]
    factorizations: int
    back_substitutions: int


@dataclass(frozen=True, slots=True)
class CutGraph:
    """Cuts that open a surface into disks through its cones (the paper's section 4.1).

    edges: (c, 2) int32 vertex pairs. paths: the cuts, each an int32 array of vertices from node to node; nodes are
    cones, junctions and points of the boundary.
    """

    edges: IndexArray
    paths: list[IndexArray]


@dataclass(frozen=True, slots=True)
class Prescription:
    """Cone angles under Gauss-Bonnet and the scale they imply (the paper's section 5).

    cones, cone_angles: (k,) int32, (k,) float64 radians. log_scale: (n,) float64, area-weighted mean 0 on an island.
    predicted_l2: the L2 stretch the map will have.
    """

    cones: IndexArray
    cone_angles: FloatArray
    log_scale: FloatArray
    predicted_l2: float
    warnings: list[Finding]


@dataclass(frozen=True, slots=True)
class Placement:
    """Cones placed automatically, with the angles that go with them.

    cones, cone_angles: (k,) int32, (k,) float64 radians, existing ones first but for those on a border that prescribe
        nothing. `parameterize` with both gives what is predicted here.
    log_scale: (n,) float64, predicted, area-weighted mean 0 on an island. predicted_l2: the L2 stretch the map will
        have. reached: whether that is within the target on every component.
    factorizations, back_substitutions: the linear algebra it took.
    """

    cones: IndexArray
    cone_angles: FloatArray
    log_scale: FloatArray
    predicted_l2: float
    reached: bool
    warnings: list[Finding]
    factorizations: int
    back_substitutions: int


@dataclass(frozen=True, slots=True)
class ConeGains:
    """What one more cone would do to the stretch, its angle and the automatic ones chosen anew.

    predicted_l2: (n,) float64, the L2 stretch of the vertex's component with a cone there, to first order; NaN where
        none may be placed.
    present_l2: the L2 stretch of the whole surface as it is; infinite where a component needs a cone.
    best: the vertex where a cone lowers that most; None where none does.
    """

    predicted_l2: FloatArray
    present_l2: float
    best: int | None
    warnings: list[Finding]


@dataclass(frozen=True, slots=True)
class Measurement:
    """Quality of given texture coordinates; cuts are the interior edges whose two sides differ.

    island: (m,) int32. flipped: triangles turned against the majority of their island. cut_edges: (c, 2) int32.
    """

    distortion: Distortion
    seams: SeamQuality
    flipped: IndexArray
    cut_edges: IndexArray
    island: IndexArray


def parameterize(
    surface: Surface,
    cones: ArrayLike,
    angles: Sequence[float | None] | None = None,
    options: Options = Options(),
    pins: Pins | None = None,
    progress: Progress | None = None,
) -> Result:
    """Cut the surface through its cones and unfold it with exact transitions across every cut.

    cones: (k,) int32 vertex indices. angles: one total angle in radians per cone, None = automatic.
    pins: with two or more on a component its map goes through them, and its place, size and turn are theirs; with one,
        its place is.
    Components that cannot be solved are named in a warning when others could; the first error is raised otherwise.
    progress: called now and then with how much is done, 0 to 1; where it returns False, Cancelled is raised, and what
        it raises itself is raised here.
    Raises InputError, TopologyError, CurvatureError, SolverError, Cancelled.
    """
    return _to_result(
        _lsgp.parameterize(
            *_surface_arrays(surface), _importance(surface), *_call(cones, angles, options, pins), progress
        )
    )


class Solver:
    """Parameterizes one surface again and again, as for a cone that is dragged or an angle that is tried out.

    Every call returns what `lsgp.parameterize` does and keeps what the next one may use: the surface's topology and
    geometry, and, as long as a component's cones stay where they are, its factored linear systems. Angles and all
    options but `seams`, `border` and `factorization`, those of seamless layouts among them, may then change without a
    new factorization.
    Not for several threads at once.
    """

    def __init__(self, surface: Surface) -> None:
        self._solver = _lsgp.Solver(*_surface_arrays(surface), _importance(surface))

    def parameterize(
        self,
        cones: ArrayLike,
        angles: Sequence[float | None] | None = None,
        options: Options = Options(),
        pins: Pins | None = None,
        progress: Progress | None = None,
    ) -> Result:
        """Arguments, result and errors as of `lsgp.parameterize`."""
        return _to_result(self._solver.parameterize(*_call(cones, angles, options, pins), progress))


def _importance(surface: Surface) -> FloatArray:
    return np.empty(0) if surface.importance is None else surface.importance


def _call(
    cones: ArrayLike, angles: Sequence[float | None] | None, options: Options, pins: Pins | None
) -> tuple[Any, ...]:
    corners, uv = (np.empty(0, np.int32), np.empty((0, 2))) if pins is None else (pins.corners, pins.uv)
    return *_cone_arrays(cones, angles, options), corners, uv


def _to_result(out: dict[str, Any]) -> Result:
    out["repair"] = RepairReport(**out["repair"])
    out["distortion"] = Distortion(**out["distortion"])
    out["seams"] = SeamQuality(**out["seams"])
    out["seamless"] = None if out["seamless"] is None else SeamlessReport(**out["seamless"])
    return Result(**out)


def find_cuts(surface: Surface, cones: ArrayLike, options: Options = Options()) -> CutGraph:
    """Shortest cuts that join all cones and boundary loops and open every handle.  Raises InputError, TopologyError."""
    vertices, _, _, values = _cone_arrays(cones, None, options)
    return CutGraph(**_lsgp.find_cuts(*_surface_arrays(surface), vertices, values))


def prescribe_curvature(
    surface: Surface,
    cones: ArrayLike,
    angles: Sequence[float | None] | None = None,
    options: Options = Options(),
) -> Prescription:
    """Cone angles and log scale without unfolding.  Arguments and errors as in `parameterize`."""
    out = _lsgp.prescribe_curvature(*_surface_arrays(surface), *_cone_arrays(cones, angles, options))
    return Prescription(**out)


def place_cones(
    surface: Surface,
    cones: ArrayLike = (),
    angles: Sequence[float | None] | None = None,
    *,
    count: int | None = None,
    target: float = 1.05,
    lattice: Lattice | None = None,
    prefer_sharp: bool = False,
    symmetric: bool = False,
    mirror: tuple[ArrayLike, ArrayLike] | None = None,
    seams: SeamMode = "follow",
    progress: Progress | None = None,
) -> Placement:
    """Place cones where they lower the stretch most, with the angles that go with them.

    cones, angles: existing cones, which are kept, and angles of theirs that are, None = automatic.
    count: cones per component, existing ones included; None: as few as bring the predicted L2 stretch to `target`.
    lattice: angles become multiples of its turn, for a seamless layout.
    prefer_sharp: sharp corners before smooth places where that costs little.
    symmetric: the same cones on both sides of a plane: of `mirror`, a point on it and its normal, or None: found.
    seams, progress: as for `parameterize`.
    None is placed on a border nor, where the mesh has room, within two rings of another.
    Raises InputError, TopologyError, CurvatureError, SolverError, Cancelled.
    """
    if count is not None:
        if not isinstance(count, Integral) or not 0 <= count <= np.iinfo(np.int32).max:
            raise InputError("WRONG_PARAMETER", f"count is {count!r}; pass a number of cones, or None for automatic.")
        count = int(count)
    if not isinstance(target, Real) or isinstance(target, bool):
        raise InputError("WRONG_PARAMETER", f"target is {target!r}; pass an L2 stretch, a number above 1.")
    for name, value in (("prefer_sharp", prefer_sharp), ("symmetric", symmetric)):
        if not isinstance(value, bool):
            raise InputError("WRONG_PARAMETER", f"{name} is {value!r}; pass True or False.")
    if lattice is not None:
        _require_choice("lattice", lattice, get_args(Lattice))
    _require_choice("seams", seams, get_args(SeamMode))
    options = {
        "count": count,
        "target": float(target),
        "lattice": lattice,
        "prefer_sharp": prefer_sharp,
        "symmetric": symmetric,
        "mirror": None if mirror is None else _mirror_numbers(mirror),
        "seams": seams,
    }
    out = _lsgp.place_cones(*_surface_arrays(surface), *_given_cones(cones, angles), options, progress)
    return Placement(**out)


def cone_gains(
    surface: Surface,
    cones: ArrayLike = (),
    angles: Sequence[float | None] | None = None,
    *,
    seams: SeamMode = "follow",
    progress: Progress | None = None,
) -> ConeGains:
    """What one more cone would do to the stretch, wherever it is placed.  Arguments and errors as in `place_cones`."""
    _require_choice("seams", seams, get_args(SeamMode))
    return ConeGains(**_lsgp.cone_gains(*_surface_arrays(surface), *_given_cones(cones, angles), seams, progress))


def measure_distortion(surface: Surface, corner_uv: ArrayLike, cones: ArrayLike | None = None) -> Measurement:
    """Measure given texture coordinates, (m, 3, 2) float64, one (u, v) per triangle corner; NaN leaves a triangle out.

    cones: (k,) int32, the vertices at which a cut may change its rotation; None: every vertex whose angles do not add
    up to a full turn.
    """
    uv = np.asarray(corner_uv)
    expected = (len(surface.triangles), 3, 2)
    if uv.shape != expected:
        raise InputError("WRONG_SHAPE", f"corner_uv has shape {uv.shape}; pass {expected}, one (u, v) per corner.")
    uv = _floats(uv, "corner_uv")
    out = _lsgp.measure_distortion(
        *_surface_arrays(surface), uv, None if cones is None else _index_vector(cones, "cones")
    )
    out["distortion"] = Distortion(**out["distortion"])
    out["seams"] = SeamQuality(**out["seams"])
    return Measurement(**out)


def _surface_arrays(surface: Surface) -> tuple[Any, ...]:
    return surface.positions, surface.triangles, surface.edges, surface.seams


def _given_cones(
    cones: ArrayLike, angles: Sequence[float | None] | None
) -> tuple[IndexArray, FloatArray, NDArray[np.bool_]]:
    """Vertices, angles, and which of them are given."""
    vertices = _index_vector(cones, "cones")
    given = [None] * len(vertices) if angles is None else list(angles)
    has_angle = np.array([angle is not None for angle in given], bool)
    values = np.array([0.0 if angle is None else float(angle) for angle in given], np.float64)
    return vertices, values, has_angle


def _mirror_numbers(mirror: tuple[ArrayLike, ArrayLike]) -> list[float]:
    """A point on the plane and its normal."""
    numbers = np.asarray(mirror)
    if numbers.shape != (2, 3):
        raise InputError("WRONG_SHAPE", f"mirror has shape {numbers.shape}; pass a point and a normal, (2, 3).")
    return [float(x) for x in _floats(numbers, "mirror").ravel()]


def _cone_arrays(cones: ArrayLike, angles: Sequence[float | None] | None, options: Options) -> tuple[Any, ...]:
    """Vertices, angles, which of them are given, and the options with the rule for the others."""
    vertices, values, has_angle = _given_cones(cones, angles)
    rule = options.prescription or ("manual" if has_angle.any() else "least-distortion")
    return (
        vertices,
        values,
        has_angle,
        {
            **vars(options),
            "prescription": rule,
            "loop_turning": {int(v): float(a) for v, a in options.loop_turning.items()},
            "seamless": None if options.seamless is None else vars(options.seamless),
        },
    )


def _float_rows(values: ArrayLike, width: int, name: str) -> FloatArray:
    array = np.asarray(values)
    if array.size == 0:
        return np.empty((0, width), np.float64)
    if array.ndim != 2 or array.shape[1] != width:
        raise InputError("WRONG_SHAPE", f"{name} has shape {array.shape}; pass (n, {width}).")
    return _floats(array, name)


def _floats(array: NDArray[Any], name: str) -> FloatArray:
    if array.dtype.kind not in "fiu":
        raise InputError("WRONG_DTYPE", f"{name} holds {array.dtype}; pass numbers.")
    return np.require(array, np.float64, ["C", "A"])


def _index_rows(values: ArrayLike, width: int, name: str) -> IndexArray:
    array = np.asarray(values)
    if array.size == 0:
        return np.empty((0, width), np.int32)
    if array.ndim != 2 or array.shape[1] != width:
        raise InputError("WRONG_SHAPE", f"{name} has shape {array.shape}; pass (n, {width}).")
    return _indices(array, name)


def _index_vector(values: ArrayLike, name: str) -> IndexArray:
    array = np.asarray(values)
    if array.size == 0:
        return np.empty(0, np.int32)
    if array.ndim != 1:
        raise InputError("WRONG_SHAPE", f"{name} has shape {array.shape}; pass (n,).")
    return _indices(array, name)


def _indices(array: NDArray[Any], name: str) -> IndexArray:
    if array.dtype.kind not in "iu":
        raise InputError("WRONG_DTYPE", f"{name} holds {array.dtype}; pass whole numbers.")
    if array.max() > np.iinfo(np.int32).max or array.min() < np.iinfo(np.int32).min:
        raise InputError("INDEX_OUT_OF_RANGE", f"{name} holds {array.max()}; indices must fit 32 bits.")
    return np.require(array, np.int32, ["C", "A"])
