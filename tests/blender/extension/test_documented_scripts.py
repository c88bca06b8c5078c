# SPDX-License-Identifier: GPL-3.0-or-later
"""Every block of the documentation that imports bpy runs in this Blender."""

import sys
from pathlib import Path

import bpy
import pytest

sys.path.append(str(Path(__file__).resolve().parents[2]))
from code_blocks import ROOT, blocks_of, documents

pytestmark = pytest.mark.slow

BLOCKS = [
    pytest.param(document, block, id=f"{document.relative_to(ROOT).as_posix()}:{block.line}")
    for document in documents()
    for block in blocks_of(document)
    if block.in_blender and block.runs
]


def test_there_are_such_blocks():
    assert BLOCKS


@pytest.mark.one_blender
@pytest.mark.parametrize("document, block", BLOCKS)
def test_script_runs(document, block):
    try:
        exec(compile("\n" * (block.line - 1) + block.text, str(document), "exec"), {"__name__": "example"})
    finally:
        if bpy.context.object is not None and bpy.context.object.mode != "OBJECT":
            bpy.ops.object.mode_set(mode="OBJECT")
