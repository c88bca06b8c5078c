# SPDX-License-Identifier: GPL-3.0-or-later
"""Undo and redo bring the pixels back that Extend Image across Cuts changes.  Run by run_in_window.py; no pytest."""

import bpy
import numpy as np
from scenes import add_ball, add_texture, edit


def pixels(image):
    return np.array(image.pixels, np.float32)


def extend_undo_redo(*, is_float, packed, in_edit_mode):
    ball = add_ball()
    bpy.ops.uv.cone_unwrap("EXEC_DEFAULT", True)
    add_texture(ball, 8, 8)
    image = bpy.data.images.new("Painted", 128, 128, float_buffer=is_float)
    ball.active_material.node_tree.nodes.active.image = image
    noise = np.random.default_rng(1).random(len(image.pixels))
    image.pixels.foreach_set(noise.astype(np.float32))
    if packed:
        image.pack()
    if in_edit_mode:
        edit(ball)
    bpy.ops.ed.undo_push(message="before")
    before = pixels(image)
    assert bpy.ops.uv.cone_extend_image("EXEC_DEFAULT", True, margin=4) == {"FINISHED"}
    yield 0.1
    after = pixels(image)
    assert (after != before).any()
    bpy.ops.ed.undo()
    yield 0.1
    assert (pixels(bpy.data.images["Painted"]) == before).all()
    bpy.ops.ed.redo()
    yield 0.1
    assert (pixels(bpy.data.images["Painted"]) == after).all()


def test_undo_and_redo_of_byte_images():
    yield from extend_undo_redo(is_float=False, packed=False, in_edit_mode=False)


def test_undo_and_redo_of_packed_float_images_in_edit_mode():
    yield from extend_undo_redo(is_float=True, packed=True, in_edit_mode=True)
