# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces generated from formulas, and broken variants, for all tests.

Every function is deterministic.  Triangles are counter-clockwise seen from outside (from +z on open patches), and
"generic" surfaces have no two equal path lengths, so that shortest paths and spanning trees on them are unique.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
IndexArray = NDArray[np.int32]


class Mesh(NamedTuple):
    """positions: (n, 3) float64.  triangles: (m, 3) int32.  cones: (k,) int32, a natural choice of cones or none."""

    positions: FloatArray
    triangles: IndexArray
    cones: IndexArray


def make(positions: object, triangles: object, cones: object = ()) -> Mesh:
    """A mesh with the exact dtypes of the library's boundary."""
    return Mesh(
        np.ascontiguousarray(positions, np.float64).reshape(-1, 3),
        np.ascontiguousarray(triangles, np.int32).reshape(-1, 3),
        np.ascontiguousarray(cones, np.int32),
    )


def edges_of(triangles: IndexArray) -> IndexArray:
    """All edges as sorted vertex pairs, (e, 2) int32, each once."""
    pairs = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    return np.unique(np.sort(pairs, axis=1), axis=0).astype(np.int32)


def euler_characteristic(triangles: IndexArray) -> int:
    """Vertices in use - edges + triangles."""
    return len(np.unique(triangles)) - len(edges_of(triangles)) + len(triangles)


# --- closed surfaces of genus 0 -------------------------------------------------------------------------------------


def tetrahedron() -> Mesh:
    """The regular tetrahedron, edge length sqrt(8), its four corners as cones of angle pi."""
    return make(
        [[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]], [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]], range(4)
    )


def octahedron() -> Mesh:
    """The regular octahedron with its six corners as cones."""
    positions = [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]]
    triangles = [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]]
    return make(positions, triangles, range(6))


def icosahedron() -> Mesh:
    """The regular icosahedron with its twelve corners as cones."""
    g = (1 + np.sqrt(5)) / 2
    positions = [[-1, g, 0], [1, g, 0], [-1, -g, 0], [1, -g, 0], [0, -1, g], [0, 1, g], [0, -1, -g], [0, 1, -g]]
    positions += [[g, 0, -1], [g, 0, 1], [-g, 0, -1], [-g, 0, 1]]
    triangles = [[0, 11, 5], [0, 5, 1], [0, 1, 7], [0, 7, 10], [0, 10, 11], [1, 5, 9], [5, 11, 4], [11, 10, 2]]
    triangles += [[10, 7, 6], [7, 1, 8], [3, 9, 4], [3, 4, 2], [3, 2, 6], [3, 6, 8], [3, 8, 9], [4, 9, 5]]
    triangles += [[2, 4, 11], [6, 2, 10], [8, 6, 7], [9, 8, 1]]
    return make(positions, triangles, range(12))


def cube(n: int = 4, stretch: Sequence[float] = (1, 1, 1)) -> Mesh:
    """A box with n x n grid cells a face, two triangles a cell, and its eight corners as cones of angle 3/2 pi.

    stretch: side lengths.  cube(1) is the cube of twelve triangles, whose corners have three to six triangles.
    """
    ids: dict[tuple[int, int, int], int] = {}
    triangles: list[tuple[int, int, int]] = []

    def vertex(point: NDArray[np.int64]) -> int:
        return ids.setdefault(tuple(int(x) for x in point), len(ids))

    axes = np.eye(3, dtype=np.int64)
    for k in range(3):
        u, v, w = axes[(k + 1) % 3], axes[(k + 2) % 3], axes[k]
        for origin, a, b in ((0 * w, v, u), (n * w, u, v)):
            for i in range(n):
                for j in range(n):
                    p = origin + i * a + j * b
                    q = [vertex(p), vertex(p + a), vertex(p + a + b), vertex(p + b)]
                    triangles += [(q[0], q[1], q[2]), (q[0], q[2], q[3])]
    points = np.array(list(ids), np.float64)
    corners = np.flatnonzero(np.all((points == 0) | (points == n), axis=1))
    return make(points / n * np.asarray(stretch, np.float64), triangles, corners)


def icosphere(levels: int = 2) -> Mesh:
    """A unit sphere: the icosahedron subdivided, its twelve corners (vertices 0..11) as cones."""
    return _on_sphere(icosahedron(), levels)


