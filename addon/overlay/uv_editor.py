# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws cuts and cones in UV editors, in the same colors as in 3D views."""

from __future__ import annotations

from functools import partial

import bpy
import gpu
import numpy as np
from numpy.typing import NDArray

from . import cache, colors, shaders
from .content import Content
from .look import ACTIVE_SIZE, OverlayLook, overlay_look
from .settings import settings


def draw() -> None:
    context = bpy.context
    chosen, space = settings(context), context.space_data
    if not (chosen.show and space.show_uvedit and space.overlay.show_overlays):
        return
    look = overlay_look()
    gpu.state.blend_set("ALPHA")
    with gpu.matrix.push_pop():
        _load_layout_space(context.region)
        draw_cuts = partial(_draw_cuts, by=chosen.cut_colors)
        for is_shown, draw_part in ((chosen.cuts, draw_cuts), (chosen.cones, _draw_cones)):
            for obj in context.objects_in_mode_unique_data if is_shown else ():
                draw_part(cache.entry(obj), look)
    gpu.state.blend_set("NONE")


def _draw_cuts(entry: cache.Entry, look: OverlayLook, by: str) -> None:
    if not len(entry.content.cut_uv):
        return
    shader = shaders.lines()
    shader.bind()
    shader.uniform_float("viewportSize", gpu.state.viewport_get()[2:])
    pixel = bpy.context.preferences.system.pixel_size
    for name, rows, size in entry.content.cut_widths():
        shader.uniform_float("lineWidth", size * look.line_width * pixel)
        entry.batch((f"layout of {name}", by), partial(_batch, entry.content, rows, look, by)).draw(shader)


def _draw_cones(entry: cache.Entry, look: OverlayLook) -> None:
    """Each where it is in the layout, which may be at several places."""
    content, pixel = entry.content, bpy.context.preferences.system.pixel_size
    if not len(content.cone_uv):
        return
    active = np.array([cone.vertex == content.active for cone in content.cones])[content.cone_rows]
    tints = colors.of_cones(content.cones, look)[content.cone_rows]
    places = np.c_[content.cone_uv, np.zeros(len(content.cone_uv))]
    gpu.state.program_point_size_set(True)
    shader = shaders.discs()
    for number, (rows, size) in enumerate(((~active, 1.0), (active, ACTIVE_SIZE))):
        if rows.any():
            batch = entry.batch(f"cones {number}", partial(shaders.disc_batch, places[rows], tints[rows]))
            shader.bind()
            shader.uniform_float("size", size * look.cone_size * pixel)
            batch.draw(shader)
    gpu.state.program_point_size_set(False)


def _batch(content: Content, rows: NDArray[np.bool_], look: OverlayLook, by: str) -> gpu.types.GPUBatch:
    segments = np.zeros((rows.sum(), 2, 3), np.float32)
    segments[..., :2] = content.cut_uv[rows]
    return shaders.line_batch(segments, colors.of_cuts(content, rows, look, by))


def _load_layout_space(region: bpy.types.Region) -> None:
    """Make the GPU's matrix map texture coordinates to pixels of the region."""
    origin = np.array(region.view2d.view_to_region(0.0, 0.0, clip=False))
    unit = np.array(region.view2d.view_to_region(1.0, 1.0, clip=False)) - origin
    gpu.matrix.translate((*origin, 0.0))
    gpu.matrix.scale((*unit, 1.0))
