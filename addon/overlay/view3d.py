# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws the overlay in 3D views."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from functools import partial
from itertools import pairwise

import bpy
import gpu
import numpy as np
from mathutils import Matrix
from numpy.typing import NDArray

from ..core.identifiers import DISTORTION_ATTRIBUTES
from ..core.screen import Screen
from ..mesh import distortion
from ..mesh.reader import reader
from . import cache, colors, labels, shaders
from .content import Content, texture_axes
from .heat import SCALES
from .look import ACTIVE_SIZE, OverlayLook, overlay_look
from .settings import ConeUnwrapOverlay, settings

# How much nearer the overlay is drawn, relative to depth, as Blender does for wires; faces stay behind those.
NEARER_PERSPECTIVE, NEARER_PARALLEL = 0.0025, 1e-5
FACES_NEARER = 0.2
PAINTING = "PAINT_TEXTURE"

Draw = Callable[[bpy.types.Object, ConeUnwrapOverlay, OverlayLook], None]

# By session_uid of the mesh and name of the places in its content, for the view being drawn: (k, 3) their pixels and
# depths in the region, and (k,) which of them are visible.
_seen: dict[tuple[int, str], tuple[NDArray[np.float32], NDArray[np.bool_]]] = {}


def shown_objects(context: bpy.types.Context) -> list[bpy.types.Object]:
    """Visible objects with meshes in edit mode, the one that is painted, or else the selected ones; each mesh once in
    edit mode."""
    if context.mode == "EDIT_MESH":
        objects = context.objects_in_mode_unique_data
    elif context.mode == "OBJECT":
        objects = [obj for obj in context.selected_objects if obj.type == "MESH"]
    elif context.mode == PAINTING:
        objects = [context.object]
    else:
        objects = []
    return [obj for obj in objects if obj.visible_get(viewport=context.space_data)]


def draw_in_scene() -> None:
    context = bpy.context
    chosen, space = settings(context), context.space_data
    if not (chosen.show and space.overlay.show_overlays):
        return
    see_through = space.shading.type == "WIREFRAME" or space.shading.show_xray
    gpu.state.depth_test_set("NONE" if see_through else "LESS_EQUAL")
    gpu.state.blend_set("ALPHA")
    try:
        _seen.clear()
        if context.mode == PAINTING:
            # Anything else would hide what is painted.
            _draw_each(context, _draw_cuts, 1.0)
            return
        for name, is_chosen in (("cone_places", chosen.cones), ("missed_places", chosen.up)):
            if is_chosen:
                _find_seen(context, name, see_through=see_through)
        for draw, share in (
            (_draw_faces, FACES_NEARER),
            (_draw_cuts, 1.0),
            (_draw_directions, 1.0),
            (_draw_cones, 1.0),
        ):
            _draw_each(context, draw, share)
    finally:
        gpu.state.depth_test_set("NONE")
        gpu.state.depth_mask_set(False)
        gpu.state.blend_set("NONE")


def _draw_each(context: bpy.types.Context, draw: Draw, share: float) -> None:
    with _brought_nearer(context.region_data, share):
        for obj in shown_objects(context):
            with gpu.matrix.push_pop():
                gpu.matrix.multiply_matrix(obj.matrix_world)
                draw(obj, settings(context), overlay_look())


def draw_on_top() -> None:
    context = bpy.context
    chosen = settings(context)
    if context.mode == PAINTING or not (chosen.show and context.space_data.overlay.show_overlays):
        return
    objects = shown_objects(context)
    gpu.state.blend_set("ALPHA")
    for obj in objects:
        _draw_labels(context, obj, chosen)
    measure = chosen.distortion.lower()
    if measure in SCALES and any(_heat_batch(cache.entry(obj), obj, measure) for obj in objects):
        _draw_scale(context, measure)
    gpu.state.blend_set("NONE")


def _draw_faces(obj: bpy.types.Object, chosen: ConeUnwrapOverlay, look: OverlayLook) -> None:
    entry = cache.entry(obj)
    measure = chosen.distortion.lower()
    heat = _heat_batch(entry, obj, measure) if measure in SCALES else None
    if heat is not None:
        heat.draw(shaders.triangles())
    for name in ("overlapping", "flipped"):
        corners = getattr(entry.content, name)
        if getattr(chosen, name) and len(corners):
            entry.batch(name, partial(_face_batch, corners, getattr(look, name))).draw(shaders.triangles())


