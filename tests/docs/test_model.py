# SPDX-License-Identifier: GPL-3.0-or-later
"""The model of the examples is the output of its script, and suitable for every example."""

import importlib.util

import lsgp
import numpy as np
import pytest
from code_blocks import ROOT

EXAMPLES = ROOT / "examples"


@pytest.fixture(scope="module")
def made():
    spec = importlib.util.spec_from_file_location("make_model", EXAMPLES / "make_model.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_the_file_is_what_the_script_makes(made):
    stored = (EXAMPLES / "model.obj").read_bytes()
    assert stored == made.as_obj(*made.model()).encode(), "run: python examples/make_model.py"


def test_the_model_is_closed_mirror_symmetric_and_stands_on_the_ground(made):
    positions, quads = made.model()
    assert positions[:, 1].min() == 0
    edges = np.stack([quads, np.roll(quads, -1, axis=1)], axis=-1).reshape(-1, 2)
    assert sorted(map(tuple, edges)) == sorted(map(tuple, edges[:, ::-1]))  # each edge once both ways
    assert len(positions) - len(edges) // 2 + len(quads) == 2  # a sphere
    corners = positions[quads]
    flux = np.einsum("ij,ij->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2]))
    assert flux > 0  # outside is outside
    from_mirrored = np.linalg.norm(positions[:, None] - positions * (-1, 1, 1), axis=2).min(axis=1)
    assert from_mirrored.max() < 1e-12


def test_automatic_cones_unwrap_it_without_overlap():
    surface = lsgp.read_mesh_file(EXAMPLES / "model.obj").surface()
    placed = lsgp.place_cones(surface)
    result = lsgp.parameterize(surface, placed.cones, placed.cone_angles)
    assert result.solved.all() and not result.warnings
    assert len(result.flipped) == len(result.overlapping) == 0
    assert result.distortion.l2_stretch < 1.05
