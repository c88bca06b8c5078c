# SPDX-License-Identifier: GPL-3.0-or-later
"""The Gauss-Bonnet ledger: the curvature given to the cones of every connected part, and what is missing.

A flat metric with cones has its curvature at the cones: 2 pi less the cone's angle, on a border pi less it. On a closed
part they add up to 2 pi (2 - 2 genus), whatever its shape. A border that turns freely takes up what the cones leave.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _lsgp, arguments
from .api import FloatArray, IndexArray, Options, Surface, cone_arrays, surface_arrays
from .equality import EqualByContent
from .short_repr import ShortRepr

# Tolerance of the sum, radians: that of the library.
CLOSED_WITHIN = 1e-6
# Rounding of an angle in single precision, radians.
_STORED_WITHIN = 5e-7


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class LedgerPart(EqualByContent, ShortRepr):
    """The account of one connected part; angles and curvatures in radians.

    triangles: (m,) int32. cones: (k,) int32, places in the list of cones that was given; a vertex at which several
        parts touch is a cone of each. A cone on a free border is one of its corners where it has an angle, none
        otherwise.
    curvature: (k,) float64, what each cone takes up; NaN where its angle is automatic.
    euler: vertices - edges + triangles; 0 of a surface with one side, which has no map. borders: how many.
    assigned: the sum of the curvatures given. required: what all have to add up to.
    border_takes_up: a free border takes up what the cones leave, so that all sets of angles close.
    room: least and most that the automatic cones can take up together.
    """

    triangles: IndexArray
    cones: IndexArray
    curvature: FloatArray
    euler: int
    borders: int
    assigned: float
    required: float
    border_takes_up: bool
    room: tuple[float, float]

    @property
    def missing(self) -> float:
        """What automatic cones or the border take up; without them it has to be 0."""
        return self.required - self.assigned

    @property
    def automatic(self) -> IndexArray:
        """Places in the list of cones of those without an angle."""
        return self.cones[np.isnan(self.curvature)]

    @property
    def closes(self) -> bool:
        """Whether angles of the automatic cones exist with which the ledger closes."""
        low, high = self.room
        return self.border_takes_up or low - CLOSED_WITHIN <= self.missing <= high + CLOSED_WITHIN

    @property
    def complete(self) -> bool:
        """Whether it closes with no angle left automatic."""
        return self.closes and not len(self.automatic)


def build_ledger(
    surface: Surface,
    cones: ArrayLike,
    angles: Sequence[float | None] | None = None,
    options: Options | None = None,
    *,
    gets_cones: bool = False,
) -> list[LedgerPart]:
    """The account of every connected part that has triangles, in the order of their first ones.

    cones, angles: as in `parameterize`; with a rule that chooses all angles, given ones do not count. Parts are those
    that `parameterize` solves one by one, as the options' meaning of seams has them.
    gets_cones: those of `place_cones` and `cone_gains` instead. They differ where a part without cones is opened along
        its seams: with its first cone it is whole.
    Whether a map can have the given angles is for `prescribe_curvature` and `parameterize` to say; the ledger says
    whether they add up.
    Of the positions only their number counts. Raises InputError where cones are no vertices, angles not as many, or
    triangles, edges and seams none of the mesh.
    """
    _require_surface(surface)
    gets_cones = arguments.flag("gets_cones", gets_cones)
    given = cone_arrays(cones, angles, Options() if options is None else options)
    if not len(surface.triangles):
        return []
    return [LedgerPart(**part) for part in _lsgp.build_ledger(surface_arrays(surface), *given, gets_cones)]


def hold_complete(
    surface: Surface,
    cones: ArrayLike,
    angles: Sequence[float | None],
    tentative: ArrayLike,
    options: Options | None = None,
) -> list[float | None]:
    """The angles, those marked tentative, (k,) bool, only in parts whose ledger is complete with them.

    Angles computed for one set of cones are meaningless for another: once a cone is added, removed or given another
    angle, the others are automatic again. The rounding error of angles stored in single precision is distributed over
    those that hold.  Errors as in `build_ledger`.
    """
    given = arguments.cone_angles("angles", angles, len(arguments.index_vector("cones", cones)))
    held = list(given)
    tentative = arguments.flags("tentative", tentative, len(held))
    if not tentative.any():
        return held
    for part in build_ledger(surface, cones, angles, options):
        places = part.cones[tentative[part.cones]]
        missing = 0.0 if part.border_takes_up else part.missing
        complete = not len(part.automatic) and abs(missing) <= CLOSED_WITHIN + _STORED_WITHIN * len(part.cones)
        for place in places:
            held[place] = given[place] - missing / len(places) if complete else None
    return held


def part_surface(surface: Surface, part: LedgerPart) -> Surface:
    """One part by itself, its vertices numbered as before; cuts may follow all of its edges."""
    _require_surface(surface)
    arguments.require_type("part", part, LedgerPart)
    arguments.require_indices("part.triangles", part.triangles, len(surface.triangles))
    return surface_of_triangles(replace(surface, edges=None, cut_costs=None), part.triangles)


def surface_of_triangles(surface: Surface, triangles: NDArray[np.integer]) -> Surface:
    """These triangles by themselves, with the edges, seams and borders on them; vertices keep their numbers."""
    kept = surface.triangles[triangles]
    keys = _edge_keys(surface, np.concatenate([kept[:, [0, 1]], kept[:, [1, 2]], kept[:, [2, 0]]]))

    def is_on_them(edges: IndexArray) -> NDArray[np.bool_]:
        return np.isin(_edge_keys(surface, edges), keys)

    marked = {"seams": surface.seams, "borders": surface.borders}
    own: dict[str, IndexArray | FloatArray] = {name: edges[is_on_them(edges)] for name, edges in marked.items()}
    if surface.edges is not None:
        followed = is_on_them(surface.edges)
        own["edges"] = surface.edges[followed]
        if surface.cut_costs is not None:
            own["cut_costs"] = surface.cut_costs[followed]
    if surface.directions is not None:
        own["directions"] = surface.directions[triangles]
    return replace(surface, triangles=kept, **own)


def _edge_keys(surface: Surface, edges: IndexArray) -> NDArray[np.int64]:
    """A number for each pair of vertices, whatever their order."""
    ends = np.sort(edges, axis=1).astype(np.int64)
    return ends[:, 0] * len(surface.positions) + ends[:, 1]


def _require_surface(surface: Surface) -> None:
    arguments.require_type("surface", surface, Surface)
    for name in ("triangles", "seams", "borders"):
        arguments.require_indices(name, getattr(surface, name), len(surface.positions))
