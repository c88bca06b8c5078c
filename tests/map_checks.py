# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks that every finished map has to pass: exact transitions, imposed angles, complete lists of defects."""

from __future__ import annotations

import dataclasses
import hashlib
from collections.abc import Sequence

import lsgp
import numpy as np
import oracle
from meshes import Mesh, compact, make
from numpy.typing import NDArray

SISTER_RATIO = 1e-9
RESIDUAL = 1e-12
ANGLE = 1e-6


def surface(mesh: Mesh, edges: object = None, seams: object = None, cut_costs: object = None) -> lsgp.Surface:
    return lsgp.Surface(mesh.positions, mesh.triangles, edges, seams, cut_costs=cut_costs)


def unwrap(
    mesh: Mesh,
    angles: Sequence[float | None] | None = None,
    seams: object = None,
    seams_mode: str = "follow",
    **options: str,
) -> lsgp.Result:
    """The map of a mesh through its own cones."""
    wanted = lsgp.Options(seams=seams_mode, **options)
    return lsgp.parameterize(surface(mesh, seams=seams), mesh.cones, angles, wanted)


def prescribe(mesh: Mesh, angles: Sequence[float | None] | None = None, **options: str) -> lsgp.Prescription:
    return lsgp.prescribe_curvature(surface(mesh), mesh.cones, angles, lsgp.Options(**options))


def codes(findings: Sequence[lsgp.Finding]) -> list[str]:
    return [finding.code for finding in findings]


def only(findings: Sequence[lsgp.Finding], code: str) -> lsgp.Finding:
    """The one finding with this code."""
    found = [finding for finding in findings if finding.code == code]
    assert len(found) == 1, f"expected one {code}, got {codes(findings)}"
    return found[0]


def digest(result: lsgp.Result) -> str:
    """Of all that a result holds but the time it took: arrays by their bytes, figures and findings by their digits."""
    parts: list[bytes] = []

    def add(value: object) -> None:
        if isinstance(value, np.ndarray):
            parts.append(value.tobytes())
        elif isinstance(value, lsgp.SeamlessReport):
            add_fields(value)
        else:
            parts.append(repr(value).encode())

    def add_fields(of: object) -> None:
        for field in dataclasses.fields(of):
            if field.name != "stage_seconds":
                add(getattr(of, field.name))

    add_fields(result)
    return hashlib.sha256(b"|".join(parts)).hexdigest()


def pairs(edges: object) -> set[tuple[int, int]]:
    """Vertex pairs as a set, the smaller vertex first."""
    return {(min(a, b), max(a, b)) for a, b in np.asarray(edges).tolist()}


def components(mesh: Mesh) -> list[tuple[Mesh, NDArray[np.integer]]]:
    """Each connected part as a mesh of its own with its triangles' numbers in the whole."""
    label = oracle.face_components(mesh.triangles)
    parts = []
    for i in range(label.max() + 1):
        faces = np.flatnonzero(label == i)
        cones = np.intersect1d(mesh.cones, mesh.triangles[faces])
        parts.append((compact(make(mesh.positions, mesh.triangles[faces], cones)), faces))
    return parts


def inner_vertices(mesh: Mesh) -> NDArray[np.integer]:
    rim = np.concatenate([np.empty(0, int), *oracle.boundary_loops(mesh.triangles)])
    return np.setdiff1d(mesh.triangles, rim)


def wanted_angle_sums(mesh: Mesh, cones: object, angles: object) -> NDArray[np.float64]:
    """2 pi everywhere but at the cones, for inner vertices."""
    wanted = np.full(len(mesh.positions), oracle.TURN)
    wanted[np.asarray(cones)] = angles
    return wanted


def assert_curvature_adds_up(mesh: Mesh, cones: object, angles: object) -> None:
    """Gauss-Bonnet to 1e-9 on a closed component."""
    total = (oracle.TURN - np.asarray(angles)).sum()
    assert abs(total - oracle.angle_defects(mesh.positions, mesh.triangles).sum()) <= 1e-9


def assert_exact_transitions(mesh: Mesh, result: lsgp.Result) -> None:
    """Sister edges of equal length, one rotation and one translation a path, read from the coordinates alone, and the
    result's own figures agree.  For one component of genus 0 also: the rotation is the curvature on one side."""
    nodes = np.concatenate([result.cones, *oracle.boundary_loops(mesh.triangles)]).astype(int)
    genus_0 = oracle.euler_of(mesh.triangles) == 2 - len(oracle.boundary_loops(mesh.triangles))
    rotations = None
    if genus_0:
        kappa, _ = oracle.full_curvature(mesh.positions, mesh.triangles, result.cones, result.cone_angles)
        cut = oracle.cut_open(mesh.triangles, result.cut_edges).cut
        rotations = oracle.cut_rotations(mesh.positions, mesh.triangles, cut, kappa)
    seams = oracle.seam_quality(mesh.triangles, result.corner_uv, result.cut_edges, nodes, rotations)
    assert seams.ratio.max(initial=1) - 1 <= SISTER_RATIO
    assert seams.translation_residual <= RESIDUAL
    if rotations is not None and len(rotations):
        assert np.abs(seams.turn - np.exp(1j * rotations)).max() <= SISTER_RATIO
    assert result.seams.sister_ratio_max - 1 <= SISTER_RATIO
    assert result.seams.rotation_residual <= SISTER_RATIO
    assert result.seams.translation_residual <= RESIDUAL


def assert_angles_met(mesh: Mesh, result: lsgp.Result) -> None:
    """No flips, and around every inner vertex the angles of the map add up to what was imposed."""
    assert (oracle.signed_areas(result.corner_uv) > 0).all()
    assert result.flipped.size == 0 and result.wrong_angle_sums.size == 0
    sums = oracle.uv_angle_sums(mesh.triangles, result.corner_uv, len(mesh.positions))
    inner = inner_vertices(mesh)
    error = np.abs(sums - wanted_angle_sums(mesh, result.cones, result.cone_angles))
    assert error[inner].max(initial=0) <= ANGLE
    assert result.cone_angle_error <= ANGLE


def solve_again(mesh: Mesh, result: lsgp.Result, method: str = "poisson") -> oracle.Map:
    """The oracle's map on the cut and with the angles of a result."""
    return oracle.unfold(
        mesh.positions,
        mesh.triangles,
        result.cones,
        result.cone_angles,
        result.cut_edges,
        method,
        oracle.read_loop_scale(mesh.triangles, result.log_scale),
    )
