# SPDX-License-Identifier: GPL-3.0-or-later
"""A trial of `lsgp batch` on 500 meshes: 460 generated or decimated shared ones, 40 malformed ones.

Every asset has to end with a result or a named refusal, results have to have the bytes of single runs, a run that is
killed in the middle has to go on without doing any twice.  Then it prints what the batch costs beside the work itself,
as the product of three shares:

- work: CPU seconds of reading, unwrapping and writing all meshes, of those of what a worker does on them, which makes
  records and draws pictures besides; in one process, in turn on each mesh;
- assets: what workers did on assets, of all CPU seconds of the batch, which starts them and writes the journal;
- busy: the share of the time of the run for which its workers are at work on an asset, so that what is missing is time
  in which they wait for a chunk, start, or have run out of assets.

The product is the throughput as a share of that of ideally scaled work.  Each share compares what happens at the same
time, so that it is right on a machine that does other things too, which a wall clock alone is not.

    python tools/benchmark/batch_trial.py [--folder build/batch_trial] [--jobs 2] [--large]

--large measures memory and time on larger meshes as well. Needs numpy, scipy and libigl beside lsgp.
"""

from __future__ import annotations

import argparse
import contextlib
import io
import json
import os
import resource
import shutil
import subprocess
import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SHARED = Path(os.environ.get("LSGP_SHARED") or ROOT.parent / "shared")
sys.path.insert(0, str(ROOT / "tests"))
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # as in workers

import igl  # noqa: E402 - the lines above come first
import meshes  # noqa: E402
import numpy as np  # noqa: E402
from lsgp.batch.assets import Asset  # noqa: E402
from lsgp.batch.tasks import Settings, Task  # noqa: E402
from lsgp.batch.work import unwrap_asset  # noqa: E402
from lsgp.cli import main as lsgp  # noqa: E402
from lsgp.errors import LsgpError  # noqa: E402
from lsgp.io.mesh_files import read_mesh  # noqa: E402
from lsgp.io.polygons import triangulate  # noqa: E402
from lsgp.run.unwrap_file import Run, unwrap_file  # noqa: E402
from lsgp.run.unwrap_options import add_unwrap_options  # noqa: E402

COUNT, MALFORMED = 500, 40
WORK, WITHOUT, WITH = "the work itself", "without pictures", "with pictures"
DECIMATED = (
    *("bird", "camel-head-disk", "cube-768", "eight-genus2", "elephant-genus3", "fandisk", "hand-5k", "igea-16k"),
    *("julius", "kitten-genus1", "max-planck-25k", "octa-flower", "rabbit"),
)
# From 5,120 triangles to 1,310,720.
LARGE = (*((meshes.bumpy_sphere, levels) for levels in (4, 5, 6, 7, 8)), (meshes.flower, 8))
LEAST_TRIANGLES, MOST_TRIANGLES = 1_000, 50_000


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--folder", type=Path, default=ROOT / "build" / "batch_trial")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--large", action="store_true")
    arguments = parser.parse_args()
    folder = arguments.folder
    library = folder / "library"
    if not library.exists():
        make_library(library)
    names = sorted(path.relative_to(library).as_posix() for path in library.rglob("*.off"))
    assert len(names) == COUNT
    shutil.rmtree(folder / "runs", ignore_errors=True)
    (folder / "runs").mkdir()

    costs, singles = single_runs(library, names, folder / "runs" / "single")
    print(f"{COUNT} meshes: {len(singles)} results, {COUNT - len(singles)} refused; CPU seconds:")
    for label, seconds in costs.items():
        print(f"  {seconds:.1f} {label}")
    for label, options in ((WITHOUT, ["--no-pictures"]), (WITH, [])):
        out = folder / "runs" / label.replace(" ", "-")
        measured = run_batch(library, out, arguments.jobs, *options)
        require_whole(out, names, singles)
        print(f"{label}: {measured.told(costs[WORK] / costs[label])}", flush=True)
    killed(library, folder / "runs" / "killed", arguments.jobs, names, singles)
    if arguments.large:
        large(folder)


# --- the meshes -----------------------------------------------------------------------------------------------------


