# SPDX-License-Identifier: GPL-3.0-or-later
"""Models with textures that have a direction: bricks, wood, cloth and stripes. Runs inside Blender.

Every texture repeats in its tile and has its upward direction along v.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import product
from types import ModuleType

import bpy
import demo_picture
import demo_scene
import numpy as np
from mathutils import Euler, Matrix
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

SEEN_FROM_A_CORNER = (Euler((np.radians(25), 0, 0)).to_matrix() @ Euler((0, 0, np.radians(20))).to_matrix()).to_4x4()
FROM_BEHIND = Matrix.Rotation(np.pi, 4, "Z")
BOX = ((0, 2, 6, 4), (1, 5, 7, 3), (0, 4, 5, 1), (2, 3, 7, 6), (0, 1, 3, 2), (4, 6, 7, 5))  # of corners by x, y, z
ANGLE_BAR = ((-0.45, -0.45), (0.45, -0.45), (0.45, -0.15), (-0.15, -0.15), (-0.15, 0.45), (-0.45, 0.45))
TILE = 0.3  # its length on the model
AROUND = 48
TEXELS = 256  # of a tile, both ways


def add_bricks(direction: str) -> None:
    """A wall, a house and a vase in a row, tiled with bricks whose upward direction is chosen so."""
    for x, add in ((-2.5, add_wall), (0.0, add_house), (2.5, add_vase)):
        obj = add()
        obj.data.materials.append(brick_material())
        press_tile(obj, direction)
        show(obj, x)


def add_textures(lsgp: ModuleType, by_blender: bool) -> None:
    """A wall of bricks, a wooden beam, a sleeve of cloth and a striped vase in a row, tiled along world Z.

    by_blender: instead with Blender's own unwrap through the same cuts, at the same texel density.
    """
    models: Sequence[tuple[Callable[[], bpy.types.Object], bpy.types.Material]] = (
        (add_wall, brick_material()),
        (add_beam, image_material("wood", wood)),
        (add_sleeve, image_material("cloth", cloth)),
        (add_vase, image_material("stripes", stripes)),
    )
    for x, (add, material) in zip((-2.9, -0.85, 0.85, 2.75), models, strict=True):
        obj = add()
        obj.data.materials.append(material)
        press_tile(obj, "Z")
        if by_blender:
            _, measured = demo_scene.measure(lsgp, obj)
            length = demo_picture.length_of_uv_unit(obj.data, demo_picture.read_uv(obj.data))
            tiled, obj = obj, demo_scene.add_copy_unwrapped_by_blender(obj, measured.cut_edges, "ANGLE_BASED")
            bpy.data.objects.remove(tiled)
            uv = demo_picture.read_uv(obj.data)
            uv *= demo_picture.length_of_uv_unit(obj.data, uv) / length
            obj.data.uv_layers.active.uv.foreach_set("vector", uv.astype(np.float32).ravel())
        obj.data.transform(FROM_BEHIND)  # where the cuts are
        show(obj, x, size=0.85)


def press_tile(obj: bpy.types.Object, direction: str) -> None:
    options = {"preset": "TILE", "tile_fit": "SIZE", "tile_size": TILE, "direction": direction}
    demo_scene.run_in_edit_mode(obj, bpy.ops.uv.cone_auto_unwrap, **options)


def show(obj: bpy.types.Object, x: float, size: float = 1.0) -> None:
    """Put the unwrapped object into the row."""
    obj.data.transform(SEEN_FROM_A_CORNER)
    obj.location, obj.scale = (x, -1.0, 0.0), (size, size, size)


def add_wall() -> bpy.types.Object:
    return add_solid("wall", list(product((-0.95, 0.95), (-0.2, 0.2), (-0.7, 0.7))), BOX)


def add_house() -> bpy.types.Object:
    bottom, _, *sides = BOX
    roof = [(1, 5, 9, 8), (3, 8, 9, 7)]
    gables = [(0, 1, 8, 3, 2), (4, 6, 7, 9, 5)]
    walls = [side for side in sides if len({corner // 4 for corner in side}) == 2]
    corners = [*product((-0.8, 0.8), (-0.6, 0.6), (-0.8, 0.2)), (-0.8, 0, 0.8), (0.8, 0, 0.8)]
    return add_solid("house", corners, [bottom, *walls, *roof, *gables])


def add_beam() -> bpy.types.Object:
    """An upright angle bar."""
    count = len(ANGLE_BAR)
    corners = [(x, y, z) for z in (-1.0, 1.0) for x, y in ANGLE_BAR]
    sides = [(k, (k + 1) % count, (k + 1) % count + count, k + count) for k in range(count)]
    return add_solid("beam", corners, [tuple(reversed(range(count))), *sides, tuple(range(count, 2 * count))])


def add_sleeve() -> bpy.types.Object:
    """A bent tube that gets narrower, open at both ends."""
    height = np.linspace(-1, 1, 25)
    return add_rings("sleeve", height, 0.42 - 0.1 * height, shift=0.3 * height**2 - 0.15)


def add_vase() -> bpy.types.Object:
    """Open at the top."""
    height = np.linspace(0, 2, 24)
    bottom = tuple(reversed(range(AROUND)))
    return add_rings("vase", height - 1, 0.45 + 0.22 * np.sin(2.2 * height) + 0.05 * height, bottom=[bottom])


def add_rings(
    name: str,
    height: FloatArray,
    radius: FloatArray,
    shift: FloatArray | float = 0.0,
    bottom: Sequence[tuple[int, ...]] = (),
) -> bpy.types.Object:
    """Rings of AROUND vertices above each other, joined by quads.  shift: of each ring along x."""
    turn = 2 * np.pi * np.arange(AROUND) / AROUND
    rings = radius[:, None, None] * np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=-1)
    rings += np.stack([shift + 0 * height, 0 * height, height], axis=-1)[:, None]
    index = np.arange(rings[..., 0].size).reshape(rings.shape[:2])
    right = np.roll(index, -1, axis=1)
    quads = np.stack([index[:-1], right[:-1], right[1:], index[1:]], axis=-1).reshape(-1, 4)
    obj = add_solid(name, rings.reshape(-1, 3).tolist(), [*quads.tolist(), *bottom])
    obj.data.shade_smooth()
    return obj


def add_solid(
    name: str, corners: Sequence[tuple[float, float, float]], faces: Sequence[Sequence[int]]
) -> bpy.types.Object:
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(corners, [], faces)
    demo_picture.add_object(name, mesh)
    return bpy.data.objects[name]


def brick_material() -> bpy.types.Material:
    """Two courses of bricks per unit of texture."""
    material, nodes, links = matte_material("bricks")
    courses = nodes.new("ShaderNodeTexBrick")
    sizes = {"Scale": 1.0, "Brick Width": 1.0, "Row Height": 0.5, "Mortar Size": 0.03}
    colors = {"Color1": (0.5, 0.12, 0.06, 1), "Color2": (0.35, 0.08, 0.04, 1), "Mortar": (0.7, 0.68, 0.6, 1)}
    for name, value in (sizes | colors).items():
        courses.inputs[name].default_value = value
    links.new(nodes.new("ShaderNodeUVMap").outputs["UV"], courses.inputs["Vector"])
    links.new(courses.outputs["Color"], nodes["Principled BSDF"].inputs["Base Color"])
    return material


def image_material(name: str, colors: Callable[[FloatArray, FloatArray], FloatArray]) -> bpy.types.Material:
    """colors: of places u, v in the unit square, (n, n) each, to (n, n, 3), display colors."""
    places = (np.arange(TEXELS) + 0.5) / TEXELS
    pixels = np.ones((TEXELS, TEXELS, 4), np.float32)
    pixels[..., :3] = colors(*np.meshgrid(places, places))
    image = bpy.data.images.new(name, TEXELS, TEXELS)
    image.pixels.foreach_set(pixels.ravel())
    material, nodes, links = matte_material(name)
    texture = nodes.new("ShaderNodeTexImage")
    texture.image = image
    links.new(nodes.new("ShaderNodeUVMap").outputs["UV"], texture.inputs["Vector"])
    links.new(texture.outputs["Color"], nodes["Principled BSDF"].inputs["Base Color"])
    return material


def matte_material(name: str) -> tuple[bpy.types.Material, bpy.types.Nodes, bpy.types.NodeLinks]:
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    material.node_tree.nodes["Principled BSDF"].inputs["Roughness"].default_value = 0.8
    return material, material.node_tree.nodes, material.node_tree.links


def wood(u: FloatArray, v: FloatArray) -> FloatArray:
    """Grain along v."""
    across = u + 0.02 * np.sin(2 * np.pi * v) + 0.01 * np.sin(2 * np.pi * (2 * v + 3 * u))
    grain = sum(np.sin(2 * np.pi * (waves * across + waves**2 / 7)) / waves**0.5 for waves in (2, 5, 9, 14, 23))
    share = np.clip(0.5 + 0.22 * grain, 0, 1)[..., None]
    return share * np.array([0.83, 0.63, 0.40]) + (1 - share) * np.array([0.50, 0.31, 0.15])


def cloth(u: FloatArray, v: FloatArray) -> FloatArray:
    """A tartan: threads along u and v, broad ones and narrow ones."""
    color = np.full((*u.shape, 3), (0.80, 0.78, 0.70))
    for across in (u, v):
        for middle, half, dye in ((0.30, 0.18, (0.16, 0.30, 0.36)), (0.75, 0.04, (0.70, 0.16, 0.14))):
            color[np.abs(across - middle) < half] *= 0.45
            color[np.abs(across - middle) < half] += 0.55 * np.array(dye)
    return color


def stripes(_: FloatArray, v: FloatArray) -> FloatArray:
    """Broad and narrow bands along u."""
    color = np.full((*v.shape, 3), (0.93, 0.91, 0.85))
    color[v < 0.4] = (0.13, 0.33, 0.47)
    color[np.abs(v - 0.7) < 0.05] = (0.80, 0.42, 0.18)
    return color
