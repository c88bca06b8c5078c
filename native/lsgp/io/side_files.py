# SPDX-License-Identifier: GPL-3.0-or-later
"""The files beside a mesh on the command line: cones and their angles, seam edges, directions, importance, density,
cut costs."""

from __future__ import annotations

import errno
import math
import os
import stat
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import InputError
from .json_text import JsonError, parse_json
from .mesh_text import Rows, malformed


class UsageError(Exception):
    """Wrong usage: a command or an option that cannot be carried out."""


def read_regular(path: Path) -> bytes:
    """The content of a regular file.  Raises OSError, for pipes and devices too: they may never begin or end."""
    mode = os.stat(path).st_mode
    if stat.S_ISDIR(mode):  # Windows would say that it is not permitted
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), path)
    if not stat.S_ISREG(mode):
        raise OSError(
            errno.EINVAL, "Not a regular file (to read a mesh from a pipe, let the input be - and redirect it)", path
        )
    try:
        return path.read_bytes()
    except OSError as error:  # from reading, after the file has been opened, without its name
        error.filename = error.filename or path
        raise


def load_json(path: Path) -> Any:
    """The content of a JSON file.  Raises OSError, UsageError."""
    return _parsed(read_regular(path), path)


def cones_in(content: Any, path: Path, prescription: str | None) -> tuple[NDArray[np.int32], list[float | None] | None]:
    """Cones of a cones file and the angles to use, in radians.  Raises InputError."""
    cones = content.get("cones") if isinstance(content, dict) else None
    if not _is_list_of(cones, _is_integer):
        raise _unlike(path, '{"cones": [vertex, ...]} with vertices counted from 0')
    angles = {}
    for key, unit in (("cone_angles", 1.0), ("angles_over_pi_2", math.pi / 2)):
        values = content.get(key)
        if values is None:
            continue
        if not _is_list_of(values, lambda value: value is None or _is_number(value)):
            raise _unlike(path, f'"{key}": [number or null, ...]')
        if len(values) != len(cones):
            raise InputError(
                "ANGLE_COUNT",
                f"'{path}' has {len(cones)} cones but {len(values)} {key}. Give one for each cone, null for automatic.",
            )
        angles[key] = [None if value is None else unit * _as_float(value) for value in values]
    indices = _indices(cones, "CONE_INDEX", "cone").reshape(-1)
    if prescription == "manual":
        if not angles:
            raise InputError(
                "ANGLE_COUNT", f"'{path}' has no angles for the manual prescription. Add \"cone_angles\" in radians."
            )
        return indices, angles.get("cone_angles", angles.get("angles_over_pi_2"))
    return indices, angles.get("cone_angles") if prescription is None else None


def pairs_in(content: Any, path: Path | None, what: str) -> NDArray[np.int32]:
    """(s, 2) vertex pairs of a file of edges.  what: one of their vertices.  Raises InputError."""
    if not _is_list_of(content, lambda pair: _is_list_of(pair, _is_integer) and len(pair) == 2):
        raise _unlike(path, "[[a, b], ...] with vertices counted from 0")
    return _indices([vertex for pair in content for vertex in pair], "INDEX_OUT_OF_RANGE", what).reshape(-1, 2)


def directions_in(content: Any, path: Path, face_count: int) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    """The strokes of a directions file: (f, 3) the direction at each face, those of one face added up, and (e, 2) the
    vertices of edges along which v is to run.  Raises InputError."""
    if not _is_list_of(content, _is_stroke):
        raise _unlike(path, "[[face, x, y, z] or [vertex, vertex], ...] with faces and vertices counted from 0")
    edges = pairs_in([row for row in content if len(row) == 2], path, "vertex of a direction")
    content = [row for row in content if len(row) == 4]
    faces = _indices([row[0] for row in content], "INDEX_OUT_OF_RANGE", "face of a direction")
    outside = faces[(faces < 0) | (faces >= face_count)]
    if len(outside):
        raise InputError(
            "INDEX_OUT_OF_RANGE",
            f"'{path}' has a direction at face {outside[0]}, but the mesh has {face_count} faces. Use faces of the "
            "file, counted from 0.",
        )
    directions = np.zeros((face_count, 3))
    np.add.at(directions, faces, np.array([[_as_float(x) for x in row[1:]] for row in content]).reshape(-1, 3))
    return directions, edges


@dataclass(frozen=True, slots=True)
class CutCostFile:
    """The content of a file of cut costs: `paint`, (n,), one number for each vertex, or `costs`, (c,), one for each of
    `pairs`, (c, 2) vertices. lines: (c,) those of the file, or of the list in it, counted from 1."""

    paint: NDArray[np.float64] | None
    pairs: NDArray[np.int64]
    costs: NDArray[np.float64]
    lines: list[int]


def load_cut_costs(path: Path) -> CutCostFile:
    """A file of cut costs: "a b cost" on each line, or one number for each vertex; or the same as a JSON list.

    Raises OSError, UsageError, InputError.
    """
    data = read_regular(path)
    if _is_json(data):
        data = _as_lines(_parsed(data, path), path)
    rows = Rows.split(data)
    try:
        width = 3 if len(rows.counts) and rows.counts[0] == 3 else 1
        wrong = np.flatnonzero(rows.counts != width)
        if len(wrong):
            form = "Give two vertices and a cost" if width == 3 else "Give one number"
            raise malformed(f"{form}, as on the line before.", int(rows.lines[wrong[0]]))
        lines = rows.lines.tolist()
        every = rows.tokens().reshape(-1, width)
        if width == 1:
            return CutCostFile(rows.floats(every.ravel()), np.empty((0, 2), np.int64), np.empty(0), lines)
        pairs = rows.integers(every[:, :2].ravel()).reshape(-1, 2)
        return CutCostFile(None, pairs, rows.floats(every[:, 2]), lines)
    except InputError as error:
        raise InputError(error.code, f"'{path}' does not hold the costs of cuts. {error.message}") from error


