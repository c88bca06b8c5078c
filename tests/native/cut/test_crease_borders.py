# SPDX-License-Identifier: GPL-3.0-or-later
"""Hard surfaces end at their creases: parts unfold without stretch, and nothing else is opened."""

from __future__ import annotations

from dataclasses import replace

import lsgp
import meshes
import numpy as np
import pytest
from hulls import hull
from large_meshes import comb, of_polygons
from lsgp.triangles import uv_area
from map_checks import pairs, surface
from meshes import Mesh
from nightly import nightly
from result_check import undeclared_faults
from sanitized_run import many_solves
from zoo import closed, swept, tunnels

SOLIDS = {
    "cylinder": closed.cylinder(32, 4, 3.0, 2),
    "fine cylinder": closed.cylinder(150, 2, 1.0, 2),
    "prism": closed.prism(6, 2, 2.0),
    "star": closed.star(5, 0.5, 0.4),
    "gear": closed.gear(12, 0.3, 2),
    "cube": meshes.cube(3),
    "pipe": swept.pipe(24, 8, 0.0, True),
    "hollow pipe": swept.hollow_pipe(40, 4, 0.3),
    "plate with tunnels": tunnels.tunneled_plate(4, 3, 1),
    "slab of genus 2": meshes.double_torus(),
}


def in_space(mesh: Mesh) -> np.ndarray:
    """Edge lengths of triangles, (m, 3)."""
    corners = mesh.positions[mesh.triangles]
    return np.linalg.norm(corners[:, [1, 2, 0]] - corners, axis=2)


def angle_between_normals(mesh: Mesh, edges: np.ndarray) -> np.ndarray:
    """At each of these edges between two triangles, radians."""
    a, b, c = mesh.positions[mesh.triangles].transpose(1, 0, 2)
    normal = np.cross(b - a, c - a)
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    out = []
    for edge in edges:
        one, other = normal[np.isin(mesh.triangles, edge).sum(axis=1) == 2]
        out.append(np.arccos(np.clip(one @ other, -1, 1)))
    return np.array(out)


def with_slivers(mesh: Mesh, count: int, gap: float, seed: int) -> Mesh:
    """Edges divided so close to one end that the triangles beside the short half have no area, as booleans leave them.

    gap: of the edge's length."""
    positions, triangles = list(mesh.positions), [tuple(t) for t in mesh.triangles.tolist()]
    rng = np.random.default_rng(seed)
    for _ in range(count):
        f, c = rng.integers(len(triangles)), rng.integers(3)
        a, b, tip = (triangles[f][(c + i) % 3] for i in range(3))
        (g,) = [i for i, t in enumerate(triangles) if i != f and {a, b} <= set(t)]
        (beyond,) = set(triangles[g]) - {a, b}
        new = len(positions)
        positions.append((1 - gap) * positions[a] + gap * positions[b])
        triangles[f], triangles[g] = (a, new, tip), (new, a, beyond)
        triangles += [(new, b, tip), (b, new, beyond)]
    return meshes.make(np.array(positions), np.array(triangles))


def chamfered_box(size: tuple[float, float, float], chamfer: float) -> Mesh:
    """A box whose edges and corners are cut off by one face each."""
    signs = np.stack(np.meshgrid(*[[-1.0, 1.0]] * 3), axis=-1).reshape(-1, 3)
    points = np.concatenate([signs * (np.array(size) / 2 - chamfer * (np.arange(3) != axis)) for axis in range(3)])
    return hull(points)


@pytest.mark.slow
@pytest.mark.parametrize("name", SOLIDS)
def test_a_hard_surface_unfolds_without_stretch_and_without_cones(name: str) -> None:
    mesh = SOLIDS[name]
    result = lsgp.auto_unwrap(surface(mesh), preset="bake")
    assert len(result.cones) == 0 and len(result.overlapping) == 0
    flat = np.linalg.norm(result.corner_uv[:, [1, 2, 0]] - result.corner_uv, axis=2)
    ratio = flat / in_space(mesh)
    assert ratio / np.median(ratio) == pytest.approx(1, abs=1e-5)


