# SPDX-License-Identifier: GPL-3.0-or-later
"""The input of a step of a kind and seed on the current mesh: seams, cones, angles, pins, importance, coordinates."""

from __future__ import annotations

from typing import Any

import lsgp
import numpy as np
from meshes import edges_of
from numpy.typing import NDArray

TURN = 2 * np.pi


def seams_of_kind(kind: str, seed: int, count: int, triangles: NDArray[np.int32], total: int) -> NDArray[np.int32]:
    """(s, 2).  total: vertices of the surface."""
    rng, edges = np.random.default_rng(seed), edges_of(triangles)
    if kind == "edges":
        return edges[rng.permutation(len(edges))[: 3 * count]]
    if kind == "path":
        return _walk(rng, edges, 4 * count)
    if kind in ("loop", "around a part"):
        return _around(rng, triangles, 3 * count if kind == "loop" else max(1, len(triangles) // 2))
    if kind == "all":
        return edges
    if kind == "no edge":
        return np.array([[0, 0], [0, total - 1]], np.int32)
    if kind == "outside":
        return np.array([[0, total + count]], np.int32)
    return np.empty((0, 2), np.int32)


def _walk(rng: np.random.Generator, edges: NDArray[np.int32], length: int) -> NDArray[np.int32]:
    """A path of edges that does not turn back at once."""
    at, before, walked = int(rng.choice(edges.ravel())), -1, []
    for _ in range(length):
        beside = edges[(edges == at).any(axis=1)]
        onward = [int(b if a == at else a) for a, b in beside.tolist()]
        onward = [v for v in onward if v != before]
        if not onward:
            break
        before, at = at, int(rng.choice(onward))
        walked.append([before, at])
    return np.array(walked, np.int32).reshape(-1, 2)


def _around(rng: np.random.Generator, triangles: NDArray[np.int32], count: int) -> NDArray[np.int32]:
    """The rim of some triangles that hang together."""
    inside = np.zeros(len(triangles), bool)
    inside[rng.integers(len(triangles))] = True
    while inside.sum() < count:
        near = np.isin(triangles, triangles[inside]).sum(axis=1) >= 2
        if not (near & ~inside).any():
            break
        inside[rng.choice(np.flatnonzero(near & ~inside))] = True
    pairs = [
        np.sort(np.concatenate([triangles[k][:, [i, (i + 1) % 3]] for i in range(3)]), axis=1)
        for k in (inside, ~inside)
    ]
    shared = set(map(tuple, pairs[0].tolist())) & set(map(tuple, pairs[1].tolist()))
    return np.array(sorted(shared), np.int32).reshape(-1, 2)


def edges_of_kind(kind: str, seed: int, triangles: NDArray[np.int32], total: int) -> NDArray[np.int32] | None:
    """Edges that cuts may follow."""
    rng, edges = np.random.default_rng(seed), edges_of(triangles)
    if kind in ("most", "few"):
        return edges[rng.random(len(edges)) < (0.8 if kind == "most" else 0.3)]
    if kind == "none":
        return np.empty((0, 2), np.int32)
    return np.array([[0, 0], [0, total - 1]], np.int32) if kind == "no edge" else None


def importance_of_kind(kind: str, seed: int, total: int) -> NDArray[np.float64] | None:
    rng = np.random.default_rng(seed)
    values = {
        "ones": np.ones(total),
        "random": rng.random(total),
        "spikes": 10 ** rng.uniform(-12, 12, total),
        "enormous": np.where(rng.random(total) < 0.5, 1e300, 1.0),
        "zeros": np.zeros(total),
        "negative": rng.normal(size=total),
        "nan": np.where(rng.random(total) < 0.1, np.nan, 1.0),
    }
    return values.get(kind)


def directions_of_kind(kind: str, seed: int, total: int) -> NDArray[np.float64] | None:
    """total: triangles."""
    rng = np.random.default_rng(seed)
    noise = rng.normal(size=(total, 3))
    values = {
        "up": np.tile([0.0, 0.0, 1.0], (total, 1)),
        "one stroke": np.where(np.arange(total)[:, None] == rng.integers(max(total, 1)), noise, 0.0),
        "strokes": np.where(rng.random((total, 1)) < 0.1, noise, 0.0),
        "noise": noise,
        "enormous": 1e300 * noise,
        "zeros": np.zeros((total, 3)),
        "nan": np.where(rng.random((total, 1)) < 0.1, np.nan, noise),
    }
    return values.get(kind)


def cut_costs_of_kind(kind: str, seed: int, total: int) -> NDArray[np.float64] | None:
    """total: edges that cuts may follow."""
    rng = np.random.default_rng(seed)
    values = {
        "ones": np.ones(total),
        "random": rng.random(total),
        "spikes": 10 ** rng.uniform(-12, 6, total),
        "zeros": np.zeros(total),
        "some zeros": rng.integers(0, 3, total).astype(float),
        "negative": rng.normal(size=total),
        "nan": np.where(rng.random(total) < 0.1, np.nan, 1.0),
        "enormous": np.where(rng.random(total) < 0.5, 1e300, 1.0),
    }
    return values.get(kind)


def border_vertices(triangles: NDArray[np.int32]) -> NDArray[np.int32]:
    pairs = np.sort(np.concatenate([triangles[:, [i, (i + 1) % 3]] for i in range(3)]), axis=1)
    edges, count = np.unique(pairs, axis=0, return_counts=True)
    return np.unique(edges[count == 1])


def cones_of_kind(
    kind: str, seed: int, count: int, present: list[int], own: list[int], triangles: NDArray[np.int32], total: int
) -> list[int]:
    """present: the cones there are.  own: those that go with the mesh."""
    rng = np.random.default_rng(seed)
    used = np.unique(triangles)
    some = rng.permutation(used)[:count].tolist()
    border = rng.permutation(border_vertices(triangles))
    return {
        "own": own,
        "none": [],
        "random": some,
        "border": border[:count].tolist(),
        "add": present + [v for v in some[:1] if v not in present],
        "drop": present[:-1],
        "move": [*present[:-1], *[v for v in some if v not in present][:1]],
        "all": used.tolist(),
        "twice": [*some, *some[:1]],
        "outside": [*some, total if seed % 2 else -1],
        "isolated": np.setdiff1d(np.arange(total), used)[:count].tolist(),
    }[kind]


def angles_of_kind(kind: str, seed: int, count: int, prescribed: list[float] | None) -> list[float | None] | None:
    """prescribed: angles that there is a map with."""
    rng = np.random.default_rng(seed)
    base = prescribed if prescribed is not None and len(prescribed) == count else [1.5 * np.pi] * count
    chosen: dict[str, list[Any] | None] = {
        "automatic": None,
        "some": [angle if rng.random() < 0.5 else None for angle in base],
        "quarter turns": (rng.integers(1, 8, count) * TURN / 4).tolist(),
        "prescribed": list(base),
        "near": (np.array(base) * (1 + 1e-3 * rng.normal(size=count))).tolist(),
        "random": rng.uniform(0.1, 3 * TURN, count).tolist(),
        "wild": rng.choice([0.0, -1.0, 1e-12, 1e9, np.nan, np.inf], count).tolist(),
        "too few": list(base[:-1]),
    }
    return chosen[kind]


def pins_of_kind(kind: str, seed: int, count: int, result: lsgp.Result | None, corners: int) -> lsgp.Pins | None:
    """result: a map of this surface, if there is one.  corners: how many the surface has."""
    rng = np.random.default_rng(seed)
    numbers = {"one": 1, "two": 2, "many": 3 + count, "as mapped": 2 + count, "folded": 5, "same place": 3}
    if kind == "none" or not corners:
        return None
    picked = rng.permutation(corners)[: numbers.get(kind, 2)]
    uv = rng.random((len(picked), 2))
    if kind == "as mapped" and result is not None and result.corner_uv.shape[0] * 3 == corners:
        uv = result.corner_uv.reshape(-1, 2)[picked]
        picked, uv = picked[~np.isnan(uv).any(axis=1)], uv[~np.isnan(uv).any(axis=1)]
    elif kind == "folded":
        uv[:, 0] *= -1e3
    elif kind == "same place":
        uv[:] = 0.5
    elif kind == "twice":
        picked[1:] = picked[0]
    elif kind == "outside":
        picked[-1] = corners if seed % 2 else -1
    elif kind == "nan":
        uv[-1] = np.nan
    return lsgp.Pins(picked.astype(np.int32), uv)


def coordinates_of_kind(kind: str, seed: int, result: lsgp.Result | None, triangles: int) -> NDArray[np.float64]:
    """(m, 3, 2) texture coordinates to be measured."""
    rng = np.random.default_rng(seed)
    if kind == "last" and result is not None and len(result.corner_uv) == triangles:
        return result.corner_uv
    if kind == "flat":
        return np.zeros((triangles, 3, 2))
    uv = rng.random((triangles, 3, 2))
    if kind == "holes":
        uv[rng.random(triangles) < 0.4] = np.nan
    if kind == "infinite":
        uv[rng.integers(triangles)] = rng.choice([np.inf, 1e300, 1e-300])
    return uv


def turning_of_kind(kind: str, seed: int, triangles: NDArray[np.int32], total: int) -> dict[int, float]:
    """Total turning of a border by one of its vertices."""
    rng, border = np.random.default_rng(seed), border_vertices(triangles)
    if kind == "elsewhere":
        return {int(rng.integers(total)): 1.0}
    if kind == "none" or not len(border):
        return {}
    return {int(rng.choice(border)): TURN if kind == "flat" else float(rng.uniform(-TURN, 2 * TURN))}
