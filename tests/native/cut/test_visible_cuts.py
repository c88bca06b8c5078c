# SPDX-License-Identifier: GPL-3.0-or-later
"""How much of all cuts is seen from the front, those that undo overlaps and fill the square included."""

from __future__ import annotations

from dataclasses import replace

import lsgp
import meshes
import numpy as np
import pytest
from map_checks import pairs, surface
from meshes import Mesh
from nightly import nightly
from zoo.swept import circle, sweep

FRONT = (0, 0, 1)
UNSEEN, IN_FULL_SIGHT = 0.1, 30.1  # the costs of an edge that no view sees, and of one that all do


def horned(seed: int, horns: int) -> Mesh:
    """A ball with a low nose and a bare face in front, and horns elsewhere, alike on both sides of x = 0."""
    random = np.random.RandomState(seed)
    ball = meshes.icosphere(3)
    p = ball.positions
    radius = 1 + 0.35 * np.exp(18 * (p[:, 2] - 1))
    tips: list[np.ndarray] = []
    while len(tips) < horns:
        tip = random.standard_normal(3)
        tip /= np.linalg.norm(tip)
        if tip[2] > 0.5 or abs(tip[0]) < 0.25 or any(tip @ other > 0.8 for other in tips):
            continue
        tips.append(tip)
        height, sharpness = random.uniform(0.8, 2.2), random.uniform(8, 25)
        for side in (1, -1):
            radius += height * np.exp(sharpness * (p @ (tip * [side, 1, 1]) - 1))
    return meshes.make(p * radius[:, None], ball.triangles)


def bent_tube(seed: int) -> Mesh:
    """A closed tube along a generic curve."""
    random = np.random.RandomState(seed)
    t = np.linspace(0, 3, 40)
    waves = random.uniform(-1, 1, (3, 3)) / [1, 2, 3]
    phase = random.uniform(0, 2 * np.pi, (3, 3))
    path = 4 * np.sum(waves[..., None] * np.sin(np.array([1, 2, 3])[:, None] * t + phase[..., None]), axis=1).T
    return sweep(path, circle(0.45, 14), closed=False, caps=True)


FAMILIES = {
    "heads": [horned(seed, 1 + seed % 2) for seed in range(4)],
    "beasts": [horned(seed, 4 + seed % 3) for seed in range(4)],
    "tubes": [bent_tube(seed) for seed in range(4)],
    "blobs": [meshes.bumpy_sphere(3, height) for height in (0.36, 0.48)],
}


def visible_length(mesh: Mesh, preset: str, is_hidden: bool) -> tuple[float, float]:
    """Of all cuts, in square roots of the surface's area, and of as long ones that run anywhere."""
    given = surface(mesh, edges=meshes.edges_of(mesh.triangles))
    views = np.cbrt((lsgp.cut_costs(given, FRONT, creases=False) - UNSEEN) / (IN_FULL_SIGHT - UNSEEN))
    hidden = replace(given, cut_costs=lsgp.cut_costs(given, FRONT)) if is_hidden else given
    result = lsgp.auto_unwrap(hidden, preset=preset)
    cuts = pairs(result.cut_edges)
    is_cut = np.array([(int(a), int(b)) in cuts for a, b in given.edges])
    length = np.linalg.norm(np.diff(given.positions[given.edges], axis=1), axis=2).ravel()
    corners = given.positions[given.triangles]
    area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1).sum() / 2
    anywhere = is_cut @ length * (length @ views) / length.sum()
    return float(is_cut @ (length * views) / np.sqrt(area)), float(anywhere / np.sqrt(area))


@pytest.mark.slow
@pytest.mark.many_solves
@pytest.mark.parametrize(
    ("family", "preset", "of_shortest", "of_anywhere"),
    [
        ("heads", "paint", 0.8, 2 / 3),
        ("tubes", "paint", 0.95, 0.85),
        ("blobs", "bake", 0.8, 2 / 3),
        *nightly(
            ("heads", "bake", 0.8, 2 / 3),
            ("beasts", "paint", 0.95, 2 / 3),
            ("beasts", "bake", 0.95, 2 / 3),
            ("tubes", "bake", 0.95, 0.85),
            ("blobs", "paint", 0.8, 2 / 3),
        ),
    ],
)
def test_whole_layouts_keep_their_cuts_out_of_sight(
    family: str, preset: str, of_shortest: float, of_anywhere: float
) -> None:
    """Less of them is seen than of the shortest cuts, and than of edges anywhere, of which shortest cuts show from .75
    to 1.2 times as much. Tubes that are left whole have short cuts, and go through what is seen."""
    hidden, anywhere = np.sum([visible_length(mesh, preset, is_hidden=True) for mesh in FAMILIES[family]], axis=0)
    shortest, _ = np.sum([visible_length(mesh, preset, is_hidden=False) for mesh in FAMILIES[family]], axis=0)
    assert hidden <= min(of_shortest * shortest, of_anywhere * anywhere)


@pytest.mark.many_solves
def test_hidden_cuts_leave_few_islands() -> None:
    """With sight alone as the cost, ten layouts come apart in twenty islands."""
    islands = 0
    for mesh in (horned(seed, 5 + seed % 3) for seed in range(10)):
        given = surface(mesh, edges=meshes.edges_of(mesh.triangles))
        given = replace(given, cut_costs=lsgp.cut_costs(given, FRONT))
        placed = lsgp.place_cones(given, count=24)
        options = lsgp.Options(mode="low-stretch", overlaps="split")
        split = lsgp.parameterize(given, placed.cones, placed.cone_angles, options)
        assert len(split.overlapping) == 0
        islands += int(split.island.max()) + 1
    assert islands <= 15