def test_a_cylinder_becomes_a_rectangle_and_two_disks() -> None:
    around, length, mesh = 32, 3.0, SOLIDS["cylinder"]
    result = lsgp.auto_unwrap(surface(mesh), preset="paint")
    assert result.island.max() == 2
    is_upright = np.ptp(mesh.positions[mesh.triangles][:, :, 2], axis=1) > 0
    (side,) = np.unique(result.island[is_upright])
    z = result.corner_uv[..., 0] + 1j * result.corner_uv[..., 1]
    edges = np.roll(z, -1, axis=1) - z
    along = np.isclose(in_space(mesh), length / 4) & (result.island == side)[:, None]
    upright = z[result.island == side] / edges[along][0]  # in units of a quarter of the length
    perimeter = around * 2 * np.sin(np.pi / around)
    assert np.ptp(upright.real) == pytest.approx(4, rel=1e-5)
    assert np.ptp(upright.imag) == pytest.approx(perimeter / (length / 4), rel=1e-5)
    for disk in {0, 1, 2} - {side}:
        size = np.ptp(z[result.island == disk].view(float).reshape(-1, 2), axis=0) / abs(edges[along][0])
        assert size == pytest.approx(2 / (length / 4), rel=0.01)


@pytest.mark.parametrize("name", SOLIDS)
def test_borders_are_creases_but_for_a_path_along_each_tube(name: str) -> None:
    mesh = SOLIDS[name]
    borders = lsgp.crease_borders(surface(mesh))
    assert pairs(borders) <= pairs(meshes.edges_of(mesh.triangles))
    flat = borders[angle_between_normals(mesh, borders) < 0.7]
    paths = {"cylinder": 4, "fine cylinder": 2, "pipe": 8, "hollow pipe": 4 + 4}
    assert len(flat) == paths.get(name, 0)


@pytest.mark.parametrize("front", [(0, -1, 0), (1, 1, 0)])
def test_tubes_are_opened_out_of_sight(front: tuple[int, int, int]) -> None:
    mesh = SOLIDS["cylinder"]
    whole = surface(mesh, edges=meshes.edges_of(mesh.triangles))
    borders = lsgp.crease_borders(replace(whole, cut_costs=lsgp.cut_costs(whole, front)))
    path = borders[np.ptp(mesh.positions[borders][:, :, 2], axis=1) > 0]
    assert len(path) == 4 and (mesh.positions[path] @ np.array(front) < 0).all()


@pytest.mark.parametrize(
    "mesh",
    [meshes.icosphere(3), meshes.torus(), meshes.bumpy_sphere(3), meshes.flower(3), meshes.saddle(), meshes.grid()],
)
def test_smooth_and_flat_surfaces_have_none(mesh: Mesh) -> None:
    assert len(lsgp.crease_borders(surface(mesh))) == 0


@pytest.mark.parametrize("seed", range(4))
def test_folds_that_fade_out_are_no_creases(seed: int) -> None:
    """Large faces bend by a crease's angle in many places, and nearly all curvature is beside one of these."""
    ball = meshes.icosphere(2)
    radii = 1 + 0.2 * np.random.default_rng(seed).uniform(-1, 1, len(ball.positions))
    mesh = meshes.make(ball.positions * radii[:, None], ball.triangles)
    edges = meshes.edges_of(mesh.triangles)
    folded = edges[angle_between_normals(mesh, edges) >= np.radians(40)]
    degree = np.bincount(folded.ravel(), minlength=len(mesh.positions))
    assert (degree == 1).sum() > 0.1 * (degree > 0).sum()
    assert len(lsgp.crease_borders(surface(mesh))) == 0


