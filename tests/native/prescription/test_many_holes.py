# SPDX-License-Identifier: GPL-3.0-or-later
"""Plates with many holes: each is closed without a cut, for a number of solves that does not grow with them. Belts:
they are closed where they bend into a ring."""

from __future__ import annotations

from functools import cache

import lsgp
import meshes
import numpy as np
import oracle
import pytest
from map_checks import surface
from result_check import undeclared_faults
from zoo import closed

HOLES = (8, 9, 18)  # along a side; from 9 on there are too many for a dense matrix


@cache
def plate(holes: int) -> lsgp.Result:
    return lsgp.parameterize(surface(meshes.plate(holes)), [])


@pytest.mark.parametrize("holes", HOLES)
def test_all_holes_close_without_a_cut(holes: int) -> None:
    assert len(oracle.boundary_loops(meshes.plate(holes).triangles)) == holes**2 + 1
    assert len(plate(holes).cut_edges) == 0
    assert undeclared_faults(surface(meshes.plate(holes)), plate(holes)) == []


def test_solves_grow_with_the_root_of_the_number_of_holes() -> None:
    few, many = (plate(holes).back_substitutions for holes in HOLES[1:])
    assert many <= 1.2 * (HOLES[2] / HOLES[1]) * few and many <= 100, (few, many)


@pytest.mark.parametrize("holes", HOLES)
def test_the_log_scale_is_harmonic_between_shifted_borders(holes: int) -> None:
    mesh, scale = meshes.plate(holes), plate(holes).log_scale
    shifts = oracle.read_loop_scale(mesh.triangles, scale)
    expected = oracle.solve_scale(mesh.positions, mesh.triangles, np.zeros(len(scale)), shifts)
    assert scale - scale[0] == pytest.approx(expected - expected[0], abs=1e-9)


# --- belts ------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("sides", [4, 6, 8])
def test_a_belt_of_few_sides_becomes_a_strip(sides: int) -> None:
    """The prediction knows nothing of its corners: bent into a ring, triangles collapse there."""
    belt = surface(closed.cylinder(sides, 1, 0.05, caps=0))
    result, placed = lsgp.parameterize(belt, []), lsgp.place_cones(belt)
    assert result.distortion.l2_stretch == pytest.approx(1, abs=1e-9)
    assert placed.mapped_l2 == pytest.approx(1, abs=1e-9) and len(placed.cones) == 0
    assert len(result.cut_edges) == 1  # across it


def test_a_belt_of_many_sides_stays_a_ring() -> None:
    belt = surface(closed.cylinder(300, 1, 0.05, caps=0))
    result = lsgp.parameterize(belt, [])
    assert len(result.cut_edges) == 0 and result.distortion.l2_stretch < 1.03
