# SPDX-License-Identifier: GPL-3.0-or-later
"""The pipeline derived a second time, in numpy and scipy, for the tests to compare the library with.

Nothing here follows the library's route where another one exists: transitions are constraint rows of a KKT system, one
per cut edge, instead of eliminated unknowns; the prescription is left to a general optimizer; the spectral map comes
from a subspace iteration (or a dense eigenproblem on a null space) instead of a Lanczos process; measures come from
singular value decompositions and from corner coordinates alone.

Conventions: positions p (n, 3), triangles t (m, 3) counter-clockwise, corner c of triangle f is 3 f + c, L is the
positive semidefinite cotan Laplacian with weights (cot a + cot b) / 2, K the angle defects, kappa the imposed ones,
and L y = kappa - K for the log scale y.  The rotation of a cut edge a -> b is the sum of kappa on b's side of it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import scipy.linalg as la
import scipy.optimize as opt
import scipy.sparse as sp
import scipy.sparse.linalg as spla
from numpy.typing import NDArray
from scipy.sparse import csgraph

FloatArray = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]
IntArray = NDArray[np.integer]

TURN = 2 * np.pi


# --- geometry -------------------------------------------------------------------------------------------------------


def triangle_areas(p: FloatArray, t: IntArray) -> FloatArray:
    return np.linalg.norm(np.cross(p[t[:, 1]] - p[t[:, 0]], p[t[:, 2]] - p[t[:, 0]]), axis=1) / 2


def corner_angles(p: FloatArray, t: IntArray) -> FloatArray:
    """(m, 3) unsigned angles of the triangles of points in the plane or in space."""
    p = np.pad(p, ((0, 0), (0, 3 - p.shape[1])))
    angles = []
    for c in range(3):
        a, b = p[t[:, (c + 1) % 3]] - p[t[:, c]], p[t[:, (c + 2) % 3]] - p[t[:, c]]
        angles.append(np.arctan2(np.linalg.norm(np.cross(a, b), axis=1), (a * b).sum(axis=1)))
    return np.stack(angles, axis=1)


def halfedges(t: IntArray) -> tuple[IntArray, IntArray, IntArray]:
    """Tail, head and opposite halfedge (-1 on a boundary) of halfedge 3 f + c, which runs from corner c to the next."""
    tail, head = t.ravel().astype(np.int64), t[:, [1, 2, 0]].ravel().astype(np.int64)
    n = int(t.max()) + 1
    key, back = tail * n + head, head * n + tail
    order = np.argsort(key)
    at = np.minimum(np.searchsorted(key[order], back), len(key) - 1)
    found = key[order][at] == back
    return tail, head, np.where(found, order[at], -1)


def boundary_loops(t: IntArray) -> list[IntArray]:
    """The vertices of each boundary loop, sorted; ordered by their smallest vertex."""
    tail, head, twin = halfedges(t)
    rim = twin < 0
    n = int(t.max()) + 1
    _, label = csgraph.connected_components(sp.coo_matrix((np.ones(rim.sum()), (tail[rim], head[rim])), (n, n)), False)
    loops: dict[int, list[int]] = {}
    for v in np.unique(tail[rim]):
        loops.setdefault(label[v], []).append(int(v))
    return [np.array(loop) for loop in loops.values()]


def face_components(t: IntArray) -> IntArray:
    """A label for each triangle, equal where triangles are joined through edges."""
    _, _, twin = halfedges(t)
    h = np.flatnonzero(twin >= 0)
    return csgraph.connected_components(sp.coo_matrix((np.ones(len(h)), (h // 3, twin[h] // 3)), (len(t),) * 2), False)[
        1
    ]


def euler_of(t: IntArray) -> int:
    """Vertices - edges + triangles."""
    _, _, twin = halfedges(t)
    return len(np.unique(t)) - (3 * len(t) - int((twin >= 0).sum()) // 2) + len(t)


def angle_defects(p: FloatArray, t: IntArray) -> FloatArray:
    """2 pi, on the boundary pi, less the angles around each vertex; 0 at isolated ones."""
    full = np.zeros(len(p))
    full[np.unique(t)] = TURN
    for loop in boundary_loops(t):
        full[loop] = np.pi
    return full - np.bincount(t.ravel(), corner_angles(p, t).ravel(), len(p))


def cotan_laplacian(p: FloatArray, t: IntArray) -> sp.csr_matrix:
    """Stiffness matrix of piecewise linear functions: sum over triangles of area * grad_i . grad_j."""
    edge = np.stack([p[t[:, (c + 2) % 3]] - p[t[:, (c + 1) % 3]] for c in range(3)], axis=1)
    local = np.einsum("fik,fjk->fij", edge, edge) / (4 * triangle_areas(p, t))[:, None, None]
    rows, cols = np.repeat(t, 3, axis=1), np.tile(t, (1, 3))
    return sp.csr_matrix((local.ravel(), (rows.ravel(), cols.ravel())), (len(p), len(p)))


def vertex_shares(p: FloatArray, t: IntArray) -> FloatArray:
    """A third of the area of the triangles around each vertex, as a share of the whole."""
    area = triangle_areas(p, t)
    return np.bincount(t.ravel(), np.repeat(area / 3, 3), len(p)) / area.sum()


# --- curvature prescription, one component ----------------------------------------------------------------------------


def solve_scale(p: FloatArray, t: IntArray, kappa: FloatArray, loop_scale: Sequence[float] = ()) -> FloatArray:
    """y with L y = kappa - K inside; loop_scale (0 where not given) on the boundary, or of area-weighted mean 0."""
    matrix = cotan_laplacian(p, t)
    border = np.zeros(len(p))
    for loop, scale in zip(boundary_loops(t), loop_scale, strict=False):
        border[loop] = scale
    right = kappa - angle_defects(p, t) - matrix @ border
    fixed = np.concatenate(boundary_loops(t) or [np.unique(t)[:1]])
    y = border + _dirichlet(matrix, right, fixed, np.unique(t))
    return y if boundary_loops(t) else y - vertex_shares(p, t) @ y


def read_loop_scale(t: IntArray, y: FloatArray) -> list[float]:
    """The value of y on every boundary loop relative to the first; it has to be one value a loop."""
    loops = boundary_loops(t)
    assert all(np.ptp(y[loop]) <= 1e-9 for loop in loops)
    return [float(y[loop[0]] - y[loops[0][0]]) for loop in loops]


def _dirichlet(matrix: sp.csr_matrix, right: FloatArray, fixed: IntArray, used: IntArray) -> FloatArray:
    free = np.setdiff1d(used, fixed)
    out = np.zeros(right.shape)
    if len(free):
        out[free] = spla.splu(matrix[free][:, free].tocsc()).solve(right[free])
    return out


def harmonic_angles(p: FloatArray, t: IntArray, cones: IntArray) -> FloatArray:
    """Total cone angles from y = 0 at the cones and the boundary, L y = -K elsewhere."""
    laplacian, defects = cotan_laplacian(p, t), angle_defects(p, t)
    y = _dirichlet(laplacian, -defects, np.concatenate([cones, *boundary_loops(t)]).astype(int), np.unique(t))
    return TURN - (defects + laplacian @ y)[cones]


@dataclass
class ScaleModel:
    """y = base + green @ kappa_of_cones, affine in the cone curvatures; share: area shares of the vertices."""

    base: FloatArray
    green: FloatArray
    share: FloatArray
    closed: bool
    total: float

    def log_scale(self, kappa: FloatArray) -> FloatArray:
        return self.base + self.green @ kappa

    def objective(self, kappa: FloatArray) -> tuple[float, FloatArray]:
        """log mean e^2y + log mean e^-2y, the logarithm of the squared predicted L2 stretch, and its gradient."""
        y = self.log_scale(kappa)
        value, gradient = 0.0, np.zeros_like(y)
        for sign in (1, -1):
            top = (sign * 2 * y).max()
            weight = self.share * np.exp(sign * 2 * y - top)
            value += top + np.log(weight.sum())
            gradient += sign * 2 * weight / weight.sum()
        return float(value), self.green.T @ gradient


def scale_model(p: FloatArray, t: IntArray, cones: IntArray) -> ScaleModel:
    """The affine map from cone curvatures to log scales.  On closed surfaces it holds for kappa with the right sum."""
    laplacian, defects, used = cotan_laplacian(p, t), angle_defects(p, t), np.unique(t)
    loops = boundary_loops(t)
    right = np.zeros((len(p), len(cones) + 1))
    right[:, 0] = -defects
    right[cones, np.arange(len(cones)) + 1] = 1
    fixed = np.concatenate(loops or [used[:1]])
    y = _dirichlet(laplacian, right, fixed, used)
    # Grounding one vertex hands it whatever curvature is left over, which is none when kappa has the right sum.
    return ScaleModel(y[:, 0], y[:, 1:], vertex_shares(p, t), not loops, float(defects.sum()))


def angle_box(p: FloatArray, t: IntArray, cones: IntArray) -> tuple[FloatArray, FloatArray]:
    """Bounds of the cone angles: [pi/4, min(4 pi, 0.6 valence pi)] enlarged to the harmonic angles."""
    valence = np.bincount(t.ravel(), minlength=len(p))[cones]
    harmonic = harmonic_angles(p, t, cones)
    return np.minimum(np.pi / 4, harmonic), np.maximum(np.minimum(4 * np.pi, 0.6 * valence * np.pi), harmonic)


def least_distortion_angles(p: FloatArray, t: IntArray, cones: IntArray) -> tuple[FloatArray, float]:
    """The bounded log-mean rule by sequential quadratic programming; angles and objective."""
    model = scale_model(p, t, cones)
    low, high = angle_box(p, t, cones)
    constraint = {"type": "eq", "fun": lambda k: k.sum() - model.total, "jac": lambda k: np.ones((1, len(k)))}
    found = opt.minimize(
        model.objective,
        TURN - harmonic_angles(p, t, cones),
        jac=True,
        method="SLSQP",
        bounds=opt.Bounds(TURN - high, TURN - low),
        constraints=[constraint] if model.closed else [],
        options={"ftol": 1e-15, "maxiter": 500},
    )
    return TURN - found.x, float(found.fun)


def predicted_l2(y: FloatArray, share: FloatArray) -> float:
    return float(np.sqrt((share @ np.exp(2 * y)) * (share @ np.exp(-2 * y))))


# --- cuts -------------------------------------------------------------------------------------------------------------


def shortest_cut_tree(p: FloatArray, t: IntArray, cones: IntArray, edges: IntArray | None = None) -> tuple[float, set]:
    """Length of the minimum spanning tree over all shortest paths between nodes, and the set of the edges on it.

    Nodes are the cones and, contracted to a point each, the boundary loops; no path enters a loop but at its end.
    edges restricts the paths.  The set is unique on generic surfaces only, the length always.
    """
    if edges is None:
        tail, head, _ = halfedges(t)
        edges = np.unique(np.sort(np.stack([tail, head], 1), axis=1), axis=0)
    node = np.arange(len(p))
    loops = boundary_loops(t)
    for loop in loops:
        node[loop] = loop[0]
    length = np.linalg.norm(p[edges[:, 0]] - p[edges[:, 1]], axis=1)
    best: dict[tuple[int, int], tuple[float, tuple[int, int]]] = {}
    for (a, b), w in zip(edges.tolist(), length.tolist(), strict=True):
        i, j = sorted((int(node[a]), int(node[b])))
        if i != j and w < best.get((i, j), (np.inf, (0, 0)))[0]:
            best[i, j] = (w, (a, b))
    i, j = np.array(list(best)).T
    graph = sp.coo_matrix(([w for w, _ in best.values()], (i, j)), (len(p), len(p))).tocsr()
    graph = graph.maximum(graph.T)
    ends = [int(c) for c in cones] + [int(loop[0]) for loop in loops]
    distance, before = np.empty((len(ends), len(ends))), []
    rim = {int(loop[0]) for loop in loops}
    for row, end in enumerate(ends):
        # A path may end in a loop but not pass through one: take the other loops' outgoing arcs away.
        keep = np.ones(len(p), bool)
        keep[[r for r in rim if r != end]] = False
        far, pred = csgraph.dijkstra(sp.diags(keep.astype(float)) @ graph, True, end, return_predecessors=True)
        distance[row] = far[ends]
        before.append(pred)
    tree = csgraph.minimum_spanning_tree(np.minimum(distance, distance.T)).tocoo()
    used: set[tuple[int, int]] = set()
    for row, col in zip(tree.row, tree.col, strict=True):
        v = ends[col]
        while v != ends[row]:
            u = int(before[row][v])
            used.add(tuple(sorted(best[min(u, v), max(u, v)][1])))
            v = u
    return float(tree.data.sum()), used


@dataclass
class OpenedMesh:
    """corner: (m, 3) opened vertex of each corner.  count: opened vertices.  left, right: (c, 2) opened vertices of the
    cut edges cut (c, 2), a -> b, in the faces left and right of a -> b."""

    corner: IntArray
    count: int
    cut: IntArray
    left: IntArray
    right: IntArray


def cut_open(t: IntArray, cut_edges: IntArray) -> OpenedMesh:
    """Open the triangles along interior edges: corners stay together where they meet across an uncut edge."""
    tail, head, twin = halfedges(t)
    is_cut = _among(tail, head, cut_edges)
    glue = np.flatnonzero((twin >= 0) & ~is_cut)
    nxt = np.arange(3 * len(t)) // 3 * 3 + (np.arange(3 * len(t)) + 1) % 3
    a = np.concatenate([glue, nxt[glue]])
    b = np.concatenate([nxt[twin[glue]], twin[glue]])
    count, label = csgraph.connected_components(sp.coo_matrix((np.ones(len(a)), (a, b)), (3 * len(t),) * 2), False)
    h = np.flatnonzero(is_cut & (twin >= 0) & (tail < head))
    cut, left = np.stack([tail[h], head[h]], 1), np.stack([label[h], label[nxt[h]]], 1)
    right = np.stack([label[nxt[twin[h]]], label[twin[h]]], 1)
    return OpenedMesh(label.reshape(-1, 3), count, cut, left, right)


def _among(tail: IntArray, head: IntArray, edges: IntArray) -> NDArray[np.bool_]:
    edges = np.asarray(edges, np.int64).reshape(-1, 2)
    n = int(max(tail.max(), head.max(), edges.max(initial=0))) + 1
    key = np.minimum(tail, head) * n + np.maximum(tail, head)
    return np.isin(key, edges.min(axis=1) * n + edges.max(axis=1))


def node_of_vertex(p: FloatArray, t: IntArray) -> IntArray:
    """Each vertex, boundary vertices replaced by the first vertex of their loop."""
    node = np.arange(len(p))
    for loop in boundary_loops(t):
        node[loop] = loop[0]
    return node


def cut_rotations(p: FloatArray, t: IntArray, cut: IntArray, kappa: FloatArray) -> FloatArray:
    """Rotation r of each cut edge a -> b of a tree: the sum of kappa over all vertices on b's side, loops whole."""
    node = node_of_vertex(p, t)
    weight = np.bincount(node, kappa, len(p))
    pairs = node[np.asarray(cut, int)]
    out = np.empty(len(cut))
    for e, (_, b) in enumerate(pairs):
        rest = np.delete(pairs, e, axis=0)
        graph = sp.coo_matrix((np.ones(len(rest)), (rest[:, 0], rest[:, 1])), (len(p), len(p)))
        side = csgraph.breadth_first_order(graph.tocsr(), b, directed=False, return_predecessors=False)
        out[e] = weight[side].sum()
    return out


