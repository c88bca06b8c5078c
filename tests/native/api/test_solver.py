# SPDX-License-Identifier: GPL-3.0-or-later
"""One factorization for the whole map, kept from call to call; the dense problems on the cut beside the sparse ones."""

from __future__ import annotations

import contextlib
import dataclasses
import functools
import threading
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor

import lsgp
import meshes
import numpy as np
import pytest
import zoo
from map_checks import digest
from sanitized_run import many_solves

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


def assert_same_placement(one: lsgp.Placement, other: lsgp.Placement) -> None:
    assert np.array_equal(one.cones, other.cones) and np.array_equal(one.cone_angles, other.cone_angles)
    assert np.array_equal(one.log_scale, other.log_scale) and one.mapped_l2 == other.mapped_l2
    assert one.warnings == other.warnings


def two_spheres() -> meshes.Mesh:
    return meshes.merge([meshes.bumpy_sphere(2), meshes.flower(2)])


@pytest.mark.parametrize("make", [meshes.bumpy_sphere, meshes.torus, two_spheres])
def test_the_map_of_placed_cones_takes_no_factorization(make: object) -> None:
    surface = surface_of(make())
    solver = lsgp.Solver(surface)
    placed = solver.place_cones(count=8)
    assert placed.factorizations > 0
    assert_same_placement(placed, lsgp.place_cones(surface, count=8))
    given = placed.cones, placed.cone_angles
    result = solver.parameterize(*given)
    assert result.factorizations == 0
    assert_same(result, lsgp.parameterize(surface, *given))
    low = lsgp.Options(mode="low-stretch")
    assert_same(solver.parameterize(*given, low), lsgp.parameterize(surface, *given, low))


def test_placing_cones_again_is_as_at_first() -> None:
    surface, cones = two_seamed_cubes(), meshes.cube(2).cones
    solver = lsgp.Solver(surface)
    for given, count in [((), 8), (cones, None), ((), 0), ((), 6)]:
        assert_same_placement(solver.place_cones(given, count=count), lsgp.place_cones(surface, given, count=count))
        assert_same(solver.parameterize(cones), lsgp.parameterize(surface, cones))


def test_a_placement_that_is_stopped_leaves_no_trace() -> None:
    surface = surface_of(meshes.bumpy_sphere())
    solver = lsgp.Solver(surface)
    fresh = lsgp.place_cones(surface, count=6)
    for calls in (0, 3, 12):
        with contextlib.suppress(lsgp.Cancelled):
            solver.place_cones(count=6, progress=stops_after(calls))
        assert_same_placement(solver.place_cones(count=6), fresh)
        assert_same(solver.parameterize(fresh.cones), lsgp.parameterize(surface, fresh.cones))


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
        # On a torus the twist about the handles is chosen anew where more than the size changes.
        assert again.factorizations == (1 if make is meshes.torus and len(changed) > 1 else 0)


@pytest.mark.parametrize(
    "make",
    [
        lambda: zoo.closed.box(4, (1, 2, 3)),
        pytest.param(lambda: zoo.closed.gear(8, 0.2, 1), marks=pytest.mark.many_solves),
    ],
)
def test_tiles_of_another_size_take_neither_another_map_nor_another_alignment_of_creases(make: object) -> None:
    mesh = make()
    surface = surface_of(mesh)
    cones = lsgp.place_cones(surface, lattice="square").cones
    solver = lsgp.Solver(surface)
    options = lsgp.Options(seamless=lsgp.Seamless(), straighten=True)
    for tiles in (None, 24, 48, 24):
        sized = dataclasses.replace(options, seamless=lsgp.Seamless(tiles=tiles))
        again, fresh = solver.parameterize(cones, options=sized), lsgp.parameterize(surface, cones, options=sized)
        assert outcome(lambda result=again: result) == outcome(lambda result=fresh: result)
        if tiles is None:
            continue
        assert again.seamless.feature_share > 0
        # What finds the coordinates and rounds them is left.
        assert again.factorizations < fresh.factorizations - 2


