# SPDX-License-Identifier: GPL-3.0-or-later
"""The same sources give the same wheel, byte for byte, wherever and whenever they are checked out.

Of what the compiler makes only the run path is looked at: these wheels are built without it.
"""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import lsgp._lsgp
import pytest

ROOT = Path(__file__).resolve().parents[2]
SOURCES = ("native/lsgp", "pyproject.toml", "blender_manifest.toml", "README.md", "LICENSE", "CMakeLists.txt")
BUILD = (
    "import sys; from scikit_build_core.build import build_wheel; build_wheel(sys.argv[1], {'wheel.cmake': 'false'})"
)


def built(folder: Path, modified: float) -> Path:
    """The wheel of a copy of the sources in a new folder, all of whose files were modified at that time."""
    for name in SOURCES:
        source, copy = ROOT / name, folder / name
        copy.parent.mkdir(parents=True, exist_ok=True)
        if source.is_dir():
            shutil.copytree(source, copy, ignore=shutil.ignore_patterns("__pycache__"))
        else:
            shutil.copy(source, copy)
    for path in folder.rglob("*"):
        os.utime(path, (modified, modified))
    environment = os.environ | {"SOURCE_DATE_EPOCH": "1700000000"}
    done = subprocess.run(
        [sys.executable, "-c", BUILD, str(folder / "wheel")],
        cwd=folder,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    (wheel,) = (folder / "wheel").glob("lsgp-*.whl")
    return wheel


def test_same_sources_give_the_same_wheel(tmp_path):
    pytest.importorskip("scikit_build_core", reason="takes scikit-build-core")
    first, second = built(tmp_path / "here", 1e9), built(tmp_path / "there" / "deeper", 1.5e9)
    assert first.name == second.name
    assert first.read_bytes() == second.read_bytes()


@pytest.mark.skipif(sys.platform != "linux", reason="takes an ELF file")
def test_run_path_of_the_module_does_not_depend_on_the_folder_of_its_build():
    """Where CMake changes a run path while it installs, zeros keep the length of that folder's name."""
    module = Path(lsgp._lsgp.__file__).read_bytes()
    assert module.count(b"$ORIGIN") == 1
    assert module.partition(b"$ORIGIN")[2][:8] != bytes(8)
