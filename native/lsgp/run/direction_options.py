# SPDX-License-Identifier: GPL-3.0-or-later
"""Directions of the texture, or of rows of quads, for the command line."""

from __future__ import annotations

import argparse
import math
from pathlib import Path
from typing import Any

from ..base.arguments import FloatArray
from ..io.mesh_files import MeshFile
from ..io.side_files import UsageError, directions_in, load_json


def add_direction_options(command: argparse.ArgumentParser, up: str, what: str) -> None:
    """up: the effect of --up. what: follows directions."""
    direction = command.add_mutually_exclusive_group()
    direction.add_argument("--up", metavar=("X", "Y", "Z"), nargs=3, type=float, help=f"the model's up direction: {up}")
    direction.add_argument(
        "--directions",
        metavar="FILE.json",
        help=f"[[face, x, y, z], ...], faces counted from 0: the direction of {what} there; longer vectors have more "
        "weight",
    )


def require_finite_up(args: argparse.Namespace) -> None:
    """Raises UsageError."""
    if args.up is not None and not all(map(math.isfinite, args.up)):
        raise UsageError("--up takes finite numbers; give the model's up, as 0 1 0")


def load_directions(args: argparse.Namespace) -> Any:
    """The content of the file of directions, for `directions_of_faces`; None without.  Raises OSError, InputError."""
    return None if args.directions is None else load_json(Path(args.directions))


def directions_of_faces(args: argparse.Namespace, content: Any, file: MeshFile) -> FloatArray | None:
    """(f, 3) at the faces of the file; None without.  Raises InputError."""
    return None if args.directions is None else directions_in(content, Path(args.directions), len(file.mesh.sizes))
