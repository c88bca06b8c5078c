# SPDX-License-Identifier: GPL-3.0-or-later
"""The contact sheet: HTML pages of all pictures with names and figures.

Assets without a result come first, then results by decreasing stretch.
"""

from __future__ import annotations

import html
import math
from collections.abc import Iterator, Sequence
from pathlib import Path
from urllib.parse import quote_from_bytes

from ..io.whole_files import write_whole
from .records import OK, Record

PER_PAGE = 500

STYLE = """
body { font: 13px/1.35 sans-serif; margin: 1.5em; background: #fff; color: #222 }
main { display: grid; grid-template-columns: repeat(auto-fill, 168px); gap: 16px }
figure { margin: 0; overflow-wrap: anywhere }
img, .none { display: block; width: 160px; height: 80px; border: 1px solid #ccc }
.none { background: #f4e4e2; padding: 6px; box-sizing: border-box; overflow: hidden }
figcaption small { color: #666 }
"""


def write_contact_sheet(out: Path, records: Sequence[Record]) -> Path:
    """Write the pages into the folder of the results, and return the first.  Raises OSError."""
    ordered = sorted(records, key=_order)
    names = page_names(len(ordered))
    for page, name in enumerate(names):
        shown = ordered[page * PER_PAGE : (page + 1) * PER_PAGE]
        write_whole(out / name, "".join(_page(shown, page, len(names))).encode("utf-8", "replace"))
    return out / names[0]


def page_names(assets: int) -> list[str]:
    """The names of the pages for so many assets."""
    return [_page_name(page) for page in range(max(1, math.ceil(assets / PER_PAGE)))]


def _order(record: Record) -> tuple[bool, float, str]:
    return record["status"] == OK, -_stretch(record), record["asset"]


def _stretch(record: Record) -> float:
    """Infinite where there is no figure, as for a layout without an area."""
    stretch = (record["distortion"] or {}).get("l2_stretch")
    return math.inf if stretch is None else stretch


def _page_name(page: int) -> str:
    return "contact-sheet.html" if page == 0 else f"contact-sheet-{page + 1}.html"


def _page(records: Sequence[Record], page: int, count: int) -> Iterator[str]:
    links = " ".join(
        f"<b>{other + 1}</b>" if other == page else f'<a href="{_page_name(other)}">{other + 1}</a>'
        for other in range(count)
    )
    yield '<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><title>Contact sheet</title>'
    yield f"<style>{STYLE}</style></head>\n<body><p>Page {links}</p>\n<main>\n"
    for record in records:
        yield _figure(record)
    yield "</main></body></html>\n"


def _figure(record: Record) -> str:
    name = html.escape(record["asset"])
    if record["status"] != OK:
        reason = html.escape(record["message"])
        return (
            f'<figure><div class="none">{reason}</div><figcaption>{name}<br>'
            f"<small>{record['status']}: {record['code']}</small></figcaption></figure>\n"
        )
    picture = record["picture"]
    shown = "" if picture is None else f'<img loading="lazy" alt="" src="{_address(picture)}">'
    figures = [f"{record['triangles']} triangles", f"{record['cones']} cones", f"stretch {_stretch(record):.3f}"]
    figures += sorted(record["warnings"])
    return (
        f'<figure>{shown}<figcaption><a href="{_address(record["output"])}">{name}</a><br>'
        f"<small>{', '.join(figures)}</small></figcaption></figure>\n"
    )


def _address(name: str) -> str:
    return quote_from_bytes(name.encode("utf-8", "surrogateescape"))