def full_curvature(
    p: FloatArray, t: IntArray, cones: IntArray, angles: Sequence[float], loop_scale: Sequence[float] = ()
) -> tuple[FloatArray, FloatArray]:
    """kappa at every vertex (boundary vertices get what the free boundary gives them) and the log scale y."""
    kappa = np.zeros(len(p))
    kappa[cones] = TURN - np.asarray(angles)
    y = solve_scale(p, t, kappa, loop_scale)
    return angle_defects(p, t) + cotan_laplacian(p, t) @ y, y


# --- unfolding --------------------------------------------------------------------------------------------------------


def local_frames(p: FloatArray, t: IntArray) -> ComplexArray:
    """(m, 3) complex coordinates of the corners, each triangle laid into the plane with its first edge along +x."""
    a, b = p[t[:, 1]] - p[t[:, 0]], p[t[:, 2]] - p[t[:, 0]]
    length = np.linalg.norm(a, axis=1)
    x = (a * b).sum(axis=1) / length
    return np.stack([0 * length, length, x + 1j * np.linalg.norm(np.cross(a, b), axis=1) / length], axis=1)


def complex_gradients(
    p: FloatArray, t: IntArray, opened: OpenedMesh
) -> tuple[sp.csr_matrix, sp.csr_matrix, FloatArray]:
    """Gz and Gzbar, (m, opened vertices), of piecewise linear maps, and the areas."""
    frame, area = local_frames(p, t), triangle_areas(p, t)
    edge = np.stack([frame[:, (c + 2) % 3] - frame[:, (c + 1) % 3] for c in range(3)], axis=1)
    rows = np.repeat(np.arange(len(t)), 3)
    shape = (len(t), opened.count)
    gz = sp.csr_matrix(((-1j * edge.conj() / (4 * area)[:, None]).ravel(), (rows, opened.corner.ravel())), shape)
    gzbar = sp.csr_matrix(((1j * edge / (4 * area)[:, None]).ravel(), (rows, opened.corner.ravel())), shape)
    return gz, gzbar, area


