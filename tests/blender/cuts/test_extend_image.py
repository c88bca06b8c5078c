# SPDX-License-Identifier: GPL-3.0-or-later
"""Extend Image across Cuts: lookups on both sides of cuts agree, island pixels stay, and what is refused."""

import bpy
import lsgp
import numpy as np
import pytest
from scenes import UvMap, add_ball, add_sphere, add_texture, changed, edit, set_uv, snapshot

SIZE = 256


def unwrapped_ball(name="Ball", shrink=0.9):
    bpy.ops.object.select_all(action="DESELECT")
    ball = add_ball(name)
    bpy.ops.uv.cone_unwrap()
    set_uv(ball, 0.5 + shrink * (UvMap(ball).uv - 0.5))
    return ball


def replaced(image, **options):
    """The image of the active material replaced by a new one with these options."""
    node = bpy.context.object.active_material.node_tree.nodes.active
    node.image = bpy.data.images.new("New", SIZE, SIZE, **options)
    bpy.data.images.remove(image)
    return node.image


def pixels(image):
    """(height, width, channels), the lowest row first."""
    return np.array(image.pixels, np.float32).reshape(image.size[1], image.size[0], image.channels)


def bake(obj, image):
    """A function of space at the texels with their center in a triangle, 0 elsewhere; returns which these are."""
    uv_map = UvMap(obj)
    values, covered = pixels(image) * 0, np.zeros((SIZE, SIZE), bool)
    for loops in uv_map.triangles:
        uv, places = uv_map.uv[loops] * SIZE, uv_map.positions[uv_map.vertex[loops]]
        low, high = np.floor(uv.min(axis=0)).astype(int), np.ceil(uv.max(axis=0)).astype(int) + 1
        y, x = (part.ravel() for part in np.mgrid[low[1] : high[1], low[0] : high[0]])
        shares = np.linalg.solve(np.vstack([uv.T, np.ones(3)]), np.stack([x + 0.5, y + 0.5, np.ones(len(x))])).T
        inside = (shares >= 0).all(axis=1)
        values[y[inside], x[inside], :3] = 0.5 + 0.2 * np.sin(shares[inside] @ places * 2 + [0, 1, 2])
        covered[y[inside], x[inside]] = True
    values[covered, 3:] = 1
    image.pixels.foreach_set(values.ravel())
    return covered


def lookup(values, uv):
    """Bilinear."""
    x, y = uv.T * SIZE - 0.5
    j, i = x.astype(int), y.astype(int)
    s, t = (x - j)[:, None], (y - i)[:, None]
    lower = values[i, j] * (1 - s) + values[i, j + 1] * s
    return lower * (1 - t) + (values[i + 1, j] * (1 - s) + values[i + 1, j + 1] * s) * t


def difference_across_cuts(obj, values):
    uv_map = UvMap(obj)
    share = (np.arange(8)[:, None] + 0.5) / 8
    sides = [
        [uv_map.uv[first] * (1 - share) + uv_map.uv[second] * share for first, second in uv_map.sides[edge]]
        for edge in sorted(uv_map.split_edges())
    ]
    return np.mean([np.abs(lookup(values, one) - lookup(values, other)).mean() for one, other in sides])


@pytest.mark.parametrize("in_edit_mode", [False, True])
@pytest.mark.parametrize("is_float", [False, True])
def test_lookups_at_both_sides_of_cuts_agree_and_islands_stay(is_float, in_edit_mode, reports):
    ball = unwrapped_ball()
    image = replaced(add_texture(ball, 8, 8), float_buffer=is_float)
    covered = bake(ball, image)
    mesh, before = snapshot(ball), pixels(image)
    if in_edit_mode:
        edit(ball, select="DESELECT")
    reports()
    assert bpy.ops.uv.cone_extend_image(margin=8) == {"FINISHED"}
    told = reports()
    if in_edit_mode:
        bpy.ops.object.mode_set(mode="OBJECT")
    after = pixels(image)
    assert (after[covered] == before[covered]).all()
    different = (after != before).any(axis=2)
    assert f'Extended "New": {different.sum()} pixels' in told
    assert not is_float or different[1:-1, 1:-1].sum() > 1000
    neighbors = np.abs(np.diff(before, axis=1))[covered[:, 1:] & covered[:, :-1]].mean()
    assert difference_across_cuts(ball, after) < neighbors + (0 if is_float else 1 / 255)
    assert difference_across_cuts(ball, before) > 20 * neighbors
    uv = f"attribute {ball.data.uv_layers.active.name}"
    assert all(uv in key or "select" in key for key in changed(mesh, snapshot(ball)))
    # A second time there is nothing left to do.
    bpy.ops.uv.cone_extend_image(margin=8)
    assert "No pixel of" in reports() and (pixels(image) == after).all()


def test_objects_that_share_an_image_leave_each_others_islands_alone():
    balls = [unwrapped_ball("A", 0.4), unwrapped_ball("B", 0.4)]
    set_uv(balls[0], UvMap(balls[0]).uv - np.array([0.2, 0]))
    set_uv(balls[1], UvMap(balls[1]).uv + np.array([0.2, 0]))
    image = replaced(add_texture(balls[1], 8, 8), float_buffer=True)
    balls[0].data.materials.append(balls[1].active_material)
    covered = bake(balls[0], image)
    first = pixels(image)
    alone = covered.copy()
    covered |= bake(balls[1], image)
    both = np.where(alone[..., None], first, pixels(image))
    image.pixels.foreach_set(both.ravel())
    for ball in balls:
        ball.select_set(True)
    assert bpy.ops.uv.cone_extend_image(margin=60) == {"FINISHED"}
    after = pixels(image)
    assert (after[covered] == both[covered]).all()
    assert max(difference_across_cuts(ball, after) for ball in balls) < 0.02


