# SPDX-License-Identifier: GPL-3.0-or-later
"""Every mesh of the zoo with automatic cones: ordinary ones have a map, broken ones a map or a reason why not."""

from __future__ import annotations

import lsgp
import numpy as np
import oracle
import pytest
import zoo
from map_checks import digest
from nightly import some_nightly
from outcome_check import error_faults, placement_faults, result_faults

SMALL = {one.name: one for one in zoo.members("small")}
ORDINARY = [name for name, one in SMALL.items() if one.ordinary]
BROKEN = [name for name, one in SMALL.items() if not one.ordinary]
# A unit in the last place is as large as what is measured: a mesh so moved is another one than that compared with.
LOST = ("lost-digits", "very-far-parts")
BROKEN_ONES = [pytest.param(name, marks=[pytest.mark.exact_input] * name.startswith(LOST)) for name in BROKEN]
# Of the large ones some that are the most of something: holes, parts, length.
LARGEST = [
    "holed-plate-across=20-along=15-bend=0.2",
    "equal-parts-kind=triangle-count=2000",
    "strip-length=5000-twist=0.01-curl=0",
    "gear-teeth=80-depth=0.1-layers=10",
]


def unwrapped(member: zoo.Member) -> tuple[lsgp.Surface, lsgp.Placement, lsgp.Result]:
    mesh = member.mesh()
    surface = lsgp.Surface(mesh.positions, mesh.triangles, member.edges())
    placed = lsgp.place_cones(surface)
    return surface, placed, lsgp.parameterize(surface, placed.cones, placed.cone_angles)


def require_sound(member: zoo.Member) -> None:
    surface, placed, result = unwrapped(member)
    given = dict(zip(placed.cones.tolist(), placed.cone_angles.tolist(), strict=True))
    assert placement_faults(surface, placed, 1.05) == []
    assert result_faults(surface, result, lsgp.Options(), given) == []
    assert result.solved.all()


@pytest.mark.slow
@pytest.mark.parametrize("name", ORDINARY)
def test_an_ordinary_mesh_has_a_map(name: str) -> None:
    require_sound(SMALL[name])


@pytest.mark.many_solves
@pytest.mark.parametrize("name", some_nightly(LARGEST, "gear-teeth=80-depth=0.1-layers=10"))
def test_a_large_mesh_has_a_map(name: str) -> None:
    require_sound(zoo.member(name))


@pytest.mark.slow
@pytest.mark.parametrize("name", BROKEN_ONES)
def test_a_broken_mesh_has_an_honest_end(name: str) -> None:
    mesh = SMALL[name].mesh()
    surface = lsgp.Surface(mesh.positions, mesh.triangles)
    try:
        surface, placed, result = unwrapped(SMALL[name])
    except lsgp.LsgpError as error:
        assert error_faults(surface, error) == []
    else:
        assert placement_faults(surface, placed, 1.05) == []
        assert result_faults(surface, result, lsgp.Options()) == []


def test_there_are_hundreds() -> None:
    assert len(zoo.members()) >= 400 and len(zoo.members("small")) >= 400
    assert len(ORDINARY) >= 200 and len(zoo.families()) >= 50
    assert all(len(one.mesh().triangles) <= 800 for one in SMALL.values())


def test_the_largest_are_what_they_are_for() -> None:
    """Genus 200, 3,000 holes, 2,000 parts, a vertex of 50,000 triangles, an aspect of 1e12, scales of 1e-30 to 1e30."""
    plate = zoo.member("tunneled-plate-across=20-along=10-thickness=1").mesh().triangles
    assert oracle.euler_of(plate) == 2 - 2 * 200
    assert len(oracle.boundary_loops(zoo.member("holed-plate-across=60-along=50-bend=0").mesh().triangles)) == 1 + 3000
    parts = zoo.member("mixed-parts-count=2000-spread=1-seed=5").mesh().triangles
    assert oracle.face_components(parts).max() == 1999
    assert np.bincount(zoo.member("fan-valence=50000-height=0").mesh().triangles.ravel()).max() == 50000
    sizes = [np.ptp(one.mesh().positions, axis=0).max() for one in zoo.members("small", "extreme-scale")]
    assert min(sizes) < 1e-29 and max(sizes) > 1e29
    flat = zoo.member("sharp-needle-aspect=1e+12").mesh().positions
    assert np.ptp(flat, axis=0)[0] == 1e12 * np.ptp(flat, axis=0)[1]


def test_ordinary_meshes_are_surfaces() -> None:
    """Oriented, two triangles at an edge at most, no vertex twice in a triangle, every triangle with an area."""
    for name in ORDINARY:
        mesh = SMALL[name].mesh()
        t = mesh.triangles.astype(np.int64)
        directed = np.concatenate([t[:, [i, (i + 1) % 3]] for i in range(3)])
        assert len(np.unique(directed, axis=0)) == len(directed), name
        assert (directed[:, 0] != directed[:, 1]).all(), name
        assert (oracle.triangle_areas(mesh.positions, t) > 0).all(), name


@pytest.mark.parametrize("name", ["bumpy-ball-levels=1-height=0.25", "random-sheet-cells=2-shear=0.1-seed=0"])
def test_members_are_the_same_each_time(name: str) -> None:
    one, other = zoo.member(name).mesh(), zoo.member(name).mesh()
    assert one.positions.tobytes() == other.positions.tobytes() and np.array_equal(one.triangles, other.triangles)
    results = [unwrapped(zoo.member(name))[2] for _ in range(2)]
    assert digest(results[0]) == digest(results[1])
