# SPDX-License-Identifier: GPL-3.0-or-later
"""One factorization for the whole map, kept from call to call; the dense problems on the cut beside the sparse ones."""

import lsgp
import meshes
import numpy as np
import pytest

RAW = lsgp.Options(repair=False)
SHAPES = [meshes.cube, meshes.bumpy_sphere, meshes.saddle, meshes.cylinder, meshes.torus]


def surface_of(mesh: meshes.Mesh) -> lsgp.Surface:
    return lsgp.Surface(mesh.positions, mesh.triangles)


def assert_same(one: lsgp.Result, other: lsgp.Result, tolerance: float = 0) -> None:
    assert np.abs(one.corner_uv - other.corner_uv).max() <= tolerance
    assert np.abs(one.cone_angles - other.cone_angles).max(initial=0) <= tolerance
    assert np.array_equal(one.cut_edges, other.cut_edges)
    assert [w.code for w in one.warnings] == [w.code for w in other.warnings]


WAYS = {
    "poisson": {},
    "spectral": {"unfold": "spectral"},
    "straightness": {"prescription": "straightness"},
    "seamless": {"seamless": lsgp.Seamless(tiles=16)},
}


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("make", SHAPES)
def test_both_factorizations_give_the_same_map(make: object, way: str) -> None:
    mesh = make()
    maps = [
        lsgp.parameterize(
            surface_of(mesh), mesh.cones, options=lsgp.Options(repair=False, factorization=factorization, **WAYS[way])
        )
        for factorization in ("cut", "sparse")
    ]
    edges = [np.linalg.norm(np.roll(result.corner_uv, -1, axis=1) - result.corner_uv, axis=2) for result in maps]
    assert np.abs(edges[0] - edges[1]).max() < 1e-9
    assert np.abs(maps[0].cone_angles - maps[1].cone_angles).max(initial=0) < 1e-9


@pytest.mark.parametrize("make", [meshes.cube, meshes.bumpy_sphere])
def test_whole_map_takes_one_factorization(make: object) -> None:
    mesh = make()
    one = lsgp.parameterize(surface_of(mesh), mesh.cones, options=RAW)
    assert one.factorizations == 1
    # The surface's own metric, one a cone but that which fixes the constant, and the two coordinates.
    assert one.back_substitutions == 1 + (len(mesh.cones) - 1) + 2
    spectral = lsgp.Options(repair=False, unfold="spectral")
    same = lsgp.parameterize(surface_of(mesh), mesh.cones, options=spectral)
    assert (same.factorizations, same.back_substitutions) == (1, one.back_substitutions)
    two = lsgp.parameterize(surface_of(mesh), mesh.cones, options=lsgp.Options(repair=False, factorization="sparse"))
    assert two.factorizations == 2


def test_integers_take_one_factorization_and_two_back_substitutions() -> None:
    mesh = meshes.cube()
    plain, seamless = (
        lsgp.parameterize(surface_of(mesh), mesh.cones, options=lsgp.Options(repair=False, seamless=seamless))
        for seamless in (None, lsgp.Seamless(tiles=16))
    )
    assert seamless.factorizations == plain.factorizations + 1
    assert seamless.back_substitutions == plain.back_substitutions + 2


def test_changed_angles_take_no_factorization() -> None:
    mesh = meshes.bumpy_sphere()
    solver = lsgp.Solver(surface_of(mesh))
    first = solver.parameterize(mesh.cones, options=RAW)
    angles = [float(first.cone_angles[0]) + 0.2, *[None] * (len(mesh.cones) - 1)]
    edited = solver.parameterize(mesh.cones, angles, RAW)
    assert (edited.factorizations, edited.back_substitutions) == (0, 2)
    assert edited.cone_angles[0] == angles[0]
    assert_same(edited, lsgp.parameterize(surface_of(mesh), mesh.cones, angles, RAW))
    harmonic = lsgp.Options(repair=False, prescription="harmonic")
    assert solver.parameterize(mesh.cones, options=harmonic).factorizations == 0
    assert_same(solver.parameterize(mesh.cones, options=RAW), first)


@pytest.mark.parametrize("make", [meshes.cube, meshes.bumpy_sphere, meshes.torus])
def test_changed_seamless_options_take_no_factorization(make: object) -> None:
    mesh = make()
    solver = lsgp.Solver(surface_of(mesh))

    def seamless(**changed: object) -> tuple[lsgp.Result, lsgp.Result]:
        options = lsgp.Options(repair=False, seamless=lsgp.Seamless(**changed))
        return solver.parameterize(mesh.cones, options=options), lsgp.parameterize(
            surface_of(mesh), mesh.cones, options=options
        )

    assert_same(*seamless(tiles=16))
    for changed in ({"tiles": 32}, {"tiles": 24, "parity": True}, {"tiles": 16, "cell": 0.25}):
        again, fresh = seamless(**changed)
        assert_same(again, fresh)
        # On a torus the twist about the handles is chosen anew.
        assert again.factorizations == (1 if make is meshes.torus else 0)


def test_moved_cone_is_that_of_a_fresh_start() -> None:
    mesh = meshes.bumpy_sphere()
    solver = lsgp.Solver(surface_of(mesh))
    solver.parameterize(mesh.cones, options=RAW)
    moved = mesh.cones.copy()
    neighbours = np.unique(mesh.triangles[(mesh.triangles == moved[0]).any(axis=1)])
    moved[0] = np.setdiff1d(neighbours, moved)[0]
    result = solver.parameterize(moved, options=RAW)
    assert result.factorizations == 1
    assert_same(result, lsgp.parameterize(surface_of(mesh), moved, options=RAW))


def test_every_kind_of_call_is_that_of_a_fresh_start() -> None:
    mesh = meshes.bumpy_sphere()
    surface = surface_of(mesh)
    solver = lsgp.Solver(surface)
    calls = [
        (mesh.cones, lsgp.Options()),
        (mesh.cones[:-1], lsgp.Options()),
        (mesh.cones, lsgp.Options(mode="low-stretch")),
        (mesh.cones, lsgp.Options(seamless=lsgp.Seamless(tiles=16))),
        (mesh.cones, lsgp.Options(seams="ignore")),
        (mesh.cones, lsgp.Options(factorization="sparse")),
        (mesh.cones, lsgp.Options(unfold="spectral")),
    ]
    for cones, options in calls:
        assert_same(solver.parameterize(cones, options=options), lsgp.parameterize(surface, cones, options=options))


def test_refused_call_leaves_the_solver_usable() -> None:
    mesh = meshes.bumpy_sphere()
    solver = lsgp.Solver(surface_of(mesh))
    first = solver.parameterize(mesh.cones, options=RAW)
    with pytest.raises(lsgp.CurvatureError, match="curvature"):
        solver.parameterize(mesh.cones, [1.0] * len(mesh.cones), RAW)
    with pytest.raises(lsgp.InputError):
        solver.parameterize([len(mesh.positions)], options=RAW)
    with pytest.raises(lsgp.Cancelled):
        solver.parameterize(mesh.cones, options=RAW, progress=lambda done: False)
    assert_same(solver.parameterize(mesh.cones, options=RAW), first)
