# SPDX-License-Identifier: GPL-3.0-or-later
"""The documentation as a site: it builds without a warning, and its lists are complete."""

import os
import re
import subprocess
import sys

import pytest
from code_blocks import ROOT

DOCS = ROOT / "docs"


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


def test_every_name_on_a_mesh_is_on_the_page_of_attributes():
    page = (DOCS / "reference" / "attributes.md").read_text(encoding="utf-8")
    identifiers = (ROOT / "addon" / "core" / "identifiers.py").read_text(encoding="utf-8")
    names = set(re.findall(r'"(uv_[a-z_]+)"', identifiers))
    for path in (ROOT / "addon").rglob("*.py"):
        names |= set(re.findall(r"\.(cone_unwrap_\w+) = bpy\.props", path.read_text(encoding="utf-8")))
    assert len(names) > 10
    assert set(re.findall(r"^\|(?: [a-z, ]+ \|)? `(\w+)`", page, re.MULTILINE)) == names