def energies(p: FloatArray, t: IntArray, opened: OpenedMesh) -> tuple[sp.csr_matrix, sp.csr_matrix]:
    """Conformal C = 4 Gzbar* A Gzbar and Dirichlet H = 2 (Gz* A Gz + Gzbar* A Gzbar) of the opened mesh."""
    gz, gzbar, area = complex_gradients(p, t, opened)
    conformal = 4 * gzbar.conj().T @ sp.diags(area) @ gzbar
    return conformal.tocsr(), (2 * gz.conj().T @ sp.diags(area) @ gz + conformal / 2).tocsr()


def transition_rows(opened: OpenedMesh, rotations: FloatArray) -> sp.csr_matrix:
    """One row a cut edge: (right copy of the edge) - e^{ir} (left copy) = 0."""
    c = len(opened.cut)
    rows = np.repeat(np.arange(c), 4)
    cols = np.concatenate([opened.right[:, ::-1], opened.left[:, ::-1]], axis=1)
    turn = np.exp(1j * rotations)
    values = np.stack([np.ones(c), -np.ones(c), -turn, turn], axis=1)
    # Both copies of an edge may share a vertex (the end of a cut): csr sums what falls on the same place.
    return sp.csr_matrix((values.ravel(), (rows, cols.ravel())), (c, opened.count))


