# SPDX-License-Identifier: GPL-3.0-or-later
"""The picture at the top of the README shows what Auto Unwrap makes today, and the demo's drawing has all of it."""

import sys
import xml.etree.ElementTree
from pathlib import Path

import bpy
import numpy as np
import pytest

sys.path.append(str(Path(__file__).resolve().parents[3] / "tools" / "pictures"))
import demo_layout
import demo_picture
import demo_scene

pytestmark = pytest.mark.slow

PICTURE = Path(__file__).resolve().parents[3] / "docs" / "images" / "suzanne.png"

DRAWN_BY = (4, 5)  # the Blender that tools/demo takes

COLORFUL = 0.25  # of 1: the difference of the channels in lines and cones, greater than in paper and checker
NEAR = 10  # pixels, along both axes: half as wide as a cone is drawn, and rounding


def colorful_pixels() -> np.ndarray:
    """(height, width) bool, row 0 at the bottom: the pixels of cuts and cones where the picture shows Auto Unwrap."""
    image = bpy.data.images.load(str(PICTURE))
    pixels = np.empty(4 * image.size[0] * image.size[1], np.float32)
    image.pixels.foreach_get(pixels)
    below = image.size[1] // 2  # what it is compared with, each below a heading
    colors = pixels.reshape(image.size[1], image.size[0], 4)[below : below + image.size[0] // 2, :, :3]
    return colors.max(axis=2) - colors.min(axis=2) > COLORFUL


def drawn_cuts(obj: bpy.types.Object, shape: tuple[int, int]) -> np.ndarray:
    """(n, 2) rows and columns of points, a pixel apart or less, on both sides of all cuts in the layout's half."""
    import lsgp

    board = demo_picture.layout_places(demo_picture.read_uv(obj.data))[:, [2, 0]]
    _, measured = demo_scene.measure(lsgp, obj)
    sides = demo_picture.Sides(obj.data)
    edges = [side for edge in measured.cut_edges for side in sides.of_path(edge)]
    start, end = board[np.array(edges)].transpose(1, 0, 2)
    unit = shape[1] / 8  # pixels; the picture is 8 units wide and 4 high, its middle at the origin
    points = start[:, None] + np.linspace(0, 1, 40)[:, None] * (end - start)[:, None]
    return (points.reshape(-1, 2) * unit + np.array(shape) / 2).astype(int)


def grown(mask: np.ndarray, by: int) -> np.ndarray:
    """The mask and all that is nearer than `by` along both axes."""
    padded = np.pad(mask.astype(np.int32), ((by + 1, by), (by + 1, by))).cumsum(0).cumsum(1)
    side = 2 * by + 1
    return padded[side:, side:] - padded[:-side, side:] - padded[side:, :-side] + padded[:-side, :-side] > 0


@pytest.mark.one_blender
@pytest.mark.all_tries
def test_cuts_of_the_layout_are_where_the_readme_shows_them():
    import lsgp

    suzanne = demo_scene.unwrapped_suzanne()
    _, measured = demo_scene.measure(lsgp, suzanne)
    islands = len(np.unique(measured.island))
    assert islands < 10  # where Smart UV Project makes 64
    if bpy.app.version[:2] != DRAWN_BY:
        return  # vertices in another order put islands elsewhere
    assert islands == 4  # as the README says
    colorful = colorful_pixels()
    cuts = drawn_cuts(suzanne, colorful.shape)
    # A fifth of the cuts have pale colors; of a stale picture hardly any place fits.
    assert colorful[tuple(cuts.T)].mean() > 0.7, "the picture is stale: run tools/demo and copy build/demo/suzanne.png"
    colorful[:, : colorful.shape[1] // 2] = False  # the model's half
    near_cuts = np.zeros_like(colorful)
    near_cuts[tuple(cuts.T)] = True
    assert (colorful & grown(near_cuts, NEAR)).sum() > 0.95 * colorful.sum()


@pytest.mark.one_blender
def test_drawing_has_every_face_and_both_sides_of_every_cut(tmp_path):
    import lsgp

    suzanne = demo_scene.unwrapped_suzanne()
    _, measured = demo_scene.measure(lsgp, suzanne)
    cones = demo_scene.marked_cones(suzanne)
    demo_layout.write_layout(suzanne, measured.cut_edges, cones, tmp_path / "map.svg")
    _, faces, *lines = xml.etree.ElementTree.parse(tmp_path / "map.svg").getroot()
    assert faces.get("d").count("Z") == len(suzanne.data.polygons)

    cuts = [line for line in lines if line.get("stroke") not in (None, demo_layout.BORDER)]
    steps = [line.get("d").count("L") for line in cuts]
    assert sum(steps) == 2 * len(measured.cut_edges)
    assert all(line.get("d").count("M") == 2 for line in cuts)
    places = [line for line in lines if line.get("r")]
    assert len(places) >= len(cones) > 0  # a cone has a place for each of its cuts
