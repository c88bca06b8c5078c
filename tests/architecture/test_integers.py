# SPDX-License-Identifier: GPL-3.0-or-later
"""Sizes and indices have 64 bits on every system: a long has 32 on Windows."""

import re

from rooms import ROOT


def test_no_source_has_a_long():
    sources = list((ROOT / "native").rglob("*.[ch]pp"))
    assert len(sources) > 100
    found = {}
    for path in sources:
        code = re.sub(r"//.*|\"(?:[^\"\\]|\\.)*\"|\blong long\b", "", path.read_text(encoding="utf-8"))
        if lines := [line.strip() for line in code.splitlines() if re.search(r"\blong\b", line)]:
            found[path.relative_to(ROOT).as_posix()] = lines
    assert found == {}
