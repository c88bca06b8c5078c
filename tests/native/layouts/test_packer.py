# SPDX-License-Identifier: GPL-3.0-or-later
"""What every packed layout keeps, on islands by formula, by oracles that share nothing with the packer."""

from __future__ import annotations

import math
from functools import cache

import lsgp
import numpy as np
import pytest
from island_kits import KINDS, Kit, fan, gathered, kit, quads
from lsgp import _lsgp
from lsgp.layouts import packing
from other_process import in_another_process
from packing_checks import Packed, areas, border, least_gap, measured, overlapping, similarities
from packing_digest import digest
from scipy.ndimage import distance_transform_edt

ROUNDING = 1e-9
MARGIN = 4 / 1024
COUNTS = dict.fromkeys(KINDS, 9) | {"scraps": 40, "mixed": 40}
EFFORTS = ("quick", "good")
TEXELS = 512  # of the rasters' side

each_kind = pytest.mark.parametrize("kind", KINDS)


@cache
def islands(kind: str) -> Kit:
    return kit(kind, COUNTS[kind])


@cache
def packed(kind: str, margin: float = MARGIN, *, effort: str = "quick", **how: object) -> np.ndarray:
    return lsgp.pack_islands(*islands(kind), margin, effort=effort, **how)


def found(kind: str, uv: np.ndarray, margin: float = MARGIN) -> Packed:
    return measured(islands(kind).corner_uv, uv, islands(kind).island, margin)


def require_moved_as_wholes(given: Kit, uv: np.ndarray, scale: float | None = None) -> np.ndarray:
    """Every island by a turn, a shift and one scale, and none mirrored; returns the turns, (islands,)."""
    moves = similarities(given.corner_uv, uv, given.island)
    assert moves.worst.max() < ROUNDING
    assert np.abs(moves.factor) == pytest.approx(np.abs(moves.factor[0]) if scale is None else scale, rel=1e-9)
    return moves.factor / np.abs(moves.factor)


def require_room(given: Kit, uv: np.ndarray, margin: float) -> None:
    """Between islands, wherever they are."""
    triangle, corner = border(*given)
    z = uv @ [1, 1j]
    segments = np.stack([z[triangle, corner], z[triangle, (corner + 1) % 3]], axis=1)
    assert least_gap(segments, given.island[triangle], 2 * margin) >= 2 * margin - ROUNDING
    assert len(overlapping(uv, given.island)) == 0


@each_kind
@pytest.mark.parametrize("margin", [0.0, MARGIN, 16 / 512])
def test_gaps_are_as_wide_as_asked_for_and_nothing_overlaps(kind: str, margin: float) -> None:
    for effort in EFFORTS:
        uv = packed(kind, margin, effort=effort)
        require_room(islands(kind), uv, margin)
        assert uv.min() >= margin - ROUNDING and uv.max() <= 1 - margin + ROUNDING
        assert uv.max() == pytest.approx(1 - margin)  # it fills the square


@each_kind
@pytest.mark.parametrize("effort", EFFORTS)
def test_a_quick_layout_that_is_known_need_not_be_found_again(kind: str, effort: str) -> None:
    """As the choice of a map has it, which is measured by one."""

    def packed_from(known: np.ndarray) -> np.ndarray:
        options = packing._options(MARGIN, True, True, None, effort, None, None, None)
        return _lsgp.pack_islands(*islands(kind), options, None, known)

    assert np.abs(packed_from(packed(kind)) - packed(kind, effort=effort)).max() < ROUNDING
    larger = 2 * packed(kind)  # than any search finds
    assert np.array_equal(packed_from(larger), larger)


@each_kind
def test_islands_keep_apart_on_a_raster(kind: str) -> None:
    """Texels with their centers in an island, and how far others are from them."""
    uv, island, margin = packed(kind, 4 / TEXELS), islands(kind).island, 4 / TEXELS
    owner = np.full((TEXELS, TEXELS), -1)
    for i in range(int(island.max()) + 1):
        covered = rasterized(uv[island == i])
        assert (owner[covered] == -1).all()
        owner[covered] = i
    inside = np.pad(owner, 1, constant_values=-2)
    for i in range(int(island.max()) + 1):
        others = (inside >= 0) & (inside != i)
        if (inside == i).any() and others.any():
            assert distance_transform_edt(~others)[inside == i].min() >= 2 * margin * TEXELS - ROUNDING
        distance = distance_transform_edt(inside != -2)[inside == i]
        assert distance.min(initial=np.inf) >= margin * TEXELS - ROUNDING


