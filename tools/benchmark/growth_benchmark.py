# SPDX-License-Identifier: GPL-3.0-or-later
"""How time and memory grow with cones, and with what becomes frequent; --write makes docs/reference/growth.md.

Each case runs at n, 2n and 4n in processes of their own, each family of meshes with each preset, as quads and as a file
to be read at some 1,000 to 30,000 triangles: CPU seconds of all threads, and the peak of memory above what the process
had before. Needs numpy and xatlas beside lsgp.

    python tools/benchmark/growth_benchmark.py [--write] [--largest 10000] [--limit 120] [case or family ...]
"""

from __future__ import annotations

import argparse
import json
import math
import resource
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from itertools import compress
from pathlib import Path
from typing import Any

import lsgp
import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests"))
import meshes  # noqa: E402
from growth_families import FAMILIES, comb, of_polygons  # noqa: E402

PAGE = ROOT / "docs" / "reference" / "growth.md"
SEED = 0

Run = Callable[[], object]


def sphere(level: int) -> lsgp.Surface:
    mesh = meshes.bumpy_sphere(level)
    return lsgp.Surface(mesh.positions, mesh.triangles)


def random_cones(surface: lsgp.Surface, count: int) -> np.ndarray:
    cones = np.random.default_rng(SEED).choice(len(surface.positions), count, replace=False)
    return np.sort(cones).astype(np.int32)


def unwrap(surface: lsgp.Surface, cones: np.ndarray | list[int], **options: object) -> Run:
    return lambda: lsgp.parameterize(surface, cones, None, lsgp.Options(**options))


def place(count: int) -> Run:
    surface = sphere(5)
    return lambda: lsgp.place_cones(surface, count=count)


def conformal(count: int) -> Run:
    surface = sphere(5)
    return unwrap(surface, random_cones(surface, count))


def seamless(count: int) -> Run:
    surface = sphere(5)
    return unwrap(surface, random_cones(surface, count), seamless=lsgp.Seamless())


def plate(count: int) -> Run:
    mesh = meshes.plate(round(math.sqrt(count)))
    return unwrap(lsgp.Surface(mesh.positions, mesh.triangles), [])


def fan(count: int) -> Run:
    """Thin triangles around one vertex: a boundary of as many corners, and one vertex with all triangles."""
    turn = np.arange(count) / count * 2 * np.pi
    positions = np.concatenate([np.zeros((1, 3)), np.stack([np.cos(turn), np.sin(turn), 0 * turn], 1)])
    corner = np.arange(count)
    triangles = np.stack([0 * corner, 1 + corner, 1 + (corner + 1) % count], 1)
    return unwrap(lsgp.Surface(positions, triangles.astype(np.int32)), [])


def parts(count: int) -> Run:
    one = meshes.grid(4, 4, lambda x, y: 0.1 * np.sin(x + y))
    shift = np.arange(count)[:, None, None] * np.array([10.0, 0, 0])
    positions = (one.positions[None] + shift).reshape(-1, 3)
    triangles = one.triangles[None] + np.arange(count)[:, None, None] * len(one.positions)
    return unwrap(lsgp.Surface(positions, triangles.reshape(-1, 3).astype(np.int32)), [])


@dataclass(frozen=True)
class Case:
    what: str
    build: Callable[[int], Run]
    first: int  # n


CASES = {
    "place": Case("cones placed on 20,480 triangles", place, 500),
    "conformal": Case("random cones on 20,480 triangles, conformal", conformal, 200),
    "seamless": Case("random cones on 20,480 triangles, seamless", seamless, 200),
    "plate": Case("holes in a plate, 30 triangles each", plate, 784),
    "fan": Case("thin triangles around one vertex", fan, 11250),
    "parts": Case("parts of 32 triangles", parts, 500),
}


SIZES = (1_000, 3_000, 10_000, 30_000)
WARM_UP = 100  # triangles; the first call of a process imports modules and reads tables
LEAST_MEMORY = 1.0  # MB; below, what allocators keep is more
SHORTEST = 0.05  # seconds; shorter runs are noise, and no part of an exponent
LIMIT, CASE_LIMIT = 120, 600  # CPU seconds of a run
QUADS, READ = "quads", "read"


