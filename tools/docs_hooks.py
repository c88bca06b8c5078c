# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes files of the repository that pages link to part of the site. MkDocs calls these functions (mkdocs.yml)."""

from pathlib import Path

from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files
from mkdocs.structure.pages import Page

ROOT = Path(__file__).resolve().parents[1]
EXAMPLES = "examples"


def on_files(files: Files, *, config: MkDocsConfig) -> Files:
    """Adds the examples, beside the folders of docs."""
    for path in sorted((ROOT / EXAMPLES).rglob("*")):
        if path.is_file() and "__pycache__" not in path.parts:
            files.append(File.generated(config, path.relative_to(ROOT).as_posix(), abs_src_path=str(path)))
    return files


def on_page_markdown(markdown: str, *, page: Page, config: MkDocsConfig, files: Files) -> str:
    """Links to examples as they are in the site."""
    return markdown.replace(f"](../../{EXAMPLES}/", f"](../{EXAMPLES}/")
