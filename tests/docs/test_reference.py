# SPDX-License-Identifier: GPL-3.0-or-later
"""The reference in docs/ is complete and agrees with the code."""

import inspect
import re

import lsgp
import reference
from code_blocks import ROOT
from lsgp import errors


def test_parts_that_follow_from_the_code_are_up_to_date():
    for path, text in reference.documents().items():
        assert path.read_text(encoding="utf-8") == text, "run: python tools/reference.py"


def test_every_public_name_is_there_once():
    named = [name for part in reference.parts() if part.startswith("python ") for name in part.split()[1:]]
    assert sorted(named) == sorted(lsgp.__all__)


def test_signatures_say_what_is_passed_by_name_only():
    page = (reference.DOCS / "reference" / "python.md").read_text(encoding="utf-8")
    functions = {f"lsgp.{name}": getattr(lsgp, name) for name in lsgp.__all__ if inspect.isroutine(getattr(lsgp, name))}
    assert len(functions) > 10
    for name, function in functions.items():
        shown = re.search(rf"^`{re.escape(name)}\((.*)\)(?: -> .*)?`$", page, re.MULTILINE)[1]
        parameters = inspect.getfullargspec(function)
        assert bool(parameters.kwonlyargs) == ("*" in shown.split(", ")), name
        for keyword in parameters.kwonlyargs:
            assert re.search(rf"\*, .*\b{keyword}\b", shown), (name, keyword)
        for positional in parameters.args:
            assert re.search(rf"\b{positional}\b", shown.split("*, ")[0]), (name, positional)


def test_every_command_is_there_once():
    assert sorted(part for part in reference.parts() if part.startswith("lsgp")) == sorted(reference.commands())


def test_every_public_name_has_a_docstring_that_is_its_own():
    for name in lsgp.__all__:
        said = getattr(lsgp, name).__doc__
        assert said and not said.startswith(f"{name}("), name
        assert said != inspect.getdoc(errors.LsgpError) or name == "LsgpError"


CODE_ROW = re.compile(r"^\| `([A-Z][A-Z_]+)` \|(.*)\|(.*)\|$", re.MULTILINE)


def documented_codes() -> dict[str, tuple[str, str]]:
    """Cause and remedy by code, of the guide's tables."""
    text = (ROOT / "docs" / "how-to" / "troubleshooting.md").read_text(encoding="utf-8")
    rows = CODE_ROW.findall(text)
    assert len(rows) == len({code for code, _, _ in rows}), "a code is there twice"
    return {code: (cause.strip(), remedy.strip()) for code, cause, remedy in rows}


def codes_of_the_library() -> set[str]:
    """Codes of errors.hpp, and those that Python raises by itself."""
    header = (ROOT / "native" / "include" / "lsgp" / "errors.hpp").read_text(encoding="utf-8")
    enum = re.search(r"enum class Code \{(.*?)\};", header, re.DOTALL)[1]
    codes = {name.upper() for name in re.findall(r"^\s+([a-z]\w*),", enum, re.MULTILINE)}
    raised = re.compile(r'(?:Error|Finding|Refused|refuse|Cancelled)\(\s*"([A-Z][A-Z_]+)"')
    for folder in (ROOT / "native" / "lsgp", ROOT / "addon"):
        for path in folder.rglob("*.py"):
            codes |= set(raised.findall(path.read_text(encoding="utf-8")))
    return codes


def test_the_guide_has_cause_and_remedy_of_every_code_and_of_no_other():
    rows = documented_codes()
    assert set(rows) == codes_of_the_library()
    for code, (cause, remedy) in rows.items():
        assert len(cause.split()) >= 4 and len(remedy.split()) >= 3, code
