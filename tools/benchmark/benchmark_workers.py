# SPDX-License-Identifier: GPL-3.0-or-later
"""The processes `benchmark.py` measures, one for each method: libraries do not meet in one address space, the peak of
memory is a method's own, and all of them can take turns."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import threading
from contextlib import suppress
from pathlib import Path

import numpy as np
from benchmark_cases import ROOT, Case

TOOLS = Path(__file__).resolve().parent
LAPLACIAN_BUILD = ROOT / "build" / "laplacian"
ONE_THREAD = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "IGL_NUM_THREADS"), "1")
RUN_SECONDS = 900.0


class Worker:
    """A process that runs its method once for every line it is sent."""

    def __init__(self, command: list[str]) -> None:
        self._process = subprocess.Popen(
            command,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            text=True,
            env=os.environ | ONE_THREAD,
        )

    def run(self) -> dict[str, object] | None:
        """What it measured; None if it crashed, or was killed after too long a time."""
        watch = threading.Timer(RUN_SECONDS, self._process.kill)
        watch.start()
        try:
            self._process.stdin.write("run\n")
            self._process.stdin.flush()
            for line in self._process.stdout:
                if line.startswith("RESULT "):
                    return json.loads(line.removeprefix("RESULT "))
        except BrokenPipeError:
            pass
        finally:
            watch.cancel()
        return None

    def close(self) -> None:
        self._process.kill()
        self._process.wait()
        with suppress(BrokenPipeError):  # of one that ended before it read its last line
            self._process.stdin.close()
        self._process.stdout.close()


def python_worker(method: str, folder: Path, **arrays: np.ndarray) -> Worker:
    """method: "lsgp", "edit" or "move" of positions, triangles and cones; "lscm" of a disk."""
    source = folder / f"{method}.npz"
    np.savez(source, **arrays)
    script = str(TOOLS / "benchmark_worker.py")
    return Worker([sys.executable, script, str(source), method, str(folder / "cut.npy")])


def lsgp_worker(method: str, case: Case, folder: Path) -> Worker:
    return python_worker(method, folder, positions=case.positions, triangles=case.triangles, cones=case.cones)


def read_cut(folder: Path) -> np.ndarray:
    """The cut that the worker of lsgp wrote."""
    return np.load(folder / "cut.npy")


def find_blender() -> str | None:
    """A Python with bpy."""
    python = Path(os.environ.get("BPY_PYTHON") or ROOT / "build" / "bpy" / "bin" / "python")
    return str(python) if python.is_file() else None


def blender_worker(
    blender: str, case: Case, seams: np.ndarray, method: str, folder: Path, target: Path | None = None
) -> Worker:
    """target: receives the map of every run."""
    source = folder / f"{method}.npz"
    np.savez(source, positions=case.positions, triangles=case.triangles, seams=seams)
    command = [blender, str(TOOLS / "benchmark_in_blender.py"), str(source), method]
    return Worker(command if target is None else [*command, str(target)])


def build_laplacian_program() -> Path | None:
    """The program that factors a bare Laplacian; None without CMake, a compiler or Eigen."""
    cmake = shutil.which("cmake")
    if cmake is None:
        return None
    steps = ["-S", str(TOOLS / "laplacian"), "-B", str(LAPLACIAN_BUILD)], ["--build", str(LAPLACIAN_BUILD)]
    for step in steps:
        if subprocess.run([cmake, *step], stdout=subprocess.DEVNULL, check=False).returncode != 0:
            return None
    return LAPLACIAN_BUILD / "factor_laplacian"


def laplacian_worker(program: Path, case: Case, library: str, folder: Path) -> Worker:
    """library: "eigen" or "cholmod"."""
    source = folder / "laplacian.bin"
    with source.open("wb") as file:
        np.array([len(case.positions), len(case.triangles)], np.int32).tofile(file)
        case.positions.astype(np.float64).tofile(file)
        case.triangles.tofile(file)
    return Worker([str(program), str(source), library])
