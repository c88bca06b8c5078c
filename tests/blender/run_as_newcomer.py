# SPDX-License-Identifier: GPL-3.0-or-later
"""The first session of a new user, in the window of this Blender, with mouse and keyboard: no line of Python.

    export BLENDER_USER_RESOURCES=EMPTY_FOLDER
    blender --factory-startup --enable-event-simulate --python-exit-code 1 --python run_as_newcomer.py -- ZIP REPORT.xml

Installs the zip, subdivides Blender's cube, marks four cones, unwraps, drags a cone, takes that back and makes the map
seamless. Exit code 0 only when all of it came out right, in less than three minutes; REPORT.xml is a junit report, and
beside it, in the folder pictures, is the screen after every step. ``test_in_blender.py --window`` in tools/packaging
does this.
"""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path

import bpy
import numpy as np
from mathutils import Vector

sys.path.append(str(Path(__file__).parent))
from run_in_blender import EXTENSION, install
from run_in_window import run
from scenes import UvMap, changed, marked, snapshot, uv_key
from windows import DRAWN, choose, click, done, drag, middle, move_to, place_of, press, running, take_picture, until

SECONDS = 180
# Of the eight corners of Blender's cube four that are no neighbors, all of them in sight, and where one is dragged.
CORNERS = ((1, -1, 1), (1, 1, -1), (-1, 1, 1), (-1, -1, -1))
TARGET = (1, -0.5, 0.5)
# Pixels from the cursor to the box in the operator's options, as they are opened.
SEAMLESS = (130, -120)


def vertex_at(place: tuple[float, float, float]) -> int:
    return min(cube().data.vertices, key=lambda vertex: (vertex.co - Vector(place)).length).index


def cube() -> bpy.types.Object:
    return bpy.data.objects["Cube"]


def first_session(package: Path) -> Iterator[float]:
    begin = time.monotonic()
    install(package)
    reports = import_module(f"{EXTENSION}.mesh.reports")
    yield DRAWN
    take_picture("1_installed")

    yield from press("TAB", middle())
    yield from until(lambda: cube().mode == "EDIT")
    yield from choose("F3", "subdivide")
    for _ in range(2):
        yield from press("R", middle(), shift=True)
        yield DRAWN
    for _ in range(6):
        yield from press("WHEELUPMOUSE", middle())
    yield DRAWN
    take_picture("2_subdivided")

    for number, corner in enumerate(CORNERS):
        yield from click(place_of(cube(), vertex_at(corner)), shift=number > 0)
    yield DRAWN
    take_picture("3_selected")
    yield from choose("RIGHTMOUSE", "mark cone")
    yield from until(lambda: done("MESH_OT_cone_mark"))
    take_picture("3_marked")
    cones = sorted(map(vertex_at, CORNERS))
    assert marked(cube()) == cones, (marked(cube()), cones)

    yield from press("A", middle())
    yield from choose("U", "from cones")
    yield from until(lambda: done("UV_OT_cone_unwrap"))
    take_picture("4_unwrapped")
    assert reports.find(cube().data).certificate is None
    before = snapshot(cube())
    yield from choose("U", "edit cones")
    yield from until(lambda: running("MESH_OT_cone_edit"))
    yield from drag(place_of(cube(), vertex_at(CORNERS[0])), place_of(cube(), vertex_at(TARGET)), 4)
    yield DRAWN
    take_picture("5_dragged")
    yield from press("RET", middle())
    yield from until(lambda: not running("MESH_OT_cone_edit"))
    assert marked(cube()) == sorted({*cones} - {vertex_at(CORNERS[0])} | {vertex_at(TARGET)})
    assert uv_key() in changed(before, snapshot(cube()))
    yield from press("Z", middle(), ctrl=True)
    yield DRAWN
    take_picture("6_undone")
    assert changed(before, snapshot(cube())) == set()

    yield from choose("U", "from cones")
    yield from move_to(middle())
    yield from press("F9", middle())
    yield DRAWN
    take_picture("7_options")
    yield from click(np.array(middle()) + SEAMLESS)
    yield from until(lambda: bpy.context.window_manager.operators[-1].properties.seamless)
    yield DRAWN
    take_picture("7_seamless")

    report, uv_map = reports.find(cube().data), UvMap(cube())
    assert report.certificate["error_texels"] == 0 == uv_map.tile_error()
    assert uv_map.islands() == 1 and not uv_map.flipped() and not report.flipped
    assert {turn for turn, _, _ in uv_map.crossings()} != {1}
    assert time.monotonic() - begin < SECONDS


def main() -> None:
    package, report = map(Path, sys.argv[sys.argv.index("--") + 1 :])
    os.environ["CONE_UNWRAP_EXTENSION"] = EXTENSION
    bpy.context.preferences.view.show_splash = False
    running = run({"test_first_session": first_session(package)}, report, False, SECONDS)
    bpy.app.timers.register(lambda: next(running), first_interval=1.0, persistent=True)


if __name__ == "__main__":
    main()
