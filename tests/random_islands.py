# SPDX-License-Identifier: GPL-3.0-or-later
"""Islands that no mesh should have, from a seed, and what is wrong with a layout of them.

Nothing here is shared with the library.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from island_kits import KINDS, Kit, fan, kit, quads, turned
from numpy.typing import NDArray
from packing_checks import least_gap, overlapping, similarities

FloatArray = NDArray[np.float64]
Random = np.random.RandomState

# Of the layout's extent: rounding of coordinates that are turned, scaled and shifted; and so large are islands whose
# turn and scale can be told.
ROUNDING, TELLABLE = 1e-9, 1e-4


def layout(seed: int, most: int = 60) -> Kit:
    """Up to so many islands of one kind or of several."""
    random = Random(seed)
    kind = list(LAYOUTS)[random.randint(len(LAYOUTS))]
    return LAYOUTS[kind](random, random.randint(1, most + 1))


def needle(random: Random) -> FloatArray:
    """A triangle or two, long and up to 1e15 times thinner."""
    width = 10 ** random.uniform(-15, -1)
    corners = np.array([[0, 0], [1, 0], [random.uniform(), width], [random.uniform(), -width]])
    return corners[[[0, 1, 2], [1, 0, 3]]][: random.randint(1, 3)]


def sliver(random: Random) -> FloatArray:
    """A row of triangles, all of them almost straight."""
    x = np.sort(random.uniform(size=8))
    corners = np.stack([x, 10 ** random.uniform(-12, -3) * random.normal(size=8)], axis=1)
    return np.stack([corners[:-2], corners[1:-1], corners[2:]], axis=1)


def line(random: Random) -> FloatArray:
    """Triangles without area, on a line or at a point."""
    x = random.uniform(size=(random.randint(1, 4), 3, 1)) if random.randint(3) else np.full((1, 3, 1), 0.5)
    return x * [1.0, 0.0]


def soup(random: Random) -> FloatArray:
    """Triangles that cross each other or are apart, mirrored ones among them."""
    return random.normal(size=(random.randint(1, 8), 3, 2)) * random.choice([0.2, 1.0, 5.0])


def fold(random: Random) -> FloatArray:
    """Two triangles on each other, with a side in common."""
    corners = random.uniform(size=(3, 2))
    return np.stack([corners, np.array([corners[1], corners[0], corners[2] + random.normal(0, 0.1, 2)])])


def spikes(random: Random) -> FloatArray:
    """A star with rays up to a thousand times longer than it is wide between them."""
    count = random.randint(3, 12)
    angle = np.sort(random.uniform(0, 2 * math.pi, 2 * count))
    radius = np.where(np.arange(2 * count) % 2, 1.0, 10 ** random.uniform(-3, 0))
    return fan(radius[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1))


def comb(random: Random) -> FloatArray:
    """Teeth with gaps between them, and islands of others may have to lie there."""
    x = np.cumsum(random.uniform(0.02, 1, 12))
    low, high = np.zeros(6), random.uniform(0.5, 3, 6)
    left, right = x[::2], x[1::2]
    teeth = quads(*(np.stack(corner, axis=1) for corner in ((left, low), (right, low), (right, high), (left, high))))
    back = np.array([[x[0], -0.2], [x[-1], -0.2], [x[-1], 0], [x[0], 0]])
    return np.concatenate([teeth, back[[[0, 1, 2], [0, 2, 3]]]])


WILD: tuple[Callable[[Random], FloatArray], ...] = (needle, sliver, line, soup, fold, spikes, comb)


def ordinary(random: Random) -> FloatArray:
    kinds = list(KINDS.values())
    return kinds[random.randint(len(kinds))](random, random.randint(6))


def wild_ones(random: Random, count: int) -> Kit:
    return scattered([WILD[random.randint(len(WILD))](random) for _ in range(count)], random)


def some_wild(random: Random, count: int) -> Kit:
    choices = [ordinary, ordinary, WILD[random.randint(len(WILD))]]
    return scattered([choices[random.randint(3)](random) for _ in range(count)], random)


def of_all_sizes(random: Random, count: int) -> Kit:
    """Of up to 1e30 times others."""
    reach = random.choice([3, 10, 30])
    return scattered([10 ** random.uniform(-reach, 0) * ordinary(random) for _ in range(count)], random)


def at_any_scale(random: Random, count: int) -> Kit:
    uv, island = some_wild(random, count)
    return Kit(10 ** random.uniform(-30, 30) * uv, island)


def far_away(random: Random, count: int) -> Kit:
    uv, island = scattered([ordinary(random) for _ in range(count)], random)
    return Kit(uv + 10 ** random.uniform(0, 9) * random.normal(size=2), island)


def all_alike(random: Random, count: int) -> Kit:
    one = (WILD[random.randint(len(WILD))] if random.randint(2) else ordinary)(random)
    return scattered([one] * count, random)


def touching(random: Random, count: int) -> Kit:
    """Triangles of a grid, each an island of its own or with neighbors, in one place."""
    side = math.ceil(math.sqrt(count))
    x, y = (axis.ravel().astype(float) for axis in np.meshgrid(np.arange(side), np.arange(side)))
    corner = [np.stack([x + i, y + j], axis=1) for i, j in ((0, 0), (1, 0), (1, 1), (0, 1))]
    uv = quads(*corner)
    return numbered(uv, random.randint(0, count, len(uv)))


def in_holes(random: Random, count: int) -> Kit:
    """As they come, rings lie around others."""
    rings = kit("rings", max(count, 3), int(random.randint(1000)))
    middle = np.array([rings.corner_uv[rings.island == i].mean(axis=(0, 1)) for i in range(max(count, 3))])
    return Kit(rings.corner_uv - middle[rings.island][:, None], rings.island)


def one_giant(random: Random, count: int) -> Kit:
    giant = 10 ** random.uniform(1, 4) * turned(ordinary(random), random)
    return scattered([giant, *(turned(ordinary(random), random) for _ in range(count * 5))], random)


LAYOUTS: dict[str, Callable[[Random, int], Kit]] = {
    "wild ones": wild_ones,
    "some wild": some_wild,
    "of all sizes": of_all_sizes,
    "at any scale": at_any_scale,
    "far away": far_away,
    "all alike": all_alike,
    "touching": touching,
    "in holes": in_holes,
    "one giant": one_giant,
}


def scattered(islands: list[FloatArray], random: Random) -> Kit:
    """At random places, on each other or not."""
    extent = max(float(np.abs(one).max()) for one in islands)
    placed = [one + random.uniform(-1, 1, 2) * extent * random.choice([0, 1]) for one in islands]
    return numbered(np.concatenate(placed), np.repeat(np.arange(len(islands)), [len(one) for one in islands]))


def numbered(uv: FloatArray, owner: NDArray[np.integer]) -> Kit:
    """With islands from 0 on, each of which has a triangle."""
    return Kit(uv, np.unique(owner, return_inverse=True)[1].ravel().astype(np.int32))


def layout_faults(given: Kit, uv: FloatArray, margin: float, *, fill: bool = True) -> list[str]:
    """What is wrong with packed islands, whatever they are.  margin: of the square, or in their unit without `fill`."""
    faults = []
    if not np.isfinite(uv).all():
        return ["coordinates are not finite"]
    if not fill:  # so that no square overflows here
        exponent = math.frexp(max(float(np.abs(uv).max()), margin))[1]
        uv, margin = np.ldexp(uv, -exponent), math.ldexp(margin, -exponent)
    extent = float(np.ptp(uv.reshape(-1, 2), axis=0).max())
    rounding = ROUNDING * max(extent, float(np.abs(uv).max()))
    moves = similarities(given.corner_uv, uv, given.island)
    # Tiny islands keep the digits that are left where they lie.
    if moves.worst.max() > ROUNDING + 2 * np.finfo(float).eps * float(np.abs(uv).max()) / max(extent, 1e-300):
        faults.append(f"island {moves.worst.argmax()} is distorted by {moves.worst.max():.2g} of the layout")
    sizes = np.array([np.ptp(uv[given.island == i], axis=(0, 1)).max() for i in range(len(moves.factor))])
    scale = np.abs(moves.factor[sizes > TELLABLE * extent])
    if len(scale) and np.ptp(scale) > 1e-4 * scale.max():
        faults.append(f"scales from {scale.min():.6g} to {scale.max():.6g}")
    ends = uv @ [1, 1j]
    segments = np.stack([ends, np.roll(ends, -1, axis=1)], axis=-1).reshape(-1, 2)
    gap = least_gap(segments, np.repeat(given.island, 3), 2 * margin)
    if gap < 2 * margin - rounding:
        faults.append(f"a gap of {gap:.6g} instead of {2 * margin:.6g}")
    if uv.min() < margin - rounding or (fill and uv.max() > 1 - margin + rounding):
        faults.append(f"coordinates from {uv.min():.6g} to {uv.max():.6g}")
    if len(pairs := overlapping(uv, given.island)):
        faults.append(f"islands {pairs[0].tolist()} and {len(pairs) - 1} other pairs overlap")
    return faults