def make_library(folder: Path) -> None:
    (folder / "good").mkdir(parents=True)
    (folder / "malformed").mkdir()
    good = good_meshes()
    for i in range(COUNT - MALFORMED):
        name, positions, triangles = next(good)
        write_off(folder / "good" / f"{i:03}-{name}.off", positions.tolist(), triangles.tolist())
    cases = [
        path for path in sorted((SHARED / "bad").glob("*.json")) if path.stem[0] in "bcda" and path.stem[1] in "_0"
    ]
    cases.sort(key=lambda path: "bcda".index(path.stem[0]))
    for path in cases[:MALFORMED]:
        case = json.loads(path.read_text())
        write_off(folder / "malformed" / f"{path.stem}.off", np.reshape(case["V"], (-1, 3)).tolist(), case["F"])


def good_meshes() -> Iterator[tuple[str, np.ndarray, np.ndarray]]:
    """Decimated shared meshes of many sizes, and generated ones between them, endlessly."""
    originals = {}
    for name in DECIMATED:
        mesh = read_mesh(SHARED / "meshes" / f"{name}.obj")
        originals[name] = mesh.positions, triangulate(mesh).triangles
    random = np.random.default_rng(1)
    made = [
        *(lambda i: meshes.bumpy_sphere(2 + i % 4), lambda i: meshes.torus(12 + i, 8 + i // 2)),
        *(lambda i: meshes.cube(3 + i % 20), lambda i: meshes.disk_with_holes(12 + 2 * (i % 8), 2)),
        *(lambda i: meshes.cylinder(12 + i, 6 + i // 3), lambda i: meshes.flower(3 + i % 3)),
    ]
    number = 0
    while True:
        for name, (positions, triangles) in originals.items():
            most = min(MOST_TRIANGLES, len(triangles))
            least = min(LEAST_TRIANGLES, most / 2)
            size = int(np.exp(random.uniform(np.log(least), np.log(most))))
            thinner = decimated(positions, triangles, size)
            yield f"{name}-{len(thinner[1])}", *thinner
            if number % 3 == 0:
                mesh = meshes.renumber(made[number // 3 % len(made)](number // 9), number)[0]
                yield f"made-{len(mesh.triangles)}", mesh.positions, mesh.triangles
            number += 1


def decimated(positions: np.ndarray, triangles: np.ndarray, size: int) -> tuple[np.ndarray, np.ndarray]:
    if size >= len(triangles):
        return positions, triangles
    out = igl.decimate(np.asarray(positions, float), np.asarray(triangles, np.int64), size)
    arrays = [part for part in out if isinstance(part, np.ndarray) and part.ndim == 2]
    return arrays[0], arrays[1]


def write_off(path: Path, positions: list, faces: list) -> None:
    lines = ["OFF", f"{len(positions)} {len(faces)} 0"]
    lines += [" ".join(map(repr, position)) for position in positions]
    lines += [" ".join(map(str, [len(face), *face])) for face in faces]
    path.write_text("\n".join(lines) + "\n")


# --- the runs -------------------------------------------------------------------------------------------------------


@dataclass
class Measured:
    """seconds: wall time of the run. cpu: of it and its workers. assets_cpu: of workers on assets. assets_seconds:
    the same by the clock."""

    jobs: int
    seconds: float
    cpu: float
    assets_cpu: float
    assets_seconds: float

    def told(self, work: float) -> str:
        assets, busy = self.assets_cpu / self.cpu, self.assets_seconds / (self.jobs * self.seconds)
        return (
            f"{self.seconds:.1f} s by the clock, {self.cpu:.1f} s of CPU; work {work:.1%}, assets {assets:.1%}, busy "
            f"{busy:.1%}: {work * assets * busy:.1%} of ideal throughput; "
            f"{3600 * COUNT / self.cpu:,.0f} assets a core-hour"
        )


def single_runs(library: Path, names: list[str], out: Path) -> tuple[dict[str, float], dict[str, bytes]]:
    """CPU seconds of each way to do all meshes, and by name the bytes of single runs that have a result."""
    parser = argparse.ArgumentParser()
    add_unwrap_options(parser)
    options = vars(parser.parse_args([]))
    settings = {label: Settings(options, pictures=label == WITH) for label in (WITHOUT, WITH)}
    seconds, results = dict.fromkeys((WORK, WITHOUT, WITH), 0.0), {}
    output = out / "single.obj"
    out.mkdir()
    for number, name in enumerate(names):
        for label in np.roll(list(seconds), number):  # none is always the first on a mesh, which is slower
            begin = time.process_time()
            if label == WORK:
                with contextlib.suppress(LsgpError):
                    unwrap_file(argparse.Namespace(input=library / name, output=output, threads=0, **options), Run())
            else:
                unwrap_asset(Task.of(Asset(name, library / name, 0), out, f"{name}.obj"), settings[label])
            seconds[label] += time.process_time() - begin
        with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
            code = lsgp(["unwrap", str(library / name), "-o", str(output)])
        assert code in (0, 3, 4)
        if code != 3:
            results[name] = output.read_bytes()
    return seconds, results


def run_batch(library: Path, out: Path, jobs: int, *options: str) -> Measured:
    begin, before = time.perf_counter(), resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(batch_command(library, out, jobs, *options), stdout=subprocess.DEVNULL, check=False)
    assert done.returncode == 4
    seconds, after = time.perf_counter() - begin, resource.getrusage(resource.RUSAGE_CHILDREN)
    cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    lines = lines_of(out)
    assets_cpu, assets_seconds = (sum(line[key] for line in lines) for key in ("cpu_seconds", "seconds"))
    return Measured(jobs, seconds, cpu, assets_cpu, assets_seconds)


def batch_command(library: Path, out: Path, jobs: int, *options: str) -> list[str]:
    return [sys.executable, "-m", "lsgp", "batch", str(library), "--out", str(out), "--jobs", str(jobs), *options]


def lines_of(out: Path) -> list[dict]:
    return [json.loads(line) for line in (out / "journal.jsonl").read_text().splitlines()]


def require_whole(out: Path, names: list[str], singles: dict[str, bytes]) -> None:
    """A line for every asset, a result or a named refusal, and the bytes of single runs."""
    lines = lines_of(out)
    assert sorted(line["asset"] for line in lines) == names
    for line in lines:
        if line["asset"] in singles:
            assert line["status"] == "ok" and (out / line["output"]).read_bytes() == singles[line["asset"]], line
        else:
            assert line["status"] == "refused" and line["code"] and line["message"], line
    assert sum(1 for _ in out.rglob("*.obj")) == len(singles)


def killed(library: Path, out: Path, jobs: int, names: list[str], singles: dict[str, bytes]) -> None:
    """Kill a run after half of its lines, and resume it."""
    process = subprocess.Popen(batch_command(library, out, jobs, "--no-pictures"), stdout=subprocess.DEVNULL)
    journal = out / "journal.jsonl"
    while not journal.exists() or journal.read_bytes().count(b"\n") < COUNT // 2:
        time.sleep(0.01)
    process.kill()
    process.wait()
    ended = lines_of(out)
    written = {line["output"]: (out / line["output"]).stat().st_mtime_ns for line in ended if line["output"]}
    assert subprocess.run([*batch_command(library, out, jobs, "--no-pictures"), "--only-missing"]).returncode == 4
    require_whole(out, names, singles)
    assert lines_of(out)[: len(ended)] == ended
    assert all((out / name).stat().st_mtime_ns == when for name, when in written.items())
    print(f"killed after {len(ended)} lines, went on with the other {COUNT - len(ended)}, did none twice")


def large(folder: Path) -> None:
    """Memory and time of larger meshes, each in a process of its own."""
    out, listed = folder / "runs" / "large", folder / "large.txt"
    (folder / "large").mkdir(exist_ok=True)
    for make, levels in LARGE:
        mesh = meshes.renumber(make(levels), levels)[0]
        path = folder / "large" / f"{len(mesh.triangles)}.off"
        if not path.exists():
            write_off(path, mesh.positions.tolist(), mesh.triangles.tolist())
        listed.write_text(f"large/{path.name}\n")
        subprocess.run(batch_command(listed, out, 1, "--only-missing"), stdout=subprocess.DEVNULL, check=True)
    for line in sorted(lines_of(out), key=lambda line: line["triangles"]):
        print(f"{line['triangles']} triangles: {line['peak_memory_mb']} MB, {line['cpu_seconds']:.2f} s of CPU")


if __name__ == "__main__":
    main()
