# SPDX-License-Identifier: GPL-3.0-or-later
"""Small polygon meshes for the tests of files, polygons and the command line, and the files that hold them."""

from __future__ import annotations

import struct
from collections import Counter
from collections.abc import Sequence

import numpy as np
from lsgp.io.polygons import PolygonMesh, Triangulation

Faces = list[list[int]]

SQUARE = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]]
SQUARE_OBJ = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
PLY_FORMS = ("ascii", "binary_little_endian", "binary_big_endian")


def polygon_mesh(positions: object, faces: Sequence[Sequence[int]]) -> PolygonMesh:
    """A mesh with the exact dtypes of the library."""
    return PolygonMesh(
        np.array(positions, np.float64).reshape(-1, 3),
        np.array([vertex for face in faces for vertex in face], np.int32),
        np.array([len(face) for face in faces], np.int64),
    )


def faces_of(mesh: PolygonMesh) -> Faces:
    return (
        [corners.tolist() for corners in np.split(mesh.corners, np.cumsum(mesh.sizes)[:-1])] if len(mesh.sizes) else []
    )


def cube(n: int, size: float = 2.0) -> tuple[np.ndarray, Faces]:
    """A cube of 6 n^2 quads; its corners are the vertices `cube_corners`."""
    lattice: dict[tuple[int, ...], int] = {}
    faces = []
    for axis in range(3):
        for side in (0, n):
            for i in range(n):
                for j in range(n):
                    square = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
                    points = [tuple(np.roll((side, *ij), axis).tolist()) for ij in square]
                    face = [lattice.setdefault(point, len(lattice)) for point in points]
                    faces.append(face if side else face[::-1])
    return size * (np.array(list(lattice)) / n - 0.5), faces


def perforated_plate(holes: int, corners: int, seed: int = 0) -> tuple[np.ndarray, Faces]:
    """A closed plate with star-shaped holes through it. Its caps are single faces, in which edges run from the outline
    to each hole and back, and so name the vertices at their ends twice."""
    random = np.random.default_rng(seed)
    turn = -np.pi / 2 - 2 * np.pi * np.arange(corners) / corners
    points, cap, feet, rings = [[0.0, 0.0]], [0], [], []
    for hole in range(holes):
        radii = random.uniform(0.2, 0.45, corners)
        foot, ring = len(points), list(range(len(points) + 1, len(points) + 1 + corners))
        around = np.stack([hole + 0.5 + radii * np.cos(turn), 0.5 + radii * np.sin(turn)], axis=1)
        points += [[hole + 0.5, 0.0], *around.tolist()]
        cap += [foot, *ring, ring[0], foot]
        feet.append(foot)
        rings.append(ring)
    right = list(range(len(points), len(points) + 3))
    points += [[holes, 0.0], [holes, 1.0], [0.0, 1.0]]
    count = len(points)
    positions = np.concatenate([np.insert(points, 2, height, axis=1) for height in (0.3, 0.0)])
    faces = [[*cap, *right], [count + vertex for vertex in reversed([*cap, *right])]]
    for loop in ([0, *feet, *right], *rings):
        faces += [[a, count + a, count + b, b] for a, b in zip(loop, [*loop[1:], loop[0]], strict=True)]
    return positions, faces


def with_own_corners(positions: np.ndarray, faces: Faces) -> tuple[np.ndarray, Faces]:
    """Every corner of a face has a vertex of its own."""
    ends = np.cumsum([len(face) for face in faces])
    corners = np.concatenate(faces)
    return positions[corners], [part.tolist() for part in np.split(np.arange(len(corners)), ends[:-1])]


def cube_corners(positions: np.ndarray) -> list[int]:
    return np.flatnonzero((np.abs(positions) == np.abs(positions).max()).all(axis=1)).tolist()


def bumpy_ball(n: int = 6) -> tuple[np.ndarray, Faces]:
    """A closed surface that no cones at the cube's corners unfold without distortion."""
    positions, faces = cube(n)
    direction = positions / np.linalg.norm(positions, axis=1, keepdims=True)
    radius = 1 + 0.15 * np.sin(3 * direction[:, 0] + 1) * np.cos(2 * direction[:, 1] - direction[:, 2])
    return direction * radius[:, None], faces


def patch(n: int = 4) -> tuple[np.ndarray, Faces]:
    """An open curved patch of a triangle, a pentagon and quads."""
    x, y = np.meshgrid(np.arange(n + 1.0), np.arange(n + 1.0), indexing="ij")
    positions = np.stack([x, y, 0.1 * x * y], axis=-1).reshape(-1, 3)
    corner = np.arange((n + 1) ** 2).reshape(n + 1, n + 1)
    faces = [
        [int(corner[i, j]), int(corner[i + 1, j]), int(corner[i + 1, j + 1]), int(corner[i, j + 1])]
        for i in range(n)
        for j in range(n)
    ]
    first, second = faces[0], faces[1]
    # The first two quads become a triangle and the pentagon beside it.
    faces[0:2] = [[first[0], first[1], first[3]], [first[1], first[2], second[2], second[3], first[3]]]
    return positions, faces


def obj_text(positions: np.ndarray, faces: Faces) -> str:
    lines = ["v " + " ".join(map(repr, p)) for p in np.asarray(positions, float).tolist()]
    return "\n".join(lines + ["f " + " ".join(str(v + 1) for v in face) for face in faces]) + "\n"


