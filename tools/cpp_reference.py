# SPDX-License-Identifier: GPL-3.0-or-later
"""The reference of the C++ library: HTML of the public headers by Doxygen, whose warnings are errors.

    python tools/cpp_reference.py FOLDER             writes it into the folder
    python tools/cpp_reference.py --filter HEADER    prints a header as Doxygen reads it

The headers have ordinary comments. Doxygen reads them through this program, which marks those that document something.
"""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
HEADERS = ROOT / "native" / "include" / "lsgp"
COMMENT = re.compile(r"(\s*)// ?(.*)")
TRAILING = re.compile(r"(\s*)([^\s}#/].*?)\s+// (.*)")
GROUP = re.compile(r"\w+")  # a heading among enumerators
PARAMETER = re.compile(r"([a-z_]+): (.*)")

START = r"""/** \mainpage
All names are in the namespace #lsgp, and `#include <lsgp/lsgp.hpp>` declares them. Begin with lsgp::Surface, the input,
lsgp::parameterize, which computes a map, and lsgp::Result; lsgp::Solver computes many maps of one surface. Every
function throws lsgp::Error.

Pages on [cones](../../explanation/what-a-cone-is.html), [the algorithm](../../explanation/algorithm.html) and
[building the library](../../how-to/developing.html) are in [the documentation](../../index.html) that this reference
is a part of. */
"""

SETTINGS = """
PROJECT_NAME = "Cone Unwrap: C++"
PROJECT_NUMBER = {version}
INPUT = {headers} {start}
EXCLUDE = {headers}/export.hpp
STRIP_FROM_PATH = {include}
STRIP_FROM_INC_PATH = {include}
INPUT_FILTER = "{python} {program} --filter"
OUTPUT_DIRECTORY = {folder}
HTML_OUTPUT = .
GENERATE_LATEX = NO
QUIET = YES
WARN_AS_ERROR = FAIL_ON_WARNINGS
EXTRACT_ALL = YES
JAVADOC_AUTOBRIEF = YES
WARN_IF_INCOMPLETE_DOC = NO
SORT_MEMBER_DOCS = NO
SHOW_USED_FILES = NO
TYPEDEF_HIDES_STRUCT = YES
MACRO_EXPANSION = YES
EXPAND_ONLY_PREDEF = YES
PREDEFINED = LSGP_API=
CLASS_GRAPH = NO
INCLUDE_GRAPH = NO
INCLUDED_BY_GRAPH = NO
HAVE_DOT = NO
HTML_TIMESTAMP = NO
HTML_COLORSTYLE_HUE = 18
HTML_COLORSTYLE_SAT = 60
"""


def documented(header: str) -> Iterator[str]:
    """The lines of a header with its comments marked for Doxygen."""
    lines = header.splitlines()
    start = lines.index("#pragma once")
    head = [line.removeprefix("//").strip() for line in lines[1:start]]  # the first line is the license
    yield from ("/// \\file", *(f"/// {line}" for line in head))
    at = start
    while at < len(lines):
        if COMMENT.fullmatch(lines[at]):
            end = next(i for i in range(at, len(lines) + 1) if i == len(lines) or not COMMENT.fullmatch(lines[i]))
            yield from _block(lines[at:end], _declaration(lines[end:]))
            at = end
        elif trailing := TRAILING.fullmatch(lines[at]):
            indent, code, said = trailing.groups()
            yield f"{indent}{code} ///< {said}"
            at += 1
            while at < len(lines) and (more := COMMENT.fullmatch(lines[at])) and len(more[1]) > len(indent):
                yield f"{more[1]}///< {more[2]}"
                at += 1
        else:
            yield lines[at]
            at += 1


def _declaration(lines: list[str]) -> str:
    """What the lines begin with, up to its end or its body."""
    return re.split(r";|\{$", "\n".join(lines), maxsplit=1, flags=re.MULTILINE)[0]


def _block(comments: list[str], declaration: str) -> Iterator[str]:
    """Comments before a declaration: parameters that begin a line have a paragraph of their own."""
    for line in comments:
        indent, said = COMMENT.fullmatch(line).groups()
        parameter = PARAMETER.fullmatch(said)
        if GROUP.fullmatch(said):
            yield line
        elif parameter and re.search(rf"[(,][^,]*\b{parameter[1]}\b", declaration):
            yield f"{indent}/// \\param {parameter[1]} {parameter[2]}"
        elif said.startswith("Throws "):
            yield f"{indent}///\n{indent}/// {said}"
        else:
            yield f"{indent}/// {said}"


def is_possible() -> bool:
    """Whether Doxygen is installed."""
    return shutil.which("doxygen") is not None


def page_of(header: str) -> str:
    """Doxygen's page of a header."""
    return header.replace("_", "__") + "_8hpp.html"


def write(folder: Path) -> None:
    """Writes the reference into an existing folder; RuntimeError with Doxygen's words if it warns of anything."""
    version = re.search(
        r'^version = "(.*)"$', (ROOT / "blender_manifest.toml").read_text(encoding="utf-8"), re.MULTILINE
    )
    with tempfile.TemporaryDirectory() as temporary:
        start = Path(temporary) / "start.dox"
        start.write_text(START, encoding="utf-8")
        settings = SETTINGS.format(
            version=version[1],
            headers=HEADERS,
            include=HEADERS.parent,
            start=start,
            python=sys.executable,
            program=Path(__file__).resolve(),
            folder=folder,
        )
        done = subprocess.run(["doxygen", "-"], input=settings, capture_output=True, text=True, check=False)
    if done.returncode != 0 or "warning:" in done.stderr:
        raise RuntimeError(f"Doxygen refuses the headers:\n{done.stderr}")


def main() -> None:
    if sys.argv[1] == "--filter":
        header = Path(sys.argv[2]).read_text(encoding="utf-8")
        print(*(documented(header) if sys.argv[2].endswith(".hpp") else header.splitlines()), sep="\n")
    else:
        folder = Path(sys.argv[1])
        folder.mkdir(parents=True, exist_ok=True)
        write(folder)


if __name__ == "__main__":
    main()