def rasterized(uv: np.ndarray) -> np.ndarray:
    """(TEXELS, TEXELS) bool: texels with their centers inside triangles."""
    covered = np.zeros((TEXELS, TEXELS), bool)
    for corners in uv * TEXELS - 0.5:
        low, high = np.floor(corners.min(axis=0)).astype(int), np.ceil(corners.max(axis=0)).astype(int)
        x, y = np.meshgrid(np.arange(low[0], high[0] + 1), np.arange(low[1], high[1] + 1))
        along, away = np.roll(corners, -1, axis=0) - corners, np.stack([x, y], axis=-1) - corners[:, None, None]
        sides = along[:, 0, None, None] * away[..., 1] - along[:, 1, None, None] * away[..., 0]
        inside = (sides > 0).all(axis=0) | (sides < 0).all(axis=0)
        covered[y[inside], x[inside]] = True
    return covered


@each_kind
def test_islands_are_moved_as_wholes(kind: str) -> None:
    given = islands(kind)
    require_moved_as_wholes(given, packed(kind))
    require_moved_as_wholes(given, packed(kind, 0.1, fill=False), 1.0)
    straight = packed(kind, turned=False)
    assert require_moved_as_wholes(given, straight) == pytest.approx(1)
    quarters = require_moved_as_wholes(given, packed(kind, turned="quarters"))
    assert np.abs(quarters**4 - 1).max() < ROUNDING


@each_kind
def test_what_keeps_its_size_is_in_a_square_at_the_origin(kind: str) -> None:
    uv = packed(kind, 0.1, fill=False)
    require_room(islands(kind), uv, 0.1)
    assert uv.min() == pytest.approx(0.1)
    # It is packed no worse than if it were scaled: the least side is at a margin that is the same part of it.
    side = float(uv.max()) + 0.1
    filled = found(kind, packed(kind, 0.1 / side), 0.1 / side)
    assert found(kind, uv, 0.1 / side).coverage > 0.9 * filled.coverage


def test_where_islands_come_from_does_not_matter() -> None:
    """Shifts that round no coordinate."""
    for kind in ("concave", "mixed"):
        exact = np.round(islands(kind).corner_uv * 2**20) / 2**20
        expected = lsgp.pack_islands(exact, islands(kind).island, MARGIN, effort="quick")
        for place in ((64.0, -32.0), (0.5, 0.25)):
            uv = lsgp.pack_islands(exact + place, islands(kind).island, MARGIN, effort="quick")
            assert np.abs(uv - expected).max() < ROUNDING


@cache
def digest_of_this_process() -> str:
    return digest()


WITHOUT_PACKAGES = """
import sys
for name in ("xatlas", "scipy", "bpy", "PIL", "shapely", "numba"):
    sys.modules[name] = None
"""


@pytest.mark.parametrize(("threads", "before"), [("1", ""), ("4", ""), ("2", WITHOUT_PACKAGES)])
def test_the_same_bytes_everywhere(threads: str, before: str) -> None:
    """For any number of threads, order of hashes and installed packages."""
    script = before + "import packing_digest; print(packing_digest.digest())"
    printed = in_another_process(script, LSGP_THREADS=threads, PYTHONHASHSEED=threads)
    assert printed.strip() == digest_of_this_process()


def test_each_island_is_in_one_tile() -> None:
    given = islands("mixed")
    for tiles in (2, 5):
        uv = packed("mixed", udim=tiles)
        require_moved_as_wholes(given, uv)
        require_room(given, uv, MARGIN)
        for i in range(COUNTS["mixed"]):
            corners = uv[given.island == i].reshape(-1, 2)
            tile = np.floor(corners.mean(axis=0))
            assert 0 <= tile[0] < tiles and tile[1] == 0
            assert (corners - tile >= MARGIN - ROUNDING).all() and (corners - tile <= 1 - MARGIN + ROUNDING).all()


AREAS = [(0.25, 0.5, 0.75, 1.0), (-3.0, 2.0, 5.0, 3.0), (0.0, 0.0, 0.5, 4.0)]


