# SPDX-License-Identifier: GPL-3.0-or-later
"""Time of `lsgp.parameterize` as Markdown tables.

speed: the whole map on growing meshes beside libigl's LSCM on the same cut, Blender's methods with that cut marked as
seams, and one factorization of the bare Laplacian; edits through `lsgp.Solver`, memory and growth. threads: two threads
beside one. previews: those of a dragged cone beside the exact map. rounding: what seamless layouts add. shares: checks
and repair. stretch: low stretch beside Blender's Minimum Stretch and libigl's SLIM. files: reading and writing, the
command line from file to file beside that of BFF, and the preset Bake beside xatlas.

But for files, all get arrays and give texture coordinates. lsgp also finds the cut, prescribes the cone angles and
measures the map. Times are CPU seconds of all threads together, one thread being asked for; medians over repetitions in
which the methods take turns, so that a busy machine hurts all alike: compare ratios within one run. Needs numpy, scipy
and libigl beside lsgp; for Blender a Python with bpy, named by BPY_PYTHON or where tools/test puts it; for the
Laplacian CMake, a compiler and Eigen, and libsuitesparse-dev for CHOLMOD; xatlas; for --write matplotlib. The
environment variable BFF names the command line of BFF. What is not there is left out.

    python tools/benchmark/benchmark.py [--tables speed ...] [--largest 1000000] [--repetitions 5] [--write] [mesh ...]
"""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Iterable

from benchmark_cases import MESHES, ROOT, SHARED, dense_cases, growing_cases, small_cases
from benchmark_files import measure_command, measure_files, measure_xatlas
from benchmark_goals import goals
from benchmark_options import measure_low_stretch, measure_rounding, measure_shares, measure_slim, measure_threads
from benchmark_previews import PREVIEWS, measure_preview, preview_cases
from benchmark_speed import Measured, measure, plot, ratio_rows, stage_rows, time_rows
from benchmark_workers import ONE_THREAD, build_laplacian_program, find_blender

LARGE, MANY = 200_000, 100
TABLES = ("speed", "threads", "previews", "rounding", "shares", "stretch", "files")
ON_PAGE = ("speed", "threads", "previews", "stretch", "files")
PAGE = ROOT / "docs" / "reference" / "benchmark.md"
PLOT = ROOT / "docs" / "images" / "benchmark.svg"


# Samples of a profiler, one thread, of the map of the head with 200,000 triangles.
WHAT_REMAINS = """\
## Where the time goes

Shares of the samples of a profiler (perf) on the head with 200,000 triangles, percent:

| cones | cuts | ordering | real factor | complex factor | solves | coarse surface | curvatures | the rest |
|--:|--:|--:|--:|--:|--:|--:|--:|--:|
| 8 | 26 | 14 | 22 |  | 6 |  | 2 | 30 |
| 100 random | 11 | 11 | 4 | 35 | 17 |  | 9 | 13 |
| 500 random | 13 | 7 | 4 | 28 | 24 | 9 | 4 | 11 |

- **Cuts** of few cones: the search for the tree is a tenth of this, exchanges of key paths with the regions around the
  cuts are four tenths, exchanges of junctions three.
- **Ordering** is minimum degree and the symbolic factorization. From 80,000 unknowns on, nested dissection takes the
  place of minimum degree, on several threads. It saves 28 to 53 % of the factor's operations with a million triangles,
  and 7 to 22 % of a map of two heads; with 200,000, 31 % of the operations but only 2 % of the map on one thread, and
  nothing with 50,000. More than half of its time counts levels from a few vertices, one after the other. Levels of the
  closed surface, counted during the search for cuts, divide the opened one worse: a map of 200,000 triangles then takes
  11 % longer. Unknowns that many others share, as the translations of cuts, leave no short separators. A few are put
  into all of them: low stretch with 8 cones then takes 16 % less time with 200,000 triangles and 25 % less with a
  million. With 99 of them, dissection takes longer than minimum degree, which therefore remains.
- **Real factor** includes the pages of memory that the system clears for it.
- **Complex factor.** With many cones, unfolding factors a complex system with the transitions in it, at four times the
  operations of the real one. Four fifths of them are in fronts with a cut below even for 8 cones, so that real numbers
  elsewhere save little; with the real factor as preconditioner, one solve takes over 250 steps.
- **Solves.** 100 cones have a Green's function each. 500 need about forty solves of one right-hand side instead, which
  wait for memory.
- **From file to file**, `lsgp unwrap --cones auto:8` takes 11.6 s for the head with a million triangles, and no step
  dominates: the visibility of vertices, which cuts cost by, is 9 % of the samples, memory that the system clears 8 %,
  the coarse surface of placement 5 %, the distances kept between cones 5 %."""

