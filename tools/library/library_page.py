# SPDX-License-Identifier: GPL-3.0-or-later
"""What became of a library of generated meshes; --write makes the table of docs/reference/library.md.

    python tools/library/library_page.py OUT [--write] [--worst FILE.png]

OUT is the folder of `lsgp batch` on a library of make_library.py. --worst: draws the pictures of the fifty worst
results into one, in five rows: those that are slow for their size, that have more islands than most of their kind, that
are stretched most, that fill least of the square, and that leave out most faces. Needs numpy and lsgp.
"""

from __future__ import annotations

import argparse
import statistics
import sys
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
from library_kinds import KINDS
from lsgp.batch.journal import read_records
from lsgp.batch.records import OK, Record
from lsgp.io.image_files import read_image
from lsgp.io.png_files import write_png

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs" / "reference" / "library.md"
IN_A_ROW = 10
# The least size of meshes of whose time a power of growth is told.
LARGE = 500


def kind_of(record: Record) -> str:
    return record["asset"].split("/")[0]


def seconds_of(record: Record) -> float:
    """Of the processor, or by the clock where it was ended."""
    return record["cpu_seconds"] or record["seconds"] or 0.0


def table(records: Sequence[Record]) -> str:
    columns = ["kind", "meshes", "with a map", "faces left out", "triangles", "CPU s", "9 of 10", "most", "power"]
    columns += ["islands", "square", "L2", "9 of 10", "most"]
    lines = [f"| {' | '.join(columns)} |", f"|---|{'--:|' * (len(columns) - 1)}"]
    for kind in [*KINDS, "all"]:
        of_kind = [record for record in records if kind in ("all", kind_of(record))]
        if of_kind:
            lines.append(f"| {' | '.join([kind, *map(str, row(of_kind))])} |")
    return "\n".join(lines) + "\n"


def row(records: Sequence[Record]) -> list[object]:
    results = [record for record in records if record["status"] == OK]
    seconds = sorted(map(seconds_of, records))
    stretches = sorted(of for r in results if (of := r["distortion"]["l2_stretch"]) is not None)
    filled = [record["coverage"] for record in results if record["coverage"] is not None]
    return [
        len(records),
        len(results),
        sum(bool(record["missing_faces"]) for record in results),
        f"{statistics.median(record['triangles'] for record in results):,.0f}",
        f"{statistics.median(seconds):.2f}",
        f"{nine_of_ten(seconds):.2f}",
        f"{seconds[-1]:.1f}",
        power(results),
        f"{statistics.median(record['islands'] for record in results):g}",
        f"{statistics.median(filled):.2f}",
        *(f"{of:.3f}" for of in (statistics.median(stretches), nine_of_ten(stretches), stretches[-1])),
    ]


def nine_of_ten(ordered: Sequence[float]) -> float:
    return ordered[(9 * len(ordered)) // 10]


def power(results: Sequence[Record]) -> str:
    """By which the time grows with the number of triangles, by least squares over those that are not small."""
    large = [(r["triangles"], seconds_of(r)) for r in results if r["triangles"] >= LARGE and seconds_of(r) > 0]
    if len(large) < 8:
        return ""
    size, seconds = np.log(np.array(large)).T
    return f"{np.polyfit(size, seconds, 1)[0]:.2f}"


def worst(records: Sequence[Record]) -> list[list[Record]]:
    """Rows of results, each the worst by another measure; none is shown twice."""
    results = [record for record in records if record["status"] == OK and record["picture"]]
    typical = {
        kind: statistics.median(r["islands"] / r["triangles"] for r in results if kind_of(r) == kind) or 1
        for kind in {kind_of(r) for r in results}
    }
    measures: list[Callable[[Record], float]] = [
        lambda r: seconds_of(r) / max(r["triangles"], LARGE),
        lambda r: r["islands"] / r["triangles"] / typical[kind_of(r)] if r["triangles"] >= LARGE else 0,
        lambda r: r["distortion"]["l2_stretch"] or np.inf,
        lambda r: -(r["coverage"] or 0),
        lambda r: (r["missing_area_percent"] or 0) + (r["overlapping"] or 0) / r["triangles"],
    ]
    rows, shown = [], set()
    for measure in measures:
        chosen = [r for r in sorted(results, key=measure, reverse=True) if r["asset"] not in shown][:IN_A_ROW]
        shown |= {r["asset"] for r in chosen}
        rows.append(chosen)
    return rows


def draw(out: Path, rows: Sequence[Sequence[Record]]) -> np.ndarray:
    return np.concatenate(
        [np.concatenate([read_image(out / record["picture"])[..., :3] for record in one], axis=1) for one in rows]
    )


def told(record: Record) -> str:
    return (
        f"{record['asset']}: {record['triangles']} triangles, {seconds_of(record):.2f} s, {record['islands']} islands, "
        f"{record['cones']} cones, square {record['coverage'] or 0:.2f}, L2 {record['distortion']['l2_stretch']:.3f}, "
        f"{record['missing_faces']} faces left out, {record['overlapping']} overlapping"
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("out", type=Path)
    parser.add_argument("--write", action="store_true", help=f"the table to {PAGE.relative_to(ROOT)}")
    parser.add_argument("--worst", type=Path, metavar="FILE.png")
    arguments = parser.parse_args()
    records = list(read_records(arguments.out, None).records.values())
    print(table(records))
    for record in records:
        if record["status"] != OK:
            print(f"{record['asset']}: {record['status']} {record['code']}: {record['message']}")
    if arguments.worst is not None:
        rows = worst(records)
        write_png(arguments.worst, draw(arguments.out, rows))
        print("\n".join(told(record) for one in rows for record in one))
    if arguments.write:
        page = PAGE.read_text(encoding="utf-8")
        begin = page.index("\n|") + 1
        end = page.find("\n\n", begin) + 1 or len(page)
        PAGE.write_text(page[:begin] + table(records) + page[end:], encoding="utf-8")


if __name__ == "__main__":
    sys.exit(main())