def family_run(family: str, how: str, count: int) -> tuple[Run, int]:
    """What a preset, quads or reading do with a mesh of this family, and its number of triangles."""
    made = FAMILIES[family]
    if how == READ:
        mesh = comb(max(1, round(count / 16)))
        return (lambda: of_polygons(mesh)), count
    surface = made.build(count)
    if how == QUADS:
        return (lambda: lsgp.remesh_to_quads(surface)), len(surface.triangles)
    return (lambda: lsgp.auto_unwrap(surface, preset=how, **made.options)), len(surface.triangles)


def ways(family: str) -> list[str]:
    made = FAMILIES[family]
    return [*([READ] if family == "teeth" else []), *made.presets, *([QUADS] if made.is_closed else [])]


def peak_memory() -> int:
    lines = Path("/proc/self/status").read_text().splitlines()
    return next(1024 * int(line.split()[1]) for line in lines if line.startswith("VmHWM"))


def measure_here(what: str, how: str, count: int) -> dict[str, Any]:
    """how: of a family; "" for a case.  A refusal is one of its codes."""
    triangles = 0
    if what in CASES:
        run = CASES[what].build(count)
    else:
        family_run(what, how, WARM_UP)[0]()
        run, triangles = family_run(what, how, count)
    before, begin = peak_memory(), time.process_time()
    try:
        run()
        refused = None
    except lsgp.LsgpError as error:
        refused = error.code
    seconds = time.process_time() - begin
    return {"seconds": seconds, "bytes": peak_memory() - before, "triangles": triangles, "refused": refused}


def measure(what: str, how: str, count: int, limit: float) -> dict[str, Any] | None:
    """In a process of its own; None where it takes more CPU seconds than the limit."""

    def limited() -> None:
        resource.setrlimit(resource.RLIMIT_CPU, (math.ceil(limit), math.ceil(limit) + 5))

    command = [sys.executable, __file__, "--measure", what, how, str(count)]
    done = subprocess.run(command, capture_output=True, text=True, preexec_fn=limited)
    if done.returncode in (-signal.SIGXCPU, -signal.SIGKILL):
        return None
    if done.returncode:
        raise RuntimeError(f"{what} {how} {count}: {done.stderr[-2000:]}")
    return json.loads(done.stdout)


def power(least: float, most: float) -> str:
    """The exponent of the growth over a factor of 4."""
    return f"{math.log(max(most, 1e-9) / max(least, 1e-9), 4):.1f}"


def exponent(sizes: list[float], values: list[float]) -> float:
    """Of growth, by least squares of the logarithms."""
    return float(np.polyfit(np.log(sizes), np.log(values), 1)[0])


def case_table(cases: list[str]) -> str:
    lines = ["| what grows | n | seconds at n, 2n, 4n | power | MB at n, 2n, 4n | power |", "|---|--:|--:|--:|--:|--:|"]
    for name in cases:
        case = CASES[name]
        found = [measure(name, "", case.first * factor, CASE_LIMIT) for factor in (1, 2, 4)]
        seconds, megabytes = [f["seconds"] for f in found], [f["bytes"] / 1e6 for f in found]
        cells = [
            case.what,
            f"{case.first:,}",
            ", ".join(f"{s:.2f}" for s in seconds),
            power(seconds[0], seconds[-1]),
            ", ".join(f"{m:.0f}" for m in megabytes),
            power(megabytes[0], megabytes[-1]),
        ]
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def family_table(families: list[str], largest: int, limit: float) -> str:
    sizes = [size for size in SIZES if size <= largest]
    heads = ["family", "as", *(f"{size:,}" for size in sizes), "power", f"MB at {sizes[0]:,}", "at the last", "power"]
    lines = ["| " + " | ".join(heads) + " |", "|---|---|" + "--:|" * (len(heads) - 2)]
    for name in families:
        for how in ways(name):
            lines.append("| " + " | ".join([FAMILIES[name].what, how, *family_cells(name, how, sizes, limit)]) + " |")
            print(lines[-1], file=sys.stderr, flush=True)
    return "\n".join(lines) + "\n"


