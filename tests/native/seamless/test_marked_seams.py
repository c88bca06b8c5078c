# SPDX-License-Identifier: GPL-3.0-or-later
"""Marked seams are cut in seamless layouts as in others: those that no cone needs have whole tiles as transitions."""

from __future__ import annotations

from dataclasses import replace

import lsgp
import meshes
import numpy as np
import pytest
from map_checks import pairs, surface
from meshes import Mesh
from result_check import undeclared_faults
from segmentations import glue, pieces_of, random_segmentation

MODELS = {
    "bumpy sphere": meshes.bumpy_sphere(3),
    "cube": meshes.cube(6),
    "torus": meshes.torus(),
    "saddle": meshes.saddle(),
    "cylinder": meshes.cylinder(),
}


def loop_around(mesh: Mesh, height: float) -> np.ndarray:
    """The edges between the triangles whose centers are above a height and those below, all around the model."""
    above = mesh.positions[mesh.triangles].mean(axis=1)[:, 2] > height
    gluing = glue(mesh.triangles)
    return gluing.edges[above[gluing.one // 3] != above[gluing.other // 3]]


def assert_seams_are_cut(seamed: lsgp.Surface, result: lsgp.Result, options: lsgp.Options) -> None:
    assert result.solved.all()
    assert pairs(seamed.seams) <= pairs(result.cut_edges)
    assert undeclared_faults(seamed, result, options) == []
    # What the seams enclose is apart in the layout, so that nothing of it can be moved with its neighbors.
    pieces = pieces_of(
        glue(seamed.triangles), np.isin(*(_keys(e) for e in (glue(seamed.triangles).edges, seamed.seams)))
    )
    for island in range(int(result.island.max()) + 1):
        assert len(np.unique(pieces.of_triangle[result.island == island])) == 1


def _keys(edges: np.ndarray) -> np.ndarray:
    return np.sort(edges, axis=1) @ np.array([1 << 32, 1])


@pytest.mark.parametrize("lattice", ["square", "triangle"])
@pytest.mark.parametrize("name", ["bumpy sphere", "cube"])
def test_a_loop_of_seams_divides_a_seamless_layout(name: str, lattice: str) -> None:
    mesh = MODELS[name]
    seamed = surface(mesh, seams=loop_around(mesh, 0.1))
    options = lsgp.Options(seamless=lsgp.Seamless(tiles=24, lattice=lattice))
    assert_seams_are_cut(seamed, lsgp.parameterize(seamed, mesh.cones, options=options), options)


@pytest.mark.parametrize("overlaps", ["keep", "split"])
@pytest.mark.parametrize("name", list(MODELS))
def test_seams_that_part_a_model_are_cut_in_seamless_layouts(name: str, overlaps: str) -> None:
    mesh = MODELS[name]
    seamed = surface(mesh, seams=random_segmentation(mesh.triangles, 6, np.random.default_rng(3)))
    options = lsgp.Options(seamless=lsgp.Seamless(tiles=24), overlaps=overlaps)
    assert_seams_are_cut(seamed, lsgp.parameterize(seamed, mesh.cones, options=options), options)


def test_seams_that_part_nothing_are_cut_and_closed_in_the_layout() -> None:
    """Their sides coincide, so that nothing is moved; whoever reads the cuts still finds them."""
    mesh = meshes.saddle(8)
    inside = np.array([[30, 31], [31, 32], [32, 33], [48, 49]], np.int32)
    options = lsgp.Options(seamless=lsgp.Seamless(tiles=4))
    plain = lsgp.parameterize(surface(mesh), [], options=options)
    seamed = surface(mesh, seams=inside)
    result = lsgp.parameterize(seamed, [], options=options)
    assert_seams_are_cut(seamed, result, options)
    assert result.island.max() == plain.island.max() == 0


@pytest.mark.parametrize("preset", ["paint", "bake", "tile"])
def test_every_preset_cuts_a_loop_of_seams(preset: str) -> None:
    mesh = MODELS["bumpy sphere"]
    seamed = surface(mesh, seams=loop_around(mesh, 0.1))
    result = lsgp.auto_unwrap(seamed, preset=preset)
    # Without given cones the texture need not run on across seams, but for tiles.
    options = lsgp.preset_options(preset)
    assert_seams_are_cut(seamed, result, options if preset == "tile" else replace(options, seams="boundary"))
