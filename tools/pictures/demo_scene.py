# SPDX-License-Identifier: GPL-3.0-or-later
"""The demo's job inside Blender: unwrap subdivided Suzanne by one press of Auto Unwrap, measure, draw, save, render.

Run by tools/demo, in the bpy module (python demo_scene.py ...) or in a Blender (blender -b --python demo_scene.py --
...). BLENDER_USER_RESOURCES must name a throw-away profile: the extension is installed there.
"""

from __future__ import annotations

import argparse
import importlib
import os
import sys
from pathlib import Path

import bpy
import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))
sys.path.insert(0, str(Path(__file__).parent))
import demo_layout
import demo_picture
from bpy_program import run_as_program
from demo_table import ANGLES, AREA, CUT_LENGTH, FLIPPED, ISLANDS, MISMATCH, OVERLAPPING, STRETCH, table

ADDON = "bl_ext.user_default.cone_unwrap"
CONE_GROUP = "uv_cones"
BLENDER_METHODS = {"CONFORMAL": "Conformal", "ANGLE_BASED": "Angle Based", "MINIMUM_STRETCH": "Minimum Stretch"}
COLUMNS = (ISLANDS, CUT_LENGTH, STRETCH, ANGLES, AREA, MISMATCH, FLIPPED, OVERLAPPING)


def main() -> None:
    arguments = parse_arguments()
    lsgp = install_extension(arguments.extension)
    suzanne = unwrapped_suzanne()
    say("pressing Blender's Smart UV Project")
    projected = add_copy(suzanne)
    run_in_edit_mode(projected, bpy.ops.uv.smart_project)
    (surface, ours), (_, theirs) = measure(lsgp, suzanne), measure(lsgp, projected)

    rows = [("Auto Unwrap", figures(ours, suzanne)), ("Smart UV Project", figures(theirs, projected))]
    for method, label in BLENDER_METHODS.items():
        if method in bpy.ops.uv.unwrap.get_rna_type().properties["method"].enum_items:
            say(f"unwrapping by Blender's {label}, through the cuts of Auto Unwrap")
            rows.append((f"{label}, same cuts", unwrapped_by_blender(lsgp, suzanne, ours.cut_edges, method)))
    print(
        f"\nSuzanne, {len(surface.triangles):,} triangles, as she is in the scene: no cones, no seams "
        f"(Blender {bpy.app.version_string})\n"
    )
    print(table("method", COLUMNS, rows), end="\n\n", flush=True)

    drawing = arguments.out / "suzanne-map.svg"
    demo_layout.write_layout(suzanne, ours.cut_edges, marked_cones(suzanne), drawing)
    say(f"wrote the map, as a drawing: {drawing}")
    for obj in (suzanne, projected):
        demo_picture.add_checker(obj)
    bpy.ops.wm.save_as_mainfile(filepath=str(arguments.out / "suzanne.blend"))
    no_cones = np.empty(0, np.int32)
    for number, (obj, found, cones) in enumerate(
        ((suzanne, ours, marked_cones(suzanne)), (projected, theirs, no_cones))
    ):
        say(f"rendering picture {number + 1} of 2")
        path = arguments.out / f"suzanne-{number}.png"
        demo_picture.render_picture(obj, found.cut_edges, cones, path, arguments.samples)


def say(step: str) -> None:
    """Print the next step, which tools/demo shows until the following one."""
    print(f"   {step}", flush=True)


def unwrapped_suzanne() -> bpy.types.Object:
    """The model of the picture: subdivided Suzanne after one press of Auto Unwrap, its cones marked."""
    suzanne = add_suzanne(subdivisions=2)
    say("pressing Auto Unwrap")
    run_in_edit_mode(suzanne, bpy.ops.uv.cone_auto_unwrap, mark=True)
    return suzanne


def parse_arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--extension", type=Path, required=True, help="the extension's zip")
    parser.add_argument("--out", type=Path, required=True, help="folder for the scene and the picture")
    parser.add_argument("--samples", type=int, default=12, help="samples a pixel of the picture")
    own = sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else sys.argv[1:]
    return parser.parse_args(own)


def install_extension(archive: Path):
    """Install the zip as a user would, leave an empty scene with it enabled, and return the lsgp it brought."""
    bpy.ops.extensions.package_install_files(filepath=str(archive), repo="user_default", enable_on_install=True)
    if ADDON not in bpy.context.preferences.addons:
        raise SystemExit(f"demo: Blender did not enable {archive}; the lines above say why")
    lsgp = importlib.import_module("lsgp")
    if not Path(lsgp.__file__).is_relative_to(os.environ["BLENDER_USER_RESOURCES"]):
        raise SystemExit(
            f"demo: lsgp came from {lsgp.__file__} and not from the extension; remove it from Python's path"
        )
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    bpy.ops.preferences.addon_enable(module=ADDON)  # the factory settings have dropped it
    return lsgp


