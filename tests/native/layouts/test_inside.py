# SPDX-License-Identifier: GPL-3.0-or-later
"""Islands that nothing outside can see get fewer texels."""

from __future__ import annotations

import ast
from pathlib import Path

import lsgp
import meshes
import numpy as np
import pytest
from layout_check import coverage, overlapping_islands
from lsgp.layouts.inside import LEAST_SHARE, find_hidden

BALL = meshes.bumpy_sphere(2)


def together(*parts: meshes.Mesh) -> tuple[lsgp.Surface, np.ndarray]:
    """One surface, in place, and the part of each triangle."""
    begin = np.cumsum([0, *(len(part.positions) for part in parts)])
    triangles = [part.triangles + first for part, first in zip(parts, begin, strict=False)]
    surface = lsgp.Surface(np.concatenate([part.positions for part in parts]), np.concatenate(triangles))
    return surface, np.repeat(np.arange(len(parts), dtype=np.int32), [len(part.triangles) for part in parts])


def scaled(mesh: meshes.Mesh, factor: float, shift: tuple[float, float, float] = (0, 0, 0)) -> meshes.Mesh:
    return mesh._replace(positions=factor * mesh.positions + np.array(shift))


def hidden_parts(*parts: meshes.Mesh) -> list[int]:
    surface, part = together(*parts)
    is_hidden = find_hidden(surface, part)
    of_part = [set(is_hidden[part == i].tolist()) for i in range(len(parts))]
    assert all(len(found) == 1 for found in of_part)
    return [i for i, found in enumerate(of_part) if found == {True}]


def test_what_is_enclosed_is_hidden_and_nothing_else():
    inner, beside = scaled(BALL, 0.5), scaled(BALL, 0.5, (3, 0, 0))
    assert hidden_parts(BALL) == []
    assert hidden_parts(BALL, inner, beside) == [1]
    assert hidden_parts(inner, beside, BALL, scaled(BALL, 0.1)) == [0, 3]
    assert hidden_parts(scaled(BALL, 1e-50), scaled(inner, 1e-50)) == [1]
    assert hidden_parts(scaled(BALL, 1, (1e5, 0, 0)), scaled(inner, 1, (1e5, 0, 0))) == [1]


def test_surfaces_hide_from_both_sides():
    inward = BALL._replace(triangles=np.ascontiguousarray(BALL.triangles[:, ::-1]))
    assert hidden_parts(inward, scaled(BALL, 0.5)) == [1]
    assert hidden_parts(inward, scaled(inward, 0.5)) == [1]


def test_what_is_there_twice_is_seen():
    assert hidden_parts(BALL, BALL) == []


def test_a_hole_shows_what_is_inside():
    """A cube without a side, and a small ball in it: some rays leave."""
    box = meshes.cube(4)
    side = box.positions[box.triangles].mean(axis=1)[:, 2]
    opened = box._replace(triangles=box.triangles[side < side.max() - 1e-9])
    middle = tuple(box.positions.mean(axis=0))
    inside = scaled(BALL, 0.2 * np.ptp(box.positions) / np.ptp(BALL.positions), middle)
    assert hidden_parts(box, inside) == [1]
    assert hidden_parts(opened, inside) == []


def test_faces_of_a_large_island_that_is_covered_in_part_are_seen():
    """Two triangles under a roof that leaves a strip of a twentieth of them."""
    floor = meshes.make([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 3]])
    box = meshes.cube(1)
    low, size = box.positions.min(axis=0), np.ptp(box.positions, axis=0)
    lid = box._replace(positions=(box.positions - low) / size * [2, 1.45, 1] - [0.5, 0.5, 0.5])
    assert hidden_parts(lid, floor) == []
    whole = box._replace(positions=(box.positions - low) / size * [2, 2, 1] - [0.5, 0.5, 0.5])
    assert hidden_parts(whole, floor) == [1]


def density(surface: lsgp.Surface, uv: np.ndarray, chosen: np.ndarray) -> float:
    chosen_surface = lsgp.Surface(surface.positions, surface.triangles[chosen])
    return lsgp.texel_density(chosen_surface, uv[chosen], 1024).mean


@pytest.mark.parametrize("share", [0.25, 0.7])
def test_hidden_islands_have_their_share_of_the_texels(share):
    surface, part = together(BALL, scaled(BALL, 0.6))
    usual = lsgp.auto_unwrap(surface)
    less = lsgp.auto_unwrap(surface, inside=share)

    def ratio(result: lsgp.Result) -> float:
        return density(surface, result.corner_uv, part == 1) / density(surface, result.corner_uv, part == 0)

    assert ratio(less) == pytest.approx(share * ratio(usual))
    assert overlapping_islands(less.corner_uv, less.island) == 0
    assert coverage(less.corner_uv[part == 0], less.island[part == 0]) >= coverage(
        usual.corner_uv[part == 0], usual.island[part == 0]
    )
    (finding,) = [one for one in less.warnings if one.code == "ISLANDS_HIDDEN"]
    np.testing.assert_array_equal(finding.elements.indices, np.flatnonzero(part == 1))
    assert not any(one.code == "ISLANDS_HIDDEN" for one in usual.warnings)


def test_without_hidden_islands_nothing_changes():
    surface, _ = together(BALL)
    assert lsgp.auto_unwrap(surface, inside=0.25) == lsgp.auto_unwrap(surface)


@pytest.mark.parametrize(
    "others",
    [
        {"inside": 0},
        {"inside": 1e-300},
        {"inside": 1.5},
        {"inside": float("nan")},
        {"inside": 0.5, "preset": "tile"},
        {"inside": 0.5, "pack": "shelves"},
    ],
)
def test_shares_that_are_none_are_refused(others):
    with pytest.raises(lsgp.InputError, match="inside"):
        lsgp.auto_unwrap(together(BALL)[0], **others)


def test_two_sizes_are_refused():
    with pytest.raises(lsgp.InputError, match="inside and texels"):
        lsgp.auto_unwrap(together(BALL)[0], inside=0.5, texels=lsgp.TexelLayout(10.0, 1024))


def test_vertices_without_triangles_are_not_part_of_the_surface():
    surface, part = together(BALL, scaled(BALL, 1 - 1e-4))
    apart = np.concatenate([surface.positions, [[1e6, 0, 0]]])
    assert set(part[find_hidden(lsgp.Surface(apart, surface.triangles), part)]) == {1}


@pytest.mark.parametrize("wrong", [-2, 10**6])
def test_numbers_of_islands_are_those_of_triangles(wrong: int):
    surface, part = together(BALL)
    with pytest.raises(lsgp.InputError, match=f"There is an island {wrong}"):
        find_hidden(surface, np.where(part == 0, wrong, 0).astype(np.int32))
    with pytest.raises(lsgp.InputError, match="pass one for each"):
        find_hidden(surface, part[1:])


def test_the_add_on_offers_what_the_library_takes() -> None:
    """It has to register without the library, and so states the least share itself."""
    source = (Path(__file__).parents[3] / "addon/operators/unwrapping/auto.py").read_text()
    (offered,) = (
        node.annotation.keywords
        for node in ast.walk(ast.parse(source))
        if isinstance(node, ast.AnnAssign) and ast.unparse(node.target) == "inside"
    )
    bounds = {keyword.arg: ast.literal_eval(keyword.value) for keyword in offered}
    assert (bounds["min"], bounds["max"]) == (LEAST_SHARE, 1)
