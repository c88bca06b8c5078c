# SPDX-License-Identifier: GPL-3.0-or-later
"""By what presets choose, and how."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import lsgp
import meshes
import pytest
from lsgp.presets.objective import ERROR_OF_ESTIMATES, Candidate, Objective, Quality
from map_checks import surface

QUALITY = Quality(
    left_out=0, defects=0, stretch=1.5, islands=3, cuts=4.0, borders=2.0, cones=9, empty=0.8, asymmetry=0.5
)
WORSE = {"stretch": 2.0, "islands": 4, "cuts": 5.0, "borders": 2.5, "cones": 11, "empty": 1.0, "asymmetry": 1.0}
WEIGHT = {name: name for name in WORSE} | {"empty": "square", "asymmetry": "symmetry"}
del WEIGHT["stretch"]


@pytest.mark.parametrize("part", WORSE)
def test_each_part_costs_what_its_weight_says(part: str) -> None:
    weights = lsgp.Weights()
    worse = replace(QUALITY, **{part: WORSE[part]})
    price = getattr(weights, WEIGHT[part]) if part in WEIGHT else 1.0
    more = price * (WORSE[part] - getattr(QUALITY, part))
    assert worse.cost(weights) - QUALITY.cost(weights) == pytest.approx(more)
    if part in WEIGHT:
        without = replace(weights, **{WEIGHT[part]: 0.0})
        assert worse.cost(without) == QUALITY.cost(without)


def test_of_many_islands_a_tenth_counts_as_one() -> None:
    weights = lsgp.Weights()
    costs = {islands: replace(QUALITY, islands=islands).cost(weights) for islands in (1, 2, 9, 10, 200, 220)}
    assert costs[2] - costs[1] == pytest.approx(costs[10] - costs[9]) == pytest.approx(weights.islands)
    assert costs[220] - costs[200] == pytest.approx(weights.islands, rel=0.05)


@pytest.mark.parametrize("value", [-1.0, math.nan, math.inf, "much", 10**400])
@pytest.mark.parametrize("name", ["islands", "cuts", "borders", "cones", "square", "symmetry"])
def test_weights_are_refused_by_name(name: str, value: object) -> None:
    with pytest.raises(lsgp.InputError, match=rf"weights\.{name} "):
        lsgp.Weights(**{name: value})


def candidates(
    costs: dict[str, tuple[float | None, float | None]], made: list[str], defects: dict[str, int] | None = None
) -> list[Candidate[str]]:
    """Of each what is expected and what it costs; None where it cannot be made, or is refused."""

    def make(name: str) -> Callable[[object], str]:
        def of(_: object) -> str:
            made.append(name)
            if costs[name][1] is None:
                raise lsgp.SolverError("SOLVER_FAILED", name)
            return name

        return of

    def quality(name: str, _: object) -> Quality:
        return Quality(0, (defects or {}).get(name, 0), costs[name][1] or 0.0, 0, 0, 0, 0, 0)

    return [
        Candidate(name, lambda estimate=estimate: estimate, make(name), quality)
        for name, (estimate, _) in costs.items()
    ]


@pytest.mark.parametrize(
    ("costs", "made", "best"),
    [
        ({"a": (1.0, 2.0), "b": (0.5, 3.0)}, ["b", "a"], "a"),  # the most promising first
        ({"a": (0.0, 2.0), "b": (2.0 + 2 * ERROR_OF_ESTIMATES, 0.0)}, ["a"], "a"),  # not worth a try
        ({"a": (0.0, 2.0), "b": (2.0 + ERROR_OF_ESTIMATES / 2, 1.0)}, ["a", "b"], "b"),  # estimates may be off
        ({"a": (0.0, 2.0), "b": (None, 1.0)}, ["a"], "a"),  # cannot be made
        ({"a": (0.0, None), "b": (math.inf, 9.0)}, ["a", "b"], "b"),  # the last resort
    ],
)
def test_others_are_made_as_long_as_they_may_cost_less(
    costs: dict[str, tuple[float | None, float | None]], made: list[str], best: str
) -> None:
    tried: list[str] = []
    told: list[float] = []
    objective = Objective(lsgp.Weights())
    assert objective.choose(candidates(costs, tried), told.append) == best
    assert tried == made
    assert told[-1] == 1.0 and told == sorted(told)
    said = {choice.name: choice for choice in objective.choices}
    assert said.keys() == {name for name, (estimate, _) in costs.items() if estimate is not None}
    assert all(said[name].cost == costs[name][1] for name in made) and said[best].is_best


def test_nothing_is_made_that_another_map_outdoes() -> None:
    tried: list[str] = []
    objective = Objective(lsgp.Weights())
    costs = {"a": (0.0, 3.0), "b": (2.5, 1.0)}
    with objective.bounded(2.0):
        assert objective.choose(candidates(costs, tried)) == "a"
    assert tried == ["a"]
    assert objective.choose(candidates(costs, tried)) == "b"


def test_no_defect_is_worth_anything() -> None:
    """A map with defects is never the better one, and others are made whatever is expected of them."""
    tried: list[str] = []
    costs = {"a": (0.0, 1.0), "b": (50.0, 60.0)}
    assert Objective(lsgp.Weights()).choose(candidates(costs, tried, {"a": 1})) == "b"
    assert tried == ["a", "b"]


def test_where_none_can_be_made_the_last_one_says_why() -> None:
    with pytest.raises(lsgp.SolverError, match="b"):
        Objective(lsgp.Weights()).choose(candidates({"a": (0.0, None), "b": (1.0, None)}, []))


def test_cancelling_ends_the_choice() -> None:
    tried: list[str] = []
    with pytest.raises(lsgp.Cancelled):
        Objective(lsgp.Weights()).choose(candidates({"a": (0.0, 1.0)}, tried), lambda _: False)


def test_a_press_says_what_it_chose_from() -> None:
    result = lsgp.auto_unwrap(surface(meshes.two_horned()))
    assert result.choices[0].cost is not None
    assert sum(choice.is_best for choice in result.choices) >= 1
    assert not lsgp.parameterize(surface(meshes.two_horned()), [0, 5, 9]).choices
