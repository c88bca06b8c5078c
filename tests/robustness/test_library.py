# SPDX-License-Identifier: GPL-3.0-or-later
"""The generated library: what its tool promises of every mesh, and that small ones of all kinds have whole maps."""

from __future__ import annotations

import sys
from pathlib import Path

import lsgp
import numpy as np
import pytest

sys.path.append(str(Path(__file__).resolve().parents[2] / "tools" / "library"))

from library_growth import surface_of
from library_kinds import KINDS
from library_shapes import Random, triangles_of, with_defects
from make_library import mesh_of, write

NUMBERS = range(3 * len(KINDS))


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("count", [10, 300, 3000])
def test_kinds_have_about_the_size_that_is_asked_for(kind: str, count: int) -> None:
    made = [KINDS[kind](Random([count, seed]), count) for seed in range(4)]
    for mesh in made:
        corners = triangles_of(mesh)
        assert np.isfinite(mesh.positions).all() and len(corners) == mesh.triangle_count()
        assert corners.min() >= 0 and corners.max() < len(mesh.positions)
        assert count / 10 <= len(corners) <= 10 * count


@pytest.mark.parametrize("share", [0.05, 0.3])
def test_defects_are_on_the_share_of_faces_that_was_asked_for(share: float) -> None:
    mesh = KINDS["bodies"](Random(1), 1000)
    spoiled = with_defects(mesh, share, Random(2))
    assert spoiled.triangle_count() == mesh.triangle_count() + int(share * mesh.triangle_count())


@pytest.mark.parametrize("kind", KINDS)
def test_growth_is_measured_on_surfaces_that_can_be_unwrapped(kind: str) -> None:
    """None of their triangles repeats a vertex, and nearly all of the mesh's are among them."""
    surface = surface_of(kind, 300, 0.05)
    corners = np.sort(surface.triangles, axis=1)
    assert (corners[:, 0] < corners[:, 1]).all() and (corners[:, 1] < corners[:, 2]).all()
    assert len(corners) >= 0.9 * len(triangles_of(KINDS[kind](Random([0xC0DE, 5]), 300)))


def test_a_number_gives_the_same_file_every_time(tmp_path: Path) -> None:
    for number in NUMBERS[:: len(KINDS) // 2 + 1]:
        first = write(tmp_path / "one", number, 500)
        assert write(tmp_path / "other", number, 500).read_bytes() == first.read_bytes()


def test_kinds_come_in_turn() -> None:
    kinds = [mesh_of(number, 100)[0].split("/")[0] for number in NUMBERS]
    assert kinds == 3 * list(KINDS)


@pytest.mark.parametrize("number", NUMBERS)
def test_small_ones_have_maps_of_all_that_has_an_area(number: int, tmp_path: Path) -> None:
    surface = lsgp.read_mesh_file(write(tmp_path, number, 300)).surface()
    result = lsgp.auto_unwrap(surface)
    a, b, c = np.moveaxis(surface.positions[surface.triangles], 1, 0)
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2
    assert area[~result.solved].sum() <= 1e-6 * area.sum()
    assert np.isfinite(result.corner_uv[result.solved]).all() and not len(result.flipped)
