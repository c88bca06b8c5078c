# SPDX-License-Identifier: GPL-3.0-or-later
"""What one more cone would gain, against a dense model of the log scale."""

from __future__ import annotations

import lsgp
import meshes
import numpy as np
import oracle
import pytest
import zoo
from map_checks import surface
from meshes import Mesh
from placement_checks import dense_model, open_vertices, place

COUNT = {"bumpy": 12, "hill": 5}
MESHES = {"bumpy": meshes.bumpy_sphere(2), "hill": meshes.hill(14)}


@pytest.mark.parametrize("name", MESHES)
def test_gains_are_those_of_a_dense_model(name: str) -> None:
    """The L2 stretch is e^(2 variance) to leading order, so the variance of one more cone can be read from it."""
    mesh = MESHES[name]
    cones = place(mesh, count=COUNT[name]).cones
    gains = lsgp.cone_gains(surface(mesh), cones)
    model = dense_model(mesh)
    present, _ = model.least(cones)
    allowed = open_vertices(mesh, cones)
    assert np.flatnonzero(np.isfinite(gains.predicted_l2)).tolist() == allowed.tolist()
    exact = np.array([present - model.least(np.append(cones, v))[0] for v in allowed])
    read = np.log(gains.present_l2 / gains.predicted_l2[allowed]) / 2
    assert read == pytest.approx(exact, abs=0.1 * exact.max())
    assert exact[allowed == gains.best] >= 0.9 * exact.max()


@pytest.mark.parametrize("name", MESHES)
def test_the_best_vertex_does_what_is_told(name: str) -> None:
    mesh = MESHES[name]
    cones = place(mesh, count=COUNT[name]).cones
    gains = lsgp.cone_gains(surface(mesh), cones)
    after = place(mesh, [*cones, gains.best], count=COUNT[name] + 1).predicted_l2
    assert after < gains.present_l2
    assert after == pytest.approx(gains.predicted_l2[gains.best], abs=0.2 * (gains.present_l2 - 1))


def test_a_closed_surface_without_cones_needs_one() -> None:
    gains = lsgp.cone_gains(surface(MESHES["bumpy"]))
    assert gains.present_l2 == np.inf and gains.best is not None
    assert np.isfinite(gains.predicted_l2).all() and (gains.predicted_l2 >= 1).all()


def test_the_part_that_needs_a_cone_most_comes_first() -> None:
    first, second = MESHES["bumpy"], meshes.flower(2)
    mesh = meshes.merge([first, second])
    cones = place(first, count=8).cones
    gains = lsgp.cone_gains(surface(mesh), cones)
    assert gains.best >= len(first.positions)


def test_borders_and_existing_cones_have_no_gain() -> None:
    mesh: Mesh = MESHES["hill"]
    gains = lsgp.cone_gains(surface(mesh), mesh.cones)
    rim = np.concatenate(oracle.boundary_loops(mesh.triangles))
    assert np.isnan(gains.predicted_l2[rim]).all() and np.isnan(gains.predicted_l2[mesh.cones]).all()


def test_stretch_beyond_all_numbers_has_a_best_vertex() -> None:
    """A sphere with a spike so long that stretches overflow: figures are finite, and gains are still told apart."""
    mesh = zoo.member("spiked-ball-levels=2-spikes=1-height=10").mesh()
    gains = lsgp.cone_gains(lsgp.Surface(mesh.positions, mesh.triangles))
    assert np.nanmax(gains.predicted_l2) <= 1e100
    model = dense_model(mesh)
    variance = [model.least(np.array([v]))[0] for v in range(len(mesh.positions))]
    assert variance[gains.best] <= 1.1 * min(variance)


def test_a_predicted_stretch_is_a_number() -> None:
    mesh = zoo.member("mixture-seed=587420").mesh()
    surface = lsgp.Surface(mesh.positions, mesh.triangles)
    prescribed = lsgp.prescribe_curvature(surface, mesh.cones)
    assert np.ptp(prescribed.log_scale) > 710  # what an exponential can be taken of
    assert 1e50 < prescribed.predicted_l2 <= 1e100
    assert "HIGH_DISTORTION" in {finding.code for finding in prescribed.warnings}
