# SPDX-License-Identifier: GPL-3.0-or-later
"""The functions of the library over numpy arrays: validation of the call, the native core, typed results."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _lsgp, arguments
from .arguments import FloatArray, IndexArray
from .equality import EqualByContent
from .errors import Finding
from .short_repr import ShortRepr

PrescriptionRule = Literal["least-distortion", "harmonic", "straightness", "manual"]
UnfoldMethod = Literal["poisson", "spectral"]
Method = Literal["lsgp", "lscm"]
SeamMode = Literal["follow", "boundary", "ignore"]
BorderMode = Literal["free", "straight"]
Lattice = Literal["square", "stripe", "translation", "triangle", "hexagon"]
CoarseGrid = Literal["refine", "merge", "relax"]
Mode = Literal["conformal", "low-stretch"]
Overlaps = Literal["keep", "split"]
Compactness = Literal["off", "sparing", "full"]
Factorization = Literal["automatic", "cut", "sparse"]
CutKind = Literal["seam", "required", "added"]
ReleaseReason = Literal["curved", "contradiction", "stretch", "lattice", "unsupported"]

Progress = Callable[[float], bool | None]


def _set(instance: object, name: str, value: object) -> None:
    """Set a field of a frozen dataclass during its construction."""
    object.__setattr__(instance, name, value)


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
        all triangles; None: none. Islands are rotated accordingly, which does not change the map;
        `Result.direction_errors` has the deviations.
    features: (f, 2) int32, edges, also of boundaries, that are to run straight along u or v; `feature_edges` finds
        some. They have precedence over creases that are straightened anyway; `Result.features` has those that do not.
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
        ) -> None: ...

    def __post_init__(self) -> None:
        _set(self, "positions", arguments.float_rows("positions", self.positions, 3))
        _set(self, "triangles", arguments.index_rows("triangles", self.triangles, 3))
        if self.edges is not None:
            _set(self, "edges", arguments.index_rows("edges", self.edges, 2))
        for name in ("seams", "borders", "features"):
            marked = getattr(self, name)
            _set(self, name, arguments.index_rows(name, np.empty((0, 2), np.int32) if marked is None else marked, 2))
        if self.importance is not None:
            shape = (len(self.positions),)
            _set(self, "importance", arguments.floats_of_shape("importance", self.importance, shape))
        if self.cut_costs is not None:
            shape = (0 if self.edges is None else len(self.edges),)
            _set(self, "cut_costs", arguments.floats_of_shape("cut_costs", self.cut_costs, shape))
        if self.directions is not None:
            _set(self, "directions", _directions(self.directions, len(self.triangles)))


def _directions(directions: ArrayLike, triangle_count: int) -> FloatArray:
    """One for each triangle."""
    if arguments.as_array("directions", directions).ndim != 1:
        return arguments.floats_of_shape("directions", directions, (triangle_count, 3))
    return np.tile(arguments.floats_of_shape("directions", directions, (3,)), (triangle_count, 1))


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
        _set(self, "corners", arguments.index_vector("corners", self.corners))
        _set(self, "uv", arguments.float_rows("uv", self.uv, 2))


_CHOICES = {
    "prescription": PrescriptionRule,
    "unfold": UnfoldMethod,
    "method": Method,
    "seams": SeamMode,
    "border": BorderMode,
    "mode": Mode,
    "overlaps": Overlaps,
    "compact": Compactness,
    "factorization": Factorization,
}


@dataclass(frozen=True)
class Seamless:
    """A layout in which a tileable texture shows no seam (the paper's section 8).

    Cone angles become multiples of the lattice's rotation, and translations across cuts map lattice points to lattice
    points. Coordinates are exact in float32: afterward scale them only by powers of two.

    lattice: "square": quarter turns of unit squares; "stripe": half turns of unit squares; "translation": unit squares
        without rotation; "triangle": third turns of triangles of side 1; "hexagon": sixth turns of them.
    tiles: cells along the layout's longer side, before rounding. tile_size: or the side of a cell on the surface, in
        its unit. Neither: the coarsest grid that is valid and costs at most a tenth in distortion.
    parity: square lattice only: black and white cells match across cuts as well.
    whole_features: features are at whole cells or released, and may cost a fifth of L2 stretch, as quads along them
        require; otherwise at multiples of 1 / 256 of a cell where cells are too large, at a tenth.
    coarse_grid: if no layout on such a coarse grid is valid: "refine" uses the next finer one, "merge" merges cones
        less than a cell apart, "relax" leaves those cones off the grid that cannot be placed on it.
    cell: side of a cell in texture coordinates, a power of two. 1 is a whole tile; 2**level / size makes translations
        multiples of 2**level texels of a texture of that size, so that its mipmaps match up to that level.
    """

    lattice: Lattice = "square"
    tiles: float | None = None
    tile_size: float | None = None
    parity: bool = False
    coarse_grid: CoarseGrid = "refine"
    cell: float = 1.0
    whole_features: bool = False

    def __post_init__(self) -> None:
        arguments.require_choice("lattice", self.lattice, get_args(Lattice))
        arguments.require_choice("coarse_grid", self.coarse_grid, get_args(CoarseGrid))
        for name in ("parity", "whole_features"):
            _set(self, name, arguments.flag(name, getattr(self, name)))
        for name in ("tiles", "tile_size", "cell"):
            value = getattr(self, name)
            if value is not None or name == "cell":
                _set(self, name, arguments.number(name, value))


@dataclass(frozen=True)
class Options:
    """How to prescribe the cone angles and how to unfold.

    prescription: the rule that chooses the automatic angles. None: "manual" if angles are given (those are kept, the
        other cones absorb the rest with least distortion), "least-distortion" otherwise.
    unfold: "poisson" (robust, one linear solve) or "spectral" (the paper's eigenproblem; closed surfaces).
    method: "lsgp", or "lscm" for the paper's comparison: the same cuts without transitions.
    seams: "follow": all marked seams are cut, other edges only where cones or handles need them, and a region enclosed
        by seams becomes an island of its own; "boundary": every seam is an open boundary, as in Blender's own unwrap;
        "ignore".
        With "follow", a component without cones is also opened along its seams (SEAMS_OPENED), unless its boundaries
        are straight, it is seamless and has a boundary, or it is a torus that its seams divide into disks or not at
        all; the texture of a component with given or placed cones continues across its seams.
        Pieces that are open along seams and have neither handles nor cones are not cut further, however many holes they
        have, as long as their map is within the range of numbers. CUTS_ADDED names all cuts besides the seams.
    border: "free": angles along boundaries are those of least distortion, and a cone there that has an angle is a
        corner; "straight": boundaries are straight from marked cone to marked cone.
    loop_turning: total turning of boundaries, radians, by any vertex on each; the others turn with least distortion. A
        free boundary about which the metric turns almost once, a hole, needs no cut and gets none; on surfaces without
        handles and cones all holes stay whole if that costs less than a tenth of L2 stretch.
    seamless: round angles and translations so that a tileable texture shows no seam; None: no rounding.
    mode: "conformal" preserves angles; "low-stretch" preserves lengths as far as the cone angles permit.
    stretch: with "low-stretch", from 0, the conformal map, to 1, the map of least stretch.
    straighten: with "low-stretch" and free boundaries: boundaries and cuts that are nearly straight in the map become
        exactly straight, and those nearly at right angles are aligned with u and v, unless that costs noticeable
        stretch. In seamless layouts on squares instead, in either mode: creases of hard surfaces, of 0.7 radians or
        more, run along lines of the lattice, as many as cost at most a tenth of L2 stretch; FEATURES_OFF_LATTICE names
        the others.
    repair: untangle flipped triangles and correct angles that are off by a full turn.
    overlaps: "keep" islands that overlap themselves, or "split" them until none does: first along other cuts for the
        same cones, unless seams are marked, then along further cuts. Transitions stay exact.
    compact: further cuts of islands that would leave much of a square empty, such as long strips, rings and islands
        with arms: "off"; "sparing", only where a short cut fills much of the square, and in no component with marked
        seams; "full", wherever the filled area outweighs the cost of the cut and the additional island. Transitions
        stay exact. Components with pins keep their islands.
    mirrored_cuts: cuts are alike on both sides of a component's mirror plane, which is detected, if its cones are and
        that costs at most half as much again; so are islands that are split or made compact, if that adds few cuts.
        CUTS_NOT_MIRRORED names those that are not.
    square_share: with compact, the area available to these islands, 1 being a whole square: less if other surfaces are
        packed beside them, so that they are cut less; the number of UDIM tiles, up to 100, so that all are filled.
    factorization: how linear systems are solved; maps differ only by rounding. "cut" factors once and leaves dense
        problems of the size of the cut, "sparse" factors for every step, "automatic" uses the cheaper.
    threads: number of threads for large factorizations, up to 1024; the result is the same for any number. 0: the value
        of the environment variable LSGP_THREADS at the library's first use, or else the number of processors.

    Options that contradict each other are refused (WRONG_PARAMETER; PINS_CONFLICT if pins are involved): the method
    "lscm" with "spectral", "low-stretch", "straight", loop_turning, seamless or pins; seamless with "straight", compact
    or pins. Maps of "lscm" and "spectral" are not repaired.
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
    straighten: bool = False
    repair: bool = True
    overlaps: Overlaps = "keep"
    compact: Compactness = "off"
    mirrored_cuts: bool = False
    square_share: float = 1.0
    factorization: Factorization = "automatic"
    threads: int = 0

    def __post_init__(self) -> None:
        for name, choices in _CHOICES.items():
            value = getattr(self, name)
            if not (name == "prescription" and value is None):
                arguments.require_choice(name, value, get_args(choices))
        if not (self.seamless is None or isinstance(self.seamless, Seamless)):
            arguments.refuse("seamless", self.seamless, "pass a Seamless, or None")
        _set(self, "stretch", arguments.number("stretch", self.stretch, "pass a number from 0 to 1"))
        _set(self, "straighten", arguments.flag("straighten", self.straighten))
        _set(self, "mirrored_cuts", arguments.flag("mirrored_cuts", self.mirrored_cuts))
        _set(self, "repair", arguments.flag("repair", self.repair))
        share = arguments.number("square_share", self.square_share, "pass a number above 0, up to 100")
        _set(self, "square_share", share)
        _set(self, "loop_turning", _loop_turning(self.loop_turning))
        _set(self, "threads", _threads(self.threads))


def _threads(count: int) -> int:
    return arguments.whole_number("threads", count, 0, "pass a number from 1 to 1024, or 0 for the default")


def _loop_turning(angles: Mapping[int, float]) -> dict[int, float]:
    remedy = "pass angles by vertices of borders"
    if not isinstance(angles, Mapping):
        arguments.refuse("loop_turning", angles, remedy)
    return {
        arguments.whole_number("a vertex of loop_turning", vertex, np.iinfo(np.int32).min, remedy): arguments.number(
            "an angle of loop_turning", turning, remedy
        )
        for vertex, turning in angles.items()
    }


@dataclass(frozen=True, slots=True, repr=False)
class Distortion(ShortRepr):
    """Quality of a map (the paper's section 7.1), over all solved triangles.

    quasi_conformal: mean of sigma_1 / sigma_2 over triangles; 1 is conformal.
    quasi_conformal_area_weighted: the same, weighted by 3D area.
    area: mean of (share of the 3D area) / (share of the UV area) over triangles; area_p10, area_p90 its percentiles.
    l2_stretch: L2 stretch of Sander et al. 2001, normalized; 1 is isometric.
    """

    quasi_conformal: float
    quasi_conformal_area_weighted: float
    area: float
    area_p10: float
    area_p90: float
    l2_stretch: float


@dataclass(frozen=True, slots=True, repr=False)
class SeamQuality(ShortRepr):
    """How exactly the two sides of every cut are related by one rotation and one translation, in `corner_uv`.

    Islands enclosed by cuts and seams are placed individually, and a cut between two of them is measured separately.
    INEXACT_SEAMS names the edges with larger errors than rounding explains, as on a component much smaller than the
    others.

    sister_ratio_max: largest ratio of the longer to the shorter side of a cut edge (the paper's sister edges); 1 is
        exact.
    rotation_residual: largest angle between the rotation of a cut edge and that of its cut, radians.
    translation_residual: largest distance between a vertex on a cut and the image of its copy on the other side,
        relative to the size of their island, of the larger one if there are two.
    """

    sister_ratio_max: float
    rotation_residual: float
    translation_residual: float


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class SeamlessReport(EqualByContent, ShortRepr):
    """The certificate of a seamless layout: the transition and the error of every cut, and the cost of rounding.

    A cut is crossed from its left side to its right one by z -> e^(2 pi i turns / rotation_order) z + cell (a + b g),
    where g is i on square lattices and e^(i pi / 3) on triangular ones and z = u + iv.

    rotation_order: rotations are multiples of 2 pi / rotation_order.
    tiles: cells along the layout's longer side, before rounding.
    tile_size: side of a cell on the surface. cell: the same in texture coordinates.
    energy_before, energy_after: symmetric Dirichlet energy before and after rounding the translations, 1 is isometric.
    cut_nodes: (c, 2) int32 vertices at the cuts' tails and heads. cut_turns: (c,) int32, 0 .. rotation_order - 1.
    cut_translations: (c, 2) int64, (a, b). cut_errors: (c,) float64, the largest distance of a vertex, as stored in
        float32, from the image of its copy, in cells. error: the largest of them, 0 on square lattices.
    flat_cones: cones whose curvature was rounded to zero, now ordinary vertices. merged_cones: cones merged with
        another within a cell.
    relaxed_cones: cones off the lattice; the cuts to them show a seam.
    feature_share: with `Options.straighten`, the share of the length of the creases of hard surfaces that runs along
        the lattice exactly, as stored in float32; None without creases.
    """

    rotation_order: int
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
    feature_share: float | None = None


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class ReleasedFeature(EqualByContent, ShortRepr):
    """A marked feature, or a part of one, that does not run straight along u or v.

    path: int32, its vertices. share: of the length of all marked features. reason: "curved", it turns away from both
    axes, or is between them, where no corner or cone lets it; "contradiction", together with features that have
    precedence it would fold the map or lose its length; "stretch", it would cost more than a tenth of L2
    stretch; "lattice", no layout with tiles of this size keeps it; "unsupported", no feature is aligned with these
    options.
    """

    path: IndexArray
    reason: ReleaseReason
    share: float


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class FeatureReport(EqualByContent, ShortRepr):
    """What became of `Surface.features`.

    share: of their length that runs straight along u or v exactly, as stored in float32, on both sides of a cut.
    released: the others.
    """

    share: float
    released: list[ReleasedFeature]


@dataclass(frozen=True, slots=True)
class RepairReport:
    """Defects of the first unfolding, and the iterations spent on repair and on lowering the stretch.

    flipped_before, wrong_angle_sums_before: counts after the first unfolding. iterations: of Newton's method, those of
    the mode "low-stretch" included.
    """

    flipped_before: int
    wrong_angle_sums_before: int
    iterations: int


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Result(EqualByContent, ShortRepr):
    """A map, the constraints imposed on it, and its measurements.

    corner_uv: (m, 3, 2) float64, one (u, v) per triangle corner; NaN where not solved. Islands have their 3D area
        up to one common factor, do not overlap each other and lie in the unit square; a component whose area is sheared
        to less than a tenth of its Dirichlet energy is smaller.
    solved: (m,) bool.
    island: (m,) int32, the island of each triangle, -1 where not solved.
    cut_edges: (c, 2) int32 vertex pairs along which the layout is open, without mesh boundaries and the seams of
        "boundary"; on components with cones, seams that end in the interior are included, although their two sides
        coincide. required_cuts: (r, 2) int32, those of them that cones, handles and boundaries need, also along seams;
        the others are seams, or split overlaps and islands.
    borders: (b, 2) int32 vertex pairs, those of `Surface.borders`.
    cut_paths: cut_edges and borders as paths, each an int32 array of vertices from node to node; nodes are the cones,
        vertices where not exactly two of the edges meet, and those where edges of two kinds do. cut_kinds: of each
        path: "seam" along marked seams; "required" as required_cuts; "added" for other reasons, such as creases and
        overlaps.
    cones, cone_angles: (k,) int32 and (k,) float64, radians, the angles that were imposed.
    flipped: indices of triangles with UV area <= 0. wrong_angle_sums: vertices whose UV angle sum, with negative angles
        of flipped triangles, misses the imposed sum by more than a degree: by full turns, or by any amount if the two
        sides of a cut differ. INEXACT_ANGLES names those that miss it by less, but by more than 1e-6 radians. On a free
        boundary only the total turning is judged. The map is valid if both are empty.
    overlapping: indices of triangles that overlap others. overlap_area: total area of all overlapping pairs, as a
        fraction of the layout's area.
    repair: defects of the first unfolding and the work of repairing them.
    cone_angle_error: largest deviation of a cone's UV angle sum from its imposed angle, radians.
    log_scale: (n,) float64, the predicted log conformal factor: logarithm of the length scale at each vertex,
        area-weighted mean 0 on an island.
    direction_errors: (m,) float64, angle between v and the direction of each triangle, radians, in a seamless layout
        modulo the lattice's rotations; NaN for triangles without direction. None if `Surface.directions` is None.
        direction_error: their mean, weighted by area and by the directions' length; None if no triangle has one.
    seamless: the certificate of a seamless layout; None for other layouts. A seamless layout is not scaled into the
        unit square: one cell has the side `cell`.
    features: what became of `Surface.features`; None without.
    warnings: findings that leave the result usable.
    stage_seconds: wall-clock seconds of each stage; not compared by equality.
    factorizations, back_substitutions: numbers of those of sparse matrices.
    """

    corner_uv: FloatArray
    solved: NDArray[np.bool_]
    island: IndexArray
    cut_edges: IndexArray
    required_cuts: IndexArray
    borders: IndexArray
    cut_paths: list[IndexArray]
    cut_kinds: list[CutKind]
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
    direction_errors: FloatArray | None
    direction_error: float | None
    seamless: SeamlessReport | None
    features: FeatureReport | None
    warnings: list[Finding]
    stage_seconds: dict[str, float] = field(compare=False)
    factorizations: int
    back_substitutions: int

    def _shown(self) -> dict[str, Any]:
        return {
            "triangles": len(self.solved),
            "solved": int(self.solved.sum()),
            "islands": len(np.unique(self.island[self.solved])),
            "cones": len(self.cones),
            "l2_stretch": self.distortion.l2_stretch,
            "flipped": len(self.flipped),
            "wrong_angle_sums": len(self.wrong_angle_sums),
            "overlapping": len(self.overlapping),
            "warnings": sorted({finding.code for finding in self.warnings}),
        }


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class CutPaths(EqualByContent, ShortRepr):
    """Cuts that open a surface into disks through its cones (the paper's section 4.1).

    edges: (c, 2) int32 vertex pairs. paths: the cuts, each an int32 array of vertices from node to node; nodes are
    cones, junctions and points of the boundary.
    """

    edges: IndexArray
    paths: list[IndexArray]


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Prescription(EqualByContent, ShortRepr):
    """Cone angles that satisfy Gauss-Bonnet and the scale they imply (the paper's section 5).

    cones, cone_angles: (k,) int32, (k,) float64 radians. log_scale: (n,) float64, the log conformal factor,
        area-weighted mean 0 on an island.
    predicted_l2: the predicted L2 stretch of the map.
    """

    cones: IndexArray
    cone_angles: FloatArray
    log_scale: FloatArray
    predicted_l2: float
    warnings: list[Finding]


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Placement(EqualByContent, ShortRepr):
    """Cones placed automatically, with their angles.

    cones, cone_angles: (k,) int32, (k,) float64 radians, existing ones first, without those on a boundary that have no
        angle. `parameterize` with both gives the map that was measured here.
    log_scale: (n,) float64, predicted, area-weighted mean 0 on an island. predicted_l2: the L2 stretch that follows
        from it, 1 being none, exact in the limit of fine triangles.
    mapped_l2: the L2 stretch of the map itself; infinite if the map has flipped triangles or wrong angles.
    reached: whether that is within the target on every component.
    maps: number of maps of components computed for this. factorizations, back_substitutions: the linear algebra of the
        choice, without that of these maps.
    """

    cones: IndexArray
    cone_angles: FloatArray
    log_scale: FloatArray
    predicted_l2: float
    mapped_l2: float
    reached: bool
    maps: int
    warnings: list[Finding]
    factorizations: int
    back_substitutions: int


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class ConeGains(EqualByContent, ShortRepr):
    """The predicted stretch with one more cone, its angle and the automatic ones recomputed.

    predicted_l2: (n,) float64, the L2 stretch of the vertex's component with a cone there, to first order; NaN where
        none may be placed. Values are capped at 1e100.
    present_l2: the L2 stretch of the whole surface with the given cones; infinite if a component needs a cone, as one
        that would be opened along its seams because it has none.
    best: the vertex where a cone lowers that most; None if there is none. If the surface has cut_costs, a vertex that
        cuts reach more cheaply if a cone there lowers it at least half as much, to first order.
    """

    predicted_l2: FloatArray
    present_l2: float
    best: int | None
    warnings: list[Finding]


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Measurement(EqualByContent, ShortRepr):
    """Quality of given texture coordinates; cuts are the interior edges whose two sides differ.

    island: (m,) int32. flipped: triangles oriented against the majority of their island. cut_edges: (c, 2) int32.
    A one-sided component is measured as if open along its cuts, which `seams` then leaves out; if an island of it is
    still one-sided, each of its triangles becomes an island. Triangles without area in the plane make figures infinite.
    """

    distortion: Distortion
    seams: SeamQuality
    flipped: IndexArray
    cut_edges: IndexArray
    island: IndexArray


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
    return _to_result(out, surface.borders)


class Solver:
    """Parameterizes one surface repeatedly, for instance while a cone is dragged or an angle is tried, or once cones
    are placed.

    Every call returns the same as the function of that name and caches data for the next one: the surface's topology
    and geometry, and, as long as a component's cones do not move, its factored linear systems, also those of the cones
    that `place_cones` has placed. Angles and all options except `seams`, `border` and `factorization`, including those
    of seamless layouts, can then change without a new factorization. A seamless layout that differs from the previous
    one only in the size of its tiles takes only their rounding: the map, and which creases run along the lattice, are
    kept. The map is kept, too, if only `straighten` differs.
    A call during another one, from another thread or from its progress callback, raises SolverError (SOLVER_BUSY).
    """

    def __init__(self, surface: Surface) -> None:
        self._solver = _lsgp.Solver(surface_arrays(surface))
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
        return _to_result(out, self._surface.borders)

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


def _call(
    cones: ArrayLike,
    angles: Sequence[float | None] | FloatArray | None,
    options: Options,
    pins: Pins | None,
    progress: Progress | None,
) -> tuple[Any, ...]:
    arguments.require_callable(progress)
    if not (pins is None or isinstance(pins, Pins)):
        arguments.refuse("pins", pins, "pass Pins, or None")
    pin_arrays = (np.empty(0, np.int32), np.empty((0, 2))) if pins is None else (pins.corners, pins.uv)
    return *cone_arrays(cones, angles, options), pin_arrays, progress


def _to_result(out: dict[str, Any], borders: IndexArray) -> Result:
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

    front: (3,), the direction from the surface to the viewer; cuts are hidden from the views around it: a cost is 0.1
        if no view sees the edge and 1.1 if all do. None: visibility has no effect.
    creases: costs fall to 0.12 of that along edges where the surface bends by 50 degrees or more, not below 30.
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
    """Cone angles and log scale without unfolding.  Arguments and errors as in `parameterize`."""
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
    seams: SeamMode = "follow",
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
        most 7 degrees off them and the stretch within 1.2: around the bottom of a vase, and none in a sleeve.
    prefer_sharp: prefer sharp corners to smooth regions if that costs little.
    symmetric: the same cones on both sides of a plane, given by `mirror`, a point on it and its normal, or, if that is
        None, detected; also on surfaces that are symmetric only up to 2 % of their extent, and on components that
        mirror each other.
    seams, progress: as for `parameterize`, which treats the placed cones and angles as assumed here: with "follow" a
        component that gets cones is not opened along its seams. threads: as in `Options`.
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
    options = {
        "count": count,
        "target": arguments.number("target", target, "pass an L2 stretch, a number above 1"),
        "lattice": lattice,
        "prefer_sharp": arguments.flag("prefer_sharp", prefer_sharp),
        "symmetric": arguments.flag("symmetric", symmetric),
        "mirror": None if mirror is None else _mirror_numbers(mirror),
        "seams": seams,
        "threads": _threads(threads),
    }
    given = _given_cones(cones, angles)
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
    return ConeGains(**_lsgp.cone_gains(surface_arrays(surface), _given_cones(cones, angles), seams, progress))


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


def surface_arrays(surface: Surface) -> tuple[Any, ...]:
    arguments.require_type("surface", surface, Surface)
    importance, cut_costs = (np.empty(0) if a is None else a for a in (surface.importance, surface.cut_costs))
    directions = np.empty((0, 3)) if surface.directions is None else surface.directions
    seams, borders, features = surface.seams, surface.borders, surface.features
    return (
        *(surface.positions, surface.triangles, surface.edges, seams, importance, cut_costs),
        *(borders, directions, features),
    )


def _given_cones(
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
    given = _given_cones(cones, angles)
    rule = options.prescription or ("manual" if given[2].any() else "least-distortion")
    seamless = None if options.seamless is None else vars(options.seamless)
    return given, {**vars(options), "prescription": rule, "seamless": seamless}
