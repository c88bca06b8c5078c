# SPDX-License-Identifier: GPL-3.0-or-later
"""By what presets choose; how they do is tested in C++."""

from __future__ import annotations

import math

import lsgp
import meshes
import numpy as np
import pytest
from map_checks import surface


@pytest.mark.parametrize("value", [-1.0, math.nan, math.inf, "much", 10**400])
@pytest.mark.parametrize("name", ["islands", "cuts", "borders", "cones", "square", "symmetry"])
def test_weights_are_refused_by_name(name: str, value: object) -> None:
    with pytest.raises(lsgp.InputError, match=rf"weights\.{name} "):
        lsgp.Weights(**{name: value})


def test_weights_are_those_of_paint_where_none_is_given() -> None:
    assert lsgp.Weights() == lsgp.preset_weights("paint")


def test_a_press_says_what_it_chose_from() -> None:
    result = lsgp.auto_unwrap(surface(meshes.two_horned()))
    assert result.choices[0].cost is not None
    assert sum(choice.is_best for choice in result.choices) >= 1
    assert not lsgp.parameterize(surface(meshes.two_horned()), [0, 5, 9]).choices


def test_the_trace_says_of_each_map_what_it_was_expected_to_cost_and_did() -> None:
    choices = lsgp.auto_unwrap(surface(meshes.two_horned())).choices
    for choice in choices:
        assert (choice.cost is None) == (choice.reason == "is expected to cost more")
        assert choice.cost is None or choice.reason.startswith("stretch ")
        assert not choice.is_best or choice.cost is not None
    # What was the best so far never costs more than what was best of its kind before.
    assert min(choice.cost for choice in choices if choice.cost is not None) == pytest.approx(
        [choice.cost for choice in choices if choice.is_best][-1], abs=0.01
    )


def test_no_map_is_made_that_could_not_cost_less_if_all_went_well() -> None:
    ring = meshes.cylinder()
    small = ring._replace(positions=0.02 * ring.positions)
    patches = surface(meshes.merge([meshes.grid()] * 40 + [small]))
    result = lsgp.auto_unwrap(patches)
    assert len(result.cones) == 0 < len(result.cut_edges)
    made = {choice.name for choice in result.choices if choice.cost is not None}
    assert "symmetric cones and cuts" in made
    assert not made & {"symmetric cones, other cuts", "usual cones", "further islands"}


def test_other_cuts_are_not_expected_to_stretch_less() -> None:
    stretch_and_cones = lsgp.Weights(islands=0, cuts=0, borders=0, square=0)
    found = 0
    for seed in range(4):
        body = meshes.voxels(np.random.default_rng(seed).uniform(size=(4, 4, 4)) > 0.35)
        result = lsgp.auto_unwrap(surface(body), creases=False, weights=stretch_and_cones)
        choices = {choice.name: choice for choice in result.choices}
        # The cones of a body without a plane of symmetry are the usual ones.
        if "symmetric cones, other cuts" not in choices:
            continue
        found += 1
        assert choices["symmetric cones, other cuts"].estimate >= choices["symmetric cones and cuts"].cost
    assert found
