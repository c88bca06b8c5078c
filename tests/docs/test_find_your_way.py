# SPDX-License-Identifier: GPL-3.0-or-later
"""Each question of the page ends in one file and one function that is defined there."""

import re

import pytest
from code_blocks import ROOT

PAGE = (ROOT / "docs" / "how-to" / "find-your-way.md").read_text(encoding="utf-8")
QUESTIONS = {text.splitlines()[0]: text.rstrip().splitlines()[-1] for text in PAGE.split("\n## ")[1:]}
PLACE = re.compile(r"→ `([^`]+)`, `(\w+)`")
DEFINITIONS = {
    ".py": r"^(?:def|class) {name}\b|^{name}\b.*=",
    # A function's or member's definition begins a line and has no semicolon before its body; a class has members.
    ".cpp": r"^[^\s/].*\b{name}\([^;]*\{{|^(?:class|struct) {name}\b|^.*\b{name}(?:<\w+>)?::\w+\([^;]*\{{",
}


def test_ten_questions_are_asked():
    assert len(QUESTIONS) == 10
    assert all(question.endswith("?") for question in QUESTIONS)


@pytest.mark.parametrize("question", QUESTIONS)
def test_a_question_ends_in_a_function_that_exists(question):
    place = PLACE.fullmatch(QUESTIONS[question])
    assert place is not None, f"the last line is {QUESTIONS[question]!r}"
    path = ROOT / place[1]
    assert path.is_file()
    definition = DEFINITIONS[path.suffix].format(name=place[2])
    assert re.search(definition, path.read_text(encoding="utf-8"), re.MULTILINE), f"{place[1]} has no {place[2]}"


@pytest.mark.parametrize("name", re.findall(r"`((?:addon|native|tests|tools|docs)/[^`]+)`", PAGE))
def test_files_that_are_named_exist(name):
    assert (ROOT / name).is_file()
