# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes the examples and the reference of the C++ library parts of the site; MkDocs calls this (mkdocs.yml)."""

import re
import sys
import tempfile
from pathlib import Path

from mkdocs.config.defaults import MkDocsConfig
from mkdocs.exceptions import PluginError
from mkdocs.structure.files import File, Files
from mkdocs.structure.pages import Page

sys.path.insert(0, str(Path(__file__).parent))
import cpp_reference

ROOT = Path(__file__).resolve().parents[1]
EXAMPLES = "examples"
CPP = "reference/cpp"  # of Doxygen's pages in the site
HEADER_LINK = re.compile(r"\]\(\.\./\.\./native/include/lsgp/(\w+)\.hpp\)")


def on_files(files: Files, *, config: MkDocsConfig) -> Files:
    """Adds the examples, beside the folders of docs, and what Doxygen makes of the headers."""
    for path in sorted((ROOT / EXAMPLES).rglob("*")):
        if path.is_file() and "__pycache__" not in path.parts:
            files.append(File.generated(config, path.relative_to(ROOT).as_posix(), abs_src_path=str(path)))
    if not cpp_reference.is_possible():
        raise PluginError("the reference of the C++ library takes doxygen; tools/docs installs it")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        try:
            cpp_reference.write(folder)
        except RuntimeError as refusal:
            raise PluginError(str(refusal)) from None
        for path in sorted(folder.rglob("*")):
            if path.is_file():
                place = f"{CPP}/{path.relative_to(folder).as_posix()}"
                files.append(File.generated(config, place, content=path.read_bytes()))
    return files


def on_page_markdown(markdown: str, *, page: Page, config: MkDocsConfig, files: Files) -> str:
    """Links to examples and headers as they are in the site."""
    markdown = markdown.replace(f"](../../{EXAMPLES}/", f"](../{EXAMPLES}/")
    return HEADER_LINK.sub(lambda header: f"](cpp/{cpp_reference.page_of(header[1])})", markdown)
