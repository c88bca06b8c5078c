# SPDX-License-Identifier: GPL-3.0-or-later
"""Tight layouts: margins, one scale, turns, determinism; and when islands stay where they are."""

from __future__ import annotations

import hashlib
import math
import sys
from dataclasses import replace
from functools import cache

import lsgp
import meshes
import numpy as np
import packing_checks
import pytest
from island_gaps import least_gap
from layout_check import coverage, moves, overlapping_islands, room, share_along_axes
from lsgp import TexelLayout
from map_checks import codes, surface
from other_process import in_another_process

PARTS = surface(meshes.merge([*(meshes.bumpy_sphere(2) for _ in range(3)), *(meshes.cube(n) for n in range(1, 4))]))
PACKED = ("paint", "bake")  # presets
# Rounding of coordinates in the unit square.
ROUNDING = 1e-9


@cache
def on_shelves(preset: str) -> lsgp.Result:
    return lsgp.auto_unwrap(PARTS, preset=preset, pack="shelves")


@pytest.fixture
def maps() -> None:
    """Which cuts are best is decided by tight layouts of them, too."""
    for preset in PACKED:
        on_shelves(preset)


@pytest.fixture
def few_tries(maps, few_tries) -> None:
    """For what is packed, while the maps that tests share are those of all tries."""


def squares(count: int, side: float = 0.1) -> tuple[np.ndarray, np.ndarray]:
    """Coordinates and islands of squares of two triangles, one beside the other."""
    corners = np.array([[0, 0], [side, 0], [side, side], [0, side]])
    uv = np.concatenate([corners[[[0, 1, 2], [0, 2, 3]]] + [2 * side * i, 0] for i in range(count)])
    return uv, np.repeat(np.arange(count), 2)


def require_packed(old: np.ndarray, new: np.ndarray, island: np.ndarray, margin: float, triangles: np.ndarray) -> None:
    """No overlap, margins, and every island moved by a turn, a shift and the same scale, those along the axes by a
    quarter turn."""
    assert overlapping_islands(new, island) == 0
    found = room(triangles, new, island)
    assert found.between >= 2 * margin - ROUNDING and found.border >= margin - ROUNDING
    factors = moves(old, new, island)
    assert np.abs(factors) == pytest.approx(np.abs(factors[0, 0]), rel=1e-6)
    for i in range(int(island.max()) + 1):
        of_island = factors[island[island >= 0] == i]
        assert np.abs(of_island - of_island[0, 0]).max() < 1e-6 * abs(of_island[0, 0])
        if share_along_axes(triangles[island == i], old[island == i]) > 0.5:
            assert quarter_turned(of_island[0, 0])


def quarter_turned(factor: complex) -> bool:
    quarters = np.angle(factor) / (math.pi / 2)
    return bool(np.abs(quarters - np.round(quarters)) < 1e-6)


@pytest.mark.slow
@pytest.mark.parametrize("margin", [0.0, 1 / 4096, 4 / 1024, 16 / 512])
@pytest.mark.parametrize("preset", ["paint", "bake"])
def test_islands_keep_their_margin_and_one_scale(few_tries, preset: str, margin: float) -> None:
    given = on_shelves(preset)
    uv = lsgp.pack_islands(given.corner_uv, given.island, margin)
    require_packed(given.corner_uv, uv, given.island, margin, PARTS.triangles)
    assert uv.max() == pytest.approx(1 - margin)  # it fills the square


def test_more_is_covered_than_on_shelves() -> None:
    for given in map(on_shelves, PACKED):
        packed = lsgp.pack_islands(given.corner_uv, given.island)
        assert coverage(packed, given.island) > 1.05 * coverage(given.corner_uv, given.island)


@pytest.mark.parametrize("margin", [0.0, 0.01, 2.0])
def test_islands_that_keep_their_size(margin: float) -> None:
    given = on_shelves("bake")
    uv = lsgp.pack_islands(given.corner_uv, given.island, margin, fill=False)
    assert np.abs(moves(given.corner_uv, uv, given.island)) == pytest.approx(1.0, rel=1e-6)
    assert uv.min() == pytest.approx(margin)
    assert room(PARTS.triangles, uv, given.island).between >= 2 * margin - ROUNDING
    assert overlapping_islands(uv, given.island) == 0


