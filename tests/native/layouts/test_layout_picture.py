# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of layouts: what is drawn where, and in which color."""

from __future__ import annotations

import math
import re
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import lsgp
import numpy as np
import pytest
from lsgp.images import layout_picture
from lsgp.images.layout_picture import CUT_COLORS, FLAT, FLIPPED, INK, MARGIN, OVERLAPPING, PAPER, SADDLE, TIP
from map_checks import surface, unwrap
from meshes import Mesh, cube, cylinder, double_torus, grid, icosphere, merge
from png_check import pixels_of

SIZE = 512
Color = tuple[int, int, int]


class Drawn:
    """A picture of a result, and where its texture coordinates are in it."""

    def __init__(self, mesh: Mesh, result: lsgp.Result, size: int = SIZE) -> None:
        self.mesh, self.result = mesh, result
        self.pixels = lsgp.draw_layout(surface(mesh), result, size=size).astype(int)
        uv = result.corner_uv[result.solved].reshape(-1, 2)
        self.low = np.floor(uv.min(axis=0) + 1e-5)
        self.margin = math.ceil(MARGIN * size)
        extent = np.maximum(np.ceil(uv.max(axis=0) - 1e-5) - self.low, 1)
        self.scale = (size - 2 * self.margin) / extent.max()

    def at(self, uv: np.ndarray) -> np.ndarray:
        """(..., 3), the colors at coordinates (..., 2)."""
        u, v = np.moveaxis((np.asarray(uv) - self.low) * self.scale, -1, 0)
        rows = len(self.pixels) - 1 - self.margin - np.floor(v).astype(int)
        return self.pixels[rows, self.margin + np.floor(u).astype(int)]

    def share(self, color: Color, within: np.ndarray | None = None) -> float:
        """Of the picture, or of these pixels of it, that has this color but for a thin line of the grid."""
        near = (np.abs(self.pixels - color) <= 12).all(axis=2)
        return float((near if within is None else near[within]).mean())


def color_of(path: int) -> np.ndarray:
    color = np.array(list(bytes.fromhex(CUT_COLORS[path % len(CUT_COLORS)][1:])))
    return (color + 255) // 2 if path // len(CUT_COLORS) % 2 else color


def is_close(found: np.ndarray, color: object, by: int = 14) -> np.ndarray:
    return (np.abs(found - np.asarray(color)) <= by).all(axis=-1)


def three_islands() -> tuple[Mesh, lsgp.Result]:
    mesh = merge([cube(4), icosphere(2), grid(6, 5)])
    return mesh, lsgp.auto_unwrap(surface(mesh), preset="bake")


def test_every_island_has_a_fill_of_its_own_and_the_rest_is_paper() -> None:
    mesh, result = three_islands()
    drawn = Drawn(mesh, result)
    centers = result.corner_uv.mean(axis=1)
    away = drawn.scale * np.sqrt(np.abs(np.linalg.det(result.corner_uv[:, 1:] - result.corner_uv[:, :1]))) > 8
    inner = away & ~np.isin(mesh.triangles, result.cut_edges).any(axis=1)
    fills = {}
    for island in range(result.island.max() + 1):
        colors = drawn.at(centers[inner & (result.island == island)])
        if len(colors):
            fills[island] = np.median(colors, axis=0)
            assert is_close(colors, fills[island]).mean() > 0.9
    assert len(fills) >= 3
    for one in fills:
        assert all(np.abs(fills[one] - fills[other]).max() > 15 for other in fills if other != one)
        assert np.abs(fills[one] - PAPER).max() > 20
    # What islands cover of the square is filled, the rest is not.
    uv_area = 0.5 * np.abs(np.linalg.det(result.corner_uv[:, 1:] - result.corner_uv[:, :1])).sum()
    square = np.zeros(drawn.pixels.shape[:2], bool)
    square[drawn.margin : -drawn.margin, drawn.margin : -drawn.margin] = True
    assert drawn.share(PAPER, square) == pytest.approx(1 - uv_area, abs=0.06)


