# SPDX-License-Identifier: GPL-3.0-or-later
"""Unwrapping in one call: the guarantees of presets, and where cones are added to given ones."""

from __future__ import annotations

from dataclasses import replace

import lsgp
import meshes
import numpy as np
import pytest
from lsgp import Surface, auto_unwrap
from lsgp.presets.auto_unwrap import TARGET
from lsgp.quads.completed_cones import GivenCones, complete_cones
from map_checks import codes, only
from meshes import Mesh
from result_check import undeclared_faults

PRESETS = ("paint", "tile", "bake")
SHAPES = {
    "ball": meshes.bumpy_sphere(3),
    "cube": meshes.cube(4),
    "torus": meshes.torus(),
    "hill": meshes.hill(),
    "cylinder": meshes.cylinder(),
    "two balls": meshes.merge([meshes.bumpy_sphere(2), meshes.bumpy_sphere(2)]),
}


def surface(mesh: Mesh, **more: object) -> Surface:
    return Surface(mesh.positions, mesh.triangles, **more)


@pytest.mark.slow
@pytest.mark.parametrize("name", SHAPES)
@pytest.mark.parametrize("preset", PRESETS)
def test_a_surface_alone_gives_a_map_without_overlaps_that_keeps_what_it_promises(preset: str, name: str) -> None:
    given = surface(SHAPES[name])
    result = auto_unwrap(given, preset=preset)
    assert result.solved.all() and not len(result.overlapping) and not len(result.flipped)
    ended = replace(given, borders=result.borders)
    assert undeclared_faults(ended, result, lsgp.preset_options(preset)) == []
    if preset == "tile":
        assert result.seamless.error == 0
    else:
        assert result.distortion.l2_stretch <= TARGET
        assert result.corner_uv.min() >= -1e-12 and result.corner_uv.max() <= 1 + 1e-12


def test_painting_stretches_less_than_the_conformal_map_through_the_same_cones() -> None:
    given = surface(meshes.bumpy_sphere(3))
    painted = auto_unwrap(given)
    conformal = lsgp.parameterize(given, painted.cones, painted.cone_angles)
    assert painted.distortion.l2_stretch < conformal.distortion.l2_stretch - 1e-3


def test_options_take_the_place_of_the_presets() -> None:
    given = surface(meshes.bumpy_sphere(3))
    hexagons = replace(lsgp.preset_options("tile"), seamless=lsgp.Seamless(lattice="hexagon"))
    assert auto_unwrap(given, preset="tile", options=hexagons).seamless.rotation_order == 6
    plain = auto_unwrap(given, options=lsgp.Options(), pack="shelves")
    fresh = lsgp.parameterize(given, plain.cones, plain.cone_angles)
    # The map that verified the cones left its factor.
    assert plain.factorizations == 0 < fresh.factorizations
    assert plain.distortion.l2_stretch == pytest.approx(fresh.distortion.l2_stretch, rel=1e-6)
    assert len(plain.cones) == len(lsgp.place_cones(given).cones)


def test_cones_that_suffice_are_kept_and_none_is_added() -> None:
    ball = meshes.bumpy_sphere(3)
    cones = ball.cones[:5]
    angles = [4.0] + [None] * 4
    result = auto_unwrap(surface(ball), cones, angles)
    assert result.cones.tolist() == cones.tolist()
    assert result.cone_angles[0] == pytest.approx(4.0, abs=1e-12)


def test_cones_that_cannot_take_up_the_curvature_are_completed() -> None:
    ball = meshes.bumpy_sphere(3)
    with pytest.raises(lsgp.TopologyError):
        lsgp.parameterize(surface(ball), ball.cones[:1])
    result = auto_unwrap(surface(ball), ball.cones[:1], [4.0])
    assert len(result.cones) > 1 and result.cones[0] == ball.cones[0]
    assert result.cone_angles[0] == pytest.approx(4.0, abs=1e-12)
    assert result.distortion.l2_stretch <= TARGET


def test_parts_without_cones_get_some_and_the_others_keep_theirs() -> None:
    ball = meshes.bumpy_sphere(2)
    both = surface(meshes.merge([ball, ball]))
    result = auto_unwrap(both, ball.cones)
    first = len(ball.positions)
    assert result.cones[result.cones < first].tolist() == ball.cones.tolist()
    added = result.cones >= first
    assert added.any() and result.cone_angles[added].sum() == pytest.approx(2 * np.pi * (added.sum() - 2))
    assert codes(result.warnings) == []


def test_what_is_said_of_a_part_names_elements_of_the_whole_surface() -> None:
    ball = meshes.bumpy_sphere(2)
    count = len(ball.triangles)
    broken = meshes.with_zero_area(ball, 7)
    whole = surface(meshes.merge([ball, broken]))
    completed = complete_cones(lsgp.Solver(whole), GivenCones.of(ball.cones, None, None), lsgp.Options(), None)
    warnings = completed.placement["warnings"]
    (alone,) = only(lsgp.place_cones(surface(broken)).warnings, "DEGENERATE_FACES").elements.indices
    assert only(warnings, "DEGENERATE_FACES").elements.indices.tolist() == [count + alone]
    # Vertices of the other part are not in the one that cones are placed on, and yet no isolated ones.
    assert "ISOLATED_VERTICES" not in codes(warnings)


