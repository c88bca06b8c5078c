# SPDX-License-Identifier: GPL-3.0-or-later
"""Directions of the texture, or of rows of quads, for the command line."""

from __future__ import annotations

import argparse
import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..base.arguments import FloatArray, IndexArray
from ..edge_directions import edge_directions, sides_of_edges
from ..errors import InputError
from ..io.mesh_files import MeshFile
from ..io.side_files import UsageError, directions_in, load_json
from ..stitching import at_stitched
from .named_files import Reads


@dataclass(frozen=True, slots=True)
class Strokes:
    """The directions of a file.

    directions: (m, 3) at the triangles; those at faces take precedence over those along edges beside them.
    faces, edges: (f,) and (e, 2), where they are; rows are first those of all faces, then those of edges.
    row, triangle: (s,) each, the triangles at which each stroke gives the direction.
    """

    directions: FloatArray
    faces: NDArray[np.intp]
    edges: IndexArray
    row: NDArray[np.intp]
    triangle: NDArray[np.intp]

    @property
    def names(self) -> list[str]:
        """Of all, by rows."""
        return [f"face {face}" for face in self.faces] + [f"edge {a} {b}" for a, b in self.edges.tolist()]

    def largest(self, values: FloatArray) -> FloatArray:
        """(f + e,) of values at triangles, (m,), the largest of each stroke; NaN where there is none."""
        out = np.full(len(self.faces) + len(self.edges), np.nan)
        np.fmax.at(out, self.row, values[self.triangle])
        return out


def add_direction_options(command: argparse.ArgumentParser, up: str, what: str) -> None:
    """up: the effect of --up. what: follows directions."""
    direction = command.add_mutually_exclusive_group()
    direction.add_argument("--up", metavar=("X", "Y", "Z"), nargs=3, type=float, help=f"the model's up direction: {up}")
    direction.add_argument(
        "--directions",
        metavar="FILE.json",
        action=Reads,
        help=f"[[face, x, y, z], ...], faces counted from 0: the direction of {what} there; longer vectors have more "
        "weight; or, also among these, [vertex, vertex]: from one to the other along the edge",
    )


def require_finite_up(args: argparse.Namespace) -> None:
    """Raises UsageError."""
    if args.up is not None and not all(map(math.isfinite, args.up)):
        raise UsageError("--up takes finite numbers; give the model's up, as 0 1 0")


def load_directions(args: argparse.Namespace) -> Any:
    """The content of the file of directions, for `strokes_of`; None without.  Raises OSError, UsageError."""
    return None if args.directions is None else load_json(Path(args.directions))


def strokes_of(args: argparse.Namespace, content: Any, file: MeshFile) -> Strokes | None:
    """What the file of directions says of a mesh file; None without.  Raises InputError."""
    if args.directions is None:
        return None
    of_faces, edges = directions_in(content, Path(args.directions), len(file.mesh.sizes))
    polygon, surface, pairs = file.triangulation.polygon, file.surface(), at_stitched(file.stitched, edges)
    at_face = of_faces[polygon]
    has_own = at_face.any(axis=1)
    try:
        along = edge_directions(surface, pairs)
    except InputError as error:
        raise InputError(error.code, f"'{args.directions}' does not hold directions. {error.message}") from error
    row, triangle, _ = sides_of_edges(surface, pairs)
    follows = ~has_own[triangle]
    faces = np.flatnonzero(of_faces.any(axis=1))
    return Strokes(
        directions=np.where(has_own[:, None], at_face, along),
        faces=faces,
        edges=edges,
        row=np.concatenate([np.searchsorted(faces, polygon[has_own]), len(faces) + row[follows]]),
        triangle=np.concatenate([np.flatnonzero(has_own), triangle[follows]]),
    )