def _draw_cuts(obj: bpy.types.Object, chosen: ConeUnwrapOverlay, look: OverlayLook) -> None:
    entry = cache.entry(obj)
    content, pixel = entry.content, bpy.context.preferences.system.pixel_size
    if chosen.cuts and len(content.cut_lines):
        shader = shaders.lines()
        shader.bind()
        shader.uniform_float("viewportSize", gpu.state.viewport_get()[2:])
        for name, rows, size in content.cut_widths():
            shader.uniform_float("lineWidth", size * look.line_width * pixel)
            build = partial(_cut_batch, content, rows, look, chosen.cut_colors)
            entry.batch((name, chosen.cut_colors), build).draw(shader)


def _draw_directions(obj: bpy.types.Object, chosen: ConeUnwrapOverlay, look: OverlayLook) -> None:
    entry, pixel = cache.entry(obj), bpy.context.preferences.system.pixel_size
    batches = []
    if chosen.axes:
        batches += [entry.batch(name, partial(_axis_batch, obj, number)) for number, name in enumerate(("u", "v"))]
    if chosen.up and (len(entry.content.up_lines) or len(entry.content.along_lines)):
        batches.append(entry.batch("up", partial(_arrow_batch, entry.content, look)))
    shader = shaders.lines()
    shader.bind()
    shader.uniform_float("viewportSize", gpu.state.viewport_get()[2:])
    shader.uniform_float("lineWidth", look.line_width * pixel)
    for batch in batches:
        batch.draw(shader)


def _arrow_batch(content: Content, look: OverlayLook) -> gpu.types.GPUBatch:
    lines = np.concatenate([content.up_lines, content.along_lines])
    return shaders.line_batch(lines, colors.repeated(look.up, len(lines)))


def _axis_batch(obj: bpy.types.Object, number: int) -> gpu.types.GPUBatch:
    """number: 0 for u, 1 for v."""
    lines, theme = texture_axes(reader(obj.data))[number], bpy.context.preferences.themes[0].user_interface
    color = (theme.axis_x, theme.axis_y)[number]
    return shaders.line_batch(lines, colors.repeated((*color, 1.0), len(lines)))


def _draw_cones(obj: bpy.types.Object, chosen: ConeUnwrapOverlay, look: OverlayLook) -> None:
    """Discs are drawn entirely or not at all; a depth test would let inclined surfaces cut through them."""
    entry = cache.entry(obj)
    content, pixel = entry.content, bpy.context.preferences.system.pixel_size
    _, seen = _seen.get((obj.data.session_uid, "cone_places"), (None, None))
    if not chosen.cones or seen is None:
        return
    tints = entry.batch("tints", partial(colors.of_cones, content.cones, look))
    active = np.array([cone.vertex == content.active for cone in content.cones])
    depth = gpu.state.depth_test_get()
    gpu.state.depth_test_set("NONE")
    gpu.state.program_point_size_set(True)
    shader = shaders.discs()
    for rows, size in ((seen & ~active, 1.0), (seen & active, ACTIVE_SIZE)):
        if rows.any():
            shader.bind()
            shader.uniform_float("size", size * look.cone_size * pixel)
            shaders.disc_batch(content.cone_places[rows], tints[rows]).draw(shader)
    gpu.state.program_point_size_set(False)
    gpu.state.depth_test_set(depth)


def _face_batch(corners: NDArray[np.float32], color: Sequence[float]) -> gpu.types.GPUBatch:
    return shaders.triangle_batch(corners, colors.repeated(color, len(corners)))


def _cut_batch(content: Content, rows: NDArray[np.bool_], look: OverlayLook, by: str) -> gpu.types.GPUBatch:
    return shaders.line_batch(content.cut_lines[rows], colors.of_cuts(content, rows, look, by))