def add_suzanne(subdivisions: int) -> bpy.types.Object:
    bpy.ops.mesh.primitive_monkey_add()
    suzanne = bpy.context.object
    suzanne.modifiers.new("Subdivision", "SUBSURF").levels = subdivisions
    bpy.ops.object.modifier_apply(modifier="Subdivision")
    return suzanne


def run_in_edit_mode(obj: bpy.types.Object, operator, **properties: object) -> None:
    """Run an operator on the whole mesh as from edit mode; one that does not finish is an error."""
    bpy.context.view_layer.objects.active = obj
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    answer = operator(**properties)
    bpy.ops.object.mode_set(mode="OBJECT")
    if answer != {"FINISHED"}:
        raise SystemExit(f"demo: {operator.idname()} did not finish; the lines above say why")


def marked_cones(obj: bpy.types.Object) -> np.ndarray:
    """Vertices with a weight above 0.5 in the group of the cones."""
    group = obj.vertex_groups[CONE_GROUP].index
    return np.array(
        [v.index for v in obj.data.vertices if any(g.group == group and g.weight > 0.5 for g in v.groups)], np.int32
    )


def measure(lsgp, obj: bpy.types.Object):
    """The mesh as a surface of the library, and its active UV layer measured by it."""
    mesh = obj.data
    mesh.calc_loop_triangles()
    positions = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.vertices.foreach_get("co", positions)
    triangles, loops = (np.empty(3 * len(mesh.loop_triangles), np.int32) for _ in range(2))
    mesh.loop_triangles.foreach_get("vertices", triangles)
    mesh.loop_triangles.foreach_get("loops", loops)
    uv = np.empty(2 * len(mesh.loops), np.float32)
    mesh.uv_layers.active.uv.foreach_get("vector", uv)
    surface = lsgp.Surface(positions.reshape(-1, 3).astype(np.float64), triangles.reshape(-1, 3))
    corner_uv = uv.reshape(-1, 2)[loops].reshape(-1, 3, 2).astype(np.float64)
    return surface, lsgp.measure_distortion(surface, corner_uv)


def unwrapped_by_blender(lsgp, obj: bpy.types.Object, cut_edges: np.ndarray, method: str) -> tuple[float, ...]:
    """The figures of Blender's unwrap of the mesh with seams on the given cuts."""
    copy = add_copy_unwrapped_by_blender(obj, cut_edges, method)
    found = figures(measure(lsgp, copy)[1], copy)
    bpy.data.meshes.remove(copy.data)
    bpy.context.view_layer.objects.active = obj
    return found


def add_copy_unwrapped_by_blender(obj: bpy.types.Object, cut_edges: np.ndarray, method: str) -> bpy.types.Object:
    """A copy of the object with seams on the given cuts, unwrapped by Blender."""
    copy = add_copy(obj)
    cuts = {frozenset(edge) for edge in cut_edges.tolist()}
    for edge in copy.data.edges:
        edge.use_seam = frozenset(edge.vertices) in cuts
    run_in_edit_mode(copy, bpy.ops.uv.unwrap, method=method)
    return copy


def add_copy(obj: bpy.types.Object) -> bpy.types.Object:
    """A copy of the object with a mesh of its own, nothing else selected."""
    bpy.ops.object.select_all(action="DESELECT")
    copy = obj.copy()
    copy.data = obj.data.copy()
    bpy.context.collection.objects.link(copy)
    return copy


def figures(measured, obj: bpy.types.Object) -> tuple[float, ...]:
    """Those of COLUMNS; distortions are means over the triangles, the mismatch is the worst of all cut edges."""
    places = np.array([vertex.co for vertex in obj.data.vertices])
    cut_length = np.linalg.norm(np.diff(places[measured.cut_edges], axis=1), axis=2).sum()
    islands, d, mismatch = len(np.unique(measured.island)), measured.distortion, measured.seams.sister_ratio_max - 1
    distortions = (d.l2_stretch, d.quasi_conformal, d.area)
    return (islands, cut_length, *distortions, mismatch, len(measured.flipped), overlapping_faces(obj))


def overlapping_faces(obj: bpy.types.Object) -> int:
    """How many faces lie on others in the active UV layer, as Blender sees it."""
    settings = bpy.context.scene.tool_settings
    was_synchronized = settings.use_uv_select_sync
    settings.use_uv_select_sync = True  # the faces of the mesh are selected
    run_in_edit_mode(obj, bpy.ops.uv.select_overlap)
    settings.use_uv_select_sync = was_synchronized
    return sum(polygon.select for polygon in obj.data.polygons)


if __name__ == "__main__":
    run_as_program(main)
