# SPDX-License-Identifier: GPL-3.0-or-later
"""The loops of the C++ sources whose number of rounds their head does not tell."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

KEYWORD = re.compile(r"\b(for|while) \(")
# A comparison of what each round moves on, alone or as one of several conditions that all have to hold.
CONDITION = re.compile(r"(\w+)(?: \+ \d+)? (?:<|<=|>|>=|!=) [^&|]*|(\w+)-- > \d+|it")
STEP = re.compile(r"(?:\+\+|--)(\w+)(?:, .*)?|(\w+) [+-]= \w+")


def without_comments(source: str) -> str:
    return re.sub(r'"(?:\\.|[^"\\\n])*"|//[^\n]*', lambda found: '""' if found[0][0] == '"' else "", source)


def heads(source: str) -> Iterator[str]:
    """Heads of loops, blanks as one, in their order."""
    source = without_comments(source)
    for found in KEYWORD.finditer(source):
        depth, end = 1, found.end()
        while depth:
            depth += {"(": 1, ")": -1}.get(source[end], 0)
            end += 1
        yield " ".join(source[found.start() : end].split())


def is_counted(head: str) -> bool:
    if head.startswith("while"):
        return False
    parts = head[head.index("(") + 1 : -1].split(";")
    if len(parts) == 1:
        return True  # over a range
    step = STEP.fullmatch(parts[2].strip())
    moved = step and (step[1] or step[2])
    for condition in [] if "||" in parts[1] else parts[1].split("&&"):
        found = CONDITION.fullmatch(condition.strip())
        if found and (found[2] or moved in (found[1], found[0])):
            return True
    return False


def open_loops(root: Path) -> list[tuple[str, str]]:
    """(file, head) of loops that are neither over a range nor counted, in order."""
    found = []
    for path in sorted([*root.rglob("*.cpp"), *root.rglob("*.hpp")]):
        for head in heads(path.read_text(encoding="utf-8")):
            if not is_counted(head):
                found.append((path.relative_to(root).as_posix(), head))
    return found