def test_a_part_for_which_no_cones_are_found_does_not_refuse_the_others() -> None:
    ball, strip = meshes.bumpy_sphere(2), meshes.moebius_strip()
    result = auto_unwrap(surface(meshes.merge([ball, strip])), ball.cones)
    assert result.solved.tolist() == [True] * len(ball.triangles) + [False] * len(strip.triangles)
    assert "COMPONENT_SKIPPED" in codes(result.warnings)
    with pytest.raises(lsgp.TopologyError):
        auto_unwrap(surface(strip), [int(strip.triangles[0, 0])])


PLATE = meshes.grid()
ONE_SIDED = {
    "band": meshes.moebius_strip(),
    "broad band": meshes.moebius_strip(12, 6),
    "bottle": meshes.klein_bottle(12, 8),
    "band and plate": meshes.merge([meshes.moebius_strip(), PLATE]),
    "plate and bottle": meshes.merge([PLATE, meshes.klein_bottle(12, 8)]),
}


def shuffled(mesh: Mesh, seed: int) -> Mesh:
    """With its triangles in another order, some of them turned: the first one decides where a component is cut."""
    rng = np.random.default_rng(seed)
    triangles = mesh.triangles[rng.permutation(len(mesh.triangles))]
    turned = rng.random(len(triangles)) < 0.3
    triangles[turned] = triangles[turned][:, [0, 2, 1]]
    return mesh._replace(triangles=triangles)


@pytest.mark.parametrize("seed", [None, 1, 2])
@pytest.mark.parametrize("name", ONE_SIDED)
@pytest.mark.parametrize("preset", PRESETS)
def test_one_sided_components_are_cut_open(preset: str, name: str, seed: int | None) -> None:
    mesh = ONE_SIDED[name] if seed is None else shuffled(ONE_SIDED[name], seed)
    given = surface(mesh)
    result = auto_unwrap(given, preset=preset)
    assert result.solved.all() and not len(result.flipped)
    opened = only(result.warnings, "SEAMS_OPENED").elements.indices
    flat = len(PLATE.triangles) if "plate" in name else 0
    assert len(opened) == len(mesh.triangles) - flat
    plain = lsgp.preset_options(preset)
    assert undeclared_faults(replace(given, borders=result.borders), result, plain) == []
    # What is said to be turned is what has its corners the other way round.
    side = result.corner_uv[:, 1:] - result.corner_uv[:, :1]
    area = side[:, 0, 0] * side[:, 1, 1] - side[:, 0, 1] * side[:, 1, 0]
    told = [finding.elements.indices for finding in result.warnings if finding.code == "REORIENTED"]
    assert np.array_equal(np.flatnonzero(area < 0), np.concatenate(told) if told else [])


def test_a_one_sided_band_is_cut_across_once() -> None:
    """Which is the shortest way: no more than twice its breadth, in edges."""
    across = 3
    result = auto_unwrap(surface(meshes.moebius_strip(24, across)))
    assert len(result.borders) <= 2 * across and result.island.max() == 0


def test_where_a_one_sided_band_may_not_be_cut_it_is_not() -> None:
    """Its quads are cut along their sides alone; without any edge to cut it is refused."""
    mesh = meshes.moebius_strip(16, 2)
    given = surface(mesh)
    corners = np.sort(np.concatenate([mesh.triangles[:, [0, 1]], mesh.triangles[:, [1, 2]], mesh.triangles[:, [2, 0]]]))
    edges, count = np.unique(corners, axis=0, return_counts=True)
    inner = edges[count == 2]
    of_triangle = np.linalg.norm(mesh.positions[corners[:, 0]] - mesh.positions[corners[:, 1]], axis=1).reshape(3, -1)
    longest = corners.reshape(3, -1, 2)[of_triangle.argmax(axis=0), np.arange(len(mesh.triangles))]
    sides = inner[~np.isin(inner @ [len(mesh.positions), 1], longest @ [len(mesh.positions), 1])]
    assert 0 < len(sides) < len(inner)
    result = auto_unwrap(replace(given, edges=sides.astype(np.int32)))
    keys = np.sort(result.borders, axis=1) @ [len(mesh.positions), 1]
    assert result.solved.all() and np.isin(keys, sides @ [len(mesh.positions), 1]).all()
    with pytest.raises(lsgp.TopologyError):
        auto_unwrap(replace(given, edges=np.empty((0, 2), np.int32)))


