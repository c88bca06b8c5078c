# SPDX-License-Identifier: GPL-3.0-or-later
"""Every value of every option together with every value of every other, and with meshes, cones, seams and pins of every
kind: each row ends in a map that keeps its contract, or in an error of the library."""

from __future__ import annotations

import dataclasses
import itertools
from typing import Any

import lsgp
import pytest
from covering import all_pairs, covering_rows
from explorer.option_values import OPTIONS, PLACEMENT, SEAMLESS
from explorer.world import World
from outcome_check import error_faults, result_faults

MESHES = [
    "triangle-corners=3-bend=0",
    "face-corners=4-bend=0.3",
    "strip-length=9-twist=0.2-curl=0.3",
    "hill-n=6-height=2.5",
    "holed-plate-across=2-along=1-bend=0.3",
    "polygon-box-cells=3-size=1x1x1",
    "box-cells=3-size=1x10x1",
    "bumpy-ball-levels=1-height=0.25",
    "gear-teeth=6-depth=0.15-layers=1",
    "cylinder-around=12-along=5-length=6-caps=0",
    "pipe-around=8-along=10-bend=1.5-caps=True",
    "ring-around=14-along=8-major=2",
    "tunneled-plate-across=2-along=1-thickness=1",
    "mixed-parts-count=5-spread=2-seed=0",
    "scale-shape=ball-exponent=-6",
    "finer-shape=holes-levels=1",
    "doubled-sheet-cells=3-joined=True",
    "fin-shape=ball",
    "bow-tie-n=3",
    "faces-twice-shape=box-count=4-turned=True",
    "turned-faces-shape=ball-share=0.1-seed=0",
    "t-junctions-shape=hill-count=1",
    "scrap-corners=8-depth=0.2-seed=0",
    "moebius-around=16-across=3",
]
CHOSEN = {
    "mesh": MESHES,
    "cones": ["own", "placed", "none", "random", "border"],
    "angles": ["automatic", "some", "prescribed", "near", "quarter turns"],
    "seams marked": ["none", "path", "around a part"],
    "features": ["none", "loop", "creases"],
    "pins": ["none", "one", "many"],
    "importance": ["none", "random"],
    "directions": ["none", "up", "strokes"],
    "edges": ["all", "most"],
    "call": ["parameterize", "Solver", "find_cuts", "prescribe_curvature"],
}
# A lattice is asked for or none: then the other options of seamless layouts have no meaning and stay as they are.
GRID = {"lattice": [None, *SEAMLESS["lattice"]], **{name: of for name, of in SEAMLESS.items() if name != "lattice"}}
PLAIN_GRID = {field.name: field.default for field in dataclasses.fields(lsgp.Seamless) if field.name != "lattice"}
VALUES: dict[str, list[Any]] = {**CHOSEN, **{name: of for name, of in OPTIONS.items() if name != "seamless"}, **GRID}

SEAMLESS_IS = {False: "none", True: "asked for"}

# What the library refuses to do together, in any row.
LSCM_HAS_NO = {"unfold": "poisson", "mode": "conformal", "border": "free", "loop_turning": "none", "pins": "none"}
SEAMLESS_HAS_NO = {"method": "lsgp", "border": "free", "pins": "none", "compact": "off"}


def keeps(row: dict[str, Any], wanted: dict[str, Any]) -> bool:
    return all(row.get(name, value) == value for name, value in wanted.items())


def together(row: dict[str, Any]) -> bool:
    """Whether these values, of some of the parameters, are not refused for each other."""
    if "lattice" in row and not keeps(row, PLAIN_GRID if row["lattice"] is None else SEAMLESS_HAS_NO):
        return False
    if row.get("parity") and row.get("lattice") not in (None, "square"):
        return False
    if row.get("method") == "lscm" and not keeps(row, LSCM_HAS_NO | {"lattice": None} | PLAIN_GRID):
        return False
    seamless = any(row.get(name, value) != value for name, value in PLAIN_GRID.items())
    if seamless and not keeps(row, SEAMLESS_HAS_NO):
        return False
    return row.get("tiles") is None or row.get("tile_size") is None


