# SPDX-License-Identifier: GPL-3.0-or-later
"""pytest imports test files by their bare names, so that two of one name cannot run in one session."""

from collections import Counter

from rooms import ROOT


def test_no_two_test_files_share_a_name() -> None:
    names = Counter(path.name for path in (ROOT / "tests").rglob("test_*.py"))
    assert len(names) > 100
    assert [name for name, count in names.items() if count > 1] == []