@pytest.mark.parametrize("seed", range(4))
def test_noise_does_not_hide_creases(seed: int) -> None:
    mesh = SOLIDS["gear"]
    noise = 0.005 * np.random.default_rng(seed).normal(size=mesh.positions.shape)
    borders = lsgp.crease_borders(surface(meshes.make(mesh.positions + noise, mesh.triangles)))
    assert len(borders) >= 0.9 * len(lsgp.crease_borders(surface(mesh)))


@pytest.mark.parametrize("preset", ["paint", "bake"])
def test_a_circular_cone_becomes_a_disk_and_a_sector_with_one_cone_at_the_apex(preset: str) -> None:
    """Its apex has more than a fifth of the curvature, but at a single vertex."""
    mesh = closed.lathe(np.array([1.0, 0.0]), np.array([0.0, 2.0]), 32, caps=(True, False))
    apex = int(np.argmax(mesh.positions[:, 2]))
    result = lsgp.auto_unwrap(surface(mesh), preset=preset)
    assert result.island.max() + 1 == 2 and result.cones.tolist() == [apex]
    assert result.distortion.l2_stretch == pytest.approx(1, abs=1e-9)


def test_round_surfaces_with_a_rim_are_no_hard_ones() -> None:
    """A dome on a disk has as much of its curvature off the rim, at many vertices."""
    height = np.sin(np.linspace(0, np.pi / 2, 9))
    dome = closed.lathe(np.cos(np.linspace(0, np.pi / 2, 9)).clip(0), height, 32, caps=(True, False))
    assert len(lsgp.crease_borders(surface(dome))) == 0


@pytest.mark.parametrize("size", [(1, 1, 1), (1, 2, 0.6), (3, 1, 1)])
@pytest.mark.parametrize("chamfer", [0.01, 0.03, 0.05])
def test_chamfers_are_no_islands(size: tuple[float, float, float], chamfer: float) -> None:
    """Their edges bend by as much as creases do, but only both together turn from one face to the next."""
    mesh = chamfered_box(size, chamfer)
    result = lsgp.auto_unwrap(surface(mesh), preset="bake")
    a, b, c = mesh.positions[mesh.triangles].transpose(1, 0, 2)
    is_face = (np.abs(np.cross(b - a, c - a)) > 1e-9).sum(axis=1) == 1
    assert is_face.sum() == 12 and set(result.island) == set(result.island[is_face])
    assert result.distortion.l2_stretch < 1.005
    marked = lsgp.crease_borders(surface(mesh), angle=1.0, sharp=meshes.edges_of(mesh.triangles))
    assert len(marked) > len(lsgp.crease_borders(surface(mesh), angle=1.0)) > 0


@pytest.mark.parametrize(("around", "along"), [(12, 6), (48, 6), (24, 7), (48, 8), (100, 8)])
def test_rings_of_a_coarse_torus_are_no_creases(around: int, along: int) -> None:
    torus = meshes.torus(around, along, 1.0, 0.25)
    assert angle_between_normals(torus, meshes.edges_of(torus.triangles)).max() > 0.7
    assert len(lsgp.crease_borders(surface(torus))) == 0


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize(("around", "along"), [(8, 6), (12, 6), (14, 7), (30, 7)])
def test_noise_makes_no_creases_of_rings(around: int, along: int, seed: int) -> None:
    """It twists quads, whose diagonals then bend a little."""
    torus = meshes.torus(around, along, 1.0, 0.4)
    size = np.median(in_space(torus))
    moved = torus.positions + 0.02 * size * np.random.default_rng(seed).normal(size=torus.positions.shape)
    assert len(lsgp.crease_borders(surface(torus._replace(positions=moved)))) == 0


