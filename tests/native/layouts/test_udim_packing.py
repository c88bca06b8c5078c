# SPDX-License-Identifier: GPL-3.0-or-later
"""Tight layouts in several UDIM tiles: each island inside one, with its margin, all of them at one scale."""

from __future__ import annotations

import dataclasses
from functools import cache

import lsgp
import meshes
import numpy as np
import pytest
from layout_check import coverage, moves, overlapping_islands, room
from lsgp import TexelLayout
from map_checks import surface

PARTS = surface(meshes.merge([*(meshes.bumpy_sphere(2) for _ in range(2)), *(meshes.cube(n) for n in range(1, 4))]))
ROUNDING = 1e-9


@cache
def on_shelves() -> lsgp.Result:
    """In more islands than there are tiles."""
    return lsgp.auto_unwrap(PARTS, preset="bake", pack="shelves", weights=lsgp.Weights(islands=0.0))


@cache
def in_one_tile(margin: float) -> np.ndarray:
    return lsgp.pack_islands(on_shelves().corner_uv, on_shelves().island, margin)


@pytest.fixture
def given() -> lsgp.Result:
    return on_shelves()


def rectangles(sizes: list[tuple[float, float]]) -> tuple[np.ndarray, np.ndarray]:
    """Coordinates and islands of rectangles of two triangles, one above the other."""
    low = np.cumsum([0.0, *(height + 1 for _, height in sizes)])
    uv = [[[0, y], [w, y], [w, y + h]] for (w, h), y in zip(sizes, low, strict=False)]
    rest = [[[0, y], [w, y + h], [0, y + h]] for (w, h), y in zip(sizes, low, strict=False)]
    both = np.array([corners for pair in zip(uv, rest, strict=True) for corners in pair], float)
    return both, np.repeat(np.arange(len(sizes)), 2)


def in_tiles(uv: np.ndarray, island: np.ndarray) -> dict[tuple[int, int], np.ndarray]:
    """The islands of each tile, (column, row); every island has to be inside one."""
    tiles: dict[tuple[int, int], list[int]] = {}
    for i in np.unique(island[island >= 0]):
        corners = uv[island == i].reshape(-1, 2)
        tile = np.floor(corners.mean(axis=0)).astype(int)
        assert (corners >= tile).all() and (corners <= tile + 1).all()
        tiles.setdefault(tuple(tile.tolist()), []).append(int(i))
    return {tile: np.array(found) for tile, found in tiles.items()}


def scale(old: np.ndarray, new: np.ndarray, island: np.ndarray) -> float:
    """By what all islands were scaled alike."""
    factors = np.abs(moves(old, new, island))
    assert factors == pytest.approx(factors[0, 0], rel=1e-6)
    return float(factors[0, 0])


@pytest.mark.slow
@pytest.mark.parametrize("margin", [0.0, 4 / 1024, 16 / 512])
@pytest.mark.parametrize("tiles", [2, 3])
def test_every_island_has_its_margin_in_a_tile(given: lsgp.Result, tiles: int, margin: float) -> None:
    uv = lsgp.pack_islands(given.corner_uv, given.island, margin, udim=tiles)
    found = in_tiles(uv, given.island)
    assert set(found) == {(column, 0) for column in range(tiles)}
    for tile, islands in found.items():
        inside = np.where(np.isin(given.island, islands), given.island, -1)
        measured = room(PARTS.triangles, uv - tile, inside)
        assert measured.border >= margin - ROUNDING and measured.between >= 2 * margin - ROUNDING
        assert overlapping_islands(uv, inside) == 0
    larger = scale(given.corner_uv, uv, given.island) / scale(given.corner_uv, in_one_tile(margin), given.island)
    # About as tightly packed as in one tile: how evenly the islands fill the tiles hangs on their outlines.
    assert larger**2 > 0.65 * tiles


def test_equal_squares_are_shared_out_evenly() -> None:
    uv, island = rectangles([(1.0, 1.0)] * 12)
    packed = lsgp.pack_islands(uv, island, 0.0, udim=3)
    assert sorted(len(islands) for islands in in_tiles(packed, island).values()) == [4, 4, 4]
    assert coverage(packed, island) == pytest.approx(3.0, rel=0.05)


