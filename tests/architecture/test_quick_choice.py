# SPDX-License-Identifier: GPL-3.0-or-later
"""What tools/test --quick leaves out leaves tests of everything: half of those of each folder are not marked slow."""

import ast
from pathlib import Path

import pytest
from rooms import ROOT

TESTS = ROOT / "tests"
FOLDERS = sorted({path.parent for path in TESTS.rglob("test_*.py")})
LEFT_OUT = {"pytest.mark.slow", "pytest.mark.nightly"}


def left_out_in(path: Path) -> list[bool]:
    """Of each test function of a file, whether it is left out."""
    module = ast.parse(path.read_text(encoding="utf-8"))
    everything = any(
        isinstance(node, ast.Assign) and ast.unparse(node) == "pytestmark = pytest.mark.slow" for node in module.body
    )
    return [
        everything or any(ast.unparse(decorator) in LEFT_OUT for decorator in node.decorator_list)
        for node in ast.walk(module)
        if isinstance(node, ast.FunctionDef) and node.name.startswith("test_")
    ]


@pytest.mark.parametrize("folder", FOLDERS, ids=lambda folder: folder.relative_to(TESTS).as_posix())
def test_half_of_a_folder_is_quick(folder: Path) -> None:
    left_out = [is_left_out for path in folder.glob("test_*.py") for is_left_out in left_out_in(path)]
    assert left_out.count(False) >= left_out.count(True)
