# SPDX-License-Identifier: GPL-3.0-or-later
"""A textured model seen close over a cut of its layout, rendered with Cycles. Runs inside Blender."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import bpy
import demo_picture
import numpy as np
from mathutils import Euler, Matrix
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

CLOSE_SIZE, WHOLE_SIZE = (520, 390), (312, 390)
# The picture plane is x-z through the focus, this many pixels a unit; the camera looks along +y.
PIXELS, LENS = 173, 85
TILES_SEEN = 5.0  # from side to side of a close-up
TILT = (np.radians(12), 0.0, np.radians(15))  # of the model, so that it is not seen flat from the front
LAMPS = (("key", (-5, -7, 6), 4, 700), ("fill", (8, -8, 1), 8, 250))
BEAD, BEAD_STEP, BEAD_COLOR = 0.023, 0.24, (0.93, 0.05, 0.52)


@dataclass(frozen=True)
class View:
    """The position and size of a close-up.

    focus: (3,) a place on the model. rotation: (3, 3) from the model's axes to the picture's. width: of the frame, in
    units of the model. path: vertices of the cut that is pointed out. vertex: the one of them at the focus.
    size: of the picture, pixels.
    """

    focus: FloatArray
    rotation: FloatArray
    width: float
    path: NDArray[np.integer]
    vertex: int
    size: tuple[int, int]


def choose_view(model: bpy.types.Object, cut_edges: np.ndarray, cones: np.ndarray) -> View:
    """At a rotated cut through an even part of the surface, away from other cuts and from its own ends."""
    import lsgp  # comes with the extension

    mesh = model.data
    positions, normals = vectors(mesh.vertices, "co"), vectors(mesh.vertices, "normal")
    uv = demo_picture.read_uv(mesh)
    width = TILES_SEEN * demo_picture.length_of_uv_unit(mesh, uv)

    def view_of(path: NDArray[np.integer], vertex: int) -> tuple[float, View]:
        focus = positions[vertex]
        others = np.append(np.setdiff1d(cut_edges, path[1:-1]), path[[0, -1]])
        alone = np.linalg.norm(positions[others] - focus, axis=1).min() / width
        toward = normals[np.linalg.norm(positions - focus, axis=1) < width / 3].mean(axis=0)
        evenness = np.linalg.norm(toward)
        near = positions[path][np.linalg.norm(positions[path] - focus, axis=1) < width / 3]
        rotation = facing(toward / evenness, near[-1] - near[0])
        return evenness + 0.5 * min(alone, 0.5), View(focus, rotation, width, path, vertex, CLOSE_SIZE)

    views = []
    for path in lsgp.split_into_paths(cut_edges, cones):
        left, right = np.diff(uv[sister_loops(mesh, path[None, :2])[0]], axis=1)[:, 0]
        if left @ right <= 0:
            views += [view_of(path, vertex) for vertex in path[1:-1].tolist()]
    views.sort(key=lambda view: -view[0])
    return next(view for _, view in views if is_open(model, view))


def is_open(model: bpy.types.Object, view: View) -> bool:
    """Whether the view's focus is seen and not hidden by other parts of the model."""
    away = 10 * view.width * view.rotation[1]
    seen, where, _, _ = model.ray_cast((view.focus - away).tolist(), away.tolist())
    return seen and np.linalg.norm(np.array(where) - view.focus) < 0.05 * view.width


def whole(model: bpy.types.Object, view: View) -> View:
    """The whole model from the side of a view."""
    rotation = facing(-view.rotation[1], np.array([0.0, 0.0, 1.0]))
    turn = tilted(rotation)
    seen = vectors(model.data.vertices, "co") @ turn.T
    low, high = seen.min(axis=0), seen.max(axis=0)
    across, _, up = high - low
    width = 1.25 * float(max(across, up * WHOLE_SIZE[0] / WHOLE_SIZE[1]))  # near parts look larger
    return replace(view, focus=turn.T @ (low + high) / 2, rotation=rotation, width=width, size=WHOLE_SIZE)


def tilted(rotation: FloatArray) -> FloatArray:
    return np.array(Euler(TILT).to_matrix()) @ rotation


