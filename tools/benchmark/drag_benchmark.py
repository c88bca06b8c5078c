# SPDX-License-Identifier: GPL-3.0-or-later
"""What a frame takes while a cone is dragged with Edit Cones, with a textured 3D view and a UV editor: a table.

    blender --factory-startup --enable-event-simulate --window-geometry 0 0 1280 860 \
        --python tools/benchmark/drag_benchmark.py -- --extension ZIP [--cuts N ...]

BLENDER_USER_RESOURCES must name a throw-away profile; without a screen run it under xvfb-run with
LIBGL_ALWAYS_SOFTWARE=1. The mesh is a cube that is subdivided and made round, with eight cones. Beside it stands what a
frame takes where a script moves one UV of the same mesh and nothing is solved. Large meshes have previews, which count
as solved like exact maps.
"""

from __future__ import annotations

import argparse
import math
import sys
import time
from collections import defaultdict
from collections.abc import Callable, Iterator
from importlib import import_module
from pathlib import Path

import bmesh
import bpy
import numpy as np
from bpy_extras.view3d_utils import location_3d_to_region_2d

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "pictures"))
import demo_scene
from blender_window import WAIT, areas, arrange, inside, region_of, run, window

FRAMES = 25
FIRST = 5  # frames before these are not counted
SECONDS = 60
RADIUS, TURN = 0.12, 0.35  # of the circle the cone is dragged on, in heights of the view, and radians of each move
COLUMNS = ("pick", "solve", "place", "write UVs", "overlay", "Blender", "frame")


class Stopwatch:
    """Milliseconds spent by name, frame by frame; a frame begins with `frame`."""

    def __init__(self) -> None:
        self.frames: list[dict[str, float]] = []
        self._begin = 0.0

    def watch(self, owner: object, method: str, name: str) -> None:
        call = getattr(owner, method)

        def watched(*arguments, **options):
            begin = time.perf_counter()
            try:
                return call(*arguments, **options)
            finally:
                if self.frames:
                    self.frames[-1][name] += 1e3 * (time.perf_counter() - begin)

        setattr(owner, method, watched)

    def frame(self) -> None:
        now = time.perf_counter()
        if self.frames:
            self.frames[-1]["frame"] = 1e3 * (now - self._begin)
        self._begin = now
        self.frames.append(defaultdict(float, begun=True))

    def medians(self) -> dict[str, float]:
        """Of the counted frames that have ended."""
        counted = self.frames[FIRST:-1]
        return {name: float(np.median([frame[name] for frame in counted])) for name in {*counted[0], *COLUMNS}}


def add_round_cube(cuts: int) -> tuple[bpy.types.Object, list[int]]:
    """In edit mode, with a checker; and its cones."""
    bpy.ops.mesh.primitive_cube_add()
    obj = bpy.context.object
    demo_scene.run_in_edit_mode(obj, bpy.ops.mesh.subdivide, number_cuts=cuts)
    demo_scene.run_in_edit_mode(obj, bpy.ops.transform.tosphere, value=1.0)
    demo_scene.run_in_edit_mode(obj, bpy.ops.mesh.cone_place, automatic=False, count=8)
    demo_scene.run_in_edit_mode(obj, bpy.ops.uv.cone_unwrap)
    bpy.ops.uv.cone_texture()
    cones = demo_scene.marked_cones(obj).tolist()
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="DESELECT")
    return obj, cones


def watch_tool(watch: Stopwatch) -> None:
    """The parts of a step. `solve` is within `place`, `write UVs` within `overlay`."""
    lsgp = import_module("lsgp")
    session = import_module(f"{demo_scene.ADDON}.jobs.sessions.cone_session")
    write = import_module(f"{demo_scene.ADDON}.mesh.uv_write")
    tool = import_module(f"{demo_scene.ADDON}.operators.cones.edit")
    watch.watch(import_module(f"{demo_scene.ADDON}.jobs.sessions.picking").Picker, "vertex_at", "pick")
    watch.watch(lsgp.Solver, "parameterize", "solve")
    watch.watch(lsgp.Preview, "parameterize", "solve")
    watch.watch(session.Step, "solve", "place")
    watch.watch(write.EditedUv, "write", "write UVs")
    watch.watch(session.ConeSession, "show", "overlay")
    watch.watch(tool, "session_content", "overlay")


def frames(watch: Stopwatch, move: Callable[[int], None], drawn: list[float], until: str = "begun") -> Iterator[float]:
    """Move once per frame of the 3D view, until enough frames are drawn; yields seconds to wait.

    until: a frame is one that is drawn after what has this name.
    """
    watch.frames.clear()
    end = time.monotonic() + SECONDS
    while len(watch.frames) <= FRAMES:
        watch.frame()
        move(len(watch.frames))
        drawn.clear()
        while not (drawn and until in watch.frames[-1]):
            if time.monotonic() > end:
                raise TimeoutError(f"only {len(watch.frames)} frames in {SECONDS} seconds")
            drawn.clear()
            # Blender handles the events and draws.
            yield 0.0


