# SPDX-License-Identifier: GPL-3.0-or-later
"""What tests in a window share: its parts, events as of a mouse and a keyboard, waiting, pictures.

Generators yield how many seconds Blender is to go on by itself.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import bpy
import numpy as np
from mathutils import Vector

Place = tuple[float, float]

STEP = 0.05
DRAWN = 0.8  # seconds, until what was opened is seen
PICTURES = "CONE_UNWRAP_PICTURES"
"""Names the folder for pictures of the screen; without it none are taken."""
DIGITS = ("ZERO", "ONE", "TWO", "THREE", "FOUR", "FIVE", "SIX", "SEVEN", "EIGHT", "NINE")
NAMES = {" ": "SPACE", **{str(digit): name for digit, name in enumerate(DIGITS)}}


def window() -> bpy.types.Window:
    return bpy.context.window_manager.windows[0]


def area(kind: str = "VIEW_3D") -> bpy.types.Area:
    return next(area for area in window().screen.areas if area.type == kind)


def region(kind: str = "WINDOW", within: str = "VIEW_3D") -> bpy.types.Region:
    return next(region for region in area(within).regions if region.type == kind)


def split_off_uv_editor() -> bpy.types.Area:
    """Half of the first 3D view as a UV editor; the other half stays what it is."""
    known = {one.as_pointer() for one in window().screen.areas}
    with bpy.context.temp_override(window=window(), area=area(), region=region()):
        bpy.ops.screen.area_split(direction="VERTICAL", factor=0.5)
    new = next(one for one in window().screen.areas if one.as_pointer() not in known)
    new.ui_type = "UV"
    return new


def running(idname: str) -> bool:
    """Whether a modal operator is."""
    return any(operator.bl_idname == idname for operator in window().modal_operators)


def until(condition: Callable[[], bool], seconds: float = 20.0) -> Iterator[float]:
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, f"waited {seconds} seconds in vain"
        yield STEP


def place_of(obj: bpy.types.Object, vertex: int, within: bpy.types.Region | None = None) -> Place:
    """Pixels of a vertex in the window; the mesh as it was when edit mode began.  within: by default the first view."""
    return place_at(obj.matrix_world @ obj.data.vertices[vertex].co, within)


def place_at(point: Vector, within: bpy.types.Region | None = None) -> Place:
    """Pixels of a point of the world in the window."""
    within = region() if within is None else within
    corner = within.data.perspective_matrix @ point.to_4d()
    across, up = np.array(corner.xy) / corner.w
    return within.x + round((across + 1) / 2 * within.width), within.y + round((up + 1) / 2 * within.height)


def event(key: str, value: str, place: Place | None = None, **keys: object) -> None:
    """keys: as ctrl=True, unicode="a"."""
    if place is not None:
        keys |= {"x": round(place[0]), "y": round(place[1])}
    window().event_simulate(type=key, value=value, **keys)


def move_to(place: Place) -> Iterator[float]:
    event("MOUSEMOVE", "NOTHING", place)
    yield STEP


def press(key: str, place: Place | None = None, unicode: str | None = None, **keys: bool) -> Iterator[float]:
    event(key, "PRESS", place, **keys, **({} if unicode is None else {"unicode": unicode}))
    event(key, "RELEASE", place, **keys)
    yield STEP


def click(place: Place, **keys: bool) -> Iterator[float]:
    yield from move_to(place)
    yield from press("LEFTMOUSE", place, **keys)


def drag(start: Place, end: Place, steps: int = 6) -> Iterator[float]:
    yield from move_to(start)
    event("LEFTMOUSE", "PRESS", start)
    for share in np.linspace(0, 1, steps + 1)[1:]:
        yield from move_to(np.array(start) + share * (np.array(end) - start))
    yield 0.2
    event("LEFTMOUSE", "RELEASE", end)
    yield STEP


def type_text(text: str, place: Place) -> Iterator[float]:
    for character in text:
        yield from press(NAMES.get(character, character.upper()), place, character)


def take_picture(name: str) -> None:
    """Of the screen as it is, as NAME.png in the folder for pictures."""
    folder = os.environ.get(PICTURES)
    # Blender's own screenshot is black on a virtual screen.
    if folder is None or shutil.which("import") is None:
        return
    Path(folder).mkdir(parents=True, exist_ok=True)
    subprocess.run(["import", "-window", "root", str(Path(folder, f"{name}.png"))], check=True)


def middle() -> tuple[float, float]:
    within = region()
    return within.x + within.width / 2, within.y + within.height / 2


def choose(key: str, entry: str, **keys: bool) -> Iterator[float]:
    """An entry of the menu that a key opens, found by typing."""
    yield from move_to(middle())
    yield from press(key, middle(), **keys)
    yield DRAWN
    if key != "F3":
        take_picture(f"menu_{key}")
        yield from press("SPACE", middle(), " ")
        yield DRAWN
    yield from type_text(entry, middle())
    yield DRAWN
    take_picture("choosing_" + entry.replace(" ", "_"))
    yield from press("RET", middle())
    yield DRAWN


def done(idname: str) -> bool:
    """Whether an operator was the last to be."""
    operators = bpy.context.window_manager.operators
    return bool(operators) and operators[-1].bl_idname == idname