def cone_metric_frames(p: FloatArray, t: IntArray, opened: OpenedMesh, y: FloatArray) -> tuple[ComplexArray, float]:
    """Target Jacobians e^{y_f + i phi_f} and the largest mismatch of the connection over uncut edges.

    phi runs over a spanning tree of the faces: phi_g = phi_f + theta_f - theta_g - w_ij (y_j - y_i) across i -> j.
    """
    tail, head, twin = halfedges(t)
    frame = local_frames(p, t)
    theta = np.angle(frame[:, [1, 2, 0]] - frame).ravel()
    laplacian = cotan_laplacian(p, t).tocsr()
    weight = -np.asarray(laplacian[tail, head]).ravel()
    uncut = np.flatnonzero((twin >= 0) & ~_among(tail, head, opened.cut))
    step = np.zeros(len(tail))
    other = twin[uncut]
    step[uncut] = theta[uncut] - theta[other] - np.pi - weight[uncut] * (y[head[uncut]] - y[tail[uncut]])
    f, g = uncut // 3, other // 3
    at = {}
    for h, i, j in zip(uncut.tolist(), f.tolist(), g.tolist(), strict=True):
        at[i, j] = h
    graph = sp.coo_matrix((np.ones(len(f)), (f, g)), (len(t), len(t))).tocsr()
    phi = np.zeros(len(t))
    seen = np.zeros(len(t), bool)
    for root in range(len(t)):
        if not seen[root]:
            order, before = csgraph.breadth_first_order(graph, root, directed=False)
            seen[order] = True
            for face in order[1:].tolist():
                phi[face] = phi[before[face]] + step[at[int(before[face]), face]]
    gap = phi[f] + step[uncut] - phi[g]
    closure = np.abs(np.angle(np.exp(1j * gap))).max(initial=0)
    return np.exp(y[t].mean(axis=1) + 1j * phi), float(closure)


