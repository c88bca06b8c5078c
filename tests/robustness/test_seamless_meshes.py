# SPDX-License-Identifier: GPL-3.0-or-later
"""Seamless layouts of real meshes on grids of all sizes: exact where there is a layout, and a named refusal where not.

A selection runs at every change.  LSGP_FULL_SWEEP=1 runs every grid on every mesh; as a script this module does
so and prints a table:

    python tests/robustness/test_seamless_meshes.py
"""

from __future__ import annotations

import sys
import time
from dataclasses import dataclass
from functools import cache
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))  # as a script

import lsgp
import numpy as np
import pytest
from meshes import Mesh
from nightly import EVERYTHING
from result_check import named_by, undeclared_faults
from shared_meshes import shared_cones, shared_folder, shared_mesh

AUTOMATIC = 0
TILES = (AUTOMATIC, 8, 16, 32, 64, 128, 512)
# From so many tiles on every mesh has a layout on just that grid.
ALWAYS = {"elephant-genus3.prescribed": 64}
ALWAYS_ELSEWHERE = 32
# Cones as in the mesh's file; those of a "prescribed" one with their angles.
SELECTED = {
    "cube-768": TILES,
    "octa-flower": (AUTOMATIC, 8, 32, 512),
    "fandisk": (AUTOMATIC, 16, 32),
    "igea-16k": (32,),
    "max-planck-25k": (64,),
    "hand-5k": (AUTOMATIC, 32, 64, 128),
    "bird": (16, 32, 128),
    "kitten-genus1": (32,),
    "eight-genus2": TILES,
    "eight-genus2.prescribed": (32, 64),
    "elephant-genus3": (),  # half a minute
    "elephant-genus3.prescribed": (64,),
    "julius": (32,),
}

if not (shared_folder() / "meshes").is_dir():
    pytest.skip(f"no meshes in {shared_folder() / 'meshes'}: set LSGP_SHARED to run this", allow_module_level=True)


@cache
def loaded(name: str) -> tuple[Mesh, list[float] | None]:
    """A mesh with its cones, and their angles where they are prescribed."""
    mesh = shared_mesh(name.removesuffix(".prescribed"))
    cones, angles = shared_cones(name)
    return mesh._replace(cones=np.array(cones, np.int32)), angles if name.endswith(".prescribed") else None


@dataclass
class Outcome:
    """faults: whatever is wrong and not said. refusal: the code of an error instead of a result."""

    faults: list[str]
    seconds: float
    refusal: str = ""
    result: lsgp.Result | None = None

    def row(self) -> str:
        if self.result is None:
            return f"{self.refusal} {self.seconds:.1f} s"
        report, result = self.result.seamless, self.result
        defects = f"{len(result.flipped)} + {len(result.wrong_angle_sums)}"
        row = f"{report.tiles:6.4g} tiles, energy {report.energy_before:.4f} -> {report.energy_after:.4f}, "
        return row + f"error {report.error:g}, flips and wrong sums {defects}, {self.seconds:.2f} s"


def attempt(name: str, tiles: float, **wanted: object) -> Outcome:
    mesh, angles = loaded(name)
    surface = lsgp.Surface(mesh.positions, mesh.triangles)
    options = lsgp.Options(seamless=lsgp.Seamless(tiles=tiles or None, **wanted))
    begin = time.perf_counter()
    try:
        result = lsgp.parameterize(surface, mesh.cones, angles, options)
    except lsgp.LsgpError as error:
        return Outcome([], time.perf_counter() - begin, error.code)
    seconds = time.perf_counter() - begin
    return Outcome(undeclared_faults(surface, result, options), seconds, "", result)


def selected() -> list[tuple[str, float]]:
    return [(name, tiles) for name in SELECTED for tiles in (TILES if EVERYTHING else SELECTED[name])]


@pytest.mark.slow
@pytest.mark.parametrize(("name", "tiles"), selected())
def test_every_grid_is_exact_or_refused(name: str, tiles: float) -> None:
    found = attempt(name, tiles)
    assert found.faults == []
    if tiles != AUTOMATIC and tiles < ALWAYS.get(name, ALWAYS_ELSEWHERE):
        if found.result is None:
            assert found.refusal in ("GRID_TOO_COARSE", "SEAMLESS_IMPOSSIBLE")
            return
    else:
        assert found.result is not None, found.refusal
        assert tiles == AUTOMATIC or found.result.seamless.tiles == tiles
    report = found.result.seamless
    assert report.error == 0
    assert found.result.flipped.size == found.result.wrong_angle_sums.size == 0
    assert tiles != AUTOMATIC or report.energy_after <= 1.1 * report.energy_before
    assert tiles == AUTOMATIC or (report.tiles != tiles) == any(w.code == "GRID_REFINED" for w in found.result.warnings)


@pytest.mark.slow
@pytest.mark.parametrize("lattice", ["stripe", "triangle", "hexagon"])
@pytest.mark.parametrize("name", ["octa-flower", "hand-5k", "eight-genus2"])
def test_other_lattices(name: str, lattice: str) -> None:
    found = attempt(name, 64, lattice=lattice)
    assert found.faults == []
    assert found.result is None or found.result.flipped.size == 0
    assert found.result is not None or found.refusal == "SEAMLESS_IMPOSSIBLE"


@pytest.mark.parametrize("name", ["cube-768", "bird", "eight-genus2"])
def test_parity(name: str) -> None:
    found = attempt(name, 64, parity=True)
    assert found.faults == [] and found.result is not None


@pytest.mark.parametrize("choice", ["merge", "relax"])
@pytest.mark.parametrize("name", ["hand-5k", "eight-genus2"])
def test_cones_given_up_on_coarse_grids_are_named(name: str, choice: str) -> None:
    found = attempt(name, 4, coarse_grid=choice)
    assert found.faults == []
    if found.result is None:
        assert found.refusal == "GRID_TOO_COARSE"
        return
    report, result = found.result.seamless, found.result
    given_up = {"merge": report.merged_cones, "relax": report.relaxed_cones}[choice]
    named = named_by(result, {"merge": "CONES_MERGED", "relax": "CONES_NOT_SNAPPED"}[choice])
    assert np.array_equal(np.sort(given_up), np.sort(named))
    assert report.tiles == 4 or any(w.code == "GRID_REFINED" for w in result.warnings)
    assert np.isin(report.relaxed_cones, result.cones).all() and not np.isin(report.merged_cones, result.cones).any()


def main() -> None:
    names = sys.argv[1:] or list(SELECTED)
    for name in names:
        for tiles in TILES:
            found = attempt(name, tiles)
            print(f"{name:26} {tiles or 'auto':>4}: {found.row()}", flush=True)
            for fault in found.faults:
                print(f"FAULT {name} {tiles}: {fault}", flush=True)


if __name__ == "__main__":
    main()
