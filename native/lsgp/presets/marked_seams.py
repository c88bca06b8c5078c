# SPDX-License-Identifier: GPL-3.0-or-later
"""Marked seams before cones are placed: charts that are good without cones get none, the others few further cuts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from ..api import measure_charts, parameterize
from ..base import arguments
from ..base.arguments import IndexArray
from ..base.counted import counted
from ..base.edge_keys import edge_keys
from ..base.progress import Progress, share_of
from ..errors import Elements, Finding
from ..ledger import surface_of_triangles
from ..options import Options
from ..results import Chart, Result
from ..surface import Surface
from .completed_cones import GivenCones, or_none
from .components import Components, keys_of
from .map_comparison import defects

# Of the time of a press.
MEASURING = 0.1


@dataclass(frozen=True, slots=True)
class AlongSeams:
    """What a press makes of a surface with marked seams.

    surface: its seams include further cuts. given: with the triangles that get no cones. options: of the maps.
    further: (c, 2), the cuts besides the marked seams that leave charts as disks.
    """

    surface: Surface
    given: GivenCones
    options: Options
    further: IndexArray

    def told(self, result: Result) -> Result:
        """A result of the surface, in which further cuts are none of the marked seams."""
        if not len(self.further):
            return result
        keys = keys_of(self.further, self.surface)
        paths: list[IndexArray] = []
        kinds = []
        for path, kind in zip(result.cut_paths, result.cut_kinds, strict=True):
            is_further = np.isin(edge_keys(path[:-1], path[1:], len(self.surface.positions)), keys)
            changes = np.flatnonzero(np.diff(is_further)) + 1
            for begin, end in pairwise([0, *changes.tolist(), len(is_further)]):
                paths.append(path[begin : end + 1])
                kinds.append("required" if kind == "seam" and is_further[begin] else kind)
        finding = Finding(
            "CUTS_ADDED",
            f"{counted(len(self.further), 'edge was', 'edges were')} cut besides the marked seams, which leave parts "
            "that are no disks and would be stretched too much. Mark seams there to choose other routes.",
            Elements("edges", self.further),
        )
        return replace(
            result,
            cut_paths=paths,
            cut_kinds=kinds,
            required_cuts=np.concatenate([result.required_cuts, self.further]),
            warnings=[*result.warnings, finding],
        )


def along_seams(surface: Surface, given: GivenCones, options: Options, progress: Progress | None = None) -> AlongSeams:
    """Which charts that marked seams bound get no cones, and the cuts of those that are no disks.

    A chart is good if its map along the seams alone has no flipped triangles and is stretched no more than the target.
    One that is not is cut where it is no disk, if it is good then; otherwise it gets cones, as it does without seams.
    Charts of components with given cones, and of seamless layouts, across whose seams the texture runs on, are good if
    all of their component are. With the seam mode "exact" no chart gets cones or cuts.
    progress, errors: as for `measure_charts`; InputError if cones are to be placed with "exact".
    """
    unchanged = AlongSeams(surface, given, options, np.empty((0, 2), np.int32))
    if options.seams == "exact":
        if given.count is not None:
            arguments.refuse("count", given.count, 'leave it out: with the seams "exact" no cones are placed')
        everywhere = np.ones(len(surface.triangles), bool)
        if not len(given.cones):
            options = _with_least_stretch(options)
        return replace(unchanged, given=replace(given, without=everywhere), options=options)
    is_plain = options.border != "straight" and not options.loop_turning and options.unfold == "poisson"
    if options.seams != "follow" or not len(surface.seams) or not is_plain or options.method != "lsgp":
        return unchanged
    of_charts = replace(_with_least_stretch(options), seamless=None)
    first, second = share_of(progress, 0.0, 0.5), share_of(progress, 0.5, 1.0)
    charts = measure_charts(surface, of_charts, first)
    is_good = _good(charts, surface, given.target)
    lacking = [chart for chart in charts if len(chart.missing) and not is_good[chart.triangles].all()]
    if lacking:
        opened = _with_seams(surface, lacking)
        triangles = np.sort(np.concatenate([chart.triangles for chart in lacking]))
        own = surface_of_triangles(opened, triangles)
        is_good[triangles] = _good(measure_charts(own, of_charts, second), own, given.target)
    is_whole = options.seamless is not None or len(given.cones) > 0
    if is_whole:
        is_good = _in_good_components(surface, given, is_good)
    further = [chart for chart in lacking if is_good[chart.triangles].all()]
    if further:
        unchanged = replace(
            unchanged,
            surface=_with_seams(surface, further),
            further=np.concatenate([chart.missing for chart in further]),
        )
    if not is_whole:
        options = replace(options, seams="boundary")
    elif options.seamless is not None:
        options, is_good = _on_lattice(unchanged.surface, options, is_good, given.target)
    return replace(unchanged, given=replace(given, without=is_good), options=options)


def _with_least_stretch(options: Options) -> Options:
    """Without cones no texture runs on across seams, which is what seamless layouts are conformal for."""
    return options if options.seamless is None else replace(options, mode="low-stretch")


def _good(charts: Sequence[Chart], surface: Surface, target: float) -> NDArray[np.bool_]:
    """Which triangles are in good charts, (m,)."""
    out = np.zeros(len(surface.triangles), bool)
    for chart in charts:
        out[chart.triangles] = chart.is_mapped and not chart.flipped and chart.l2_stretch <= target
    return out


def _with_seams(surface: Surface, charts: Sequence[Chart]) -> Surface:
    return replace(surface, seams=np.concatenate([surface.seams, *(chart.missing for chart in charts)]))


def _whole_components(surface: Surface) -> Components:
    """As they are before seams are cut."""
    return Components.of(replace(surface, seams=None))


def _in_good_components(surface: Surface, given: GivenCones, is_good: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Which triangles are in components without given cones all of whose triangles are good, (m,)."""
    of = _whole_components(surface)
    is_bad = np.zeros(of.count, bool)
    is_bad[of.of_triangle[(of.of_triangle >= 0) & ~is_good]] = True
    is_bad[of.of_vertex[given.cones]] = True
    return (of.of_triangle >= 0) & ~is_bad[of.of_triangle]


def _on_lattice(
    surface: Surface, options: Options, is_good: NDArray[np.bool_], target: float
) -> tuple[Options, NDArray[np.bool_]]:
    """The options of a seamless layout, and which triangles get no cones in it, (m,).

    The texture runs on across seams where that is stretched no more than the target; otherwise it ends at them, where
    no component gets cones.
    """
    of = _whole_components(surface)
    is_all = bool(is_good[of.of_triangle >= 0].all())
    least = _with_least_stretch(options) if is_all else options
    running_on = or_none(partial(parameterize, surface, (), None, least))
    if running_on is not None:
        reached = of.stretches(running_on) <= target
        reached &= of.defects(running_on) == 0
        if is_all and not (reached.all() and defects(running_on) == 0):
            return replace(least, seams="boundary"), is_good
        return least, is_good & (of.of_triangle >= 0) & reached[of.of_triangle]
    if is_all:
        return replace(least, seams="boundary"), is_good
    return options, np.zeros_like(is_good)
