# SPDX-License-Identifier: GPL-3.0-or-later
"""The same islands packed by several packers; --write makes the tables of docs/reference/packing.md.

    PYTHONPATH=tests python tools/benchmark/packing_benchmark.py [--write] [option ...] [case ...]

Cases are kits by formula ("1000 leaves") and layouts of meshes ("Bake, flower"): all, or those that have one of the
arguments in their name. Needs numpy and xatlas beside lsgp, a Python with bpy, and one with spyrrow and numpy; what has
no Python is left out. Every packer runs in a process of its own, with a limit of CPU seconds, and the checks of the
tests measure what comes out. --resume goes on from a run that was stopped.
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import statistics
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass
from itertools import product
from pathlib import Path

import numpy as np
from island_kits import KINDS, Kit, kit
from packing_checks import measured
from packing_layouts import layouts
from packing_peers import PACKERS
from placement_page import as_table

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs" / "reference" / "packing.md"
RESULTS = ROOT / "build" / "packing" / "results.json"
PEERS = Path(__file__).with_name("packing_peers.py")

# Of the square's side, by the number of islands: what leaves them most of it.
MARGINS = {10: 4 / 1024, 100: 2 / 1024, 1000: 1 / 1024, 5000: 1 / 2048}
OF_LAYOUTS = 4 / 1024
OWN, TIMED = "lsgp", "xatlas, brute force"
# Seconds of a process beside packing; how much longer than its CPU seconds it may take.
START, PATIENCE = 10, 20


@dataclass(frozen=True)
class Case:
    """group: of which medians are told."""

    name: str
    group: str
    margin: float
    read: Callable[[], Kit | None]


@dataclass(frozen=True)
class Row:
    """What a packer made of a case.  failed: why there is nothing else."""

    case: str
    group: str
    packer: str
    coverage: float = 0.0
    seconds: float = 0.0
    kept: float = 0.0
    overlapping: int = 0
    failed: str = ""


def cases() -> Iterator[Case]:
    for count, kind in product(MARGINS, KINDS):
        read = lambda count=count, kind=kind: kit(kind, count)  # noqa: E731
        yield Case(f"{count} {kind}", f"{count:,} islands", MARGINS[count], read)
    for name, read in layouts():
        yield Case(name, name.partition(",")[0], OF_LAYOUTS, read)


def pack(packer: str, python: str, given: Kit, margin: float, limit: int) -> tuple[np.ndarray, float] | str:
    """The islands as they are packed and CPU seconds; or why they are not."""
    with tempfile.TemporaryDirectory() as folder:
        source, target = Path(folder) / "kit.npz", Path(folder) / "packed.npz"
        np.savez(source, corner_uv=given.corner_uv, island=given.island, margin=margin)
        command = [python, str(PEERS), packer, str(source), str(target)]
        variables = dict(os.environ)
        if not packer.startswith(OWN):
            variables.pop("PYTHONPATH", None)
        most = limit + START
        try:
            ended = subprocess.run(
                command,
                env=variables,
                timeout=PATIENCE * most,
                capture_output=True,
                preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (most, most)),
            )
        except subprocess.TimeoutExpired:
            return "slow"
        if ended.returncode < 0:
            return "slow" if -ended.returncode in (9, 24) else "crash"
        if ended.returncode or not target.is_file():
            print(ended.stderr.decode(errors="replace")[-500:], file=sys.stderr)
            return "crash" if b"panicked" in ended.stderr else "error"
        packed = np.load(target)
        return packed["corner_uv"], float(packed["seconds"])


def measure(case: Case, given: Kit, packer: str, python: str, limit: int) -> Row:
    found = pack(packer, python, given, case.margin, limit)
    if isinstance(found, str):
        return Row(case.name, case.group, packer, failed=found)
    uv, seconds = found
    got = measured(given.corner_uv, uv, given.island, case.margin)
    return Row(case.name, case.group, packer, got.coverage, seconds, min(got.kept, 2.0), got.overlapping)


def medians(rows: list[Row]) -> str:
    """Of each group and packer; ratios are medians of those on the same islands."""
    at = {(row.case, row.packer): row for row in rows if not row.failed}
    lines = []
    for group, packer in product(unique(row.group for row in rows), unique(row.packer for row in rows)):
        asked = [row.case for row in rows if (row.group, row.packer) == (group, packer)]
        done = [at[case, packer] for case in asked if (case, packer) in at]
        if not asked:
            continue
        if not done:
            lines.append([group, packer, f"0 of {len(asked)}", *[""] * 6])
            continue
        to_best, to_timed = [], []
        for row in done:
            peers = [one for (case, name), one in at.items() if case == row.case and not name.startswith(OWN)]
            if peers:
                to_best.append(row.coverage / max(one.coverage for one in peers))
            if (row.case, TIMED) in at:
                to_timed.append(row.seconds / max(at[row.case, TIMED].seconds, 1e-3))
        lines.append(
            [
                *(group, packer, f"{len(done)} of {len(asked)}"),
                f"{statistics.median(row.coverage for row in done):.3f}",
                f"{statistics.median(to_best):.3f}" if to_best else "",
                f"{statistics.median(row.seconds for row in done):.3g}",
                f"{statistics.median(to_timed):.3g}" if to_timed else "",
                f"{min(row.kept for row in done):.3f}",
                sum(row.overlapping for row in done),
            ]
        )
    columns = [
        "islands",
        "packer",
        "packed",
        "covered",
        "to the best peer",
        "CPU s",
        "to brute force",
        "least gap",
        "overlaps",
    ]
    return as_table(columns, 2, lines)


def each(rows: list[Row], told: Callable[[Row], str]) -> str:
    packers = unique(row.packer for row in rows)
    at = {(row.case, row.packer): row for row in rows}
    lines = []
    for case in unique(row.case for row in rows):
        found = [at.get((case, packer)) for packer in packers]
        lines.append([case, *("" if row is None else row.failed or told(row) for row in found)])
    return as_table(["islands", *packers], 1, lines)


def unique(values: Iterator[str]) -> list[str]:
    return list(dict.fromkeys(values))


def write(tables: dict[str, str]) -> None:
    """Replaces the tables below headings of the page."""
    page = PAGE.read_text(encoding="utf-8")
    for heading, rows in tables.items():
        begin = page.index("\n|", page.index(f"## {heading}\n")) + 1
        end = page.find("\n\n", begin) + 1 or len(page)
        page = page[:begin] + rows + page[end:]
    PAGE.write_text(page, encoding="utf-8")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("cases", nargs="*", metavar="case", help="words of their names; all by default")
    parser.add_argument("--packers", nargs="+", choices=PACKERS, default=list(PACKERS))
    parser.add_argument("--limit", type=int, default=120, help="CPU seconds of a packer on a case (default: 120)")
    parser.add_argument("--blender", metavar="PYTHON", help="one with bpy")
    parser.add_argument("--spyrrow", metavar="PYTHON", help="one with spyrrow")
    parser.add_argument("--resume", action="store_true", help=f"measure what {RESULTS.relative_to(ROOT)} does not have")
    parser.add_argument("--write", action="store_true", help=f"the tables to {PAGE.relative_to(ROOT)}")
    arguments = parser.parse_args()
    pythons = {"Blender": arguments.blender, "spyrrow": arguments.spyrrow}
    packers = {name: pythons.get(name, sys.executable) for name in arguments.packers}
    rows = [Row(**row) for row in json.loads(RESULTS.read_text())] if arguments.resume and RESULTS.is_file() else []
    has = {(row.case, row.packer) for row in rows}
    chosen = [case for case in cases() if not arguments.cases or any(word in case.name for word in arguments.cases)]
    for case in chosen:
        given = case.read()
        for packer, python in packers.items():
            if given is None or python is None or (case.name, packer) in has:
                continue
            rows.append(measure(case, given, packer, python, arguments.limit))
            print(rows[-1], flush=True)
            RESULTS.parent.mkdir(parents=True, exist_ok=True)
            RESULTS.write_text(json.dumps([asdict(row) for row in rows]))
    order = [case.name for case in cases()]
    rows.sort(key=lambda row: (order.index(row.case), list(PACKERS).index(row.packer)))
    tables = {
        "Medians": medians(rows),
        "Covered part of the square": each(rows, lambda row: f"{row.coverage:.3f}"),
        "CPU seconds": each(rows, lambda row: f"{row.seconds:.3g}"),
    }
    for heading, table in tables.items():
        print(f"## {heading}\n\n{table}")
    if arguments.write:
        write(tables)


if __name__ == "__main__":
    main()
