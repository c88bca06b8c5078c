# SPDX-License-Identifier: GPL-3.0-or-later
"""Every code block of README.md and docs/ does what it says.

The blocks of a document run one after the other in one folder, which has examples/model.obj to begin with, the same as
model.obj, and a folder library with a small ball; Python blocks share their variables and find `positions` and
`triangles` of the model. Blocks for Blender's Python are run by tests/blender/extension/test_documented_scripts.py;
those that import a package that is not installed, or say in a line that they take it, are left out, and the test of
their document then counts as skipped.
"""

import contextlib
import os
import re
import shutil
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import lsgp
import meshes
import numpy as np
import pytest
from code_blocks import LEFT_OUT, ROOT, Block, blocks_of, documents, require_shown

MODEL = ROOT / "examples" / "model.obj"
LANGUAGES = {"sh", "python", "pycon", "text", "cpp", "cmake", "mermaid"}


def names(paths: list[Path]) -> list[str]:
    return [path.relative_to(ROOT).as_posix() for path in paths]


@pytest.mark.parametrize("document", documents(), ids=names(documents()))
def test_blocks_say_what_they_are_and_why_they_are_left_out(document):
    for block in blocks_of(document):
        where = f"{document}:{block.line}"
        assert block.language in LANGUAGES, where
        assert block.runs or len(block.text.splitlines()[0]) > len(LEFT_OUT) + 8, f"{where}: say why"
    indented = [line for line in document.read_text(encoding="utf-8").splitlines() if line.startswith("    ")]
    indented = [line for line in indented if not line.lstrip().startswith("![")]  # pictures of a list's items
    prose = [line for line in indented if not any(line in block.text for block in blocks_of(document))]
    assert prose == [], "code is put between fences, where this test sees it"


@pytest.mark.slow
@pytest.mark.parametrize("document", documents(), ids=names(documents()))
def test_blocks_run_and_print_what_is_shown(document, tmp_path):
    (tmp_path / "examples").mkdir()
    for folder in (tmp_path, tmp_path / "examples"):
        shutil.copy(MODEL, folder)
    model = lsgp.read_mesh_file(MODEL)
    (tmp_path / "library").mkdir()
    write_obj(tmp_path / "library" / "small.obj", meshes.bumpy_sphere(1))
    variables = {"__name__": "example", "positions": model.mesh.positions, "triangles": model.triangulation.triangles}
    printed: str | None = ""
    missing: set[str] = set()
    for block in blocks_of(document):
        if block.runs and not block.in_blender and (needed := not_installed(block)):
            missing |= needed
            printed = None
        elif block.language == "text" and printed is None:
            continue
        elif block.language == "text":
            require_shown(block, printed, document)
        elif not block.runs or block.in_blender or block.language in {"cpp", "cmake", "mermaid", "pycon"}:
            printed = ""
        elif block.language == "sh":
            printed = run_in_shell(block, tmp_path, document)
        else:
            printed = run_python(block, variables, tmp_path, document)
    if missing:
        pytest.skip(f"all other blocks are fine; some take {', '.join(sorted(missing))}")


def not_installed(block: Block) -> set[str]:
    """The packages that the block imports, or says it takes, and that are not there."""
    names = re.findall(r"^import (\w+)", block.text, re.MULTILINE) if block.language == "python" else []
    names += re.findall(r"^# takes the package (\w+)$", block.text, re.MULTILINE)
    return {name for name in names if find_spec(name) is None}


def write_obj(path: Path, mesh: meshes.Mesh) -> None:
    lines = [f"v {x} {y} {z}" for x, y, z in mesh.positions.tolist()]
    lines += [f"f {a} {b} {c}" for a, b, c in (np.asarray(mesh.triangles) + 1).tolist()]
    path.write_text("\n".join(lines) + "\n")


def run_in_shell(block: Block, folder: Path, document: Path) -> str:
    """What the commands print to either stream; each has to succeed."""
    programs = Path(sys.executable).parent
    environment = {**os.environ, "PATH": f"{programs}{os.pathsep}{os.environ['PATH']}"}
    bash = shutil.which("bash")
    assert bash is not None
    done = subprocess.run(
        [bash, "-eu", "-o", "pipefail", "-c", block.text],
        cwd=folder,
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        timeout=120,
        check=False,
    )
    assert done.returncode == 0, f"{document}:{block.line} ends with {done.returncode}:\n{done.stdout}"
    return done.stdout


def run_python(block: Block, variables: dict, folder: Path, document: Path) -> str:
    """What the block prints, run in this process with these variables, in this folder."""
    # Lines of a traceback are those of the document.
    code = compile("\n" * (block.line - 1) + block.text, str(document), "exec")
    with contextlib.chdir(folder), pytest.MonkeyPatch.context() as patch:
        printed: list[str] = []
        patch.setitem(variables, "print", lambda *values: printed.append(" ".join(map(str, values))))
        exec(code, variables)
    return "\n".join(printed)
