# SPDX-License-Identifier: GPL-3.0-or-later
"""Changes that preserve the shape preserve the map: numbering, motion, scale, mirroring, company.

Cones and angles are given, so that ties in their choice cannot matter.  Where a surface has two shortest cuts the
layouts need not be similar figures, but the maps are the same if all triangles are: that is what is compared, and the
layouts themselves, too, where the cuts agree.
"""

from __future__ import annotations

from functools import cache

import lsgp
import meshes
import numpy as np
import oracle
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from map_checks import pairs, prescribe, surface, unwrap
from meshes import Mesh
from result_check import undeclared_faults

SAME = 1e-6

# Name, mesh, how to unfold it.  The spectral map is defined for closed surfaces.
SURFACES = {
    "cube": meshes.cube(4),
    "sphere": meshes.bumpy_sphere(2),
    "flower": meshes.flower(2),
    "saddle": meshes.saddle(6),
    "hill": meshes.hill(8),
    "holes": meshes.disk_with_holes(12, 2),
    "tube": meshes.cylinder(10, 4),
    "torus": meshes.torus(14, 8),
    "genus 2": meshes.subdivide(meshes.double_torus())._replace(cones=np.array([0, 7, 20, 31], np.int32)),
}
CLOSED = ("cube", "sphere", "flower")

names = st.sampled_from(sorted(SURFACES))
seeds = st.integers(0, 2**32 - 1)
few = settings(max_examples=40)


@cache
def angles_of(name: str) -> tuple[float, ...]:
    """What the library chooses once for the mesh's cones."""
    return tuple(prescribe(SURFACES[name]).cone_angles.tolist())


@cache
def map_of(name: str, unfold: str = "poisson") -> lsgp.Result:
    return unwrap(SURFACES[name], angles_of(name), unfold=unfold)


def assert_same_map(expected: np.ndarray, found: np.ndarray, same_cuts: bool) -> None:
    """Of one component; (m, 3, 2) corners in the same order."""
    assert oracle.metric_gap(expected, found) <= SAME
    if same_cuts:
        assert oracle.similarity_gap(expected, found) <= SAME


@pytest.mark.parametrize("name", SURFACES)
def test_the_maps_compared_here_are_sound(name: str) -> None:
    assert undeclared_faults(surface(SURFACES[name]), map_of(name)) == []
    assert map_of(name).solved.all() and map_of(name).flipped.size == 0


@few
@given(name=names, seed=seeds)
@example(name="torus", seed=0)
@example(name="holes", seed=0)
def test_renumbering(name: str, seed: int) -> None:
    mesh, before = SURFACES[name], map_of(name)
    shuffled, new_of_old, old_corner = meshes.renumber(mesh, seed)
    after = unwrap(shuffled, angles_of(name))
    there = before.corner_uv.reshape(-1, 2)[old_corner].reshape(-1, 3, 2)
    assert_same_map(there, after.corner_uv, pairs(new_of_old[before.cut_edges]) == pairs(after.cut_edges))


@few
@given(name=names, seed=seeds, exponent=st.floats(-6, 6))
@example(name="sphere", seed=1, exponent=-6.0)
@example(name="holes", seed=2, exponent=6.0)
def test_rigid_motion_and_uniform_scale(name: str, seed: int, exponent: float) -> None:
    moved = meshes.transform(SURFACES[name], seed, 10**exponent)
    after = unwrap(moved, angles_of(name))
    assert_same_map(map_of(name).corner_uv, after.corner_uv, pairs(map_of(name).cut_edges) == pairs(after.cut_edges))


@few
@given(name=st.sampled_from(CLOSED), seed=seeds, exponent=st.floats(-6, 6))
def test_motion_and_scale_of_the_spectral_map(name: str, seed: int, exponent: float) -> None:
    moved = meshes.transform(SURFACES[name], seed, 10**exponent)
    before, after = map_of(name, "spectral"), unwrap(moved, angles_of(name), unfold="spectral")
    assert_same_map(before.corner_uv, after.corner_uv, pairs(before.cut_edges) == pairs(after.cut_edges))


@few
@given(name=names, axis=st.integers(0, 2))
def test_a_mirrored_surface_has_the_mirrored_map(name: str, axis: int) -> None:
    mesh = SURFACES[name]
    sign = np.where(np.arange(3) == axis, -1.0, 1.0)
    twin = meshes.make(mesh.positions * sign, mesh.triangles[:, ::-1], mesh.cones)
    after = unwrap(twin, angles_of(name))
    assert (oracle.signed_areas(after.corner_uv) > 0).all()
    mirrored = after.corner_uv[:, ::-1] * [-1.0, 1.0]
    assert_same_map(map_of(name).corner_uv, mirrored, pairs(map_of(name).cut_edges) == pairs(after.cut_edges))


@few
@given(name=names, seed=seeds, count=st.integers(1, 40), value=st.sampled_from([0.0, 1e30, np.nan]))
def test_isolated_vertices_anywhere(name: str, seed: int, count: int, value: float) -> None:
    mesh = SURFACES[name]
    total = len(mesh.positions) + count
    kept = np.sort(np.random.default_rng(seed).permutation(total)[: len(mesh.positions)])
    positions = np.full((total, 3), value)
    positions[kept] = mesh.positions
    after = unwrap(meshes.make(positions, kept[mesh.triangles], kept[mesh.cones]), angles_of(name))
    assert np.array_equal(after.corner_uv, map_of(name).corner_uv)


@few
@given(name=names, other=names, exponent=st.floats(0, 6), first=st.booleans())
@example(name="cube", other="genus 2", exponent=6.0, first=False)
def test_a_second_component_far_away(name: str, other: str, exponent: float, first: bool) -> None:
    """Each component keeps its map; the packing scales both alike."""
    mesh, far = SURFACES[name], SURFACES[other]
    far = far._replace(positions=far.positions + 10**exponent)
    both = [mesh, far] if first else [far, mesh]
    angles = [angles_of(name), angles_of(other)] if first else [angles_of(other), angles_of(name)]
    count = len(both[0].positions)
    together = Mesh(
        np.concatenate([part.positions for part in both]),
        np.concatenate([both[0].triangles, both[1].triangles + count]),
        np.concatenate([both[0].cones, both[1].cones + count]),
    )
    after = unwrap(together, angles[0] + angles[1])
    assert after.solved.all()
    m = len(mesh.triangles)
    assert oracle.similarity_gap(map_of(name).corner_uv, after.corner_uv[:m] if first else after.corner_uv[-m:]) <= SAME


@few
@given(name=names, other=st.sampled_from(CLOSED), first=st.booleans())
def test_a_second_component_that_cannot_be_solved(name: str, other: str, first: bool) -> None:
    """A closed surface without cones is left out and named; the map of the rest does not change by a bit."""
    mesh, closed = SURFACES[name], SURFACES[other]._replace(cones=np.empty(0, np.int32))
    together = meshes.merge([mesh, closed] if first else [closed, mesh])
    together = together._replace(
        positions=np.concatenate([p.positions for p in ([mesh, closed] if first else [closed, mesh])])
    )
    after = unwrap(together, angles_of(name))
    m = len(mesh.triangles)
    own = slice(0, m) if first else slice(-m, None)
    assert after.solved[own].all() and after.solved.sum() == m
    assert np.array_equal(after.corner_uv[own], map_of(name).corner_uv)
    assert undeclared_faults(surface(together), after) == []
