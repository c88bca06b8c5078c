# SPDX-License-Identifier: GPL-3.0-or-later
"""Where a compiler or Python's headers are missing, the build says so, and how this system installs them."""

import os
import sys
import sysconfig

import pytest
from test_header_libraries import CMAKE, ROOT, cmake

pytestmark = [
    pytest.mark.skipif(CMAKE is None, reason="no cmake; install it here, as with: pip install cmake"),
    pytest.mark.skipif(sys.platform == "win32", reason="Windows has no folder of programs to look into"),
]


# Python's own name for its compiler is what pip's builds ask for.
@pytest.mark.parametrize("asked", ["x86_64-linux-gnu-none -pthread", None], ids=["named", "any"])
def test_without_compiler_the_build_stops_with_the_command_that_installs_one(tmp_path, monkeypatch, asked):
    monkeypatch.delenv("CXX", raising=False)
    names = {} if asked is None else {"CXX": asked}
    only_here = ["-DCMAKE_FIND_USE_CMAKE_SYSTEM_PATH=OFF", "-G", "Unix Makefiles"]
    done = cmake("-S", ROOT, "-B", tmp_path / "build", "-DLSGP_PYTHON=OFF", *only_here, **names, PATH=str(tmp_path))
    assert done.returncode != 0
    said = " ".join(done.stderr.split())
    wanted = "x86_64-linux-gnu-none" if asked else "c++, CC, g++, aCC, xlC, icpx, icpc, clang++"
    assert "A C++ compiler is needed to build lsgp" in said and wanted in said
    if os.path.exists("/etc/debian_version"):
        assert "This installs one: apt-get install g++" in said


def test_without_headers_of_python_the_build_stops_with_the_command_that_installs_them(tmp_path):
    python = [f"-DPython_EXECUTABLE={sys.executable}", f"-DCMAKE_IGNORE_PATH={sysconfig.get_path('include')}"]
    done = cmake("-S", ROOT, "-B", tmp_path / "build", *python)
    assert done.returncode != 0
    said = " ".join(done.stderr.split())
    assert "The headers of Python (Python.h) are needed" in said
    if os.path.exists("/etc/debian_version"):
        assert "This installs them for the system's own Python: apt-get install python3-dev" in said


def test_without_an_interpreter_nothing_is_said_of_headers(tmp_path):
    done = cmake("-S", ROOT, "-B", tmp_path / "build", f"-DPython_EXECUTABLE={tmp_path / 'python'}")
    assert done.returncode != 0
    assert "Could NOT find Python" in done.stderr and "Python.h" not in done.stderr
