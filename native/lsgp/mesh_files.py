# SPDX-License-Identifier: GPL-3.0-or-later
"""Mesh files in and out: OBJ, OFF and PLY to polygons, polygons with texture coordinates to OBJ.

The readers and the writer are our own because no reader without further dependencies keeps polygons, their order and
the vertices exactly as the file has them, and numpy is the wheel's only dependency.
"""

from __future__ import annotations

import contextlib
import os
import secrets
import shutil
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from .errors import InputError
from .mesh_obj import format_obj, read_obj
from .mesh_off import HEADER as OFF_HEADER
from .mesh_off import read_off
from .mesh_ply import read_ply
from .polygons import PolygonMesh

# Names of files that are being written; they stay where a process is killed. A suffix may stand behind them.
PARTIAL = ".lsgp-*.partial"
ABANDONED_SECONDS = 3600.0


def read_mesh(path: str | os.PathLike[str], with_uv: bool = False) -> PolygonMesh:
    """Read vertices and polygons, in the file's order.

    The format is told by the name (.obj, .off, .ply), otherwise by the first bytes (PLY, OFF).
    with_uv: also read the texture coordinates of an OBJ; None in the answer for the other formats.
    Raises OSError; InputError: UNKNOWN_FORMAT, MALFORMED_FILE, INDEX_OUT_OF_RANGE, BAD_FACE.
    """
    data = Path(path).read_bytes()
    suffix = Path(path).suffix.lower()
    if suffix == ".obj":
        return read_obj(data, with_uv)
    if suffix == ".ply" or (suffix != ".off" and data[:4].rstrip() == b"ply"):
        return read_ply(data)
    if suffix == ".off" or OFF_HEADER.match((data[:80].split() or [b""])[0]):
        return read_off(data)
    raise InputError(
        "UNKNOWN_FORMAT", f"'{os.fspath(path)}' is no OBJ, OFF or PLY file. Export the mesh in one of these formats."
    )


def write_obj(path: str | os.PathLike[str], mesh: PolygonMesh, corner_uv: NDArray[np.float64]) -> None:
    """Write the mesh as OBJ with texture coordinates (c, 2) per polygon corner; a polygon with a NaN gets none.

    Vertices, polygons and their order stay; doubles read back as the same doubles.  Raises OSError, and leaves a file
    that was there as it was.
    """
    write_whole(path, format_obj(mesh, corner_uv))


def write_whole(path: str | os.PathLike[str], data: bytes) -> None:
    """Write a file so that it is there as a whole or not at all.  Raises OSError."""
    target = Path(os.path.realpath(path))
    if target.exists() and not target.is_file():
        target.write_bytes(data)  # a device or a pipe is written to, not replaced
        return
    with whole_file(target) as partial, partial.open("xb") as file:
        file.write(data)


@contextlib.contextmanager
def whole_file(target: Path, suffix: str = "") -> Iterator[Path]:
    """The path to write to of a file that takes its place when all went well, and otherwise is gone.

    suffix: of that path, for writers that tell the format by it.
    """
    partial = target.with_name(PARTIAL.replace("*", secrets.token_hex(6)) + suffix)
    try:
        yield partial
        if target.exists():
            shutil.copymode(target, partial)
        os.replace(partial, target)
    except BaseException:
        with contextlib.suppress(OSError):
            partial.unlink()
        raise


def remove_old_partials(folder: Path) -> None:
    """Remove, at any depth, what processes left that were killed while they wrote, an hour ago or more."""
    for partial in folder.rglob(f"{PARTIAL}*"):
        with contextlib.suppress(OSError):
            if time.time() - partial.stat().st_mtime > ABANDONED_SECONDS:
                partial.unlink()
