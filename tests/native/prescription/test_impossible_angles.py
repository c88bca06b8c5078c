# SPDX-License-Identifier: GPL-3.0-or-later
"""Angles that no triangulation of the surface can have are refused by their cones, and cones that no angles suit by the
vertices of which one has to be a cone."""

from __future__ import annotations

from collections.abc import Sequence

import lsgp
import meshes
import numpy as np
import oracle
import pytest
from map_checks import surface
from meshes import Mesh
from zoo.tunnels import sponge

PI = np.pi
CLEAR = 1e-6  # radians: nearer than that to the limit, rounding decides


def wanted(mesh: Mesh, cones: Sequence[int], angles: Sequence[float | None]) -> np.ndarray:
    """What the angles around every vertex have to add up to: a full turn inside, anything along borders."""
    sums = np.full(len(mesh.positions), 2 * PI)
    for loop in oracle.boundary_loops(mesh.triangles):
        sums[loop] = np.nan
    sums[list(cones)] = [np.nan if angle is None else angle for angle in angles]
    return sums


def refusal(mesh: Mesh, cones: Sequence[int], angles: Sequence[float | None]) -> lsgp.CurvatureError | None:
    """The error that says these angles cannot be, None where there is a map, whatever its defects."""
    try:
        lsgp.parameterize(surface(mesh), cones, angles)
    except lsgp.CurvatureError as error:
        given = dict(zip(cones, angles, strict=True))
        alone = all(given[v] >= valence(mesh, v) * PI * (1 - 1e-12) for v in error.elements.indices.tolist())
        assert error.code == "ANGLES_IMPOSSIBLE" or (error.code == "CONE_ANGLE_RANGE" and alone)
        return error
    return None


def assert_refused_for(mesh: Mesh, cones: Sequence[int], angles: Sequence[float | None]) -> list[int]:
    """The cones named: of those with given angles, and reason enough by themselves."""
    error = refusal(mesh, cones, angles)
    assert error is not None and error.elements.kind == "vertices"
    named = error.elements.indices.tolist()
    given = dict(zip(cones, angles, strict=True))
    assert len(set(named)) == len(named) > 0 and all(given[cone] is not None for cone in named)
    alone = [given[cone] if cone in named else None for cone in cones]
    assert oracle.angle_room(mesh.triangles, wanted(mesh, cones, alone)) <= CLEAR
    return sorted(named)


def rest_shared(mesh: Mesh, cones: Sequence[int], some: dict[int, float]) -> list[float]:
    """The angles `some` and, at all other cones of a sphere, equal ones that obey Gauss-Bonnet."""
    rest = (2 * PI * (len(cones) - 2) - sum(some.values())) / (len(cones) - len(some))
    return [some.get(int(cone), rest) for cone in cones]


def valence(mesh: Mesh, vertex: int) -> int:
    return int((mesh.triangles == vertex).sum())


FLOWER = meshes.flower(2)  # cones of valence 4
OCTAHEDRON, ICOSAHEDRON = meshes.octahedron(), meshes.icosahedron()


@pytest.mark.parametrize("turns", [2, 2.5])
def test_four_triangles_cannot_carry_two_turns(turns: float) -> None:
    assert valence(FLOWER, 0) == 4
    angles = rest_shared(FLOWER, FLOWER.cones, {0: turns * 2 * PI})
    assert assert_refused_for(FLOWER, FLOWER.cones.tolist(), angles) == [0]


def test_four_triangles_may_carry_almost_two_turns() -> None:
    angles = rest_shared(FLOWER, FLOWER.cones, {0: 3.9 * PI})
    assert oracle.angle_room(FLOWER.triangles, wanted(FLOWER, FLOWER.cones, angles)) > CLEAR
    assert refusal(FLOWER, FLOWER.cones, angles) is None


