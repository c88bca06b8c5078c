# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether a result keeps what it promises, judged from its coordinates alone, on any surface however messy.

`map_checks` states what a map of a clean surface has to be; this module asks less and of more: whatever is wrong with
a map must be said by a warning that names the elements.  Nothing here is shared with the library or the oracle.
"""

from __future__ import annotations

from dataclasses import dataclass

import lsgp
import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse import csgraph

TURN = 2 * np.pi
ANGLE = 1e-6  # radians
SISTER_RATIO = 1e-9
RESIDUAL = 1e-12  # relative to the layout
GAUSS_BONNET = 1e-9  # radians
DEFAULTS = lsgp.Options()


def named_by(result: lsgp.Result, code: str) -> NDArray[np.int32]:
    """The elements of all warnings with this code."""
    found = [finding.elements.indices for finding in result.warnings if finding.code == code]
    return np.concatenate(found) if found else np.empty(0, np.int32)


def undeclared_faults(surface: lsgp.Surface, result: lsgp.Result, options: lsgp.Options = DEFAULTS) -> list[str]:
    """Everything that is wrong with a result and that no warning of it names; empty for an honest one.

    options: what the map was made with: seams may be open borders, and the method "lscm" knows no transitions.
    """
    faults = _wrong_figures(result)
    skipped = np.flatnonzero(~result.solved)
    if not np.array_equal(np.unique(named_by(result, "COMPONENT_SKIPPED")), skipped):
        faults.append(f"{len(skipped)} triangles without a map are not those of COMPONENT_SKIPPED")
    if not np.isnan(result.corner_uv[skipped]).all():
        faults.append("coordinates of a triangle without a map")
    bad = int((~np.isfinite(result.corner_uv[result.solved])).any(axis=(1, 2)).sum())
    if bad:
        return [*faults, f"{bad} triangles of a map have coordinates that are not finite"]

    opened = _open(surface, result, _border_seams(surface, result, options))
    z = opened.z.reshape(-1, 3)
    area = np.imag((z[:, 1] - z[:, 0]).conj() * (z[:, 2] - z[:, 0]))
    flipped = opened.triangle[~(area > 0)]
    if not np.isin(flipped, named_by(result, "FLIPPED_TRIANGLES")).all() or not np.isin(flipped, result.flipped).all():
        faults.append(f"{len(flipped)} flipped triangles {flipped[:5].tolist()}, {len(result.flipped)} listed")
    unlisted = ~np.isin(_edge_keys(*_open_edges(opened)), _edge_keys(*result.cut_edges.T))
    if unlisted.any():
        faults.append(f"{int(unlisted.sum())} sides of edges are apart that cut_edges does not list")
    if options.method == "lsgp":
        faults += _wrong_angles(result, opened, flipped) + _open_seams(result, opened)
    return faults


def _wrong_figures(result: lsgp.Result) -> list[str]:
    faults = []
    if not np.array_equal(result.solved, result.island >= 0):
        faults.append("`solved` and `island` disagree")
    for listed, code in ((result.flipped, "FLIPPED_TRIANGLES"), (result.wrong_angle_sums, "WRONG_ANGLE_SUMS")):
        if not np.array_equal(np.sort(listed), np.sort(named_by(result, code))):
            faults.append(f"{code} does not name what the result lists")
    if len(result.cones) != len(result.cone_angles) or not (result.cone_angles > 0).all():
        faults.append("a cone without an angle above 0")
    figures = {name: getattr(result.seams, name) for name in ("sister_ratio_max", "rotation_residual")}
    figures |= {"translation_residual": result.seams.translation_residual, "cone_angle_error": result.cone_angle_error}
    if not len(result.flipped):  # a flipped triangle may have no area, and then no finite distortion either
        figures |= {name: getattr(result.distortion, name) for name in result.distortion.__slots__}
    faults += [f"{name} is {value}" for name, value in figures.items() if not np.isfinite(value)]
    if not np.isfinite(result.log_scale).all():
        faults.append("log_scale is not finite")
    return faults


@dataclass
class _Opened:
    """The solved triangles, turned alike, each double only once, glued where exactly two of them meet along an edge.

    triangle: (m,) their numbers.  z: (3m) u + iv.  vertex: (3m) of the surface.  twin: (3m) opposite halfedge or -1.
    fan: (3m) corners around one vertex share a number.  closed: (fans,) whether the triangles go all the way round.
    component: (m,) joined by edges.
    """

    triangle: NDArray[np.int64]
    z: NDArray[np.complex128]
    vertex: NDArray[np.int64]
    twin: NDArray[np.int64]
    fan: NDArray[np.int64]
    closed: NDArray[np.bool_]
    component: NDArray[np.int64]


def _labels(a: NDArray[np.int64], b: NDArray[np.int64], count: int) -> NDArray[np.int64]:
    graph = sp.coo_matrix((np.ones(len(a), bool), (a, b)), (count, count))
    return csgraph.connected_components(graph, directed=False)[1]


def _next(h: NDArray[np.int64]) -> NDArray[np.int64]:
    return h // 3 * 3 + (h + 1) % 3


def _edge_keys(a: NDArray[np.integer], b: NDArray[np.integer]) -> NDArray[np.int64]:
    return (np.minimum(a, b).astype(np.int64) << 32) + np.maximum(a, b)


def _border_seams(surface: lsgp.Surface, result: lsgp.Result, options: lsgp.Options) -> NDArray[np.int64]:
    """The keys of the seams that are open borders and not cuts."""
    keys = _edge_keys(*surface.seams.T)
    if options.seams == "boundary":
        return keys
    opened = surface.triangles[named_by(result, "SEAMS_OPENED")]
    return np.intersect1d(keys, _edge_keys(opened.ravel(), opened[:, [1, 2, 0]].ravel()))


def _open(surface: lsgp.Surface, result: lsgp.Result, borders: NDArray[np.int64]) -> _Opened:
    single = np.ones(len(surface.triangles), bool)
    single[named_by(result, "DUPLICATE_FACE")] = False
    kept = result.solved & single
    turned = np.zeros(len(kept), bool)
    turned[named_by(result, "REORIENTED")] = True
    order = np.where(turned[:, None], [2, 1, 0], [0, 1, 2])[kept]
    triangle = np.flatnonzero(kept)
    vertex = np.take_along_axis(surface.triangles[kept].astype(np.int64), order, axis=1).ravel()
    uv = np.take_along_axis(result.corner_uv[kept], order[:, :, None], axis=1)

    h = np.arange(len(vertex))
    tail, head = vertex, vertex[_next(h)]
    key = _edge_keys(tail, head)
    # Triangles without a map count: with them more than two may meet, and then the edge is open.
    everyone = surface.triangles[single]
    keys, meeting = np.unique(_edge_keys(everyone.ravel(), everyone[:, [1, 2, 0]].ravel()), return_counts=True)
    borders = np.union1d(borders, keys[meeting > 2])
    by_edge = np.argsort(key, kind="stable")
    first, count = np.unique(key[by_edge], return_index=True, return_counts=True)[1:]
    one, other = by_edge[first[count == 2]], by_edge[first[count == 2] + 1]
    glued = (tail[one] == head[other]) & ~np.isin(key[one], borders)
    one, other = one[glued], other[glued]
    twin = np.full(len(h), -1)
    twin[one], twin[other] = other, one
    fan = _labels(np.concatenate([one, _next(one)]), np.concatenate([_next(other), other]), len(h))
    closed = np.ones(int(fan.max()) + 1, bool)
    rim = twin < 0
    closed[fan[rim]] = closed[fan[_next(h)[rim]]] = False
    component = _labels(one // 3, other // 3, len(triangle))
    return _Opened(triangle, (uv[..., 0] + 1j * uv[..., 1]).ravel(), vertex, twin, fan, closed, component)


def _open_edges(opened: _Opened) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Both vertices of all halfedges at which the two sides have different coordinates."""
    h = np.flatnonzero(opened.twin >= 0)
    other = opened.twin[h]
    apart = (opened.z[h] != opened.z[_next(other)]) | (opened.z[_next(h)] != opened.z[other])
    return opened.vertex[h[apart]], opened.vertex[_next(h[apart])]


