# SPDX-License-Identifier: GPL-3.0-or-later
"""Stacks: islands of one shape lie exactly on each other, whatever the order of their triangles, and no others do."""

from __future__ import annotations

import lsgp
import meshes
import numpy as np
import pytest
from layout_check import overlapping_islands
from map_checks import codes, only, surface

HILL = meshes.hill(5)
# No symmetry.
SHAPE = HILL.positions[:, :2] + 0.1 * np.sin(3 * HILL.positions[:, :1] + HILL.positions[:, 1:2] ** 2)
TRIANGLES = HILL.triangles.astype(int)
PARTS = surface(meshes.merge([meshes.bumpy_sphere(1)] * 3 + [meshes.cube(2)] * 2))


def copy(turn: complex, shift: complex, *, mirrored: bool = False, shuffled: int | None = None) -> np.ndarray:
    """(m, 3, 2), the shape moved, its triangles and their corners in another order."""
    z = SHAPE @ [1, 1j]
    z = turn * (z.conj() if mirrored else z) + shift
    triangles = TRIANGLES[:, [0, 2, 1]] if mirrored else TRIANGLES
    if shuffled is not None:
        random = np.random.default_rng(shuffled)
        triangles = np.array([np.roll(t, random.integers(3)) for t in triangles[random.permutation(len(triangles))]])
    return np.stack([z.real, z.imag], axis=-1)[triangles]


def corner_set(uv: np.ndarray) -> set[tuple[tuple[float, ...], ...]]:
    """Triangles as sets of corners."""
    return {tuple(sorted(map(tuple, triangle))) for triangle in uv.tolist()}


def stacks_of(parts: list[np.ndarray], *, mirrored: bool = False) -> tuple[lsgp.Stacks, list[np.ndarray]]:
    uv, island = np.concatenate(parts), np.repeat(np.arange(len(parts)), [len(part) for part in parts])
    stacks = lsgp.find_stacks(uv, island, mirrored=mirrored)
    return stacks, np.split(stacks.stacked(uv), np.cumsum([len(part) for part in parts])[:-1])


@pytest.mark.parametrize("shuffled", [None, 1])
@pytest.mark.parametrize("mirrored", [False, True])
def test_copies_lie_exactly_on_the_first(mirrored: bool, shuffled: int | None) -> None:
    parts = [copy(1, 0), copy(np.exp(2j), 9 - 4j, mirrored=mirrored, shuffled=shuffled)]
    stacks, moved = stacks_of(parts, mirrored=mirrored)
    assert stacks.count == 1 and stacks.kept.tolist() == [True] * len(TRIANGLES) + [False] * len(TRIANGLES)
    assert (moved[0] == parts[0]).all() and corner_set(moved[1]) == corner_set(parts[0])


def test_mirrored_islands_are_another_shape_unless_asked_for() -> None:
    assert stacks_of([copy(1, 0), copy(1, 9, mirrored=True)])[0].count == 0
    # But two that are mirrored alike are one.
    assert stacks_of([copy(1, 0), copy(1, 9, mirrored=True), copy(1j, 20, mirrored=True)])[0].count == 1


def test_islands_that_differ_stay() -> None:
    bent = copy(1, 9)
    bent[bent == bent[0, 0]] += 1e-2
    reordered = copy(1, 40)
    parts = [copy(1, 0), bent, copy(1.01, 20), reordered[:-1]]
    stacks, moved = stacks_of(parts, mirrored=True)
    assert stacks.count == 0 and all((one == other).all() for one, other in zip(moved, parts, strict=True))


def test_the_order_of_triangles_decides_between_ways_that_fit() -> None:
    square = np.array([[[0, 0], [1, 0], [1, 1]], [[0, 0], [1, 1], [0, 1]]], float)
    stacks, moved = stacks_of([square, square @ np.array([[0, 1], [-1, 0]]) + 5])
    assert stacks.count == 1 and (moved[1] == square).all()


def test_rounding_is_of_no_account_and_triangles_without_an_island_stay() -> None:
    noise = np.random.default_rng(3).normal(size=SHAPE.shape)[TRIANGLES] * 1e-7
    uv = np.concatenate([copy(1, 0), copy(1j, 9) + noise, np.full((1, 3, 2), np.nan)])
    stacks = lsgp.find_stacks(uv, [0] * len(TRIANGLES) + [1] * len(TRIANGLES) + [-1])
    assert stacks.count == 1 and stacks.kept[-1] and np.isnan(stacks.stacked(uv)[-1]).all()


@pytest.mark.parametrize("stack", ["same", "mirrored"])
def test_packed_stacks_share_texels_and_count_as_no_overlaps(stack: str) -> None:
    plain = lsgp.auto_unwrap(PARTS, preset="bake", pack="tight")
    result = lsgp.auto_unwrap(PARTS, preset="bake", pack="tight", stack=stack)
    count = lsgp.find_stacks(plain.corner_uv, plain.island, mirrored=stack == "mirrored").count
    assert count >= 3 and codes(result.warnings) == [*codes(plain.warnings), "ISLANDS_STACKED"]
    told = only(result.warnings, "ISLANDS_STACKED")
    assert told.message.startswith(f"{count} of {plain.island.max() + 1} islands are stacked on others")
    seen = ~np.isin(np.arange(len(result.island)), told.elements.indices)
    assert overlapping_islands(result.corner_uv[seen], result.island[seen]) == 0
    assert corner_set(result.corner_uv) == corner_set(result.corner_uv[seen])
    assert result.overlap_area == 0 and len(result.overlapping) == 0
    # What stacks leave free makes all islands larger.
    assert np.ptp(result.corner_uv[0], axis=0).max() > 1.2 * np.ptp(plain.corner_uv[0], axis=0).max()


@pytest.mark.parametrize(
    "how",
    [{"stack": "all"}, {"stack": "same", "pack": "shelves"}, {"stack": "same", "preset": "tile"}],
)
def test_what_cannot_be_stacked_is_refused(how: dict) -> None:
    with pytest.raises(lsgp.InputError) as refusal:
        lsgp.auto_unwrap(PARTS, **how)
    assert refusal.value.code == "WRONG_PARAMETER"
    assert refusal.value.message.startswith("stack ")