@pytest.mark.slow
@pytest.mark.parametrize("mesh", [cube(4), double_torus()], ids=["cube", "genus 2"])
def test_both_sides_of_every_cut_have_its_color(mesh: Mesh) -> None:
    result = lsgp.auto_unwrap(surface(mesh), preset="bake")
    drawn = Drawn(mesh, result, 2048)
    path = {frozenset(pair): k for k, cut in enumerate(result.cut_paths) for pair in pairwise(cut)}
    seen, sides = {number: 0 for number in path.values()}, 0
    at_cones = result.corner_uv[np.isin(mesh.triangles, result.cones)]
    for triangle, uv in zip(mesh.triangles, result.corner_uv, strict=True):
        for c in range(3):
            number = path.get(frozenset((triangle[c], triangle[c - 2])))
            middle = 0.5 * (uv[c] + uv[c - 2])
            if number is None or np.linalg.norm(at_cones - middle, axis=1).min(initial=1) < 0.02:
                continue
            sides += 1
            seen[number] += is_close(drawn.at(middle), color_of(number), 30)
    assert sum(seen.values()) > 0.95 * sides > 10
    # Of a cut of one edge, one of the two sides may lie under the color of another cut.
    assert all(count >= min(2, len(result.cut_paths[number]) - 1) for number, count in seen.items())


def test_cones_are_colored_by_curvature_at_all_their_places() -> None:
    mesh = cube(4)
    result = unwrap(mesh)
    drawn = Drawn(mesh, result)
    assert is_close(drawn.at(_places(mesh, result, result.cones)), TIP).all()
    saddles = replace(result, cone_angles=np.full(len(result.cones), 2.5 * math.pi))
    assert is_close(Drawn(mesh, saddles).at(_places(mesh, result, result.cones)), SADDLE).all()
    flat = replace(result, cone_angles=np.full(len(result.cones), 2 * math.pi))
    assert is_close(Drawn(mesh, flat).at(_places(mesh, result, result.cones)), FLAT).all()


def test_corners_of_a_boundary_are_flat_with_half_a_turn() -> None:
    mesh = grid(6, 6)
    result = unwrap(Mesh(mesh.positions, mesh.triangles, np.zeros(0, np.int32)))
    corner = replace(result, cones=np.array([0], np.int32), cone_angles=np.array([math.pi]))
    at = np.clip(_places(mesh, result, [0]), 1e-3, 1 - 1e-3)
    assert is_close(Drawn(mesh, corner).at(at), FLAT).all()


def _places(mesh: Mesh, result: lsgp.Result, vertices: object) -> np.ndarray:
    """Of these vertices in the layout, off the border of the picture's square."""
    return np.clip(result.corner_uv[np.isin(mesh.triangles, vertices)], 1e-3, 1 - 1e-3)


@pytest.mark.slow
def test_boundaries_are_dark() -> None:
    mesh = cylinder()
    result = unwrap(mesh)
    drawn = Drawn(mesh, result, 2048)
    counts = np.bincount(np.unique(np.sort(result.cut_edges, axis=1)).ravel(), minlength=len(mesh.positions))
    sides, times = np.unique(
        np.sort(mesh.triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1), axis=0, return_counts=True
    )
    boundary = {tuple(side) for side in sides[times == 1].tolist()}
    found = [
        drawn.at(0.5 * (uv[c] + uv[c - 2]))
        for triangle, uv in zip(mesh.triangles, result.corner_uv, strict=True)
        for c in range(3)
        if tuple(sorted((triangle[c], triangle[c - 2]))) in boundary and not counts[triangle].any()
    ]
    assert len(found) > 10
    assert is_close(np.array(found), INK, 40).mean() > 0.9


def test_flipped_and_overlapping_triangles_stand_out() -> None:
    mesh = grid(8, 8)
    result = unwrap(mesh)
    some = np.arange(40, dtype=np.int32)
    area = 40 / len(mesh.triangles)
    for name, color in (("flipped", FLIPPED), ("overlapping", OVERLAPPING)):
        marked = Drawn(mesh, replace(result, **{name: some}))
        assert marked.share(color) == pytest.approx(area, abs=0.08)
        assert Drawn(mesh, result).share(color) == 0


def test_triangles_without_coordinates_are_not_drawn() -> None:
    mesh = grid(8, 8)
    result = unwrap(mesh)
    left = mesh.positions[mesh.triangles][:, :, 0].max(axis=1) < np.median(mesh.positions[:, 0])
    uv = result.corner_uv.copy()
    uv[left] = np.nan
    solved, island = ~left, np.where(left, -1, result.island).astype(np.int32)
    drawn = Drawn(mesh, replace(result, corner_uv=uv, solved=solved, island=island))
    gone = result.corner_uv[left].mean(axis=1)
    assert is_close(drawn.at(gone), PAPER).mean() > 0.8
    nothing = replace(result, corner_uv=uv * np.nan, solved=left & ~left, island=np.full_like(island, -1))
    empty = lsgp.draw_layout(surface(mesh), nothing, size=SIZE)
    assert empty.shape == (SIZE, SIZE, 3)
    assert is_close(empty.astype(int), PAPER).mean() > 0.9


