# SPDX-License-Identifier: GPL-3.0-or-later
"""The wheel and the extension under test, built once, and the Python with bpy they are tried in.

LSGP_WHEEL names a wheel to use instead of building one, BPY_PYTHON a Python with bpy (default: this one, if it has
bpy). CONE_UNWRAP_REQUIRE_BLENDER=1 makes it an error that there is no Blender to test in.
"""

import importlib.util
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from blenders import RealBlender, leave_out, real_blenders

ROOT = Path(__file__).resolve().parents[2]


def python_with_bpy() -> str | None:
    """Path of a Python that can import bpy, None where there is none."""
    if "BPY_PYTHON" in os.environ:
        return os.environ["BPY_PYTHON"]
    return sys.executable if importlib.util.find_spec("bpy") else None


@pytest.fixture(scope="session", params=real_blenders() or [None], ids=lambda found: found.name if found else "none")
def real_blender(request: pytest.FixtureRequest) -> RealBlender:
    """A Blender executable; every one there is in turn."""
    if request.param is None:
        leave_out("no Blender executable; set BLENDER and BLENDER_PYTHON, or BLENDER_CHROOTS")
    return request.param


@pytest.fixture(scope="session")
def bpy_python() -> str:
    python = python_with_bpy()
    if python is None:
        leave_out("no Python with bpy; install bpy here or set BPY_PYTHON")
    return python


@pytest.fixture(scope="session")
def wheel(tmp_path_factory: pytest.TempPathFactory, bpy_python: str) -> Path:
    """A wheel of the native library for the Python with bpy."""
    if "LSGP_WHEEL" in os.environ:
        return Path(os.environ["LSGP_WHEEL"]).resolve()
    folder = tmp_path_factory.mktemp("wheel")
    build = [bpy_python, "-m", "pip", "wheel", str(ROOT), "--no-deps", "--quiet", "--wheel-dir", str(folder)]
    subprocess.run(build, check=True)
    return next(folder.glob("lsgp-*.whl"))


@pytest.fixture(scope="session")
def staged(wheel: Path, bpy_python: str, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The staged folder; its zip lies beside it. Blender's validator has accepted the zip."""
    out = tmp_path_factory.mktemp("extension")
    tool = ROOT / "tools" / "packaging" / "stage_extension.py"
    command = [bpy_python, str(tool), "--wheel", str(wheel), "--out", str(out)]
    done = subprocess.run(command, check=True, capture_output=True, text=True)
    assert "not validated" not in done.stderr
    return out / "cone_unwrap"


@pytest.fixture
def copy_of_staged(staged: Path, tmp_path: Path) -> Path:
    """A staged extension the test may damage."""
    return Path(shutil.copytree(staged, tmp_path / "cone_unwrap"))