def _wrong_angles(result: lsgp.Result, opened: _Opened, flipped: NDArray[np.int64]) -> list[str]:
    faults = []
    z, fan_count = opened.z.reshape(-1, 3), len(opened.closed)
    here = np.angle((z[:, [2, 0, 1]] - z) * (z[:, [1, 2, 0]] - z).conj())
    sums = np.bincount(opened.fan, here.ravel(), fan_count)
    vertex = np.zeros(fan_count, np.int64)
    vertex[opened.fan] = opened.vertex
    wanted = np.full(int(opened.vertex.max()) + 1, TURN)
    on_surface = result.cones < len(wanted)
    wanted[result.cones[on_surface]] = result.cone_angles[on_surface]
    # A vertex at which several sheets meet has one entry in the result and an angle on each sheet.
    fans_of_vertex = np.bincount(vertex, minlength=len(wanted))
    # Borders are free but at cones.
    judged = (opened.closed | np.isin(vertex, result.cones)) & (fans_of_vertex[vertex] == 1)
    beside_flips = opened.vertex.reshape(-1, 3)[np.isin(opened.triangle, flipped)].ravel()
    excused = np.concatenate([result.wrong_angle_sums, named_by(result, "INEXACT_ANGLES"), beside_flips])
    off = np.abs(sums - wanted[vertex])
    wrong = judged & ~(off <= ANGLE) & ~np.isin(vertex, excused)
    if wrong.any():
        faults.append(f"angles at {vertex[wrong][:5].tolist()} off by {off[wrong].max():.1e} rad")

    # Gauss-Bonnet of what was imposed, on every closed component.
    part_of_fan = np.zeros(fan_count, np.int64)
    part_of_fan[opened.fan] = np.repeat(opened.component, 3)
    parts = int(opened.component.max()) + 1
    is_closed = np.bincount(part_of_fan, ~opened.closed, parts) == 0
    edges = np.bincount(opened.component[np.flatnonzero(opened.twin >= 0) // 3], minlength=parts) / 2
    euler = np.bincount(part_of_fan, minlength=parts) - edges + np.bincount(opened.component, minlength=parts)
    total = np.bincount(part_of_fan, TURN - wanted[vertex], parts)
    single = np.bincount(part_of_fan, fans_of_vertex[vertex] > 1, parts) == 0
    gap = np.abs(total - TURN * euler)[is_closed & single]
    if gap.max(initial=0) > GAUSS_BONNET:
        faults.append(f"the imposed angles miss Gauss-Bonnet by {gap.max():.1e} rad")
    return faults


def _open_seams(result: lsgp.Result, opened: _Opened) -> list[str]:
    """Each path of the cut between nodes (cones, branchings, the border) is one rotation and one translation."""
    z, twin = opened.z, opened.twin
    h = np.flatnonzero(twin >= 0)
    left = np.stack([z[h], z[_next(h)]], axis=1)
    right = np.stack([z[_next(twin[h])], z[twin[h]]], axis=1)
    cut = (left != right).any(axis=1)
    h, left, right = h[cut], left[cut], right[cut]
    if not len(h):
        return []
    faults = []
    lengths = np.abs(left[:, 1] - left[:, 0]), np.abs(right[:, 1] - right[:, 0])
    named = named_by(result, "INEXACT_SEAMS").reshape(-1, 2)
    excused = np.isin(_edge_keys(opened.vertex[h], opened.vertex[_next(h)]), _edge_keys(*named.T))
    ratio = np.divide(*lengths, where=lengths[1] > 0, out=np.ones(len(h)))[~excused].max(initial=1)
    if ratio - 1 > SISTER_RATIO:
        faults.append(f"sister edges differ in length by {ratio - 1:.1e}")

    # Halfedges follow each other where a path passes straight through a vertex.
    leaving = np.bincount(opened.fan[h], minlength=len(opened.closed))
    passes = opened.closed & (leaving == 2)
    passes[opened.fan[np.isin(opened.vertex, result.cones)]] = False
    out = h[passes[opened.fan[h]]]
    out = out[np.argsort(opened.fan[out], kind="stable")].reshape(-1, 2)
    place = np.full(len(z), -1)
    place[h] = np.arange(len(h))
    before = place[np.concatenate([twin[out[:, 1]], twin[out[:, 0]]])]
    after = place[np.concatenate([out[:, 0], out[:, 1]])]
    path = _labels(before, after, len(h))

    def mean(values: NDArray[np.complex128], weights: NDArray[np.float64] | None = None) -> NDArray[np.complex128]:
        total = np.bincount(path, values.real) + 1j * np.bincount(path, values.imag)
        return total / (np.bincount(path) if weights is None else weights)

    turn = mean((left[:, 1] - left[:, 0]).conj() * (right[:, 1] - right[:, 0]), np.ones(1))
    turn = (turn / np.where(turn == 0, 1, np.abs(turn)))[path]
    shift = (right - turn[:, None] * left).mean(axis=1)
    residual = np.abs(right - turn[:, None] * left - mean(shift)[path][:, None]).max(axis=1)
    residual = residual[np.bincount(path, excused)[path] == 0].max(initial=0)
    size = max(float(np.ptp(z.real)), float(np.ptp(z.imag)))
    if not residual <= RESIDUAL * size:
        faults.append(f"seam residual {residual / size:.1e} of the layout")
    return faults
