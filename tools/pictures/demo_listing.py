# SPDX-License-Identifier: GPL-3.0-or-later
"""The pictures of the page on extensions.blender.org: an icon, and the model of the examples beside its layout.

Run by tools/demo --listing, like demo_scene.py; leaves listing-icon.png and listing-featured.png.
"""

from __future__ import annotations

import sys
from pathlib import Path

import bpy
import numpy as np
from mathutils import Matrix

sys.path.insert(0, str(Path(__file__).parents[1]))
sys.path.insert(0, str(Path(__file__).parent))
import demo_picture
import demo_scene
from bpy_program import run_as_program

MODEL = Path(__file__).resolve().parents[2] / "examples" / "model.obj"
LENGTH = 2.6  # of the model in the picture, in its units
FEATURED = (1920, 1080)  # pixels, as the platform wants them
ICON = (256, 256)
ICON_WIDTH = 3.2  # of the part that the icon shows, in units of the picture


def main() -> None:
    arguments = demo_scene.parse_arguments()
    lsgp = demo_scene.install_extension(arguments.extension)
    duck = add_model()
    demo_scene.say("pressing Auto Unwrap")
    demo_scene.run_in_edit_mode(duck, bpy.ops.uv.cone_auto_unwrap, mark=True)
    _, measured = demo_scene.measure(lsgp, duck)
    demo_picture.add_checker(duck)
    duck.hide_render = True
    demo_picture.compose(duck, measured.cut_edges, demo_scene.marked_cones(duck))
    demo_scene.say("rendering the featured picture")
    demo_picture.render(arguments.out / "listing-featured.png", arguments.samples, *FEATURED)
    demo_scene.say("rendering the icon")
    look_at_the_model()
    demo_picture.render(arguments.out / "listing-icon.png", arguments.samples, *ICON)


def add_model() -> bpy.types.Object:
    """The duck with smooth shading, centered, scaled and turned for the picture."""
    bpy.ops.wm.obj_import(filepath=str(MODEL))
    duck = bpy.context.object
    bpy.ops.object.transform_apply()
    duck.modifiers.new("Subdivision", "SUBSURF").levels = 1
    bpy.ops.object.modifier_apply(modifier="Subdivision")
    places = np.array([vertex.co for vertex in duck.data.vertices])
    low, high = places.min(axis=0), places.max(axis=0)
    duck.data.transform(Matrix.Translation(-(low + high) / 2))
    duck.data.transform(Matrix.Scale(LENGTH / (high - low).max(), 4))
    duck.data.transform(Matrix.Rotation(np.radians(20), 4, "Z"))
    return duck


def look_at_the_model() -> None:
    """Points the camera at the left half of the picture."""
    camera = bpy.context.scene.camera
    camera.location.x, _, camera.location.z = demo_picture.MODEL_CENTER
    distance = demo_picture.MODEL_CENTER[1] - camera.location.y
    camera.data.lens = camera.data.sensor_width * distance / ICON_WIDTH


if __name__ == "__main__":
    run_as_program(main)
