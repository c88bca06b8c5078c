# SPDX-License-Identifier: GPL-3.0-or-later
"""The Gauss-Bonnet ledger: the assigned and the missing curvature of every connected component.

A flat metric with cones has its curvature at the cones: 2 pi minus the cone's angle, pi minus it on a boundary. On a
closed component the sum is 2 pi (2 - 2 genus), whatever its shape. A free boundary takes up the remaining curvature.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _lsgp
from .api import cone_arrays
from .base import arguments
from .base.arguments import FloatArray, IndexArray
from .base.edge_keys import edge_keys, side_keys
from .base.equality import EqualByContent
from .base.short_repr import ShortRepr
from .options import Options
from .surface import Surface, require_vertices, surface_arrays

# Tolerance of the sum, radians: that of the library.
CLOSED_WITHIN = 1e-6
# Rounding of an angle in single precision, radians.
_STORED_WITHIN = 5e-7


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class LedgerPart(EqualByContent, ShortRepr):
    """The budget of one connected component; angles and curvatures in radians.

    triangles: (m,) int32. cones: (k,) int32, indices into the given list of cones; a vertex at which several components
        touch is a cone of each. A cone on a free boundary counts only if it has an angle, as a corner.
    curvature: (k,) float64, of each cone; NaN if its angle is automatic.
    euler: vertices - edges + triangles; 0 for a one-sided surface, which has no map. borders: number of boundaries.
    assigned: the sum of the given curvatures. required: the sum that all must have.
    border_takes_up: a free boundary takes up the remaining curvature, so that any set of angles closes.
    room: least and most curvature that the automatic cones can take up together.
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
        """The curvature left to automatic cones or the boundary; must be 0 if there are none."""
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
    angles: Sequence[float | None] | FloatArray | None = None,
    options: Options | None = None,
    *,
    gets_cones: bool = False,
) -> list[LedgerPart]:
    """The budget of every connected component with triangles, in the order of their first ones.

    cones, angles: as in `parameterize`; with a rule that chooses all angles, given ones have no effect. Components are
    those that `parameterize` solves separately, subject to the options' meaning of seams.
    gets_cones: use the components of `place_cones` and `cone_gains` instead. They differ if a component without cones
        is opened along its seams: its first cone makes it whole.
    The ledger says whether angles add up; `prescribe_curvature` and `parameterize` decide whether a map can have them.
    Only the number of positions matters. Raises InputError if cones are not vertices, the numbers of cones and angles
    differ, or triangles, edges and seams do not belong to the mesh.
    """
    require_vertices(surface)
    gets_cones = arguments.flag("gets_cones", gets_cones)
    given = cone_arrays(cones, angles, Options() if options is None else options)
    if not len(surface.triangles):
        return []
    return [LedgerPart(**part) for part in _lsgp.build_ledger(surface_arrays(surface), *given, gets_cones)]


def hold_complete(
    surface: Surface,
    cones: ArrayLike,
    angles: Sequence[float | None] | FloatArray,
    tentative: ArrayLike,
    options: Options | None = None,
) -> list[float | None]:
    """The angles, with tentative ones (marked, (k,) bool) kept only in components whose ledger is complete with them.

    Angles computed for one set of cones are meaningless for another: once a cone is added, removed or given another
    angle, the others are automatic again. The rounding error of angles stored in single precision is distributed over
    the kept ones.  Errors as in `build_ledger`.
    """
    given = arguments.cone_angles("angles", angles, len(arguments.index_vector("cones", cones)))
    held = list(given)
    tentative = arguments.flags("tentative", tentative, len(held))
    if not tentative.any():
        return held
    for component in build_ledger(surface, cones, angles, options):
        places = component.cones[tentative[component.cones]]
        missing = 0.0 if component.border_takes_up else component.missing
        tolerance = CLOSED_WITHIN + _STORED_WITHIN * len(component.cones)
        complete = not len(component.automatic) and abs(missing) <= tolerance
        for place in places:
            held[place] = given[place] - missing / len(places) if complete else None
    return held


def part_surface(surface: Surface, part: LedgerPart) -> Surface:
    """One component as a surface of its own, with unchanged vertex indices; cuts may follow all of its edges."""
    require_vertices(surface)
    arguments.require_type("part", part, LedgerPart)
    arguments.require_indices("part.triangles", part.triangles, len(surface.triangles))
    return surface_of_triangles(replace(surface, edges=None, cut_costs=None), part.triangles)


def surface_of_triangles(surface: Surface, triangles: NDArray[np.integer]) -> Surface:
    """These triangles by themselves, with what is marked on them; vertices keep their numbers."""
    kept = surface.triangles[triangles]
    keys = side_keys(kept, len(surface.positions))

    def is_on_them(edges: IndexArray) -> NDArray[np.bool_]:
        return np.isin(edge_keys(edges[:, 0], edges[:, 1], len(surface.positions)), keys)

    marked = {"seams": surface.seams, "borders": surface.borders, "features": surface.features}
    own: dict[str, IndexArray | FloatArray] = {name: edges[is_on_them(edges)] for name, edges in marked.items()}
    if surface.edges is not None:
        followed = is_on_them(surface.edges)
        own["edges"] = surface.edges[followed]
        if surface.cut_costs is not None:
            own["cut_costs"] = surface.cut_costs[followed]
    if surface.directions is not None:
        own["directions"] = surface.directions[triangles]
    return replace(surface, triangles=kept, **own)