def test_moved_cone_is_that_of_a_fresh_start() -> None:
    mesh = meshes.bumpy_sphere()
    solver = lsgp.Solver(surface_of(mesh))
    solver.parameterize(mesh.cones, options=RAW)
    moved = mesh.cones.copy()
    neighbors = np.unique(mesh.triangles[(mesh.triangles == moved[0]).any(axis=1)])
    moved[0] = np.setdiff1d(neighbors, moved)[0]
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


def test_maps_that_were_split_are_made_compact_again_in_other_ways() -> None:
    """What a solver keeps of a split map gives the islands that one makes that has kept nothing."""
    mesh = meshes.bumpy_sphere()
    surface = surface_of(mesh)
    solver = lsgp.Solver(surface)
    split = lsgp.Options(mode="low-stretch", overlaps="split")
    ways = [
        split,
        dataclasses.replace(split, compact="full"),
        dataclasses.replace(split, compact="sparing"),
        dataclasses.replace(split, compact="full", square_share=2.0),
        dataclasses.replace(split, compact="full", straighten=True),
        dataclasses.replace(split, mode="conformal"),
        dataclasses.replace(split, overlaps="keep"),
        split,
    ]
    for options in ways:
        for cones in (mesh.cones, mesh.cones[1:]):
            assert_same(solver.parameterize(cones, options=options), lsgp.parameterize(surface, cones, options=options))


def test_straight_sides_are_found_once() -> None:
    mesh = meshes.cylinder()
    surface = surface_of(mesh)
    options = lsgp.Options(mode="low-stretch", overlaps="split", compact="sparing", straighten=True)
    solver = lsgp.Solver(surface)
    fresh = solver.parameterize([], options=options)
    again = solver.parameterize([], options=options)
    assert again.factorizations == 0 < fresh.factorizations
    assert_same(again, lsgp.parameterize(surface, [], options=options))
    further = dataclasses.replace(options, square_share=2.0)
    assert_same(solver.parameterize([], options=further), lsgp.parameterize(surface, [], options=further))


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


def two_seamed_cubes() -> lsgp.Surface:
    mesh = meshes.merge([meshes.cube(2), meshes.cube(2)])
    return lsgp.Surface(mesh.positions, mesh.triangles, seams=meshes.edges_of(mesh.triangles))


def test_cones_that_move_to_another_part_open_and_close_both() -> None:
    surface = two_seamed_cubes()
    solver = lsgp.Solver(surface)
    half = len(surface.positions) // 2
    cones = meshes.cube(2).cones
    for given in (cones, cones + half, cones, [], np.concatenate([cones, cones + half])):
        assert_same(solver.parameterize(given), lsgp.parameterize(surface, given))


def test_changed_angles_take_no_factorization_where_another_part_is_open_along_its_seams() -> None:
    surface, cones = two_seamed_cubes(), meshes.cube(2).cones
    solver = lsgp.Solver(surface)
    assert solver.parameterize(cones).factorizations > 0
    angles = [1.4 * np.pi] + [None] * (len(cones) - 1)
    again = solver.parameterize(cones, angles)
    assert again.factorizations == 0
    assert_same(again, lsgp.parameterize(surface, cones, angles))


def outcome(call: object, *args: object) -> object:
    """What a result holds but for the time and the linear algebra it took, or what it was refused for."""
    try:
        result = call(*args)
    except lsgp.LsgpError as error:
        return error.code, str(error), error.elements.indices.tolist()
    return digest(dataclasses.replace(result, factorizations=0, back_substitutions=0))


def stops_after(calls: int) -> Callable[[float], bool]:
    left = iter(range(calls))
    return lambda done: next(left, None) is not None


def linked_solvers(first: lsgp.Surface, *others: lsgp.Surface) -> list[lsgp.Solver]:
    solvers = [lsgp.Solver(first)]
    for surface in others:
        solvers.append(lsgp.Solver(surface, solvers[-1]))
    return solvers


def around_triangle(mesh: meshes.Mesh, triangle: int) -> np.ndarray:
    a, b, c = mesh.triangles[triangle]
    return np.array([[a, b], [b, c], [c, a]])