def _kkt(matrix: sp.csr_matrix, rows: sp.csr_matrix) -> spla.SuperLU:
    c = rows.shape[0]
    return spla.splu(sp.block_array([[matrix, rows.conj().T], [rows, sp.csr_matrix((c, c))]]).tocsc())


def _pin(count: int) -> sp.csr_matrix:
    return sp.csr_matrix(([1.0], ([0], [0])), (1, count))


def poisson_unfold(
    p: FloatArray, t: IntArray, opened: OpenedMesh, rotations: FloatArray, y: FloatArray
) -> ComplexArray:
    """Minimize sum A (|f_z - T|^2 + |f_zbar|^2) under the transition rows; (m, 3) corner coordinates u + iv."""
    gz, _, area = complex_gradients(p, t, opened)
    target, _ = cone_metric_frames(p, t, opened, y)
    _, dirichlet = energies(p, t, opened)
    rows = sp.vstack([transition_rows(opened, rotations), _pin(opened.count)]).tocsr()
    right = np.concatenate([2 * gz.conj().T @ (area * target), np.zeros(rows.shape[0])])
    return _kkt(dirichlet, rows).solve(right)[: opened.count][opened.corner]


def spectral_unfold(
    p: FloatArray, t: IntArray, opened: OpenedMesh, rotations: FloatArray, tolerance: float = 1e-13
) -> tuple[ComplexArray, FloatArray]:
    """The map of least conformal energy for its Dirichlet energy, constants left out, and the smallest lambdas.

    Subspace iteration on (C + s H)^-1 H under the transition rows, with a Rayleigh-Ritz step, to a residual.
    """
    conformal, dirichlet = energies(p, t, opened)
    rows = sp.vstack([transition_rows(opened, rotations), _pin(opened.count)]).tocsr()
    solver = _kkt((conformal + 1e-10 * dirichlet).tocsr(), rows)
    rng = np.random.default_rng(7)
    block = rng.normal(size=(opened.count, 5)) + 1j * rng.normal(size=(opened.count, 5))
    values, front = np.ones(5), np.empty(0)
    for _ in range(400):
        block = solver.solve(np.concatenate([dirichlet @ block, np.zeros((rows.shape[0], 5))]))[: opened.count]
        block, _ = la.qr(block, mode="economic")  # the columns may all but coincide, on the cube for instance
        last = values
        small_c, small_h = block.conj().T @ (conformal @ block), block.conj().T @ (dirichlet @ block)
        values, mix = la.eigh((small_c + small_c.conj().T) / 2, (small_h + small_h.conj().T) / 2)
        block = block @ mix
        best = block[:, 0]
        share, front = abs(front.conj() @ (dirichlet @ best)) if len(front) else 0.0, best
        if 1 - share < tolerance and abs(values[0] - last[0]) <= tolerance:
            break
    return block[:, 0][opened.corner], values


def spectral_unfold_dense(
    p: FloatArray, t: IntArray, opened: OpenedMesh, rotations: FloatArray
) -> tuple[ComplexArray, FloatArray]:
    """The same from a dense eigenproblem on an orthonormal basis of all maps with these transitions."""
    conformal, dirichlet = (m.toarray() for m in energies(p, t, opened))
    rows = np.concatenate([transition_rows(opened, rotations).toarray(), _pin(opened.count).toarray()])
    basis = la.null_space(rows)
    c, h = basis.conj().T @ conformal @ basis, basis.conj().T @ dirichlet @ basis
    values, vectors = la.eigh((c + c.conj().T) / 2, (h + h.conj().T) / 2)
    return (basis @ vectors[:, 0])[opened.corner], values


def lscm_unfold(
    p: FloatArray, t: IntArray, opened: OpenedMesh, pins: Sequence[int], places: Sequence[complex]
) -> ComplexArray:
    """Least-squares conformal map of the opened mesh without transitions, two opened vertices pinned."""
    conformal, _ = energies(p, t, opened)
    free = np.setdiff1d(np.arange(opened.count), pins)
    z = np.zeros(opened.count, complex)
    z[list(pins)] = places
    z[free] = spla.splu(conformal[free][:, free].tocsc()).solve(-(conformal[free][:, list(pins)] @ z[list(pins)]))
    return z[opened.corner]


# --- angles a triangulation can carry ---------------------------------------------------------------------------------


