# SPDX-License-Identifier: GPL-3.0-or-later
"""From regions to finished maps: pins, the library's result, aspect and placement. Nothing is written.

Runs in a thread of its own while Blender continues, so nothing here touches Blender's data.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ...core import native
from ...core.errors import Refused
from . import cells
from .areas import mean_tile_size, size_in_texels
from .cones_between import told_between
from .cuts import CutChoice, with_cut_costs
from .directions import DirectionChoice, with_directions
from .solving import solve_all
from .unwrapped import Unwrapped

if TYPE_CHECKING:
    import lsgp
    from lsgp.run.feature_options import FeatureKinds

    from ...core.cone_angles import ConeAngles
    from ...core.region import Region
    from .solving import Progress

HIGH_DISTORTION = "HIGH_DISTORTION"
# Stretch from which on a map is of little use.
NEEDS_CONES = 1.5
GRID_REFINED = "GRID_REFINED"
TARGET_MISSED = "PLACEMENT_NOT_REACHED"
USUAL_TARGET = 1.05
"""The stretch that cones are placed for where nobody chooses another."""
# Of an island: below, nobody sees it.
_SEEN_STRETCH = 1.1
# Of the area of all objects, of those that have no say in the size of automatic tiles.
_SMALL_SHARE = 0.05
# How much smaller an object's automatic tiles may be than elsewhere without being told, and without larger ones being
# tried where it has cuts that they would have to fit: it takes long to find that they do not.
_MOST_UNSAID_SCALE = 2.0
# Times the stretch that an object has with tiles of its own size, to have those that the others have.
_PRICE_OF_ONE_SIZE = 1.1
# Of the chosen size, by which tiles have to differ from it to be told.
_NOTICEABLE = 0.01


@dataclass(frozen=True, slots=True)
class UnwrapSettings:
    """What the artist chose.

    cone_group: the vertex group of the cones. weight_group: that of the importance weights, None where all vertices
    count alike. weight_factor: what a weight of 1 adds to an importance of 1. subdivided: whether regions are read with
    the Subdivision Surface modifier. cuts: where cuts should run. direction: where the texture
    should. features: what runs straight along u or v besides edges with the attribute for it. The others as in the
    operator.
    """

    options: lsgp.Options
    cone_group: str
    weight_group: str | None
    weight_factor: float
    use_pins: bool
    keep_placement: bool
    correct_aspect: bool
    cuts: CutChoice
    direction: DirectionChoice = field(default_factory=DirectionChoice)
    features: FeatureKinds | None = None
    subdivided: bool = False


@dataclass(frozen=True, slots=True)
class UnwrapTask:
    """Everything that the map of one region is computed from.

    cones: those of the region with their angles. pinned: (m, 3) bool, the corners that keep their UVs. keep_placement:
    whether islands stay where the old UVs of the region are. aspect: of the image that the coordinates are for; 1 where
    they are not corrected for one. cuts: where they should run. completes: whether cones are placed where those of the
    region do not suffice; count: how many on each connected part that gets some, None for as few as bring the stretch
    to the target; symmetric: whether they are placed alike on both sides of a mirror plane, if that costs little;
    weights: by which maps are compared, None for the usual ones.
    creases_of: the preset of `lsgp.auto_unwrap` whose rule then bounds hard surfaces at creases; None: no creases.
    Regions that are rounded have none.
    """

    region: Region
    cones: ConeAngles
    options: lsgp.Options
    pinned: NDArray[np.bool_]
    keep_placement: bool
    aspect: float
    cuts: CutChoice
    completes: bool = False
    count: int | None = None
    target: float = USUAL_TARGET
    symmetric: bool = False
    weights: lsgp.Weights | None = None
    creases_of: str | None = None

    @property
    def threads(self) -> int:
        return self.options.threads

    def with_threads(self, count: int) -> UnwrapTask:
        return replace(self, options=replace(self.options, threads=count))


def unwrap_task(region: Region, settings: UnwrapSettings) -> UnwrapTask:
    """What the map of the region is computed from.  Raises Refused."""
    options = _options_for(region, settings.options)
    region = _with_features(with_directions(region, settings.direction), settings.features)
    if region.weights is not None and settings.weight_factor:
        weighted = replace(region.surface, importance=1.0 + settings.weight_factor * region.weights)
        region = replace(region, surface=weighted)
    return UnwrapTask(
        region=region,
        cones=region.own_cones,
        options=options,
        pinned=region.pinned if settings.use_pins else np.zeros_like(region.pinned),
        keep_placement=settings.keep_placement,
        aspect=region.image_aspect if settings.correct_aspect else 1.0,
        cuts=settings.cuts,
    )


def _with_features(region: Region, kinds: FeatureKinds | None) -> Region:
    if kinds is None:
        return region
    found = kinds.edges_of(region.surface, region.sharp)
    return replace(region, surface=replace(region.surface, features=np.concatenate([region.surface.features, found])))


def unwrap_all(
    tasks: Sequence[UnwrapTask],
    progress: Progress | None = None,
    solve: Callable[[UnwrapTask, Progress | None], Unwrapped] | None = None,
) -> list[Unwrapped | Exception]:
    """The maps of all tasks; an error in place of each that could not be computed.  Raises Cancelled.

    Automatic tiles of seamless layouts have one size in the world but for density weights: as large as all
    but a small part of the area permits; objects there that have no layout with it, or are stretched too much, keep
    smaller ones.
    solve: in place of `unwrap`.
    """
    tasks, solve = _sharing_the_square(tasks), solve or unwrap
    if len(tasks) < 2 or not all(_has_automatic_tiles(task) for task in tasks):
        return solve_all(tasks, solve, progress)
    share_of = native.part("base.progress").share_of
    outcomes = solve_all(tasks, solve, share_of(progress, 0.0, 0.5))
    # What is scaled to nothing has no size.
    found = {i: each for i, each in enumerate(outcomes) if isinstance(each, Unwrapped) and _tile_size(each) > 0}
    common = _common_tile_size(list(found.values()))
    others = [i for i, each in found.items() if _may_have_tiles_of(each, common)]
    redone = solve_all([_with_tile_size(tasks[i], common) for i in others], solve, share_of(progress, 0.5, 1.0))
    for i, each in zip(others, redone, strict=True):
        if _tile_size(found[i]) > common or _is_hardly_worse(each, found[i]):
            outcomes[i] = each
    for i in found:
        each = outcomes[i]
        factor = common / _tile_size(each) if isinstance(each, Unwrapped) else 1.0
        if factor > _MOST_UNSAID_SCALE:
            outcomes[i] = _with_smaller_tiles(each, factor)
    return outcomes


def _common_tile_size(unwrapped: Sequence[Unwrapped]) -> float:
    """The largest one that suits all but a small part of the area."""
    if not unwrapped:
        return 0.0
    by_size = sorted(unwrapped, key=_tile_size)
    areas = np.cumsum([size_in_texels(each.region) ** 2 for each in by_size])
    return _tile_size(by_size[np.argmax(~(areas <= _SMALL_SHARE * areas[-1]))])


def _may_have_tiles_of(unwrapped: Unwrapped, size: float) -> bool:
    """Whether it has others, and is worth being tried with those."""
    larger = size / _tile_size(unwrapped)
    return larger != 1 and (larger <= _MOST_UNSAID_SCALE or not len(unwrapped.result.seamless.cut_errors))


def _is_hardly_worse(one: Unwrapped | Exception, than: Unwrapped) -> bool:
    if not isinstance(one, Unwrapped) or len(one.result.flipped) > len(than.result.flipped):
        return False
    if not one.result.solved[than.result.solved].all():
        return False
    return one.result.distortion.l2_stretch <= _PRICE_OF_ONE_SIZE * than.result.distortion.l2_stretch


def _with_smaller_tiles(unwrapped: Unwrapped, factor: float) -> Unwrapped:
    result = unwrapped.result
    message = (
        f"Tiles are {factor:.3g} times smaller than on the other objects, as this one is too small for tiles as large "
        "as there. Choose smaller tiles, or unwrap small objects separately."
    )
    elements = native.lsgp.Elements("triangles", np.flatnonzero(result.solved).astype(np.int32))
    finding = native.lsgp.Finding(HIGH_DISTORTION, message, elements)
    return replace(unwrapped, result=replace(result, warnings=[*result.warnings, finding]))


def _has_automatic_tiles(task: UnwrapTask) -> bool:
    seamless = task.options.seamless
    return seamless is not None and seamless.tiles is None and seamless.tile_size is None


def _tile_size(unwrapped: Unwrapped) -> float:
    """In the world, where the density weight is 1."""
    return unwrapped.result.seamless.tile_size * unwrapped.region.texel_scale


def _with_tile_size(task: UnwrapTask, size: float) -> UnwrapTask:
    """size: in the world, where the density weight is 1."""
    seamless = replace(task.options.seamless, tile_size=size / task.region.texel_scale)
    return replace(task, options=replace(task.options, seamless=seamless))


def _sharing_the_square(tasks: Sequence[UnwrapTask]) -> list[UnwrapTask]:
    """Each with its share of the square that all are to be packed into, by area in texels, where that matters."""
    if all(task.options.compact == "off" for task in tasks):
        return list(tasks)
    areas = np.array([size_in_texels(task.region) ** 2 for task in tasks])
    shares = areas / areas.sum() if (areas > 0).all() and np.isfinite(areas).all() else np.ones(len(tasks))
    return [
        replace(task, options=replace(task.options, square_share=float(share) * task.options.square_share))
        for task, share in zip(tasks, shares, strict=True)
    ]


def unwrap(task: UnwrapTask, progress: Progress | None, solver: lsgp.Solver | lsgp.Preview | None = None) -> Unwrapped:
    """The map of one task.  Raises LsgpError.

    solver: for the region's surface with its costs of cuts, to reuse what it has factorized; or to approximate the map
    of a region without pins.
    """
    lsgp = native.lsgp
    if solver is None:
        task = replace(task, region=with_cut_costs(task.region, task.cuts))
    region, pinned = task.region, task.pinned
    # The library works where both axes have the same unit of length.
    squeeze = lsgp.correct_aspect((1.0, 1.0), task.aspect)
    pins = _pins(region, pinned, region.corner_uv / squeeze)
    imposed = task.cones.without_stale(region.surface, task.options)
    if task.completes:
        result = _completed(task, imposed, pins, progress)
    else:
        parameterize = partial(lsgp.parameterize, region.surface) if solver is None else solver.parameterize
        if pins is not None:
            parameterize = partial(parameterize, pins=pins)
        result = parameterize(imposed.cones, imposed.angles, task.options, progress=progress)
    result = replace(result, warnings=_with_one_stretch(result, task))
    result = replace(result, warnings=_with_size_of_tiles(result, task))
    between = told_between(region.surface, imposed.cones)
    result = replace(result, warnings=[*result.warnings, *between])
    uv = result.corner_uv
    step = None if result.seamless is None else cells.step(task.options.seamless)
    if task.keep_placement and step is not None:
        uv = cells.keep_places(region, result, step)
    elif task.keep_placement:
        old = region.corner_uv / squeeze
        # Pins have already placed their islands.
        old[np.isin(result.island, result.island[pinned.any(axis=1)])] = np.nan
        uv = lsgp.fit_placement(uv, old, result.island)
    uv = lsgp.correct_aspect(uv, task.aspect)
    # Pinned UVs keep their exact bytes, which the way through double precision would round.
    exact = pinned & result.solved[:, None]
    uv[exact] = region.corner_uv[exact]
    return Unwrapped(region, result, uv, exact, task.aspect, step)


def _completed(task: UnwrapTask, cones: ConeAngles, pins: lsgp.Pins | None, progress: Progress | None) -> lsgp.Result:
    """The map through these cones and those placed besides.  Raises LsgpError."""
    return native.lsgp.auto_unwrap(
        task.region.surface,
        cones.cones,
        cones.angles,
        preset=task.creases_of or "paint",
        options=task.options,
        count=task.count,
        target=task.target,
        symmetric=task.symmetric,
        weights=task.weights,
        creases=task.creases_of is not None and not task.region.is_rounded,
        sharp=task.region.sharp,
        pins=pins,
        pack="shelves",  # the islands of all objects are packed together, afterward
        progress=progress,
    )


def _with_one_stretch(result: lsgp.Result, task: UnwrapTask) -> list[lsgp.Finding]:
    """The warnings with the measured stretch instead of the predicted one, and with a remedy."""
    # Where faces are named, smaller tiles are the remedy.
    others = [f for f in result.warnings if f.code != HIGH_DISTORTION or f.elements.kind == "triangles"]
    # Nobody minds where no less than usual was asked for.
    is_lenient = task.completes and task.count is None and task.target >= USUAL_TARGET
    if is_lenient and any(f.code == TARGET_MISSED for f in others) and _worst_stretch(result, task) < _SEEN_STRETCH:
        others = [f for f in others if f.code != TARGET_MISSED]
    warned = any(f.code == HIGH_DISTORTION and f.elements.kind != "triangles" for f in result.warnings)
    stretch = result.distortion.l2_stretch
    if not len(result.cones) and not stretch < NEEDS_CONES and not task.completes:
        message = (
            f"No cones are marked, and the map is stretched: {stretch:.3g}, 1 being none. "
            "Use Auto Unwrap, which places what is missing, or mark cones."
        )
        return [*others, native.lsgp.Finding("NO_CONES_MARKED", message)]
    if not warned or (task.options.mode == "low-stretch" and stretch < NEEDS_CONES):
        return others
    cause = "Some places are much larger in the map than others."
    if not stretch < NEEDS_CONES:
        cause = f"The map is stretched much: {stretch:.3g}, 1 being none."
    remedy = "Choose Low Stretch, or add cones where the texture is small."
    return [*others, native.lsgp.Finding(HIGH_DISTORTION, f"{cause} {remedy}")]


def _worst_stretch(result: lsgp.Result, task: UnwrapTask) -> float:
    """The largest L2 stretch of an island, at the common scale."""
    surface, solved = task.region.surface, result.solved
    stretch = native.lsgp.triangle_distortion(surface, result.corner_uv).stretch[solved]
    a, b, c = np.moveaxis(surface.positions[surface.triangles[solved]], 1, 0)
    area, island = np.linalg.norm(np.cross(b - a, c - a), axis=1), result.island[solved]
    squared = np.bincount(island, np.where(area > 0, area * stretch**2, 0.0))
    total = np.bincount(island, area)
    return float(np.sqrt((squared[total > 0] / total[total > 0]).max(initial=0.0)))


def _with_size_of_tiles(result: lsgp.Result, task: UnwrapTask) -> list[lsgp.Finding]:
    """The warnings; where a size of tiles was chosen, with how far those of the map are from it in place of the number
    of tiles, which nobody chose."""
    seamless = task.options.seamless
    if seamless is None or seamless.tile_size is None:
        return result.warnings
    others = [finding for finding in result.warnings if finding.code != GRID_REFINED]
    size = mean_tile_size(task.region, result)
    larger = size / seamless.tile_size - 1 if size else 0.0
    if not abs(larger) >= _NOTICEABLE:
        return others
    why = "a whole number of them has to fit between cones. Choose smaller tiles, which are rounded less."
    if len(others) < len(result.warnings):
        why = "there is no layout with larger ones. Use fewer cones, or choose smaller tiles."
    comparison = "larger" if larger > 0 else "smaller"
    message = f"Tiles are {100 * abs(larger):.0f} % {comparison} on the surface than the size chosen, since {why}"
    return [*others, native.lsgp.Finding("TILE_SIZE_DIFFERS", message)]


def _options_for(region: Region, options: lsgp.Options) -> lsgp.Options:
    """Tiles are measured on the object with its scale and density weight, of which the mesh knows nothing.

    Raises Refused.
    """
    seamless = options.seamless
    if seamless is None or seamless.tile_size is None:
        return options
    if not region.object_scale:
        raise Refused(
            "the object is scaled to zero, so tiles have no size on it; scale it up or give a number of tiles"
        )
    return replace(options, seamless=replace(seamless, tile_size=seamless.tile_size / region.texel_scale))


def _pins(region: Region, pinned: NDArray[np.bool_], uv: NDArray[np.float64]) -> lsgp.Pins | None:
    """Each pinned loop once; the triangles of a polygon share loops."""
    corners = np.flatnonzero(pinned)
    if not len(corners):
        return None
    _, first = np.unique(region.triangle_loops.ravel()[corners], return_index=True)
    corners = corners[np.sort(first)]
    return native.lsgp.Pins(corners.astype(np.int32), uv.reshape(-1, 2)[corners])
