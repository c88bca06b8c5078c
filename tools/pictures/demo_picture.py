# SPDX-License-Identifier: GPL-3.0-or-later
"""A picture of an unwrapped mesh: the checkered model and its UV layout side by side, rendered with Cycles.

The layout is built as a flat mesh with the model's own material, so texture, light and the colors of the cuts agree
between the two halves by themselves. Runs inside Blender.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from itertools import pairwise
from pathlib import Path

import bpy
import numpy as np
from mathutils import Euler

WIDTH = 1600  # pixels of the picture; half as high
# The picture plane is x-z, 8 x 4 units, the camera looks along +y; each half is 4 x 4 units.
MODEL_CENTER, MODEL_TURN, MODEL_SIZE = (-1.82, -2.6, 0.07), (np.radians(2), 0.0, np.radians(22)), 1.2
LAYOUT_CENTER, LAYOUT_SIZE = (2.02, 0.0, 0.0), (3.72, 3.6)
WALL_DEPTH = 0.09
BOUNCES = 2  # of light; further ones change pale matte surfaces by less than a shade
SQUARE = 0.11  # side of a checker square on the model, in units of the model
TUBE, BORDER_TUBE, CONE_BALL = 0.018, 0.010, 0.046

PAPER = (0.965, 0.955, 0.935)
LIGHT_SQUARE, DARK_SQUARE = (0.94, 0.92, 0.87), (0.47, 0.58, 0.66)
LIGHT_LINE, DARK_LINE = (0.84, 0.82, 0.77), (0.55, 0.655, 0.73)
BORDER_COLOR = (0.16, 0.18, 0.22)
CUT_COLORS = ("#d6336c", "#2b9348", "#7b4fc9", "#e3b505", "#12a0a0", "#c23fb5", "#87991a", "#3c9be0", "#8a5a3c")
POSITIVE_CONE, NEGATIVE_CONE = (0.93, 0.33, 0.10), (0.10, 0.30, 0.85)


def render_picture(
    model: bpy.types.Object, cut_edges: np.ndarray, cones: np.ndarray, path: Path, samples: int, width: int = WIDTH
) -> None:
    """Write the picture of `model`, as `compose` has it, to `path`.  width: pixels; it is half as high."""
    with empty_stage():
        compose(model, cut_edges, cones)
        render(path, samples, width, width // 2)


@contextmanager
def empty_stage() -> Iterator[None]:
    """Hides all objects from the renderer; afterward they are as they were, and those added since are gone."""
    hidden = {obj: obj.hide_render for obj in bpy.data.objects}
    for obj in hidden:
        obj.hide_render = True
    yield
    for obj in set(bpy.data.objects) - set(hidden):
        bpy.data.objects.remove(obj)
    for obj, was in hidden.items():
        obj.hide_render = was


def compose(model: bpy.types.Object, cut_edges: np.ndarray, cones: np.ndarray) -> None:
    """Build the scene around a copy of `model`, which has its checker.

    cut_edges: (c, 2) vertex pairs where the layout is open. cones: (k,) vertices.
    """
    import lsgp  # comes with the extension

    mesh = model.data
    uv = read_uv(mesh)
    board = layout_places(uv)
    shown = model.copy()
    shown.data = mesh.copy()
    shown.data.shade_smooth()
    shown.hide_render = False
    shown.location, shown.rotation_euler, shown.scale = MODEL_CENTER, MODEL_TURN, (MODEL_SIZE,) * 3
    bpy.context.collection.objects.link(shown)
    turn = MODEL_SIZE * np.array(Euler(MODEL_TURN).to_matrix())
    positions = np.array([vertex.co for vertex in mesh.vertices]) @ turn.T + MODEL_CENTER

    add_layout(mesh, uv, board)
    sides = Sides(mesh)
    for number, cut in enumerate(lsgp.split_into_paths(cut_edges, cones)):
        lines = [positions[cut], *(board[loops] for loops in sides.of_path(cut))]
        add_tubes(f"cut {number}", lines, TUBE, cut_color(number))
    borders = lsgp.split_into_paths(sides.border_edges(), cut_edges.ravel())
    lines = [positions[border] for border in borders]
    lines += [board[loops] for border in borders for loops in sides.of_path(border)]
    add_tubes("borders", lines, BORDER_TUBE, BORDER_COLOR)
    for cone in cones.tolist():
        places = np.vstack([positions[cone], board[sides.places(cone, uv)]])
        add_balls(places, cone_color(sides.curvature(cone, uv)))
    add_studio()


def add_checker(model: bpy.types.Object) -> None:
    """Give the model a checker as its only material, with squares of one size, regardless of the size of the layout."""
    mesh = model.data
    mesh.materials.clear()
    mesh.materials.append(checker_material(length_of_uv_unit(mesh, read_uv(mesh)) / SQUARE))


def read_uv(mesh: bpy.types.Mesh) -> np.ndarray:
    """(loops, 2) texture coordinates of the active layer."""
    uv = np.empty(2 * len(mesh.loops), np.float32)
    mesh.uv_layers.active.uv.foreach_get("vector", uv)
    return uv.reshape(-1, 2).astype(np.float64)


def length_of_uv_unit(mesh: bpy.types.Mesh, uv: np.ndarray) -> float:
    """Mean length on the model of one unit of texture."""
    mesh.calc_loop_triangles()
    loops = np.array([triangle.loops for triangle in mesh.loop_triangles])
    edge_a, edge_b = uv[loops[:, 1]] - uv[loops[:, 0]], uv[loops[:, 2]] - uv[loops[:, 0]]
    area = np.abs(edge_a[:, 0] * edge_b[:, 1] - edge_a[:, 1] * edge_b[:, 0]).sum() / 2
    return float(np.sqrt(sum(polygon.area for polygon in mesh.polygons) / area))


def layout_places(uv: np.ndarray) -> np.ndarray:
    """(loops, 3) where the corners of the layout lie in the picture."""
    low, high = uv.min(axis=0), uv.max(axis=0)
    flat = (uv - (low + high) / 2) * (np.array(LAYOUT_SIZE) / (high - low)).min()
    return np.column_stack([flat[:, 0], np.zeros(len(flat)), flat[:, 1]]) + LAYOUT_CENTER


class Sides:
    """Which loops lie on the two sides of every edge and around every vertex."""

    def __init__(self, mesh: bpy.types.Mesh) -> None:
        self.corners: dict[int, list[tuple[int, int, int]]] = {}
        self.halfedges: dict[tuple[int, int], tuple[int, int]] = {}
        vertex = [loop.vertex_index for loop in mesh.loops]
        for polygon in mesh.polygons:
            loops = list(polygon.loop_indices)
            for before, loop, after in zip(loops[-1:] + loops[:-1], loops, loops[1:] + loops[:1], strict=True):
                self.halfedges[vertex[loop], vertex[after]] = (loop, after)
                self.corners.setdefault(vertex[loop], []).append((before, loop, after))

    def border_edges(self) -> np.ndarray:
        return np.array([edge for edge in self.halfedges if edge[::-1] not in self.halfedges]).reshape(-1, 2)

    def of_path(self, path: np.ndarray) -> list[list[int]]:
        """The loops along the path's one or two sides."""
        sides = []
        for vertices in (path.tolist(), path[::-1].tolist()):
            pairs = [self.halfedges.get(edge) for edge in pairwise(vertices)]
            if None not in pairs:
                sides.append([pairs[0][0], *(end for _, end in pairs)])
        return sides

    def places(self, vertex: int, uv: np.ndarray) -> list[int]:
        """One loop for every position of a vertex in the layout."""
        return list({tuple(uv[loop].round(6)): loop for _, loop, _ in self.corners[vertex]}.values())

    def curvature(self, vertex: int, uv: np.ndarray) -> float:
        """A full turn minus the angles of the layout around a vertex, radians."""
        before, here, after = uv[np.array(self.corners[vertex])].transpose(1, 0, 2)
        ahead, back = after - here, before - here
        cross = ahead[:, 0] * back[:, 1] - ahead[:, 1] * back[:, 0]
        return float(2 * np.pi - np.arctan2(cross, (ahead * back).sum(axis=1)).sum())


