# SPDX-License-Identifier: GPL-3.0-or-later
"""Cones for a map: those that are given, and automatic ones where these do not suffice."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import compress
from typing import TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..api import Solver
from ..base import arguments
from ..base.arguments import FloatArray, IndexArray
from ..base.progress import Progress
from ..errors import Cancelled, Finding, LsgpError
from ..ledger import LedgerPart, build_ledger, surface_of_triangles
from ..options import Options
from ..results import Placement, Result
from ..surface import Pins, Surface
from .map_comparison import reached_up_to

T = TypeVar("T")

# The stretch of the map that automatic cones are to reach, as of `place_cones`.
TARGET = 1.05


@dataclass(frozen=True, slots=True)
class GivenCones:
    """Cones that are to be completed.

    cones: (k,) int32. angles: one each, None = automatic. count, target: the number on each component, or the stretch
    that it goes by, as of `place_cones`. without: (m,) bool, the triangles of charts that get none; None: every chart
    may.
    """

    cones: IndexArray
    angles: list[float | None]
    count: int | None = None
    target: float = TARGET
    without: NDArray[np.bool_] | None = None

    @classmethod
    def of(
        cls,
        cones: ArrayLike = (),
        angles: Sequence[float | None] | FloatArray | None = None,
        count: int | None = None,
        target: float = TARGET,
    ) -> GivenCones:
        """As the arguments of `place_cones`.  Raises InputError where there are not as many angles as cones, or the
        target is none."""
        remedy = "pass an L2 stretch, a finite number above 1"
        stretch = arguments.number("target", target, remedy)
        if not 1 < stretch < math.inf:
            arguments.refuse("target", target, remedy)
        given = arguments.index_vector("cones", cones)
        return cls(given, list(arguments.cone_angles("angles", angles, len(given))), count, stretch)

    @property
    def is_free(self) -> bool:
        """Whether neither cones nor their number are given."""
        return self.count is None and not len(self.cones)


@dataclass(frozen=True, slots=True)
class CompletedCones:
    """Given cones and those placed in addition.

    cones: (k,) int32, given ones first. angles: one each for `parameterize`, None = automatic. placement: on the
    components that needed or were tried for cones; None if there are none. target: the stretch that determined their
    number; None if that was given. is_symmetric: whether they mirror each other, so that cuts may as well.
    """

    cones: IndexArray
    angles: list[float | None]
    placement: Placement | None
    target: float | None = TARGET
    is_symmetric: bool = False

    def parameterize(
        self, solver: Solver, options: Options, pins: Pins | None = None, progress: Progress | None = None
    ) -> Result:
        """The map through these cones. Arguments and errors as for `Solver.parameterize`."""
        of_map = replace(options, mirrored_cuts=options.mirrored_cuts or self.is_symmetric)
        return solver.parameterize(self.cones, self.angles, of_map, pins, progress)

    def joined(self, others: CompletedCones, surface: Surface, of_others: NDArray[np.bool_]) -> CompletedCones:
        """These cones, and on some components those of another choice.

        of_others: (n,) bool, the vertices of these components.
        """
        theirs, ours = of_others[others.cones], ~of_others[self.cones]
        cones = np.concatenate([self.cones[ours], others.cones[theirs]])
        angles = [*compress(self.angles, ours), *compress(others.angles, theirs)]
        placement = self.placement
        if placement is not None:
            found = _findings_on(placement, surface, ~of_others)
            if others.placement is not None:
                found = joined_warnings(found, _findings_on(others.placement, surface, of_others))
            placement = replace(placement, warnings=found)
        return CompletedCones(cones, angles, placement, self.target, self.is_symmetric)

    def told(self, result: Result, options: Options) -> Result:
        """The result of a map through these cones with the applicable warnings of it and of their placement."""
        # Presets have cuts mirrored where that is possible; nobody has to be told where it is not.
        of_map = [finding for finding in result.warnings if finding.code != "CUTS_NOT_MIRRORED"]
        if self.placement is None:
            return replace(result, warnings=of_map)
        findings = [_true_of_map(finding, result) for finding in self.placement.warnings]
        if self.target and result.distortion.l2_stretch <= reached_up_to(self.target, result, options):
            findings = [finding for finding in findings if finding.code != "PLACEMENT_NOT_REACHED"]
        return replace(result, warnings=joined_warnings(findings, of_map))


def complete_cones(
    solver: Solver,
    given: GivenCones,
    options: Options,
    progress: Progress | None = None,
    *,
    symmetric: bool = False,
) -> CompletedCones:
    """Cones for a map with these options: the given ones, and automatic ones where they do not suffice.

    Components without cones get some as far as they need them, and so do those whose ledger does not close.
    progress and errors as of `place_cones`, symmetric as well if no cones are given.
    """
    if not len(given.cones):
        return _placed(solver, given, options, progress, symmetric)
    ledger = build_ledger(solver.surface, given.cones, given.angles, options, gets_cones=True)
    lacking = [component for component in ledger if _lacks(component)]
    if given.without is not None:
        lacking = [component for component in lacking if not given.without[component.triangles].all()]
    # Given cones that no map can have leave other components without: mapping reports the defect of those.
    for components in (lacking, [component for component in lacking if not len(component.cones)]):
        if not components:
            break
        triangles = np.sort(np.concatenate([component.triangles for component in components]))
        present = np.unique(np.concatenate([component.cones for component in components]))
        own = Solver(surface_of_triangles(solver.surface, triangles))
        part = GivenCones(given.cones[present], [given.angles[i] for i in present], given.count, given.target)
        placed = or_none(partial(_place, own, part, options, progress))
        if placed is not None:
            return _completed(given, options, replace(placed, warnings=_renumbered(placed.warnings, triangles)))
    return CompletedCones(given.cones, given.angles, None, given.target)


def _true_of_map(finding: Finding, result: Result) -> Finding:
    """A finding of placement, which leaves components out that have a map without cones."""
    if finding.code != "COMPONENT_SKIPPED" or (result.island[finding.elements.indices] < 0).any():
        return finding
    reason = finding.message.partition(": ")[2]
    return replace(
        finding, code="PLACEMENT_NOT_REACHED", message=f"A component was unwrapped without placed cones: {reason}"
    )


def joined_warnings(of_placement: Sequence[Finding], of_map: Sequence[Finding]) -> list[Finding]:
    """Merges the findings of placement and mapping, without duplicates."""
    said = {(finding.code, finding.message) for finding in of_map}
    return [finding for finding in of_placement if (finding.code, finding.message) not in said] + list(of_map)


def or_none(attempt: Callable[[], T]) -> T | None:
    """The value of an attempt; None if the library refuses it. Cancellation propagates."""
    try:
        return attempt()
    except Cancelled:
        raise
    except LsgpError:
        return None


def _placed(
    solver: Solver, given: GivenCones, options: Options, progress: Progress | None, symmetric: bool
) -> CompletedCones:
    """Cones where none are given."""
    if given.without is None or not given.without.any():
        return _completed(given, options, _place(solver, given, options, progress, symmetric))
    triangles = np.flatnonzero(~given.without)
    if not len(triangles):
        return CompletedCones(given.cones, given.angles, None, given.target)
    own = Solver(surface_of_triangles(solver.surface, triangles))
    placed = _place(own, given, options, progress, symmetric)
    return _completed(given, options, replace(placed, warnings=_renumbered(placed.warnings, triangles)))


def _place(
    solver: Solver, given: GivenCones, options: Options, progress: Progress | None, symmetric: bool = False
) -> Placement:
    lattice = None if options.seamless is None else options.seamless.lattice
    return solver.place_cones(
        given.cones,
        given.angles,
        count=given.count,
        target=given.target,
        lattice=lattice,
        symmetric=symmetric,
        follow_strokes=options.follow_strokes,
        seams=options.seams,
        threads=options.threads,
        progress=progress,
    )


def _completed(given: GivenCones, options: Options, placed: Placement) -> CompletedCones:
    # The angles are for free borders, and for rules that keep them.
    as_placed = options.prescription is None and options.border == "free"
    angle_at = dict(zip(placed.cones.tolist(), placed.cone_angles.tolist(), strict=True)) if as_placed else {}
    new = placed.cones[~np.isin(placed.cones, given.cones)]
    angles = [angle_at.get(cone, angle) for cone, angle in zip(given.cones.tolist(), given.angles, strict=True)]
    angles += [angle_at.get(cone) for cone in new.tolist()]
    target = given.target if given.count is None else None
    return CompletedCones(np.concatenate([given.cones, new]), angles, placed, target)


def _renumbered(findings: Sequence[Finding], triangles: NDArray[np.integer]) -> list[Finding]:
    """Findings on these triangles of a surface as findings on the surface, of which the others are a part as well."""
    of_surface = []
    for finding in findings:
        elements = finding.elements
        if elements.kind == "triangles":
            elements = replace(elements, indices=triangles[elements.indices].astype(np.int32))
        if finding.code != "ISOLATED_VERTICES":
            of_surface.append(replace(finding, elements=elements))
    return of_surface


def _findings_on(placement: Placement, surface: Surface, marked: NDArray[np.bool_]) -> list[Finding]:
    """Those that concern marked vertices, (n,) bool, or no elements."""

    def concerns(finding: Finding) -> bool:
        indices = finding.elements.indices
        vertices = surface.triangles[indices] if finding.elements.kind == "triangles" else indices
        return not len(indices) or bool(marked[vertices].any())

    return [finding for finding in placement.warnings if concerns(finding)]


def _lacks(component: LedgerPart) -> bool:
    return not len(component.cones) or not component.closes
