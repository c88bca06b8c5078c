# SPDX-License-Identifier: GPL-3.0-or-later
"""Where Eigen and Spectra are not installed, the build downloads them, or says how this system installs them.

No network is needed: the archives lie in a folder, and the servers are out of reach.
"""

import hashlib
import os
import shutil
import subprocess
import sys
import tarfile
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
MODULE = ROOT / "native" / "header_libraries.cmake"
PATH = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
CMAKE = shutil.which("cmake", path=PATH)
NOT_INSTALLED = [f"-DCMAKE_DISABLE_FIND_PACKAGE_{name}=ON" for name in ("Eigen3", "Spectra")]
UNREACHABLE = {name: "http://127.0.0.1:9" for name in ("http_proxy", "https_proxy", "all_proxy")} | {"no_proxy": ""}

pytestmark = pytest.mark.skipif(CMAKE is None, reason="no cmake; install it here, as with: pip install cmake")


def cmake(*arguments: object, **environment: str) -> subprocess.CompletedProcess[str]:
    command = [CMAKE, *map(str, arguments)]
    environment = os.environ | {"PATH": PATH} | environment
    return subprocess.run(command, capture_output=True, text=True, timeout=300, check=False, env=environment)


def run_script(folder: Path, *lines: str) -> str:
    """What a CMake script prints that has the functions of the build."""
    script = folder / "script.cmake"
    script.write_text("\n".join([f"include({MODULE.as_posix()})", *lines]), encoding="utf-8")
    done = cmake("-P", script)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stderr  # of message() without a kind


def download(folder: Path, digest: str, *addresses: str) -> str:
    out = (folder / "headers").as_posix()
    return run_script(
        folder, f'lsgp_download("Eigen" {digest} {out} failure {" ".join(addresses)})', 'message("failure=${failure}")'
    )


@pytest.fixture
def archive(tmp_path) -> Path:
    """An archive of one header."""
    header = tmp_path / "Core"
    header.write_text("// a header\n", encoding="utf-8")
    path = tmp_path / "eigen.tar.bz2"
    with tarfile.open(path, "w:bz2") as out:
        out.add(header, "eigen/Eigen/Core")
    return path


def digest_of(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()


def test_headers_come_from_the_first_address_that_has_them(archive, tmp_path):
    said = download(tmp_path, digest_of(archive), (tmp_path / "none").as_uri(), archive.as_uri())
    assert said == "failure=\n"
    assert (tmp_path / "headers" / "eigen" / "Eigen" / "Core").read_text(encoding="utf-8") == "// a header\n"


def test_headers_are_downloaded_once(archive, tmp_path):
    digest = digest_of(archive)
    download(tmp_path, digest, archive.as_uri())
    archive.unlink()
    assert download(tmp_path, digest, archive.as_uri()) == "failure=\n"


def test_other_bytes_are_refused(archive, tmp_path):
    said = download(tmp_path, 64 * "0", archive.as_uri())
    assert f"{archive.as_uri()}: its SHA-256 is {digest_of(archive)}, and not {64 * '0'}" in said
    assert not (tmp_path / "headers").exists()


@pytest.mark.parametrize(
    ("system", "command"),
    [
        ("ID=debian", "apt-get install libeigen3-dev libspectra-dev"),
        ("ID=linuxmint\nID_LIKE=ubuntu", "apt-get install libeigen3-dev libspectra-dev"),
        ("ID=fedora", "dnf install eigen3-devel spectra-devel"),
        ('ID="rocky"\nID_LIKE="rhel centos fedora"', "dnf install eigen3-devel spectra-devel"),
        ("ID=arch", "git clone https://aur.archlinux.org/spectra.git && (cd spectra && makepkg -si)"),
    ],
    ids=lambda text: text.partition("\n")[0],
)
def test_the_command_is_that_of_the_system(tmp_path, system, command):
    release = tmp_path / "os-release"
    release.write_text(f"NAME=any\n{system}\n", encoding="utf-8")
    assert run_script(tmp_path, f"lsgp_install_command({release.as_posix()} command)", 'message("${command}")') == (
        f"{command}\n"
    )


@pytest.mark.parametrize("fetch", ["ON", "OFF"])
def test_without_network_the_build_stops_with_the_command_that_installs_both(tmp_path, fetch):
    asked = [] if fetch == "ON" else ["-DLSGP_FETCH=OFF"]  # it is on unless it is switched off
    done = cmake("-S", ROOT, "-B", tmp_path / "build", "-DLSGP_PYTHON=OFF", *NOT_INSTALLED, *asked, **UNREACHABLE)
    assert done.returncode != 0
    said = " ".join(done.stderr.split())
    command = run_script(tmp_path, "lsgp_install_command(/etc/os-release command)", 'message("${command}")').strip()
    assert f"Eigen 3.4.0 is not installed, and {'could not be' if fetch == 'ON' else 'LSGP_FETCH is off'}" in said
    assert f"This installs both: {command}" in said
    for server in ("gitlab.com", "deb.debian.org"):
        assert (server in said) == (fetch == "ON")


def test_the_library_is_compiled_with_the_headers_that_were_downloaded(tmp_path):
    build = tmp_path / "build"
    folders = [build / "headers" / name for name in ("Eigen-3.4.0/eigen-3.4.0", "Spectra-1.0.1/spectra-1.0.1/include")]
    for folder in folders:
        folder.mkdir(parents=True)
    options = (*NOT_INSTALLED, "-DLSGP_SPECTRA=NOTFOUND", "-DCMAKE_FIND_USE_CMAKE_SYSTEM_PATH=OFF")
    done = cmake("-S", ROOT, "-B", build, "-DLSGP_PYTHON=OFF", "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON", *options)
    assert done.returncode == 0, done.stdout + done.stderr
    commands = (build / "compile_commands.json").read_text(encoding="utf-8")
    for folder in folders:
        assert f"-isystem {folder}" in commands
