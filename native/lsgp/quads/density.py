# SPDX-License-Identifier: GPL-3.0-or-later
"""The density of quads over a surface, as the scale of a metric in which all of them are equal.

A quad whose side is twice as long in the metric is half as long on the surface: lengths are scaled by the square root
of the density. Scales that fall too fast for the triangles would leave some with a side longer than both others
together; there they are raised, as little as possible.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from ..base import arguments
from ..base.arguments import FloatArray
from ..base.counted import counted
from ..base.progress import UNTOLD, Steps
from ..errors import Elements, Finding, InputError
from ..surface import Surface
from ..triangles import side_lengths, triangle_areas
from .divided_triangles import DividedSurface, divide_long_edges

# Scales of lengths are those of `Surface.scale`.
_LEAST, _MOST = 1e-12, 1e12
# How much of what two sides of a triangle are longer than the third one is to be left, and how much is enough.
_KEPT, _ENOUGH = 0.5, 0.45
# Scales are raised this much beyond what a triangle needs, so that this ends.
_BEYOND, _ROUNDING = 1.01, 1e-12
# A density that is raised by less is not worth a warning.
_TOLD = 1.1


def require_density(density: ArrayLike, vertex_count: int) -> FloatArray:
    """(n,) positive finite numbers.  Raises InputError: WRONG_PARAMETER, which names the vertices."""
    values = arguments.floats_of_shape("density", density, (vertex_count,))
    with np.errstate(invalid="ignore"):
        bad = np.flatnonzero(~((values >= _LEAST) & (values <= _MOST))).astype(np.int32)
    if len(bad):
        raise InputError(
            "WRONG_PARAMETER",
            f"The density at {counted(len(bad), 'vertex', 'vertices')} does not lie between {_LEAST:g} and {_MOST:g}. "
            "Give positive numbers, 1 for quads of ordinary size.",
            Elements("vertices", bad),
        )
    return values


def even_density(surface: Surface, density: FloatArray) -> float | None:
    """The density that all vertices of triangles have; None if they differ."""
    used = density[surface.triangles]
    return float(used.flat[0]) if used.size and used.min() == used.max() else None


def at_density(
    surface: Surface, density: FloatArray, longest: float, steps: Steps = UNTOLD
) -> tuple[DividedSurface, list[Finding]]:
    """The surface with the metric in which quads of this density are equal, and what there is to say about it. Edges
    longer than this share of the square root of its area are divided, so that the density can vary along them, and has
    places for cones.

    density: (n,) as of `require_density`. steps: told of.  Raises Cancelled.
    """
    scale = np.sqrt(density) * (1.0 if surface.scale is None else surface.scale)
    scaled = replace(surface, scale=scale)
    divided = divide_long_edges(scaled, longest * math.sqrt(_area_about(scaled)), steps)
    raised = _raised(divided.surface, steps)
    changed = np.flatnonzero(raised[: len(scale)] > math.sqrt(_TOLD) * scale).astype(np.int32)
    findings = []
    if len(changed):
        most = float(((raised[: len(scale)] / scale)[changed] ** 2).max())
        findings.append(
            Finding(
                "DENSITY_RAISED",
                f"The density was raised at {counted(len(changed), 'vertex', 'vertices')}, up to {most:.3g} times: "
                "triangles there are too large for it to fall that fast. Let it vary less, or divide them.",
                Elements("vertices", changed),
            )
        )
    return replace(divided, surface=replace(divided.surface, scale=raised)), findings


def _area_about(surface: Surface) -> float:
    """In the metric, whose triangles may be impossible yet."""
    return float(
        (triangle_areas(replace(surface, scale=None)) * surface.scale[surface.triangles].mean(axis=1) ** 2).sum()
    )


def _raised(surface: Surface, steps: Steps) -> FloatArray:
    """(n,) the scale, raised as little as possible so that the sides of every triangle keep half of what two of them
    are longer than the third one. Where all scales are the greatest one they do, so that none exceeds it."""
    triangles, sides = surface.triangles, side_lengths(replace(surface, scale=None))
    scale, most = surface.scale.copy(), float(surface.scale[triangles].max())
    active = np.arange(len(triangles))
    while len(active):
        steps.tell()
        before = scale.copy()
        for corner in range(3):
            order = [corner, (corner + 1) % 3, (corner + 2) % 3]
            at = triangles[active][:, order].T
            of_corners, of_sides = before[at], sides[active][:, order].T
            lacks = _needed(of_corners, of_sides, _ENOUGH) > (1 + _ROUNDING) * of_corners[0]
            wanted = _BEYOND * _needed(of_corners[:, lacks], of_sides[:, lacks], _KEPT)
            np.maximum.at(scale, at[0, lacks], np.minimum(wanted, most))
        active = np.flatnonzero((scale > before)[triangles].any(axis=1))
    return scale


def _needed(scale: FloatArray, sides: FloatArray, share: float) -> FloatArray:
    """The scale at the first corner with which the side opposite is as much shorter than the two others together as
    this share of what it is where all scales are equal.  scale: (3, t). sides: (3, t), the opposite one second."""
    (_, second, third), (ahead, opposite, back) = scale, sides
    kept = share * 2 / 3 * np.maximum(ahead + back - opposite, 0.0)
    beyond = second * (opposite - ahead + kept) + third * (opposite - back + kept)
    both = ahead + back - kept
    return np.divide(beyond, both, out=np.zeros_like(beyond), where=both > 0)