def test_an_image_stays_where_one_of_its_objects_is_refused():
    balls = [unwrapped_ball("A"), unwrapped_ball("B")]
    image = replaced(add_texture(balls[1], 8, 8))
    bake(balls[1], image)
    balls[0].data.materials.append(balls[1].active_material)
    set_uv(balls[0], UvMap(balls[0]).uv + np.array([0.5, 0]))
    before = pixels(image)
    balls[0].select_set(True)
    with pytest.raises(RuntimeError, match=r"A: .* out of the UV square"):
        bpy.ops.uv.cone_extend_image()
    assert (pixels(image) == before).all()


def test_faces_with_another_image_are_ends_of_the_surface():
    ball = unwrapped_ball()
    image = replaced(add_texture(ball, 8, 8))
    bake(ball, image)
    before = pixels(image)
    add_texture(ball, 16, 16)
    for face in ball.data.polygons[1:]:
        face.material_index = 1
    ball.data.polygons.active = 0
    bpy.ops.uv.cone_extend_image(margin=2)
    different = (pixels(image) != before).any(axis=2)
    uv_map = UvMap(ball)
    corners = uv_map.uv[uv_map.loops_of_face[0]] * SIZE
    y, x = np.nonzero(different)
    assert len(x) and x.min() > corners[:, 0].min() - 3 and x.max() < corners[:, 0].max() + 3
    assert y.min() > corners[:, 1].min() - 3 and y.max() < corners[:, 1].max() + 3


def test_normals_turn_in_their_first_two_channels():
    ball = unwrapped_ball()
    image = replaced(add_texture(ball, 8, 8), float_buffer=True)
    bake(ball, image)
    before = pixels(image)
    bpy.ops.uv.cone_extend_image(margin=4)
    plain = pixels(image)
    image.pixels.foreach_set(before.ravel())
    bpy.ops.uv.cone_extend_image(margin=4, normal_map=True)
    turned = pixels(image)
    different = (turned[..., :2] != plain[..., :2]).any(axis=2)
    assert different.sum() > 100 and (turned[..., 2:] == plain[..., 2:]).all()
    length = [np.linalg.norm(values[different][:, :2] - 0.5, axis=1) for values in (turned, plain)]
    # But beside cuts, where samples also take gutters, which are turned.
    assert np.isclose(*length, atol=1e-6).mean() > 0.8
    uv_map = UvMap(ball)
    loops = uv_map.triangles
    surface = lsgp.Surface(uv_map.positions, np.asarray(uv_map.vertex[loops], np.int32))
    expected = lsgp.pad_image(before[::-1], surface, uv_map.uv[loops].astype(float), 4, normal_map=True)
    np.testing.assert_allclose(turned, expected[::-1], atol=1e-6)


def without_uv(ball):
    add_texture(ball, 8, 8)
    ball.data.uv_layers.remove(ball.data.uv_layers[0])


def with_tiles(ball):
    replaced(add_texture(ball, 8, 8), tiled=True)


def out_of_the_square(ball):
    add_texture(ball, 8, 8)
    set_uv(ball, UvMap(ball).uv + np.array([0.5, 0]))


@pytest.mark.parametrize(
    ("prepare", "told"),
    [
        (without_uv, "has no UV map"),
        (lambda ball: None, "has no image with pixels"),
        (with_tiles, "UDIM"),
        (out_of_the_square, "out of the UV square"),
    ],
)
def test_what_cannot_be_extended_is_refused(prepare, told):
    prepare(unwrapped_ball())
    with pytest.raises(RuntimeError, match=told):
        bpy.ops.uv.cone_extend_image()


def test_a_sequence_of_images_is_refused(tmp_path):
    ball = unwrapped_ball()
    image = add_texture(ball, 8, 8)
    image.filepath_raw, image.file_format = str(tmp_path / "frame_0001.png"), "PNG"
    image.save()
    image.source = "SEQUENCE"
    with pytest.raises(RuntimeError, match=r"sequence|no image with pixels"):
        bpy.ops.uv.cone_extend_image()


def test_a_linked_image_is_refused(tmp_path):
    bpy.data.libraries.write(str(tmp_path / "library.blend"), {bpy.data.images.new("Far", 8, 8)}, fake_user=True)
    with bpy.data.libraries.load(str(tmp_path / "library.blend"), link=True) as (_, wanted):
        wanted.images = ["Far"]
    ball = unwrapped_ball()
    add_texture(ball, 8, 8)
    ball.active_material.node_tree.nodes.active.image = wanted.images[0]
    with pytest.raises(RuntimeError, match='"Far" is linked'):
        bpy.ops.uv.cone_extend_image()


def test_one_refusal_does_not_stop_the_others(reports):
    sphere = add_sphere()
    ball = unwrapped_ball()
    image = replaced(add_texture(ball, 8, 8))
    bake(ball, image)
    before = pixels(image)
    sphere.select_set(True)
    reports()
    assert bpy.ops.uv.cone_extend_image() == {"FINISHED"}
    assert "Sphere: the material of the active face has no image" in reports()
    assert (pixels(image) != before).any()