@pytest.mark.parametrize("sides", [8, 12, 24])
@pytest.mark.parametrize("slope", [45, 60, 70, 72, 74, 80, 90])
def test_rims_of_a_frustum_are_creases(sides: int, slope: float) -> None:
    """Where a rim and the cap beyond bend alike, the other rim does not."""
    height = 0.4 * np.tan(np.radians(slope)) if slope < 90 else 1.0
    top = 0.6 if slope < 90 else 1.0
    frustum = closed.lathe(np.array([1.0, top]), np.array([0.0, height]), sides, caps=(True, True))
    z = frustum.positions[:, 2]
    edges = meshes.edges_of(frustum.triangles)
    bends = angle_between_normals(frustum, edges)
    rims = edges[(np.ptp(z[edges], axis=1) == 0) & (bends >= 0.7)]
    borders = pairs(lsgp.crease_borders(surface(frustum)))
    # Two faces may be unfolded together across an edge of a rim, as the base of a pyramid and one of its sides.
    assert len(pairs(rims) - borders) <= 2


def test_what_the_artist_has_marked_is_left_alone() -> None:
    cylinder = SOLIDS["cylinder"]
    both = meshes.merge([cylinder, cylinder])
    alone = pairs(lsgp.crease_borders(surface(both)))
    second = {edge for edge in alone if min(edge) >= len(cylinder.positions)}
    assert len(second) == len(alone) / 2
    seamed = lsgp.crease_borders(surface(both, seams=cylinder.triangles[:1, :2]))
    assert pairs(seamed) == second
    assert pairs(lsgp.crease_borders(surface(both), [0])) == second


def test_few_corners_are_left_to_cones() -> None:
    cube = surface(meshes.cube(3))
    assert len(lsgp.crease_borders(cube, most_corners=8)) == 0
    assert len(lsgp.crease_borders(cube, most_corners=7)) == 7 * 3  # as many edges of a cube, of three edges each
    # The texture runs on across creases where that counts.
    assert len(lsgp.auto_unwrap(cube, preset="paint", weights=lsgp.Weights(borders=5.0)).cones) == 8
    assert len(lsgp.auto_unwrap(cube, preset="bake").cones) == 0
    assert len(lsgp.auto_unwrap(cube, preset="bake", creases=False).cones) == 8


def test_edges_marked_sharp_are_creases() -> None:
    """A blunt cone on a tube: its rim bends by less than a crease does."""
    profile, height = np.array([1.0, 1.0, 0.0]), np.array([0.0, 2.0, 2.4])
    tower = closed.lathe(profile, height, 32, caps=(True, False))
    rim = 32 + np.arange(32)
    sharp = np.stack([rim, np.roll(rim, -1)], axis=1)
    assert angle_between_normals(tower, sharp).max() < 1.3
    without = pairs(lsgp.crease_borders(surface(tower), angle=1.3))
    marked = pairs(lsgp.crease_borders(surface(tower), angle=1.3, sharp=sharp))
    assert not pairs(sharp) & without and pairs(sharp) <= marked


def test_a_border_is_where_the_surface_ends() -> None:
    """The map is that of the surface torn there, whatever seams mean."""
    sheet = meshes.hill(8)
    middle = np.flatnonzero(np.isclose(sheet.positions[:, 0], np.median(sheet.positions[:, 0])))
    across = np.array([e for e in meshes.edges_of(sheet.triangles) if np.isin(e, middle).all()])
    torn = lsgp.Surface(sheet.positions, sheet.triangles, borders=across)
    for seams in ("follow", "ignore"):
        options = lsgp.Options(seams=seams)
        result = lsgp.parameterize(torn, [], options=options)
        assert result.island.max() == 1 and undeclared_faults(torn, result, options) == []
        assert not pairs(result.cut_edges) & pairs(across) and pairs(result.borders) == pairs(across)
        seamed = surface(sheet, seams=across)
        same = lsgp.parameterize(seamed, [], options=lsgp.Options(seams="boundary"))
        assert np.array_equal(result.corner_uv, same.corner_uv)


