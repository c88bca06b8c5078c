# SPDX-License-Identifier: GPL-3.0-or-later
"""The same input gives the same bytes, in this process and in others; the same surface gives the same map."""

from __future__ import annotations

import hashlib
from dataclasses import replace

import lsgp
import meshes
import numpy as np
import oracle
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from jitter.jittered_inputs import moved
from lsgp.base.angles import arctan2
from lsgp.quads.quad_map import QuadCenters, map_on_quads
from map_checks import digest, pairs, surface, unwrap
from other_process import in_another_process

SURFACES = {
    "bumpy sphere": meshes.bumpy_sphere(3),
    "cube, many equal paths": meshes.cube(4),
    "parts": meshes.merge([meshes.flower(2), meshes.disk_with_holes(12, 2), meshes.cylinder(8, 3)]),
}


@pytest.mark.parametrize("unfold", ["poisson", "spectral"])
@pytest.mark.parametrize("name", SURFACES)
def test_twice_the_same_bytes(name: str, unfold: str) -> None:
    one, two = unwrap(SURFACES[name], unfold=unfold), unwrap(SURFACES[name], unfold=unfold)
    assert digest(one) == digest(two)


@pytest.mark.slow
@pytest.mark.parametrize("threads", ["1", "3"])
def test_another_process_with_other_threads_gives_the_same_bytes(threads: str) -> None:
    script = (
        "import meshes, test_determinism as t\n"
        "from map_checks import digest, unwrap\n"
        "for mesh in t.SURFACES.values(): print(digest(unwrap(mesh)), digest(unwrap(mesh, unfold='spectral')))\n"
    )
    printed = in_another_process(script, LSGP_THREADS=threads, PYTHONHASHSEED=threads)
    expected = [f"{digest(unwrap(m))} {digest(unwrap(m, unfold='spectral'))}" for m in SURFACES.values()]
    assert printed.split("\n")[:-1] == expected


def computed_in_python() -> list[str]:
    """Digests of results that numpy has a part in."""
    mesh = meshes.bumpy_sphere(3)
    ball = lsgp.Surface(mesh.positions, mesh.triangles, features=mesh.triangles[:40, :2])
    quads = lsgp.remesh_to_quads(ball, target=150).mesh
    centers = QuadCenters(quads.triangles[quads.quads[:, 0]], quads.positions[quads.quads[:, 0]])
    corner_uv = mesh.positions[mesh.triangles][..., :2]
    bends = [lsgp.feature_edges(ball, angle=angle) for angle in np.linspace(0.02, 0.4, 20)]
    found = {
        "bends": np.concatenate(bends),
        "arctan2": arctan2(*mesh.positions.T[:2]),
        "directions": lsgp.edge_directions(ball, mesh.triangles[:, :2], up=(0.3, 0.5, 0.7)),
        "polished": quads.positions,
        "map": map_on_quads(ball, quads, centers, corner_uv).corner_uv,
    }
    return [f"{name} {hashlib.sha256(values.tobytes()).hexdigest()}" for name, values in found.items()]


@pytest.mark.slow
def test_what_python_computes_is_the_same_on_older_processors() -> None:
    """Numpy and its BLAS have an implementation for each set of instructions, and round otherwise in each."""
    printed = in_another_process(
        "import test_determinism as t; print('\\n'.join(t.computed_in_python()))",
        OPENBLAS_CORETYPE="Nehalem",
        NPY_DISABLE_CPU_FEATURES="FMA3 AVX2 AVX512F AVX512CD AVX512_SKX AVX512_CLX AVX512_CNL AVX512_ICL AVX512_SPR "
        "X86_V3 X86_V4",
    )
    assert printed.splitlines() == computed_in_python()


SYMMETRIC = {
    "cube": meshes.cube(3),
    "two cubes": meshes.merge([meshes.cube(2)] * 2),
    "equal islands": meshes.merge([meshes.cylinder(8, 3)] * 3),
}


@pytest.mark.slow
@pytest.mark.parametrize("unfold", ["poisson", "spectral"])
@pytest.mark.parametrize("name", SYMMETRIC)
def test_rounding_does_not_choose_rotations_and_places(name: str, unfold: str) -> None:
    """Other processors and compilers round differently; here positions differ in their last digits, and cuts do not.
    What is equal in a shape is equal but for rounding in most of these bases, where another of equals is the first."""
    random = np.random.default_rng(0)
    mesh = SYMMETRIC[name]
    for base in [mesh.positions, *(moved(mesh.positions, str(seed)) for seed in range(20))]:
        cuts = unwrap(mesh._replace(positions=base), unfold=unfold).cut_edges
        expected = unwrap(mesh._replace(positions=base), seams=cuts, unfold=unfold)
        for _ in range(4):
            rounded = base * (1 + random.uniform(-1e-15, 1e-15, base.shape))
            found = unwrap(mesh._replace(positions=rounded), seams=cuts, unfold=unfold)
            assert pairs(found.cut_edges) == pairs(expected.cut_edges)
            assert found.corner_uv == pytest.approx(expected.corner_uv, abs=1e-12)


