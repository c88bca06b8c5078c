# SPDX-License-Identifier: GPL-3.0-or-later
"""Pixels of Blender's images as arrays, and writing them so that they can be undone."""

from __future__ import annotations

from typing import Any

import bpy
import numpy as np
from numpy.typing import NDArray

from ..core.errors import Refused


def require_paintable(image: bpy.types.Image) -> None:
    """Raise Refused where an image has no pixels of its own that can be changed."""
    name = f'the image "{image.name}"'
    if not image.is_editable:
        raise Refused(f"{name} is linked from another file and cannot be changed; make it local first")
    if image.source == "TILED":
        raise Refused(f"{name} has UDIM tiles, which are not extended; use an image for each tile")
    if image.source not in {"FILE", "GENERATED"} or image.type == "MULTILAYER":
        raise Refused(f"{name} is a movie, a sequence, a render or has layers; save it as a single image and use that")
    # Blender loads a file when its pixels are asked for.
    if not len(image.pixels):
        raise Refused(f"{name} has no pixels; check the path of its file")


def read_pixels(image: bpy.types.Image) -> NDArray[Any]:
    """(height, width, channels), the top row first: uint8, or float32 where Blender keeps floating point."""
    width, height = image.size
    values = np.empty(width * height * image.channels, np.float32)
    image.pixels.foreach_get(values)
    if not image.is_float:
        values = np.rint(values * 255).astype(np.uint8)
    return values.reshape(height, width, image.channels)[::-1]


def write_pixels(image: bpy.types.Image, pixels: NDArray[Any]) -> None:
    """Replace an image's pixels by those of `read_pixels`; in a window this is a step of undo."""
    values = pixels[::-1].astype(np.float32).ravel()
    if not image.is_float:
        values /= 255
    _add_undo_step(image)
    image.pixels.foreach_set(values)
    image.update()
    _add_undo_step(image)


def _add_undo_step(image: bpy.types.Image) -> None:
    """Let Blender remember the pixels.

    Undo of operators does not bring pixels back, only that of Blender's own operators on images does. To invert no
    channel changes nothing and is such a step: one before and one after a change lead from one to the other.
    """
    # Without a window there is no undo, and Blender would crash.
    if bpy.app.background:
        return
    with bpy.context.temp_override(edit_image=image):
        bpy.ops.image.invert("EXEC_DEFAULT", False, invert_r=False, invert_g=False, invert_b=False, invert_a=False)
