# SPDX-License-Identifier: GPL-3.0-or-later
"""`lsgp unwrap --picture`."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import lsgp as library
from command import Ended
from meshes import moebius_strip
from png_check import pixels_of


def test_draws_the_layout_that_is_written(cube_files: Path, lsgp: Callable[..., Ended]) -> None:
    done = lsgp("unwrap", "cube.obj", "-o", "out.obj", "--cones", "corners.json", "--picture", "layout.png")
    assert done.code == 0, done.err
    drawn = pixels_of((cube_files / "layout.png").read_bytes())
    surface = library.read_mesh_file(cube_files / "cube.obj").surface()
    cones = json.loads((cube_files / "corners.json").read_text())["cones"]
    costs = library.cut_costs(surface, (0, 0, 1))
    surface = library.Surface(surface.positions, surface.triangles, surface.edges, cut_costs=costs)
    expected = library.draw_layout(surface, library.parameterize(surface, cones))
    assert drawn.shape == (1024, 1024, 3)
    assert (drawn == expected).mean() > 0.999


def test_a_refused_mesh_has_no_picture(cube_files: Path, lsgp: Callable[..., Ended]) -> None:
    (cube_files / "one.json").write_text('{"cones": [0], "cone_angles": [1.0]}')
    done = lsgp("unwrap", "cube.obj", "-o", "out.obj", "--cones", "one.json", "--picture", "layout.png")
    assert done.code == 3
    assert not (cube_files / "layout.png").exists()


def test_the_name_of_a_picture_tells_what_it_is(cube_files: Path, lsgp: Callable[..., Ended]) -> None:
    before = sorted(path.name for path in cube_files.iterdir())
    for name in ("layout.svg", "layout", "-"):
        done = lsgp("unwrap", "cube.obj", "-o", "out.obj", "--picture", name)
        assert done.code == 2
        assert f"name it .png, not '{name}'" in done.err
    assert sorted(path.name for path in cube_files.iterdir()) == before


def test_faces_that_are_left_out_are_not_drawn(cube_files: Path, lsgp: Callable[..., Ended]) -> None:
    """Those of a Moebius strip beside the cube, which has no layout."""
    text = (cube_files / "cube.obj").read_text()
    first = sum(line.startswith("v ") for line in text.splitlines()) + 1
    strip = moebius_strip()
    text += "".join(f"v {x} {y} {z}\n" for x, y, z in strip.positions)
    text += "".join(f"f {a} {b} {c}\n" for a, b, c in (strip.triangles + first).tolist())
    (cube_files / "both.obj").write_text(text)
    pictures = []
    for name, code in (("cube", 0), ("both", 4)):
        files = ("-o", "out.obj", "--cones", "corners.json", "--cuts", "shortest", "--picture", f"{name}.png")
        assert lsgp("unwrap", f"{name}.obj", *files).code == code
        pictures.append(pixels_of((cube_files / f"{name}.png").read_bytes()))
    assert (pictures[0] == pictures[1]).mean() > 0.99
