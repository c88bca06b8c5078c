# SPDX-License-Identifier: GPL-3.0-or-later
"""Batches that are killed or asked to end at random moments and resumed, on this machine and on Dask: nothing is lost
or done twice, and neither processes nor temporary files stay behind.

Continuous integration runs a few; LSGP_FULL_SWEEP=1 runs fifty of each kind.
"""

from __future__ import annotations

import contextlib
import json
import os
import random
import shutil
import signal
import subprocess
import sys
import time
import uuid
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest
from batch_meshes import obj_text, off_text
from dask_cluster import Cluster
from lsgp.run.exit_codes import TERMINATED
from meshes import Mesh, bumpy_sphere, moebius_strip, renumber
from nightly import EVERYTHING

pytestmark = pytest.mark.skipif(not Path("/proc/self/environ").exists(), reason="processes are found by way of Linux")

TRIALS = range(50 if EVERYTHING else 1)
MOST_KILLS = 3 if EVERYTHING else 1
COUNT = 16
# What processes have to end, at most; they take milliseconds.
END_SECONDS = 60.0
MARK = "LSGP_KILLED_BATCH"


def processes_with(mark: str) -> list[int]:
    """Those that have it in their environment, and so those that they started."""
    found = []
    for folder in Path("/proc").glob("[0-9]*"):
        with contextlib.suppress(OSError):
            if f"{MARK}={mark}".encode() in (folder / "environ").read_bytes().split(b"\0"):
                found.append(int(folder.name))
    return found


def wait_until(condition: Callable[[], bool], what: str) -> None:
    end = time.monotonic() + END_SECONDS
    while not condition():
        assert time.monotonic() < end, what
        time.sleep(0.02)


@dataclass
class Library:
    """Meshes, and what an undisturbed run makes of them.

    seconds: that it takes. in_place: results are written over the meshes. results, codes: by asset, the bytes of its
    result or why there is none.
    """

    folder: Path
    in_place: bool
    seconds: float
    results: dict[str, bytes]
    codes: dict[str, str | None]

    @classmethod
    def of(cls, meshes: dict[str, str], folder: Path, *, in_place: bool) -> Library:
        """meshes: the files by their names."""
        made = cls(folder / "library", in_place, 0.0, {}, {})
        for name, text in meshes.items():
            (made.folder / name).parent.mkdir(parents=True, exist_ok=True)
            (made.folder / name).write_text(text)
        out = made.start(folder / "undisturbed")
        begin = time.monotonic()
        assert subprocess.run(made.command(out), stdout=subprocess.DEVNULL).returncode == 4
        made.seconds = time.monotonic() - begin
        for line in lines_of(out):
            made.codes[line["asset"]] = line["code"]
            if line["output"]:
                made.results[line["asset"]] = (out / line["output"]).read_bytes()
        assert len(made.codes) == COUNT and len(made.results) == COUNT - COUNT // 8
        return made

    def start(self, out: Path) -> Path:
        """The folder of a new run: with the meshes, where they are written over."""
        if self.in_place:
            shutil.copytree(self.folder, out)
        return out

    def command(self, out: Path, *options: str) -> list[str]:
        source, own = (out, ["--in-place"]) if self.in_place else (self.folder, [])
        return [sys.executable, "-m", "lsgp", "batch", str(source), "--out", str(out), "--reports", *own, *options]

    def require_whole(self, out: Path, before: list[list[dict]]) -> None:
        """before: the lines at each kill, which stay; only what failed is done again."""
        journal = lines_of(out)
        for lines in before:
            assert journal[: len(lines)] == lines
        final = [line for line in journal if line["status"] != "failed"]
        assert {line["asset"]: line["code"] for line in final} == self.codes
        assert len(final) == len(self.codes)
        refused = {name for name, code in self.codes.items() if code} if self.in_place else set()
        outputs = {line["output"]: line["asset"] for line in final if line["output"]}
        found = {path.relative_to(out).as_posix(): path.read_bytes() for path in out.rglob("*.obj")}
        assert found.keys() - refused == outputs.keys()
        for output, name in outputs.items():
            assert found[output] == self.results[name]
            assert json.loads((out / f"{output}.report.json").read_bytes())["status"] == "ok"
            assert (out / "pictures" / f"{name}.png").read_bytes().startswith(b"\x89PNG")
        assert (out / "summary.txt").read_text().startswith(f"{COUNT} assets\n")
        assert (out / "contact-sheet.html").read_bytes().endswith(b"</html>\n")
        names = [path.name for path in out.rglob("*")]
        assert not [name for name in names if name.startswith(".lsgp-") or name.endswith(".lsgp-backup")]


def lines_of(out: Path) -> list[dict]:
    """The whole lines of the journal."""
    path = out / "journal.jsonl"
    if not path.exists():
        return []
    return [json.loads(line) for line in path.read_bytes().splitlines(keepends=True) if line.endswith(b"\n")]


def times_of(out: Path, lines: list[dict]) -> dict[str, int]:
    """When the results of these lines were written."""
    return {line["output"]: (out / line["output"]).stat().st_mtime_ns for line in lines if line["output"]}


