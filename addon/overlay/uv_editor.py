# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws cuts in UV editors, in the same colors as in 3D views."""

from __future__ import annotations

import bpy
import gpu
import numpy as np

from . import cache, colors, shaders
from .content import Content
from .look import OverlayLook, overlay_look
from .settings import settings


def draw() -> None:
    context = bpy.context
    chosen, space = settings(context), context.space_data
    if not (chosen.show and chosen.cuts and space.show_uvedit and space.overlay.show_overlays):
        return
    look = overlay_look(context)
    shader = shaders.lines()
    gpu.state.blend_set("ALPHA")
    with gpu.matrix.push_pop():
        _load_layout_space(context.region)
        for obj in context.objects_in_mode_unique_data:
            entry = cache.entry(obj)
            if not len(entry.content.cut_uv):
                continue
            shader.bind()
            shader.uniform_float("viewportSize", gpu.state.viewport_get()[2:])
            shader.uniform_float("lineWidth", look.line_width * context.preferences.system.pixel_size)
            entry.batch("layout", lambda content=entry.content: _batch(content, look)).draw(shader)
    gpu.state.blend_set("NONE")


def _batch(content: Content, look: OverlayLook) -> gpu.types.GPUBatch:
    segments = np.zeros((len(content.cut_uv), 2, 3), np.float32)
    segments[..., :2] = content.cut_uv
    return shaders.line_batch(segments, colors.of_paths(content.cut_paths, look))


def _load_layout_space(region: bpy.types.Region) -> None:
    """Make the GPU's matrix map texture coordinates to pixels of the region."""
    origin = np.array(region.view2d.view_to_region(0.0, 0.0, clip=False))
    unit = np.array(region.view2d.view_to_region(1.0, 1.0, clip=False)) - origin
    gpu.matrix.translate((*origin, 0.0))
    gpu.matrix.scale((*unit, 1.0))
