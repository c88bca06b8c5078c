# SPDX-License-Identifier: GPL-3.0-or-later
"""The documentation as a site: it builds without a warning, and its lists are complete."""

import os
import re
import subprocess
import sys

import cpp_reference
import pytest
from code_blocks import ROOT

DOCS = ROOT / "docs"
HEADERS = ROOT / "native" / "include" / "lsgp"
# export.hpp declares nothing.
PUBLIC_HEADERS = sorted(path.stem for path in HEADERS.glob("*.hpp") if path.stem != "export")
needs_doxygen = pytest.mark.skipif(not cpp_reference.is_possible(), reason="takes doxygen")


@pytest.mark.slow
@needs_doxygen
def test_site_builds_without_a_warning(tmp_path):
    pytest.importorskip("material", reason="takes mkdocs-material")
    command = [sys.executable, "-m", "mkdocs", "build", "--strict", "--site-dir", str(tmp_path / "site")]
    environment = os.environ | {"NO_MKDOCS_2_WARNING": "1"}
    done = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0 and "WARNING" not in done.stderr, done.stderr
    assert (tmp_path / "site" / "examples" / "model.obj").read_bytes() == (ROOT / "examples" / "model.obj").read_bytes()
    pages = {path.relative_to(DOCS).with_suffix(".html").as_posix() for path in DOCS.rglob("*.md")}
    pages = pages - {"README.html"} | {"index.html"}
    assert pages <= {path.relative_to(tmp_path / "site").as_posix() for path in (tmp_path / "site").rglob("*.html")}
    cpp = (tmp_path / "site" / "reference" / "cpp.html").read_text(encoding="utf-8")
    for header in PUBLIC_HEADERS:
        page = cpp_reference.page_of(header)
        assert f'href="cpp/{page}"' in cpp, header
        assert (tmp_path / "site" / "reference" / "cpp" / page).is_file(), header


@needs_doxygen
def test_reference_of_cpp_has_every_function_with_its_comment(tmp_path):
    cpp_reference.write(tmp_path)
    page = (tmp_path / "lsgp_8hpp.html").read_text(encoding="utf-8")
    header = (HEADERS / "lsgp.hpp").read_text(encoding="utf-8")
    functions = re.findall(r"^LSGP_API .*?(\w+)\(", header, re.MULTILINE)
    assert len(functions) >= 10
    for function in functions:
        assert re.search(rf">(?:lsgp::)?{function}</a>.*\n.*mdescRight", page), f"{function} has no description"


@needs_doxygen
def test_reference_of_cpp_refuses_a_comment_that_doxygen_warns_of(tmp_path, monkeypatch):
    headers = tmp_path / "include" / "lsgp"
    headers.mkdir(parents=True)
    (headers / "wrong.hpp").write_text("// License.\n#pragma once\n\n// What \\ref no_such_name does.\nvoid f();\n")
    monkeypatch.setattr(cpp_reference, "HEADERS", headers)
    with pytest.raises(RuntimeError, match="no_such_name"):
        cpp_reference.write(tmp_path)


def test_page_of_cpp_has_every_header_and_shows_programs_that_are_tested():
    page = (DOCS / "reference" / "cpp.md").read_text(encoding="utf-8")
    assert sorted(re.findall(r"^\| \[`(\w+)\.hpp`\]", page, re.MULTILINE)) == PUBLIC_HEADERS
    programs = re.findall(r"^```cpp\n(.*?)^```", page, re.MULTILINE | re.DOTALL)
    for program, name in zip(programs, ("main.cpp", "press.cpp"), strict=True):
        tested = (ROOT / "tests" / "packaging" / "consumer" / name).read_text(encoding="utf-8")
        assert tested == f"// SPDX-License-Identifier: GPL-3.0-or-later\n{program}"


def test_every_page_is_in_the_index_and_in_the_navigation():
    index = (DOCS / "README.md").read_text(encoding="utf-8")
    navigation = (ROOT / "mkdocs.yml").read_text(encoding="utf-8")
    for page in sorted(path.relative_to(DOCS).as_posix() for path in DOCS.rglob("*.md")):
        assert f"]({page})" in index or page == "README.md", page
        assert f"- {page}\n" in navigation, page


def test_there_are_twenty_questions_each_with_a_link():
    page = (DOCS / "how-to" / "questions.md").read_text(encoding="utf-8")
    questions = re.split(r"^\d+\. ", page.partition("## Start")[2], flags=re.MULTILINE)[1:]
    assert len(questions) == 20
    assert all(re.match(r"\*\*[^*]+\?\*\*", question) and "](" in question for question in questions)


def links_of(page: str) -> set[str]:
    """Pages that a page links to, as paths in docs."""
    path = DOCS / page
    targets = re.findall(r"\]\((?!https?:)([^)#\s]+\.md)", path.read_text(encoding="utf-8"))
    return {os.path.relpath((path.parent / target).resolve(), DOCS) for target in targets}


def test_answers_to_the_twenty_questions_are_two_clicks_from_the_front_page():
    assert "how-to/questions.md" in links_of("README.md")
    answers = links_of("how-to/questions.md")
    assert len(answers) > 10
    assert answers <= links_of("README.md") | {"README.md"}, "the front page links to each itself, too"


def test_every_name_on_a_mesh_is_on_the_page_of_attributes():
    page = (DOCS / "reference" / "attributes.md").read_text(encoding="utf-8")
    identifiers = (ROOT / "addon" / "core" / "identifiers.py").read_text(encoding="utf-8")
    names = set(re.findall(r'"(uv_[a-z_]+)"', identifiers))
    for path in (ROOT / "addon").rglob("*.py"):
        names |= set(re.findall(r"\.(cone_unwrap_\w+) = bpy\.props", path.read_text(encoding="utf-8")))
    assert len(names) > 10
    assert set(re.findall(r"^\|(?: [a-z, ]+ \|)? `(\w+)`", page, re.MULTILINE)) == names
