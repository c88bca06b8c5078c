# SPDX-License-Identifier: GPL-3.0-or-later
"""Large surfaces, whose maps are chosen on few of their triangles."""

from __future__ import annotations

import time
from dataclasses import replace

import large_meshes
import lsgp
import numpy as np
import pytest
from lsgp.presets.auto_unwrap import TARGET
from map_checks import codes, digest, surface
from numpy.typing import NDArray
from result_check import undeclared_faults


def chosen_on_few(result: lsgp.Result) -> bool:
    return any(choice.name.startswith("on ") for choice in result.choices)


@pytest.fixture(scope="module")
def large() -> lsgp.Surface:
    return surface(large_meshes.bumpy(34000))


@pytest.mark.slow
@pytest.mark.parametrize("preset", ["paint", "bake"])
def test_maps_chosen_on_few_triangles_keep_what_presets_promise(large: lsgp.Surface, preset: str) -> None:
    result = lsgp.auto_unwrap(large, preset=preset)
    assert chosen_on_few(result)
    assert result.solved.all() and not len(result.overlapping) and not len(result.flipped)
    assert undeclared_faults(replace(large, borders=result.borders), result, lsgp.preset_options(preset)) == []
    assert result.distortion.l2_stretch <= TARGET


@pytest.mark.slow
def test_noise_of_the_size_of_triangles_is_no_reason_for_cones(large: lsgp.Surface) -> None:
    first, second = large.positions[large.triangles[:, 0]], large.positions[large.triangles[:, 1]]
    edge = float(np.linalg.norm(first - second, axis=1).mean())
    noise = 0.1 * edge * np.random.RandomState(0).normal(size=large.positions.shape)
    noisy = lsgp.auto_unwrap(replace(large, positions=large.positions + noise))
    assert chosen_on_few(noisy)
    assert len(noisy.cones) <= len(lsgp.auto_unwrap(large).cones) + 2


@pytest.mark.slow
def test_they_are_the_same_for_any_number_of_threads(large: lsgp.Surface) -> None:
    one, two = (
        lsgp.auto_unwrap(large, options=replace(lsgp.preset_options("paint"), threads=threads)) for threads in (1, 2)
    )
    assert digest(one) == digest(two)


@pytest.mark.slow
def test_what_cuts_cost_counts_there_as_well(large: lsgp.Surface) -> None:
    ends = np.concatenate([large.triangles[:, [0, 1]], large.triangles[:, [1, 2]], large.triangles[:, [2, 0]]])
    edges = np.unique(np.sort(ends, axis=1), axis=0)
    is_in_front = large.positions[edges].mean(axis=1)[:, 1] < 0

    def lengths(is_priced: NDArray[np.bool_]) -> NDArray[np.float64]:
        """Of the cuts in front and behind, where those on one of these sides cost much."""
        result = lsgp.auto_unwrap(replace(large, edges=edges, cut_costs=np.where(is_priced, 30.0, 0.1)))
        assert chosen_on_few(result)
        ends = large.positions[result.cut_edges]
        length = np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1)
        is_front = ends.mean(axis=1)[:, 1] < 0
        return np.array([length[is_front].sum(), length[~is_front].sum()])

    front_priced, back_priced = lengths(is_in_front), lengths(~is_in_front)
    assert front_priced[0] < back_priced[0] / 2
    assert back_priced[1] < front_priced[1] / 2


def test_surfaces_that_cannot_be_simplified_are_chosen_for_as_they_are() -> None:
    assert not chosen_on_few(lsgp.auto_unwrap(surface(large_meshes.strip(40000))))


def test_small_surfaces_are_chosen_for_as_they_are() -> None:
    assert not chosen_on_few(lsgp.auto_unwrap(surface(large_meshes.bumpy(3000))))


@pytest.mark.slow
def test_what_was_chosen_on_few_triangles_is_there_when_the_time_is_over(large: lsgp.Surface) -> None:
    """The time is spent where that part of the work is done. Once there is a map, there is one at all later moments,
    also where a slow machine takes longer than that; which choice there is when is tested in C++, without a clock."""
    ended: list[tuple[float, bool]] = []
    for until in (0.05, 0.14, 0.2):
        reached, result = unwrapped_until(large, until)
        ended.append((reached, result is not None))
        if result is None:
            continue
        assert "TIME_LIMIT" in codes(result.warnings)
        assert len({str(choice) for choice in result.choices}) == len(result.choices)
        assert result.solved.all() and not len(result.flipped) and not len(result.overlapping)
        bordered = replace(large, borders=result.borders)
        assert undeclared_faults(bordered, result, lsgp.preset_options("paint")) == []
    has_map = [is_made for _, is_made in sorted(ended)]
    assert has_map == sorted(has_map)


def unwrapped_until(large: lsgp.Surface, until: float) -> tuple[float, lsgp.Result | None]:
    """What was told of the work when the time was over, and the map that there was."""
    seconds, reached, begin, is_over = 8.0, 0.0, 0.0, False

    def wait_at_the_end(done: float) -> bool:
        nonlocal reached, begin, is_over
        begin = begin or time.monotonic()  # the library has begun before
        if not is_over:
            reached = done
            if done > until:
                time.sleep(max(begin + seconds + 0.01 - time.monotonic(), 0))
            is_over = time.monotonic() > begin + seconds
        return True

    try:
        result = lsgp.auto_unwrap(large, seconds=seconds, progress=wait_at_the_end)
    except lsgp.SolverError as error:
        assert error.code == "TIME_LIMIT"
        return reached, None
    return reached, result
