# SPDX-License-Identifier: GPL-3.0-or-later
"""What the harnesses in tests/fuzz and the sweeps of extreme shapes have found, each as small as it could be made."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import lsgp
import meshes
import numpy as np
import pytest
import zoo
from explorer import places
from lsgp import lattice
from lsgp.io.mesh_obj import read_obj
from map_checks import codes, surface
from meshes import Mesh
from opened_surface import named_by
from packing_checks import overlapping
from result_check import undeclared_faults


def honest(mesh: Mesh, **options: str) -> lsgp.Result:
    given = lsgp.Options(**options)
    result = lsgp.parameterize(surface(mesh), mesh.cones, None, given)
    assert undeclared_faults(surface(mesh), result, given) == []
    return result


def far_apart(mesh: Mesh, seed: int) -> Mesh:
    """Stretched along the axes by factors between 1e-18 and 1e18."""
    return mesh._replace(positions=mesh.positions * 10.0 ** np.random.default_rng(seed).uniform(-18, 18, 3))


@pytest.mark.parametrize("exponent", [-5, -7, -9, -11, -13, -15, -20])
def test_a_component_much_smaller_than_another(exponent: int) -> None:
    """In the common layout it has fewer digits than when it was solved: what got lost is named."""
    large, small = meshes.cube(3), meshes.bumpy_sphere(2)
    small = small._replace(positions=small.positions * 10.0**exponent)
    count = len(large.positions)
    both = Mesh(
        np.concatenate([large.positions, small.positions]),
        np.concatenate([large.triangles, small.triangles + count]),
        np.concatenate([large.cones, small.cones + count]),
    )
    assert honest(both).solved[: len(large.triangles)].all()


def test_a_tube_pinched_far_away() -> None:
    """Scales from 1 to 1e8 in one component: the layout loses its digits, and the checks must not come before that."""
    around = np.pi / 2 * (np.arange(16) % 4)
    positions = np.stack([np.cos(around), np.sin(around), np.arange(16) // 4 / 2], axis=1)
    positions[[0, 11]] = -7.0
    tube = meshes.cylinder(4, 3)
    honest(tube._replace(positions=positions), prescription="straightness")


def test_a_scale_beyond_all_numbers() -> None:
    """The same without cones: the scale would be e^30000 in one place and e^-60000 in another."""
    mesh = meshes.torus(3, 3)
    mesh.positions[:] = np.random.default_rng(4).integers(-7, 8, mesh.positions.shape)
    mesh.positions[8, 2] = 3.85e8
    with pytest.raises(lsgp.SolverError, match=r"by a factor of 10\^[0-9]{5}, more than numbers can hold"):
        lsgp.parameterize(surface(mesh), [])


def test_a_stretch_that_overflows() -> None:
    """A torus with one vertex far away: triangles so thin that the smaller singular value cancels to nothing."""
    mesh = meshes.torus(6, 4)
    mesh.positions[21, 0] = -4.05e19
    honest(mesh, unfold="spectral")
    try:
        honest(mesh)
    except lsgp.SolverError as error:
        assert error.code == "SOLVER_FAILED"


@pytest.mark.parametrize("far", [1e5, 1e8, 1.175e19])
def test_a_layout_that_overflows(far: float) -> None:
    """Finite when it is solved, not when it is scaled: what counts are the coordinates that are returned."""
    mesh = meshes.grid(3, 4, lambda x, y: np.sin(x + 0.5 * y))._replace(cones=np.array([5], np.int32))
    mesh.positions[5] = [far, -0.8, 0.3]
    try:
        honest(mesh, prescription="straightness")
    except lsgp.SolverError as error:
        assert error.code == "SOLVER_FAILED"


def test_an_angle_next_to_nothing() -> None:
    """Beside pi it vanishes: it is refused like the angle 0, or comes back above 0."""
    tube = meshes.cylinder(3, 3)
    try:
        result = lsgp.parameterize(surface(tube), [6], [5e-324], lsgp.Options("manual"))
    except lsgp.CurvatureError as error:
        assert error.code == "CONE_ANGLE_RANGE"
    else:
        assert undeclared_faults(surface(tube), result) == []


@pytest.mark.parametrize("seed", [3, 10])
def test_a_box_stretched_beyond_measure(seed: int) -> None:
    honest(far_apart(meshes.cube(3), seed))


def test_an_eigenproblem_without_a_solution() -> None:
    """The eigensolver gives up with an exception of its own: to the caller it is SOLVER_FAILED, or another map."""
    try:
        honest(far_apart(meshes.cube(3), 2), unfold="spectral")
    except lsgp.SolverError as error:
        assert error.code == "SOLVER_FAILED"


@pytest.mark.parametrize("border", ["free", "straight"])
def test_cones_on_a_border_beside_each_other(border: str) -> None:
    """A strip too narrow for corners where it was asked for: a triangle flips, and angles elsewhere are off for it."""
    strip = meshes.grid(4, 1, lambda x, y: np.sin(x + y))
    result = honest(strip._replace(cones=np.arange(4, dtype=np.int32)), border=border)
    assert border == "free" or "HIGH_DISTORTION" in codes(result.warnings)


@pytest.mark.parametrize("parity", [False, True])
def test_a_seamless_layout_without_a_cut(parity: bool) -> None:
    """Nothing to round: sanitizers saw the diagonal taken of a matrix without elements."""
    options = {"seamless": lsgp.Seamless(parity=parity)}
    result = honest(meshes.grid(1, 1), **options)
    assert len(result.cut_edges) == 0 and result.seamless.error == 0


@pytest.mark.parametrize("vertex", [-1, 12, 2**31 - 1])
def test_the_turning_of_a_loop_at_no_vertex(vertex: int) -> None:
    """Elements of an error are there to be selected: a vertex that does not exist is none of them."""
    tube = meshes.cylinder(3, 3)
    with pytest.raises(lsgp.InputError) as caught:
        lsgp.parameterize(surface(tube), [], None, lsgp.Options(loop_turning={vertex: np.pi}))
    assert caught.value.code == "LOOP_TURNING" and caught.value.elements.indices.size == 0


@pytest.mark.slow
@pytest.mark.parametrize("line", [b"\\", b"# \\", b" \\\n\\", b"f 1 2 3\n\\\n\\\n"])
def test_lines_of_an_obj_that_hold_a_backslash_alone(tmp_path: Path, line: bytes) -> None:
    text = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n" + line
    assert len(read_obj(text, True).positions) == 3
    (tmp_path / "in.obj").write_bytes(text)
    command = [sys.executable, "-m", "lsgp", "unwrap", "in.obj", "-o", "out.obj"]
    assert subprocess.run(command, cwd=tmp_path, capture_output=True, timeout=60).returncode == 0


@pytest.mark.parametrize("length", [1e-200, 1e200])
def test_directions_of_any_length(length: float) -> None:
    """A mirror plane and a front are given by directions; the squares of these are no numbers."""
    ball = surface(meshes.bumpy_sphere(2))
    axis = np.array([0.0, 0.0, 1.0])
    placed, expected = (lsgp.place_cones(ball, symmetric=True, mirror=([0, 0, 0], n)) for n in (length * axis, axis))
    assert np.array_equal(placed.cones, expected.cones)
    ball = lsgp.Surface(ball.positions, ball.triangles, meshes.edges_of(ball.triangles))
    assert np.array_equal(lsgp.cut_costs(ball, length * axis), lsgp.cut_costs(ball, axis))


def test_a_mirror_plane_that_is_too_far_away() -> None:
    """Mirror images would be no numbers: there are none, which is said."""
    ball = surface(meshes.bumpy_sphere(2))
    placed = lsgp.place_cones(ball, symmetric=True, mirror=([1.7e308, -1.7e308, 1.7e308], [1, -1, 1]))
    assert codes(placed.warnings) == ["NOT_SYMMETRIC"]


@pytest.mark.parametrize("vertex", [-1, 42, 2**31 - 2, 2**31 - 1, -(2**31)])
def test_sharp_edges_between_no_vertices(vertex: int) -> None:
    """The number after the largest of all has no place in an index."""
    mesh = meshes.bumpy_sphere(1)
    assert vertex >= len(mesh.positions) or vertex < 0
    ball = lsgp.Surface(mesh.positions, mesh.triangles, meshes.edges_of(mesh.triangles))
    for call in (lsgp.cut_costs, lsgp.crease_borders):
        for edge in ([vertex, vertex], [0, vertex], [vertex, 1]):
            with pytest.raises(lsgp.InputError, match="sharp edges name") as caught:
                call(ball, sharp=[[0, 1], edge])
            assert caught.value.code == "INDEX_OUT_OF_RANGE"


@pytest.mark.parametrize("vertex", [-1, -(2**31), 2**31 - 1])
def test_texture_coordinates_of_no_vertex(vertex: int) -> None:
    with pytest.raises(lsgp.InputError, match=f"holds {vertex}") as caught:
        lsgp.index_uv([[0, 1, 2], [1, vertex, 2]], np.zeros((2, 3, 2)))
    assert caught.value.code == "INDEX_OUT_OF_RANGE"


def test_texture_coordinates_of_the_last_vertices_of_a_large_mesh() -> None:
    """Memory goes with the triangles, not with the largest vertex."""
    triangles, uv = np.array([[0, 1, 2], [1, 3, 2]]), np.random.default_rng(0).random((2, 3, 2)).round(1)
    for found, expected in zip(lsgp.index_uv(triangles + 2**31 - 5, uv), lsgp.index_uv(triangles, uv), strict=True):
        assert np.array_equal(found, expected)


@pytest.mark.parametrize("value", [0.0, 1])
def test_arrays_that_no_memory_can_hold(value: float) -> None:
    """All elements of such an array are one number in memory; what is passed on has each."""
    rows = np.broadcast_to(value, (2**50, 3))
    wanted = {0.0: lambda: lsgp.Surface(rows, [[0, 1, 2]]), 1: lambda: lsgp.Surface(np.eye(3), rows)}
    with pytest.raises(lsgp.SolverError, match=r"needed and not left") as caught:
        wanted[value]()
    assert caught.value.code == "OUT_OF_MEMORY" and str(2**50) in caught.value.message


TRIANGLE = np.array([[[0, 0], [1, 0], [0, 1.0]]])


@pytest.mark.parametrize("fill", [True, False])
@pytest.mark.parametrize("size", [2.0**-500, 2.0**-30, 2.0**600, 2.0**1015])
def test_islands_of_any_size_are_packed_alike(size: float, fill: bool) -> None:
    """Areas are squares of coordinates, which overflow long before these do."""
    uv, island, margin = np.repeat(TRIANGLE, 5, axis=0), np.arange(5), 0.01
    expected = lsgp.pack_islands(uv, island, margin, fill=fill)
    found = lsgp.pack_islands(size * uv, island, margin if fill else size * margin, fill=fill)
    assert np.array_equal(found, expected if fill else size * expected)


@pytest.mark.parametrize("distance", [2.0**20, 3 * 2.0**28, 2.0**40])
def test_islands_of_any_place_are_packed_alike(distance: float) -> None:
    """No digit is lost before they are taken to the origin, from places where they have as many as near it."""
    random = np.random.default_rng(7)
    uv = np.round(random.uniform(0, 8, (30, 3, 2)) * 2**10) / 2**10
    island = np.repeat(np.arange(10), 3)
    far = uv + distance * np.array([1, -1])
    assert np.array_equal(lsgp.pack_islands(far, island), lsgp.pack_islands(uv, island))


def test_islands_that_no_square_can_hold_are_refused() -> None:
    island = np.arange(100)
    for uv in (np.full((100, 3, 2), 1e160), np.repeat(TRIANGLE, 100, axis=0) + 1e160):
        for fill in (True, False):
            with pytest.raises(lsgp.InputError, match="Move them to the origin"):
                lsgp.pack_islands(uv, island, fill=fill)
    with pytest.raises(lsgp.InputError, match="larger than numbers can hold"):
        lsgp.pack_islands(np.repeat(1.7e308 * TRIANGLE, 100, axis=0), island, fill=False)
    for place in (0.0, 0.5):
        with pytest.raises(lsgp.InputError, match="leave out those that are points"):
            lsgp.pack_islands(np.full((2, 3, 2), place), [0, 1])


@pytest.mark.parametrize("size", [2.0**-500, 2.0**600, 2.0**1000])
def test_islands_of_any_size_are_placed_and_stacked_alike(size: float) -> None:
    square = np.array([[[0, 0], [1, 0], [1, 1]], [[0, 0], [1, 1], [0, 1.0]]])
    uv, island = np.concatenate([square, 2 * square + 5, square[:, :, ::-1] @ np.diag([1, -1]) + 9]), [0, 0, 1, 1, 2, 2]
    old = np.random.default_rng(0).random(uv.shape)
    assert np.array_equal(lsgp.fit_placement(size * uv, old, island), lsgp.fit_placement(uv, old, island))
    assert np.array_equal(lsgp.fit_placement(uv, size * old, island), size * lsgp.fit_placement(uv, old, island))
    assert lsgp.find_stacks(size * uv, island) == lsgp.find_stacks(uv, island)
    assert lsgp.find_stacks(uv, island).count == 1


@pytest.mark.parametrize("times", [-(2**31), -5, 0, 7, 2**31 - 1])
def test_a_motion_repeated_any_number_of_times(times: int) -> None:
    quarter = lsgp.Transition(1j, 3 + 0j, True)
    assert quarter.power(times) == quarter.power(times % 4)


@pytest.mark.parametrize("density", [1e20, 1e160, 1e300, 1e304, 1e308])
def test_a_texel_density_beyond_all_tiles(density: float) -> None:
    """Texels of an island, which are more than its coordinates, may be more than numbers can hold."""
    box = surface(meshes.cube(2))
    result = lsgp.auto_unwrap(box, pack="shelves")
    with pytest.raises(lsgp.InputError, match=r"larger than a tile|more than numbers can hold") as caught:
        lsgp.at_texel_density(box, result, lsgp.TexelLayout(density, 1024, 4))
    assert len(caught.value.message) < 300
    if "Lower the texel density to" in caught.value.message:
        told = float(caught.value.message.split("texel density to ")[1].split(",")[0])
        assert lsgp.at_texel_density(box, result, lsgp.TexelLayout(told, 1024, 100)).solved.all()


def test_a_texel_layout_is_refused_before_the_map(monkeypatch: pytest.MonkeyPatch) -> None:
    """The number of tiles, and that of a seamless layout, are known before anything is unwrapped."""
    monkeypatch.setattr(lsgp.Solver, "parameterize", lambda *_, **__: pytest.fail("unwrapped"))
    with pytest.raises(lsgp.InputError, match="udim is 1000"):
        lsgp.TexelLayout(10.0, 1024, udim=1000)
    with pytest.raises(lsgp.InputError, match="has the size of its tiles"):
        lsgp.auto_unwrap(surface(meshes.cube(2)), preset="tile", texels=lsgp.TexelLayout(10.0, 1024))


def test_a_component_that_is_mapped_in_part_is_left_out_in_part_only() -> None:
    """Cones cannot be placed on it, as few edges may be cut; along its seams one part of it unfolds nevertheless."""
    member = zoo.member("mixed-parts-count=2-spread=0-seed=0")
    mesh = member.mesh()
    total = len(mesh.positions)
    found = lsgp.auto_unwrap(
        lsgp.Surface(
            mesh.positions,
            mesh.triangles,
            places.edges_of_kind("few", 6002, mesh.triangles, total),
            places.seams_of_kind("around a part", 5270, 6, mesh.triangles, total),
        ),
        preset="tile",
    )
    assert np.array_equal(np.unique(named_by(found, "COMPONENT_SKIPPED")), np.flatnonzero(~found.solved))


def test_creases_of_a_broken_surface_are_walked_around_once() -> None:
    """Some were open on one side only, around which a walk did not come back, and could not be cancelled."""
    mesh = zoo.member("mixture-seed=630529").mesh()
    plain = lsgp.Surface(mesh.positions, mesh.triangles)
    marked = replace(plain, features=lsgp.feature_edges(plain, angle=0.5, borders=True))
    assert lsgp.auto_unwrap(marked, pack="shelves").solved.any()


def test_cones_whose_other_angles_have_no_map_at_all_keep_theirs() -> None:
    """No map has no defects, and was taken for better than one that has some; its angles are missing."""
    mesh = zoo.member("mixture-seed=84478").mesh()
    given = lsgp.Surface(mesh.positions, mesh.triangles)
    placed = lsgp.place_cones(given, count=8, border="strips")
    assert len(placed.cones) == 8 and np.isfinite(placed.cone_angles).all()


@pytest.mark.parametrize("shift", [0.0, 0.5])
def test_islands_on_each_other_are_packed_apart_without_a_margin(shift: float) -> None:
    """Their outlines do not cross, and no corner is inside another island."""
    square = np.array([[[0, 0], [1, 0], [1, 1]], [[0, 0], [1, 1], [0, 1]]], float)
    island = np.repeat(np.arange(3), 2)
    packed = lsgp.pack_islands(np.concatenate([square + shift * i for i in range(3)]), island, 0)
    assert len(overlapping(packed, island)) == 0
    assert len({tuple(packed[island == i].min(axis=(0, 1))) for i in range(3)}) == 3


@pytest.mark.parametrize("shift", [1e39, 1.7e308, -1.7e308])
def test_islands_are_not_shifted_beyond_float32(shift: float) -> None:
    """Sums were infinite, and rounding both sides of a cut together did not end."""
    triangles = np.array([[0, 1, 2], [0, 2, 3]])
    corner_uv = np.array([[[0, 0], [1, 0], [1, 1]], [[0, 0], [1, 1], [0, 1]]], float) * abs(shift)
    with pytest.raises(lsgp.InputError, match=r"island 0 takes triangle 0 beyond 3\.4e\+38"):
        lattice.shift_islands(triangles, corner_uv, np.array([0, 1]), np.array([[0, 2]]), np.full((2, 2), shift))


@pytest.mark.parametrize("far", [0.0, 1e8, -1e10])
def test_a_layout_that_lies_far_away_stays_inside_the_margin(far: float) -> None:
    """Kept as it was given, an island was as wide as the digits of its place could tell."""
    around = np.linspace(0, 2 * np.pi, 33)
    outer, inner = (radius * np.stack([np.cos(around), np.sin(around)], axis=1) for radius in (0.8, 0.7))
    ring = np.concatenate(
        [
            np.stack([outer[:-1], outer[1:], inner[:-1]], axis=1),
            np.stack([outer[1:], inner[1:], inner[:-1]], axis=1),
        ]
    )
    packed = lsgp.pack_islands(ring + far, np.zeros(len(ring), int), 0.01, effort="quick", turned=False)
    assert packed.min() >= 0.01 - 1e-12 and packed.max() <= 0.99 + 1e-9
