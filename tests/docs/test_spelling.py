# SPDX-License-Identifier: GPL-3.0-or-later
"""Names, comments, messages and pages have American spelling, as the APIs of Blender, numpy and Eigen do."""

import re
from pathlib import Path

ROOT = Path(__file__).parents[2]
FOLDERS = ("addon", "docs", "examples", "native", "tests", "tools")
SUFFIXES = {".py", ".pyi", ".cpp", ".hpp", ".md", ".txt", ".toml", ".yml", ".js", ""}
# "Cancelled", as in Python's CancelledError, is the spelling of the error, and so of the word.
BRITISH = re.compile(
    r"colour|behaviour|neighbour|favour|honour|\bgrey|centre|centring|\bmetres?\b|licence|catalogue|artefact|judgement"
    r"|(label|model|travel|signal|bevel|tunnel|channel|level)l(ed|ing|er)(?![a-z])|\bfulfils?\b|\b(to|after)wards\b"
    r"|(minim|maxim|optim|normal|real|regular|organ|recogn|factor|initial|serial|equal|util"
    r"|summar|general|visual|parameter|synchron)is(e|ed|es|er|ers|ing|ation|ations)\b",
    re.IGNORECASE,
)


def lines_of_the_project():
    paths = [path for folder in FOLDERS for path in (ROOT / folder).rglob("*")]
    for path in [*paths, *ROOT.glob("*.md"), ROOT / "CITATION.cff", ROOT / "CMakeLists.txt"]:
        if path.is_file() and path.suffix in SUFFIXES and path != Path(__file__) and "__pycache__" not in path.parts:
            text = path.read_bytes()
            if b"\0" not in text:
                for number, line in enumerate(text.decode("utf-8", "replace").splitlines(), start=1):
                    yield f"{path.relative_to(ROOT)}:{number}", line


def test_spelling_is_american():
    found = [f"{where}: {match[0]}" for where, line in lines_of_the_project() for match in BRITISH.finditer(line)]
    assert not found, "\n".join(found)