def _on_sphere(mesh: Mesh, levels: int) -> Mesh:
    for _ in range(levels):
        mesh = subdivide(mesh)
    radius = np.linalg.norm(mesh.positions, axis=1, keepdims=True)
    return mesh._replace(positions=mesh.positions / radius)


def ellipsoid(levels: int = 2, axes: Sequence[float] = (1.0, 1.3, 0.7)) -> Mesh:
    """An icosphere with three different half axes."""
    mesh = icosphere(levels)
    return mesh._replace(positions=mesh.positions * np.asarray(axes))


def ball_of_quads(around: int = 12, rows: int = 7) -> tuple[FloatArray, IndexArray]:
    """Positions and quads (f, 4) of a sphere of rows, with `around` vertices at each pole, all in one place: the first
    and the last ones."""
    turn, height = np.meshgrid(np.arange(around) * 2 * np.pi / around, np.linspace(0, np.pi, rows + 1))
    positions = np.stack([np.sin(height) * np.cos(turn), np.sin(height) * np.sin(turn), np.cos(height)], axis=-1)
    positions[0], positions[-1] = (0, 0, 1), (0, 0, -1)
    i, j = np.arange(around), np.roll(np.arange(around), -1)
    quads = np.concatenate([np.stack([i, i + around, j + around, j], axis=1) + around * row for row in range(rows)])
    return positions.reshape(-1, 3), quads


def bumpy_sphere(levels: int = 2, height: float = 0.25) -> Mesh:
    """A sphere with smooth bumps and no symmetry: generic.  Six of the icosahedron's corners as cones."""
    mesh = icosphere(levels)
    x, y, z = mesh.positions.T
    bump = (
        np.sin(2.3 * x + 0.7) * np.cos(1.9 * y - 0.3)
        + 0.6 * np.sin(3.1 * z + 1.1 * x)
        + 0.3 * np.cos(2.7 * y + 1.7 * z)
    )
    return make(mesh.positions * (1 + height * bump)[:, None], mesh.triangles, [0, 2, 4, 7, 9, 11])


# Of the cones of with_close_cones, radians: on both sides of the short edge they have opposite curvature.
CLOSE_CONE_ANGLES = np.pi / 2 * np.array([2, 2, 2, 3, 3, 3, 5])


def with_close_cones(distance: float) -> Mesh:
    """A bumpy sphere with two cones on one edge, which is divided at this share of its length."""
    ball = bumpy_sphere()
    (first, second), added = ball.triangles[0, :2], len(ball.positions)
    position = ball.positions[first] + distance * (ball.positions[second] - ball.positions[first])
    triangles = []
    for corners in ball.triangles:
        ends = np.flatnonzero(np.isin(corners, (first, second)))
        if len(ends) < 2:
            triangles.append(corners)
            continue
        for end in ends:
            triangles.append(np.where(np.arange(3) == end, added, corners))
    cones = [*ball.cones[ball.cones != first], first, added]
    return make(np.vstack([ball.positions, position]), np.array(triangles), cones)


def forked(levels: int = 3) -> Mesh:
    """A bumpy sphere with 28 cones, generic: the shortest ways between two pairs of them merge at one junction."""
    mesh = bumpy_sphere(levels, 0.15)
    return mesh._replace(cones=np.arange(3, 642, 23, dtype=np.int32))


def flower(levels: int = 3, height: float = 0.35) -> Mesh:
    """An octahedral flower: six petals along the axes, their tips (vertices 0..5) as cones; generic in the last digits.

    The paper's Octa-flower in the small: few cones, all of positive curvature.
    """
    mesh = _on_sphere(octahedron(), levels)
    x, y, z = mesh.positions.T
    petals = (x**4 + y**4 + z**4 - 0.6) / 0.4
    tilt = 0.02 * np.sin(2 * x + 0.4) + 0.013 * np.cos(3 * y - 0.2) + 0.017 * np.sin(2.4 * z + x)
    return make(mesh.positions * (1 + height * petals + tilt)[:, None], mesh.triangles, range(6))


# --- surfaces with boundary -----------------------------------------------------------------------------------------