THREADS = """\
## Two threads

Wall-clock seconds of the whole map. Threads divide the factorization, the solves, the passes over triangles and, in
dissection, the parts of the surface; the tree along which directions are integrated is built beside the factor. The
search for cuts, the levels of dissection, the symbolic factorization and topology run on one thread: they are almost
half of the time of one thread with 200,000 triangles. The factorization cannot begin before the cuts are known: an
order of the closed surface, found meanwhile, has 1.5 times the operations with 200,000 triangles and 1.9 times with a
million. [Batches](../how-to/batch.md) unwrap one mesh on each processor instead.
"""

BESIDE_BLENDER = """\
## Low stretch

CPU seconds beside Blender's Minimum Stretch with 10 iterations on the same cut. *Mismatch* is the largest relative
difference in length of the two sides of a cut edge.
"""

BESIDE_SLIM = """\
Beside libigl's SLIM (Rabinovich et al. 2017) on the same cut, which starts from Tutte's map and ends when its symmetric
Dirichlet energy is within 2 % of that of lsgp. Its maps do not match across the cuts, which makes their problem easier.
"""

FILES = """\
## Files

CPU seconds of reading a surface from files of each kind, and of writing it with a map. OFF has no texture coordinates.
"""

COMMAND = """\
The command line from file to file: `lsgp unwrap --cones auto:8` of an OBJ, and the peak memory of its process.
"""

BESIDE_XATLAS = """\
The preset *Bake*, packed, beside xatlas with its defaults; [the maps are compared
elsewhere](quality.md#presets-and-other-unwraps).
"""


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("meshes", nargs="*", metavar="mesh", help=f"for rounding and shares: of {', '.join(MESHES)}")
    parser.add_argument("--tables", nargs="+", choices=TABLES, default=TABLES)
    parser.add_argument("--largest", type=int, default=1_000_000, help="triangles of the largest mesh for speed")
    parser.add_argument("--repetitions", type=int, default=5, help="at 60,000 triangles; more below, fewer above")
    parser.add_argument("--write", action="store_true", help=f"{', '.join(ON_PAGE)} to {PAGE.relative_to(ROOT)}")
    arguments = parser.parse_args()
    if arguments.write and not set(ON_PAGE) <= set(arguments.tables):
        parser.error(f"--write needs --tables {' '.join(ON_PAGE)}")
    os.environ.update(ONE_THREAD)  # libigl reads its own at its first parallel loop
    if not SHARED.is_dir():
        print(f"{SHARED} is not there: made surfaces instead.", file=sys.stderr)
    blender = find_blender()
    if blender is None:
        print(
            "Blender is left out: no Python with bpy. Run tools/test once or name one in BPY_PYTHON.", file=sys.stderr
        )
    repetitions = arguments.repetitions
    page = []

    def show(section: str) -> None:
        print(section, end="\n\n")
        page.append(section)

    if "speed" in arguments.tables:
        show(measure_speed(arguments.largest, repetitions, blender, arguments.write))
    if "threads" in arguments.tables:
        large = [case for case in growing_cases(arguments.largest) if len(case.triangles) >= LARGE]
        table = as_table(measure_threads(case, repetitions) for case in large if len(case.cones) < MANY)
        show(f"{THREADS}\n{table}")
    if "previews" in arguments.tables:
        table = as_table(measure_preview(case, repetitions) for case in preview_cases(arguments.largest))
        show(f"{PREVIEWS}\n{table}")
    small = small_cases(arguments.meshes)
    if "rounding" in arguments.tables:
        print("\nRounding angles and translations, repair included, as a multiple of the whole unwrap without it:\n")
        print(as_table(measure_rounding(case, repetitions) for case in small))
    if "shares" in arguments.tables:
        print(
            "\nChecks, the search for overlaps and repair, by wall-clock time, and their shares of the whole unwrap:\n"
        )
        print(as_table(measure_shares(case, repetitions) for case in small))
    if "stretch" in arguments.tables:
        beside_blender = as_table(measure_low_stretch(case, min(3, repetitions), blender) for case in dense_cases())
        show(f"{BESIDE_BLENDER}\n{beside_blender}")
        growing = [case for case in growing_cases(200_000) if len(case.cones) < MANY]
        show(f"{BESIDE_SLIM}\n{as_table(measure_slim(case) for case in growing)}")
    if "files" in arguments.tables:
        growing = [case for case in growing_cases(arguments.largest) if len(case.cones) < MANY]
        show(f"{FILES}\n{as_table(measure_files(case, min(3, repetitions)) for case in growing)}")
        show(f"{COMMAND}\n{as_table(measure_command(case, min(3, repetitions)) for case in growing)}")
        dense = [case for case in growing if len(case.triangles) < LARGE]
        show(f"{BESIDE_XATLAS}\n{as_table(measure_xatlas(case, 1) for case in dense)}")
    if arguments.write:
        page.append(goals())
        PAGE.write_text("\n\n".join(page) + "\n", encoding="utf-8")


