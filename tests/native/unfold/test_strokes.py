# SPDX-License-Identifier: GPL-3.0-or-later
"""Several strokes on one island: automatic angles and rotations about handles follow them where that costs little."""

from __future__ import annotations

from dataclasses import replace

import lsgp
import meshes
import numpy as np
import oracle
import pytest
from map_checks import codes

MOST_STRETCH = 1.1  # of L2, for following strokes
LEAST = 0.01  # radians: a smaller error is not worth another map
SEEDS = range(6)


def stroked(mesh: meshes.Mesh, seed: int, count: int = 2) -> lsgp.Surface:
    """Strokes in random directions on random triangles."""
    rng = np.random.default_rng(seed)
    directions = np.zeros(mesh.triangles.shape)
    for f in rng.choice(len(mesh.triangles), count, replace=False):
        corners = mesh.positions[mesh.triangles[f]]
        directions[f] = rng.normal(size=2) @ (corners[1:] - corners[0])
    return lsgp.Surface(mesh.positions, mesh.triangles, directions=directions)


def missed(surface: lsgp.Surface, result: lsgp.Result, rotation_order: int = 1) -> float:
    """The mean angle between v and the strokes, by area and length, modulo full turns / rotation_order, radians."""
    period, angles, weights = 2 * np.pi / rotation_order, [], []
    z = oracle.as_complex(result.corner_uv)
    for f in np.flatnonzero(surface.directions.any(axis=1)):
        place = surface.positions[surface.triangles[f]]
        edges = place[1:] - place[0]
        image = np.linalg.lstsq(edges.T, surface.directions[f], rcond=None)[0] @ (z[f, 1:] - z[f, 0])
        angle = np.angle(image / 1j)
        angles.append(abs(angle - period * np.round(angle / period)))
        weights.append(np.linalg.norm(surface.directions[f]) * np.linalg.norm(np.cross(*edges)))
    return float(np.average(angles, weights=weights))


def unwrapped(surface: lsgp.Surface, follow: bool, lattice: str | None) -> lsgp.Result:
    """Through automatic cones with automatic angles."""
    seamless = None if lattice is None else lsgp.Seamless(lattice=lattice)
    placed = lsgp.place_cones(surface, lattice=lattice, follow_strokes=follow)
    options = lsgp.Options(seamless=seamless, follow_strokes=follow)
    return lsgp.parameterize(surface, placed.cones, placed.cone_angles, options)


def bumpy_torus() -> meshes.Mesh:
    """Without symmetry: on a torus cones lie at any of several places alike, and what strokes gain there differs."""
    mesh = meshes.torus(24, 12)
    x, y, z = mesh.positions.T
    bump = np.sin(1.1 * x + 0.7) * np.cos(0.9 * y - 0.3) + 0.6 * np.sin(1.5 * z + 0.5 * x)
    return mesh._replace(positions=mesh.positions * (1 + 0.15 * bump)[:, None])


MODELS = {
    "ball": lambda: meshes.bumpy_sphere(3),
    "ellipsoid": lambda: meshes.ellipsoid(3, (1.0, 2.0, 0.6)),
    "fork": lambda: meshes.forked(3),
    "flower": lambda: meshes.flower(3),
    "torus": bumpy_torus,
}


@pytest.mark.slow
@pytest.mark.parametrize("lattice", [None, "square"])
@pytest.mark.parametrize("name", MODELS)
def test_what_follows_strokes_misses_them_by_less_and_costs_a_tenth_at_most(name: str, lattice: str | None) -> None:
    order = 1 if lattice is None else 4
    usual_errors, errors = [], []
    for seed in SEEDS:
        surface = stroked(MODELS[name](), seed)
        usual, toward = (unwrapped(surface, follow, lattice) for follow in (False, True))
        assert not {"FLIPPED_TRIANGLES", "WRONG_ANGLE_SUMS"} & set(codes(toward.warnings))
        # Rounding to tiles may turn either.
        slack = 1e-9 if lattice is None else 0.05
        usual_errors.append(missed(surface, usual, order))
        errors.append(missed(surface, toward, order))
        assert errors[-1] <= usual_errors[-1] + slack
        assert toward.distortion.l2_stretch <= MOST_STRETCH * usual.distortion.l2_stretch * (
            1.0 if lattice is None else 1.1
        )
        assert toward.direction_error == pytest.approx(errors[-1], abs=1e-6)
    assert np.mean(errors) < 0.9 * np.mean(usual_errors)