@pytest.mark.parametrize(
    ("given", "code", "words"),
    [
        ({"angle": 0.0}, "WRONG_PARAMETER", "above 0"),
        ({"angle": 3.2}, "WRONG_PARAMETER", "at most pi"),
        ({"most_corners": -1}, "WRONG_PARAMETER", "whole number from 0"),
        ({"least_share": 1.5}, "WRONG_PARAMETER", "from 0 to 1"),
        ({"least_share": np.nan}, "WRONG_PARAMETER", "from 0 to 1"),
        ({"cones": [99]}, "CONE_INDEX", "99"),
    ],
)
def test_refusals(given: dict, code: str, words: str) -> None:
    with pytest.raises(lsgp.InputError, match=words) as refused:
        lsgp.crease_borders(surface(meshes.cube(2)), **given)
    assert refused.value.code == code


@pytest.mark.parametrize(
    ("borders", "code"),
    [([[0, 0]], "EDGE_NOT_IN_MESH"), ([[0, 25]], "EDGE_NOT_IN_MESH"), ([[0, 26]], "INDEX_OUT_OF_RANGE")],
)
def test_borders_that_are_no_edges(borders: list, code: str) -> None:
    cube = meshes.cube(2)
    with pytest.raises(lsgp.InputError) as refused:
        lsgp.parameterize(lsgp.Surface(cube.positions, cube.triangles, borders=borders), cube.cones)
    assert refused.value.code == code


def rounded_box(size: tuple[float, float, float], radius: float) -> Mesh:
    """A box with edges and corners rounded by four strips; no edge bends by as much as a crease."""
    band = radius * (1 - np.tan(np.radians([0, 22.5, 45])))
    lines = [np.concatenate([-half + band[::-1], half - band]) for half in np.array(size) / 2]
    points, triangles = [], []
    for axis in range(3):
        u, v = lines[axis - 2], lines[axis - 1]
        for side in (-1, 1):
            first = len(points)
            for a in u:
                for b in v:
                    point = np.empty(3)
                    point[[axis, axis - 2, axis - 1]] = side * size[axis] / 2, a, b
                    core = np.clip(point, radius - np.array(size) / 2, np.array(size) / 2 - radius)
                    away = point - core
                    points.append(core + radius * away / np.linalg.norm(away))
            for i in range(len(u) - 1):
                for j in range(len(v) - 1):
                    a, b, c, d = (first + k * len(v) + m for k, m in ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)))
                    triangles += [[a, b, c], [a, c, d]] if side > 0 else [[a, c, b], [a, d, c]]
    places, vertex = np.unique(np.round(points, 12), axis=0, return_inverse=True)
    return meshes.make(places, vertex.ravel()[np.array(triangles)])


@pytest.mark.parametrize("size", [(1.0, 1.5, 2.0), (0.5, 3.0, 1.0)])
def test_rounded_edges_are_cut_along_their_middle(size: tuple[float, float, float]) -> None:
    mesh, radius = rounded_box(size, 0.05), 0.05
    borders = lsgp.crease_borders(surface(mesh))
    assert len(borders) and angle_between_normals(mesh, borders).max() < 0.7
    # In the middle the surface is equally far from two faces.
    to_face = np.sort(np.abs(np.array(size) / 2 - np.abs(mesh.positions[np.unique(borders)])), axis=1)
    assert to_face[:, 0] == pytest.approx(to_face[:, 1], abs=1e-9)
    assert (to_face[:, 0] <= radius * (1 - np.sqrt(1 / 3)) + 1e-9).all()
    for preset in ("bake", "paint"):
        result = lsgp.auto_unwrap(surface(mesh), preset=preset)
        assert len(result.cones) == 0 and result.island.max() < 6
        assert len(result.overlapping) == 0 == len(result.flipped) and result.distortion.l2_stretch < 1.005