def test_cuts_match_as_before() -> None:
    """Within islands each cut has one turn and one translation still, and along all cuts sides are as long."""
    ball = meshes.bumpy_sphere(3)
    both = surface(meshes.merge([ball, ball, meshes.cube(3)]))
    result = lsgp.auto_unwrap(both, options=lsgp.Options(mode="low-stretch"), creases=False, pack="tight")
    assert result.island.max() == 2 and len(result.cut_edges) > 20
    measured = lsgp.measure_distortion(both, result.corner_uv, result.cones)
    assert measured.seams.rotation_residual < 1e-9 and measured.seams.translation_residual < 1e-9
    split = lsgp.auto_unwrap(PARTS, preset="bake", pack="tight")
    for of, found in ((both, result), (PARTS, split)):
        measured = lsgp.measure_distortion(of, found.corner_uv, found.cones)
        # A press rounds positions to 2^-32 of the surface's size, of which the shortest edges are a twentieth.
        assert measured.seams.sister_ratio_max - 1 < 2e-8 and len(measured.flipped) == 0
        assert measured.distortion.l2_stretch == pytest.approx(found.distortion.l2_stretch, rel=1e-9)
    assert replace(split, corner_uv=on_shelves("bake").corner_uv) == on_shelves("bake")


def test_islands_that_may_not_be_turned_are_only_shifted() -> None:
    given = on_shelves("bake")
    uv = lsgp.pack_islands(given.corner_uv, given.island, turned=False)
    require_packed(given.corner_uv, uv, given.island, 4 / 1024, PARTS.triangles)
    assert np.abs(np.angle(moves(given.corner_uv, uv, given.island))).max() < 1e-6


def test_a_direction_that_was_asked_for_stays() -> None:
    up = replace(PARTS, directions=np.array([0.0, 0.0, 1.0]))
    shelves, tight = (lsgp.auto_unwrap(up, preset="bake", pack=pack) for pack in ("shelves", "tight"))
    assert np.abs(np.angle(moves(shelves.corner_uv, tight.corner_uv, tight.island))).max() < 1e-6
    assert coverage(tight.corner_uv, tight.island) > coverage(shelves.corner_uv, shelves.island)


def digest() -> str:
    """Of layouts that take several tries."""
    packed = [lsgp.pack_islands(given.corner_uv, given.island).tobytes() for given in map(on_shelves, PACKED)]
    return hashlib.sha256(b"".join(packed)).hexdigest()


@cache
def digests() -> tuple[str, str]:
    """Of this process, twice."""
    return digest(), digest()


@pytest.mark.slow
@pytest.mark.parametrize("threads", ["1", "3"])
def test_another_process_gives_the_same_bytes(threads: str) -> None:
    """Whatever the order of hashes and the number of processors."""
    one_processor = "import os; os.sched_setaffinity(0, [min(os.sched_getaffinity(0))])\n"
    script = (one_processor if threads == "1" and sys.platform == "linux" else "") + "import test_packing as t\n"
    printed = in_another_process(script + "print(t.digest())", LSGP_THREADS=threads, PYTHONHASHSEED=threads)
    assert digests() == (printed.strip(), printed.strip())


@pytest.mark.slow
@pytest.mark.parametrize("count", [1, 2, 100, 700])
def test_few_and_many_islands(count: int) -> None:
    uv, island = squares(count)
    margin = 1 / 1024
    packed = lsgp.pack_islands(uv, island, margin)
    middles = packed[::2, [0, 2]].mean(axis=1)
    side = np.abs(packed[0, 0] - packed[0, 1]).max()
    apart = np.abs(middles[:, None] - middles).max(axis=2)[np.triu_indices(count, 1)] - side
    assert apart.min(initial=1) >= 2 * margin - ROUNDING and overlapping_islands(packed, island) == 0
    assert packed.min() >= margin - ROUNDING and packed.max() <= 1 - margin + ROUNDING
    # Squares with their margins, on a grid.
    least = (1 - 2 * margin * (math.ceil(math.sqrt(count)) + 1)) ** 2 * count / math.ceil(math.sqrt(count)) ** 2
    assert coverage(packed, island) > (0.99 if count == 1 else 0.7) * least