def merged(old: str, new: str) -> str:
    """A table of families with the rows of another, which were measured now, in place of its own or after them. Sizes
    that only one of both has are dashes in the other."""
    tables = [rows_of(old), rows_of(new)]
    is_size = [[head.replace(",", "").isdigit() for head in heads] for heads, *_ in tables]
    sizes = {head for (heads, *_), of_size in zip(tables, is_size, strict=True) for head in compress(heads, of_size)}

    def wide(row: list[str], heads: list[str], of_size: list[bool]) -> list[str]:
        known = dict(compress(zip(heads, row, strict=True), of_size))
        others = [cell for cell, is_one in zip(row, of_size, strict=True) if not is_one]
        in_order = sorted(sizes, key=lambda size: int(size.replace(",", "")))
        return [*others[:2], *(known.get(size, "-") for size in in_order), *others[2:]]

    found: dict[tuple[str, ...], list[str]] = {}
    for (heads, _, *rows), of_size in zip(tables, is_size, strict=True):
        for row in [heads, *rows]:
            found[tuple(row[:2])] = wide(row, heads, of_size)
    first, *rest = ("| " + " | ".join(line) + " |\n" for line in found.values())
    return first + "|---|---|" + "--:|" * (first.count("|") - 3) + "\n" + "".join(rest)


def rows_of(table: str) -> list[list[str]]:
    return [[cell.strip() for cell in line.strip().strip("|").split("|")] for line in table.strip().splitlines()]


def family_cells(name: str, how: str, sizes: list[int], limit: float) -> list[str]:
    """The times, their exponent, the memory at the first and the last size that was measured, and its exponent."""
    cells: list[str] = []
    found: list[dict[str, Any]] = []
    for size in sizes:
        one = measure(name, how, size, limit)
        if one is None:
            cells.append(f"> {limit:g}")
            break
        cells.append(f"{one['seconds']:.2f}" if one["refused"] is None else f"`{one['refused']}`")
        if one["refused"] is None and one["seconds"] >= SHORTEST:
            found.append(one)
    cells += ["-"] * (len(sizes) - len(cells))
    if len(found) < 2:
        return [*cells, "-", "-", "-", "-"]
    triangles, seconds = [f["triangles"] for f in found], [f["seconds"] for f in found]
    megabytes = [max(LEAST_MEMORY, f["bytes"] / 1e6) for f in found]
    memory = [f"{megabytes[0]:.0f}", f"{megabytes[-1]:.0f}", f"{exponent(triangles, megabytes):.2f}"]
    return [*cells, f"{exponent(triangles, seconds):.2f}", *memory]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    known = [*CASES, *FAMILIES]
    parser.add_argument("names", nargs="*", metavar="name", help=f"of {', '.join(known)}; all by default")
    parser.add_argument("--largest", type=int, default=SIZES[-1], help="triangles of a family")
    parser.add_argument("--limit", type=float, default=LIMIT, help="CPU seconds of a run of a family")
    parser.add_argument(
        "--write", action="store_true", help=f"the tables to {PAGE.relative_to(ROOT)}, of families the rows measured"
    )
    parser.add_argument("--measure", nargs=3, metavar=("name", "how", "n"), help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.measure:
        name, how, count = arguments.measure
        print(json.dumps(measure_here(name, how, int(count))))
        return
    names = arguments.names or known
    tables = {}
    if cases := [name for name in names if name in CASES]:
        tables["| what grows"] = case_table(cases)
    if families := [name for name in names if name in FAMILIES]:
        tables["| family"] = family_table(families, arguments.largest, arguments.limit)
    print("\n".join(tables.values()))
    if arguments.write:
        page = PAGE.read_text(encoding="utf-8")
        for head, table in tables.items():
            begin, end = page.index(head), page.index("\n\n", page.index(head)) + 1
            page = page[:begin] + (merged(page[begin:end], table) if head == "| family" else table) + page[end:]
        PAGE.write_text(page, encoding="utf-8")


if __name__ == "__main__":
    main()