def cut_color(number: int) -> tuple[float, float, float]:
    """The colors in turn, every second cycle as tints."""
    turn, place = divmod(number, len(CUT_COLORS))
    full = np.array([int(CUT_COLORS[place][k : k + 2], 16) / 255 for k in (1, 3, 5)])
    return tuple(1 - (0.55 if turn % 2 else 1.0) * (1 - full))


def cone_color(curvature: float) -> tuple[float, float, float]:
    """From nearly white without curvature to full color at half a turn: warm if positive, cold if negative."""
    full = np.array(POSITIVE_CONE if curvature > 0 else NEGATIVE_CONE)
    share = min(1.0, 0.45 + 0.55 * abs(curvature) / np.pi)
    return tuple(1 - share * (1 - full))


def linear(color: tuple[float, float, float]) -> tuple[float, float, float, float]:
    """A display color in linear light, as Cycles expects it."""
    return (*(c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in color), 1.0)


def plain_material(name: str, color: tuple[float, float, float], roughness: float = 0.5) -> bpy.types.Material:
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    shader = material.node_tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = linear(color)
    shader.inputs["Roughness"].default_value = roughness
    return material


def checker_material(repeat: float) -> bpy.types.Material:
    """A two-tone checker with finer lines; `repeat` squares to one unit of texture."""
    size, fine = 512, 4
    index = np.arange(2 * size) % size
    to_line = np.abs((index / size * fine + 0.5) % 1.0 - 0.5) / fine
    on_line = to_line < 0.012
    line = on_line[:, None] | on_line[None, :]
    cell = np.arange(2 * size) // size
    dark = (cell[:, None] + cell[None, :]) % 2 == 1
    tile = np.where(dark[..., None], DARK_SQUARE, LIGHT_SQUARE)
    tile = np.where(line[..., None], np.where(dark[..., None], DARK_LINE, LIGHT_LINE), tile)
    pixels = np.ones((2 * size, 2 * size, 4), np.float32)
    pixels[..., :3] = tile
    image = bpy.data.images.new("checker", 2 * size, 2 * size)
    image.pixels.foreach_set(pixels.ravel())
    image.pack()

    material = plain_material("checker", LIGHT_SQUARE, roughness=0.55)
    nodes, links = material.node_tree.nodes, material.node_tree.links
    coordinate, mapping, texture = (
        nodes.new(kind) for kind in ("ShaderNodeTexCoord", "ShaderNodeMapping", "ShaderNodeTexImage")
    )
    mapping.inputs["Scale"].default_value = (repeat / 2, repeat / 2, 1)
    texture.image = image
    links.new(coordinate.outputs["UV"], mapping.inputs["Vector"])
    links.new(mapping.outputs["Vector"], texture.inputs["Vector"])
    links.new(texture.outputs["Color"], nodes["Principled BSDF"].inputs["Base Color"])
    return material