def test_a_layout_of_many_tiles_has_the_aspect_of_its_squares() -> None:
    mesh = grid(20, 5)
    result = unwrap(mesh)
    wide = replace(result, corner_uv=(result.corner_uv - result.corner_uv.min(axis=(0, 1))) * 7.7 + 12)
    extent = np.ceil(np.ptp(wide.corner_uv.reshape(-1, 2), axis=0) - 1e-9)
    drawn = Drawn(mesh, wide)
    height, width = (np.array(drawn.pixels.shape[:2]) - 2 * drawn.margin).tolist()
    assert width / height == pytest.approx(extent[0] / extent[1], rel=0.02)
    assert max(drawn.pixels.shape) == SIZE
    assert not is_close(drawn.at(wide.corner_uv.mean(axis=1)), PAPER).any()


def test_the_same_result_has_the_same_picture_wherever_it_lies() -> None:
    mesh, result = three_islands()
    one = lsgp.draw_layout(surface(mesh), result, size=256)
    assert one.dtype == np.uint8 and one.shape == (256, 256, 3)
    assert (one == lsgp.draw_layout(surface(mesh), result, size=256)).all()
    moved = replace(result, corner_uv=result.corner_uv + np.array([1024.0, -512.0]))
    assert (one == lsgp.draw_layout(surface(mesh), moved, size=256)).mean() > 0.99


def test_pictures_of_all_sizes_look_alike() -> None:
    mesh = cube(2)
    result = unwrap(mesh)
    large, small = (Drawn(mesh, result, size) for size in (1024, 512))
    halved = large.pixels.reshape(512, 2, 512, 2, 3).mean(axis=(1, 3))
    assert np.abs(halved - small.pixels).mean() < 0.02 * 255
    for drawn in (large, small):  # and no triangle's middle is bare paper
        assert not is_close(drawn.at(result.corner_uv.mean(axis=1)), PAPER).any()


def test_refuses_results_of_other_surfaces_and_sizes() -> None:
    mesh = cube(2)
    result = unwrap(mesh)
    with pytest.raises(lsgp.InputError, match=r"result\.corner_uv has shape") as error:
        lsgp.draw_layout(surface(cube(3)), result)
    assert error.value.code == "WRONG_SHAPE"
    for size in (63, 8193, 100.5, True):
        with pytest.raises(lsgp.InputError, match=r"size is .*64 to 8192"):
            lsgp.draw_layout(surface(mesh), result, size=size)


def test_the_colors_of_cuts_are_those_of_the_overlay() -> None:
    look = Path(__file__).parents[3] / "addon/overlay/look.py"
    (line,) = re.findall(r"^CUT_COLORS = \((.*)\)$", look.read_text(), re.MULTILINE)
    assert tuple(re.findall(r"#\w{6}", line)) == layout_picture.CUT_COLORS


def test_png_holds_the_pixels(tmp_path: Path) -> None:
    pixels = np.random.default_rng(1).integers(0, 256, (5, 7, 3), np.uint8)
    lsgp.write_png(tmp_path / "some.png", pixels)
    assert (pixels_of((tmp_path / "some.png").read_bytes()) == pixels).all()


@pytest.mark.parametrize(
    ("pixels", "code"),
    [
        (np.zeros((4, 4), np.uint8), "WRONG_SHAPE"),
        (np.zeros((4, 4, 4), np.uint8), "WRONG_SHAPE"),
        (np.zeros((0, 4, 3), np.uint8), "WRONG_SHAPE"),
        (np.zeros((4, 4, 3)), "WRONG_DTYPE"),
    ],
)
def test_png_refuses_what_is_no_picture(tmp_path: Path, pixels: np.ndarray, code: str) -> None:
    with pytest.raises(lsgp.InputError, match="pixels") as error:
        lsgp.write_png(tmp_path / "some.png", pixels)
    assert error.value.code == code
    assert list(tmp_path.iterdir()) == []