@pytest.mark.parametrize("area", AREAS)
@pytest.mark.parametrize("kind", ["convex", "strips", "mixed"])
def test_an_area_is_filled(kind: str, area: tuple[float, float, float, float]) -> None:
    """Islands lie in it with their margin, and reach from one of its sides to the other."""
    given, margin = islands(kind), 0.004
    uv = packed(kind, margin, area=area)
    require_moved_as_wholes(given, uv)
    require_room(given, uv, margin)
    low, high = uv.min(axis=(0, 1)), uv.max(axis=(0, 1))
    assert (low >= np.array(area[:2]) + margin - ROUNDING).all() and (
        high <= np.array(area[2:]) - margin + ROUNDING
    ).all()
    left = np.array([area[2] - area[0], area[3] - area[1]]) - 2 * margin - (high - low)
    assert left.min() < 1e-6 * max(high - low)


def test_islands_that_keep_their_size_fit_an_area_or_are_named() -> None:
    given = islands("concave")
    side = float(packed("concave", 0.01, fill=False).max()) + 0.01
    roomy = (0.0, 0.0, 1.2 * side, 1.2 * side)
    uv = lsgp.pack_islands(*given, 0.01, fill=False, area=roomy, effort="quick")
    require_moved_as_wholes(given, uv, 1.0)
    require_room(given, uv, 0.01)
    assert uv.min() >= 0.01 - ROUNDING and uv.max() <= 1.2 * side - 0.01 + ROUNDING
    require_refused(given, 0.01, fill=False, area=(0.0, 0.0, 0.5 * side, 0.5 * side))


def in_blocks(uv: np.ndarray, island: np.ndarray, block: float) -> tuple[np.ndarray, np.ndarray]:
    """The first and the last block of each island's box, (islands, 2) each, and that the box begins at a corner."""
    boxes = [(uv[island == i].min(axis=(0, 1)), uv[island == i].max(axis=(0, 1))) for i in range(island.max() + 1)]
    low, high = (np.array(ends) / block for ends in zip(*boxes, strict=True))
    assert np.abs(low - np.round(low)).max() < 1e-6
    return np.round(low).astype(int), np.ceil(high - 1e-6).astype(int) - 1


@pytest.mark.parametrize("texels", [1, 4])
@pytest.mark.parametrize("kind", ["convex", "rings", "mixed"])
def test_boxes_begin_on_whole_blocks_that_no_two_islands_share(kind: str, texels: int) -> None:
    given, block = islands(kind), texels / TEXELS
    for margin in (0.0, 1 / TEXELS):
        uv = packed(kind, margin, snap=block)
        require_moved_as_wholes(given, uv)
        require_room(given, uv, margin)
        in_blocks(uv, given.island, block)
        owner = {}
        for i in range(COUNTS[kind]):
            for cell in touched(uv[given.island == i], block):
                assert owner.setdefault(cell, i) == i


def touched(uv: np.ndarray, block: float) -> set[tuple[int, int]]:
    """Blocks that have a point of a fine grid of the triangles well inside them."""
    steps = np.array([(i, j, 24 - i - j) for i in range(25) for j in range(25 - i)]) / 24
    places = (steps @ uv).reshape(-1, 2) / block
    inside = (np.abs(places - np.round(places)) > 1e-6).all(axis=1)
    return set(map(tuple, np.floor(places[inside]).astype(int).tolist()))