def off_text(positions: np.ndarray, faces: Faces) -> str:
    lines = ["OFF", f"{len(positions)} {len(faces)} 0"]
    lines += [" ".join(map(repr, p)) for p in np.asarray(positions, float).tolist()]
    return "\n".join(lines + [" ".join(map(str, [len(face), *face])) for face in faces]) + "\n"


def ply_bytes(
    positions: np.ndarray,
    faces: Faces,
    form: str = "ascii",
    coordinate: str = "double",
    count: str = "uchar",
    index: str = "int",
    list_name: str = "vertex_indices",
    extras: bool = False,
) -> bytes:
    """A PLY file. extras: properties and elements around those of the mesh that a reader has to step over."""
    codes = {
        "char": "b",
        "uchar": "B",
        "short": "h",
        "ushort": "H",
        "int": "i",
        "uint": "I",
        "float": "f",
        "double": "d",
    }
    order = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}[form]
    header = ["ply", f"format {form} 1.0", "comment made for a test"]
    if extras:
        header += ["element camera 1", "property list uchar float view", "property int shutter"]
    header += [f"element vertex {len(positions)}"]
    header += ["property uchar red"] * extras + [f"property {coordinate} {axis}" for axis in "xyz"]
    header += ["property float quality"] * extras + [f"element face {len(faces)}"]
    header += ["property int flags"] * extras + [f"property list {count} {index} {list_name}"]
    header += ["property list uchar float texcoord"] * extras + ["end_header"]

    rows: list[list[tuple[str, float]]] = []
    if extras:
        rows.append([("uchar", 2), ("float", 0.5), ("float", 1.5), ("int", 7)])
    kind = float if coordinate in ("float", "double") else int
    for p in np.asarray(positions).astype(kind).tolist():
        rows.append([("uchar", 255)] * extras + [(coordinate, c) for c in p] + [("float", 0.25)] * extras)
    for number, face in enumerate(faces):
        row = [("int", -1)] * extras + [(count, len(face))] + [(index, v) for v in face]
        texcoord = [("uchar", number % 3)] + [("float", 0.5)] * (number % 3)
        rows.append(row + texcoord * extras)
    head = ("\n".join(header) + "\n").encode()
    if order:
        return head + b"".join(struct.pack(order + codes[kind], value) for row in rows for kind, value in row)
    return head + "".join(" ".join(repr(value) for _, value in row) + "\n" for row in rows).encode()


def require_triangulation(mesh: PolygonMesh, triangulation: Triangulation) -> None:
    """Every polygon of k corners has k - 2 triangles of its own corners; its edges border one of them, in the polygon's
    own direction, and every diagonal two, in opposite directions."""
    starts = mesh.starts
    assert (mesh.corners[triangulation.corner] == triangulation.triangles).all()
    assert (np.diff(triangulation.polygon) >= 0).all()
    for polygon, size in enumerate(mesh.sizes.tolist()):
        local = triangulation.corner[triangulation.polygon == polygon] - starts[polygon]
        assert local.shape == (size - 2, 3)
        directed = Counter((t[i], t[(i + 1) % 3]) for t in local.tolist() for i in range(3))
        border = {(i, (i + 1) % size) for i in range(size)}
        assert max(directed.values()) == 1
        assert {pair for pair in directed if pair[::-1] not in directed} == border


def triangle_areas(mesh: PolygonMesh, triangulation: Triangulation) -> np.ndarray:
    """(m,) signed areas of the triangles, seen along the normal (Newell's) of their polygon."""
    areas = np.empty(len(triangulation.triangles))
    for polygon, start in enumerate(mesh.starts.tolist()):
        points = mesh.positions[mesh.corners[start : start + int(mesh.sizes[polygon])]]
        points = points - points[0]
        newell = np.cross(points, np.roll(points, -1, axis=0)).sum(axis=0)
        mine = triangulation.polygon == polygon
        a, b, c = np.moveaxis(points[triangulation.corner[mine] - start], 1, 0)
        areas[mine] = np.cross(b - a, c - a) @ (newell / np.linalg.norm(newell)) / 2
    return areas


def polygon_areas(mesh: PolygonMesh) -> np.ndarray:
    """(f,) lengths of Newell's area vectors."""
    areas = []
    for start, size in np.stack([mesh.starts, mesh.sizes], axis=1).tolist():
        points = mesh.positions[mesh.corners[start : start + size]]
        points = points - points[0]
        areas.append(np.linalg.norm(np.cross(points, np.roll(points, -1, axis=0)).sum(axis=0)) / 2)
    return np.array(areas)


def stl_files(positions: np.ndarray, triangles: np.ndarray) -> dict[str, bytes]:
    """Triangles, (m, 3), as a binary file and as text."""
    corners = positions[triangles].astype("<f4")
    facets = b"".join(bytes(12) + corner.tobytes() + bytes(2) for corner in corners)
    lines = ["solid ball"]
    for corner in corners.tolist():
        places = [f"vertex {x!r} {y!r} {z!r}" for x, y, z in corner]
        lines += ["facet normal 0 0 0", "outer loop", *places, "endloop", "endfacet"]
    return {
        "binary": bytes(80) + struct.pack("<I", len(corners)) + facets,
        "text": "\n".join([*lines, "endsolid ball", ""]).encode(),
    }
