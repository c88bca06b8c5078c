# SPDX-License-Identifier: GPL-3.0-or-later
"""The second demo's job inside Blender: seamless layouts beside Blender's own of the same cuts, drawn close over a cut.

Run by tools/demo --seamless, in the bpy module (python demo_seamless.py ...) or in a Blender (blender -b --python
demo_seamless.py -- ...). BLENDER_USER_RESOURCES must name a throw-away profile: the extension is installed there.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import bpy
import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))
sys.path.insert(0, str(Path(__file__).parent))
import demo_closeup
import demo_layout
import demo_picture
import demo_scene
import demo_texture
from bpy_program import run_as_program
from demo_table import MISMATCH, STRETCH, Column, table

MESHES = Path(__file__).resolve().parents[3] / "shared" / "meshes"
TEXTURE_SIZE = 1024
COLORS_OFF = Column(("colors off,", "of 255"), 0)
COLORS_OFF_MOST = Column(("at most,", "of 255"), 0)
COLUMNS = (STRETCH, MISMATCH, COLORS_OFF, COLORS_OFF_MOST)


@dataclass(frozen=True)
class Shape:
    """cones: how many are placed on each part, None for automatic. tiles: along the longer side of the layout.

    crease: edges bent by more are drawn sharp, radians.
    """

    name: str
    add: Callable[[], bpy.types.Object]
    cones: int | None
    tiles: float
    crease: float


def main() -> None:
    arguments = demo_scene.parse_arguments()
    lsgp = demo_scene.install_extension(arguments.extension)
    texture = demo_texture.pinwheels(TEXTURE_SIZE)
    material = demo_closeup.texture_material(texture)
    rows, maps, shots = [], [], []
    for shape in COLLECTION if MESHES.is_dir() else GENERATED:
        demo_scene.say(f"unwrapping the {shape.name}")
        ours = add(shape, material)
        count = {"automatic": True} if shape.cones is None else {"automatic": False, "count": shape.cones}
        demo_scene.run_in_edit_mode(ours, bpy.ops.mesh.cone_place, **count)
        demo_scene.run_in_edit_mode(ours, bpy.ops.uv.cone_unwrap, seamless=True, tile_fit="TILES", tiles=shape.tiles)
        _, measured = demo_scene.measure(lsgp, ours)
        cones = demo_scene.marked_cones(ours)
        maps.append((ours, measured.cut_edges, cones))
        view = demo_closeup.choose_view(ours, measured.cut_edges, cones)
        theirs = demo_scene.add_copy_unwrapped_by_blender(ours, measured.cut_edges, "ANGLE_BASED")
        demo_closeup.lay_alike(theirs, ours, view)
        shots.append((ours, demo_closeup.whole(ours, view), "whole"))
        for label, obj in (("seamless", ours), ("blender", theirs)):
            uv = demo_picture.read_uv(obj.data)[demo_closeup.sister_loops(obj.data, measured.cut_edges)]
            rows.append((f"{shape.name}, {label}", figures(demo_scene.measure(lsgp, obj)[1], uv, texture)))
            shots.append((obj, view, label))
    print("\n" + table("layout", COLUMNS, rows), end="\n\n", flush=True)
    for obj, cut_edges, cones in maps:
        drawing = arguments.out / f"seamless-map-{obj.name.lower()}.svg"
        demo_layout.write_layout(obj, cut_edges, cones, drawing)
        demo_scene.say(f"wrote the map, as a drawing: {drawing}")
    bpy.ops.wm.save_as_mainfile(filepath=str(arguments.out / "seamless.blend"))
    for number, (obj, view, label) in enumerate(shots):
        demo_scene.say(f"rendering picture {number + 1} of {len(shots)}")
        demo_closeup.render_view(obj, view, arguments.out / f"seamless-{number}-{label}.png", arguments.samples)


def add(shape: Shape, material: bpy.types.Material) -> bpy.types.Object:
    obj = shape.add()
    obj.name = shape.name
    obj.data.materials.clear()
    obj.data.materials.append(material)
    obj.data.shade_smooth()
    obj.data.set_sharp_from_angle(angle=shape.crease)
    return obj


def add_mesh(name: str) -> bpy.types.Object:
    """A mesh of the collection next to the checkout."""
    bpy.ops.wm.obj_import(filepath=str(MESHES / f"{name}.obj"), forward_axis="Y", up_axis="Z")
    return bpy.context.object


def add_fan() -> bpy.types.Object:
    """A sector of a fan's disk: a hub, a blade that gets thinner outwards, with sharp edges all around."""
    bpy.ops.mesh.primitive_cube_add(size=2.0)
    fan = bpy.context.object
    demo_scene.run_in_edit_mode(fan, bpy.ops.mesh.subdivide, number_cuts=23)
    for vertex in fan.data.vertices:
        x, y, z = vertex.co
        radius, angle = 2.0 + 1.2 * x, 0.9 * y
        thickness = 0.35 + 0.45 / (1 + np.exp(8 * (x + 0.35)))
        vertex.co = (radius * np.cos(angle), radius * np.sin(angle), thickness * z + 0.25 * x * x)
    return fan


def figures(measured, uv: np.ndarray, texture: np.ndarray) -> tuple[float, ...]:
    """Those of COLUMNS.  uv: both sides of every cut edge; colors are compared at nine points of each."""
    part = np.linspace(0, 1, 9)[:, None]
    places = uv[:, :, :1] * (1 - part) + uv[:, :, 1:] * part
    left, right = (demo_texture.bilinear(texture, side.reshape(-1, 2)) for side in places.transpose(1, 0, 2, 3))
    off = 255 * np.abs(right - left).max(axis=1)
    return measured.distortion.l2_stretch, measured.seams.sister_ratio_max - 1, off.mean(), off.max()


SHARP, ROUND = np.radians(35), np.pi
COLLECTION = (
    Shape("Fandisk", partial(add_mesh, "fandisk"), cones=18, tiles=24.0, crease=SHARP),
    Shape("Igea", partial(add_mesh, "igea-16k"), cones=10, tiles=28.0, crease=ROUND),
)
GENERATED = (
    Shape("Fan", add_fan, cones=18, tiles=24.0, crease=SHARP),
    Shape("Suzanne", partial(demo_scene.add_suzanne, subdivisions=2), cones=None, tiles=28.0, crease=ROUND),
)


if __name__ == "__main__":
    run_as_program(main)
