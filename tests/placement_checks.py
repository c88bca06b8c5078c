# SPDX-License-Identifier: GPL-3.0-or-later
"""Placed cones against a dense model of the log scale, derived apart from the library."""

from __future__ import annotations

from dataclasses import dataclass

import lsgp
import numpy as np
import oracle
from map_checks import inner_vertices, surface
from meshes import Mesh
from numpy.typing import NDArray

TURN = oracle.TURN
USUAL_REACH = 0.6 * np.pi
SHARE = np.deg2rad(100)

Floats = NDArray[np.float64]


def place(mesh: Mesh, *args: object, **options: object) -> lsgp.Placement:
    return lsgp.place_cones(surface(mesh), *args, **options)


def curvature_of(placed: lsgp.Placement) -> Floats:
    return TURN - placed.cone_angles


def imposed_scale(mesh: Mesh, placed: lsgp.Placement) -> Floats:
    """The log scale of the placed curvatures by a sparse solve, of mean 0."""
    kappa = np.zeros(len(mesh.positions))
    kappa[placed.cones] = curvature_of(placed)
    y = oracle.solve_scale(mesh.positions, mesh.triangles, kappa)
    return y - oracle.vertex_shares(mesh.positions, mesh.triangles) @ y


def middle_l2(mesh: Mesh, y: Floats) -> float:
    """The L2 stretch of scales e^y at the middles of edges."""
    share = oracle.triangle_areas(mesh.positions, mesh.triangles)
    at = (y[mesh.triangles] + y[mesh.triangles[:, [1, 2, 0]]]) / 2
    mean = share / share.sum() / 3
    return float(np.sqrt((mean @ np.exp(2 * at)).sum() * (mean @ np.exp(-2 * at)).sum()))


def strength(mesh: Mesh, placed: lsgp.Placement) -> Floats:
    """How far each cone's curvature is from the angle defect that its vertex has anyway."""
    return np.abs(curvature_of(placed) - oracle.angle_defects(mesh.positions, mesh.triangles)[placed.cones])


@dataclass
class DenseModel:
    """Variance of the log scale, constant + 2 h.kappa + kappa.H.kappa, over all vertices."""

    constant: float
    slope: Floats
    form: Floats
    total: float | None  # of curvatures, on closed surfaces

    def least(self, cones: NDArray[np.integer]) -> tuple[float, Floats]:
        """The least variance of cones at some vertices, without bounds, and their curvatures."""
        k, closed = len(cones), self.total is not None
        system = np.zeros((k + closed, k + closed))
        system[:k, :k] = self.form[np.ix_(cones, cones)]
        right = np.append(-self.slope[cones], self.total) if closed else -self.slope[cones]
        if closed:
            system[k, :k] = system[:k, k] = 1
        kappa = np.linalg.solve(system, right)[:k]
        return self.variance(cones, kappa), kappa

    def variance(self, cones: NDArray[np.integer], kappa: Floats) -> float:
        return float(self.constant + 2 * self.slope[cones] @ kappa + kappa @ self.form[np.ix_(cones, cones)] @ kappa)


def dense_model(mesh: Mesh) -> DenseModel:
    share = oracle.vertex_shares(mesh.positions, mesh.triangles)
    defects = oracle.angle_defects(mesh.positions, mesh.triangles)
    laplacian = oracle.cotan_laplacian(mesh.positions, mesh.triangles).toarray()
    n = len(share)
    loops = oracle.boundary_loops(mesh.triangles)
    center = np.eye(n) - np.outer(np.ones(n), share)
    if loops:
        inner = inner_vertices(mesh)
        green = np.zeros((n, n))
        green[np.ix_(inner, inner)] = np.linalg.inv(laplacian[np.ix_(inner, inner)])
        green = center @ green
    else:
        green = center @ np.linalg.pinv(laplacian) @ center.T
    start = -green @ defects
    return DenseModel(
        float(share @ start**2),
        green.T @ (share * start),
        green.T @ (share[:, None] * green),
        None if loops else float(defects.sum()),
    )


def open_vertices(mesh: Mesh, cones: NDArray[np.integer]) -> NDArray[np.integer]:
    """Inner vertices more than two edges away from every cone."""
    near = np.isin(np.arange(len(mesh.positions)), cones)
    for _ in range(2):
        near[mesh.triangles[near[mesh.triangles].any(axis=1)]] = True
    return np.setdiff1d(inner_vertices(mesh), np.flatnonzero(near))