def measure_speed(largest: int, repetitions: int, blender: str | None, writes: bool) -> str:
    """The page, written after every surface, so that a long run can be ended early."""
    laplacian = build_laplacian_program()
    if laplacian is None:
        print("The Laplacian is left out: CMake, a C++ compiler or Eigen is missing.", file=sys.stderr)
    rows: list[Measured] = []
    for case in growing_cases(largest):
        rows.append(measure(case, repetitions, laplacian, blender))
        print(f"{case.name}, {len(case.cones)} cones: {rows[-1].seconds}", file=sys.stderr)
        if writes:
            plot(rows, PLOT)
            PAGE.write_text(speed_page(rows) + "\n", encoding="utf-8")
    return speed_page(rows)


def speed_page(rows: list[Measured]) -> str:
    return f"""# Speed

Written by `python tools/benchmark/benchmark.py --tables speed threads previews stretch files --write`. All methods take
arrays and return texture coordinates, in alternating processes of their own; figures are CPU seconds of all threads,
medians of repetitions. Compare them with each other, not with those of another machine.

- **lsgp**: given cones, angles of least distortion, the Poisson map, its check and the search for overlaps, no repair.
- **angle edited**, **cone moved**: a repeated call of `lsgp.Solver`, which caches unchanged data.
- **LSCM**: that of libigl, on the surface cut open along lsgp's cuts, without continuity across them.
- **Blender**: with the same cuts marked as seams; Minimum Stretch with 10 iterations.
- **Laplacian**: analysis, factorization and one solve of the bare real cotangent Laplacian with one vertex fixed, a
  lower bound for any method with one Poisson solve.

The larger meshes are decimated and subdivided from `max-planck-25k`. Runs that would take too long are omitted.

![CPU seconds by triangles](../images/benchmark.svg)

{as_table(time_rows(rows))}

Ratios, the peak memory of the processes, Python and libraries included, and the defects of lsgp's unrepaired map:

{as_table(ratio_rows(rows))}

The stages of lsgp, with its CPU time divided in proportion to the wall-clock time of its stages. The factorization
counts as part of prescription, which needs it first. Editing an angle needs no factorization; the remaining stages are
linear passes over the whole surface: the frames and the solve for the two coordinates (unfold), and the measurements of
the map that is returned (check, layout, overlaps).

{as_table(stage_rows(rows))}

{WHAT_REMAINS}"""


def as_table(rows: Iterable[dict[str, object]]) -> str:
    rows = list(rows)
    columns = list(dict.fromkeys(column for row in rows for column in row))
    lines = ["| " + " | ".join(columns) + " |", "|---" + "|--:" * (len(columns) - 1) + "|"]
    lines += ["| " + " | ".join(str(row.get(column, "")) for column in columns) + " |" for row in rows]
    return "\n".join(lines)


if __name__ == "__main__":
    main()