@pytest.mark.parametrize(
    ("mesh", "one", "other", "angle"),
    [(OCTAHEDRON, 0, 2, 3.3), (ICOSAHEDRON, 0, 11, 4.2)],
    ids=["valence 4", "valence 5"],
)
def test_neighbors_share_two_triangles(mesh: Mesh, one: int, other: int, angle: float) -> None:
    """Each could have its angle alone, but together they have two triangles fewer."""
    both = (mesh.triangles == one).any(axis=1) | (mesh.triangles == other).any(axis=1)
    assert angle < valence(mesh, one) and 2 * angle > both.sum() == valence(mesh, one) + valence(mesh, other) - 2
    cones = mesh.cones.tolist()
    for alone in (one, other):
        assert refusal(mesh, cones, rest_shared(mesh, cones, {alone: angle * PI})) is None
    angles = rest_shared(mesh, cones, {one: angle * PI, other: angle * PI})
    assert assert_refused_for(mesh, cones, angles) == sorted([one, other])


def test_a_triangle_needs_half_a_turn_at_its_corners() -> None:
    """Three sharp cones around one triangle, each of them sharp enough to be possible alone."""
    mesh = meshes.bumpy_sphere(2)
    corners = [int(v) for v in mesh.triangles[150]]
    assert not set(corners) & set(mesh.cones.tolist())
    cones = [*mesh.cones.tolist(), *corners]
    angles = rest_shared(mesh, cones, dict.fromkeys(corners, 0.3 * PI))
    assert assert_refused_for(mesh, cones, angles) == sorted(corners)
    angles = rest_shared(mesh, cones, dict.fromkeys(corners[:2], 0.3 * PI) | {corners[2]: 0.5 * PI})
    assert refusal(mesh, cones, angles) is None


def test_inside_an_open_surface() -> None:
    mesh = meshes.hill()
    top = int(mesh.cones[0])
    limit = valence(mesh, top) * PI
    assert assert_refused_for(mesh, [top], [1.05 * limit]) == [top]
    assert refusal(mesh, [top], [0.9 * limit]) is None


def test_a_corner_of_one_triangle_cannot_have_more_than_half_a_turn() -> None:
    mesh = meshes.hill()
    corner = next(v for loop in oracle.boundary_loops(mesh.triangles) for v in loop.tolist() if valence(mesh, v) == 1)
    assert assert_refused_for(mesh, [corner], [1.2 * PI]) == [corner]


def test_automatic_angles_are_not_blamed() -> None:
    cones = FLOWER.cones.tolist()
    assert assert_refused_for(FLOWER, cones, [4.2 * PI, *[None] * 5]) == [0]


def test_of_two_components_the_one_is_named() -> None:
    mesh = meshes.merge([FLOWER, FLOWER])
    cones = mesh.cones.tolist()
    angles = [None] * 6 + rest_shared(FLOWER, FLOWER.cones, {1: 4.2 * PI})
    result = lsgp.parameterize(surface(mesh), cones, angles)
    skipped = [finding for finding in result.warnings if finding.code == "COMPONENT_SKIPPED"]
    assert len(skipped) == 1 and not result.solved[len(FLOWER.triangles) :].any()
    assert result.solved[: len(FLOWER.triangles)].all()


# --- random angles ----------------------------------------------------------------------------------------------------

SMALL = {
    "octahedron": OCTAHEDRON,
    "icosahedron": ICOSAHEDRON,
    "cube": meshes.cube(1),
    "tetrahedron": meshes.subdivide(meshes.tetrahedron()),
    "flower": meshes.flower(1),
    "sphere": meshes.icosphere(1),
    "torus": meshes.torus(6, 5),
    "hill": meshes.hill(5),
}
SEEDS = range(12)