def washer(segments: int, around: int = 24, bevel: float = 0.04) -> tuple[Mesh, np.ndarray]:
    """A thick ring about z whose four rims are beveled by so many strips, and the edges of its quads."""
    inner, outer, height = 0.5, 1.5, 0.5
    turn = np.pi / 2 * np.arange(segments + 1) / segments
    profile = []
    for i, (radius, z) in enumerate([(outer, height), (inner, height), (inner, 0), (outer, 0)]):
        center = np.array([radius, z]) + bevel * np.array([(-1, 1, 1, -1)[i], (-1, -1, 1, 1)[i]])
        profile += [center + bevel * np.array([np.cos(t), np.sin(t)]) for t in turn + i * np.pi / 2]
    radius, z = np.array(profile).T
    along = len(radius)
    angle = 2 * np.pi * np.arange(around)[:, None] / around
    positions = np.stack([radius * np.cos(angle), radius * np.sin(angle), z + 0 * angle], axis=-1).reshape(-1, 3)
    i, j = (k.ravel() for k in np.meshgrid(np.arange(around), np.arange(along), indexing="ij"))
    a, b, c, d = (((i + m) % around) * along + (j + n) % along for m, n in ((0, 0), (1, 0), (1, 1), (0, 1)))
    triangles = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    edges = np.concatenate([np.stack([a, b], axis=1), np.stack([a, d], axis=1)])
    return meshes.make(positions, triangles), edges


@pytest.mark.slow
@pytest.mark.parametrize("segments", [1, 2, 3])
@pytest.mark.parametrize("polygons", [False, True], ids=["triangles", "quads"])
def test_faces_with_beveled_holes_keep_them(segments: int, polygons: bool) -> None:
    """What is beside the rim of a hole bends away from the face; it is narrow, so that nothing is gained by a cut."""
    mesh, edges = washer(segments)
    noise = 3e-6 * np.random.default_rng(segments).standard_normal(mesh.positions.shape)
    given = lsgp.Surface(mesh.positions + noise, mesh.triangles, edges=edges if polygons else None)
    borders = lsgp.crease_borders(given)
    radius, z = np.linalg.norm(mesh.positions[:, :2], axis=1), mesh.positions[:, 2]
    across = np.ptp(radius[borders], axis=1) > 0.5
    assert not across.any() and np.ptp(z[borders], axis=1).max() > 0.3
    for preset in ("bake", "paint"):
        result = lsgp.auto_unwrap(given, preset=preset, pack="shelves")
        assert len(result.cones) == 0 == len(result.overlapping) and result.distortion.l2_stretch < 1.002
        if preset == "paint":
            assert result.island.max() + 1 <= 6


@pytest.mark.parametrize("seed", range(3))
def test_the_two_triangles_of_a_chamfer_end_at_the_same_face(seed: int) -> None:
    """No cut parts them, and positions in single precision make one of them nearer to each face."""
    mesh = chamfered_box((1, 2, 0.6), 0.03)
    edges = meshes.edges_of(mesh.triangles)
    of_polygons = edges[angle_between_normals(mesh, edges) > 0.01]
    noise = 1e-6 * np.random.default_rng(seed).standard_normal(mesh.positions.shape)
    given = lsgp.Surface(mesh.positions + noise, mesh.triangles, edges=of_polygons)
    result = lsgp.auto_unwrap(replace(given, borders=lsgp.crease_borders(given)), preset="bake", creases=False)
    assert len(result.cones) == 0 and result.distortion.l2_stretch < 1.005


@pytest.mark.parametrize("size", [(1.0, 1.0, 1.0), (1.0, 1.4, 0.8)])
@pytest.mark.parametrize("chamfer", [0.08, 0.1, 0.12])
def test_wide_chamfers_unfold_beside_faces(size: tuple[float, float, float], chamfer: float) -> None:
    """All of them are connected around the corners, where they bend by less than creases do; unfolded in one piece they
    would be branches."""
    mesh = chamfered_box(size, chamfer)
    borders = lsgp.crease_borders(surface(mesh))
    places = mesh.positions[borders]
    sides = np.linalg.norm(places[:, 1] - places[:, 0], axis=1) > 0.4
    # Of 24 sides of twelve chamfers, 17 connect these with six faces.
    assert sides.sum() == 7
    result = lsgp.auto_unwrap(surface(mesh), preset="bake")
    assert result.island.max() < 6 and len(result.cones) == 0 and result.distortion.l2_stretch < 1.0001