def angle_room(t: IntArray, wanted: FloatArray) -> float:
    """The largest value that the smallest corner can have where triangles sum to pi and vertices to `wanted`.

    wanted: radians at every vertex, NaN where any sum will do.  Negative where no triangles have these angles, and
    -inf where not even negative corners would help.
    """
    m, corners = len(t), np.arange(3 * len(t))
    bound = np.flatnonzero(~np.isnan(wanted) & (np.bincount(t.ravel(), minlength=len(wanted)) > 0))
    row_of_vertex = np.full(len(wanted), -1)
    row_of_vertex[bound] = m + np.arange(len(bound))
    row = row_of_vertex[t.ravel()]
    rows, cols = np.concatenate([corners // 3, row[row >= 0]]), np.concatenate([corners, corners[row >= 0]])
    sums = sp.csr_matrix((np.ones(len(rows)), (rows, cols)), (m + len(bound), 3 * m))
    # Every corner is the smallest one and what it has more; the unknowns are these and, last, the smallest one.
    sums = sp.hstack([sums, sp.csr_matrix(sums.sum(axis=1))]).tocsr()
    found = opt.linprog(
        -np.eye(3 * m + 1)[-1],
        A_eq=sums,
        b_eq=np.concatenate([np.full(m, np.pi), wanted[bound]]),
        bounds=[(0, None)] * (3 * m) + [(None, None)],
        method="highs",
    )
    return -float(found.fun) if found.success else -np.inf


# --- low stretch ------------------------------------------------------------------------------------------------------


def rest_scales(t: IntArray, log_scale: FloatArray, stretch: float) -> FloatArray:
    """(m,) lengths of the rest shapes relative to the surface's: its own at stretch 1, the prescribed metric's at 0."""
    return np.exp((1 - stretch) * log_scale[t].mean(axis=1))


def symmetric_dirichlet(
    p: FloatArray, t: IntArray, corner_uv: FloatArray, scale: FloatArray | float = 1.0, weight: FloatArray | None = None
) -> float:
    """Mean symmetric Dirichlet energy of a map against triangles scaled by `scale`, at the best size of the layout.

    1 is isometric; weight: (m,), areas by default.
    """
    sigma = stretches(p, t, corner_uv) / np.reshape(scale, (-1, 1))
    weight = triangle_areas(p, t) if weight is None else weight
    grown, shrunk = (weight @ (sigma**power).sum(axis=1) / (2 * weight.sum()) for power in (2.0, -2.0))
    return float(np.sqrt(grown * shrunk))


def least_symmetric_dirichlet(
    p: FloatArray,
    t: IntArray,
    opened: OpenedMesh,
    rows: sp.csr_matrix,
    corner_uv: FloatArray,
    scale: FloatArray | float = 1.0,
    weight: FloatArray | None = None,
    steps: int = 300,
) -> FloatArray:
    """The map of least energy that `rows` @ displacement = 0 lets a map without flips become; (m, 3, 2).

    Quasi-Newton steps on a dense null space, in coordinates in which the Dirichlet form is the identity, until the
    energy cannot fall any more.
    """
    gz, gzbar, area = complex_gradients(p, t, opened)
    weight = area if weight is None else weight
    unscale = sp.diags(np.broadcast_to(1 / np.asarray(scale, float), len(t)))
    gz, gzbar = unscale @ gz, unscale @ gzbar
    start = np.empty(opened.count, complex)
    start[opened.corner.ravel()] = as_complex(corner_uv).ravel()
    basis = la.null_space(rows.toarray(), rcond=1e-9)
    dirichlet = (gz.conj().T @ sp.diags(weight) @ gz + gzbar.conj().T @ sp.diags(weight) @ gzbar) @ basis
    factor = la.cholesky(basis.conj().T @ dirichlet)
    basis = la.solve_triangular(factor, basis.T, trans="T").T  # columns orthonormal in the Dirichlet form

    def energy(x: FloatArray) -> tuple[float, FloatArray]:
        z = start + basis @ (x[: len(x) // 2] + 1j * x[len(x) // 2 :])
        a, b = gz @ z, gzbar @ z
        upright, mirrored = np.abs(a) ** 2, np.abs(b) ** 2
        total, det = upright + mirrored, upright - mirrored
        if det.min() <= 0:
            return np.inf, x
        slope = 1 + det**-2.0
        along_a = weight * (slope - 2 * total * det**-3.0) * a
        along_b = weight * (slope + 2 * total * det**-3.0) * b
        gradient = basis.conj().T @ (gz.conj().T @ along_a + gzbar.conj().T @ along_b)
        return float(weight @ (total * slope)) / 2, np.concatenate([gradient.real, gradient.imag])

    found = _descend(energy, np.zeros(2 * basis.shape[1]), steps)
    half = len(found) // 2
    return as_uv((start + basis @ (found[:half] + 1j * found[half:]))[opened.corner])


def _descend(energy: Callable[[FloatArray], tuple[float, FloatArray]], x: FloatArray, steps: int) -> FloatArray:
    """L-BFGS with steps halved until the energy, infinite outside its domain, falls; (value, gradient) at x."""
    value, gradient = energy(x)
    pairs: list[tuple[FloatArray, FloatArray]] = []
    for _ in range(steps):
        direction, shares = -gradient, []
        for moved, bent in reversed(pairs):
            shares.append(moved @ direction / (moved @ bent))
            direction = direction - shares[-1] * bent
        if pairs:
            moved, bent = pairs[-1]
            direction = direction * (moved @ bent) / (bent @ bent)
        for (moved, bent), share in zip(pairs, reversed(shares), strict=True):
            direction = direction + (share - bent @ direction / (moved @ bent)) * moved
        step, slope = 1.0, gradient @ direction
        if -slope <= 1e-14 * value:
            return x
        while (there := energy(x + step * direction))[0] > value + 1e-4 * step * slope:
            step /= 2
            if step < 1e-12:
                return x
        moved, bent = step * direction, there[1] - gradient
        x, (value, gradient) = x + moved, there
        if moved @ bent > 0:
            pairs = [*pairs[-29:], (moved, bent)]
    return x


# --- measures of a map, from corner coordinates alone -----------------------------------------------------------------


def as_complex(corner_uv: FloatArray) -> ComplexArray:
    return corner_uv[..., 0] + 1j * corner_uv[..., 1]


def as_uv(corner_z: ComplexArray) -> FloatArray:
    return np.stack([corner_z.real, corner_z.imag], axis=-1)


def signed_areas(corner_uv: FloatArray) -> FloatArray:
    a, b = corner_uv[:, 1] - corner_uv[:, 0], corner_uv[:, 2] - corner_uv[:, 0]
    return (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]) / 2


def stretches(p: FloatArray, t: IntArray, corner_uv: FloatArray) -> FloatArray:
    """(m, 2) singular values, the larger first, of the Jacobians from triangles in space to the plane."""
    frame = local_frames(p, t)
    source = np.stack([as_uv(frame[:, 1] - frame[:, 0]), as_uv(frame[:, 2] - frame[:, 0])], axis=2)
    image = np.stack([corner_uv[:, 1] - corner_uv[:, 0], corner_uv[:, 2] - corner_uv[:, 0]], axis=2)
    return np.linalg.svd(image @ np.linalg.inv(source), compute_uv=False)


def distortion(p: FloatArray, t: IntArray, corner_uv: FloatArray) -> dict[str, float]:
    """The paper's 7.1; triangles in space and in the plane each as shares of their own total area."""
    sigma, area = stretches(p, t, corner_uv), triangle_areas(p, t)
    share, uv_share = area / area.sum(), sigma.prod(axis=1) * area / (sigma.prod(axis=1) @ area)
    conformality, ratio = sigma[:, 0] / sigma[:, 1], share / uv_share
    l2 = np.sqrt(share @ ((sigma**-2.0).sum(axis=1) / 2) * (share @ sigma.prod(axis=1)))
    return {
        "quasi_conformal": float(conformality.mean()),
        "quasi_conformal_area_weighted": float(share @ conformality),
        "area": float(ratio.mean()),
        "area_p10": float(np.percentile(ratio, 10)),
        "area_p90": float(np.percentile(ratio, 90)),
        "l2_stretch": float(l2),
    }


def uv_angle_sums(t: IntArray, corner_uv: FloatArray, count: int) -> FloatArray:
    """Sum of the map's triangle angles around each original vertex; a flipped triangle's count negative."""
    flat = corner_uv.reshape(-1, 2)
    angles = corner_angles(flat, np.arange(len(flat)).reshape(-1, 3)) * np.sign(signed_areas(corner_uv))[:, None]
    return np.bincount(t.ravel(), angles.ravel(), count)


def open_edges(t: IntArray, corner_uv: FloatArray, tolerance: float = 0.0) -> set[tuple[int, int]]:
    """Interior edges whose two sides do not have the same coordinates."""
    tail, head, twin = halfedges(t)
    z = as_complex(corner_uv).ravel()
    nxt = np.arange(len(z)) // 3 * 3 + (np.arange(len(z)) + 1) % 3
    h = np.flatnonzero((twin >= 0) & (tail < head))
    apart = np.maximum(np.abs(z[h] - z[nxt[twin[h]]]), np.abs(z[nxt[h]] - z[twin[h]])) > tolerance
    return set(zip(tail[h[apart]].tolist(), head[h[apart]].tolist(), strict=True))


@dataclass
class Seams:
    """Per cut edge: ratio >= 1 of the sides' lengths, turn e^{ir} from the left to the right side.

    translation_residual: how far the images of left vertices are from the right ones along any one path between
    nodes, relative to the layout's size."""

    cut: IntArray
    ratio: FloatArray
    turn: ComplexArray
    translation_residual: float


def seam_quality(
    t: IntArray, corner_uv: FloatArray, cut_edges: IntArray, nodes: IntArray, rotations: FloatArray | None = None
) -> Seams:
    """Sister sides of the cut edges of a map.

    nodes: vertices where paths end besides the branchings and ends of the cut (cones, boundary).  The translation of a
    path is read with `rotations` (in the order of the answer's cut) if given, else with the path's own mean rotation.
    """
    opened = cut_open(t, cut_edges)
    z = np.empty(opened.count, complex)
    z[opened.corner.ravel()] = as_complex(corner_uv).ravel()
    left, right = z[opened.left], z[opened.right]
    quotient = (right[:, 1] - right[:, 0]) / (left[:, 1] - left[:, 0])
    ratio = np.maximum(np.abs(quotient), 1 / np.abs(quotient))
    turn = quotient / np.abs(quotient)
    size = np.linalg.norm(np.ptp(corner_uv.reshape(-1, 2), axis=0))
    worst = 0.0
    for path, forward in cut_paths(opened.cut, nodes):
        rho = np.exp(1j * rotations[path]) if rotations is not None else turn[path]
        rho = np.where(forward, rho, rho.conj())
        mean = rho.sum() / abs(rho.sum())
        a = np.where(forward[:, None], left[path], right[path])
        b = np.where(forward[:, None], right[path], left[path])
        shift = (b - mean * a).ravel()
        worst = max(worst, float(np.abs(shift - shift.mean()).max()) / size)
    return Seams(opened.cut, ratio, turn, worst)


def cut_paths(cut: IntArray, nodes: IntArray) -> list[tuple[IntArray, NDArray[np.bool_]]]:
    """Chains of cut edges between nodes: indices into cut, and whether each edge is walked from its first vertex."""
    around: dict[int, list[int]] = {}
    for e, (a, b) in enumerate(cut.tolist()):
        around.setdefault(a, []).append(e)
        around.setdefault(b, []).append(e)
    ends = {v for v, at in around.items() if len(at) != 2} | {int(v) for v in nodes if int(v) in around}
    walked, paths = set(), []
    for start in sorted(ends):
        for first in around[start]:
            if first in walked:
                continue
            path, forward, v, e = [], [], start, first
            while True:
                walked.add(e)
                path.append(e)
                forward.append(cut[e, 0] == v)
                v = int(cut[e, 1] if forward[-1] else cut[e, 0])
                if v in ends:
                    break
                e = next(other for other in around[v] if other != e)
            paths.append((np.array(path), np.array(forward)))
    return paths


def similarity_gap(corner_a: FloatArray, corner_b: FloatArray) -> float:
    """Largest distance between two layouts after the best similarity of b onto a, relative to a's extent."""
    a, b = as_complex(corner_a).ravel(), as_complex(corner_b).ravel()
    a, b = a - a.mean(), b - b.mean()
    factor = (b.conj() @ a) / (b.conj() @ b)
    return float(np.abs(a - factor * b).max() / np.abs(a).max())


def metric_gap(corner_a: FloatArray, corner_b: FloatArray) -> float:
    """Largest relative difference of triangle edge lengths between two maps, each scaled to unit area.

    Layouts of different cuts are no similar figures, but the maps are the same if all triangles are.
    """
    lengths = []
    for uv in (corner_a, corner_b):
        edges = np.linalg.norm(uv - uv[:, [1, 2, 0]], axis=2)
        lengths.append(edges / np.sqrt(np.abs(signed_areas(uv)).sum()))
    return float(np.abs(lengths[0] / lengths[1] - 1).max())


# --- the whole thing --------------------------------------------------------------------------------------------------


@dataclass
class Map:
    corner_uv: FloatArray
    opened: OpenedMesh
    rotations: FloatArray
    log_scale: FloatArray
    closure: float
    lambdas: FloatArray | None = None


def unfold(
    p: FloatArray,
    t: IntArray,
    cones: IntArray,
    angles: Sequence[float],
    cut_edges: IntArray,
    method: str = "poisson",
    loop_scale: Sequence[float] = (),
) -> Map:
    """The map with these cone angles on this cut of one component of genus 0, by "poisson", "spectral" or "dense"."""
    kappa, y = full_curvature(p, t, cones, angles, loop_scale)
    opened = cut_open(t, cut_edges)
    rotations = cut_rotations(p, t, opened.cut, kappa)
    _, closure = cone_metric_frames(p, t, opened, y)
    if method == "poisson":
        return Map(as_uv(poisson_unfold(p, t, opened, rotations, y)), opened, rotations, y, closure)
    solve = spectral_unfold if method == "spectral" else spectral_unfold_dense
    z, lambdas = solve(p, t, opened, rotations)
    return Map(as_uv(z), opened, rotations, y, closure, lambdas)


def steiner_cost(n: int, edges: IntArray, costs: FloatArray, terminals: IntArray) -> float:
    """Cost of the cheapest tree over the terminals (Dreyfus and Wagner 1971): exponential in their number."""
    graph = sp.coo_matrix((costs, np.asarray(edges).T), (n, n)).tocsr()
    distance = csgraph.dijkstra(graph, directed=False)
    *others, last = (int(t) for t in terminals)
    full = (1 << len(others)) - 1
    best = np.empty((full + 1, n))  # of trees over a set of terminals and one more vertex
    for i, terminal in enumerate(others):
        best[1 << i] = distance[terminal]
    for chosen in range(1, full + 1):
        if chosen & (chosen - 1) == 0:
            continue
        joined = np.full(n, np.inf)
        part = (chosen - 1) & chosen
        while part:
            joined = np.minimum(joined, best[part] + best[chosen ^ part])
            part = (part - 1) & chosen
        best[chosen] = (joined[:, None] + distance).min(axis=0)
    return float(best[full, last])