@pytest.mark.parametrize("tiles", [2, 5, 40])
def test_no_more_tiles_are_taken_than_make_islands_larger(tiles: int) -> None:
    """A square in a tile of its own is as large as it can be, and there is room for all others in a second one."""
    uv, island = rectangles([(4.0, 4.0), *[(1.0, 1.0)] * 8])
    packed = lsgp.pack_islands(uv, island, 0.01, udim=tiles)
    assert len(in_tiles(packed, island)) == 2
    assert scale(uv, packed, island) == pytest.approx((1 - 0.02) / 4, rel=0.02)
    alone = lsgp.pack_islands(*rectangles([(2.0, 1.0)]), 0.01, udim=tiles)
    assert in_tiles(alone, np.zeros(2, int)).keys() == {(0, 0)}


@pytest.mark.slow
def test_tiles_are_in_rows_of_ten() -> None:
    uv, island = rectangles([(1.0, 1.0)] * 23)
    packed = lsgp.pack_islands(uv, island, 0.05, udim=23)
    assert set(in_tiles(packed, island)) == {(i % 10, i // 10) for i in range(23)}
    assert scale(uv, packed, island) == pytest.approx(0.9, rel=0.02)


def test_one_tile_is_the_unit_square(given: lsgp.Result, few_tries) -> None:
    whole = given.corner_uv, given.island
    assert np.array_equal(lsgp.pack_islands(*whole, udim=1), lsgp.pack_islands(*whole))
    assert np.array_equal(lsgp.pack_islands(*whole, udim=3), lsgp.pack_islands(*whole, udim=3))


def test_islands_that_may_not_be_turned_are_only_shifted(given: lsgp.Result) -> None:
    uv = lsgp.pack_islands(given.corner_uv, given.island, turned=False, udim=2)
    assert np.abs(np.angle(moves(given.corner_uv, uv, given.island))).max() < 1e-6


@pytest.mark.slow
def test_presets_take_tiles(given: lsgp.Result, few_tries) -> None:
    found = lsgp.auto_unwrap(PARTS, preset="bake", udim=3, margin=0.02)
    shared = dataclasses.replace(lsgp.preset_options("bake"), square_share=3.0)
    given = lsgp.auto_unwrap(PARTS, preset="bake", options=shared, pack="shelves")
    assert np.array_equal(found.corner_uv, lsgp.pack_islands(given.corner_uv, given.island, 0.02, udim=3))
    assert found == lsgp.auto_unwrap(PARTS, preset="bake", pack="tight", udim=3, margin=0.02)


def test_progress_never_goes_back_and_stops_it(given: lsgp.Result) -> None:
    told: list[float] = []
    lsgp.pack_islands(given.corner_uv, given.island, udim=2, progress=told.append)
    assert told == sorted(told) and told[-1] == 1.0 and len(told) > 20
    for stop in (1, len(told) // 2):
        calls = iter(range(stop))
        with pytest.raises(lsgp.Cancelled):
            lsgp.pack_islands(given.corner_uv, given.island, udim=2, progress=lambda _: next(calls, None) is not None)  # noqa: B023


@pytest.mark.parametrize(
    ("how", "told"),
    [
        ({"udim": 0}, "from 1 to 100"),
        ({"udim": 101}, "from 1 to 100"),
        ({"udim": 2, "fill": False}, "at_texel_density"),
        ({"udim": 2, "margin": 0.49}, "smaller margin"),
    ],
)
def test_what_tiles_do_not_go_with_is_refused(how, told) -> None:
    with pytest.raises(lsgp.InputError, match=told) as caught:
        lsgp.pack_islands(*rectangles([(1.0, 1.0)] * 9), **how)
    assert caught.value.code == "WRONG_PARAMETER"


def test_layouts_that_are_not_packed_have_no_tiles() -> None:
    pins = lsgp.Pins([0, 5], [[0, 0], [1, 0]])
    cube = surface(meshes.cube(2))
    for how, told in (
        ({"preset": "tile"}, "seamless"),
        ({"pins": pins}, "pinned"),
        ({"pack": "shelves"}, 'pack="tight"'),
        ({"texels": TexelLayout(40.0, 512)}, "that of texels"),
    ):
        with pytest.raises(lsgp.InputError, match=told):
            lsgp.auto_unwrap(cube, udim=2, **how)


def test_tiles_may_be_filled_by_islands_without_area() -> None:
    uv, island = rectangles([(2.0, 1.0), *[(1.0, 0.0)] * 4])
    packed = lsgp.pack_islands(uv, island, 0.01, udim=5)
    assert sum(map(len, in_tiles(packed, island).values())) == 5
    assert np.isfinite(packed).all()
