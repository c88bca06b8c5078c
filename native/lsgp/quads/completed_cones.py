# SPDX-License-Identifier: GPL-3.0-or-later
"""Cones of layouts: given ones, and those that the library places where these do not suffice."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np
from numpy.typing import ArrayLike

from .. import _lsgp
from ..api import Solver, given_cones, option_values, to_result
from ..base import arguments
from ..base.arguments import FloatArray, IndexArray
from ..base.progress import Progress
from ..errors import Cancelled, LsgpError, SolverError
from ..options import Options
from ..results import Result

T = TypeVar("T")

# The L2 stretch that automatic cones are placed for.
_TARGET = 1.05


@dataclass(frozen=True, slots=True)
class GivenCones:
    """cones: (k,). angles: one each, None = automatic. count: on each component that gets some; None: as few as bring
    the stretch to that of `place_cones`."""

    cones: IndexArray
    angles: list[float | None]
    count: int | None = None

    @classmethod
    def of(cls, cones: ArrayLike, angles: Sequence[float | None] | FloatArray | None, count: int | None) -> GivenCones:
        """Raises InputError."""
        given = arguments.index_vector("cones", cones)
        if count is not None:
            count = arguments.whole_number("count", count, 0, "pass a number of cones, or None for automatic")
        return cls(given, list(arguments.cone_angles("angles", angles, len(given))), count)

    @property
    def is_free(self) -> bool:
        """Whether neither cones nor their number are given."""
        return self.count is None and not len(self.cones)


def complete_cones(
    solver: Solver, given: GivenCones, options: Options, progress: Progress | None
) -> _lsgp.CompletedCones:
    """The given cones, and automatic ones where they do not suffice.  Raises the errors of `place_cones`."""
    cones = given_cones(given.cones, given.angles)
    return solver._solver.complete_cones(cones, given.count, _TARGET, option_values(options), progress)


def feature_cones(solver: Solver, options: Options, progress: Progress | None) -> _lsgp.CompletedCones | None:
    """Cones with which features can run along the lattice, and automatic ones on other components; None without
    features, or if there are no such cones."""
    return solver._solver.complete_feature_cones(_TARGET, option_values(options), progress)


def lay_out(solver: Solver, cones: _lsgp.CompletedCones, options: Options, progress: Progress | None) -> Result:
    """The map through cones, with what is found of it and of their placement.  Raises LsgpError where a component has
    none."""
    out = solver._solver.parameterize_through(cones, option_values(options), progress)
    told = out.pop("told")
    layout = to_result(out, solver.surface.borders)
    for finding in layout.warnings:
        if finding.code == "COMPONENT_SKIPPED":
            raise SolverError(finding.code, finding.message, finding.elements)
    return replace(layout, warnings=told)


def held_open(given: GivenCones, held: IndexArray) -> GivenCones:
    """The given cones, and some that are held at half a turn."""
    return GivenCones(np.concatenate([given.cones, held]), [*given.angles, *[math.pi] * len(held)], given.count)


def or_none(attempt: Callable[[], T]) -> T | None:
    """The value of an attempt; None if the library refuses it. Cancellation propagates."""
    try:
        return attempt()
    except Cancelled:
        raise
    except LsgpError:
        return None
