# SPDX-License-Identifier: GPL-3.0-or-later
"""A mesh of triangles gets the same map from Blender as from the command line, up to the packing.

Polygons are divided by Blender in its own way there.
"""

from pathlib import Path

import bmesh
import bpy
import numpy as np
import pytest
from lsgp.cli import main
from scenes import UvMap, add_ball, add_cube, add_grid, add_ramp, add_sphere, add_tube, joined

pytestmark = pytest.mark.slow

# Of sides in a map of area 1: UVs are rounded to single precision.
TOLERANCE = 2e-6
MESHES = {
    "cube": add_cube,
    "sphere": add_sphere,
    "ball": lambda: unmarked(add_ball()),
    "tube": add_tube,
    "ramp": add_ramp,
    "two parts": lambda: joined(add_tube(), add_grid()),
}


def triangulated(obj: bpy.types.Object) -> bpy.types.Object:
    bm = bmesh.new()
    bm.from_mesh(obj.data)
    bmesh.ops.triangulate(bm, faces=bm.faces)
    bm.to_mesh(obj.data)
    bm.free()
    return obj


def unmarked(obj: bpy.types.Object) -> bpy.types.Object:
    obj.vertex_groups.clear()
    return obj


def text_of(obj: bpy.types.Object) -> str:
    lines = [f"v {' '.join(repr(float(x)) for x in v.co)}" for v in obj.data.vertices]
    lines += [f"f {' '.join(str(v + 1) for v in face.vertices)}" for face in obj.data.polygons]
    return "\n".join(lines) + "\n"


def sides(uv: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """(t, 3), the lengths of the sides of all triangles, in a map of area 1."""
    z = uv[triangles] @ (1, 1j)
    area = np.imag((z[:, 1] - z[:, 0]).conj() * (z[:, 2] - z[:, 0])).sum() / 2
    return np.abs(z - np.roll(z, 1, axis=1)) / np.sqrt(area)


def command_line_map(obj: bpy.types.Object, preset: str, folder: Path) -> np.ndarray:
    """UV of every loop."""
    (folder / "in.obj").write_text(text_of(obj))
    options = ["--preset", preset, "--front", "0", "-1", "0", "--up", "0", "0", "1"]
    assert main(["unwrap", str(folder / "in.obj"), "-o", str(folder / "out.obj"), *options]) == 0
    uv, loops = [], []
    for line in (folder / "out.obj").read_text().splitlines():
        kind, *fields = line.split() or [""]
        if kind == "vt":
            uv.append([float(x) for x in fields[:2]])
        elif kind == "f":
            loops += [int(field.split("/")[1]) - 1 for field in fields]
    return np.array(uv)[loops]


@pytest.mark.one_blender
@pytest.mark.parametrize("preset", ["PAINT", "TILE", "BAKE"])
@pytest.mark.parametrize("name", MESHES)
def test_blender_and_the_command_line(name: str, preset: str, tmp_path: Path) -> None:
    obj = triangulated(MESHES[name]())
    by_command = command_line_map(obj, preset.lower(), tmp_path)
    assert bpy.ops.uv.cone_auto_unwrap(preset=preset, direction="Z") == {"FINISHED"}
    found = UvMap(obj)
    assert np.abs(sides(by_command, found.triangles) - sides(found.uv, found.triangles)).max() < TOLERANCE
