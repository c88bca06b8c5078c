# SPDX-License-Identifier: GPL-3.0-or-later
"""The options of a map."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal, get_args

import numpy as np

from .base import arguments
from .base.frozen import set_field

PrescriptionRule = Literal["least-distortion", "harmonic", "straightness", "manual"]
UnfoldMethod = Literal["poisson", "spectral"]
Method = Literal["lsgp", "lscm"]
SeamMode = Literal["follow", "exact", "boundary", "ignore"]
BorderMode = Literal["free", "straight", "strips"]
Lattice = Literal["square", "stripe", "translation", "triangle", "hexagon"]
CoarseGrid = Literal["refine", "merge", "relax"]
FeaturePlaces = Literal["anywhere", "half", "whole"]
Mode = Literal["conformal", "low-stretch"]
Overlaps = Literal["keep", "split"]
Compactness = Literal["off", "sparing", "full"]
Factorization = Literal["automatic", "cut", "sparse"]

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
        its unit. Neither: the coarsest grid that is valid and costs at most a tenth in distortion. Components that
        need a finer one, and have less than a twentieth of the area together, get it for themselves.
    parity: square lattice only: black and white cells match across cuts as well.
    feature_places: where features and creases along the lattice lie: "anywhere", at multiples of 1 / 256 of a cell
        where cells are too large for whole ones; "half", at half cells, or "whole", at whole ones as quads along them
        require: those that find no such place are released, and the others may cost a fifth of L2 stretch instead of a
        tenth.
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
    feature_places: FeaturePlaces = "anywhere"

    def __post_init__(self) -> None:
        arguments.require_choice("lattice", self.lattice, get_args(Lattice))
        arguments.require_choice("coarse_grid", self.coarse_grid, get_args(CoarseGrid))
        arguments.require_choice("feature_places", self.feature_places, get_args(FeaturePlaces))
        set_field(self, "parity", arguments.flag("parity", self.parity))
        for name in ("tiles", "tile_size", "cell"):
            value = getattr(self, name)
            if value is not None or name == "cell":
                set_field(self, name, arguments.number(name, value))


@dataclass(frozen=True)
class Options:
    """How to prescribe the cone angles and how to unfold.

    prescription: the rule that chooses the automatic angles. None: "manual" if angles are given (those are kept, the
        other cones absorb the rest with least distortion), "least-distortion" otherwise.
    unfold: "poisson" (robust, one linear solve) or "spectral" (the paper's eigenproblem; closed surfaces).
    method: "lsgp", or "lscm" for the paper's comparison: the same cuts without transitions.
    seams: "follow": all marked seams are cut, other edges only where cones or handles need them, and a region enclosed
        by seams becomes an island of its own; "exact": the seams are cut and nothing else; "boundary": every seam is an
        open boundary, also of components with cones; "ignore".
        With "follow", a component without cones is also opened along its seams (SEAMS_OPENED), unless its boundaries
        are straight, it is seamless and has a boundary, or it is a torus that its seams divide into disks or not at
        all; the texture of a component with given or placed cones continues across its seams.
        Pieces that are open along seams and have neither handles nor cones are not cut further, however many holes they
        have, as long as their map is within the range of numbers. CUTS_ADDED names all cuts besides the seams.
        With "exact", all components without cones are opened, overlaps are kept, and what cannot be mapped without
        further cuts is refused: SEAMS_INCOMPLETE names the edges that are missing, as a warning where the rest has a
        map, and where a tube was laid out as a ring. Cones have to lie on seams that join them.
    border: "free": angles along boundaries are those of least distortion, and a cone there that has an angle is a
        corner; "straight": boundaries are straight from marked cone to marked cone; "strips": a tube, as
        `find_tubes` finds, between two boundaries, without marked cones and seams, or open along seams from one to the
        other, becomes a straight strip if its girth is the same within a tenth all along; other boundaries are free.
    loop_turning: total turning of boundaries, radians, by any vertex on each; the others turn with least distortion. A
        free boundary about which the metric turns almost once, a hole, needs no cut and gets none; on surfaces without
        handles and cones all holes stay whole if that costs less than a tenth of L2 stretch.
    seamless: round angles and translations so that a tileable texture shows no seam; None: no rounding.
    mode: "conformal" preserves angles; "low-stretch" preserves lengths as far as the cone angles permit.
    stretch: with "low-stretch", from 0, the conformal map, to 1, the map of least stretch.
    straighten: with "low-stretch" and free boundaries: boundaries and cuts that are nearly straight in the map become
        exactly straight, and those nearly at right angles are aligned with u and v, unless that costs noticeable
        stretch. In seamless layouts on squares, in either mode, this holds for components without cuts; and creases of
        hard surfaces, of 0.7 radians or more, run along lines of the lattice, as many as cost at most a tenth of L2
        stretch; FEATURES_OFF_LATTICE names the others.
    repair: untangle flipped triangles and correct angles that are off by a full turn.
    overlaps: "keep" islands that overlap themselves, or "split" them until none does: first along other cuts for the
        same cones, unless seams are marked, then along further cuts. Transitions stay exact.
    compact: further cuts of islands that would leave much of a square empty, such as long strips, rings and islands
        with arms: "off"; "sparing", only where a short cut fills much of the square; "full", wherever the filled area
        outweighs the cost of the cut and the additional island. Transitions stay exact. Components with pins or marked
        seams keep their islands.
    mirrored_cuts: cuts are alike on both sides of a component's mirror plane, which is detected, if its cones are and
        that costs at most half as much again; so are islands that are split or made compact, if that adds few cuts.
        CUTS_NOT_MIRRORED names those that are not.
    follow_strokes: automatic cone angles, and in seamless layouts rotations about handles, are chosen so that the
        texture follows several directions of the surface, if these are strokes, on up to half of a component's area,
        and if their mean error becomes smaller by 0.01 radians or more, at up to a tenth of L2 stretch.
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
    follow_strokes: bool = True
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
        set_field(self, "stretch", arguments.number("stretch", self.stretch, "pass a number from 0 to 1"))
        set_field(self, "straighten", arguments.flag("straighten", self.straighten))
        set_field(self, "mirrored_cuts", arguments.flag("mirrored_cuts", self.mirrored_cuts))
        set_field(self, "follow_strokes", arguments.flag("follow_strokes", self.follow_strokes))
        set_field(self, "repair", arguments.flag("repair", self.repair))
        share = arguments.number("square_share", self.square_share, "pass a number above 0, up to 100")
        set_field(self, "square_share", share)
        set_field(self, "loop_turning", _loop_turning(self.loop_turning))
        set_field(self, "threads", thread_count(self.threads))


def thread_count(count: int) -> int:
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
