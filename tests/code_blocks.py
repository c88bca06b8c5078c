# SPDX-License-Identifier: GPL-3.0-or-later
"""The code blocks of the documentation, for the tests that run them.

Fences say what a block is: ```sh for the shell, ```python, ```text for what the block before prints, in excerpts;
```cpp, ```cmake and ```mermaid are not run. A block whose first line is "# not run by the tests: WHY" is left alone; a
Python block that imports bpy is run inside Blender.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
LEFT_OUT = "# not run by the tests: "


@dataclass(frozen=True)
class Block:
    """language: after the fence. line: of its first line in the file, from 1."""

    language: str
    text: str
    line: int

    @property
    def runs(self) -> bool:
        return not self.text.startswith(LEFT_OUT)

    @property
    def in_blender(self) -> bool:
        return self.language == "python" and re.search(r"^import bpy$", self.text, re.MULTILINE) is not None


def documents() -> list[Path]:
    return [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]


def blocks_of(document: Path) -> list[Block]:
    """The fenced blocks in their order.  Raises ValueError for one that is not closed."""
    blocks: list[Block] = []
    lines: list[str] | None = None
    begin, language = 0, ""
    for number, line in enumerate(document.read_text(encoding="utf-8").splitlines(), 1):
        if not line.startswith("```"):
            if lines is not None:
                lines.append(line)
        elif lines is None:
            begin, language, lines = number + 1, line[3:].strip(), []
        else:
            blocks.append(Block(language, "\n".join(lines) + "\n", begin))
            lines = None
    if lines is not None:
        raise ValueError(f"{document}:{begin}: the block does not end")
    return blocks


def require_shown(block: Block, printed: str, document: Path) -> None:
    """The lines of the block are printed, in this order; others may stand between them."""
    said = iter(printed.splitlines())
    for number, line in enumerate(block.text.splitlines(), block.line):
        assert any(same_line(line, other) for other in said), f"{document}:{number} is not printed; this is:\n{printed}"


def same_line(shown: str, printed: str) -> bool:
    """The same words and, up to a hundredth or a mere rounding error, the same numbers."""
    both = shown.split(), printed.split()
    return len(both[0]) == len(both[1]) and all(map(same_word, *both))


def same_word(shown: str, printed: str) -> bool:
    if shown == printed:
        return True
    try:
        a, b = float(shown), float(printed)
    except ValueError:
        return False
    return abs(a - b) <= 1e-2 * abs(b) or max(abs(a), abs(b)) < 1e-11
