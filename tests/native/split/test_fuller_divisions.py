# SPDX-License-Identifier: GPL-3.0-or-later
"""With Bake, islands that leave much of the square empty are divided further where the packer then fills it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache

import lsgp
import meshes
import numpy as np
import pytest
from lsgp.presets import map_comparison
from lsgp.triangles import uv_area
from map_checks import surface
from zoo import closed, swept

MODELS = {
    **{f"spring of {turns} turns": swept.spring(turns, 10, True) for turns in (2, 3, 4, 6, 7)},
    **{
        f"shade of {around} faces": closed.lathe(np.array([1, 0.6]), np.array([0, height]), around, caps=(False, False))
        for around, height in ((16, 1.2), (24, 1.5), (40, 1.5))
    },
    "circular cone": closed.lathe(np.array([1.0, 0.0]), np.array([0.0, 2.0]), 32, caps=(True, False)),
    "comb": meshes.voxels(np.array([[1, 1, 1, 1, 1, 1], *[[1, 0, 1, 0, 1, 0]] * 3], bool)[:, :, None]),
    "block": closed.box(4, (1, 1.5, 2)),
    **{
        f"frustum of {top} by {height}": closed.lathe(np.array([1, top]), np.array([0, height]), 20, caps=(True, True))
        for top, height in ((0.5, 0.7), (0.5, 1.0), (0.6, 1.0), (0.7, 1.3))
    },
}


def estimated_divisions(monkeypatch: pytest.MonkeyPatch) -> list[lsgp.Result]:
    """The maps as they are divided by the estimate alone."""
    module, before = lsgp.presets.auto_unwrap, []
    original = module.best_division

    def best_division(mapped: tuple[lsgp.Surface, object, lsgp.Result], *given: object) -> lsgp.Result:
        before.append(mapped[2])
        return original(mapped, *given)

    monkeypatch.setattr(module, "best_division", best_division)
    return before


@pytest.mark.slow
@pytest.mark.parametrize("name", MODELS)
def test_divisions_other_than_the_estimated_one_fill_the_square_more(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Whichever is chosen: the islands that packers fill a square with best change with the last bits of a mesh."""
    before = estimated_divisions(monkeypatch)
    after = lsgp.auto_unwrap(surface(MODELS[name]), preset="bake")
    usual = before[0]
    filled = uv_area(lsgp.pack_islands(usual.corner_uv, usual.island))
    if after.island.tolist() == usual.island.tolist():
        assert uv_area(after.corner_uv) == filled
        return
    islands, others = (map_comparison.island_count(result) for result in (usual, after))
    assert filled < 0.7
    # Compared with little effort, which misses a part of what more of it finds.
    assert uv_area(after.corner_uv) > 0.93 * (1 + 0.3 * max(0, others - islands) / others) * filled
    assert after.distortion.l2_stretch <= 1.01**2 * usual.distortion.l2_stretch  # one may replace another
    assert len(after.flipped) == 0 == len(after.overlapping)


@pytest.mark.parametrize(
    ("filled", "changes"),
    [
        (lambda islands: islands / 20, 1),
        (lambda islands: 0.6 / islands, -1),
        (lambda islands: 0.5, 0),
        (lambda islands: 0.7 + islands / 100, 0),  # no other is tried
    ],
    ids=["more fill more", "fewer fill more", "all fill as much", "the square is full"],
)
def test_the_division_that_fills_the_square_most_is_chosen(
    filled: Callable[[int], float], changes: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Given what the packer answers, so that it does not hang on what it makes of the islands of this mesh."""
    before = estimated_divisions(monkeypatch)
    monkeypatch.setattr(
        map_comparison, "_filled_when_packed", lambda result, *_, **__: filled(map_comparison.island_count(result))
    )
    after = lsgp.auto_unwrap(surface(MODELS["spring of 3 turns"]), preset="bake")
    assert np.sign(map_comparison.island_count(after) - map_comparison.island_count(before[0])) == changes


@pytest.mark.parametrize(("triangles", "most"), [(5000, 0.7), (5001, 0.6)])
def test_large_meshes_are_divided_otherwise_only_where_less_is_filled(
    triangles: int, most: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    few = np.zeros(triangles, np.int32)
    usual = replace(unwrapped_cube(), island=few, solved=few == 0)
    for filled in (most - 0.01, most):
        monkeypatch.setattr(map_comparison, "_filled_when_packed", lambda *_, part=filled: part)
        assert map_comparison.fills_badly(usual) == (filled < most)


@pytest.mark.parametrize("depth", [0.4, 0.45])
def test_a_divided_map_fills_the_square_no_less_than_whole(depth: float) -> None:
    """A flat body of three lobes, of which one would be cut off by the estimate; whole it fills more than half."""
    ball = meshes.icosphere(3)
    x, y, _ = ball.positions.T
    radius = 1 + depth * np.cos(3 * np.arctan2(y, x)) * (x**2 + y**2)
    result = lsgp.auto_unwrap(
        surface(meshes.make(ball.positions * radius[:, None] * [1, 1, 0.6], ball.triangles)), preset="bake"
    )
    assert uv_area(result.corner_uv) > 0.55


@pytest.mark.parametrize(
    ("before", "islands", "filled", "is_worth"),
    [
        (1, 1, 0.40, True),  # as many islands
        (1, 2, 0.46, False),
        (1, 2, 0.51, True),
        (1, 3, 0.56, False),  # three times as many are seen as such
        (1, 3, 0.62, True),
        (4, 5, 0.40, False),
        (4, 5, 0.42, True),
        (4, 8, 0.49, False),
        (4, 8, 0.51, True),  # twice as many islands
    ],
)
def test_what_further_islands_have_to_fill_with_bake(
    before: int, islands: int, filled: float, is_worth: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Instead of fewer that fill 0.38 of the square."""
    plain = unwrapped_cube()
    numbers = np.arange(len(plain.island))
    usual, divided = (replace(plain, island=(numbers % count).astype(np.int32)) for count in (before, islands))
    monkeypatch.setattr(map_comparison, "_filled_when_packed", lambda result, *_: 0.38 if result is usual else filled)
    worse = replace(divided, overlapping=np.array([3], np.int32))
    assert not map_comparison.may_replace_undivided(worse, usual)
    assert map_comparison.may_replace_undivided(divided, usual) == is_worth


@cache
def unwrapped_cube() -> lsgp.Result:
    return lsgp.auto_unwrap(surface(meshes.cube(2)), pack="shelves")


def test_only_whole_squares_are_compared(monkeypatch: pytest.MonkeyPatch) -> None:
    """How islands fill a square together with those of other objects one of them does not tell."""
    before = estimated_divisions(monkeypatch)
    spring = surface(MODELS["spring of 3 turns"])
    for options in (
        replace(lsgp.preset_options("bake"), square_share=0.5),
        replace(lsgp.preset_options("bake"), compact="off"),
    ):
        after = lsgp.auto_unwrap(spring, options=options)
        assert after.island.max() == before[-1].island.max()
