# SPDX-License-Identifier: GPL-3.0-or-later
"""Creases of hard surfaces run along the lattice of a seamless layout, and become rows of edges of a quad mesh."""

from __future__ import annotations

import time
from dataclasses import replace
from functools import cache

import lsgp
import meshes
import numpy as np
import oracle
import pytest
from lsgp.surface import surface_arrays
from map_checks import codes, only, pairs, surface
from meshes import Mesh
from numpy.typing import NDArray
from result_check import undeclared_faults
from shared_meshes import hard_mesh
from zoo import broken, closed, tunnels

TILE = lsgp.preset_options("tile")
PLAIN = replace(TILE, straighten=False)
SHARP = np.radians(40)
MOST_L2 = 1.1  # of the stretch without
HAVE_A_DIRECTION = 0.75  # of the length of creases, along the lattice

SLAB = np.zeros((5, 5, 2), bool)
SLAB[:2], SLAB[:, :2] = True, True


HARD = {
    "box": closed.box(4, (1, 1.37, 2.11)),
    "turned box": meshes.transform(closed.box(4, (1, 1.37, 2.11)), seed=1),
    "L": meshes.voxels(SLAB),
    "wheel": closed.toothed_wheel(6, 0.2),
    "cylinder": closed.lathe(np.ones(5), np.linspace(0, 2, 5), 24, caps=(True, True)),
}


def joined(mesh: Mesh, options: lsgp.Options = TILE, features: NDArray[np.integer] | None = None) -> lsgp.Result:
    """The map whose texture runs on across creases, also where it were better to end there."""
    given = surface(mesh) if features is None else replace(surface(mesh), features=features)
    return lsgp.auto_unwrap(given, preset="tile", options=options, creases=False)


@cache
def of(name: str, along: bool = True) -> lsgp.Result:
    return joined(HARD[name], TILE if along else PLAIN)