PLACING: dict[str, list[Any]] = {
    **{name: CHOSEN[name] for name in ("mesh", "cones", "angles", "seams marked", "edges")},
    **PLACEMENT,
    "call": ["place_cones", "cone_gains"],
}


ROWS, PLACING_ROWS = covering_rows(VALUES, together), covering_rows(PLACING)


@pytest.mark.parametrize(("values", "rows"), [(VALUES, ROWS), (PLACING, PLACING_ROWS)], ids=["maps", "placement"])
def test_all_pairs_are_covered(values: dict[str, list[Any]], rows: list[dict[str, Any]]) -> None:
    allowed = together if values is VALUES else lambda row: True
    for (a, i), (b, j) in all_pairs(values, allowed):
        assert any(row[a] == values[a][i] and row[b] == values[b][j] for row in rows)
    assert all(set(row) == set(values) and allowed(row) for row in rows)
    most = sorted((len(of) for of in values.values()), reverse=True)
    assert len(rows) <= 2 * most[0] * most[1]  # the product of the two longest lists is what any array needs


def entered(row: dict[str, Any], seed: int) -> World:
    """A session with all that a row has chosen."""
    world = World()
    steps = [
        {"do": "take mesh", "mesh": row["mesh"]},
        {"do": "mark seams", "kind": row["seams marked"], "count": 2, "seed": seed},
        {"do": "mark features", "kind": row.get("features", "none"), "count": 2, "seed": seed},
        {"do": "allow cuts", "kind": row["edges"], "count": 2, "seed": seed},
        {"do": "weigh", "kind": row.get("importance", "none"), "count": 2, "seed": seed},
        {"do": "direct", "kind": row.get("directions", "none"), "count": 2, "seed": seed},
        {"do": "choose cones", "kind": row["cones"], "count": 4, "seed": seed},
        {"do": "choose angles", "kind": row["angles"], "count": 4, "seed": seed},
    ]
    if row.get("pins", "none") != "none":
        steps += [{"do": "parameterize"}, {"do": "pin", "kind": row["pins"], "count": 2, "seed": seed}]
    for step in steps:
        assert world.perform(step)[1] == [], step
    return world


def test_pairs_are_of_all_options() -> None:
    """No option is left out: what the verbs take is what is listed."""
    assert set(VALUES) == {*CHOSEN, *OPTIONS, *SEAMLESS} - {"seamless"}
    parameters = set(lsgp.place_cones.__kwdefaults__) - {"progress"}
    assert parameters == set(PLACEMENT)


@pytest.mark.slow
@pytest.mark.parametrize("number", range(len(ROWS)))
def test_row_of_options(number: int) -> None:
    row = ROWS[number]
    world = entered(row, number)
    seamless = {name: row[name] for name in SEAMLESS} if row["lattice"] else {}
    options = {name: row[name] for name in OPTIONS if name != "seamless"} | {"seamless": SEAMLESS_IS[bool(seamless)]}
    chosen = {"do": "choose options", "options": options, "seamless": seamless, "afresh": True, "seed": number}
    assert world.perform(chosen)[1] == []
    call = {"parameterize": "parameterize", "Solver": "solve", "find_cuts": "find cuts"}.get(row["call"], "prescribe")
    assert world.perform({"do": call})[1] == []


@pytest.mark.slow
@pytest.mark.parametrize("number", range(len(PLACING_ROWS)))
def test_row_of_placement(number: int) -> None:
    row = PLACING_ROWS[number]
    world = entered(row, number)
    how = {name: row[name] for name in PLACEMENT}
    call = (
        {"do": "place cones", "options": how, "adopt": True} if row["call"] == "place_cones" else {"do": "cone gains"}
    )
    assert world.perform(call)[1] == []


def test_rows_reach_maps_and_refusals() -> None:
    """The values are such that at least a third of the rows of maps end in one."""
    ends = []
    for number, row in itertools.islice(enumerate(ROWS), 0, None, 8):
        world = entered(row, number)
        try:
            result = lsgp.parameterize(world.surface, world.cones, world.angles)
        except lsgp.LsgpError as error:
            assert error_faults(world.surface, error) == []
            ends.append(False)
        else:
            assert result_faults(world.surface, result, lsgp.Options()) == []
            ends.append(True)
    assert len(ends) > sum(ends) >= len(ends) / 3