def meshes(text_of: Callable[[Mesh], str], suffix: str) -> dict[str, str]:
    """Files of spheres, of which every eighth is a Moebius strip, which is refused."""
    made = (moebius_strip() if i % 8 == 7 else renumber(bumpy_sphere(2 + i % 2), i)[0] for i in range(COUNT))
    return {f"{i:02}{suffix}" if i % 3 else f"deep/{i:02}{suffix}": text_of(mesh) for i, mesh in enumerate(made)}


@pytest.fixture(scope="module")
def library(tmp_path_factory: pytest.TempPathFactory) -> Library:
    return Library.of(meshes(off_text, ".off"), tmp_path_factory.mktemp("files"), in_place=False)


@pytest.fixture(scope="module")
def own_library(tmp_path_factory: pytest.TempPathFactory) -> Library:
    """Whose meshes are written over."""
    return Library.of(meshes(obj_text, ".obj"), tmp_path_factory.mktemp("files"), in_place=True)


@pytest.fixture(scope="module")
def cluster(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Cluster]:
    pytest.importorskip("distributed")
    started = Cluster(tmp_path_factory.mktemp("cluster"))
    yield started
    started.stop()


def killed_and_resumed(
    library: Library, out: Path, chance: random.Random, kills: dict[str, Callable], *options: str
) -> None:
    """Runs that are killed, then one that is not.

    kills: ways to do it; each takes the process that has been started and the mark of all that it starts.
    """
    before, written = [], {}
    library.start(out)
    for _ in range(chance.randint(1, MOST_KILLS)):
        mark = uuid.uuid4().hex
        command = library.command(out, *options, *(["--only-missing"] if before or chance.random() < 0.5 else []))
        process = subprocess.Popen(
            command, stdout=subprocess.DEVNULL, env=os.environ | {MARK: mark}, start_new_session=True
        )
        time.sleep(chance.uniform(0.0, 1.2 * library.seconds))
        kills[chance.choice(list(kills))](process, mark)
        assert process.wait(300) in (-signal.SIGKILL, -signal.SIGTERM, TERMINATED, 4)
        wait_until(lambda mark=mark: not processes_with(mark), "processes outlive the run that started them")
        before.append(lines_of(out))
        written = require_kept(out, written) | times_of(out, before[-1])
    done = subprocess.run(library.command(out, *options, "--only-missing"), capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (4, "")
    library.require_whole(out, before)
    require_kept(out, written)


def require_kept(out: Path, written: dict[str, int]) -> dict[str, int]:
    """Results that had a line are not written again."""
    assert {name: (out / name).stat().st_mtime_ns for name in written} == written
    return written


def kill_main(process: subprocess.Popen[bytes], mark: str) -> None:
    process.kill()


def kill_group(process: subprocess.Popen[bytes], mark: str) -> None:
    """It and all that it started."""
    os.killpg(process.pid, signal.SIGKILL)


def kill_worker(process: subprocess.Popen[bytes], mark: str) -> None:
    """One of those that it started."""
    for pid in [pid for pid in processes_with(mark) if pid != process.pid][:1]:
        with contextlib.suppress(ProcessLookupError):
            os.kill(pid, signal.SIGKILL)


def ask_main(process: subprocess.Popen[bytes], mark: str) -> None:
    """As a scheduler does; while Python starts it ends at once."""
    process.terminate()


LOCAL = {"main": kill_main, "group": kill_group, "worker": kill_worker, "asked": ask_main}


@pytest.mark.slow
@pytest.mark.parametrize("seed", TRIALS)
def test_on_this_machine(library: Library, tmp_path: Path, seed: int) -> None:
    killed_and_resumed(library, tmp_path / "out", random.Random(seed), LOCAL, "--jobs", "2")


@pytest.mark.parametrize("seed", TRIALS)
def test_in_place(own_library: Library, tmp_path: Path, seed: int) -> None:
    """A mesh is there as it was or with its result, whole, at any moment."""
    killed_and_resumed(own_library, tmp_path / "out", random.Random(100 + seed), LOCAL, "--jobs", "2")


@pytest.mark.parametrize("seed", TRIALS)
def test_on_dask(library: Library, cluster: Cluster, tmp_path: Path, seed: int) -> None:
    """The batch is killed, whose tasks end then, or one of Dask's workers, which another one replaces."""
    chance = random.Random(200 + seed)

    def kill_client(process: subprocess.Popen[bytes], mark: str) -> None:
        process.kill()
        wait_until(lambda: not cluster.asset_processes(), "tasks outlive the batch that started them")

    def ask_client(process: subprocess.Popen[bytes], mark: str) -> None:
        process.terminate()
        wait_until(lambda: not cluster.asset_processes(), "tasks outlive the batch that started them")

    def replace_worker(process: subprocess.Popen[bytes], mark: str) -> None:
        cluster.replace_worker(chance)

    kills = {"client": kill_client, "group": kill_group, "worker": replace_worker, "asked": ask_client}
    killed_and_resumed(library, tmp_path / "out", chance, kills, "--scheduler", cluster.address)
