# SPDX-License-Identifier: GPL-3.0-or-later
"""The algorithm page names every source file, and only functions and tests that exist."""

import re

from code_blocks import ROOT

PAGE = (ROOT / "docs" / "explanation" / "algorithm.md").read_text(encoding="utf-8")
SOURCES = ROOT / "native" / "src"
ROWS = [line.strip("| ").split(" | ") for line in PAGE.splitlines() if re.match(r"\|.*`\w+\.py` \|$", line)]


def test_every_source_file_is_in_a_table():
    named = {name for row in ROWS for name in re.findall(r"`([\w/]+\.cpp)`", row[-2])}
    assert named == {path.relative_to(SOURCES).as_posix() for path in SOURCES.rglob("*.cpp")}


def test_functions_are_where_the_tables_say():
    for row in ROWS:
        for place in row[-2].split("; "):
            (file, *functions) = re.findall(r"`([^`]+)`", place)
            path = SOURCES / file
            text = path.read_text(encoding="utf-8")
            if path.with_suffix(".hpp").exists():
                text += path.with_suffix(".hpp").read_text(encoding="utf-8")
            for function in functions:
                assert re.search(rf"\b{function}\b", text), f"{file} has no {function}"


def test_tests_of_the_tables_exist():
    names = {path.name for path in (ROOT / "tests").rglob("test_*.py")}
    assert {name for row in ROWS for name in re.findall(r"`(\w+\.py)`", row[-1])} <= names