def test_groups_keep_together() -> None:
    given = islands("mixed")
    groups = np.where(np.arange(COUNTS["mixed"]) < 12, np.arange(COUNTS["mixed"]) // 4, -1)
    # As they would be placed by hand: each group somewhere else, its islands side by side.
    for effort in EFFORTS:
        uv = lsgp.pack_islands(*given, MARGIN, groups=groups, effort=effort)
        require_moved_as_wholes(given, uv)
        for group in range(3):
            of_group = np.where(groups[given.island] == group, 0, -1)
            moves = similarities(given.corner_uv, uv, of_group)
            assert moves.worst.max() < ROUNDING
        assert len(overlapping(uv, given.island)) == 0


def test_groups_of_overlapping_islands_are_packed_as_they_are() -> None:
    """Stacks: what is in a group is not kept apart from each other, only from the rest."""
    given = islands("convex")
    twice = Kit(np.concatenate([given.corner_uv, given.corner_uv]), np.concatenate([given.island, given.island + 9]))
    uv = lsgp.pack_islands(*twice, MARGIN, groups=np.tile(np.arange(9), 2), effort="quick")
    assert np.array_equal(uv[: len(given.island)], uv[len(given.island) :])
    require_room(given, uv[: len(given.island)], MARGIN)


def locked_layout() -> tuple[Kit, list[int]]:
    """Packed islands, of which some keep their place while the others are spread out."""
    uv, island, kept = packed("mixed"), islands("mixed").island, [3, 8, 20]
    moved = np.where(np.isin(island, kept)[:, None, None], uv, 0.7 * uv + 2)
    return Kit(moved, island), kept


def test_locked_islands_stay_and_others_leave_them_their_margin() -> None:
    given, kept = locked_layout()
    is_kept = np.isin(given.island, kept)
    for effort in EFFORTS:
        uv = lsgp.pack_islands(*given, MARGIN, locks={"place": kept}, effort=effort)
        assert np.array_equal(uv[is_kept], given.corner_uv[is_kept])
        require_room(given, uv, MARGIN)
        assert uv.min() >= MARGIN - ROUNDING and uv.max() <= 1 - MARGIN + ROUNDING
        moves = similarities(given.corner_uv[~is_kept], uv[~is_kept], given.island[~is_kept])
        scale = np.abs(np.delete(moves.factor, kept))
        assert scale == pytest.approx(scale[0], rel=1e-9)


def test_islands_that_keep_their_rotation_or_their_scale() -> None:
    given = islands("leaves")
    uv = lsgp.pack_islands(*given, MARGIN, locks={"rotation": [0, 4, 5]}, effort="quick")
    turns = require_moved_as_wholes(given, uv)
    assert turns[[0, 4, 5]] == pytest.approx(1)
    small = Kit(given.corner_uv * 0.03, given.island)
    uv = lsgp.pack_islands(*small, MARGIN, locks={"scale": [2, 3]}, effort="quick")
    factor = np.abs(similarities(small.corner_uv, uv, small.island).factor)
    assert factor[[2, 3]] == pytest.approx(1)
    assert np.delete(factor, [2, 3]) == pytest.approx(factor[0], rel=1e-9)
    require_room(small, uv, MARGIN)


def test_all_islands_locked_are_left_as_they_are() -> None:
    uv, island = packed("convex"), islands("convex").island
    assert np.array_equal(lsgp.pack_islands(uv, island, MARGIN, locks={"place": range(9)}), uv)


def require_refused(given: Kit, margin: float, names: list[int] | None = None, **how: object) -> lsgp.InputError:
    """With the triangles of these islands, and inputs left as they were."""
    uv, island = given.corner_uv.copy(), given.island.copy()
    with pytest.raises(lsgp.InputError) as caught:
        lsgp.pack_islands(uv, island, margin, **how)
    assert np.array_equal(uv, given.corner_uv, equal_nan=True) and np.array_equal(island, given.island)
    assert caught.value.code in ("WRONG_PARAMETER", "INDEX_OUT_OF_RANGE")
    if names is not None:
        assert caught.value.elements.kind == "triangles"
        assert sorted(set(given.island[caught.value.elements.indices].tolist())) == names
    return caught.value


def test_margins_without_room_are_refused_with_how_many_would_fit() -> None:
    """Of two squares one: their corners would be further apart than those of the square without its margin."""
    given = rectangles([(1.0, 1.0)] * 2)
    refused = require_refused(given, 0.3)
    assert "1 of 2 islands" in refused.message
    # What is left out is named by its triangles.
    assert refused.elements.kind == "triangles"
    assert len(set(given.island[refused.elements.indices].tolist())) == 1
    assert np.isin(given.island, given.island[refused.elements.indices]).sum() == len(refused.elements.indices)


WAYS = (
    *({}, {"fill": False}, {"turned": "quarters"}, {"turned": False}, {"udim": 3}, {"snap": 1 / 256}),
    *({"area": (-3.0, 2.0, 5.0, 3.0)}, {"locks": {"place": [0]}}, {"locks": {"scale": [2]}}, {"groups": [0, 0, 1, 1]}),
)


def given_for(kind: str, how: dict[str, object]) -> Kit:
    """Small, so that what is locked fits."""
    return Kit(islands(kind).corner_uv * (0.02 if "locks" in how else 1.0), islands(kind).island)


def arguments(kind: str, how: dict[str, object]) -> dict[str, object]:
    alone = [-1] * (COUNTS[kind] - 4)
    return how | {"groups": [*how["groups"], *alone]} if "groups" in how else how


@each_kind
@pytest.mark.parametrize("how", WAYS, ids=str)
def test_a_packed_layout_is_not_packed_worse(kind: str, how: dict[str, object]) -> None:
    """What is given is one of the layouts that are compared; and it keeps what every layout keeps."""
    given, how = given_for(kind, how), arguments(kind, how)
    margin = 0.004 * (float(np.ptp(given.corner_uv)) if how.get("fill") is False else 1.0)
    once = lsgp.pack_islands(*given, margin, effort="quick", **how)
    again = lsgp.pack_islands(once, given.island, margin, effort="quick", **how)
    if how.get("fill") is False:
        assert again.max() <= once.max() * (1 + ROUNDING)
    else:
        assert areas(again).sum() >= areas(once).sum() * (1 - ROUNDING)
    if "groups" not in how:
        require_room(given, again, margin)


def test_layouts_of_more_effort_are_given_to_less() -> None:
    for kind in ("convex", "concave"):
        good = packed(kind, effort="good")
        again = lsgp.pack_islands(0.3 * good + 2, islands(kind).island, MARGIN, effort="quick")
        assert areas(again).sum() >= areas(good).sum() * (1 - ROUNDING)


@each_kind
@pytest.mark.parametrize("how", WAYS, ids=str)
def test_numbers_of_islands_triangles_and_corners_do_not_matter(kind: str, how: dict[str, object]) -> None:
    """To the byte, as none of these islands are equal."""
    given, how = given_for(kind, how), arguments(kind, how)
    random = np.random.RandomState(1)
    triangles, number = random.permutation(len(given.island)), random.permutation(COUNTS[kind])
    first = random.randint(3, size=(len(given.island), 1))
    corners = (first + np.arange(3)) % 3

    def renumbered(uv: np.ndarray) -> np.ndarray:
        return np.take_along_axis(uv[triangles], corners[:, :, None], axis=1)

    of_numbers = dict(how)
    if "groups" in how:
        of_numbers["groups"] = np.array(how["groups"])[np.argsort(number)]
    if "locks" in how:
        of_numbers["locks"] = {what: number[kept].tolist() for what, kept in how["locks"].items()}
    expected = lsgp.pack_islands(*given, MARGIN, effort="quick", **how)
    renamed = number[given.island][triangles].astype(np.int32)
    found = lsgp.pack_islands(renumbered(given.corner_uv), renamed, MARGIN, effort="quick", **of_numbers)
    assert np.array_equal(found, renumbered(expected))


@each_kind
def test_more_effort_is_never_worse(kind: str) -> None:
    for margin in (0.0, MARGIN):
        quick, good = (areas(packed(kind, margin, effort=effort)).sum() for effort in EFFORTS)
        assert good >= quick * (1 - ROUNDING)


def test_what_cannot_be_packed_is_named() -> None:
    given, kept = locked_layout()
    outside = given.corner_uv.copy()
    outside[given.island == kept[1]] += 1
    require_refused(Kit(outside, given.island), MARGIN, [kept[1]], locks={"place": kept})
    overlap = given.corner_uv.copy()
    middles = [given.corner_uv[given.island == i].mean(axis=(0, 1)) for i in (kept[0], kept[1])]
    overlap[given.island == kept[1]] += middles[0] - middles[1]
    require_refused(Kit(overlap, given.island), MARGIN, [kept[0], kept[1]], locks={"place": kept})
    lost = given.corner_uv.copy()
    lost[np.flatnonzero(given.island == 5)[0], 1] = np.nan
    require_refused(Kit(lost, given.island), MARGIN, [5])
    for how in (
        *({"effort": "fast"}, {"seconds": -1.0}, {"snap": 0.0}, {"area": (0, 0, 0, 1)}, {"area": (0, 0, np.nan, 1)}),
        *({"locks": {"color": [1]}}, {"locks": {"place": [99]}}, {"udim": 3, "fill": False}, {"margin": math.nan}),
    ):
        require_refused(given, how.pop("margin", MARGIN), **how)


def test_progress_rises_and_stops_the_work() -> None:
    given = kit("mixed", 100)
    for effort in (*EFFORTS, "best"):
        told: list[float] = []
        how = {"seconds": 1.0} if effort == "best" else {}
        lsgp.pack_islands(*given, 1 / 1024, effort=effort, progress=told.append, **how)
        assert told == sorted(told) and told[-1] == 1 and 0 <= told[0] < 1
        with pytest.raises(lsgp.Cancelled):
            lsgp.pack_islands(*given, 1 / 1024, effort=effort, progress=lambda done: done < 0.3, **how)
        with pytest.raises(lsgp.Cancelled):
            lsgp.pack_islands(*given, 1 / 1024, effort=effort, progress=lambda _: False, **how)


def rectangles(sizes: list[tuple[float, float]]) -> Kit:
    corners = np.array([[[0, 0], [1, 0], [1, 1]], [[0, 0], [1, 1], [0, 1]]])
    return gathered([corners * size for size in sizes])


def test_what_fits_exactly_fills_the_square() -> None:
    """Without margins: equal squares, one rectangle in two halves, and a square cut into rectangles."""
    for sizes, least in (
        ([(1.0, 1.0)] * 16, 0.99),
        ([(2.0, 1.0)] * 2, 0.99),
        ([(3, 1), (1, 3), (3, 1), (1, 3), (2, 2)], 0.8),
    ):
        given = rectangles(sizes)
        uv = lsgp.pack_islands(*given, 0.0)
        assert measured(given.corner_uv, uv, given.island, 0.0).coverage > least


def test_islands_without_area_are_moved_along() -> None:
    """Points, lines, and what is hardly longer than rounding, beside others; and a line alone."""
    given = islands("convex")
    point, line = [[0.3, 0.1]] * 3, [[0.2, 0.5], [0.4, 0.9], [0.3, 0.7]]
    tiny = np.array([[0, 0], [1, 0], [0, 1]]) * 1e-16 + [0.7, 0.2]
    uv = np.concatenate([given.corner_uv, [point, line, tiny]])
    island = np.concatenate([given.island, [9, 10, 11]])
    packed_uv = lsgp.pack_islands(uv, island, MARGIN, effort="quick")
    require_moved_as_wholes(given, packed_uv[:-3])
    require_room(Kit(uv, island), packed_uv, MARGIN)
    assert packed_uv.min() >= MARGIN - ROUNDING and packed_uv.max() <= 1 - MARGIN + ROUNDING
    assert np.ptp(lsgp.pack_islands([line, line], [0, 1], MARGIN), axis=(0, 1)).max() > 0.9


def test_disks_lie_in_rings() -> None:
    """The rings alone, side by side, would take a square of which half stays empty."""
    given = kit("rings", 30)
    uv = lsgp.pack_islands(*given, 1 / 1024, effort="quick")
    boxes = sum(np.ptp(given.corner_uv[given.island == i], axis=(0, 1)).prod() for i in range(30))
    area = measured(given.corner_uv, given.corner_uv, given.island, 0.0)
    assert measured(given.corner_uv, uv, given.island, 1 / 1024).coverage > 1.1 * area.coverage * area.side**2 / boxes


@pytest.mark.parametrize("count", [1, 4, 40])
def test_holes_of_holes_are_filled(count: int) -> None:
    """Rings, one for the hole of each, and a disk for that of it, hardly smaller than these."""
    angle = np.arange(33) * (2 * math.pi / 32)
    circle = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    circle[-1] = circle[0]

    def between(inner: float, outer: float) -> np.ndarray:
        return quads(outer * circle[:-1], outer * circle[1:], inner * circle[1:], inner * circle[:-1])

    rings = [*[between(0.85, 1.0)] * count, *[between(0.65, 0.8)] * count, *[0.6 * fan(circle[:-1])] * count]
    given, margin = gathered(rings), 1 / 1024
    uv = lsgp.pack_islands(*given, margin, effort="quick")
    require_room(given, uv, margin)
    boxes = [(uv[given.island == i].min(axis=(0, 1)), uv[given.island == i].max(axis=(0, 1))) for i in range(3 * count)]
    low, high = (np.array(ends) for ends in zip(*boxes, strict=True))
    for first in (0, count):
        outer, inner = slice(first, first + count), slice(first + count, first + 2 * count)
        is_inside = (low[inner, None] > low[outer]).all(axis=2) & (high[inner, None] < high[outer]).all(axis=2)
        assert (is_inside.sum(axis=0) == 1).all() and (is_inside.sum(axis=1) == 1).all()


def test_a_thousand_scraps_are_packed() -> None:
    given = kit("scraps", 1000)
    uv = lsgp.pack_islands(*given, 1 / 2048, effort="quick")
    require_moved_as_wholes(given, uv)
    require_room(given, uv, 1 / 2048)
    assert measured(given.corner_uv, uv, given.island, 1 / 2048).coverage > 0.45


def dissected(seed: int) -> tuple[np.ndarray, np.ndarray]:
    """The rectangles that a square of side 8 is cut into along whole numbers, apart from each other."""
    random = np.random.RandomState(seed)

    def parts(width: int, height: int, cuts: int) -> list[tuple[int, int]]:
        longer = max(width, height)
        if cuts == 0 or longer == 1:
            return [(width, height)]
        at = random.randint(1, longer)
        if width == longer:
            return parts(at, height, cuts - 1) + parts(width - at, height, cuts - 1)
        return parts(width, at, cuts - 1) + parts(width, height - at, cuts - 1)

    sizes = np.array(parts(8, 8, 3), float)
    corners = np.array([[0, 0], [1, 0], [1, 1], [0, 1]])[[[0, 1, 2], [0, 2, 3]]]
    apart = 10.0 * np.arange(len(sizes))[:, None, None, None]
    return (corners * sizes[:, None, None] + apart).reshape(-1, 3, 2), np.repeat(np.arange(len(sizes)), 2)


def fits(seed: int, effort: str) -> bool:
    """Whether the pieces of a square of side 8 are placed in one that is hardly larger."""
    uv, island = dissected(seed)
    try:
        packed = lsgp.pack_islands(uv, island, 0.0, fill=False, area=(0, 0, 8.1, 8.1), effort=effort)
    except lsgp.InputError:
        return False
    assert packed.min() >= -ROUNDING and packed.max() <= 8.1 + ROUNDING
    assert len(overlapping(packed, island)) == 0 and areas(packed).sum() == pytest.approx(64)
    return True


def test_what_keeps_its_size_is_placed_in_other_orders_until_it_fits() -> None:
    """More of what fits is found with more effort, and all that is found with less."""
    quick, good = ({seed for seed in range(30) if fits(seed, effort)} for effort in EFFORTS)
    assert quick < good


@pytest.mark.slow
def test_the_best_layout_within_seconds_is_never_below_a_good_one() -> None:
    for kind in ("convex", "concave"):
        good, best = (packed(kind, **how) for how in ({"effort": "good"}, {"effort": "best", "seconds": 0.3}))
        assert areas(best).sum() >= areas(good).sum() * (1 - ROUNDING)


@pytest.mark.slow
def test_best_layouts_turn_islands_more_finely_than_good_ones() -> None:
    """Good ones of up to eight islands have eight directions in a quarter turn, from the longest side of their hull."""
    island = np.arange(6, dtype=np.int32)

    def off_directions(effort: str, seed: int) -> int:
        random = np.random.default_rng(seed)
        corners = np.exp(2j * np.pi * (np.arange(3) + random.uniform(0.1, 0.9, (6, 3))) / 3)
        uv = np.stack([corners.real, corners.imag], axis=-1)
        z = lsgp.pack_islands(uv, island, 0.0, effort=effort) @ (1, 1j)
        sides = np.roll(z, -1, axis=1) - z
        longest = sides[island, np.abs(sides).argmax(axis=1)]
        eighths = np.angle(longest) / (np.pi / 16)
        return int((np.abs(eighths - eighths.round()) > 1e-3).sum())

    # Those of the smallest square around an island are off, too.
    seeds = range(4)
    assert sum(off_directions("best", seed) for seed in seeds) > sum(off_directions("good", seed) for seed in seeds)
