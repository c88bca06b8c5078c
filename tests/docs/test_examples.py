# SPDX-License-Identifier: GPL-3.0-or-later
"""The example programs run, and type checkers accept them with the installed package."""

import importlib.util
import json
import re
import subprocess
import sys

import numpy as np
import pytest
from code_blocks import ROOT
from png_check import pixels_of
from this_process import run_command

EXAMPLES = ROOT / "examples"
PROGRAMS = [str(path) for path in sorted(EXAMPLES.glob("*.py"))]


def test_best_map_is_written(tmp_path):
    command = [sys.executable, EXAMPLES / "best_map.py", EXAMPLES / "model.obj", tmp_path / "best.obj"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert re.search(r"best\.obj: [a-z ]+, L2 stretch 1\.0\d\d,", done.stdout)
    assert (tmp_path / "best.obj").read_text().count("\nvt ") > 800


@pytest.mark.slow
def test_mypy_accepts_them(tmp_path):
    pytest.importorskip("mypy", reason="takes mypy")
    command = [sys.executable, "-m", "mypy", "--strict", "--cache-dir", ROOT / "build" / "mypy", *PROGRAMS]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.slow
def test_pyright_accepts_them(tmp_path):
    if importlib.util.find_spec("basedpyright") is None:
        pytest.skip("takes basedpyright")
    settings = {"include": PROGRAMS, "typeCheckingMode": "strict"}
    (tmp_path / "pyrightconfig.json").write_text(json.dumps(settings))
    command = [sys.executable, "-m", "basedpyright", "-p", str(tmp_path), "--pythonpath", sys.executable]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


def test_the_picture_of_the_readme_shows_the_layout_of_the_model(tmp_path):
    """Its cuts, by their colors, and its island; where that lies in the square may change."""
    command = ["unwrap", EXAMPLES / "model.obj", "-o", "duck.obj", "--preset", "paint", "--picture", "duck.png"]
    assert run_command(tmp_path, *command).returncode == 0
    made = pixels_of((tmp_path / "duck.png").read_bytes())
    shown = pixels_of((ROOT / "docs" / "images" / "duck.png").read_bytes())
    assert shown.shape == made.shape
    assert colors_of(shown) == colors_of(made), "make docs/images/duck.png with the command of the README"


def colors_of(pixels):
    """Those of more than a few pixels."""
    colors, counts = np.unique(pixels.reshape(-1, 3), axis=0, return_counts=True)
    return {tuple(color) for color in colors[counts > 400].tolist()}
