# SPDX-License-Identifier: GPL-3.0-or-later
"""So many given cones that their angles are found with directions from a coarse surface: the same angles as without."""

from __future__ import annotations

from functools import cache

import lsgp
import meshes
import numpy as np
import oracle
import pytest
from map_checks import assert_curvature_adds_up, inner_vertices, prescribe, surface
from meshes import Mesh
from sanitized_run import many_solves

TURN = 2 * np.pi
COUNTS = (160, 240)  # from 151 on, with 40 vertices for each


def with_cones(mesh: Mesh, count: int) -> Mesh:
    cones = np.random.default_rng(count).choice(inner_vertices(mesh), count, replace=False)
    return mesh._replace(cones=cones.astype(np.int32))


def crowded(mesh: Mesh, count: int) -> Mesh:
    """The vertices at one end: angles reach their bounds."""
    return mesh._replace(cones=np.argsort(mesh.positions[:, 0])[:count].astype(np.int32))


CLOSED = meshes.bumpy_sphere(5)
STRETCHED = CLOSED._replace(positions=CLOSED.positions * np.array([1, 1, 30]))  # takes exact Hessians in the end
CASES = {
    "closed": with_cones(CLOSED, 160),
    "open": with_cones(meshes.hill(100), 160),
    "crowded": crowded(CLOSED, 160),
    "stretched": with_cones(STRETCHED, 160),
}
every_case = pytest.mark.parametrize(
    "name",
    ["closed", "crowded", *many_solves("open", "stretched")],
)


@cache
def prescribed(name: str) -> lsgp.Prescription:
    return prescribe(CASES[name])


@cache
def scale_model(name: str) -> oracle.ScaleModel:
    return oracle.scale_model(*CASES[name])


@every_case
def test_harmonic_angles(name: str) -> None:
    mesh = CASES[name]
    found = prescribe(mesh, prescription="harmonic")
    assert found.cone_angles == pytest.approx(oracle.harmonic_angles(*mesh), abs=1e-9)


@pytest.mark.slow
@every_case
def test_no_angle_can_be_improved(name: str) -> None:
    """The objective is convex: at its minimum the slope is 0 at cones within their bounds, up to a constant where
    Gauss-Bonnet determines the sum, and points outside at the others."""
    mesh = CASES[name]
    angles = prescribed(name).cone_angles
    model = scale_model(name)
    slope = -model.objective(TURN - angles)[1]  # of the angles
    low, high = oracle.angle_box(*mesh)
    assert (angles >= low - 1e-9).all() and (angles <= high + 1e-9).all()
    at_low, at_high = angles < low + 1e-7, angles > high - 1e-7
    free = ~at_low & ~at_high
    assert free.sum() > 1
    assert free.all() == (name in ("closed", "open"))
    if model.closed:
        assert_curvature_adds_up(mesh, mesh.cones, angles)
        slope = slope - slope[free].mean()
    assert np.abs(slope[free]).max() <= 1e-10
    assert (slope[at_low] >= -1e-10).all() and (slope[at_high] <= 1e-10).all()


@every_case
def test_the_log_scale_is_that_of_the_angles(name: str) -> None:
    found = prescribed(name)
    model = scale_model(name)
    y = model.log_scale(TURN - found.cone_angles)
    assert found.log_scale == pytest.approx(y - model.share @ y, abs=1e-9)


def test_back_substitutions_do_not_grow_with_the_cones() -> None:
    options = lsgp.Options(repair=False)
    spent = []
    for count in COUNTS:
        mesh = with_cones(CLOSED, count)
        spent.append(lsgp.parameterize(surface(mesh), mesh.cones, options=options).back_substitutions)
    # One for each cone on the coarse surface, the cheaper one.
    assert spent[1] - spent[0] <= COUNTS[1] - COUNTS[0] + 10
    assert spent[0] <= COUNTS[0] + 100


@pytest.mark.slow
@pytest.mark.parametrize(
    "seamless",
    [pytest.param(None, id="plain", marks=pytest.mark.many_solves), pytest.param(lsgp.Seamless(), id="seamless")],
)
def test_angles_do_not_depend_on_what_was_asked_before(seamless: lsgp.Seamless | None) -> None:
    """Rounding angles needs the effect of every cone on the surface itself as well."""
    mesh = CASES["closed"]
    solver = lsgp.Solver(surface(mesh))
    solver.parameterize(mesh.cones, options=lsgp.Options(repair=False, seamless=lsgp.Seamless()))
    options = lsgp.Options(repair=False, seamless=seamless)
    again = solver.parameterize(mesh.cones, options=options)
    fresh = lsgp.parameterize(surface(mesh), mesh.cones, options=options)
    assert again.corner_uv.tobytes() == fresh.corner_uv.tobytes()
