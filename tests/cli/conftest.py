# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

import json
import os
from collections.abc import Callable
from pathlib import Path

import pytest
from command import Ended
from polygon_meshes import bumpy_ball, cube, cube_corners, obj_text
from this_process import run_command

SHARED = Path(os.environ.get("LSGP_SHARED") or Path(__file__).resolve().parents[3] / "shared")
# On all systems: an OBJ file keeps its own, and one made of another format ends lines so.
LINE_END = "\n"


@pytest.fixture
def lsgp(tmp_path: Path) -> Callable[..., Ended]:
    """Runs a command line in the test's folder, in this process."""

    def run(*arguments: object) -> Ended:
        done = run_command(tmp_path, *arguments)
        return Ended(done.returncode, done.stdout, done.stderr, tmp_path)

    return run


@pytest.fixture(scope="session")
def shared() -> Path:
    """The folder with meshes/ and bad/ beside the checkout; the tests that need it are skipped without it."""
    if not SHARED.is_dir():
        pytest.skip(f"no shared folder at {SHARED}")
    return SHARED


@pytest.fixture
def cube_files(tmp_path: Path) -> Path:
    """cube.obj of quads, its corners in corners.json."""
    positions, faces = cube(4)
    (tmp_path / "cube.obj").write_text(obj_text(positions / 3, faces), newline=LINE_END)
    (tmp_path / "corners.json").write_text(json.dumps({"cones": cube_corners(positions)}))
    return tmp_path


@pytest.fixture
def ball_files(tmp_path: Path) -> Path:
    """ball.obj, closed, curved everywhere, of quads; eight cones in cones.json."""
    positions, faces = bumpy_ball()
    (tmp_path / "ball.obj").write_text(obj_text(positions, faces), newline=LINE_END)
    (tmp_path / "cones.json").write_text(json.dumps({"cones": cube_corners(cube(6)[0])}))
    return tmp_path
