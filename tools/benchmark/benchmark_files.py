# SPDX-License-Identifier: GPL-3.0-or-later
"""Files, the command line from file to file, and the packer xatlas on the same surfaces; a part of `benchmark.py`."""

from __future__ import annotations

import os
import statistics
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from importlib.util import find_spec
from pathlib import Path

import igl
import lsgp
import numpy as np
from benchmark_cases import Case
from benchmark_options import cpu_seconds

# An environment variable with the path of the command line of BFF (Boundary First Flattening).
BFF = "BFF"
CONES = 8
MEASURING = """\
import resource, subprocess, sys
subprocess.run(sys.argv[1:], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=True)
usage = resource.getrusage(resource.RUSAGE_CHILDREN)
print(usage.ru_utime + usage.ru_stime, usage.ru_maxrss)
"""
# xatlas takes minutes for more.
MOST_TRIANGLES_OF_XATLAS = 60_000

# A file of each kind in which the surface is read, and whether it is text.
KINDS = {"OBJ": ("obj", True), "OFF": ("off", True), "PLY": ("ply", False), "PLY as text": ("text.ply", True)}


def measure_files(case: Case, repetitions: int) -> dict[str, object]:
    """CPU seconds of reading the surface and of writing it with a map."""
    row: dict[str, object] = {"mesh": case.name, "triangles": f"{len(case.triangles):,}"}
    with tempfile.TemporaryDirectory() as folder:
        for kind, (suffix, is_text) in KINDS.items():
            path, out = Path(folder) / f"mesh.{suffix}", Path(folder) / f"out.{suffix}"
            write_triangles(path, case, is_text)
            file = lsgp.read_mesh_file(path)
            uv = np.random.default_rng(0).random((len(case.positions), 2))[case.triangles]
            read, written = [], []
            for _ in range(repetitions):
                read.append(cpu_seconds(lambda path=path: lsgp.read_mesh_file(path)))
                if kind != "OFF":  # has no texture coordinates
                    written.append(cpu_seconds(lambda out=out, file=file, uv=uv: lsgp.write_mesh_file(out, file, uv)))
            row[f"{kind} read"] = f"{statistics.median(read):.2f}"
            if written:
                row[f"{kind} written"] = f"{statistics.median(written):.2f}"
    return row


def measure_command(case: Case, repetitions: int) -> dict[str, object]:
    """CPU seconds and megabytes from file to file, with eight cones that are chosen, beside BFF if there is one."""
    row: dict[str, object] = {"mesh": case.name, "triangles": f"{len(case.triangles):,}"}
    with tempfile.TemporaryDirectory() as folder:
        path, out = Path(folder) / "mesh.obj", Path(folder) / "out.obj"
        write_triangles(path, case)
        own = [sys.executable, "-m", "lsgp", "unwrap", str(path), "-o", str(out), "--cones", f"auto:{CONES}"]
        commands = {"lsgp": own}
        if BFF in os.environ:
            commands["BFF"] = [os.environ[BFF], str(path), str(out), f"--nCones={CONES}"]
        for name, command in commands.items():
            runs = [cost_of(command) for _ in range(repetitions)]
            row[f"{name} s"] = f"{statistics.median(seconds for seconds, _ in runs):.2f}"
            row[f"{name} MB"] = f"{max(megabytes for _, megabytes in runs):.0f}"
    if "BFF s" in row:
        row["BFF / lsgp"] = f"{float(str(row['BFF s'])) / float(str(row['lsgp s'])):.1f}"
    return row


def write_triangles(path: Path, case: Case, is_text: bool = True) -> None:
    encoding = igl.FileEncoding.Ascii if is_text else igl.FileEncoding.Binary
    igl.write_triangle_mesh(str(path), case.positions, case.triangles.astype(np.int64), encoding)


def cost_of(command: Sequence[str]) -> tuple[float, float]:
    """CPU seconds of all threads, and the peak memory in megabytes, of a command that has to succeed."""
    # By way of a small process: a child begins with the memory of its parent.
    done = subprocess.run([sys.executable, "-c", MEASURING, *command], stdout=subprocess.PIPE, text=True, check=True)
    seconds, peak = map(float, done.stdout.split())
    return seconds, peak / (1 << 20 if sys.platform == "darwin" else 1 << 10)


def measure_xatlas(case: Case, repetitions: int) -> dict[str, object]:
    """CPU seconds of the whole unwrap, packed, beside the preset "bake"; none without the package."""
    row: dict[str, object] = {"mesh": case.name, "triangles": f"{len(case.triangles):,}"}
    surface = lsgp.Surface(case.positions, case.triangles)
    own = [cpu_seconds(lambda: lsgp.auto_unwrap(surface, preset="bake")) for _ in range(repetitions)]
    row["lsgp s"] = f"{statistics.median(own):.2f}"
    if find_spec("xatlas") is None or len(case.triangles) > MOST_TRIANGLES_OF_XATLAS:
        return row
    import xatlas

    theirs = [cpu_seconds(lambda: xatlas.parametrize(case.positions, case.triangles)) for _ in range(repetitions)]
    times = statistics.median(theirs) / statistics.median(own)
    return row | {"xatlas s": f"{statistics.median(theirs):.2f}", "xatlas / lsgp": f"{times:.1f}"}
