# SPDX-License-Identifier: GPL-3.0-or-later
"""What the run with sanitizers leaves out."""

from __future__ import annotations

import pytest


def many_solves(*cases: object) -> list[object]:
    """Parameters of a test, tuples where it has several, with the marker of that name."""
    return [
        pytest.param(*(case if isinstance(case, tuple) else (case,)), marks=pytest.mark.many_solves) for case in cases
    ]