@pytest.mark.parametrize("count", [1, 3])
@pytest.mark.parametrize("length", [1.2, 20.0])
def test_long_strips_lie_along_the_diagonal(count: int, length: float) -> None:
    """Those that are hardly longer than wide stay along the axes."""
    uv, island = squares(count)
    packed = lsgp.pack_islands(uv * [length, 1], island)
    factor = moves(uv * [length, 1], packed, island)[0, 0]
    assert quarter_turned(factor) == (length < 2)
    if length > 2:
        # Exactly so, beside each other; or nearly so in a way that covers more, as in steps.
        gap = 2 * 4 / 1024
        scale = ((1 - gap) * math.sqrt(2) - (count - 1) * gap) / ((length + count) * 0.1)
        covers_more = coverage(packed, island) > scale**2 * length * count * 0.01
        assert abs(factor.real) == pytest.approx(abs(factor.imag), rel=0.25 if covers_more else 0.05)
        # The square around strips on top of each other, with room for their margins.
        side = (length + 1.2 * count) * 0.1 / math.sqrt(2)
        assert coverage(packed, island) > 0.9 * length * count * 0.01 / side**2


def test_an_island_that_is_alone_is_turned_until_it_fits_best() -> None:
    angle = 0.3
    corners = np.array([[0, 0], [3, 0], [3, 3], [0, 3], [1.5, 1.5]]) @ [
        [math.cos(angle), math.sin(angle)],
        [-math.sin(angle), math.cos(angle)],
    ]
    island = np.zeros(4, np.int32)
    uv = corners[[[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]]]
    assert coverage(lsgp.pack_islands(uv, island), island) > 0.97
    packed = lsgp.pack_islands(uv, island, turned="quarters")
    assert quarter_turned(moves(uv, packed, island)[0, 0]) and coverage(packed, island) < 0.7
    with pytest.raises(lsgp.InputError, match='True, False or "quarters"'):
        lsgp.pack_islands(uv, island, turned="thirds")


@pytest.mark.parametrize("scraps", [20, 100, 400])
def test_a_large_island_is_turned_among_scraps_as_if_it_were_alone(scraps: int) -> None:
    around = np.linspace(0, 2 * np.pi, 60, endpoint=False)
    rim = np.stack([np.cos(around), 0.4 * np.sin(around)], axis=1)
    body = np.stack([np.zeros_like(rim), rim, np.roll(rim, -1, axis=0)], axis=1)
    alone = lsgp.pack_islands(body, np.zeros(len(body), np.int32), margin=0, effort="quick")
    small, owner = squares(scraps, 0.02)
    uv = np.concatenate([body, small])
    island = np.concatenate([np.zeros(len(body), np.int32), owner + 1])
    packed = lsgp.pack_islands(uv, island, margin=0, effort="quick")

    def side(new: np.ndarray) -> float:
        """Of the square, beside the length of the body."""
        return 2 / float(np.linalg.norm(new[0, 1] - new[30, 1]))

    assert side(packed) <= 1.05 * side(alone) < 1.9


@pytest.mark.parametrize("count", [30, 300, 2_000, 20_000])
def test_margins_of_many_islands_take_at_most_a_quarter_of_their_room(count: int) -> None:
    corner = np.array([[0, 0, 0], [0.01, 0, 0], [0, 0.01, 0]])
    positions = (np.random.default_rng(0).uniform(size=(count, 1, 3)) + corner).reshape(-1, 3)
    soup = lsgp.Surface(positions, np.arange(3 * count, dtype=np.int32).reshape(-1, 3))
    result = lsgp.auto_unwrap(soup, preset="paint")
    filled = coverage(result.corner_uv, result.island)
    assert filled > 0.4
    z = result.corner_uv @ [1, 1j]
    sides = np.stack([z, np.roll(z, -1, axis=1)], axis=2).reshape(-1, 2)
    texel = 1 / 1024
    gap = packing_checks.least_gap(sides, np.repeat(result.island, 3), 9 * texel)
    # A texel at least, and as wide as usual as long as there is room.
    assert gap >= (8 if count == 30 else 1) * texel * (1 - 1e-9)
    extent = np.ptp(result.corner_uv, axis=1).sum()
    tenth = 1.1  # what layouts fill is told before they are made
    assert gap < tenth * texel or gap * extent + count * gap**2 < tenth * 0.25 * filled


