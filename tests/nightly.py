# SPDX-License-Identifier: GPL-3.0-or-later
"""Cases that LSGP_FULL_SWEEP=1 adds, as in tools/nightly, to a sample that runs at every change."""

from __future__ import annotations

import os
from collections.abc import Iterable

import pytest

EVERYTHING = os.environ.get("LSGP_FULL_SWEEP") == "1"


def nightly(*cases: object, marks: Iterable[pytest.MarkDecorator] = ()) -> list[object]:
    """Parameters of a test, tuples where it has several, with the marker of that name and others."""
    marks = (pytest.mark.nightly, *marks)
    return [pytest.param(*(case if isinstance(case, tuple) else (case,)), marks=marks) for case in cases]


def some_nightly(cases: Iterable[object], *left_out: object) -> list[object]:
    """The same parameters, some of them with that marker."""
    cases = list(cases)
    assert all(case in cases for case in left_out)
    return [case for case in cases if case not in left_out] + nightly(*left_out)


def leave_out_nightly(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Deselect what has that marker, unless everything runs."""
    left_out = [] if EVERYTHING else [item for item in items if item.get_closest_marker("nightly")]
    if left_out:
        config.hook.pytest_deselected(items=left_out)
        items[:] = [item for item in items if not item.get_closest_marker("nightly")]
