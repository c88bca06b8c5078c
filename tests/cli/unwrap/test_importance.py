# SPDX-License-Identifier: GPL-3.0-or-later
"""`lsgp unwrap --mode low-stretch --importance`: how the file is read, and the errors of invalid files."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
from polygon_meshes import bumpy_ball

COUNT = len(bumpy_ball()[0])
LOW_STRETCH = ("unwrap", "ball.obj", "-o", "out.obj", "--cones", "cones.json", "--mode", "low-stretch")


def test_refusals_say_what_is_wrong(lsgp, ball_files: Path) -> None:
    weights = np.ones(COUNT)
    weights[[3, 8]] = -1, math.nan
    (ball_files / "bad.txt").write_text("\n".join(map(str, weights.tolist())))
    bad = lsgp(*LOW_STRETCH, "--importance", "bad.txt", "--report", "report.json")
    assert bad.code == 3
    assert "of 2 vertices is negative or no finite number" in bad.err
    assert "(vertices 3, 8)" in bad.err
    assert bad.report()["elements"] == {"kind": "vertices", "indices": [3, 8]}
    (ball_files / "short.txt").write_text("1\n" * (COUNT - 1))
    short = lsgp(*LOW_STRETCH, "--importance", "short.txt")
    assert short.code == 3
    assert f"'short.txt' has {COUNT - 1} numbers for {COUNT} vertices. Give one for each." in short.err
    (ball_files / "words.txt").write_text("1\n" * 4 + "one\n")
    words = lsgp(*LOW_STRETCH, "--importance", "words.txt")
    assert words.code == 3
    assert "'words.txt' does not hold the importance of vertices. Line 5: 'one' is not a number." in words.err


def test_text_and_json_are_the_same(lsgp, ball_files: Path) -> None:
    weights = np.linspace(0, 3, COUNT).tolist()
    texts = {
        "lines.txt": "# from a modeler\n" + "\n".join(map(repr, weights)) + "\n",
        "one-line.txt": " ".join(map(repr, weights)),
        "list.json": "\n " + json.dumps(weights, indent=1),
    }
    outputs = set()
    for name, text in texts.items():
        (ball_files / name).write_text(text)
        done = lsgp(*LOW_STRETCH, "--importance", name)
        assert done.code == 0, done.err
        outputs.add((ball_files / "out.obj").read_bytes())
    assert len(outputs) == 1
