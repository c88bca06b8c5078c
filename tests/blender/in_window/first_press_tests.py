# SPDX-License-Identifier: GPL-3.0-or-later
"""The first session with Auto Unwrap, by mouse and keyboard: unwrap, change the preset, paint over a cut.

Run by run_in_window.py, not by pytest.
"""

import bpy
import numpy as np
import pytest
from first_press_models import default_cube, scan, suzanne
from mathutils import Vector
from scenes import UvMap, add_texture, covered_twice
from windows import DRAWN, choose, click, done, drag, middle, move_to, place_at, press, running, until

SIZE = 512
# Pixels from the cursor to the last of the presets, as the operator's options are opened.
BAKE = (264, -82)
STROKE = 40  # pixels on each side of the cut


def last():
    return bpy.context.window_manager.operators[-1].properties


def require_good(obj):
    uv_map = UvMap(obj)
    assert uv_map.flipped() == set() and covered_twice([uv_map]) == 0
    assert uv_map.uv.min() >= 0 and uv_map.uv.max() <= 1
    return uv_map


def session(make):
    (obj,) = make()
    bpy.context.preferences.view.smooth_view = 0
    bpy.ops.view3d.view_selected()
    bpy.context.region_data.view_distance *= 1.5
    yield from press("TAB", middle())
    yield from until(lambda: obj.mode == "EDIT")
    yield from press("A", middle())
    yield from choose("U", "auto unwrap")
    yield from until(lambda: done("UV_OT_cone_auto_unwrap"), 60)
    assert last().preset == "PAINT"
    painted = require_good(obj)
    yield from move_to(middle())
    yield from press("F9", middle())
    yield DRAWN
    yield from click(np.array(middle()) + BAKE)
    yield from until(lambda: last().preset == "BAKE", 60)
    yield from until(lambda: not running("UV_OT_cone_wait_for_redo"), 60)
    yield DRAWN
    # Adjusting an operator undoes it first, and there are other objects then.
    obj = bpy.context.object
    baked = require_good(obj)
    assert not np.array_equal(painted.uv, baked.uv)
    yield from press("ESC", np.array(middle()) + BAKE)
    yield DRAWN
    yield from press("TAB", middle())
    yield from until(lambda: obj.mode == "OBJECT")
    yield from paint(obj, baked)


def paint(obj, uv_map):
    """A stroke from one side of a cut to the other colors both of them alike."""
    image = add_texture(obj, SIZE, SIZE)
    image.generated_color = (1, 1, 1, 1)
    bpy.ops.object.mode_set(mode="TEXTURE_PAINT")
    yield DRAWN
    ends, texels = across_a_cut(obj, uv_map)
    blank = texels_of(image)
    yield from drag(*ends)
    yield from until(lambda: not np.array_equal(texels_of(image), blank))
    yield DRAWN
    drawn = texels_of(image)
    here, there = (drawn[row, column] for row, column in texels)
    assert np.abs(here - 1).max() > 0.5 and np.abs(here - there).max() < 0.1, (here, there)
    # The brush is a small part of the view.
    assert 0 < (drawn != blank).any(axis=2).mean() < 0.5


def texels_of(image):
    """(rows, columns, 3)."""
    return np.array(image.pixels[:]).reshape(SIZE, SIZE, 4)[..., :3]


def across_a_cut(obj, uv_map):
    """The ends of a stroke over the cut that faces the view most, and the texels at its middle on both sides."""
    eye = obj.matrix_world.inverted() @ bpy.context.region_data.view_matrix.inverted().translation
    best, found = 0.0, None
    for edge in sorted(uv_map.split_edges()):
        sides = [Side(uv_map, loops) for loops in uv_map.sides[edge]]
        size = min(side.seen_from(obj, eye) for side in sides)
        if size > best:
            best, found = size, sides
    assert found is not None, "no cut is in sight"
    # A short stroke runs nearly straight over the middle of the edge, whatever the angle between the faces.
    shares = [side.share_of(STROKE, obj) for side in found]
    ends = [side.pixels(share, obj) for side, share in zip(found, shares, strict=True)]
    uvs = [side.at(share / 2)[1] for side, share in zip(found, shares, strict=True)]
    return ends, [tuple((uv[::-1] * SIZE).astype(int)) for uv in uvs]


class Side:
    """A face beside a cut: points from the middle of the edge, 0, to that of the face, 1."""

    def __init__(self, uv_map, loops):
        self.face = next(i for i, own in enumerate(uv_map.loops_of_face) if loops[0] in own)
        own = uv_map.loops_of_face[self.face]
        self.corners = uv_map.positions[uv_map.vertex[own]]
        self.ends = [
            (uv_map.positions[uv_map.vertex[list(at)]].mean(axis=0), uv_map.uv[list(at)].mean(axis=0))
            for at in (loops, own)
        ]

    def at(self, share):
        """Position and UV."""
        (place, uv), (last_place, last_uv) = self.ends
        return place + share * (last_place - place), uv + share * (last_uv - uv)

    def pixels(self, share, obj):
        """The point in the window."""
        return np.array(place_at(obj.matrix_world @ Vector(self.at(share)[0])))

    def share_of(self, length, obj):
        """How far a stroke of so many pixels reaches."""
        whole = np.linalg.norm(self.pixels(1, obj) - self.pixels(0, obj))
        return float(min(0.6, length / max(whole, 1)))

    def seen_from(self, obj, eye):
        """Its area times the cosine to the view; 0 where something hides it or it is not well inside the view."""
        if np.abs(self.pixels(0, obj) - middle()).max() > 350:
            return 0.0
        places = [Vector(self.at(share)[0]) for share in (0.1, 0.6)]
        for place in places:
            hit, _, _, face = obj.ray_cast(eye, place - eye)
            if not hit or face != self.face:
                return 0.0
        area = np.cross(self.corners, np.roll(self.corners, -1, axis=0)).sum(axis=0) / 2
        return float(area @ (eye - places[0]).normalized())


def test_the_default_cube():
    yield from session(default_cube)


@pytest.mark.nightly
def test_suzanne():
    yield from session(suzanne)


@pytest.mark.nightly
def test_an_imported_scan():
    yield from session(scan)