def random_angles(mesh: Mesh, seed: int) -> tuple[list[int], list[float]]:
    """Some vertices inside, and angles from even to very uneven ones; without a border they obey Gauss-Bonnet."""
    rng = np.random.default_rng(seed)
    loops = oracle.boundary_loops(mesh.triangles)
    inside = np.setdiff1d(mesh.triangles, np.concatenate([[], *loops]))
    cones = rng.choice(inside, int(rng.integers(min(4, len(inside)), len(inside) + 1)), replace=False)
    total = 2 * PI * (len(cones) - (0 if loops else oracle.euler_of(mesh.triangles)))
    return cones.tolist(), (total * rng.dirichlet(np.full(len(cones), 10 ** rng.uniform(-0.5, 1)))).tolist()


@pytest.mark.parametrize("name", SMALL)
def test_angles_are_refused_exactly_where_no_triangles_have_them(name: str) -> None:
    """Both answers come from all over: a linear program over the corners knows which."""
    mesh = SMALL[name]
    ends = []
    for seed in SEEDS:
        cones, angles = random_angles(mesh, seed)
        room = oracle.angle_room(mesh.triangles, wanted(mesh, cones, angles))
        assert abs(room) > CLEAR
        ends.append(room < 0)
        if room < 0:
            assert_refused_for(mesh, cones, angles)
        else:
            assert refusal(mesh, cones, angles) is None
    assert len(set(ends)) == 2


# --- automatic angles -------------------------------------------------------------------------------------------------

SPONGE = sponge(1)  # genus 5, 64 vertices


def cones_on_one_side(seed: int) -> list[int]:
    """A few vertices next to each other: of the tunnels far from them no angle is left to choose."""
    rng = np.random.default_rng(seed)
    count, center = int(rng.integers(4, 16)), SPONGE.positions[rng.integers(len(SPONGE.positions))]
    return np.argsort(np.linalg.norm(SPONGE.positions - center, axis=1), kind="stable")[:count].tolist()


def test_cones_are_refused_exactly_where_no_angles_suit_the_other_vertices() -> None:
    """A linear program over the corners knows where, and counting triangles proves the reason."""
    ends = []
    for seed in SEEDS:
        cones = cones_on_one_side(seed)
        possible = oracle.angle_room(SPONGE.triangles, wanted(SPONGE, cones, [None] * len(cones))) > CLEAR
        ends.append(possible)
        if possible:
            lsgp.parameterize(surface(SPONGE), cones)
            continue
        with pytest.raises(lsgp.CurvatureError, match="Mark a cone among these vertices") as refused:
            lsgp.parameterize(surface(SPONGE), cones)
        assert refused.value.code == "ANGLES_IMPOSSIBLE" and refused.value.elements.kind == "vertices"
        named = refused.value.elements.indices
        assert not np.isin(named, cones).any()
        # Half a turn each is as much as all these vertices can take, or more.
        among = int(np.isin(SPONGE.triangles, named).all(axis=1).sum())
        assert among >= 2 * len(named) > 0
        assert f"carry {180 * among} degrees" in str(refused.value)
    assert len(set(ends)) == 2


def test_a_cone_among_the_vertices_named_makes_angles_possible() -> None:
    mesh = meshes.merge([SPONGE, FLOWER])
    cones = cones_on_one_side(1)[:4]
    both = [*cones, *(FLOWER.cones + len(SPONGE.positions)).tolist()]
    for _ in range(20):
        result = lsgp.parameterize(surface(mesh), both)
        skipped = [finding for finding in result.warnings if finding.code == "COMPONENT_SKIPPED"]
        if not skipped:
            break
        assert "ANGLES_IMPOSSIBLE" in skipped[0].message and result.solved.sum() == len(FLOWER.triangles)
        with pytest.raises(lsgp.CurvatureError) as refused:
            lsgp.parameterize(surface(SPONGE), cones)
        named = refused.value.elements.indices
        added = int(named[np.argmax(np.linalg.norm(SPONGE.positions[named] - SPONGE.positions[cones[0]], axis=1))])
        cones, both = [*cones, added], [*both, added]
    assert 4 < len(cones) < 20 and result.solved.all()
    assert oracle.angle_room(SPONGE.triangles, wanted(SPONGE, cones, [None] * len(cones))) > CLEAR