def creases(mesh: Mesh) -> NDArray[np.int64]:
    """The halfedges at which a closed surface bends, both of each edge."""
    corners = mesh.positions[mesh.triangles]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    twin = oracle.halfedges(mesh.triangles)[2]
    h = np.arange(len(twin))
    return h[np.arccos(np.clip((normal[h // 3] * normal[twin // 3]).sum(axis=1), -1, 1)) > SHARP]


def ends(result: lsgp.Result, halfedges: NDArray[np.int64]) -> NDArray[np.float64]:
    """(h, 2, 2) both ends of halfedges in the layout, as float32 stores them."""
    uv = result.corner_uv.astype(np.float32).astype(float).reshape(-1, 2)
    return np.stack([uv[halfedges], uv[halfedges // 3 * 3 + (halfedges + 1) % 3]], axis=1)


@pytest.mark.slow
@pytest.mark.parametrize("marked", [False, True])
def test_features_lie_at_whole_or_half_tiles_where_that_is_asked_for(marked: bool) -> None:
    """Those of a spool are as far apart as they happen to be; without it some are in between."""
    profile = np.array([1.0, 1.0, 0.5, 0.5, 1.0, 1.0]), np.array([0.0, 0.2, 0.4, 1.4, 1.6, 1.8])
    spool = surface(closed.lathe(*profile, 32, caps=(True, True)))
    spool = replace(spool, features=lsgp.feature_edges(spool, angle=SHARP)) if marked else spool
    shares, sizes = {}, {}
    for places in ("anywhere", "half", "whole"):
        options = replace(TILE, seamless=replace(TILE.seamless, feature_places=places))
        result = lsgp.auto_unwrap(spool, preset="tile", options=options, creases=False)
        both = ends(result, creases(meshes.make(spool.positions, spool.triangles)))
        for step in (1, 0.5):
            at_step = ((both[:, 0] == both[:, 1]) & (both[:, 0] % step == 0)).any(axis=1)
            shares[places, step] = at_step.mean()
        sizes[places] = result.seamless.tile_size
        assert undeclared_faults(spool, result, options) == []
    assert shares["anywhere", 0.5] < 0.9 < min(shares["half", 0.5], shares["whole", 1])
    # Half tiles are not whole ones, but larger.
    assert shares["half", 1] < 0.9 and sizes["half"] > sizes["whole"]


@pytest.mark.parametrize("name", HARD)
def test_every_crease_lies_on_a_line_of_the_lattice(name: str) -> None:
    mesh, result = HARD[name], of(name)
    both = ends(result, creases(mesh))
    on_line = (both[:, 0] == both[:, 1]) & (both[:, 0] == np.round(both[:, 0]))
    assert on_line.any(axis=1).all()
    assert result.seamless.feature_share == 1
    assert "FEATURES_OFF_LATTICE" not in codes(result.warnings)
    assert undeclared_faults(surface(mesh), result, TILE) == []


@pytest.mark.slow
@pytest.mark.parametrize("teeth", [7, pytest.param(10, marks=pytest.mark.many_solves)])
def test_creases_whose_lengths_depend_on_each_other_lie_on_fine_lines(teeth: int) -> None:
    """Its cones follow from each other by halves and thirds of lengths, all of which have to be whole."""
    mesh = closed.toothed_wheel(teeth, 0.2)
    result = joined(mesh)
    both = 256 * ends(result, creases(mesh))
    assert ((both[:, 0] == both[:, 1]) & (both[:, 0] == np.round(both[:, 0]))).any(axis=1).all()
    assert result.seamless.feature_share == 1
    assert undeclared_faults(surface(mesh), result, TILE) == []


@pytest.mark.parametrize("name", HARD)
def test_that_costs_at_most_a_tenth_of_stretch(name: str) -> None:
    assert of(name).distortion.l2_stretch <= MOST_L2 * of(name, False).distortion.l2_stretch


def test_every_component_has_the_cones_that_serve_it() -> None:
    """Cones for creases stretch the star too much, and without them the prism keeps less of its creases."""
    prism, star = closed.prism(6, 2, 1.0), closed.star(5, 0.5, 0.5)
    alone = [joined(mesh) for mesh in (prism, star)]
    both = meshes.merge([prism, star])
    result = joined(both)
    in_prism = result.cones < len(prism.positions)
    assert sorted(result.cones[in_prism]) == sorted(alone[0].cones)
    # Which of its corners alike the star's are at hangs on rounding; those for creases would be at all of them.
    assert np.count_nonzero(~in_prism) <= len(alone[1].cones) + 2 < len(star.positions)
    assert result.seamless.feature_share == 1
    assert undeclared_faults(surface(both), result, TILE) == []


def test_open_components_without_features_get_no_cones_for_them() -> None:
    box, cup = closed.box(2, (1, 1, 1)), closed.lathe(np.ones(4), np.arange(4.0), 16, caps=(False, True))
    cones = lsgp._lsgp.feature_cones(surface_arrays(surface(meshes.merge([box, cup]))), True, None)[0]
    assert sorted(cones) == sorted(lsgp._lsgp.feature_cones(surface_arrays(surface(box)), True, None)[0])
    assert len(cones) == 8


def test_corners_of_caps_with_thousands_of_sides_are_chosen_among_some() -> None:
    """Each candidate is a right-hand side, and has a product with every other one."""
    sides = 4000
    given = surface(closed.prism(sides, 1, 2))
    begin = time.process_time()
    cones, angles = lsgp._lsgp.feature_cones(surface_arrays(given), True, None)
    assert time.process_time() - begin < 8
    assert (2 * np.pi - angles).sum() == pytest.approx(4 * np.pi)
    assert np.unique(cones).size == len(cones) <= 8


@pytest.mark.parametrize("height, seed", [(0.25, 1), (0.25, 3), (0.3, 4)])
def test_creases_of_coarse_round_shapes_do_not_make_tiles_small(height: float, seed: int) -> None:
    """They are as sharp as those of hard surfaces, but lead everywhere, so that others cannot be along it."""
    given = surface(closed.noise_sphere(1, height, seed))
    result, plain = (lsgp.auto_unwrap(given, preset="tile", options=each) for each in (TILE, PLAIN))
    along = lsgp.parameterize(given, result.cones, result.cone_angles, TILE)
    assert along.seamless.feature_share < HAVE_A_DIRECTION
    np.testing.assert_array_equal(result.corner_uv, plain.corner_uv)
    assert along.seamless.tile_size < result.seamless.tile_size / 2
    assert along.distortion.l2_stretch > result.distortion.l2_stretch
    told = only(result.warnings, "FEATURES_OFF_LATTICE")
    assert pairs(told.elements.indices.reshape(-1, 2)) == pairs(along.seamless.creases.reshape(-1, 2))
    assert f"only {100 * along.seamless.feature_share:.0f} %" in told.message
    marked = replace(given, features=lsgp.feature_edges(given, angle=SHARP))
    assert lsgp.auto_unwrap(marked, preset="tile").features.share > 0.25


ROUND = {
    "cylinder": closed.with_polygon_caps(32, (1, 1), 2),
    "rod": closed.with_polygon_caps(24, (1, 1), 16),
    "disk": closed.with_polygon_caps(32, (2, 2), 0.3),
    "prism": closed.with_polygon_caps(12, (1, 1), 2),
    "cone": closed.with_polygon_caps(32, (1, 0), 2),
    "cut cone": closed.with_polygon_caps(32, (1, 0.5), 2),
}


@pytest.mark.parametrize("name", ROUND)
def test_round_parts_end_at_rims_that_cannot_run_along_the_lattice(name: str) -> None:
    """Their caps have no place for cones inside; ended there, all but the apex of a cone unrolls."""
    given = surface(ROUND[name])
    result, usual = lsgp.auto_unwrap(given, preset="tile"), joined(ROUND[name])
    assert len(result.borders) > 0 and len(usual.borders) == 0
    assert result.distortion.l2_stretch < (1.005 if name == "cone" else 1 + 1e-9) < usual.distortion.l2_stretch
    assert len(result.cones) == (name == "cone")
    assert result.seamless.tile_size > 0.9 * usual.seamless.tile_size
    assert undeclared_faults(replace(given, borders=result.borders), result, TILE) == []
    if "cone" in name:
        return
    positions, triangles, _ = ROUND[name]
    halfedges = creases(ROUND[name])
    sides = halfedges[np.ptp(positions[triangles][halfedges // 3, :, 2], axis=1) > 0]
    rims = ends(result, sides)
    assert len(rims) > 0 and (rims[:, 0] == rims[:, 1]).any(axis=1).all()


def test_only_the_components_that_need_it_end_at_creases() -> None:
    box, rod = closed.box(2, (1, 1, 1)), ROUND["cylinder"]
    both = meshes.merge([box, rod])
    result = lsgp.auto_unwrap(surface(both), preset="tile")
    assert result.borders.min() >= len(box.positions)
    assert sorted(result.cones) == sorted(lsgp.auto_unwrap(surface(box), preset="tile").cones)


@pytest.mark.parametrize("marked", ["cones", "seams", "features"])
def test_marked_parts_do_not_end_at_creases(marked: str) -> None:
    mesh = ROUND["cylinder"]
    cones = lsgp.place_cones(surface(mesh), lattice="square").cones if marked == "cones" else ()
    rim = np.stack([np.arange(32), np.roll(np.arange(32), -1)], axis=1)
    given = surface(mesh) if marked == "cones" else replace(surface(mesh), **{marked: rim})
    assert len(lsgp.auto_unwrap(given, cones, preset="tile").borders) == 0


SOFT = [meshes.bumpy_sphere(2), meshes.torus(), meshes.icosphere(1), closed.noise_sphere(3, 0.04, 1)]


@pytest.mark.nightly
@pytest.mark.many_solves
def test_creases_are_followed_as_far_as_marked_ones() -> None:
    """On a part with bevels, through cones for creases, which cost stretch as the creases do through others."""
    mesh = hard_mesh("anchor")
    share = joined(mesh, features=lsgp.feature_edges(surface(mesh), angle=SHARP)).features.share
    assert joined(mesh).seamless.feature_share >= share - 0.05 > 0.85


@pytest.mark.parametrize("mesh", SOFT)
def test_soft_surfaces_are_laid_out_as_without(mesh: Mesh) -> None:
    """The coarse ball is bent by more than 20 degrees, but nowhere by 40; noise is, at edges that form no lines."""
    along, plain = (lsgp.auto_unwrap(surface(mesh), preset="tile", options=each) for each in (TILE, PLAIN))
    np.testing.assert_array_equal(along.corner_uv, plain.corner_uv)
    assert along.seamless.feature_share is None and plain.seamless.feature_share is None


def test_creases_off_the_lattice_are_named() -> None:
    """Those of this gear contradict each other; the warning and the share say which are off, and how much of them."""
    mesh = closed.gear(4, 0.3, 2)
    result = joined(mesh)
    found = creases(mesh)
    both = ends(result, found)
    off = (both[:, 0] != both[:, 1]).all(axis=1)
    corners = np.stack([found, found // 3 * 3 + (found + 1) % 3], axis=1)
    edges = np.sort(mesh.triangles.ravel()[corners[off]], axis=1)
    named = only(result.warnings, "FEATURES_OFF_LATTICE").elements
    assert named.kind == "edges"
    assert {tuple(sorted(edge)) for edge in named.indices.reshape(-1, 2).tolist()} == set(map(tuple, edges.tolist()))
    length = np.linalg.norm(np.diff(mesh.positions[mesh.triangles.ravel()[corners]], axis=1)[:, 0], axis=1)
    assert result.seamless.feature_share == pytest.approx(length[~off].sum() / length.sum(), abs=1e-9)
    ends_of = np.sort(mesh.triangles.ravel()[corners], axis=1).tolist()
    is_aligned = zip(np.sort(result.seamless.creases, axis=1).tolist(), result.seamless.is_crease_aligned, strict=True)
    assert {tuple(edge): bool(aligned) for edge, aligned in is_aligned} == {
        tuple(edge): not is_off for edge, is_off in zip(ends_of, off.tolist(), strict=True)
    }


def test_tiles_of_a_given_size_keep_what_they_can() -> None:
    """Not all creases of this gear find a place on 32 tiles; before some were released, none did."""
    mesh = closed.gear(4, 0.3, 2)
    options = replace(TILE, seamless=replace(TILE.seamless, tiles=32))
    result = joined(mesh, options)
    both = ends(result, creases(mesh))
    assert result.seamless.tiles == 32
    assert 0.25 < result.seamless.feature_share < 1
    assert (both[:, 0] == both[:, 1]).any(axis=1).mean() > 0.25
    assert undeclared_faults(surface(mesh), result, options) == []


@pytest.mark.parametrize("small", [closed.gear(4, 0.3, 2), closed.star(7, 0.5, 0.3)], ids=["gear", "star"])
def test_creases_of_a_small_part_do_not_take_others_off_the_lattice(small: Mesh) -> None:
    """Not all of its creases find a place, and none on tiles as large as those of the box."""
    box = HARD["box"]
    mesh = meshes.merge([box, meshes.transform(small, 1, 0.05)])
    result = joined(mesh)
    both = ends(result, creases(mesh)[: len(creases(box))])
    assert (both[:, 0] == both[:, 1]).any(axis=1).all(), "the box keeps what it has alone"
    assert result.seamless.tiles <= 128
    assert undeclared_faults(surface(mesh), result, TILE) == []


def test_a_rim_along_the_lattice_does_not_turn() -> None:
    """A disk whose rim is straight has its whole turn in cones of the disk and in corners of the rim."""
    mesh, result = HARD["cylinder"], of("cylinder")
    for height in (0.0, 2.0):
        rim = np.isclose(mesh.positions[result.cones][:, 2], height)
        assert (2 * np.pi - result.cone_angles[rim]).sum() == pytest.approx(2 * np.pi)


@pytest.mark.parametrize("name", ["box", "L"])
def test_creases_become_edges_of_quads(name: str) -> None:
    mesh = HARD[name]
    quads = lsgp.remesh_to_quads(surface(mesh), target=300).mesh
    sides = quads.positions[np.stack([quads.quads, np.roll(quads.quads, -1, axis=1)], axis=-1).reshape(-1, 2)]
    middle, side = sides.mean(axis=1), np.diff(sides, axis=1)[:, 0]
    ends_of = np.stack([(found := creases(mesh)), found // 3 * 3 + (found + 1) % 3], axis=1)
    covered = whole = 0.0
    for a, b in mesh.positions[mesh.triangles.ravel()[ends_of]]:
        length = np.linalg.norm(b - a)
        along = (middle - a) @ (b - a) / length
        away = np.linalg.norm(middle - a - along[:, None] * (b - a) / length, axis=1)
        is_parallel = np.abs(side @ (b - a)) > 0.999 * length * np.linalg.norm(side, axis=1)
        near = (away < 1e-5) & is_parallel & (along >= 0) & (along < length)
        covered += np.linalg.norm(side[near], axis=1).sum() / 2  # every side is in two quads
        whole += length
    assert covered == pytest.approx(whole, rel=0.05)


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize("corners", [4, 5])
def test_lines_without_a_free_coordinate_are_laid_out(corners: int, seed: int) -> None:
    """A few triangles without cuts and cones: nothing has to be rounded but creases, of which few are left."""
    mesh = broken.scrap(corners, 2.0, seed)
    assert undeclared_faults(surface(mesh), joined(mesh), TILE) == []


@pytest.mark.slow
def test_all_creases_of_a_plate_with_many_tunnels_run_along_the_lattice() -> None:
    mesh = surface(tunnels.tunneled_plate(4, 3, 1))
    alone, shared = (
        lsgp.auto_unwrap(mesh, preset="tile", creases=False, options=replace(TILE, threads=threads))
        for threads in (1, 2)
    )
    for result in (alone, shared):
        assert result.seamless.feature_share == 1 and result.seamless.error == 0
        assert len(result.flipped) == len(result.wrong_angle_sums) == 0
    assert np.array_equal(alone.corner_uv, shared.corner_uv)


def test_a_plate_with_more_corners_than_cones_are_worth_ends_at_its_creases() -> None:
    mesh = tunnels.tunneled_plate(4, 3, 1)
    result = lsgp.auto_unwrap(surface(mesh), preset="tile")
    assert len(result.borders) > 0 and len(result.cones) == 0 and result.solved.all()
    assert result.distortion.l2_stretch == pytest.approx(1, abs=1e-9)
    assert undeclared_faults(replace(surface(mesh), borders=result.borders), result, TILE) == []


def test_tile_of_a_plate_with_many_tunnels_reports_progress_and_can_be_stopped_late() -> None:
    reports: list[float] = []

    def stop_late(done: float) -> bool:
        reports.append(done)
        return done < 0.9

    with pytest.raises(lsgp.Cancelled):
        lsgp.auto_unwrap(surface(tunnels.tunneled_plate(4, 3, 1)), preset="tile", creases=False, progress=stop_late)
    assert reports == sorted(reports) and len(reports) > 20
