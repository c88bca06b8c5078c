# SPDX-License-Identifier: GPL-3.0-or-later
"""Texel density against areas from the lengths of sides, and layouts at a density, in one square and in UDIM tiles."""

from __future__ import annotations

import math
import re
from dataclasses import replace

import lsgp
import meshes
import numpy as np
import pytest
from lsgp import TexelLayout, at_texel_density, texel_density
from map_checks import codes, surface

SIZE = 1024
PARTS = surface(meshes.merge([*(meshes.bumpy_sphere(1) for _ in range(6)), *(meshes.cube(n) for n in range(1, 7))]))


@pytest.fixture(scope="module")
def split() -> lsgp.Result:
    return lsgp.auto_unwrap(PARTS, preset="bake", pack="shelves")


def heron(corners: np.ndarray) -> np.ndarray:
    """(m,) areas of (m, 3, d) triangles by the lengths of their sides (Kahan's form)."""
    lengths = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2)
    c, b, a = np.sort(lengths, axis=1).T
    return np.sqrt(np.maximum((a + (b + c)) * (c - (a - b)) * (c + (a - b)) * (a + (b - c)), 0)) / 4


def by_areas(of: lsgp.Surface, uv: np.ndarray, texels: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Density of each triangle, and its area on the surface and in texels."""
    area, covered = heron(of.positions[of.triangles]), heron(uv) * texels
    return np.sqrt(covered / area), area, covered


def distances(boxes: np.ndarray) -> np.ndarray:
    """Of every two boxes the larger of the gaps in both directions, below 0 where they overlap."""
    low, high = boxes[:, None, :2], boxes[:, None, 2:]
    gaps = np.maximum(low - high.transpose(1, 0, 2), low.transpose(1, 0, 2) - high).max(axis=2)
    return gaps[np.triu_indices(len(boxes), 1)]


def boxes_of(result: lsgp.Result) -> np.ndarray:
    count = int(result.island.max()) + 1
    corners = [result.corner_uv[result.island == i].reshape(-1, 2) for i in range(count)]
    return np.array([[*uv.min(axis=0), *uv.max(axis=0)] for uv in corners])


@pytest.mark.parametrize(("size", "texels"), [(1024, 1024**2), ((2048, 512), 2048 * 512), (1.5, 2.25)])
def test_density_is_that_of_the_areas(split: lsgp.Result, size: object, texels: float) -> None:
    uv = split.corner_uv
    density, area, covered = by_areas(PARTS, uv, texels)
    assert lsgp.triangle_texel_density(PARTS, uv, size) == pytest.approx(density, rel=1e-6)
    found = texel_density(PARTS, uv, size)
    assert (found.minimum, found.maximum) == pytest.approx((density.min(), density.max()), rel=1e-6)
    assert found.mean == pytest.approx(math.sqrt(covered.sum() / area.sum()), rel=1e-9)
    below = area[density < found.median * (1 - 1e-6)].sum(), area[density <= found.median * (1 + 1e-6)].sum()
    assert below[0] <= area.sum() / 2 <= below[1]


@pytest.mark.parametrize("scale", [1e-100, 1e-3, 1e5, 1e100])
def test_a_larger_surface_has_fewer_texels_per_unit(split: lsgp.Result, scale: float) -> None:
    larger = replace(PARTS, positions=scale * PARTS.positions)
    one, other = (texel_density(of, split.corner_uv, SIZE) for of in (PARTS, larger))
    for name in ("minimum", "median", "maximum", "mean"):
        assert getattr(other, name) == pytest.approx(getattr(one, name) / scale, rel=1e-9)


@pytest.mark.parametrize("scale", [1e-290, 1e-200, 1e200, 1e290])
def test_density_grows_with_the_layout_at_any_size(split: lsgp.Result, scale: float) -> None:
    one, other = (texel_density(PARTS, factor * split.corner_uv, SIZE) for factor in (1.0, scale))
    for name in ("minimum", "median", "maximum", "mean"):
        assert getattr(other, name) == pytest.approx(getattr(one, name) * scale, rel=1e-9)


def test_what_has_no_area_in_a_huge_layout_has_no_texels() -> None:
    grid = surface(meshes.grid(5, 4))
    uv = np.full((len(grid.triangles), 3, 2), np.finfo(float).max)
    assert (lsgp.triangle_texel_density(grid, uv, SIZE) == 0).all()


def test_a_flat_map_of_one_scale_has_one_density() -> None:
    grid = surface(meshes.grid(5, 4))
    uv = 0.25 * grid.positions[grid.triangles][..., :2]
    found = texel_density(grid, uv, 400)
    assert (found.minimum, found.median, found.maximum, found.mean) == pytest.approx((100,) * 4, rel=1e-12)


def test_what_is_not_mapped_does_not_count() -> None:
    grid = surface(meshes.grid(5, 4))
    uv = 0.25 * grid.positions[grid.triangles][..., :2]
    uv[3] = np.nan
    assert np.flatnonzero(np.isnan(lsgp.triangle_texel_density(grid, uv, 400))).tolist() == [3]
    assert texel_density(grid, uv, 400).mean == pytest.approx(100)
    with pytest.raises(lsgp.InputError) as error:
        texel_density(grid, np.full_like(uv, np.nan), 400)
    assert error.value.code == "NO_UV"


@pytest.mark.parametrize("density", [3.0, 40.0, 700.0])
def test_a_layout_gets_the_density_by_one_scale(split: lsgp.Result, density: float) -> None:
    found = at_texel_density(PARTS, split, TexelLayout(density, SIZE))
    assert texel_density(PARTS, found.corner_uv, SIZE).mean == pytest.approx(density, rel=1e-12)
    factors = found.corner_uv / np.where(split.corner_uv == 0, np.nan, split.corner_uv)
    assert np.nanmax(factors) == pytest.approx(np.nanmin(factors), rel=1e-12)
    assert replace(found, corner_uv=split.corner_uv, warnings=split.warnings) == split


def test_islands_outside_the_square_are_named(split: lsgp.Result) -> None:
    plain = texel_density(PARTS, split.corner_uv, SIZE).mean
    assert "ISLANDS_OUTSIDE" not in codes(at_texel_density(PARTS, split, TexelLayout(plain, SIZE)).warnings)
    found = at_texel_density(PARTS, split, TexelLayout(1.5 * plain, SIZE))
    (finding,) = [finding for finding in found.warnings if finding.code == "ISLANDS_OUTSIDE"]
    reaches = boxes_of(found)[:, 2:].max(axis=1) > 1
    assert 0 < reaches.sum() < len(reaches)
    assert finding.message.startswith(f"{reaches.sum()} of {len(reaches)} islands")
    assert set(finding.elements.indices) == set(np.flatnonzero(reaches[found.island]))


@pytest.mark.parametrize("margin", [0.0, 4.0, 30.0])
@pytest.mark.parametrize("times", [1.2, 2.5])
def test_islands_lie_in_tiles_with_their_margin(split: lsgp.Result, times: float, margin: float) -> None:
    plain = texel_density(PARTS, split.corner_uv, SIZE).mean
    layout = TexelLayout(times * plain, SIZE, udim=20, margin=margin)
    found = at_texel_density(PARTS, split, layout)
    assert texel_density(PARTS, found.corner_uv, SIZE).mean == pytest.approx(times * plain, rel=1e-12)
    boxes, free, slack = boxes_of(found), margin / SIZE, 1e-9
    tiles = np.floor((boxes[:, :2] + boxes[:, 2:]) / 2)
    assert (boxes[:, :2] - tiles >= free - slack).all() and (boxes[:, 2:] - tiles <= 1 - free + slack).all()
    assert distances(boxes).min() >= 2 * free - slack
    numbers = 1001 + tiles[:, 0] + 10 * tiles[:, 1]
    assert tiles[:, 0].max() < 10 and numbers.min() == 1001
    # No tile is left out, and no fewer would do by this way of packing.
    taken = len(set(numbers))
    assert numbers.max() == 1000 + taken and taken >= (heron(found.corner_uv).sum())
    assert at_texel_density(PARTS, split, replace(layout, udim=taken)) == found
    with pytest.raises(lsgp.InputError, match=f"the islands take {taken} tiles .* Take {taken} tiles") as error:
        at_texel_density(PARTS, split, replace(layout, udim=taken - 1))
    assert error.value.code == "TOO_FEW_TILES"
    assert set(error.value.elements.indices) == set(np.flatnonzero((numbers == numbers.max())[found.island]))


def test_an_island_larger_than_a_tile_is_refused_with_the_density_that_fits() -> None:
    grid = surface(meshes.grid(4, 4))
    result = lsgp.parameterize(grid, [])
    side = np.ptp(grid.positions[:, 0])
    with pytest.raises(lsgp.InputError, match="1 of 1 islands is larger than a tile") as error:
        at_texel_density(grid, result, TexelLayout(500 / side, 256, udim=9, margin=3))
    assert error.value.code == "ISLAND_TOO_LARGE"
    assert error.value.elements.indices.tolist() == list(range(len(grid.triangles)))
    most = 250 / side
    told = float(re.search(r"density to ([0-9.]+),", error.value.message)[1])
    assert 0.999 * most <= told <= most
    at_texel_density(grid, result, TexelLayout(told, 256, udim=1, margin=3))


def test_more_than_a_row_of_tiles_goes_on_in_the_next_row() -> None:
    squares = surface(meshes.merge([meshes.grid(2, 2) for _ in range(12)]))
    result = lsgp.parameterize(squares, [])
    side = np.ptp(meshes.grid(2, 2).positions[:, 0])
    found = at_texel_density(squares, result, TexelLayout(200 / side, 256, udim=12, margin=5))
    assert sorted(map(tuple, np.floor(boxes_of(found)[:, :2]).astype(int).tolist())) == sorted(
        (i % 10, i // 10) for i in range(12)
    )


@pytest.mark.parametrize(
    ("changed", "match"),
    [
        ({"density": 0.0}, "density is 0.0"),
        ({"density": float("nan")}, "density is nan"),
        ({"texture_size": 0}, "texture_size is 0"),
        ({"texture_size": 12.5}, "texture_size is 12.5"),
        ({"udim": 0}, "udim is 0"),
        ({"udim": 101}, "udim is 101"),
        ({"udim": 2, "margin": SIZE / 2}, "less than half a tile"),
        ({"udim": 2, "margin": -1.0}, "margin is -1.0"),
    ],
)
def test_numbers_that_cannot_be_used_are_named_before_there_is_a_map(changed: dict[str, float], match: str) -> None:
    with pytest.raises(lsgp.InputError, match=match):
        TexelLayout(**{"density": 10.0, "texture_size": SIZE} | changed)


def test_seamless_layouts_and_pins_have_a_size_of_their_own() -> None:
    ball = surface(meshes.bumpy_sphere(1))
    with pytest.raises(lsgp.InputError, match="has the size of its tiles"):
        lsgp.auto_unwrap(ball, preset="tile", texels=TexelLayout(10.0, SIZE))
    with pytest.raises(lsgp.InputError, match="pins and texels"):
        lsgp.auto_unwrap(ball, pins=lsgp.Pins([0, 5], [[0, 0], [1, 0]]), texels=TexelLayout(10.0, SIZE))


def test_unwrapping_in_one_call_at_a_density(split: lsgp.Result) -> None:
    layout = TexelLayout(60.0, SIZE, udim=4)
    assert lsgp.auto_unwrap(PARTS, preset="bake", texels=layout) == at_texel_density(PARTS, split, layout)
