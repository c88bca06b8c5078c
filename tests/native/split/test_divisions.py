# SPDX-License-Identifier: GPL-3.0-or-later
"""How far presets divide islands to fill the square."""

from __future__ import annotations

from dataclasses import replace

import lsgp
import meshes
import numpy as np
import pytest
from lsgp.base.counted import counted
from lsgp.triangles import uv_area
from map_checks import surface
from zoo import closed, swept

MODELS = {
    "box": closed.box(4, (1, 1.5, 2)),
    "cube": meshes.cube(4),
    "spring": swept.spring(4, 10, True),
    "knot": swept.knot(2, 3, 10),
    "gear": closed.gear(12, 0.3, 2),
    "blob": meshes.bumpy_sphere(3, 0.36),
    "comb": meshes.voxels(np.array([[1, 1, 1, 1, 1, 1], *[[1, 0, 1, 0, 1, 0]] * 3], bool)[:, :, None]),
    "shade": closed.lathe(np.array([1, 0.6]), np.array([0, 1.5]), 24, caps=(False, False)),
    "frustum": closed.lathe(np.array([1, 0.6]), np.array([0, 1.0]), 20, caps=(True, True)),
}
AS_THEY_ARE = "islands as they are"


# Of costs: what differs by less decides nothing.
ROUNDING = 0.011


def count(result: lsgp.Result) -> int:
    return int(result.island.max()) + 1


def divisions(result: lsgp.Result) -> list[lsgp.Choice]:
    """Those that were considered, the usual one first; none without a choice."""
    names = [choice.name for choice in result.choices]
    return result.choices[names.index(AS_THEY_ARE) :] if AS_THEY_ARE in names else []


@pytest.mark.slow
@pytest.mark.parametrize("preset", ["paint", "bake"])
@pytest.mark.parametrize("name", MODELS)
def test_the_division_that_costs_least_is_chosen(name: str, preset: lsgp.Preset) -> None:
    """Whichever it is: what packers make of islands changes with the last bits of a mesh."""
    result = lsgp.auto_unwrap(surface(MODELS[name]), preset=preset)
    made = [choice for choice in divisions(result) if choice.cost is not None]
    least = min(choice.cost for choice in made)
    assert [choice for choice in made if choice.is_best][-1].cost < least + ROUNDING
    assert f"{counted(count(result), 'island')}," in [choice for choice in made if choice.is_best][-1].reason
    assert len(result.overlapping) == 0 == len(result.flipped)


@pytest.mark.parametrize("name", ["box", "spring", "knot", "gear"])
def test_islands_are_as_many_as_they_are_worth(name: str) -> None:
    """The dearer they are, the fewer; what packs badly is divided where they cost nothing."""
    counts = [
        count(lsgp.auto_unwrap(surface(MODELS[name]), weights=lsgp.Weights(islands=islands)))
        for islands in (0.0, 0.4, 100.0)
    ]
    assert counts == sorted(counts, reverse=True)


def test_models_that_need_it_are_divided() -> None:
    """A strip fills next to nothing of the square."""
    for name, most in (("spring", 8), ("knot", 8)):
        result = lsgp.auto_unwrap(surface(MODELS[name]))
        assert 1 < count(result) <= most
        assert uv_area(result.corner_uv) > 0.45


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
    "options",
    [
        replace(lsgp.preset_options("bake"), square_share=0.5),
        replace(lsgp.preset_options("bake"), compact="off"),
        lsgp.preset_options("tile"),
    ],
    ids=["a part of the square", "whole islands", "seamless"],
)
def test_divisions_of_whole_squares_alone_are_compared(options: lsgp.Options) -> None:
    """How islands fill a square together with those of other objects one of them does not tell."""
    assert not divisions(lsgp.auto_unwrap(surface(MODELS["gear"]), options=options))
    assert divisions(lsgp.auto_unwrap(surface(MODELS["gear"]), preset="bake"))