@pytest.mark.parametrize("order", [[0, 1, 2], [2, 0, 1]])
def test_an_island_without_a_border_is_packed_like_others(order: list[int]) -> None:
    """Two triangles on each other, with the same corners."""
    uv = np.array([[[0, 0], [1, 0], [1, 0.3]], [[1, 0], [0, 0], [1, 0.3]], [[2, 0], [3, 0], [3, 1]]])
    packed = lsgp.pack_islands(uv[order], np.array([0, 0, 1])[order])
    assert overlapping_islands(packed, np.array([0, 0, 1])[order]) == 0


def test_an_island_lies_in_the_hole_of_another() -> None:
    angle = np.arange(48) * (2 * math.pi / 48)
    circle = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    inner, outer = 0.8 * circle, circle
    around = np.arange(48), np.roll(np.arange(48), -1)
    band = [[outer[i], outer[j], inner[i]] for i, j in zip(*around, strict=True)]
    band += [[outer[j], inner[j], inner[i]] for i, j in zip(*around, strict=True)]
    disk = [[[3, 0], 0.7 * circle[i] + [3, 0], 0.7 * circle[j] + [3, 0]] for i, j in zip(*around, strict=True)]
    uv, island = np.array(band + disk), np.repeat([0, 1], [96, 48])
    packed = lsgp.pack_islands(uv, island)
    assert coverage(packed, island) > 0.6  # the ring alone would leave 0.28, both side by side 0.17
    assert room(np.arange(3 * len(uv)).reshape(-1, 3), packed, island).border >= 4 / 1024 - ROUNDING


@pytest.mark.parametrize("locks", [None, {"scale": [0]}])
@pytest.mark.parametrize("exponent", [-900, -20, -1, 1, 10, 500, 900])
def test_an_area_of_another_size_is_filled_likewise(exponent: int, locks: dict | None) -> None:
    """By a power of two it is the same to the last bit; what keeps its size becomes as much larger."""
    uv, island = squares(5)
    large = math.ldexp(1.0, exponent)
    how = {"margin": 0.01, "effort": "quick", "locks": locks}
    expected = lsgp.pack_islands(uv, island, area=(0, 0, 1, 0.5), **how)
    how["margin"] *= large
    given = uv if locks is None else uv * large
    found = lsgp.pack_islands(given, island, area=(0, 0, large, large / 2), **how)
    assert np.array_equal(found, expected * large)


@pytest.mark.parametrize("fill", [True, False])
@pytest.mark.parametrize(("width", "height"), [(1, 1000), (3e4, 1), (1e3, 1e6), (1e-6, 1e-5), (1e5, 1e5)])
def test_areas_of_any_size_and_shape_take_little_memory(width: float, height: float, fill: bool) -> None:
    """Raster and islands are small, or the area is much larger than these."""
    narrow = min(width, height)
    uv, island = squares(7, narrow / 20)
    area, margin = (0, 0, width, height), narrow / 200
    packed = lsgp.pack_islands(uv, island, margin, fill=fill, area=area, effort="quick")
    factors = np.abs(moves(uv, packed, island))
    assert factors == pytest.approx(factors[0, 0], rel=1e-9) and (fill or factors[0, 0] == pytest.approx(1))
    assert overlapping_islands(packed / narrow, island) == 0
    reach = packed.reshape(-1, 2)
    assert (reach.min(axis=0) >= margin * (1 - 1e-6)).all()
    assert (reach.max(axis=0) <= np.array([width, height]) * (1 + 1e-9) - margin).all()
    # Seven squares side by side are at most as wide as the area.
    assert not fill or factors[0, 0] * narrow / 20 > narrow / 8