def test_faces_with_wide_chamfers_fill_the_square() -> None:
    for size in ((1.0, 1.0, 1.0), (1.0, 1.4, 0.8)):
        result = lsgp.auto_unwrap(surface(chamfered_box(size, 0.1)), preset="bake")
        assert uv_area(result.corner_uv) > 0.6


def test_what_is_round_itself_has_no_bevels() -> None:
    ball = meshes.icosphere(4)
    noise = np.random.default_rng(1).standard_normal((len(ball.positions), 1))
    scan = meshes.make(ball.positions * (1 + 0.03 * noise), ball.triangles)
    for mesh in (rounded_box((1.0, 1.5, 2.0), 0.45), meshes.icosphere(2), meshes.bumpy_sphere(3), scan):
        assert len(lsgp.crease_borders(surface(mesh))) == 0


@pytest.mark.slow
@pytest.mark.parametrize("gap", [0.0, *nightly(1e-7, marks=[pytest.mark.many_solves])])
@pytest.mark.parametrize(
    "name", ["cube", "plate with tunnels", "slab of genus 2", *nightly("star", marks=[pytest.mark.many_solves])]
)
def test_triangles_without_area_hide_no_creases(name: str, gap: float) -> None:
    for seed in range(3):
        mesh = with_slivers(SOLIDS[name], 6, gap, seed)
        result = lsgp.auto_unwrap(surface(mesh), preset="bake", pack="shelves")
        assert len(result.cones) == 0
        assert result.distortion.l2_stretch <= 1.001


@pytest.mark.parametrize("mesh", [closed.star(8, 0.5, 0.4), closed.star(12, 0.7, 0.05)])
def test_rounding_does_not_choose_the_borders_of_regular_outlines(mesh: Mesh) -> None:
    expected = pairs(lsgp.crease_borders(surface(mesh)))
    random = np.random.default_rng(0)
    for _ in range(8):
        units = random.integers(-1, 2, mesh.positions.shape)
        moved = mesh._replace(positions=mesh.positions + units * np.spacing(np.abs(mesh.positions)))
        assert pairs(lsgp.crease_borders(surface(moved))) == expected


@pytest.mark.slow
@pytest.mark.parametrize("points", [8, *many_solves(12), *nightly(24, marks=[pytest.mark.many_solves])])
@pytest.mark.parametrize("inner", [0.5, 0.7])
@pytest.mark.parametrize("height", [0.05, 0.2, 0.4])
def test_sides_of_extruded_outlines_become_bands(points: int, inner: float, height: float) -> None:
    """Unfolded with the caps, sides would lie over each other at every notch, and be islands of their own. How many of
    the sides follow each other in a band hangs on rounding: two or more on average."""
    mesh = closed.star(points, inner, height)
    result = lsgp.auto_unwrap(surface(mesh), preset="paint", pack="shelves")
    corners = mesh.positions[mesh.triangles]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    is_side = np.abs(normal[:, 2]) < 1e-9 * np.linalg.norm(normal, axis=1)
    bands, all_islands = np.unique(result.island[is_side]), np.unique(result.island)
    sides = 2 * points
    assert 2 * len(bands) <= sides and len(all_islands) <= len(bands) + 2
    assert result.distortion.l2_stretch <= 1.0005 and len(result.overlapping) == 0


@pytest.mark.parametrize("teeth", [100, 1100])
def test_every_corner_of_a_comb_lies_at_a_border_however_small_its_teeth_are(teeth: int) -> None:
    """As cones its corners would be too many."""
    solid = of_polygons(comb(teeth))
    assert len(np.unique(lsgp.crease_borders(solid))) == len(solid.positions)