def test_marked_cones_get_angles_that_follow_strokes() -> None:
    mesh = meshes.bumpy_sphere(3)
    cones = lsgp.place_cones(lsgp.Surface(mesh.positions, mesh.triangles), count=10).cones
    gains = 0
    for seed in SEEDS:
        surface = stroked(mesh, seed)
        usual, toward = (
            lsgp.parameterize(surface, cones, options=lsgp.Options(follow_strokes=follow)) for follow in (False, True)
        )
        assert missed(surface, toward) <= missed(surface, usual) + 1e-9
        assert toward.distortion.l2_stretch <= MOST_STRETCH * usual.distortion.l2_stretch
        gains += missed(surface, toward) < 0.5 * missed(surface, usual)
    assert gains >= len(SEEDS) / 2


def test_given_angles_are_kept() -> None:
    mesh = meshes.octahedron()
    surface = stroked(meshes.subdivide(mesh), 3)
    cones, angles = list(range(6)), [4 * np.pi / 3] * 6
    results = [lsgp.parameterize(surface, cones, angles, lsgp.Options(follow_strokes=f)) for f in (False, True)]
    assert results[0].corner_uv.tobytes() == results[1].corner_uv.tobytes()


@pytest.mark.parametrize("directions", ["one", "everywhere"])
def test_what_turns_alone_can_meet_changes_no_angle(directions: str) -> None:
    mesh = meshes.bumpy_sphere(3)
    surface = stroked(mesh, 1, count=1)
    if directions == "everywhere":
        surface = replace(surface, directions=np.tile([0.0, 0.0, 1.0], (len(mesh.triangles), 1)))
    results = [unwrapped(surface, follow, None) for follow in (False, True)]
    assert results[0].corner_uv.tobytes() == results[1].corner_uv.tobytes()


def test_rotations_about_handles_follow_strokes_with_given_angles() -> None:
    """Where all angles are given, a seamless layout still has rotations about handles to choose. Many tiles, since what
    rounding to few costs is in no estimate."""
    mesh = meshes.subdivide(meshes.double_torus())
    placed = lsgp.place_cones(lsgp.Surface(mesh.positions, mesh.triangles), lattice="square")
    gains = []
    for seed in range(8):
        surface = stroked(mesh, seed)
        usual, toward = (
            lsgp.parameterize(
                surface,
                placed.cones,
                placed.cone_angles,
                lsgp.Options(seamless=lsgp.Seamless(tiles=2048), follow_strokes=follow),
            )
            for follow in (False, True)
        )
        gains.append(missed(surface, usual, 4) - missed(surface, toward, 4))
        assert toward.distortion.l2_stretch <= MOST_STRETCH * usual.distortion.l2_stretch
    assert max(gains) > 10 * LEAST
    assert min(gains) > -LEAST


@pytest.mark.slow
@pytest.mark.parametrize("preset", ["paint", "tile", "bake"])
def test_a_press_with_strokes_is_never_farther_from_them(preset: str) -> None:
    mesh = meshes.bumpy_sphere(3)
    options = lsgp.preset_options(preset)
    gained = 0
    for seed in range(4):
        surface = stroked(mesh, seed, count=3)
        usual = lsgp.auto_unwrap(surface, preset=preset, options=replace(options, follow_strokes=False))
        toward = lsgp.auto_unwrap(surface, preset=preset)
        assert toward.direction_error <= usual.direction_error
        assert toward.distortion.l2_stretch <= MOST_STRETCH * usual.distortion.l2_stretch
        gained += toward.direction_error < usual.direction_error - LEAST
    assert gained > 0


def test_components_that_mirror_each_other_follow_their_own_strokes() -> None:
    mesh = meshes.bumpy_sphere(3)
    left = stroked(mesh, 2)
    mirror = np.array([-1.0, 1.0, 1.0])
    right = stroked(mesh, 3)
    surface = lsgp.Surface(
        np.concatenate([left.positions - [3, 0, 0], (right.positions - [3, 0, 0]) * mirror]),
        np.concatenate([left.triangles, right.triangles[:, ::-1] + len(mesh.positions)]),
        directions=np.concatenate([left.directions, right.directions * mirror]),
    )
    errors = []
    for follow in (False, True):
        placed = lsgp.place_cones(surface, symmetric=True, follow_strokes=follow)
        result = lsgp.parameterize(surface, placed.cones, placed.cone_angles)
        errors.append([np.nanmean(half) for half in np.split(result.direction_errors, 2)])
    assert (np.array(errors[1]) <= np.array(errors[0]) + 1e-9).all()
    assert np.min(np.array(errors[0]) - errors[1]) > LEAST