def test_cones_that_no_map_can_have_do_not_keep_others_from_theirs() -> None:
    """A vertex with five or six triangles carries less than 1,080 degrees."""
    ball = meshes.bumpy_sphere(2)
    result = auto_unwrap(surface(meshes.merge([ball, ball])), ball.cones[:2], [6 * np.pi, 6 * np.pi])
    count = len(ball.triangles)
    assert result.solved.tolist() == [False] * count + [True] * count
    assert len(result.cones) > 0 and result.cones.min() >= len(ball.positions)
    assert "COMPONENT_SKIPPED" in codes(result.warnings)


def test_open_surfaces_that_lie_flat_get_no_cones() -> None:
    assert len(auto_unwrap(surface(meshes.grid())).cones) == 0


def test_count_is_that_of_placing() -> None:
    given = surface(meshes.bumpy_sphere(3))
    assert len(auto_unwrap(given, count=9).cones) == 9
    with pytest.raises(lsgp.InputError, match="count is -1"):
        auto_unwrap(given, count=-1)


def test_the_target_determines_how_many_cones_are_placed() -> None:
    given = surface(meshes.bumpy_sphere(3))
    maps = [auto_unwrap(given, target=target) for target in (1.01, TARGET, 1.3)]
    numbers = [len(result.cones) for result in maps]
    assert numbers[0] > numbers[1] > numbers[2]
    assert maps[0].distortion.l2_stretch < maps[1].distortion.l2_stretch < maps[2].distortion.l2_stretch <= 1.3
    assert maps[1] == auto_unwrap(given)


@pytest.mark.parametrize("target", [1.0, 0.5, -2, np.nan, np.inf])
def test_what_is_no_stretch_is_refused_as_a_target_also_where_no_cone_is_placed(target: float) -> None:
    ball = meshes.bumpy_sphere(2)
    with pytest.raises(lsgp.InputError, match=r"target is .*L2 stretch"):
        auto_unwrap(surface(ball), ball.cones, target=target)


@pytest.mark.parametrize("preset", ["PAINT", "", None, 1])
def test_unknown_presets_are_refused(preset: object) -> None:
    with pytest.raises(lsgp.InputError, match="choose one of paint, tile, bake"):
        auto_unwrap(surface(meshes.cube()), preset=preset)


def test_progress_is_that_of_placing_and_of_the_map_and_stops_both() -> None:
    given = surface(meshes.bumpy_sphere(4))
    told: list[float] = []
    auto_unwrap(given, progress=told.append)
    assert told == sorted(told) and told[0] < 0.3 and told[-1] == pytest.approx(1.0)
    for limit in (0.2, 0.8):
        with pytest.raises(lsgp.Cancelled):
            auto_unwrap(given, progress=lambda done, limit=limit: done < limit)


def test_edges_that_may_not_be_cut_are_not_cut() -> None:
    cube = meshes.cube(4)
    lengths = np.linalg.norm(np.diff(cube.positions[meshes.edges_of(cube.triangles)], axis=1)[:, 0], axis=1)
    straight = meshes.edges_of(cube.triangles)[lengths < 1.2 * lengths.min()]
    both = meshes.merge([cube, cube])
    edges = np.concatenate([straight, straight + len(cube.positions)])
    result = auto_unwrap(surface(both, edges=edges), cube.cones)
    allowed = {tuple(edge) for edge in np.sort(edges, axis=1).tolist()}
    assert {tuple(edge) for edge in np.sort(result.cut_edges, axis=1).tolist()} <= allowed


def pierced_plate() -> Surface:
    """A plate around a bar, each closed, which touch at two vertices, as exporters leave faces with holes."""
    x, y, z = 2.1148, 1.6989, 0.1714
    plate = [(-x, -y, 0), (x, -y, 0), (x, -y, z), (x, y, 0), (x, y, z), (-x, y, 0), (-x, y, z), (-x, -y, z)]
    bar = [(-0.1035, 0.1788, 0), (0.2066, 0, 0), (0.2066, 0, z), (-0.103, -0.1791, 0), (-0.103, -0.1791, z)]
    sides = [(0, 1, 2), (1, 3, 4), (3, 5, 6), (5, 0, 7), (0, 2, 7), (1, 4, 2), (3, 6, 4), (5, 7, 6)]
    walls = [(8, 9, 10), (9, 11, 12), (11, 8, 13), (8, 10, 13), (9, 12, 10), (11, 13, 12), (11, 9, 8)]
    flat = [(7, 2, 4), (7, 4, 6), (11, 0, 5), (11, 5, 3), (11, 3, 1), (11, 1, 0), (7, 12, 13), (7, 13, 10), (7, 10, 12)]
    corners = [*plate, *bar, (-0.1035, 0.1788, z)]
    return Surface(np.array(corners), np.array([*sides, *walls, *flat], np.int32))


@pytest.mark.parametrize("preset", PRESETS)
def test_parts_without_a_map_are_cut_until_they_have_one(preset: str) -> None:
    given = pierced_plate()
    result = auto_unwrap(given, preset=preset)
    assert result.solved.all() and not len(result.flipped) and not len(result.overlapping)
    ended = replace(given, borders=result.borders)
    assert undeclared_faults(ended, result, lsgp.preset_options(preset)) == []