CHANGES: dict[str, list[object]] = {
    "prescription": [None, "harmonic", "straightness"],
    "unfold": ["poisson", "spectral"],
    "method": ["lsgp", "lscm"],
    "seams": ["follow", "boundary", "ignore"],
    "border": ["free", "straight"],
    "seamless": [
        None,
        lsgp.Seamless(tiles=8),
        lsgp.Seamless(tiles=12),
        lsgp.Seamless(tiles=6, lattice="stripe", coarse_grid="merge"),
    ],
    "straighten": [False, True],
    "mode": ["conformal", "low-stretch"],
    "stretch": [1.0, 0.5],
    "repair": [True, False],
    "overlaps": ["keep", "split"],
    "compact": ["off", "full"],
    "mirrored_cuts": [False, True],
    "follow_strokes": [True, False],
    "factorization": ["automatic", "cut", "sparse"],
    "loop_turning": [{}, {0: 2 * np.pi}],
}


@pytest.mark.slow
@pytest.mark.parametrize("seed", [0, 1, 2, *many_solves(3, 4, 5)])
def test_any_sequence_of_calls_is_that_of_fresh_starts(seed: int) -> None:
    rng = np.random.default_rng(seed)
    mesh = meshes.merge([meshes.cube(2), meshes.grid(4, 4), meshes.torus(8, 6), meshes.bumpy_sphere(1)])
    edges = meshes.edges_of(mesh.triangles)
    weights = rng.random(len(mesh.positions)) if seed % 2 else None
    surface = lsgp.Surface(
        mesh.positions, mesh.triangles, seams=rng.choice(edges, len(edges) // 6, replace=False), importance=weights
    )
    solvers = linked_solvers(
        surface,
        dataclasses.replace(surface, borders=around_triangle(mesh, 0)),
        dataclasses.replace(surface, borders=around_triangle(mesh, len(mesh.triangles) - 1), features=edges[:20]),
        dataclasses.replace(surface, directions=rng.random((len(mesh.triangles), 3))),
    )
    options, cones, angles, pins = lsgp.Options(), mesh.cones, None, None
    solved = 0
    for _ in range(80):
        solver = solvers[0 if rng.random() < 0.5 else rng.integers(len(solvers))]
        # One thing is changed at a time, or all are changed back.
        what = rng.choice([*CHANGES, "cones", "cones", "angles", "pins", "cancel", *["all"] * 3])
        if what == "cones":
            some = rng.choice(len(mesh.positions), rng.integers(0, 12), replace=False)
            cones, angles = (
                [mesh.cones, mesh.cones[:8], mesh.cones[::-1], some, [*mesh.cones, 10**6]][rng.integers(5)],
                None,
            )
        elif what == "angles":
            angles = [None if rng.random() < 0.7 else float(rng.uniform(4, 8)) for _ in cones]
        elif what == "pins":
            corners = rng.choice(3 * len(mesh.triangles), rng.integers(1, 4), replace=False)
            pins = None if pins is not None else lsgp.Pins(corners, rng.random((len(corners), 2)))
        elif what == "cancel":
            with contextlib.suppress(lsgp.LsgpError):
                solver.parameterize(cones, angles, options, pins, stops_after(int(rng.integers(1, 30))))
        elif what in CHANGES:
            choices = CHANGES[what]
            options = dataclasses.replace(options, **{what: choices[rng.integers(len(choices))]})
        elif what == "all":
            options, cones, angles, pins = lsgp.Options(), mesh.cones, None, None
        call = (cones, angles, options, pins)
        found = outcome(solver.parameterize, *call)
        assert found == outcome(lsgp.parameterize, solver.surface, *call), (what, options)
        solved += isinstance(found, str)
        if rng.random() < 0.2:
            count, is_symmetric = [None, 0, 4][rng.integers(3)], bool(rng.integers(2))
            placing = {"count": count, "symmetric": is_symmetric, "seams": options.seams}
            placed = outcome(functools.partial(solver.place_cones, **placing))
            assert placed == outcome(functools.partial(lsgp.place_cones, solver.surface, **placing)), placing
    assert solved > 10


@pytest.mark.parametrize("options", [lsgp.Options(overlaps="split"), lsgp.Options(seamless=lsgp.Seamless())])
def test_components_that_a_border_leaves_as_they_are_are_solved_once(options: lsgp.Options) -> None:
    sphere, flower = meshes.bumpy_sphere(2), meshes.flower(2)
    both = meshes.merge([sphere, flower])
    surface = surface_of(both)
    opened = dataclasses.replace(surface, borders=around_triangle(both, 0))
    first, second = linked_solvers(surface, opened)
    placed = first.place_cones()
    first.parameterize(placed.cones, placed.cone_angles, options)
    again = second.place_cones()
    assert 0 < again.factorizations < lsgp.place_cones(opened).factorizations
    assert_same_placement(again, lsgp.place_cones(opened))
    given = again.cones, again.cone_angles, options
    result = second.parameterize(*given)
    assert result.factorizations < lsgp.parameterize(opened, *given).factorizations
    assert_same(result, lsgp.parameterize(opened, *given))


def test_linked_solvers_are_busy_together() -> None:
    mesh = meshes.bumpy_sphere()
    surface = surface_of(mesh)
    first, second = linked_solvers(surface, dataclasses.replace(surface, borders=around_triangle(mesh, 0)))
    refusals = []

    def call_other(done: float) -> None:
        with pytest.raises(lsgp.SolverError) as refused:
            first.parameterize(mesh.cones)
        refusals.append(refused.value.code)

    second.parameterize(mesh.cones, progress=call_other)
    assert refusals and set(refusals) == {"SOLVER_BUSY"}


def test_call_from_its_own_progress_is_refused_and_leaves_the_outer_one_as_it_is() -> None:
    mesh = meshes.bumpy_sphere()
    solver = lsgp.Solver(surface_of(mesh))
    refusals = []

    def call_again(done: float) -> None:
        with pytest.raises(lsgp.SolverError) as refused:
            solver.parameterize(mesh.cones[1:])
        refusals.append(refused.value.code)

    result = solver.parameterize(mesh.cones, progress=call_again)
    assert refusals and set(refusals) == {"SOLVER_BUSY"}
    assert_same(result, lsgp.parameterize(surface_of(mesh), mesh.cones))
    assert_same(solver.parameterize(mesh.cones), result)


def test_threads_that_share_a_solver_take_turns_or_are_refused() -> None:
    mesh = meshes.bumpy_sphere()
    solver = lsgp.Solver(surface_of(mesh))
    fresh = [lsgp.parameterize(surface_of(mesh), cones, options=RAW) for cones in (mesh.cones, mesh.cones[1:])]
    # The first waits in its progress until the second has been refused.
    is_under_way, was_refused = threading.Event(), threading.Event()

    def wait(done: float) -> None:
        is_under_way.set()
        assert was_refused.wait(60)

    with ThreadPoolExecutor(2) as threads:
        first = threads.submit(solver.parameterize, mesh.cones, None, RAW, None, wait)
        assert is_under_way.wait(60)
        second = threads.submit(solver.parameterize, mesh.cones[1:], None, RAW)
        with pytest.raises(lsgp.SolverError, match="already running a call") as refused:
            second.result(60)
        was_refused.set()
        assert refused.value.code == "SOLVER_BUSY"
        assert_same(first.result(60), fresh[0])
    assert_same(solver.parameterize(mesh.cones[1:], options=RAW), fresh[1])


def test_straight_sides_on_a_lattice_are_not_those_of_an_earlier_call() -> None:
    """An island without cuts has them before it is put onto the lattice."""
    mesh = meshes.grid(6, 4, lambda x, y: 0.3 * np.sin(x) * y)
    sheet = lsgp.Surface(mesh.positions, mesh.triangles)
    solver = lsgp.Solver(sheet)
    found = []
    for straighten in (False, True, False, True):
        options = lsgp.Options(seamless=lsgp.Seamless(tiles=8), straighten=straighten)
        found.append(solver.parameterize((), options=options).corner_uv)
        assert np.array_equal(found[-1], lsgp.parameterize(sheet, (), options=options).corner_uv)
    assert not np.array_equal(found[0], found[1])