def add_object(name: str, data: bpy.types.ID) -> bpy.types.Object:
    added = bpy.data.objects.new(name, data)
    bpy.context.collection.objects.link(added)
    return added


def add_layout(mesh: bpy.types.Mesh, uv: np.ndarray, board: np.ndarray) -> None:
    """The layout as a mesh of loose polygons in the picture plane."""
    layout = bpy.data.meshes.new("layout")
    layout.from_pydata(board.tolist(), [], [list(polygon.loop_indices) for polygon in mesh.polygons])
    corner = np.array([loop.vertex_index for loop in layout.loops])
    layout.uv_layers.new().uv.foreach_set("vector", uv[corner].astype(np.float32).ravel())
    layout.materials.append(mesh.materials[0])
    shown = add_object("layout", layout)
    # Where the layout overlaps itself its faces coincide and must not shade each other; a copy behind casts the shadow.
    shown.visible_shadow = shown.visible_diffuse = shown.visible_glossy = False
    add_object("layout shadow", layout).location.y = WALL_DEPTH / 4


def add_tubes(name: str, lines: list[np.ndarray], radius: float, color: tuple[float, float, float]) -> None:
    curve = bpy.data.curves.new(name, "CURVE")
    curve.dimensions, curve.bevel_depth, curve.bevel_resolution, curve.use_fill_caps = "3D", radius, 3, True
    for line in lines:
        spline = curve.splines.new("POLY")
        spline.points.add(len(line) - 1)
        spline.points.foreach_set("co", np.column_stack([line, np.ones(len(line))]).astype(np.float32).ravel())
    curve.materials.append(plain_material(name, color))
    add_object(name, curve)


