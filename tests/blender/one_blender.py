# SPDX-License-Identifier: GPL-3.0-or-later
"""What runs in one Blender only when all of tools/test runs."""

from __future__ import annotations

import pytest


def one_blender(*cases: object) -> list[object]:
    """Parameters of a test, tuples where it has several, with the marker of that name."""
    return [
        pytest.param(*(case if isinstance(case, tuple) else (case,)), marks=pytest.mark.one_blender) for case in cases
    ]