def facing(toward: FloatArray, up: FloatArray) -> FloatArray:
    """The rotation that turns `toward` to the camera and `up`, or its opposite, upwards; higher points stay higher."""
    up = up - toward * (up @ toward)
    up *= np.copysign(1, up[2]) / np.linalg.norm(up)
    return np.array([np.cross(up, toward), -toward, up])


def vectors(elements, name: str) -> FloatArray:
    """(n, 3) of a Blender collection."""
    values = np.empty(3 * len(elements), np.float32)
    elements.foreach_get(name, values)
    return values.reshape(-1, 3).astype(np.float64)


def sister_loops(mesh: bpy.types.Mesh, edges: np.ndarray) -> NDArray[np.integer]:
    """(edges, 2, 2): the loops at both ends of each edge, in the faces left and right of it."""
    halfedges = demo_picture.Sides(mesh).halfedges
    return np.array([(halfedges[a, b], halfedges[b, a][::-1]) for a, b in edges.tolist()])


def lay_alike(layout: bpy.types.Object, model: bpy.types.Object, view: View) -> None:
    """Move, turn and scale a layout as a whole to the size of the model's texels, and to those left of the cut."""
    mesh = layout.data
    uv, wanted = (demo_picture.read_uv(obj.data) @ (1, 1j) for obj in (layout, model))
    at = view.path.tolist().index(view.vertex)
    left = sister_loops(mesh, np.stack([view.path[at - 1 : at + 1], view.path[at : at + 2]], axis=1))[:, 0].ravel()
    here, there = uv[left].mean(), wanted[left].mean()
    turn = ((wanted[left] - there) * (uv[left] - here).conj()).sum()
    size = [demo_picture.length_of_uv_unit(obj.data, demo_picture.read_uv(obj.data)) for obj in (layout, model)]
    placed = (uv - here) * turn / abs(turn) * size[0] / size[1] + there
    mesh.uv_layers.active.uv.foreach_set(
        "vector", np.stack([placed.real, placed.imag], axis=1).astype(np.float32).ravel()
    )


def texture_material(texture: FloatArray) -> bpy.types.Material:
    """The texture, one tile per unit of texture coordinates."""
    size = len(texture)
    pixels = np.ones((size, size, 4), np.float32)
    pixels[..., :3] = texture
    image = bpy.data.images.new("pinwheels", size, size)
    image.pixels.foreach_set(pixels.ravel())
    image.pack()
    material = demo_picture.plain_material("pinwheels", (1.0, 1.0, 1.0))
    nodes, links = material.node_tree.nodes, material.node_tree.links
    node = nodes.new("ShaderNodeTexImage")
    node.image = image
    links.new(node.outputs["Color"], nodes["Principled BSDF"].inputs["Base Color"])
    return material


def render_view(model: bpy.types.Object, view: View, path: Path, samples: int) -> None:
    """Write a picture of the model alone, without background, with beads along the cut; leaves the scene as it was."""
    frame = view.size[0] / PIXELS
    turn = frame / view.width * tilted(view.rotation)
    line = (vectors(model.data.vertices, "co")[view.path] - view.focus) @ turn.T
    with demo_picture.empty_stage():
        shown = model.copy()
        shown.hide_render = False
        shown.matrix_world = Matrix(turn.tolist()).to_4x4() @ Matrix.Translation((-view.focus).tolist())
        bpy.context.collection.objects.link(shown)
        demo_picture.add_balls(places_along(line, BEAD_STEP), BEAD_COLOR, BEAD)
        demo_picture.add_light(0.6, LAMPS)
        demo_picture.add_camera(LENS, frame * LENS / 36)
        bpy.context.scene.render.film_transparent = True
        demo_picture.render(path, samples, *view.size)


def places_along(line: FloatArray, step: float) -> FloatArray:
    """Points on a polyline, (n, 3) to (k, 3), at equal steps."""
    length = np.append(0.0, np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1)))
    at = np.arange(step / 2, length[-1], step)
    return np.stack([np.interp(at, length, column) for column in line.T], axis=1)
