# SPDX-License-Identifier: GPL-3.0-or-later
"""A failed component does not affect the others, and its reason is reported."""

from __future__ import annotations

import lsgp
import meshes
import numpy as np
import pytest
from lsgp import Options, Seamless
from map_checks import codes, only, surface
from meshes import Mesh
from opened_surface import named_by
from result_check import undeclared_faults

GOOD = meshes.cube(3)


def tangled(seed: int = 0) -> Mesh:
    """A sphere so crumpled that its map has flips, which only a repair would take out."""
    ball = meshes.icosphere(2)
    rng = np.random.default_rng(seed)
    crumpled = ball.positions + rng.normal(size=ball.positions.shape) * 0.25
    return meshes.make(crumpled, ball.triangles, rng.choice(len(crumpled), 6, replace=False))


def assert_left_out(result: lsgp.Result, mesh: Mesh, first: int, code: str) -> None:
    finding = only(result.warnings, "COMPONENT_SKIPPED")
    skipped = np.arange(first, first + len(mesh.triangles))
    assert code in finding.message and finding.elements.indices.tolist() == skipped.tolist()
    assert np.flatnonzero(~result.solved).tolist() == skipped.tolist()
    assert np.isnan(result.corner_uv[skipped]).all() and np.isfinite(result.corner_uv[:first]).all()
    assert result.flipped.size == 0 and result.wrong_angle_sums.size == 0


def test_map_that_cannot_be_rounded_is_not_laid_out() -> None:
    bad, options = tangled(), Options(seamless=Seamless(tiles=16), repair=False)
    with pytest.raises(lsgp.CurvatureError) as alone:
        lsgp.parameterize(surface(bad), bad.cones, options=options)
    assert alone.value.code == "SEAMLESS_IMPOSSIBLE"
    both = meshes.merge([GOOD, bad])
    result = lsgp.parameterize(surface(both), both.cones, options=options)
    assert_left_out(result, bad, len(GOOD.triangles), "SEAMLESS_IMPOSSIBLE")
    good = lsgp.parameterize(surface(GOOD), GOOD.cones, options=options)
    assert np.array_equal(result.corner_uv[: len(GOOD.triangles)], good.corner_uv)
    assert np.array_equal(result.seamless.cut_translations, good.seamless.cut_translations)


@pytest.mark.parametrize("overlaps", ["keep", "split"])
def test_part_whose_cuts_single_precision_can_hardly_hold_is_laid_out(overlaps: str) -> None:
    """Two cones on one edge, of a length far below the last digit."""
    options = Options(seamless=Seamless(tiles=16), overlaps=overlaps)
    both = meshes.merge([GOOD, meshes.with_close_cones(1e-7)])
    result = lsgp.parameterize(surface(both), both.cones, options=options)
    assert undeclared_faults(surface(both), result, options) == []
    assert result.solved.all() and result.flipped.size == 0 and result.wrong_angle_sums.size == 0
    assert result.seamless.tiles == 16 and result.seamless.error == 0


@pytest.mark.parametrize("size", [1e-2, 1e-4, 1e-6])
@pytest.mark.parametrize("tiles", [16, 64])
def test_small_part_is_laid_out_on_a_finer_grid_beside_the_others(tiles: float | None, size: float) -> None:
    """On tiles of about its own size, and the others as if it were not there, up to a translation by whole tiles."""
    small = GOOD._replace(positions=GOOD.positions * size)
    options = Options(seamless=Seamless(tiles=tiles))
    alone = lsgp.parameterize(surface(GOOD), GOOD.cones, options=options)
    both = meshes.merge([GOOD, small])
    result = lsgp.parameterize(surface(both), both.cones, options=options)
    assert undeclared_faults(surface(both), result, options) == []
    assert result.solved.all() and result.seamless.error == 0
    moved = result.corner_uv[: len(GOOD.triangles)] - alone.corner_uv
    assert np.array_equal(np.round(moved[0, 0]), moved[0, 0]) and np.ptp(moved, axis=(0, 1)).max() < 1e-5
    assert result.seamless.tiles == alone.seamless.tiles and "GRID_REFINED" not in codes(result.warnings)
    assert np.ptp(result.corner_uv[len(GOOD.triangles) :], axis=(0, 1)).max() < 8
    assert only(result.warnings, "HIGH_DISTORTION").elements.indices.tolist() == list(
        range(len(GOOD.triangles), len(both.triangles))
    )


def test_where_no_part_has_a_layout_the_first_error_is_raised() -> None:
    bad = meshes.merge([tangled(), tangled()])
    with pytest.raises(lsgp.CurvatureError) as refused:
        lsgp.parameterize(surface(bad), bad.cones, options=Options(seamless=Seamless(), repair=False))
    assert refused.value.code == "SEAMLESS_IMPOSSIBLE"
    assert refused.value.elements.indices.max() < len(tangled().positions)


@pytest.mark.parametrize("lattice", ["square", "triangle"])
def test_flat_cones_of_a_part_that_is_left_out_are_not_named(lattice: str) -> None:
    options = Options(seamless=Seamless(lattice=lattice), repair=False)
    ball, bad = meshes.bumpy_sphere(2), tangled()
    flat = {}
    for name, mesh in (("ball", ball), ("both", meshes.merge([ball, bad]))):
        result = lsgp.parameterize(surface(mesh), mesh.cones, options=options)
        flat[name] = named_by(result, "FLAT_CONES").tolist()
        assert result.seamless.flat_cones.tolist() == flat[name]
    assert not result.solved[len(ball.triangles) :].any()
    assert flat["both"] == flat["ball"]
