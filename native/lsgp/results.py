# SPDX-License-Identifier: GPL-3.0-or-later
"""What the functions of the library return."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from .base.arguments import FloatArray, IndexArray
from .base.equality import EqualByContent
from .base.short_repr import ShortRepr
from .errors import Finding

CutKind = Literal["seam", "required", "added"]
ReleaseReason = Literal["curved", "contradiction", "stretch", "lattice", "unsupported"]


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


@dataclass(frozen=True, slots=True)
class Choice:
    """A map that a preset made, or could have made, on its way to a result.

    name: what it was. estimate: what it was expected to cost, in hundredths of L2 stretch, as of `Weights`; infinite
    where nothing was known. cost: what it did cost; None where it was not made. reason: what came out, or why it was
    not made. is_best: whether it was the best so far.
    """

    name: str
    estimate: float
    cost: float | None
    reason: str
    is_best: bool = False


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class SeamlessReport(EqualByContent, ShortRepr):
    """The certificate of a seamless layout: the transition and the error of every cut, and the cost of rounding.

    A cut is crossed from its left side to its right one by z -> e^(2 pi i turns / rotation_order) z + cell (a + b g),
    where g is i on square lattices and e^(i pi / 3) on triangular ones and z = u + iv.

    rotation_order: rotations are multiples of 2 pi / rotation_order.
    tiles: cells along the layout's longer side, before rounding.
    tile_size: side of a cell on the surface, but for small components with smaller ones. cell: the same in texture
        coordinates.
    energy_before, energy_after: symmetric Dirichlet energy before and after rounding the translations, 1 is isometric.
    cut_nodes: (c, 2) int32 vertices at the cuts' tails and heads. cut_turns: (c,) int32, 0 .. rotation_order - 1.
    cut_translations: (c, 2) int64, (a, b). cut_errors: (c,) float64, the largest distance of a vertex, as stored in
        float32, from the image of its copy, in cells. error: the largest of them, 0 on square lattices.
    flat_cones: cones whose curvature was rounded to zero, now ordinary vertices. merged_cones: cones merged with
        another within a cell.
    relaxed_cones: cones off the lattice; the cuts to them show a seam.
    feature_share: with `Options.straighten`, the share of the length of the creases of hard surfaces that runs along
        the lattice exactly, as stored in float32; None without creases.
    creases: (c, 2) int32, those creases, vertex pairs. is_crease_aligned: (c,) bool, whether each runs there.
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
    creases: IndexArray = field(default_factory=lambda: np.empty((0, 2), np.int32))
    is_crease_aligned: NDArray[np.bool_] = field(default_factory=lambda: np.empty(0, np.bool_))


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
    cut_edges: (c, 2) int32 vertex pairs along which the layout is open, without mesh boundaries; on components with
        cones, seams that end in the interior are included, although their two sides coincide. Where several sheets
        cross at an edge it is listed once for each that is cut there.
    required_cuts: (r, 2) int32, those of them that cones, handles and boundaries need, also along seams; the others are
        seams, or split overlaps and islands.
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
    choices: what a preset chose from, in the order in which it did; not compared by equality. Empty elsewhere.
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
    choices: list[Choice] = field(default_factory=list, compare=False)

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

    edges: (c, 2) int32 vertex pairs; where several sheets cross at an edge, once for each that is cut there. paths: the
    cuts, each an int32 array of vertices from node to node; nodes are cones, junctions and points of the boundary.
    """

    edges: IndexArray
    paths: list[IndexArray]


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Chart(EqualByContent, ShortRepr):
    """A part of the surface bounded by its marked seams and boundaries, and its map without cones and further cuts.

    triangles: (t,) int32. euler, borders: its Euler characteristic and the number of its boundaries, 1 and 1 for a
        disk; 0 and 0 if it has one side only.
    is_mapped: False of charts with handles, closed ones and one-sided ones. l2_stretch: of its map, at a scale of its
        own; infinite without one. flipped, overlapping: numbers of triangles.
    missing: (e, 2) int32, edges whose cutting leaves it as a disk, but for holes about which its metric nearly turns
        once; none of closed charts without handles, which any cut opens.
    """

    triangles: IndexArray
    euler: int
    borders: int
    is_mapped: bool
    l2_stretch: float
    flipped: int
    overlapping: int
    missing: IndexArray

    @property
    def is_disk(self) -> bool:
        return self.euler == 1 and self.borders == 1


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


@dataclass(frozen=True, eq=False, repr=False)
class Tubes(EqualByContent, ShortRepr):
    """Rings of quads, one after the other, as of pipes, ropes, horns and walls of revolution.

    borders: (b, 2) int32, the edges at which they end, for `Surface.borders`. triangles: (t,) int32, those of tubes.
    """

    borders: IndexArray
    triangles: IndexArray