def add_balls(places: np.ndarray, color: tuple[float, float, float], radius: float = CONE_BALL) -> None:
    material = plain_material("cone", color, roughness=0.25)
    for place in places:
        bpy.ops.mesh.primitive_uv_sphere_add(radius=radius, location=place, segments=32, ring_count=16)
        bpy.ops.object.shade_smooth()
        bpy.context.object.data.materials.append(material)


def add_studio() -> None:
    """A pale wall behind both halves, soft light from the upper left, a long lens in front."""
    bpy.ops.mesh.primitive_plane_add(size=60, location=(0, WALL_DEPTH, 0), rotation=(np.pi / 2, 0, 0))
    bpy.context.object.data.materials.append(plain_material("wall", PAPER, roughness=1.0))
    add_light(0.5, (("key", (5, -12, 9), 7, 1250), ("fill", (-9, -12, 2), 10, 450)))
    add_camera(lens=120, distance=8 * 120 / 36)


def add_light(strength: float, lamps: tuple[tuple[str, tuple[float, float, float], float, float], ...]) -> None:
    """A pale sky and lamps that shine at the origin; name, place, size and power of each."""
    world = bpy.data.worlds.new("studio")
    world.use_nodes = True
    world.node_tree.nodes["Background"].inputs["Color"].default_value = linear((0.97, 0.98, 1.0))
    world.node_tree.nodes["Background"].inputs["Strength"].default_value = strength
    bpy.context.scene.world = world
    for name, place, size, power in lamps:
        lamp = bpy.data.lights.new(name, "AREA")
        lamp.size, lamp.energy = size, power
        added = add_object(name, lamp)
        added.location = place
        added.rotation_euler = (-added.location).to_track_quat("-Z", "Y").to_euler()


def add_camera(lens: float, distance: float) -> None:
    """Looks along +y at the origin; the picture is 36 * distance / lens units wide there."""
    camera = bpy.data.cameras.new("camera")
    camera.lens, camera.sensor_width, camera.sensor_fit = lens, 36, "HORIZONTAL"
    added = add_object("camera", camera)
    added.location = (0, -distance, 0)
    added.rotation_euler = (np.pi / 2, 0, 0)
    bpy.context.scene.camera = added


def render(path: Path, samples: int, width: int, height: int) -> None:
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.device, scene.cycles.samples, scene.cycles.seed = "CPU", samples, 0
    scene.cycles.max_bounces = scene.cycles.diffuse_bounces = BOUNCES
    try:
        scene.cycles.use_denoising = True
        scene.cycles.denoiser = "OPENIMAGEDENOISE"
        # Colors and normals, which guide it, are free of noise after a few samples; to denoise them, too, takes as long
        # as seven samples.
        scene.cycles.denoising_prefilter = "FAST"
    except TypeError:  # this build has no denoiser: more samples instead
        scene.cycles.use_denoising, scene.cycles.samples = False, 4 * samples
    scene.render.dither_intensity = 0  # flat areas stay flat, which halves the file
    scene.view_settings.view_transform = "Standard"
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = width, height, 100
    scene.render.image_settings.file_format = "PNG"
    scene.render.image_settings.color_mode, scene.render.image_settings.compression = "RGBA", 100
    scene.render.filepath = str(path)
    bpy.ops.render.render(write_still=True)
