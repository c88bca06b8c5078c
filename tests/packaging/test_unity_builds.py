# SPDX-License-Identifier: GPL-3.0-or-later
"""Every source of the library is compiled once, however many of them are compiled together."""

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
SOURCES = ROOT / "native" / "src"
PATH = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
CMAKE = shutil.which("cmake", path=PATH)
KERNELS = "solvers/dense_kernels_for.cpp"  # once for every instruction set

pytestmark = pytest.mark.skipif(CMAKE is None, reason="no cmake; install it here, as with: pip install cmake")


def compiled(build: Path, *options: str) -> list[list[str]]:
    """The sources of the library that each call of the compiler reads."""
    command = [CMAKE, "-S", ROOT, "-B", build, "-DLSGP_PYTHON=OFF", "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON", *options]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    files = [Path(call["file"]) for call in json.loads((build / "compile_commands.json").read_text(encoding="utf-8"))]
    groups = []
    for file in files:
        if file.is_relative_to(SOURCES):
            groups.append([file])
        else:
            groups.append(map(Path, re.findall(r'#include "([^"]+\.cpp)"', file.read_text(encoding="utf-8"))))
    return [[path.relative_to(SOURCES).as_posix() for path in group] for group in groups]


def test_single_sources_folders_and_batches_have_all_sources(tmp_path):
    everything = sorted(path.relative_to(SOURCES).as_posix() for path in SOURCES.rglob("*.cpp"))
    unity = "-DCMAKE_UNITY_BUILD=ON"
    calls = []
    for number, options in enumerate(((), (unity,), (unity, "-DLSGP_BATCHES=ON"))):
        groups = compiled(tmp_path / str(number), *options)
        found = [source for group in groups for source in group]
        assert sorted({*found}) == everything
        assert {source for source in found if found.count(source) > 1} <= {KERNELS}
        calls.append(len(groups))
    assert calls[0] > calls[1] > calls[2]
