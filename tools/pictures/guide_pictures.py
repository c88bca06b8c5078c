# SPDX-License-Identifier: GPL-3.0-or-later
"""The pictures of the guide: paper with darts; cubes, heads and machine parts unwrapped; textures. Runs inside Blender.

Run by tools/demo --guide, like demo_scene.py; leaves guide-NAME-NUMBER.png, to be put together by guide_sheet.py.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from types import ModuleType

import bpy
import numpy as np
from mathutils import Euler
from numpy.typing import NDArray

sys.path.insert(0, str(Path(__file__).parents[1]))
sys.path.insert(0, str(Path(__file__).parent))
import demo_picture
import demo_scene
import guide_textures
from bpy_program import run_as_program

FloatArray = NDArray[np.float64]

WIDTH = 1000  # pixels of a picture; half as high
RINGS, STEPS = 30, 240
RADIUS, SQUARES = 1.35, 7.0  # of a sheet of paper, and checker squares along it
FLAT_PLACE, FLAT_TILT = (-2.1, -2.0, 0.0), np.radians(62)  # toward the camera
BENT_PLACE, BENT_TILT = (1.8, -2.0, 0.3), np.radians(32)
EDGE_COLOR = "#d6336c"
TEETH = 12
GEAR = ((0.4, -0.25), (1.3, -0.25), (1.3, 0.25), (0.4, 0.25))  # profiles: radius and height
FLANGE = ((0.35, -0.6), (1.2, -0.6), (1.2, -0.35), (0.6, -0.35), (0.6, 0.8), (0.35, 0.8))
SEEN_FROM_ABOVE = (Euler((np.radians(50), 0, 0)).to_matrix() @ Euler((0, 0, np.radians(20))).to_matrix()).to_4x4()


def main() -> None:
    arguments = demo_scene.parse_arguments()
    lsgp = demo_scene.install_extension(arguments.extension)
    for number, draw in enumerate((dart, inset)):
        empty_scene()
        draw()
        demo_picture.add_studio()
        demo_picture.render(arguments.out / f"guide-cone-{number}.png", arguments.samples, WIDTH, WIDTH // 2)
    unwrapped = {
        "cube": [(add_cube, {"count": 8}, {}), (add_rounded_cube, {"count": 8}, {})],
        "count": [(add_suzanne, {"count": 4}, {}), (add_suzanne, {"count": 14}, {})],
        "stretch": [(add_suzanne, {"count": 8}, {}), (add_suzanne, {"count": 8}, {"mode": "LOW_STRETCH"})],
    }
    for name, pictures in unwrapped.items():
        for number, (add, place, options) in enumerate(pictures):
            empty_scene()
            obj = add()
            demo_scene.run_in_edit_mode(obj, bpy.ops.mesh.cone_place, automatic=False, **place)
            demo_scene.run_in_edit_mode(obj, bpy.ops.uv.cone_unwrap, **options)
            take_picture(lsgp, obj, arguments.out / f"guide-{name}-{number}.png", arguments.samples)
    for number, add in enumerate((add_gear, add_flange)):
        empty_scene()
        obj = add()
        demo_scene.run_in_edit_mode(obj, bpy.ops.uv.cone_auto_unwrap, mark=True)
        take_picture(lsgp, obj, arguments.out / f"guide-hard-{number}.png", arguments.samples)
    rows = {
        "bricks": (partial(guide_textures.add_bricks, "FIT"), partial(guide_textures.add_bricks, "Z")),
        "textures": (partial(guide_textures.add_textures, lsgp, by_blender) for by_blender in (True, False)),
    }
    for name, pictures in rows.items():
        for number, add_row in enumerate(pictures):
            empty_scene()
            add_row()
            demo_picture.add_studio()
            demo_picture.render(arguments.out / f"guide-{name}-{number}.png", arguments.samples, WIDTH, WIDTH // 2)


def take_picture(lsgp: ModuleType, obj: bpy.types.Object, path: Path, samples: int) -> None:
    """Render an object and its map."""
    _, measured = demo_scene.measure(lsgp, obj)
    distortion = measured.distortion
    print(f"{path.stem}: L2 {distortion.l2_stretch:.3f}, QC {distortion.quasi_conformal:.3f}", flush=True)
    demo_picture.add_checker(obj)
    demo_picture.render_picture(obj, measured.cut_edges, demo_scene.marked_cones(obj), path, samples, WIDTH)


def empty_scene() -> None:
    for data in (bpy.data.objects, bpy.data.meshes, bpy.data.materials):
        for item in list(data):
            data.remove(item)


def add_suzanne() -> bpy.types.Object:
    """The head alone, without its loose eyes."""
    demo_scene.add_suzanne(subdivisions=2)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.separate(type="LOOSE")
    bpy.ops.object.mode_set(mode="OBJECT")
    *eyes, head = sorted(bpy.data.objects, key=lambda obj: len(obj.data.vertices))
    for eye in eyes:
        bpy.data.objects.remove(eye)
    return head


def add_cube() -> bpy.types.Object:
    """Seen from a corner."""
    cube = subdivided_cube()
    cube.data.transform(guide_textures.SEEN_FROM_A_CORNER)
    return cube


def subdivided_cube() -> bpy.types.Object:
    bpy.ops.mesh.primitive_cube_add(size=1.6)
    cube = bpy.context.object
    demo_scene.run_in_edit_mode(cube, bpy.ops.mesh.subdivide, number_cuts=7)
    return cube


def add_rounded_cube() -> bpy.types.Object:
    """A cube that is swollen on one side, all edges rounded."""
    cube = subdivided_cube()
    for vertex in cube.data.vertices:
        x, y, z = vertex.co
        if y < 0:
            vertex.co.y -= 0.5 * np.exp(-6 * (x * x + z * z))
    smooth = cube.modifiers.new("Smooth", "SMOOTH")
    smooth.iterations = 6
    bpy.ops.object.modifier_apply(modifier="Smooth")
    cube.modifiers.new("Subdivision", "SUBSURF").levels = 1
    bpy.ops.object.modifier_apply(modifier="Subdivision")
    cube.data.transform(guide_textures.SEEN_FROM_A_CORNER)
    return cube


def add_gear() -> bpy.types.Object:
    """A wheel with square teeth and a bore."""
    is_gap = np.arange(4 * TEETH) % 4 >= 2
    return add_turned("gear", GEAR, 4 * TEETH, lambda radius: np.where(is_gap & (radius > 1), 0.78, 1.0))


def add_flange() -> bpy.types.Object:
    """A pipe with a collar at its foot."""
    return add_turned("flange", FLANGE, 64, lambda _: np.ones(64))


def add_turned(
    name: str, profile: Sequence[tuple[float, float]], around: int, factor: Callable[[float], FloatArray]
) -> bpy.types.Object:
    """A closed profile turned about an axis.  factor: of a radius at each of the angles."""
    turn = 2 * np.pi * np.arange(around) / around
    rings = [
        np.stack(
            [radius * factor(radius) * np.cos(turn), radius * factor(radius) * np.sin(turn), 0 * turn + z], axis=-1
        )
        for radius, z in profile
    ]
    index = np.arange(len(profile) * around).reshape(len(profile), around)
    right, up = np.roll(index, -1, axis=1), np.roll(index, -1, axis=0)
    quads = np.stack([index, right, np.roll(up, -1, axis=1), up], axis=-1).reshape(-1, 4)
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(np.concatenate(rings).tolist(), [], quads.tolist())
    mesh.transform(SEEN_FROM_ABOVE)
    demo_picture.add_object(name, mesh)
    return bpy.data.objects[name]


def dart() -> None:
    """A sheet without a quarter, flat and closed to a cone of 270 degrees."""
    angle, curvature = 1.5 * np.pi, 0.5 * np.pi
    slope = angle / (2 * np.pi)

    def cone(radius: FloatArray, turn: FloatArray) -> FloatArray:
        around = turn / slope
        height = -np.sqrt(1 - slope**2)
        return radius[..., None] * np.stack(
            [slope * np.cos(around), slope * np.sin(around), np.full_like(around, height)], axis=-1
        )

    add_sheet("flat", angle, flat, FLAT_PLACE, FLAT_TILT, turn=3 * np.pi / 4, curvature=curvature)
    add_sheet("cone", angle, cone, np.add(BENT_PLACE, (0, 0, 0.2)), BENT_TILT, np.radians(-65), curvature=curvature)


def inset() -> None:
    """A sheet that is slit and a quarter to be inserted, flat and as a saddle of 450 degrees."""
    angle, curvature = 2.5 * np.pi, -0.5 * np.pi
    around = np.linspace(0, 2 * np.pi, 4001)

    def curve(height: float) -> FloatArray:
        rise = height * np.cos(2 * around)
        return np.stack([np.cos(rise) * np.cos(around), np.cos(rise) * np.sin(around), np.sin(rise)], axis=-1)

    def lengths(height: float) -> FloatArray:
        return np.append(0, np.cumsum(np.linalg.norm(np.diff(curve(height), axis=0), axis=1)))

    low, high = 0.0, 1.2
    for _ in range(50):
        height = (low + high) / 2
        low, high = (low, height) if lengths(height)[-1] > angle else (height, high)
    along, places = lengths(height), curve(height)

    def saddle(radius: FloatArray, turn: FloatArray) -> FloatArray:
        at = np.stack([np.interp(turn, along * angle / along[-1], column) for column in places.T], axis=-1)
        return radius[..., None] * at

    add_sheet(
        "flat", 2 * np.pi, flat, np.add(FLAT_PLACE, (-0.2, 0, -0.35)), FLAT_TILT, turn=np.pi / 4, curvature=curvature
    )
    add_sheet("quarter", np.pi / 2, flat, np.add(FLAT_PLACE, (0.86, 0, 0.59)), FLAT_TILT, turn=0.0, curvature=curvature)
    add_sheet("saddle", angle, saddle, BENT_PLACE, BENT_TILT, np.radians(-25), curvature=curvature)


def flat(radius: FloatArray, turn: FloatArray) -> FloatArray:
    return np.stack([radius * np.cos(turn), radius * np.sin(turn), 0 * radius], axis=-1)


def add_sheet(
    name: str,
    angle: float,
    bend: Callable[[FloatArray, FloatArray], FloatArray],
    place: FloatArray,
    tilt: float,
    turn: float,
    curvature: float,
) -> None:
    """A sector of a disk with a checker, bent without stretching it, its two straight edges colored.

    bend: radius and angle in the sheet, (n,) each, to (n, 3). turn: about the sheet's upright axis. tilt: of that axis
    to the camera.
    """
    steps = int(STEPS * angle / (2 * np.pi))
    turns = np.linspace(0, angle, steps + 1)
    radii = np.linspace(0, RADIUS, RINGS + 1)
    radius, around = (grid.ravel() for grid in np.meshgrid(radii, turns))
    rotation = np.array(Euler((tilt, 0, 0)).to_matrix() @ Euler((0, 0, turn)).to_matrix())
    places = bend(radius, around) @ rotation.T + place
    index = np.arange(len(radius)).reshape(steps + 1, RINGS + 1)
    quads = np.stack([index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1]], axis=-1).reshape(-1, 4)
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(places.tolist(), [], quads.tolist())
    in_sheet = flat(radius, around)[:, :2] / RADIUS * SQUARES + 0.5
    corner = np.array([loop.vertex_index for loop in mesh.loops])
    mesh.uv_layers.new().uv.foreach_set("vector", in_sheet[corner].astype(np.float32).ravel())
    mesh.materials.append(demo_picture.checker_material(1.0))
    demo_picture.add_object(name, mesh)
    mesh.shade_smooth()
    edge = tuple(int(EDGE_COLOR[k : k + 2], 16) / 255 for k in (1, 3, 5))
    demo_picture.add_tubes(f"{name} edges", [places[index[0]], places[index[-1]]], demo_picture.TUBE, edge)
    apex = places[index[0, 0]]
    demo_picture.add_balls(apex[None], demo_picture.cone_color(curvature))


if __name__ == "__main__":
    run_as_program(main)
