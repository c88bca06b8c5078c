# SPDX-License-Identifier: GPL-3.0-or-later
"""Each command's help ends with three examples, and its parser accepts them."""

import shlex

import pytest
import reference
from lsgp.cli.command import _parser
from lsgp.cli.examples import EXAMPLES

WIDTH = 80


def test_every_command_has_three_examples():
    assert {f"lsgp {name}" for name in EXAMPLES} == set(reference.commands()) - {"lsgp"}
    assert all(len(set(examples)) == 3 for examples in EXAMPLES.values())


@pytest.mark.parametrize("name", EXAMPLES)
def test_the_help_shows_them_line_by_line(name, monkeypatch):
    monkeypatch.setenv("COLUMNS", str(WIDTH))
    text = reference.commands()[f"lsgp {name}"].format_help()
    lines = text.splitlines()
    begin = lines.index("examples:")
    assert [line.strip() for line in lines[begin + 1 : begin + 4]] == list(EXAMPLES[name])
    assert max(map(len, EXAMPLES[name])) <= WIDTH - 2


@pytest.mark.parametrize("example", [example for examples in EXAMPLES.values() for example in examples])
def test_the_parser_accepts_them(example):
    program, command, *arguments = shlex.split(example)
    assert program == "lsgp"
    assert _parser().parse_args([command, *arguments]).command == command