@settings(max_examples=6)
@given(seed=st.integers(0, 2**32 - 1), exponent=st.floats(-6, 6))
def test_motion_and_scale_change_nothing(seed: int, exponent: float) -> None:
    mesh = meshes.bumpy_sphere(2)
    moved = meshes.transform(mesh, seed, 10**exponent)
    one, two = unwrap(mesh), unwrap(moved)
    assert pairs(one.cut_edges) == pairs(two.cut_edges)
    assert two.cone_angles == pytest.approx(one.cone_angles, abs=1e-7)
    assert two.log_scale == pytest.approx(one.log_scale, abs=1e-7)
    assert oracle.metric_gap(one.corner_uv, two.corner_uv) <= 1e-7


@settings(max_examples=6)
@given(seed=st.integers(0, 2**32 - 1))
def test_numbering_changes_nothing(seed: int) -> None:
    mesh = meshes.bumpy_sphere(2)
    shuffled, new_of_old, old_corner = meshes.renumber(mesh, seed)
    one, two = unwrap(mesh), unwrap(shuffled)
    assert {tuple(sorted(edge)) for edge in new_of_old[one.cut_edges].tolist()} == pairs(two.cut_edges)
    order = np.argsort(two.cones)[np.argsort(np.argsort(new_of_old[one.cones]))]
    assert two.cone_angles[order] == pytest.approx(one.cone_angles, abs=1e-7)
    there = one.corner_uv.reshape(-1, 2)[old_corner].reshape(-1, 3, 2)
    assert oracle.metric_gap(there, two.corner_uv) <= 1e-7


@settings(max_examples=4)
@given(seed=st.integers(0, 2**32 - 1))
def test_order_of_cones_changes_nothing(seed: int) -> None:
    mesh = meshes.bumpy_sphere(2)
    order = np.random.default_rng(seed).permutation(len(mesh.cones))
    one = unwrap(mesh)
    two = lsgp.parameterize(surface(mesh), mesh.cones[order])
    angles = [dict(zip(r.cones.tolist(), r.cone_angles.tolist(), strict=True)) for r in (one, two)]
    assert angles[1] == pytest.approx(angles[0], abs=1e-9)
    assert oracle.metric_gap(one.corner_uv, two.corner_uv) <= 1e-9


def given_otherwise(mesh: meshes.Mesh, seed: int) -> meshes.Mesh:
    """The same surface with other numbers of vertices and triangles, turned, moved and scaled."""
    return meshes.transform(meshes.renumber(mesh, seed)[0], seed, scale=(1.0, 1000.0, 0.01)[seed % 3])


def press(mesh: meshes.Mesh, preset: lsgp.Preset) -> tuple[int, float, float]:
    """Islands, cost, and the part of the square that is filled."""
    result = lsgp.auto_unwrap(surface(mesh), preset=preset)
    cost = min(choice.cost for choice in result.choices if choice.is_best and choice.cost is not None)
    sides = np.diff(result.corner_uv[result.solved], axis=1)
    area = np.abs(sides[:, 0, 0] * sides[:, 1, 1] - sides[:, 0, 1] * sides[:, 1, 0]).sum() / 2
    return len(np.unique(result.island[result.solved])), cost, area


def edges_with(pairs_of: np.ndarray, new: np.ndarray) -> set[tuple[int, ...]]:
    return {tuple(sorted(edge)) for edge in new[pairs_of].tolist()}