def two_horned(levels: int = 3, turn: float = 0.0) -> Mesh:
    """A ball with two horns and a snout, its own mirror image in x = 0 and in no other plane.

    turn: of the triangulation about an axis across that plane, which makes it another one on each side.
    """
    ball = icosphere(levels)
    p = ball.positions @ rotation([1, 2, 3], turn).T
    horn = np.exp(-6 * ((np.abs(p[:, 0]) - 0.6) ** 2 + (p[:, 1] - 0.7) ** 2 + (p[:, 2] - 0.2) ** 2))
    snout = np.exp(-5 * (p[:, 0] ** 2 + (p[:, 1] + 0.3) ** 2 + (p[:, 2] - 0.9) ** 2))
    return make(p * (1 + 0.9 * horn + 0.7 * snout)[:, None], ball.triangles)


def rotation(axis: Sequence[float], angle: float) -> FloatArray:
    """By Rodrigues' formula."""
    x, y, z = np.array(axis) / np.linalg.norm(axis)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def grid(nx: int = 6, ny: int = 5, height: Callable[[FloatArray, FloatArray], FloatArray] | None = None) -> Mesh:
    """A disk: the rectangle [0, nx] x [0, ny] in unit cells, lifted to z = height(x, y)."""
    x, y = (a.ravel().astype(np.float64) for a in np.meshgrid(np.arange(nx + 1), np.arange(ny + 1), indexing="xy"))
    z = np.zeros_like(x) if height is None else height(x, y)
    i, j = (a.ravel() for a in np.meshgrid(np.arange(nx), np.arange(ny), indexing="xy"))
    a = j * (nx + 1) + i
    b, c, d = a + 1, a + nx + 2, a + nx + 1
    return make(np.stack([x, y, z], axis=1), np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)]))


def saddle(n: int = 8, bend: float = 0.06) -> Mesh:
    """A hyperbolic patch z = bend (x^2 - y^2) about its middle, one boundary loop; generic."""
    c = n / 2
    return grid(n, n, lambda x, y: bend * ((x - c) ** 2 - (y - c) ** 2) + 0.02 * np.sin(1.3 * x + 0.4 * y))


def hill(n: int = 10, height: float = 2.5) -> Mesh:
    """A disk with one round hill, its top the only cone; generic."""
    c = n / 2

    def lift(x: FloatArray, y: FloatArray) -> FloatArray:
        return height * np.exp(-((x - c) ** 2 + (y - c) ** 2) / (0.12 * n * n)) + 0.03 * np.sin(1.1 * x + 0.7 * y)

    mesh = grid(n, n, lift)
    return mesh._replace(cones=np.array([np.argmax(mesh.positions[:, 2])], np.int32))


def disk_with_holes(n: int = 12, holes: int = 2) -> Mesh:
    """A gently curved square with `holes` square holes in a row along its diagonal, each two cells wide; generic."""
    mesh = grid(n, n, lambda x, y: 0.15 * np.sin(0.6 * x + 0.2) * np.cos(0.5 * y) + 0.01 * np.sin(2 * x + y))
    cell = np.concatenate([np.arange(n * n)] * 2)
    i, j = cell % n, cell // n
    gone = np.zeros(len(cell), bool)
    for h in range(holes):
        at = (2 * h + 1) * n // (2 * holes) - 1
        gone |= (i >= at) & (i < at + 2) & (j >= at) & (j < at + 2)
    return compact(make(mesh.positions, mesh.triangles[~gone]))


