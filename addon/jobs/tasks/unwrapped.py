# SPDX-License-Identifier: GPL-3.0-or-later
"""What becomes of the task of a map."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ...core.islands import Islands

if TYPE_CHECKING:
    import lsgp

    from ...core.region import Region


@dataclass(frozen=True, slots=True)
class Unwrapped:
    """A finished map.

    corner_uv: (m, 3, 2) float64 as to be written, NaN where not solved. pinned: (m, 3) bool, the corners that kept
    their UVs. aspect: as in the task. step: side of the cells by which islands of a seamless layout may be moved; None
    for other layouts. note: what is to be told of its place. placing: warnings about it; an artist is told by the
    note. square_used: the part of the UV square that all maps cover that are packed with this one; None: they are not,
    or into something else.
    """

    region: Region
    result: lsgp.Result
    corner_uv: NDArray[np.float64]
    pinned: NDArray[np.bool_]
    aspect: float
    step: float | None
    note: str = ""
    placing: tuple[lsgp.Finding, ...] = ()
    square_used: float | None = None

    @property
    def warnings(self) -> list[lsgp.Finding]:
        return self.result.warnings

    def islands(self) -> Islands:
        """The solved islands for the packer."""
        solved = self.result.solved
        region, island = self.region, self.result.island
        return Islands(
            region.surface.triangles[solved], self.corner_uv[solved], island[solved], self.pinned[solved], self.aspect
        )
