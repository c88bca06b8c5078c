# SPDX-License-Identifier: GPL-3.0-or-later
"""The check of results finds what it is there to find: sound maps pass, and every way to spoil one is noticed."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import lsgp
import meshes
import numpy as np
import pytest
from map_checks import surface, unwrap
from result_check import undeclared_faults

MESH = meshes.bumpy_sphere(2)
SURFACE = surface(MESH)
SOUND = unwrap(MESH)

MIXED = meshes.merge([meshes.cube(2), meshes.moebius_strip(8, 1)])
SPLIT = meshes.with_flipped(meshes.hill(6), [7])
DOUBLED = SPLIT._replace(triangles=np.concatenate([SPLIT.triangles, SPLIT.triangles[3:4]]))


@pytest.mark.parametrize("mesh", [MESH, MIXED, SPLIT, DOUBLED, meshes.torus(14, 8), meshes.bow_tie(3)[0]])
@pytest.mark.parametrize("unfold", ["poisson", "spectral"])
def test_sound_maps_pass(mesh: meshes.Mesh, unfold: str) -> None:
    options = lsgp.Options(unfold=unfold)
    result = lsgp.parameterize(surface(mesh), mesh.cones, None, options)
    assert undeclared_faults(surface(mesh), result, options) == []


def spoiled(change: Callable[[np.ndarray], object]) -> lsgp.Result:
    """The sound map with its coordinates changed in place."""
    uv = SOUND.corner_uv.copy()
    change(uv)
    return replace(SOUND, corner_uv=uv)


def moved_vertex(uv: np.ndarray, by: float) -> None:
    """A vertex away from cones and cuts."""
    vertex = np.setdiff1d(MESH.triangles, np.union1d(SOUND.cut_edges, SOUND.cones))[5]
    uv[MESH.triangles == vertex] += by


def corner_on_seam(uv: np.ndarray, by: float) -> None:
    """One side of an end of a cut edge."""
    a, b = SOUND.cut_edges[3]
    face = np.flatnonzero((MESH.triangles == a).any(axis=1) & (MESH.triangles == b).any(axis=1))[0]
    at = uv[face][MESH.triangles[face] == a]
    uv[(MESH.triangles == a) & (uv == at).all(axis=2)] += by


SPOILED = {
    "not finite": lambda: spoiled(lambda uv: uv[7, 1].fill(np.nan)),
    "flipped": lambda: spoiled(lambda uv: moved_vertex(uv, 0.5)),
    "mirrored": lambda: spoiled(lambda uv: np.negative(uv[..., 0], out=uv[..., 0])),
    "collapsed": lambda: spoiled(lambda uv: uv[7].fill(0.5)),
    "seam moved a little": lambda: spoiled(lambda uv: corner_on_seam(uv, 1e-9)),
    "seam moved far": lambda: spoiled(lambda uv: corner_on_seam(uv, 1e-3)),
    "triangle torn off": lambda: spoiled(lambda uv: uv[7].__iadd__([1e-3, 0])),
    "sheared": lambda: spoiled(lambda uv: uv[..., 0].__iadd__(0.01 * uv[..., 1])),
    "single precision": lambda: replace(SOUND, corner_uv=SOUND.corner_uv.astype(np.float32).astype(float)),
    "angles off": lambda: replace(SOUND, cone_angles=SOUND.cone_angles + np.array([1e-5, -1e-5, 0, 0, 0, 0])),
    "Gauss-Bonnet off": lambda: replace(SOUND, cone_angles=SOUND.cone_angles + 1e-8),
    "a cone withheld": lambda: replace(SOUND, cones=SOUND.cones[1:], cone_angles=SOUND.cone_angles[1:]),
    "unsolved triangles": lambda: replace(SOUND, solved=SOUND.solved & (np.arange(len(SOUND.solved)) > 3)),
    "stretch is no number": lambda: replace(SOUND, distortion=replace(SOUND.distortion, l2_stretch=np.nan)),
    "flips listed, not named": lambda: replace(SOUND, flipped=np.array([3], np.int32)),
}


@pytest.mark.parametrize("name", SPOILED)
def test_spoiled_maps_are_noticed(name: str) -> None:
    assert undeclared_faults(SURFACE, SPOILED[name]()) != []


def test_a_warning_withheld_is_noticed() -> None:
    mesh, options = MESH, lsgp.Options()
    hard = lsgp.parameterize(SURFACE, mesh.cones, [0.05 * np.pi] * 4 + [3.9 * np.pi] * 2, options)
    assert undeclared_faults(SURFACE, hard) == [] and len(hard.flipped)
    silent = replace(hard, warnings=[], flipped=np.empty(0, np.int32), wrong_angle_sums=np.empty(0, np.int32))
    assert len(undeclared_faults(SURFACE, silent)) >= 1
    skipped = lsgp.parameterize(surface(MIXED), MIXED.cones)
    assert undeclared_faults(surface(MIXED), replace(skipped, warnings=[])) != []


def test_seams_as_borders_need_no_transitions() -> None:
    seams = MESH.triangles[:60, :2]
    opened = lsgp.Surface(MESH.positions, MESH.triangles, None, seams)
    options = lsgp.Options(seams="boundary")
    result = lsgp.parameterize(opened, MESH.cones, None, options)
    assert undeclared_faults(opened, result, options) == []
