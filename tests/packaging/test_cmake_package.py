# SPDX-License-Identifier: GPL-3.0-or-later
"""The CMake package: a program outside of the source tree finds the installed library, and runs with it."""

import os
import shutil
import subprocess
import sys
import tomllib
from math import pi
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
CONSUMER = Path(__file__).parent / "consumer"
CPP_TESTS = ROOT / "build" / "unit_tests"  # where tools/test has compiled the library, which takes minutes
BUILD = CPP_TESTS if (CPP_TESTS / "CMakeCache.txt").exists() else ROOT / "build" / "library"
PATH = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"


def cmake(*arguments: object) -> subprocess.CompletedProcess[str]:
    program = shutil.which("cmake", path=PATH)
    assert program is not None
    command = [program, *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, timeout=1500, check=False)


def require(done: subprocess.CompletedProcess[str]) -> None:
    assert done.returncode == 0, done.stdout + done.stderr


def configure_consumer(prefix: Path, build: Path, version: str) -> subprocess.CompletedProcess[str]:
    prefixes = ";".join(filter(None, [str(prefix), os.environ.get("CMEEL_PREFIX")]))
    return cmake("-S", CONSUMER, "-B", build, f"-DCMAKE_PREFIX_PATH={prefixes}", f"-DWANTED_VERSION={version}")


@pytest.fixture(scope="module")
def version() -> str:
    return tomllib.loads((ROOT / "blender_manifest.toml").read_text(encoding="utf-8"))["version"]


@pytest.fixture(scope="module")
def prefix(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Where the library is installed."""
    if shutil.which("cmake", path=PATH) is None:
        pytest.skip("no cmake; install it here, as with: pip install cmake")
    if not any(map(shutil.which, ("make", "ninja"))):
        pytest.skip("neither make nor ninja, which cmake builds with")
    folder = tmp_path_factory.mktemp("prefix")
    require(cmake("-S", ROOT, "-B", BUILD, "-DLSGP_PYTHON=OFF"))
    require(cmake("--build", BUILD, "--target", "lsgp", "--parallel", os.cpu_count() or 1))
    require(cmake("--install", BUILD, "--prefix", folder))
    return folder


def test_a_program_builds_against_the_installed_library_and_runs(prefix, tmp_path, version):
    require(configure_consumer(prefix, tmp_path, version))
    require(cmake("--build", tmp_path))
    done = subprocess.run([tmp_path / "consumer"], capture_output=True, text=True, timeout=60, check=True)
    # The four corners of a regular tetrahedron share its curvature of 4 pi.
    assert [float(line) for line in done.stdout.split()] == pytest.approx([pi] * 4, abs=1e-8)
    done = subprocess.run([tmp_path / "press"], capture_output=True, text=True, timeout=60, check=True)
    stretch, *choices = done.stdout.splitlines()
    # A regular tetrahedron has a map without distortion, as one island.
    assert float(stretch.removeprefix("L2 stretch ")) == pytest.approx(1, abs=1e-6)
    assert any(line.startswith("* ") and " 1 island," in line for line in choices)


@pytest.mark.skipif(sys.platform != "linux", reason="names of shared libraries are the system's")
def test_the_library_is_named_by_the_versions_that_share_its_interface(prefix, version):
    (library,) = prefix.rglob("liblsgp.so")
    name = f"liblsgp.so.{version.rpartition('.')[0]}"
    assert os.readlink(library) == name
    assert os.readlink(library.with_name(name)) == f"liblsgp.so.{version}"
    assert name.encode() in library.read_bytes()


def test_another_minor_version_is_refused(prefix, tmp_path, version):
    major, minor, _ = version.split(".")
    done = configure_consumer(prefix, tmp_path, f"{major}.{int(minor) + 1}")
    assert done.returncode != 0
    assert "lsgp" in done.stderr and f"version: {version}" in done.stderr


@pytest.mark.skipif(
    shutil.which("pkg-config") is None or shutil.which("c++") is None, reason="takes pkg-config and c++"
)
def test_a_program_builds_with_what_pkg_config_says_and_the_folder_may_be_moved(prefix, tmp_path, version):
    moved = tmp_path / "moved"
    shutil.copytree(prefix, moved, symlinks=True)
    (folder,) = (found.parent for found in moved.rglob("lsgp.pc"))
    eigen = tmp_path / "eigen3.pc"
    eigen.write_text("Name: Eigen\nDescription: headers\nVersion: 3.4.0\nCflags: -I/usr/include/eigen3\n")
    environment = os.environ | {"PKG_CONFIG_PATH": f"{folder}{os.pathsep}{tmp_path}"}

    def said(*arguments: str) -> str:
        command = ["pkg-config", *arguments, "lsgp"]
        return subprocess.run(command, env=environment, capture_output=True, text=True, check=True).stdout

    assert said("--modversion").strip() == version
    program = tmp_path / "consumer"
    flags = said("--cflags", "--libs").split()
    subprocess.run(["c++", "-std=c++17", str(CONSUMER / "main.cpp"), "-o", str(program), *flags], check=True)
    environment["LD_LIBRARY_PATH"] = str(folder.parent)
    done = subprocess.run([program], env=environment, capture_output=True, text=True, timeout=60, check=True)
    assert len(done.stdout.split()) == 4
