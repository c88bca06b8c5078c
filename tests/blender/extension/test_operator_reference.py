# SPDX-License-Identifier: GPL-3.0-or-later
"""The page on the operators has every operator of the extension with all its arguments."""

import sys
from pathlib import Path

import bpy
from installed import addon

sys.path.append(str(Path(__file__).resolve().parents[3] / "tools"))
import reference_operators


def test_page_is_what_this_blender_says_of_the_operators():
    operators = [cls for cls in addon.registration.CLASSES if issubclass(cls, bpy.types.Operator)]
    assert len(operators) > 20
    written = reference_operators.PAGE.read_text(encoding="utf-8")
    assert written == reference_operators.page(operators), "run: python tools/reference_operators.py"
