# SPDX-License-Identifier: GPL-3.0-or-later
"""Packing of finished islands, those of all objects together: by the packer of xatlas where the extension has it, and
otherwise by Blender's own."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ...core import native
from ...core.digest import digest_of
from ...core.errors import Refused
from ...core.islands import Islands, lie_along_axes
from ..tasks.areas import total_area
from .blender_packer import pack_once

EXACT = "EXACT"
"""Method of margins: what is left of them after scaling is what was asked for. Blender's own "Fraction" searches for
that too, and takes ten times as long."""
MOST_ABOVE = 0.02
"""With Blender's packer what is left of an exact margin may be so much wider; it is not narrower."""
MOST_PASSES = 5
"""Of Blender's packer, for each way to turn islands."""
QUARTER_TURN, ANY_TURN = "CARDINAL", "ANY"
"""Ways of Blender's packer to turn islands, the faster one first: the other takes seconds."""
ENOUGH, ENOUGH_UNTURNED = 0.65, 0.6
"""Parts of the square from which on a layout by Blender's packer is large enough; the other if no island is turned,
which takes a hundredth of the time."""
# Of a full turn, tried for an island that is alone, and what another of them has to gain.
DIRECTIONS = 720
TURN_GAINS = 1e-3
HARDLY_FILLED, SHORTER_UNALIGNED = 0.3, 0.9
"""An island along the axes is turned out of them where it fills so little of the square, and that makes the side at
least so much shorter, as by `lsgp.pack_islands`."""
KEPT = 8
"""Layouts that are not searched for again."""

# The last layouts by the packer of xatlas, by all that they were made from.
_kept: OrderedDict[bytes, NDArray[np.float64]] = OrderedDict()


def is_tight() -> bool:
    """Whether exact margins cost little, because the packer of xatlas is here."""
    return native.lsgp.packer_name() is not None


def pack(
    parts: Sequence[Islands], margin_method: str, margin: float, *, turned: bool = True, udim: int = 1
) -> list[NDArray[np.float64]]:
    """Pack the islands of all parts together into the unit square; returns the new corner_uv of each part.

    margin_method: of Blender's packer, or EXACT, which looks for the largest layout that leaves the margin.
    margin: around each island. turned: whether islands may be; by quarters alone where most of their border lies along
    the axes, unless that leaves most of the square empty. udim: over how many UDIM tiles they are spread at most.
    Every island is moved by a single similarity.  Raises Refused where Blender does not pack, and where several tiles
    are asked for that it would have to fill.
    """
    if len(parts) == 1 and not parts[0].island.any() and not parts[0].pinned.any():
        return [_alone(parts[0], margin, turned)]
    if margin_method != EXACT and udim == 1:
        return _turned_where_that_pays(parts, margin_method, margin, _turns(parts, turned)[-1])
    obstacle = _obstacle(parts)
    if obstacle is None:
        try:
            return _pack_tightly(parts, margin, turned, udim)
        except native.lsgp.InputError:
            # Blender's packer makes the margin narrower.
            obstacle = "the margin leaves no room for so many islands; lower it"
    if udim > 1:
        raise Refused(f"Islands cannot be spread over UDIM tiles: {obstacle}, or set UDIM Tiles to 1")
    return _with_exact_margin(parts, margin, _turns(parts, turned))


def _turns(parts: Sequence[Islands], turned: bool) -> list[str | None]:
    """How Blender's packer may turn these, the faster ways first."""
    if not turned:
        return [None]
    return [None, QUARTER_TURN] if lie_along_axes(parts) else [None, QUARTER_TURN, ANY_TURN]


def pack_at_scale(parts: Sequence[Islands], margin: float, *, turned: bool) -> list[NDArray[np.float64]] | None:
    """Put the islands of all parts close together in a square that begins at the origin, and leave their size.

    Returns, margin, turned: as of `pack`; None where the packer of xatlas cannot pack them.
    """
    return None if _obstacle(parts) else _pack_tightly(parts, margin, turned, 1, fill=False)


def _obstacle(parts: Sequence[Islands]) -> str | None:
    """Why the packer of xatlas cannot pack these, and what to do; None where it can."""
    if not is_tight():
        return "this extension has no packer for that on this Blender; use Blender from blender.org"
    if any(part.pinned.any() for part in parts):
        return "some are pinned; unpin them"
    if any(part.aspect != 1.0 for part in parts):
        return "the image is not square; use a square one"
    return None