@pytest.mark.parametrize("side", [1e-3, 1e-6])
def test_small_islands_find_room_around_one_that_keeps_its_place(side: float) -> None:
    uv, island = squares(3, side)
    uv[island == 0] *= 0.3 / side
    uv[island == 0] += 0.1
    packed = lsgp.pack_islands(uv, island, 1e-9, fill=False, area=(0, 0, 1, 1), locks={"place": [0]}, effort="quick")
    assert np.array_equal(packed[island == 0], uv[island == 0])
    assert overlapping_islands(packed, island) == 0 and packed.min() >= 0 and packed.max() <= 1


def test_what_an_area_cannot_hold_is_refused_with_its_numbers() -> None:
    uv, island = squares(2)
    with pytest.raises(lsgp.InputError, match="only 0 of 2 islands fit"):
        lsgp.pack_islands(uv * 1e6, island, fill=False, area=(0, 0, 1, 1))
    with pytest.raises(lsgp.InputError, match="only 1 of 2 islands fit"):
        lsgp.pack_islands(uv * 1e6, island, locks={"scale": [0]})
    with pytest.raises(lsgp.InputError, match="far outside the area"):
        lsgp.pack_islands(uv, island, 0, fill=False, area=(0, 0, 1e-200, 1e-200))
    with pytest.raises(lsgp.InputError, match="no side is more than"):
        lsgp.pack_islands(uv, island, 0, area=(0, 0, 1e7, 1))


def told_at_most(message: str) -> float:
    return float(message.split("at most ")[1].split(",")[0].rstrip("."))


def shape_errors(old: np.ndarray, new: np.ndarray) -> np.ndarray:
    """(m,) of each triangle's sides, relative to the longest one, but for a scale of all."""
    before, after = (np.linalg.norm(uv - np.roll(uv, 1, axis=1), axis=2) for uv in (old, new))
    before, after = before / before.max(), after / after.max()
    return np.abs(after - before).max(axis=1) / before.max(axis=1)


# One step of coordinates that are 2^33 times as large as an island is a part of 2^-20 of it.
STEP = 2.0**-20


@pytest.mark.parametrize(
    ("margin", "area"),
    [*((10.0**n, False) for n in (8, 10, 17, 154, 300, 308)), *((10.0**n, True) for n in (8, 17, 90))],
)
@pytest.mark.parametrize("count", [1, 7, 30])
def test_a_margin_beside_which_islands_have_no_digits_is_refused(count: int, area: bool, margin: float) -> None:
    """Such islands collapsed; a margin that is told instead fits."""
    uv, island = squares(count, 1.0)
    uv[island == 0] *= 1e-3
    how = {"fill": False, "effort": "quick"} | ({"area": (0, 0, 16 * margin, 16 * margin)} if area else {})
    with pytest.raises(lsgp.InputError, match=r"The margin is .*, so large that numbers are too far apart") as caught:
        lsgp.pack_islands(uv, island, margin, **how)
    told = told_at_most(caught.value.message)
    assert told < margin
    limiting = np.unique(island[caught.value.elements.indices])
    assert limiting.tolist() == [0] if margin == 1e8 else 0 in limiting
    packed = lsgp.pack_islands(uv, island, told, **how)
    assert shape_errors(uv, packed).max() < 2 * STEP
    # It is not told much less than what would do.
    assert packed.max() > 2.0**29 * 1e-3


@pytest.mark.parametrize("how", [{"fill": True}, {"fill": False, "margin": 0.1}, {"locks": {"scale": [1]}}])
@pytest.mark.parametrize("place", [(1e17, 0), (-1e17, 3), (5, -1e60), (1e90, 1e90)])
def test_an_area_where_islands_have_no_digits_is_refused(place: tuple[float, float], how: dict) -> None:
    uv, island = squares(3, 1.0)
    size = max(64.0, 2.0**-40 * max(np.abs(place)))

    def packed(x: float, y: float) -> np.ndarray:
        return lsgp.pack_islands(uv, island, area=(x, y, x + size, y + size), effort="quick", **how)

    with pytest.raises(lsgp.InputError, match="so far from the origin that numbers there are too far apart") as caught:
        packed(*place)
    told = told_at_most(caught.value.message)
    assert told < max(np.abs(place))
    found = packed(told, -told)
    assert np.isfinite(found).all()
    # What keeps its scale is a speck beside islands that fill a large area, and does not count.
    counted = {0, 2} if "locks" in how and size > 2.0**30 else {0, 1, 2}
    for each in counted:
        assert shape_errors(uv[island == each], found[island == each]).max() < 2 * STEP
    assert set(island[caught.value.elements.indices]) == counted