def plate(holes: int) -> Mesh:
    """A gently curved square with `holes` by `holes` square holes, each one cell wide and three apart; generic."""
    n = 4 * holes
    mesh = grid(n, n, lambda x, y: 0.3 * np.sin(0.4 * x + 0.2) * np.cos(0.3 * y) + 0.01 * np.sin(2 * x + y))
    cell = np.concatenate([np.arange(n * n)] * 2)
    gone = (cell // n % 4 == 1) & (cell % n % 4 == 1)
    return compact(make(mesh.positions, mesh.triangles[~gone]))


def cylinder(around: int = 16, along: int = 6, taper: float = 0.3) -> Mesh:
    """A tapering tube about z with two boundary loops; no cones needed."""
    mesh = _quilt(around, along, wrap_u=True, wrap_v=False)
    angle, t = 2 * np.pi * mesh.positions[:, 0] / around, mesh.positions[:, 1] / along
    radius = 1 - taper * t + 0.02 * np.sin(3 * angle + 0.5) * np.cos(2 * t)
    return mesh._replace(positions=np.stack([radius * np.cos(angle), radius * np.sin(angle), 2.2 * t], axis=1))


# --- surfaces with handles ------------------------------------------------------------------------------------------


def torus(around: int = 18, along: int = 10, major: float = 2.0, minor: float = 0.7) -> Mesh:
    """A torus about z."""
    mesh = _quilt(around, along, wrap_u=True, wrap_v=True)
    a, b = 2 * np.pi * mesh.positions[:, 0] / around, 2 * np.pi * mesh.positions[:, 1] / along
    ring = major + minor * np.cos(b)
    return mesh._replace(positions=np.stack([ring * np.cos(a), ring * np.sin(a), minor * np.sin(b)], axis=1))


def voxels(filled: NDArray[np.bool_]) -> Mesh:
    """The boundary of a set of unit cells, two triangles a square; cells must not meet in an edge or a corner only."""
    solid = np.pad(np.asarray(filled, bool), 1)
    ids: dict[tuple[int, ...], int] = {}
    triangles: list[list[int]] = []
    axes = np.eye(3, dtype=np.int64)
    for cell in np.argwhere(solid):
        for k in range(3):
            u, v, w = axes[(k + 1) % 3], axes[(k + 2) % 3], axes[k]
            for sign, a, b in ((-1, v, u), (1, u, v)):
                if not solid[tuple(cell + sign * w)]:
                    p = cell + (w if sign > 0 else 0)
                    q = [ids.setdefault(tuple(int(x) for x in s), len(ids)) for s in (p, p + a, p + a + b, p + b)]
                    triangles += [[q[0], q[1], q[2]], [q[0], q[2], q[3]]]
    return make(np.array(list(ids), np.float64), triangles)


def perforated_slab(k: int) -> Mesh:
    """Genus k * k: a square slab of cells with k * k holes through it."""
    filled = np.ones((2 * k + 1, 2 * k + 1, 1), bool)
    filled[1::2, 1::2] = False
    return voxels(filled)


def double_torus() -> Mesh:
    """Genus 2: a slab of cells with two holes through it."""
    filled = np.ones((5, 3, 1), bool)
    filled[1, 1] = filled[3, 1] = False
    return voxels(filled)


def _quilt(nu: int, nv: int, wrap_u: bool, wrap_v: bool) -> Mesh:
    """nu x nv cells whose opposite sides may be joined; positions hold (i, j, 0)."""
    cols, rows = nu + (not wrap_u), nv + (not wrap_v)
    i, j = (a.ravel() for a in np.meshgrid(np.arange(nu), np.arange(nv), indexing="xy"))
    i1, j1 = (i + 1) % cols, (j + 1) % rows
    a, b, c, d = j * cols + i, j * cols + i1, j1 * cols + i1, j1 * cols + i
    x, y = (g.ravel() for g in np.meshgrid(np.arange(cols), np.arange(rows), indexing="xy"))
    return make(np.stack([x, y, 0 * x], 1), np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)]))


# --- one mesh from others -------------------------------------------------------------------------------------------


def subdivide(mesh: Mesh) -> Mesh:
    """Each triangle into four at the middles of its edges; old vertices keep their numbers, so do cones."""
    pairs = np.concatenate([mesh.triangles[:, [0, 1]], mesh.triangles[:, [1, 2]], mesh.triangles[:, [2, 0]]])
    edges, back = np.unique(np.sort(pairs, axis=1), axis=0, return_inverse=True)
    m01, m12, m20 = (back.reshape(3, -1) + len(mesh.positions)).astype(np.int32)
    v0, v1, v2 = mesh.triangles.T
    children = [(v0, m01, m20), (v1, m12, m01), (v2, m20, m12), (m01, m12, m20)]
    triangles = np.stack([np.stack(child, axis=1) for child in children], axis=1).reshape(-1, 3)
    return make(np.concatenate([mesh.positions, mesh.positions[edges].mean(axis=1)]), triangles, mesh.cones)


def merge(meshes: Sequence[Mesh], gap: float = 0.5) -> Mesh:
    """Several meshes side by side along x as components of one."""
    positions, triangles, cones, count, right = [], [], [], 0, 0.0
    for mesh in meshes:
        low, high = mesh.positions[:, 0].min(), mesh.positions[:, 0].max()
        positions.append(mesh.positions + np.array([right - low, 0, 0]))
        triangles.append(mesh.triangles + count)
        cones.append(mesh.cones + count)
        count, right = count + len(mesh.positions), right + high - low + gap
    return make(np.concatenate(positions), np.concatenate(triangles), np.concatenate(cones))