def _pack_tightly(
    parts: Sequence[Islands], margin: float, turned: bool, udim: int, *, fill: bool = True
) -> list[NDArray[np.float64]]:
    """With the packer of xatlas.  parts: without pins, for square images.  fill: whether tiles are to be filled.

    Raises lsgp.InputError.
    """
    first = np.cumsum([0, *(int(part.island.max()) + 1 for part in parts)])
    island = np.concatenate([part.island + at for part, at in zip(parts, first[:-1], strict=True)])
    before, how = np.concatenate([part.corner_uv for part in parts]), {"fill": fill, "turned": turned, "udim": udim}
    key = digest_of(before, island, margin, how)
    uv = _kept.pop(key, None)
    if uv is None:
        uv = native.lsgp.pack_islands(before, island.astype(np.int32), margin, **how)
    _kept[key] = uv
    if len(_kept) > KEPT:
        _kept.popitem(last=False)
    return np.split(uv, np.cumsum([len(part.island) for part in parts])[:-1])


def forget() -> None:
    """Drop the layouts that are kept."""
    _kept.clear()


def _turned_where_that_pays(
    parts: Sequence[Islands], margin_method: str, margin: float, turn: str | None
) -> list[NDArray[np.float64]]:
    """The layout without turning islands, or, where that leaves much of the square empty, the larger one of it and that
    with islands turned."""
    unturned = pack_once(parts, margin_method, margin, None)
    if turn is None or _covered(unturned) >= ENOUGH_UNTURNED:
        return unturned
    return max(unturned, pack_once(parts, margin_method, margin, turn), key=_covered)


def _covered(layout: Sequence[NDArray[np.float64]]) -> float:
    return sum(map(total_area, layout))


def _with_exact_margin(
    parts: Sequence[Islands], margin: float, turns: Sequence[str | None]
) -> list[NDArray[np.float64]]:
    """The largest layout that the ways to turn islands give, with what is left of the margin after scaling no less than
    asked for."""
    added, scale, kept = margin, 0.0, None
    for turn in turns:
        for _ in range(MOST_PASSES):
            packed = pack_once(parts, "ADD", added, turn)
            now = _scale(parts, packed)
            left = added * now / margin if margin else 1.0
            if kept is None or (left >= 1 and now > scale):
                kept, scale = packed, now if left >= 1 else 0.0
            if 1 <= left <= 1 + MOST_ABOVE or now < scale:
                break
            added *= (1 + MOST_ABOVE / 2) / left
        if scale and _covered(kept) >= ENOUGH:
            break
    return kept


def _alone(part: Islands, margin: float, turned: bool) -> NDArray[np.float64]:
    """One island by itself, as large as it can be.  turned: whether it may be."""
    squeeze = native.lsgp.correct_aspect((1.0, 1.0), part.aspect)
    places = (part.corner_uv / squeeze).reshape(-1, 2)
    if turned:
        area = total_area(part.corner_uv) if lie_along_axes([part]) else 0.0
        turn = _filling_turn(places, squeeze, area)
        places = places @ np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
    places = places * squeeze
    low = places.min(axis=0)
    scale = (1 - 2 * margin) / np.ptp(places, axis=0).max()
    return (margin + scale * (places - low)).reshape(part.corner_uv.shape)


def _filling_turn(places: NDArray[np.float64], squeeze: NDArray[np.float64], aligned: float) -> float:
    """The turn with which an island gets largest, radians; Blender's packer does not look for that.

    aligned: the area of an island that lies along the axes, 0 of others; it is turned by quarters, unless that leaves
    most of the square empty.
    """
    angles = np.arange(DIRECTIONS) * (2 * np.pi / DIRECTIONS)
    reach = np.array([(places @ (np.cos(angle), np.sin(angle))).max() for angle in angles])
    quarter = DIRECTIONS // 4
    across, up = reach + np.roll(reach, -2 * quarter), np.roll(reach, -quarter) + np.roll(reach, -3 * quarter)
    side = np.maximum(across * squeeze[0], up * squeeze[1])
    least = side[::quarter].min()
    if aligned > HARDLY_FILLED * least**2 or (aligned and side.min() > SHORTER_UNALIGNED * least):
        angles, side = angles[::quarter], side[::quarter]
    # As it lies, where turning gains nothing.
    return float(angles[np.flatnonzero(side <= side.min() * (1 + TURN_GAINS))[0]])


def _scale(parts: Sequence[Islands], packed: Sequence[NDArray[np.float64]]) -> float:
    """By how much the packer scaled the islands; 1 where all of them are pinned."""
    before = after = 0.0
    for part, uv in zip(parts, packed, strict=True):
        moved = ~part.stays
        squeeze = native.lsgp.correct_aspect((1.0, 1.0), part.aspect)
        corners = [corner_uv[moved] / squeeze for corner_uv in (part.corner_uv, uv)]
        sides = [at - np.roll(at, 1, axis=1) for at in corners]
        before, after = before + np.linalg.norm(sides[0]) ** 2, after + np.linalg.norm(sides[1]) ** 2
    return float(np.sqrt(after / before)) if before else 1.0
