# SPDX-License-Identifier: GPL-3.0-or-later
"""With Paint, islands are divided only where each further one fills a fifth more of the square."""

from __future__ import annotations

from dataclasses import replace

import lsgp
import meshes
import numpy as np
import pytest
from lsgp.presets import cone_choices, few_islands
from lsgp.presets.few_islands import MakeDivided, best_of_few, worth_of_filling
from lsgp.triangles import uv_area
from map_checks import surface
from meshes import Mesh
from zoo import closed, swept

PAINT = lsgp.preset_options("paint")
WELL = 0.53  # what fills more of the square counts for no island
MODELS = {
    "box": closed.box(4, (1, 1.5, 2)),
    "cube": meshes.cube(4),
    "spring": swept.spring(4, 10, True),
    "knot": swept.knot(2, 3, 10),
    "gear": closed.gear(12, 0.3, 2),
    "blob": meshes.bumpy_sphere(3, 0.36),
    "comb": meshes.voxels(np.array([[1, 1, 1, 1, 1, 1], *[[1, 0, 1, 0, 1, 0]] * 3], bool)[:, :, None]),
}


def count(result: lsgp.Result) -> int:
    return int(result.island.max()) + 1


def filled(result: lsgp.Result) -> float:
    return uv_area(lsgp.pack_islands(result.corner_uv, result.island))


def maps(mesh: Mesh, monkeypatch: pytest.MonkeyPatch) -> tuple[lsgp.Result, lsgp.Result]:
    """The chosen map and the same one with its islands left whole."""
    choices, wholes = [], []

    def choose(
        usual: lsgp.Result, options: lsgp.Options, of: lsgp.Surface, divide: MakeDivided, *_: object
    ) -> lsgp.Result:
        choices.append(best_of_few(usual, options, of, divide))
        wholes.append(divide(replace(options, compact="off")))
        return choices[-1]

    monkeypatch.setattr(cone_choices, "best_of_few", choose)
    packed = lsgp.auto_unwrap(surface(mesh))
    chosen = next(i for i, one in enumerate(choices) if one.island.tolist() == packed.island.tolist())
    return packed, wholes[chosen]


@pytest.mark.parametrize("name", MODELS)
def test_each_further_island_fills_a_fifth_more(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    divided, whole = maps(MODELS[name], monkeypatch)
    more = count(divided) - count(whole)
    assert more >= 0
    assert min(WELL, filled(divided)) >= (1.2**more - 1e-6) * min(WELL, filled(whole))
    assert len(divided.overlapping) == 0 == len(divided.flipped)


def test_models_that_need_it_are_divided(monkeypatch: pytest.MonkeyPatch) -> None:
    """A strip fills next to nothing of the square; a box fills most of it in two pieces."""
    for name, most in (("spring", 5), ("knot", 5), ("box", 2)):
        divided, whole = maps(MODELS[name], monkeypatch)
        assert count(whole) <= count(divided) <= most
        assert filled(divided) > 0.45


@pytest.mark.parametrize(
    ("fewest", "islands", "before", "after", "is_worth"),
    [
        (1, 2, 0.40, 0.47, False),
        (1, 2, 0.40, 0.49, True),
        (1, 3, 0.30, 0.42, False),  # a fifth more, twice
        (1, 3, 0.30, 0.44, True),
        (1, 2, 0.45, 0.90, False),  # what fills that much stays whole
        (4, 5, 0.40, 0.47, False),
        (30, 33, 0.40, 0.47, False),  # of many islands, a tenth counts as one
        (30, 33, 0.40, 0.49, True),
        (30, 32, 0.40, 0.46, True),
    ],
)
def test_what_an_island_is_worth(fewest: int, islands: int, before: float, after: float, is_worth: bool) -> None:
    gains = worth_of_filling(after, islands, fewest) > worth_of_filling(before, fewest, fewest)
    assert gains == is_worth


def test_the_most_worthwhile_of_several_divisions_is_chosen(monkeypatch: pytest.MonkeyPatch) -> None:
    """A whole map, and others of which the shares of the square say the islands; what cannot gain is not made."""
    cube = surface(meshes.cube(2))
    plain = lsgp.auto_unwrap(cube, pack="shelves")

    def with_islands(number: int) -> lsgp.Result:
        return replace(plain, island=(np.arange(len(plain.island)) % number).astype("int32"))

    of_share = {0.25: 2, 0.5: 3, 1.0: 6, 2.0: 9}
    for fills, expected, made in (
        ({1: 0.5}, 1, {"off"}),
        ({1: 0.3, 2: 0.5, 3: 0.52, 6: 0.6, 9: 0.7}, 2, {"off", 0.25}),
        ({1: 0.1, 2: 0.15, 3: 0.5, 6: 0.54, 9: 0.7}, 3, {"off", 0.25, 0.5}),
        ({1: 0.05, 2: 0.06, 3: 0.07, 6: 0.14, 9: 0.3}, 9, {"off", 0.25, 0.5, 2.0}),
    ):
        asked = set()

        def divide(options: lsgp.Options, asked: set[object] = asked) -> lsgp.Result:
            asked.add("off" if options.compact == "off" else options.square_share)
            return with_islands(1 if options.compact == "off" else of_share[options.square_share])

        monkeypatch.setattr(
            few_islands, "measure_of_filling", lambda *_, fills=fills: lambda result: fills[count(result)]
        )
        best = best_of_few(with_islands(of_share[1.0]), PAINT, cube, divide)
        assert count(best) == expected and asked == made


def test_a_share_of_the_square_leaves_the_estimate(monkeypatch: pytest.MonkeyPatch) -> None:
    """What islands fill is then not known."""
    gear, options = surface(MODELS["gear"]), replace(PAINT, square_share=0.999)
    estimated = lsgp.auto_unwrap(gear, options=options, pack="shelves")
    monkeypatch.setattr(cone_choices, "best_of_few", lambda usual, *_: usual)
    unpacked = lsgp.auto_unwrap(gear, pack="shelves")
    assert count(estimated) == count(unpacked) > 1