def compact(mesh: Mesh) -> Mesh:
    """Without the vertices that no triangle uses."""
    used = np.unique(mesh.triangles)
    return make(mesh.positions[used], np.searchsorted(used, mesh.triangles), np.searchsorted(used, mesh.cones))


def renumber(mesh: Mesh, seed: int) -> tuple[Mesh, NDArray[np.int64], NDArray[np.int64]]:
    """The same surface with vertices, triangles and each triangle's first corner shuffled.

    Returns the mesh and what moves old per-element values over: new_vertex_of_old (n,), and old_corner_of_new (m*3,),
    corners counted 3 * triangle + corner.  Cones keep their order.
    """
    rng = np.random.default_rng(seed)
    new_of_old = rng.permutation(len(mesh.positions))
    order, turn = rng.permutation(len(mesh.triangles)), rng.integers(0, 3, len(mesh.triangles))
    corner = (np.arange(3)[None, :] + turn[:, None]) % 3
    old_corner = 3 * order[:, None] + corner
    positions = np.empty_like(mesh.positions)
    positions[new_of_old] = mesh.positions
    triangles = new_of_old[mesh.triangles.ravel()[old_corner]]
    return make(positions, triangles, new_of_old[mesh.cones]), new_of_old, old_corner.ravel()


def transform(mesh: Mesh, seed: int, scale: float = 1.0) -> Mesh:
    """The same surface turned and moved by a seeded rigid motion and scaled."""
    rng = np.random.default_rng(seed)
    turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    turn[:, 0] *= np.sign(np.linalg.det(turn))
    return mesh._replace(positions=np.ascontiguousarray(scale * (mesh.positions @ turn.T + rng.normal(size=3))))


# --- broken twins ---------------------------------------------------------------------------------------------------


def with_coordinate(mesh: Mesh, vertex: int, value: float) -> Mesh:
    """One coordinate replaced, by NaN or infinity for instance."""
    positions = mesh.positions.copy()
    positions[vertex, 1] = value
    return mesh._replace(positions=positions)


def with_repeated_index(mesh: Mesh, triangle: int) -> Mesh:
    """One triangle that names its first vertex twice."""
    triangles = mesh.triangles.copy()
    triangles[triangle, 1] = triangles[triangle, 0]
    return mesh._replace(triangles=triangles)


def with_zero_area(mesh: Mesh, triangle: int) -> Mesh:
    """An edge of `triangle` split by a vertex on it, on that side only: a T-junction closed by a sliver of no area."""
    a, b, c = (int(x) for x in mesh.triangles[triangle])
    m = len(mesh.positions)
    positions = np.concatenate([mesh.positions, [(mesh.positions[a] + mesh.positions[b]) / 2]])
    triangles = np.concatenate([np.delete(mesh.triangles, triangle, axis=0), [[a, m, c], [m, b, c], [a, b, m]]])
    return make(positions, triangles, mesh.cones)


def with_needles(mesh: Mesh, split: Iterable[int], height: float, count: int = 1) -> Mesh:
    """The first edges of triangles `split` by so many vertices beside them, on that side only: T-junctions closed by
    needles, of heights relative to their length."""
    positions, triangles, new = list(mesh.positions), [], len(mesh.positions)
    chosen = set(split)
    for f, (a, b, c) in enumerate(mesh.triangles.tolist()):
        if f not in chosen:
            triangles.append([a, b, c])
            continue
        along = mesh.positions[b] - mesh.positions[a]
        inward = mesh.positions[c] - mesh.positions[a]
        inward = inward - along * (along @ inward) / (along @ along)
        inward *= np.linalg.norm(along) / np.linalg.norm(inward)
        share = np.arange(1, count + 1)[:, None] / (count + 1)
        positions += list(mesh.positions[a] + share * along + 4 * height * share * (1 - share) * inward)
        chain = [a, *range(new, new + count), b]
        triangles += [[p, q, c] for p, q in pairwise(chain)]
        triangles += [[a, q, p] for p, q in pairwise(chain[1:])]
        new += count
    return make(np.array(positions), np.array(triangles, np.int32), mesh.cones)


