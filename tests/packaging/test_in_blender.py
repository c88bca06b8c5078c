# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs tests/blender inside Blender from an ordinary pytest run.

BPY_PYTHON names a Python with bpy (default: this one, if it has bpy). BLENDER names an executable, BLENDER_PYTHON a
Python of the same version that can build wheels; or BLENDER_CHROOT an installation of ../shared/tools/real-blender.
"""

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
TOOL = ROOT / "tools" / "test_in_blender.py"


def run_tool(*arguments: str) -> None:
    done = subprocess.run([sys.executable, str(TOOL), *arguments], capture_output=True, text=True, check=False)
    assert done.returncode == 0, f"{done.stdout[-8000:]}\n{done.stderr[-4000:]}"
    assert "test_in_blender:" in done.stdout


def test_addon_in_bpy(bpy_python, wheel, tmp_path):
    run_tool("--python", bpy_python, "--wheel", str(wheel), "--out", str(tmp_path))


def test_addon_in_a_real_blender(tmp_path):
    if "BLENDER_CHROOT" in os.environ:
        # The chroot sees the repository, but not every temporary folder.
        run_tool("--chroot", os.environ["BLENDER_CHROOT"], "--out", str(ROOT / "build" / "in_real_blender"))
    elif "BLENDER" in os.environ and "BLENDER_PYTHON" in os.environ:
        run_tool("--blender", os.environ["BLENDER"], "--python", os.environ["BLENDER_PYTHON"], "--out", str(tmp_path))
    else:
        pytest.skip("no Blender executable; set BLENDER and BLENDER_PYTHON, or BLENDER_CHROOT")
