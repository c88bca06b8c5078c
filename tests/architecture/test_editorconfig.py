# SPDX-License-Identifier: GPL-3.0-or-later
"""The text files follow .editorconfig; ruff and clang-format check the length of lines and the indentation."""

import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from rooms import ROOT

FOLDERS = ("addon", "docs", "examples", "native", "tests", "tools")
KEEP_SPACES = {".svg"}  # trim_trailing_whitespace = false


def text_files() -> Iterator[Path]:
    paths = [path for path in ROOT.iterdir() if path.suffix in {".md", ".txt", ".toml", ".cff"}]
    for folder in FOLDERS:
        paths += (ROOT / folder).rglob("*")
    for path in sorted(paths):
        if path.is_file() and "__pycache__" not in path.parts and b"\0" not in path.read_bytes():
            yield path


def deviations(content: bytes, suffix: str) -> list[str]:
    try:
        text = content.decode("utf-8")
    except UnicodeDecodeError:
        return ["not UTF-8"]
    out = ["lines that do not end in LF"] if "\r" in text else []
    if text and not text.endswith("\n"):
        out.append("no final newline")
    if suffix not in KEEP_SPACES and re.search(r"[ \t]$", text, re.MULTILINE):
        out.append("trailing whitespace")
    if re.search(r"^ *\t", text, re.MULTILINE):
        out.append("tabs")
    return out


def test_text_files_follow_it() -> None:
    files = list(text_files())
    assert len(files) > 500
    found = {path.relative_to(ROOT).as_posix(): deviations(path.read_bytes(), path.suffix) for path in files}
    assert {name: of for name, of in found.items() if of} == {}


@pytest.mark.parametrize(
    ("content", "deviation"),
    [
        (b"a", "no final newline"),
        (b"a\r\n", "lines that do not end in LF"),
        (b"a \nb\n", "trailing whitespace"),
        (b"\ta\n", "tabs"),
        (b"\xff\n", "not UTF-8"),
    ],
)
def test_a_deviation_is_found(content: bytes, deviation: str) -> None:
    assert deviation in deviations(content, ".py")