def _as_lines(content: Any, path: Path) -> bytes:
    """The entries of a JSON list, one to a line."""
    if _is_list_of(content, _is_number):
        rows = [[value] for value in content]
    elif _is_list_of(content, lambda row: _is_list_of(row, _is_number) and len(row) == 3):
        rows = content
    else:
        raise _unlike(path, "[[a, b, cost], ...] with vertices counted from 0, or [number, ...], one for each vertex")
    return "\n".join(" ".join(map(repr, row)) for row in rows).encode()


def load_importance(path: Path) -> NDArray[np.float64]:
    """The numbers of a file, a JSON list or text with white space between them.  Raises OSError, UsageError,
    InputError."""
    data = read_regular(path)
    if not _is_json(data):
        return _numbers(data, path, "importance")
    content = _parsed(data, path)
    if not _is_list_of(content, _is_number):
        raise _unlike(path, "[number, ...], one for each vertex")
    return _floats(content)


@dataclass(frozen=True, slots=True)
class DensityFile:
    """The content of a file of densities: `values` of all vertices, or of these `vertices`, the others having 1."""

    path: Path
    vertices: NDArray[np.int32] | None
    values: NDArray[np.float64]

    def at_vertices(self, vertex_count: int) -> NDArray[np.float64]:
        """(n,) that of each vertex, of several values the last one.  Raises InputError."""
        if self.vertices is None:
            if len(self.values) != vertex_count:
                raise InputError(
                    "WRONG_PARAMETER",
                    f"'{self.path}' has {len(self.values)} numbers for {vertex_count} vertices. Give one for each.",
                )
            return self.values
        outside = self.vertices[(self.vertices < 0) | (self.vertices >= vertex_count)]
        if len(outside):
            raise InputError(
                "INDEX_OUT_OF_RANGE",
                f"'{self.path}' has a density at vertex {outside[0]}, but the mesh has {vertex_count} vertices. Use "
                "vertices of the file, counted from 0.",
            )
        density = np.ones(vertex_count)
        density[self.vertices] = self.values
        return density


def load_density(path: Path) -> DensityFile:
    """A file of densities: one number for each vertex, as a JSON list or as text with white space between them, or a
    JSON list of vertices and their numbers.  Raises OSError, UsageError, InputError."""
    data = read_regular(path)
    if not _is_json(data):
        return DensityFile(path, None, _numbers(data, path, "density"))
    content = _parsed(data, path)
    if content and _is_list_of(content, _is_number):
        return DensityFile(path, None, _floats(content))
    if not _is_list_of(content, lambda row: _is_list_of(row, _is_number) and len(row) == 2 and _is_integer(row[0])):
        raise _unlike(
            path, "[number, ...], one for each vertex, or [[vertex, number], ...] with vertices counted from 0"
        )
    vertices = _indices([row[0] for row in content], "INDEX_OUT_OF_RANGE", "vertex of a density")
    return DensityFile(path, vertices, _floats([row[1] for row in content]))


def _is_json(data: bytes) -> bool:
    return data.lstrip()[:1] in (b"[", b"{")


def _numbers(data: bytes, path: Path, what: str) -> NDArray[np.float64]:
    """Those of a text, with white space between them.  what: of vertices they are.  Raises InputError."""
    rows = Rows.split(data)
    try:
        return rows.floats(rows.tokens())
    except InputError as error:
        raise InputError(error.code, f"'{path}' does not hold the {what} of vertices. {error.message}") from error


def _floats(values: list[float]) -> NDArray[np.float64]:
    return np.array([_as_float(value) for value in values], np.float64)


def _parsed(data: bytes, path: Path) -> Any:
    try:
        return parse_json(data)
    except JsonError as error:
        raise UsageError(f"'{path}' is not valid JSON: {error}; correct it there") from error


def _is_stroke(row: Any) -> bool:
    """Whether it is the direction at a face or the two vertices of an edge."""
    if _is_list_of(row, _is_integer) and len(row) == 2:
        return True
    return _is_list_of(row, _is_number) and len(row) == 4 and _is_integer(row[0])


def _is_list_of(value: Any, accepts: Callable[[Any], bool]) -> bool:
    return isinstance(value, list) and all(map(accepts, value))


def _is_integer(value: Any) -> bool:
    return isinstance(value, int) and not isinstance(value, bool)


def _is_number(value: Any) -> bool:
    return _is_integer(value) or isinstance(value, float)


def _as_float(value: float) -> float:
    try:
        return float(value)
    except OverflowError:  # an integer of more than 308 digits
        return math.inf


def _indices(values: list[int], code: str, what: str) -> NDArray[np.int32]:
    limit = np.iinfo(np.int32)
    wrong = next((value for value in values if not limit.min <= value <= limit.max), None)
    if wrong is not None:
        raise InputError(
            code, f"A {what} lies outside the mesh: {_as_float(wrong):.3g}. Use vertices of the file, counted from 0."
        )
    return np.array(values, np.int32)


def _unlike(path: Path | None, form: str) -> InputError:
    return InputError("MALFORMED_FILE", f"'{path}' does not have the form {form}. Correct the file.")