def measure(cuts: int, watch: Stopwatch, drawn: list[float]) -> Iterator[float]:
    """The rows of one mesh, printed; yields seconds to wait."""
    view, editor = areas("VIEW_3D")[0], areas("IMAGE_EDITOR")[0]
    with inside(view):
        if bpy.context.object is not None:
            bpy.ops.object.mode_set(mode="OBJECT")
        bpy.ops.object.select_all(action="SELECT")
        bpy.ops.object.delete()
        obj, cones = add_round_cube(cuts)
        view.spaces.active.shading.color_type = "TEXTURE"
        bpy.ops.view3d.view_axis(type="FRONT")
        bpy.ops.view3d.view_orbit(angle=0.5, type="ORBITRIGHT")
        bpy.ops.view3d.view_all()
    with inside(editor):
        bpy.ops.image.view_all(fit_view=True)
    yield 4 * WAIT
    bm = bmesh.from_edit_mesh(obj.data)
    bm.faces.ensure_lookup_table()
    uv = bm.faces[0].loops[0][bm.loops.layers.uv.active]

    def move_uv(frame: int) -> None:
        uv.uv.x += (-1) ** frame * 1e-3
        bmesh.update_edit_mesh(obj.data, loop_triangles=False, destructive=False)

    yield from frames(watch, move_uv, drawn)
    triangles = sum(len(face.verts) - 2 for face in bm.faces)
    print_row(triangles, "a script moves one UV", watch.medians())

    region = region_of(view)
    height = region.height
    middle = np.array([region.x + region.width / 2, region.y + height / 2])
    eye = view.spaces.active.region_3d.view_matrix.inverted().translation
    bm.verts.ensure_lookup_table()
    nearest = min((bm.verts[cone] for cone in cones), key=lambda vertex: (vertex.co - eye).length)
    start = np.array((region.x, region.y)) + location_3d_to_region_2d(region, view.spaces.active.region_3d, nearest.co)

    def event(kind: str, value: str, place: np.ndarray) -> None:
        window().event_simulate(type=kind, value=value, x=round(place[0]), y=round(place[1]))

    with inside(view):
        bpy.ops.mesh.cone_edit("INVOKE_DEFAULT")
    event("MOUSEMOVE", "NOTHING", start)
    yield WAIT
    event("LEFTMOUSE", "PRESS", start)
    yield WAIT

    def drag(frame: int) -> None:
        around = np.array([math.cos(TURN * frame), math.sin(TURN * frame)])
        event("MOUSEMOVE", "NOTHING", middle + RADIUS * height * around)

    yield from frames(watch, drag, drawn, "write UVs")
    event("LEFTMOUSE", "RELEASE", middle)
    event("ESC", "PRESS", middle)
    yield WAIT
    times = watch.medians()
    times["place"] -= times["solve"]
    times["overlay"] -= times["write UVs"]
    print_row(triangles, "a cone is dragged", times)


def print_row(triangles: int, what: str, times: dict[str, float]) -> None:
    times["Blender"] = times["frame"] - sum(times[name] for name in COLUMNS[:-2])
    cells = [f"{times[name]:.1f}" if times[name] >= 0.05 else "" for name in COLUMNS]
    print(f"| {triangles:,} | {what} | " + " | ".join(cells) + " |", flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--extension", type=Path, required=True, help="the extension's zip")
    parser.add_argument("--cuts", type=int, nargs="+", default=[40, 90], help="how often each side of the cube is cut")
    arguments = parser.parse_args(sys.argv[sys.argv.index("--") + 1 :])
    bpy.context.preferences.view.show_splash = False
    demo_scene.install_extension(arguments.extension)
    run(tables(arguments.cuts))


def tables(cuts: list[int]) -> Iterator[float]:
    yield from arrange(0.5)
    watch, drawn = Stopwatch(), []
    watch_tool(watch)
    region = region_of(areas("VIEW_3D")[0])
    bpy.types.SpaceView3D.draw_handler_add(lambda: drawn.append(time.perf_counter()), (), "WINDOW", "POST_PIXEL")
    print(f"\nMilliseconds, medians of {FRAMES - FIRST} frames; 3D view of {region.width} x {region.height} pixels\n")
    print("| triangles | | " + " | ".join(COLUMNS) + " |\n|--:|---|" + "--:|" * len(COLUMNS))
    for number in cuts:
        yield from measure(number, watch, drawn)


if __name__ == "__main__":
    main()
