# SPDX-License-Identifier: GPL-3.0-or-later
"""`lsgp unwrap --cut-costs`: costs of edges and paint on vertices, and the errors of invalid files."""

from __future__ import annotations

import json
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from command import cut_edges
from polygon_meshes import bumpy_ball

POSITIONS, FACES = bumpy_ball()
COUNT = len(POSITIONS)
UNWRAP = ("unwrap", "ball.obj", "-o", "out.obj", "--cones", "cones.json")
EDGES = sorted({tuple(sorted(pair)) for face in FACES for pair in pairwise([*face, face[0]])})


def cut_with(lsgp, folder: Path, content: str, *options: str) -> set[tuple[int, int]]:
    (folder / "costs").write_text(content)
    done = lsgp(*UNWRAP, "--cut-costs", "costs", *options)
    assert done.code == 0, done.err
    return cut_edges(folder / "out.obj")


def test_cuts_avoid_edges_that_cost_much(lsgp, ball_files: Path) -> None:
    assert lsgp(*UNWRAP).code == 0
    usual = cut_edges(ball_files / "out.obj")
    dear = "# avoid\n" + "".join(f"{a} {b} 1e5\n" for a, b in sorted(usual)[::2])
    assert not cut_with(lsgp, ball_files, dear) & set(sorted(usual)[::2])


def test_text_and_json_are_the_same_and_every_edge_may_have_a_cost(lsgp, ball_files: Path) -> None:
    costs = 1 + np.abs(np.sin(np.arange(len(EDGES))))
    rows = [[b, a, cost] for (a, b), cost in zip(EDGES, costs.tolist(), strict=True)]
    text = cut_with(lsgp, ball_files, "".join(f"{a} {b} {cost!r}\n" for a, b, cost in rows))
    assert cut_with(lsgp, ball_files, json.dumps(rows)) == text
    # With a cost at every edge it does not matter what the others would cost.
    assert cut_with(lsgp, ball_files, json.dumps(rows), "--cuts", "shortest") == text


def test_paint_repels_cuts(lsgp, ball_files: Path) -> None:
    assert lsgp(*UNWRAP, "--cuts", "shortest").code == 0
    usual = cut_edges(ball_files / "out.obj")
    inside = {vertex for edge in usual for vertex in edge} - set(json.loads(cones(ball_files)))
    paint = np.full(COUNT, 0.5)
    paint[sorted(inside)] = 1
    painted = cut_with(lsgp, ball_files, "\n".join(map(str, paint.tolist())), "--cuts", "shortest")
    assert len({vertex for edge in painted for vertex in edge} & inside) < 0.5 * len(inside)


def cones(folder: Path) -> str:
    return json.dumps(json.loads((folder / "cones.json").read_text())["cones"])


FIRST = f"{EDGES[0][0]} {EDGES[0][1]}"


@pytest.mark.parametrize(
    ("content", "said", "code"),
    [
        (f"{FIRST} 1\n\n0 one 2\n", "Line 3: 'one' is not an integer.", "MALFORMED_FILE"),
        (f"{FIRST} 1\n0 1\n", "Line 2: Give two vertices and a cost, as on the line before.", "MALFORMED_FILE"),
        (f"# costs\n{FIRST} -1\n", "Line 2: -1 does not lie between 0 and 1e6.", "WRONG_PARAMETER"),
        (f"{FIRST} nan\n", "Line 1: nan does not lie between 0 and 1e6.", "WRONG_PARAMETER"),
        (f"{FIRST} 1\n0 99999 1\n", "Line 2: there is no edge from vertex 0 to 99999.", "EDGE_NOT_IN_MESH"),
        (f"{FIRST} 1\n7 7 1\n", "Line 2: there is no edge from vertex 7 to 7.", "EDGE_NOT_IN_MESH"),
        ("0.5\n0.5\n", f"'costs' has 2 numbers for {COUNT} vertices.", "WRONG_PARAMETER"),
        (
            "0.5\n" * (COUNT - 1) + "2\n",
            "The painted cost of 1 vertex does not lie between 0 and 1.",
            "WRONG_PARAMETER",
        ),
        ("0.5\n0.5 0.5\n", "Line 2: Give one number, as on the line before.", "MALFORMED_FILE"),
        ("[[0, 1]]", "does not have the form [[a, b, cost], ...]", "MALFORMED_FILE"),
        ("", f"'costs' has 0 numbers for {COUNT} vertices.", "WRONG_PARAMETER"),
    ],
)
def test_refusals_name_the_line(lsgp, ball_files: Path, content: str, said: str, code: str) -> None:
    (ball_files / "costs").write_text(content)
    refused = lsgp(*UNWRAP, "--cut-costs", "costs", "--report", "report.json")
    assert refused.code == 3
    assert said in refused.err
    assert refused.report()["code"] == code


def test_cones_are_placed_by_them_too(lsgp, ball_files: Path) -> None:
    (ball_files / "costs").write_text("0 0 1\n")
    refused = lsgp("cones", "ball.obj", "-o", "placed.json", "--cut-costs", "costs")
    assert refused.code == 3 and "no edge from vertex 0 to 0" in refused.err
    (ball_files / "costs").write_text(f"{FIRST} 0\n")
    assert lsgp("cones", "ball.obj", "-o", "placed.json", "--count", "6", "--cut-costs", "costs").code == 0