def test_an_area_may_be_as_large_as_it_will() -> None:
    """Islands lie in its low corner, or fill it."""
    uv, island = squares(4, 1.0)
    for side in (1e17, 1e150):
        for fill in (True, False):
            packed = lsgp.pack_islands(uv, island, 0.1, fill=fill, area=(0, 0, side, side), effort="quick")
            assert shape_errors(uv, packed).max() < 1e-9


def test_islands_that_are_specks_beside_others_are_packed_with_them() -> None:
    uv, island = squares(4, 1.0)
    uv[island == 1] *= 1e-12
    for how in ({"fill": True}, {"fill": False}, {"fill": False, "area": (1, 1, 20, 20)}, {"locks": {"scale": [1]}}):
        packed = lsgp.pack_islands(uv, island, effort="quick", **how)
        assert np.isfinite(packed).all()


@pytest.mark.parametrize("snap", [1e6, 1e17, 1e200, 1e308])
def test_blocks_larger_than_all_islands_are_refused_with_the_room_there_is(snap: float) -> None:
    uv, island = squares(4, 1.0)
    with pytest.raises(lsgp.InputError, match=r"snap is .*, and the area inside the margins is [1-9]\S* by [1-9]"):
        lsgp.pack_islands(uv, island, fill=False, snap=snap)


def test_what_is_not_mapped_stays_and_what_has_no_area_is_moved_along() -> None:
    uv, island = squares(4)
    line = [[[9.0, 0.0], [9.1, 0.0], [9.05, 0.0]], [[9.0, 1.0], [9.0, 1.0], [9.0, 1.0]]]
    spike = [[[0.0, 0.0], [0.0, 0.3], [0.0, 0.1]]]  # without area, of the first square, and reaching out of it
    uv = np.concatenate([uv, line, spike, np.full((1, 3, 2), np.nan)])
    island = np.concatenate([island, [4, 5, 0, -1]])
    packed = lsgp.pack_islands(uv, island, 0.01)
    assert np.isnan(packed[-1]).all() and np.isfinite(packed[:-1]).all()
    found = room(np.arange(3 * len(uv)).reshape(-1, 3), packed, island)
    assert found.between >= 0.02 - ROUNDING and found.border >= 0.01 - ROUNDING
    assert np.array_equal(lsgp.pack_islands(np.full((2, 3, 2), 5.0), [-1, -1]), np.full((2, 3, 2), 5.0))


def test_margins_that_leave_no_room_are_refused() -> None:
    uv, island = squares(100)
    with pytest.raises(lsgp.InputError, match="smaller margin") as caught:
        lsgp.pack_islands(uv, island, 0.06)
    assert caught.value.code == "WRONG_PARAMETER"
    for margin in (-0.1, 0.5, math.nan):
        with pytest.raises(lsgp.InputError, match="margin"):
            lsgp.pack_islands(uv, island, margin)
    uv[3] = np.inf
    with pytest.raises(lsgp.InputError, match="triangle 3"):
        lsgp.pack_islands(uv, island)


def test_progress_is_told_and_stops_it() -> None:
    given = on_shelves("bake")
    told: list[float] = []
    lsgp.pack_islands(given.corner_uv, given.island, progress=told.append)
    assert told == sorted(told) and told[0] == 0 and told[-1] == 1 and len(told) > 5
    with pytest.raises(lsgp.Cancelled):
        lsgp.pack_islands(given.corner_uv, given.island, progress=lambda done: done < 0.5)
    told.clear()
    lsgp.auto_unwrap(PARTS, preset="bake", pack="tight", progress=told.append)
    assert told == sorted(told) and told[-1] == 1


