# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of results: PNG files that show the surface, and of the layout where it is large, small and flipped."""

from __future__ import annotations

from dataclasses import replace

import lsgp
import numpy as np
import pytest
from lsgp.batch.pictures import EQUAL, FLIPPED, LARGER, LEVELS, MARGIN, SIDE, SMALLER, VIEW, picture_of
from meshes import Mesh, cube, grid, icosphere
from png_check import pixels_of


def unwrapped(mesh: Mesh) -> tuple[lsgp.Surface, lsgp.Result]:
    surface = lsgp.Surface(mesh.positions, mesh.triangles)
    return surface, lsgp.parameterize(surface, mesh.cones)


def halves(surface: lsgp.Surface, result: lsgp.Result) -> tuple[np.ndarray, np.ndarray]:
    """The picture of the surface and that of the layout."""
    pixels = pixels_of(picture_of(surface, result)).astype(int)
    assert pixels.shape == (SIDE, 2 * SIDE, 3)
    return pixels[:, :SIDE], pixels[:, SIDE:]


def test_a_flat_square_is_laid_out_without_distortion() -> None:
    surface, result = unwrapped(grid(6, 6))
    _, layout = halves(surface, result)
    inked = (layout != 255).any(axis=2)
    assert inked.sum() == pytest.approx((SIDE - 2 * MARGIN) ** 2, rel=0.05)
    colors = np.unique(layout[inked], axis=0)
    assert (np.ptp(colors, axis=1) < 40).all()  # grays: neither larger nor smaller


def test_a_checker_of_two_colors_covers_the_surface() -> None:
    surface, result = unwrapped(cube(6))
    model, _ = halves(surface, result)
    inked = model[(model != 255).any(axis=2)]
    # Seen from a corner a cube is a hexagon: half to three quarters of the square around it.
    assert 0.5 * SIDE**2 < len(inked) < 0.8 * SIDE**2
    bluish = inked[:, 2] > inked[:, 0]
    assert 0.3 < bluish.mean() < 0.7


def test_the_back_does_not_shine_through() -> None:
    mesh = icosphere(4)
    surface, result = unwrapped(Mesh(mesh.positions, mesh.triangles, np.array([0, 3, 7, 11], np.int32)))
    ahead = (surface.positions @ VIEW[2])[surface.triangles].mean(axis=1) > 0
    # The front lies in one square of the checker, the back in another one of the other color.
    uv = np.where(ahead[:, None, None], [0.0, 0.0], [17.99, 16.99]) + 0.01 * np.array([[0, 0], [1, 0], [0, 1]])
    model, _ = halves(surface, replace(result, corner_uv=uv))
    row, column = np.indices((SIDE, SIDE))
    within = np.hypot(row + 0.5 - SIDE / 2, column + 0.5 - SIDE / 2) < 0.45 * SIDE - 2 * MARGIN
    bluish = model[within][:, 2] > model[within][:, 0]
    assert bluish.all() or not bluish.any()


def test_triangles_are_red_where_large_blue_where_small_magenta_where_flipped() -> None:
    surface, result = unwrapped(grid(2, 1))
    right = surface.positions[surface.triangles][:, :, 0].mean(axis=1) > surface.positions[:, 0].mean()
    uv = result.corner_uv.copy()
    uv[right] *= 3
    distorted = replace(result, corner_uv=uv)
    _, layout = halves(surface, distorted)
    # Of a layout of ten parts nine are the right half's, which was half of the surface, and one the left one's.
    red = np.log2(0.9 / 0.5) / 2
    blue = min(1.0, -np.log2(0.1 / 0.5) / 2)
    for share, color in ((red, LARGER), (blue, SMALLER)):
        wanted = EQUAL + share * (color - EQUAL)
        assert (np.abs(layout - wanted).max(axis=2) <= 0.5 * 255 / LEVELS + 1).sum() > 100
    flipped = replace(result, flipped=np.flatnonzero(right).astype(np.int32))
    _, layout = halves(surface, flipped)
    share = (np.abs(layout - FLIPPED).sum(axis=2) < 30).sum() / (layout != 255).any(axis=2).sum()
    assert share == pytest.approx(0.5, abs=0.08)


def test_same_result_same_bytes_and_nothing_solved_is_an_empty_picture() -> None:
    mesh = icosphere(2)
    surface, result = unwrapped(Mesh(mesh.positions, mesh.triangles, np.array([0, 3, 7, 11], np.int32)))
    assert picture_of(surface, result) == picture_of(surface, result)
    nothing = replace(result, solved=np.zeros_like(result.solved))
    assert (pixels_of(picture_of(surface, nothing)) == 255).all()