@pytest.mark.parametrize("what", ["plain", "costs", "importance", "scale", "directions", "seams", "features", "cones"])
@pytest.mark.parametrize("preset", ["paint", "tile"])
def test_what_comes_out_of_a_press_is_in_the_numbering_that_was_given(preset: lsgp.Preset, what: str) -> None:
    mesh = meshes.merge([meshes.flower(2), meshes.hill(6)])
    edges, n = meshes.edges_of(mesh.triangles), len(mesh.positions)
    height = mesh.positions[:, 1] - mesh.positions[:, 1].min()
    marked: dict[str, np.ndarray] = {}
    if what == "costs":
        marked = {"edges": edges, "cut_costs": np.exp(height[edges[:, 0]])}
    elif what in ("importance", "scale"):
        marked = {what: 1 + 0.02 * height}
    elif what == "directions":
        marked = {what: np.tile([0.0, 0.2, 1.0], (len(mesh.triangles), 1))}
    elif what in ("seams", "features"):
        marked = {what: edges[:12]}
    cones = [int(mesh.positions[:, axis].argmax()) for axis in range(3)] if what == "cones" else []
    one = lsgp.auto_unwrap(lsgp.Surface(mesh.positions, mesh.triangles, **marked), cones, preset=preset)
    twin, new, old_corner = meshes.renumber(mesh, 5)
    old = np.argsort(new)
    renumbered = {
        name: new[array] if array.dtype != float else array[old] if len(array) == n else array
        for name, array in marked.items()
    }
    if what == "directions":
        renumbered = {what: marked[what][old_corner[::3] // 3]}
    two = lsgp.auto_unwrap(lsgp.Surface(twin.positions, twin.triangles, **renumbered), new[cones], preset=preset)
    assert dict(zip(new[one.cones].tolist(), one.cone_angles.tolist(), strict=True)) == pytest.approx(
        dict(zip(two.cones.tolist(), two.cone_angles.tolist(), strict=True))
    )
    assert edges_with(one.cut_edges, new) == edges_with(two.cut_edges, np.arange(n))
    assert edges_with(one.borders, new) == edges_with(two.borders, np.arange(n))
    assert one.log_scale[old] == pytest.approx(two.log_scale, abs=1e-6)
    lengths = [np.linalg.norm(np.diff(r.corner_uv, axis=1, append=r.corner_uv[:, :1]), axis=2) for r in (one, two)]
    assert lengths[0].ravel()[old_corner] == pytest.approx(lengths[1].ravel(), rel=1e-5)
    of_old = one.island[old_corner[::3] // 3]
    assert len(set(zip(of_old.tolist(), two.island.tolist(), strict=True))) == one.island.max() + 1
    assert [two.island.tolist().index(i) for i in range(two.island.max() + 1)] == sorted(
        two.island.tolist().index(i) for i in range(two.island.max() + 1)
    )
    if what == "directions":
        assert one.direction_errors[old_corner[::3] // 3] == pytest.approx(two.direction_errors, abs=1e-6, nan_ok=True)
    assert sorted((f.code, len(f.elements.indices)) for f in one.warnings) == sorted(
        (f.code, len(f.elements.indices)) for f in two.warnings
    )


@pytest.mark.parametrize("vertex", [-7, 64, 2**30])
def test_what_names_no_vertex_is_refused_in_the_numbers_that_were_given(vertex: int) -> None:
    given = surface(meshes.grid(7, 7))
    with pytest.raises(lsgp.InputError, match=rf"\({vertex}\)"):
        lsgp.auto_unwrap(given, sharp=[[3, vertex]])
    with pytest.raises(lsgp.InputError, match=rf"\({vertex}\)"):
        lsgp.auto_unwrap(given, options=lsgp.Options(loop_turning={vertex: 1.0}))


def test_sizes_are_told_in_the_unit_that_was_given() -> None:
    for scale in (1.0, 1000.0):
        given = surface(meshes.transform(meshes.cube(3), 1, scale))
        size = lsgp.Seamless(tile_size=0.5 * scale)
        result = lsgp.auto_unwrap(given, preset="tile", options=replace(lsgp.preset_options("tile"), seamless=size))
        assert result.seamless.tile_size == pytest.approx(0.5 * scale, rel=0.5)
        wrong = replace(lsgp.preset_options("tile"), seamless=lsgp.Seamless(tile_size=-1.0))
        with pytest.raises(lsgp.InputError, match=r"size is -1\."):
            lsgp.auto_unwrap(given, preset="tile", options=wrong)


@pytest.mark.parametrize("preset", ["paint", "bake"])
def test_a_press_makes_the_same_map_of_the_same_surface(preset: lsgp.Preset) -> None:
    families = [
        meshes.bumpy_sphere(3),
        meshes.flower(3),
        meshes.two_horned(3),
        meshes.forked(3),
        meshes.hill(),
        meshes.torus(),
        meshes.cylinder(),
        meshes.cube(4),
        meshes.plate(3),
        meshes.perforated_slab(2),
        meshes.double_torus(),
        meshes.merge([meshes.flower(2), meshes.torus(), meshes.cube(3), meshes.bumpy_sphere(2)]),
        meshes.merge([meshes.cylinder(), meshes.cylinder(), meshes.cube(3), meshes.torus()]),
    ]
    other = []
    for number, mesh in enumerate(families):
        islands, cost, square = press(mesh, preset)
        for seed in range(3):
            found = press(given_otherwise(mesh, 3 * number + seed), preset)
            if found != (islands, pytest.approx(cost, rel=0.01, abs=0.01), pytest.approx(square, rel=0.02)):
                other.append((number, seed, (islands, cost, square), found))
    # A coordinate that lies between two quanta to the last digit may be rounded to the other one.
    assert len(other) <= 1, other
