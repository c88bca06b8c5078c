# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces of many handles: what takes few steps for each is made, and what grows with their cube refused at once."""

from __future__ import annotations

from typing import get_args

import lsgp
import meshes
import numpy as np
import pytest
from lsgp.presets.auto_unwrap import Preset
from map_checks import surface
from nightly import some_nightly

# Gauss-Bonnet asks for eight cones for each handle, of which 2,048 may be placed.
TOO_MANY = 17
# Where a face of a handle has less of the area than an island has to.
TINY_FACES = 23


def star_prism(corners: int) -> lsgp.Surface:
    """A prism over a star, its caps as fans of triangles from their middles."""
    angle, radius = 2 * np.pi * np.arange(corners) / corners, np.where(np.arange(corners) % 2, 1, 0.6)
    rim = np.stack([radius * np.cos(angle), radius * np.sin(angle), 0 * angle], axis=1)
    positions = np.concatenate([rim, rim + np.array([0, 0, 0.3]), [[0, 0, 0], [0, 0, 0.3]]])
    i, j = np.arange(corners), (np.arange(corners) + 1) % corners
    low, high = np.full(corners, 2 * corners), np.full(corners, 2 * corners + 1)
    sides = [(i, j, j + corners), (i, j + corners, i + corners), (low, j, i), (high, i + corners, j + corners)]
    return lsgp.Surface(positions, np.concatenate([np.stack(side, axis=1) for side in sides]).astype(np.int32))


def assert_usable(result: lsgp.Result) -> None:
    assert result.solved.all()
    assert not len(result.flipped)
    assert not len(result.overlapping)


def test_more_cones_than_can_be_placed_are_refused_with_the_estimate_and_the_limit() -> None:
    with pytest.raises(
        lsgp.SolverError, match=r"2304 cones.* multiplications .* GB of memory; the limit is 2048"
    ) as found:
        lsgp.place_cones(surface(meshes.perforated_slab(TOO_MANY)))
    assert found.value.code == "SOLVER_FAILED"


def test_surfaces_that_take_too_many_cones_end_at_all_their_creases() -> None:
    slab = meshes.perforated_slab(TINY_FACES)
    borders = lsgp.crease_borders(surface(slab), most_corners=24)
    # At least the rims of all holes, on both sides.
    assert len(borders) >= 2 * 4 * TINY_FACES**2


@pytest.mark.slow
@pytest.mark.many_solves
@pytest.mark.parametrize("preset", some_nightly(get_args(Preset), "paint", "bake"))
def test_every_preset_unwraps_hundreds_of_handles(preset: Preset) -> None:
    result = lsgp.auto_unwrap(surface(meshes.perforated_slab(TOO_MANY)), preset=preset, pack="shelves")
    assert_usable(result)
    assert result.distortion.l2_stretch == pytest.approx(1, abs=1e-6)


@pytest.mark.slow
def test_layouts_whose_rounding_would_take_too_much_are_refused() -> None:
    with pytest.raises(lsgp.SolverError, match=r"GB of memory; the limit is"):
        lsgp.remesh_to_quads(surface(meshes.perforated_slab(10)))


@pytest.mark.nightly
@pytest.mark.many_solves
def test_where_no_cones_are_found_a_map_ends_at_creases() -> None:
    assert_usable(lsgp.auto_unwrap(star_prism(1000), preset="tile"))
