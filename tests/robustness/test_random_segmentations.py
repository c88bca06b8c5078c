# SPDX-License-Identifier: GPL-3.0-or-later
"""Random seams that part a surface into disks and planar pieces: just they are cut, and the layout is valid.

A selection runs at every change; LSGP_FULL_SWEEP=1 runs all seeds on all generated and shared meshes.
"""

from __future__ import annotations

import lsgp
import meshes
import numpy as np
import pytest
from map_checks import codes, only, pairs, surface
from meshes import Mesh
from nightly import EVERYTHING
from numpy.typing import NDArray
from result_check import undeclared_faults
from segmentations import glue, pieces_of, random_segmentation
from shared_meshes import shared_mesh

MODES = ("follow", "exact", "boundary")
GENERATED = {
    "cube": meshes.cube(6),
    "bumpy": meshes.bumpy_sphere(3),
    "flower": meshes.flower(3),
    "forked": meshes.forked(3),
    "hill": meshes.hill(10),
    "holes": meshes.disk_with_holes(14, 2),
    "cylinder": meshes.cylinder(16, 6),
    "torus": meshes.torus(18, 10),
    "two holes": meshes.subdivide(meshes.subdivide(meshes.double_torus())),
    "one-sided": meshes.moebius_strip(),
}
SEEDS = range(20) if EVERYTHING else range(2)
# The others have parts that get no seam, triangles that lie on others, or edges of more than two triangles.
SHARED = [
    "bird",
    "blobby-misoriented",
    "camel-head-disk",
    "cube-768",
    "eight-genus2",
    "elephant-genus3",
    "fandisk",
    "hand-5k",
    "igea-16k",
    "julius",
    "kitten-genus1",
    "max-planck-25k",
    "moebius",
    "octa-flower",
    "rabbit",
]


def segmented(mesh: Mesh, seed: int, *, holes: bool = True) -> NDArray[np.int64]:
    rng = np.random.default_rng([seed, len(mesh.triangles)])
    return random_segmentation(mesh.triangles, int(rng.integers(2, 12)), rng, holes=holes)


def assert_just_the_seams_are_cut(mesh: Mesh, seams: NDArray[np.int64], mode: str) -> None:
    options = lsgp.Options(seams=mode)
    result = lsgp.parameterize(surface(mesh, seams=seams), [], options=options)
    assert result.solved.all()
    assert pairs(glue(mesh.triangles).opened(result.corner_uv)) == pairs(seams)
    assert "CUTS_ADDED" not in codes(result.warnings)
    assert pairs(result.cut_edges) == pairs(seams)
    z = result.corner_uv[..., 0] + 1j * result.corner_uv[..., 1]
    area = np.imag((z[:, 1] - z[:, 0]).conj() * (z[:, 2] - z[:, 0]))
    reversed_triangles = np.zeros(len(area), bool)
    for finding in result.warnings:
        if finding.code == "REORIENTED":
            reversed_triangles[finding.elements.indices] = True
    assert (np.where(reversed_triangles, -area, area) > 0).all()
    assert undeclared_faults(surface(mesh, seams=seams), result, options) == []
    assert len(result.flipped) == 0 and len(result.wrong_angle_sums) == 0


def test_segmentations_have_disks_and_pieces_with_holes() -> None:
    borders: list[int] = []
    for mesh in GENERATED.values():
        for seed in SEEDS:
            seams, gluing = segmented(mesh, seed), glue(mesh.triangles)
            found = pieces_of(gluing, gluing.among(seams))
            assert found.planar.all() and len(seams) > 0
            borders += found.borders.tolist()
    assert borders.count(1) > 50 and sum(count > 1 for count in borders) > 5


@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("name", GENERATED)
def test_just_the_seams_are_cut(name: str, seed: int, mode: str) -> None:
    assert_just_the_seams_are_cut(GENERATED[name], segmented(GENERATED[name], seed), mode)


@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize("seed", range(15) if EVERYTHING else range(1))
@pytest.mark.parametrize("name", SHARED if EVERYTHING else ("bird", "cube-768", "eight-genus2", "moebius"))
def test_just_the_seams_of_shared_meshes_are_cut(name: str, seed: int, mode: str) -> None:
    mesh = shared_mesh(name)
    assert_just_the_seams_are_cut(mesh, segmented(mesh, seed), mode)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("name", ["cube", "bumpy", "flower", "torus", "two holes"])
def test_seams_between_disks_suffice_for_cones_on_them(name: str, seed: int) -> None:
    mesh, rng = GENERATED[name], np.random.default_rng([seed, len(name)])
    seams = segmented(mesh, seed, holes=False)
    cones = rng.choice(np.unique(seams), 6, replace=False)
    result = lsgp.parameterize(surface(mesh, seams=seams), cones)
    assert pairs(result.cut_edges) == pairs(seams)
    assert "CUTS_ADDED" not in codes(result.warnings)
    assert undeclared_faults(surface(mesh, seams=seams), result) == []


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("name", ["cube", "bumpy", "flower", "torus", "two holes"])
def test_cuts_to_cones_off_the_seams_are_named(name: str, seed: int) -> None:
    mesh, rng = GENERATED[name], np.random.default_rng([seed, len(name)])
    seams = segmented(mesh, seed)
    cones = rng.choice(np.setdiff1d(mesh.triangles, seams), 6, replace=False)
    result = lsgp.parameterize(surface(mesh, seams=seams), cones)
    added = only(result.warnings, "CUTS_ADDED")
    assert added.elements.kind == "edges"
    assert pairs(added.elements.indices) == pairs(result.cut_edges) - pairs(seams)
    assert pairs(seams) <= pairs(result.cut_edges)
    assert added.message.startswith(f"{len(added.elements.indices)} edge")
