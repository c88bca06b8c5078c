# SPDX-License-Identifier: GPL-3.0-or-later
"""The certificate of a seamless layout, as data and as a table, from reports made by hand."""

from __future__ import annotations

import json

import numpy as np
import pytest
from lsgp import SeamlessReport
from lsgp.certificate import certificate, certificate_table
from lsgp.run.report import to_json


def report(errors: list[float], rotation_order: int = 4, cell: float = 1.0) -> SeamlessReport:
    """Cut i runs from vertex 100 + i to vertex 200 + i, turns i times and shifts by (i, -3 i) cells."""
    count = np.arange(len(errors))
    return SeamlessReport(
        rotation_order=rotation_order,
        tiles=15.5,
        tile_size=0.125,
        cell=cell,
        energy_before=1.0125,
        energy_after=1.0375,
        cut_nodes=np.stack([100 + count, 200 + count], axis=1).astype(np.int32),
        cut_turns=(count % rotation_order).astype(np.int32),
        cut_translations=np.stack([count, -3 * count], axis=1).astype(np.int64),
        cut_errors=np.array(errors, float),
        error=max(errors, default=0.0),
        flat_cones=np.array([5], np.int32),
        merged_cones=np.array([6, 7], np.int32),
        relaxed_cones=np.empty(0, np.int32),
    )


def rows(table: str) -> list[list[str]]:
    """The words of the lines of cuts."""
    return [line.replace(",", "").split() for line in table.splitlines()[2:] if not line.startswith("...")]


def test_certificate_as_json_holds_every_cut() -> None:
    found = json.loads(to_json(certificate(report([0.0, 2**-10, 0.0]), 512)))
    assert found["cuts"] == [
        {"tail": 100, "head": 200, "turns": 0, "translation": [0, 0], "error_texels": 0.0},
        {"tail": 101, "head": 201, "turns": 1, "translation": [1, -3], "error_texels": 0.5},
        {"tail": 102, "head": 202, "turns": 2, "translation": [2, -6], "error_texels": 0.0},
    ]
    assert (found["rotation_order"], found["tiles"], found["tile_size"], found["cell"]) == (4, 15.5, 0.125, 1.0)
    assert (found["error"], found["error_texels"], found["texture_size"]) == (2**-10, 0.5, 512)
    assert (found["energy_before"], found["energy_after"]) == (1.0125, 1.0375)
    assert (found["flat_cones"], found["merged_cones"], found["relaxed_cones"]) == ([5], [6, 7], [])


@pytest.mark.parametrize("cell", [1.0, 2.0**-4])
def test_texels_are_of_a_texture_over_the_unit_square(cell: float) -> None:
    found = certificate(report([2.0**-10], cell=cell), 2048)
    assert found["error_texels"] == found["cuts"][0]["error_texels"] == 2 * cell


@pytest.mark.parametrize(("rotation_order", "angle"), [(1, 90), (2, 90), (4, 90), (3, 60), (6, 60)])
def test_basis_is_of_squares_or_of_equilateral_triangles(rotation_order: int, angle: float) -> None:
    first, second = np.array(certificate(report([0.0], rotation_order), 1024)["basis"])
    assert first.tolist() == [1, 0]
    assert np.linalg.norm(second) == pytest.approx(1, abs=1e-15)
    assert np.degrees(np.arctan2(second[1], second[0])) == pytest.approx(angle)


def test_table_has_a_row_for_every_cut() -> None:
    table = certificate_table(report([0.0] * 3), 1024)
    assert rows(table) == [
        ["100", "200", "0", "0", "0", "0"],
        ["101", "201", "1/4", "1", "-3", "0"],
        ["102", "202", "2/4", "2", "-6", "0"],
    ]
    head = table.splitlines()[0]
    for figure in ("3 cuts", "0 texels off at 1024 x 1024", "15.5 tiles", "0.125 each", "1.0125", "1.0375"):
        assert figure in head
    assert "translation in tiles" in table.splitlines()[1]


def test_turns_are_told_in_the_lattices_own() -> None:
    assert [row[2] for row in rows(certificate_table(report([0.0] * 6, 6), 1024))] == [
        *["0", "1/6", "2/6", "3/6", "4/6", "5/6"]
    ]


def test_part_tiles_are_cells() -> None:
    lines = certificate_table(report([0.0], cell=2.0**-4), 1024).splitlines()
    assert "15.5 cells" in lines[0]
    assert "translation in cells" in lines[1]


@pytest.mark.parametrize("count", [12, 13, 35])
def test_many_cuts_are_summed_up(count: int) -> None:
    lines = certificate_table(report([0.0] * count), 1024).splitlines()
    assert len(rows("\n".join(lines))) == 12
    assert lines[14:] == ([] if count == 12 else [f"... and {count - 12} more, all exact"])


def test_worst_cuts_come_first_and_the_rest_hides_none() -> None:
    errors = [0.0] * 10 + [2.0**-10 * (1 + i) for i in range(20)]
    table = certificate_table(report(errors), 1024)
    assert [row[0] for row in rows(table)] == [str(129 - i) for i in range(12)]
    assert [float(row[5]) for row in rows(table)] == [20 - i for i in range(12)]
    assert table.splitlines()[-1] == "... and 18 more, at most 8.0e+00 texels off"
    assert "2.0e+01 texels off" in table.splitlines()[0]


def test_layout_without_cuts_is_one_line() -> None:
    table = certificate_table(report([]), 1024)
    assert table.startswith("seamless: 0 cuts, 0 texels off")
    assert "\n" not in table
