# SPDX-License-Identifier: GPL-3.0-or-later
"""The library compiles with the compiler and the Eigen of the newest system there is, without a warning.

No code is made, which would take minutes; `tools/test_all_blenders` builds the whole wheel there and tests it. A few of
the folders are compiled at every change, which takes seconds, and all with LSGP_FULL_SWEEP=1.
"""

import json
import os
import shlex
import shutil
import subprocess
import sys

import pytest
from blenders import ROOT, chroots, leave_out
from nightly import EVERYTHING

REAL_BLENDER = ROOT.parent / "shared" / "tools" / "real-blender"
BUILD = ROOT / "build" / "newest_compiler"  # which the chroot sees
OPTIONS = ("-DLSGP_PYTHON=OFF", "-DCMAKE_UNITY_BUILD=ON", "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON", "-DLSGP_WERROR=ON")


def compile_options() -> list[list[str]]:
    """What follows the compiler's name in the commands that compile the library, without those about their output."""
    cmake = shutil.which("cmake", path=f"{os.path.dirname(sys.executable)}{os.pathsep}{os.environ['PATH']}")
    if cmake is None:
        pytest.skip("no cmake; install it here, as with: pip install cmake")
    subprocess.run([cmake, "-S", ROOT, "-B", BUILD, *OPTIONS], check=True, capture_output=True)
    found = []
    for entry in json.loads((BUILD / "compile_commands.json").read_text(encoding="utf-8")):
        words = shlex.split(entry["command"])
        first = next(place for place, word in enumerate(words) if word.startswith("-"))
        output = words.index("-o")
        found.append([*words[first:output], *words[output + 2 :]])
    return found


def test_library_compiles_with_the_newest_compiler_and_eigen():
    if not chroots():
        leave_out("no system beside ours; set BLENDER_CHROOTS")
    sources = compile_options()
    assert len(sources) > 20
    commands = [shlex.join(["c++", *options, "-fsyntax-only"]) for options in sources[:: 1 if EVERYTHING else 6]]
    script = "\n".join(["set -e", *commands])
    done = subprocess.run(
        [str(REAL_BLENDER), "run", chroots()[-1], "-c", script],
        cwd=ROOT,
        env={**os.environ, "BLENDER_EXE": "sh"},
        capture_output=True,
        text=True,
        timeout=1500,
        check=False,
    )
    assert done.returncode == 0, done.stderr
