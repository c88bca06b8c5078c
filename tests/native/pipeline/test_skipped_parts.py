# SPDX-License-Identifier: GPL-3.0-or-later
"""A failed component does not affect the others, and its reason is reported."""

from __future__ import annotations

import lsgp
import meshes
import numpy as np
import pytest
from lsgp import Options, Seamless
from map_checks import only, surface
from meshes import Mesh

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


@pytest.mark.parametrize("tiles", [None, 16, 2**14])
@pytest.mark.parametrize("overlaps", ["keep", "split"])
def test_part_that_is_lost_in_a_cell_of_the_finest_grid_leaves_the_others(overlaps: str, tiles: float | None) -> None:
    speck = GOOD._replace(positions=GOOD.positions * 1e-6)
    options = Options(seamless=Seamless(tiles=tiles), overlaps=overlaps)
    alone = lsgp.parameterize(surface(GOOD), GOOD.cones, options=options)
    both = meshes.merge([GOOD, speck])
    result = lsgp.parameterize(surface(both), both.cones, options=options)
    assert_left_out(result, speck, len(GOOD.triangles), "GRID_TOO_COARSE")
    message = only(result.warnings, "COMPONENT_SKIPPED").message
    assert "too small beside others" in message and "cones" not in message
    assert np.array_equal(result.corner_uv[: len(GOOD.triangles)], alone.corner_uv)
    assert result.seamless.tiles == alone.seamless.tiles and result.seamless.error == alone.seamless.error
    assert result.cones.tolist() == GOOD.cones.tolist()


def test_where_no_part_has_a_layout_the_first_error_is_raised() -> None:
    bad = meshes.merge([tangled(), tangled()])
    with pytest.raises(lsgp.CurvatureError) as refused:
        lsgp.parameterize(surface(bad), bad.cones, options=Options(seamless=Seamless(), repair=False))
    assert refused.value.code == "SEAMLESS_IMPOSSIBLE"
    assert refused.value.elements.indices.max() < len(tangled().positions)


def test_flat_cones_of_a_part_that_is_left_out_are_not_named() -> None:
    options = Options(seamless=Seamless(lattice="triangle"))
    ball, box = meshes.bumpy_sphere(2), meshes.cube(1)
    flat = {}
    for name, mesh in (("ball", ball), ("box", box), ("both", meshes.merge([ball, meshes.transform(box, 1, 1e-4)]))):
        result = lsgp.parameterize(surface(mesh), mesh.cones, options=options)
        flat[name] = only(result.warnings, "FLAT_CONES").elements.indices.tolist()
        assert result.seamless.flat_cones.tolist() == flat[name]
    assert not result.solved[len(ball.triangles) :].any()
    assert flat["both"] == flat["ball"] and len(flat["box"]) == 2
