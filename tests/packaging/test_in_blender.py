# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs tests/blender inside Blender from an ordinary pytest run.

BPY_PYTHON names a Python with bpy (default: this one, if it has bpy). BLENDER names an executable, BLENDER_PYTHON a
Python of the same version that can build wheels; or BLENDER_CHROOT an installation of ../shared/tools/real-blender.
"""

import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
TOOL = ROOT / "tools" / "test_in_blender.py"


def run_tool(*arguments: str) -> None:
    done = subprocess.run([sys.executable, str(TOOL), *arguments], capture_output=True, text=True, check=False)
    assert done.returncode == 0, f"{done.stdout[-8000:]}\n{done.stderr[-4000:]}"
    assert "test_in_blender:" in done.stdout


def test_addon_in_bpy(bpy_python, wheel, tmp_path):
    run_tool("--python", bpy_python, "--wheel", str(wheel), "--out", str(tmp_path))


def test_addon_in_a_real_blender(real_blender):
    run_tool(*real_blender)
