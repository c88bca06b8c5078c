# SPDX-License-Identifier: GPL-3.0-or-later
"""How time and memory grow with cones, holes, needles and components; --write makes docs/reference/growth.md.

Each case runs at n, 2n and 4n in processes of their own: CPU seconds of all threads, and the peak of memory above what
the process had before. Needs numpy beside lsgp.

    python tools/benchmark/growth_benchmark.py [--write] [case ...]
"""

from __future__ import annotations

import argparse
import json
import math
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import lsgp
import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests"))
import meshes  # noqa: E402

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


def holes(count: int) -> Run:
    mesh = meshes.plate(round(math.sqrt(count)))
    return unwrap(lsgp.Surface(mesh.positions, mesh.triangles), [])


def needles(count: int) -> Run:
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
    "holes": Case("holes in a plate, 30 triangles each", holes, 784),
    "needles": Case("thin triangles around one vertex", needles, 11250),
    "parts": Case("parts of 32 triangles", parts, 500),
}


def peak_memory() -> int:
    lines = Path("/proc/self/status").read_text().splitlines()
    return next(1024 * int(line.split()[1]) for line in lines if line.startswith("VmHWM"))


def measure_here(case: str, count: int) -> dict[str, float]:
    run = CASES[case].build(count)
    before, begin = peak_memory(), time.process_time()
    run()
    return {"seconds": time.process_time() - begin, "bytes": peak_memory() - before}


def measure(case: str, count: int) -> dict[str, float]:
    command = [sys.executable, __file__, "--measure", case, str(count)]
    return json.loads(subprocess.run(command, capture_output=True, text=True, check=True, timeout=600).stdout)


def power(least: float, most: float) -> str:
    """The exponent of the growth over a factor of 4."""
    return f"{math.log(max(most, 1e-9) / max(least, 1e-9), 4):.1f}"


def table(cases: list[str]) -> str:
    lines = ["| what grows | n | seconds at n, 2n, 4n | power | MB at n, 2n, 4n | power |", "|---|--:|--:|--:|--:|--:|"]
    for name in cases:
        case = CASES[name]
        found = [measure(name, case.first * factor) for factor in (1, 2, 4)]
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


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("cases", nargs="*", metavar="case", help=f"of {', '.join(CASES)}; all by default")
    parser.add_argument("--write", action="store_true", help=f"the table to {PAGE.relative_to(ROOT)}")
    parser.add_argument("--measure", nargs=2, metavar=("case", "n"), help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.measure:
        case, count = arguments.measure
        print(json.dumps(measure_here(case, int(count))))
        return
    found = table(arguments.cases or list(CASES))
    print(found)
    if arguments.write:
        page = PAGE.read_text(encoding="utf-8")
        begin = page.index("| what grows")
        PAGE.write_text(page[:begin] + found + page[page.index("\n## ", begin) :], encoding="utf-8")


if __name__ == "__main__":
    main()