@pytest.mark.slow
def test_presets_are_packed_where_that_is_installed(few_tries) -> None:
    for preset in PACKED:
        tight = lsgp.auto_unwrap(PARTS, preset=preset, pack="tight")
        assert lsgp.auto_unwrap(PARTS, preset=preset) == tight != on_shelves(preset)
        wide = lsgp.auto_unwrap(PARTS, preset=preset, pack="tight", margin=16 / 1024)
        assert room(PARTS.triangles, wide.corner_uv, wide.island).between >= 32 / 1024 - ROUNDING


def test_islands_that_may_not_be_moved_stay() -> None:
    ball = meshes.bumpy_sphere(2)
    pins = lsgp.Pins([0, 5], [[0, 0], [1, 0]])
    udim = TexelLayout(40.0, 512, udim=20)
    for how in ({"preset": "tile"}, {"pins": pins}, {"preset": "bake", "texels": udim}):
        left = lsgp.auto_unwrap(surface(ball), ball.cones, **how)
        assert left == lsgp.auto_unwrap(surface(ball), ball.cones, pack="shelves", **how)
        with pytest.raises(lsgp.InputError, match="pack is 'tight'"):
            lsgp.auto_unwrap(surface(ball), ball.cones, pack="tight", **how)


@pytest.mark.slow
@pytest.mark.parametrize("times", [0.3, 1.0, 3.0])
def test_a_texel_density_has_the_margin_that_is_asked_for(few_tries, times: float) -> None:
    size, given = 512, on_shelves("bake")
    density = times * lsgp.texel_density(PARTS, given.corner_uv, size).mean
    layout = TexelLayout(density, size)
    found = lsgp.auto_unwrap(PARTS, preset="bake", pack="tight", margin=8 / size, texels=layout)
    assert lsgp.texel_density(PARTS, found.corner_uv, size).mean == pytest.approx(density)
    assert room(PARTS.triangles, found.corner_uv, found.island).between >= 16 / size - ROUNDING
    assert found.corner_uv.min() == pytest.approx(8 / size)
    assert ("ISLANDS_OUTSIDE" in codes(found.warnings)) == (found.corner_uv.max() > 1)
    # Without one the layout is the usual one at that scale.
    plain = lsgp.auto_unwrap(PARTS, preset="bake", texels=layout)
    ratio = plain.corner_uv / lsgp.auto_unwrap(PARTS, preset="bake").corner_uv
    assert ratio == pytest.approx(ratio[0, 0, 0])


def test_a_margin_takes_a_tight_layout() -> None:
    for pack in (None, "shelves"):
        with pytest.raises(lsgp.InputError, match='pack="tight"'):
            lsgp.auto_unwrap(PARTS, pack=pack, margin=0.01)


@pytest.mark.parametrize("reach", [0.0, 0.01, 0.2, 3.0])
def test_the_least_gap_is_that_of_all_pairs(reach: float) -> None:
    random = np.random.RandomState(1)
    for _ in range(20):
        begin = random.uniform(size=(12, 2)) @ [1, 1j]
        segments = np.stack([begin, begin + random.normal(0, 0.1, (12, 2)) @ [1, 1j]], axis=1)
        owner = random.randint(0, 3, 12)
        expected = min(
            distance_of(segments[i], segments[j]) for i in range(12) for j in range(i) if owner[i] != owner[j]
        )
        found = least_gap(segments, owner, reach)
        assert found == pytest.approx(expected, abs=1e-12) if expected <= reach else found == math.inf


def distance_of(one: np.ndarray, other: np.ndarray) -> float:
    """Of two segments, over a fine grid of the points of both; 0 where they cross."""
    (a, b), (c, d) = one, other
    shares = np.linalg.lstsq(
        np.array([[(b - a).real, (c - d).real], [(b - a).imag, (c - d).imag]]),
        np.array([(c - a).real, (c - a).imag]),
        rcond=None,
    )[0]
    if ((shares >= 0) & (shares <= 1)).all():
        return 0.0

    def to(place: complex, begin: complex, end: complex) -> float:
        share = np.clip(((place - begin) / (end - begin)).real, 0, 1)
        return abs(place - begin - share * (end - begin))

    return min(to(a, c, d), to(b, c, d), to(c, a, b), to(d, a, b))
