# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs tests/blender inside Blender from an ordinary pytest run.

BPY_PYTHON names a Python with bpy (default: this one, if it has bpy). BLENDER names an executable, BLENDER_PYTHON a
Python of the same version that can build wheels; BLENDER_CHROOTS, separated by colons, installations of
../shared/tools/real-blender. What needs a window is tried in the last of them, where xvfb-run is installed beside it.
"""

import subprocess
import sys
from pathlib import Path

import pytest
from blenders import leave_out, real_blenders

ROOT = Path(__file__).resolve().parents[2]
TOOL = ROOT / "tools" / "packaging" / "test_in_blender.py"


def run_tool(*arguments: str) -> str:
    """What the tool printed; fails where the tool does."""
    done = subprocess.run([sys.executable, str(TOOL), *arguments], capture_output=True, text=True, check=False)
    assert done.returncode == 0, f"{done.stdout[-30000:]}\n{done.stderr[-4000:]}"
    return done.stdout


def test_addon_in_bpy(bpy_python, wheel, tmp_path, pytestconfig):
    """All of them, or those that are selected here by marks, as by `tools/test --quick`."""
    chosen = pytestconfig.getoption("markexpr")
    how = ["--python", bpy_python, "--wheel", str(wheel), "--out", str(tmp_path)]
    assert "tests, 0 failures" in run_tool(*how, "--", *(["-m", chosen] if chosen else []), "--few-tries")


@pytest.mark.slow
def test_addon_in_a_real_blender(real_blender, wheel, staged):
    """In its window, too, where there is a screen; and the Blender accepts the zip for blender.org's.

    What no Blender changes runs in bpy, above; `tools/test_all_blenders` runs all of it everywhere.
    """
    (package,) = staged.parent.glob("*.zip")
    window = ["--window"] if real_blender.has_screen else []
    how = [*real_blender.arguments, "--validate", str(package), *window, "--library-of", str(wheel)]
    said = run_tool(*how, "--", "-m", "not one_blender", "--few-tries")
    assert "tests, 0 failures" in said
    assert real_blender.has_screen == ("tests in a window, 0 failures" in said)


def test_some_blender_has_a_window():
    if not any(found.has_screen for found in real_blenders()):
        leave_out("no virtual screen for Blender; install xvfb-run beside it")