def with_fin(mesh: Mesh) -> tuple[Mesh, tuple[int, int]]:
    """A third triangle on an edge of triangle 0; returns that edge, the non-manifold one, too."""
    a, b = (int(x) for x in mesh.triangles[0, :2])
    apex = mesh.positions[[a, b]].mean(axis=0) * 1.5 + [0.01, 0.02, 0.03]
    positions = np.concatenate([mesh.positions, [apex]])
    return make(positions, np.concatenate([mesh.triangles, [[a, b, len(mesh.positions)]]]), mesh.cones), (a, b)


def with_pocket(mesh: Mesh) -> Mesh:
    """Two more triangles back to back on an edge of triangle 0: joined along two edges, about a vertex of just two.

    What a face that was duplicated and turned leaves behind; the last two triangles.
    """
    a, b = (int(x) for x in mesh.triangles[0, :2])
    c = len(mesh.positions)
    positions = np.concatenate([mesh.positions, [mesh.positions[[a, b]].mean(axis=0) + np.array([0.1, 0.3, 0.4])]])
    return make(positions, np.concatenate([mesh.triangles, [[a, b, c], [b, a, c]]]), mesh.cones)


def bow_tie(n: int = 3) -> tuple[Mesh, int]:
    """Two grid patches that share one corner vertex; returns that vertex too."""
    first = grid(n, n)
    count, tip = len(first.positions), (n + 1) ** 2 - 1
    other = first.triangles + count
    other[other == count] = tip
    mesh = make(
        np.concatenate([first.positions, first.positions + np.array([n, n, 0])]),
        np.concatenate([first.triangles, other]),
    )
    return compact(mesh), tip


def with_flipped(mesh: Mesh, triangles: Sequence[int]) -> Mesh:
    """Some triangles turned inside out."""
    out = mesh.triangles.copy()
    out[list(triangles)] = out[list(triangles)][:, ::-1]
    return mesh._replace(triangles=out)


def with_isolated_vertices(mesh: Mesh, count: int) -> Mesh:
    """`count` vertices in front of all others that no triangle uses."""
    extra = np.arange(3 * count, dtype=np.float64).reshape(-1, 3) + 10
    return make(np.concatenate([extra, mesh.positions]), mesh.triangles + count, mesh.cones + count)


def triangle_soup(mesh: Mesh) -> Mesh:
    """Each triangle with three vertices of its own."""
    return make(mesh.positions[mesh.triangles].reshape(-1, 3), np.arange(3 * len(mesh.triangles)))


def moebius_strip(around: int = 16, across: int = 3) -> Mesh:
    """A band with one half twist: not orientable, one boundary loop."""
    i, j = (a.ravel() for a in np.meshgrid(np.arange(around), np.arange(across), indexing="xy"))
    rows = across + 1
    last = i + 1 == around
    right, low, high = np.where(last, 0, i + 1), np.where(last, across - j, j), np.where(last, across - j - 1, j + 1)
    a, b, c, d = i * rows + j, right * rows + low, right * rows + high, i * rows + j + 1
    k, s = (g.ravel() for g in np.meshgrid(np.arange(around), np.arange(rows), indexing="ij"))
    angle, t = 2 * np.pi * k / around, 0.4 * (2 * s / across - 1)
    ring = 1 + t * np.cos(angle / 2)
    positions = np.stack([ring * np.cos(angle), ring * np.sin(angle), t * np.sin(angle / 2)], 1)
    return make(positions, np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)]))


def klein_bottle(around: int = 16, along: int = 12) -> Mesh:
    """Closed and not orientable: a figure eight turned by half a turn on its way round (it crosses itself in space)."""
    i, j = (a.ravel() for a in np.meshgrid(np.arange(around), np.arange(along), indexing="xy"))
    last = i + 1 == around
    j1 = (j + 1) % along
    right, low, high = np.where(last, 0, i + 1), np.where(last, (-j) % along, j), np.where(last, (-j1) % along, j1)
    a, b, c, d = i * along + j, right * along + low, right * along + high, i * along + j1
    k, s = (g.ravel() for g in np.meshgrid(np.arange(around), np.arange(along), indexing="ij"))
    u, v = 2 * np.pi * k / around, 2 * np.pi * s / along
    ring = 2 + np.cos(u / 2) * np.sin(v) - np.sin(u / 2) * np.sin(2 * v)
    z = np.sin(u / 2) * np.sin(v) + np.cos(u / 2) * np.sin(2 * v)
    positions = np.stack([ring * np.cos(u), ring * np.sin(u), z], 1)
    return make(positions, np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)]))