def _heat_batch(entry: cache.Entry, obj: bpy.types.Object, measure: str) -> gpu.types.GPUBatch | None:
    """None where no distortion was measured, or that of another UV map."""

    def build() -> gpu.types.GPUBatch | None:
        if not distortion.is_current(obj.data):
            return None
        mesh = reader(obj.data)
        values = mesh.face_values(DISTORTION_ATTRIBUTES[measure])
        if values is None:
            return None
        triangles, faces = mesh.drawn_triangles()
        return shaders.triangle_batch(mesh.all_positions()[triangles], SCALES[measure].colors_of(values[faces]))

    return entry.batch(measure, build)


def _find_seen(context: bpy.types.Context, name: str, *, see_through: bool) -> None:
    """Find where these places of each mesh are in the region, and which of them are visible."""
    region, view = context.region, context.region_data
    found = [(obj, getattr(cache.entry(obj).content, name)) for obj in shown_objects(context)]
    matrix = _nearer(view, 1.0) @ view.view_matrix
    for obj, places in found:
        if not len(places):
            continue
        part = Screen(np.array(matrix @ obj.matrix_world, np.float64), region.width, region.height).pixels(places)
        shown = np.isfinite(part).all(axis=1)
        if not see_through:
            shown &= part[:, 2] <= labels.depths(part, region.width, region.height)
        _seen[obj.data.session_uid, name] = part, shown


def _draw_labels(context: bpy.types.Context, obj: bpy.types.Object, chosen: ConeUnwrapOverlay) -> None:
    """The angles of visible cones, and by how much the map misses visible directions drawn on the mesh."""
    content, look, system = cache.entry(obj).content, overlay_look(), context.preferences.system
    wanted = []
    if chosen.cones and chosen.angles:
        wanted.append(("cone_places", [labels.label(cone) for cone in content.cones], 0.5 * look.cone_size + 3))
    if chosen.up:
        wanted.append(("missed_places", [f"{labels.in_degrees(angle)} off" for angle in content.missed_by], 3))
    texts, offsets, places = [], [], [np.empty((0, 3), np.float32)]
    for name, of_places, offset in wanted:
        pixels, seen = _seen.get((obj.data.session_uid, name), (None, None))
        if pixels is not None:
            texts += [text for text, show in zip(of_places, seen, strict=True) if show]
            places.append(pixels[seen])
            offsets += [offset * system.pixel_size] * len(places[-1])
    labels.draw_labels(texts, np.concatenate(places), offsets, round(look.text_size * system.ui_scale), look.text)


def _draw_scale(context: bpy.types.Context, measure: str) -> None:
    """A bar with the colors of the scale at the bottom left, and what they mean."""
    scale, look = SCALES[measure], overlay_look()
    pixel = context.preferences.system.ui_scale
    size = round(look.text_size * pixel)
    left = labels.BAR_MARGIN * pixel + sum(
        region.width for region in context.area.regions if region.type == "TOOLS" and region.alignment == "LEFT"
    )
    low = labels.BAR_MARGIN * pixel + 1.5 * size
    edges = left + np.linspace(0, labels.BAR_WIDTH * pixel, 65)
    values = scale.least * (scale.most / scale.least) ** np.linspace(0, 1, 64)
    high = low + labels.BAR_HEIGHT * pixel
    corners = np.concatenate([labels.rectangle(a, low, b, high) for a, b in pairwise(edges)])
    bar = shaders.triangle_batch(corners, np.repeat(scale.colors_of(values), 2, axis=0))
    bar.draw(shaders.triangles())
    labels.draw_scale_texts(scale, (left, low), pixel, size, look.text)


@contextmanager
def _brought_nearer(view: bpy.types.RegionView3D, share: float) -> Iterator[None]:
    with gpu.matrix.push_pop_projection():
        gpu.matrix.load_projection_matrix(_nearer(view, share))
        yield


def _nearer(view: bpy.types.RegionView3D, share: float) -> Matrix:
    """The view's projection with slightly smaller depths, so that the surface does not hide what lies on it."""
    projection = view.window_matrix.copy()
    if view.is_perspective:
        projection[2][3] *= 1 + share * NEARER_PERSPECTIVE
    else:
        projection[2][3] -= share * NEARER_PARALLEL * view.view_distance
    return projection
