# SPDX-License-Identifier: GPL-3.0-or-later
"""A Dask cluster of processes of this machine."""

from __future__ import annotations

import contextlib
import random
import subprocess
import sys
import time
from pathlib import Path


class Cluster:
    """A scheduler and two workers with a thread each, processes of this machine."""

    def __init__(self, folder: Path) -> None:
        self.address_file = folder / "scheduler.json"
        self._folder = folder
        self._scheduler = self._start("scheduler", "--port", "0", "--no-dashboard")
        self.workers = [self._start_worker() for _ in range(2)]
        self.address = self._address()

    def _start(self, *arguments: str) -> subprocess.Popen[bytes]:
        command = [sys.executable, "-m", "distributed.cli.dask_" + arguments[0], *arguments[1:]]
        command += ["--scheduler-file", str(self.address_file), "--host", "127.0.0.1"]
        with (self._folder / f"{arguments[0]}.log").open("ab") as log:
            return subprocess.Popen(command, cwd=self._folder, stdout=log, stderr=log)

    def _address(self) -> str:
        from distributed import Client

        end = time.monotonic() + 60
        while not self.address_file.exists():
            assert time.monotonic() < end, "the scheduler does not start"
            time.sleep(0.1)
        with Client(scheduler_file=str(self.address_file)) as client:
            client.wait_for_workers(2, timeout=60)
            return client.scheduler.address

    def _start_worker(self) -> subprocess.Popen[bytes]:
        return self._start("worker", "--nthreads", "1", "--no-nanny", "--no-dashboard")

    def replace_worker(self, chance: random.Random) -> None:
        """Kill one of the workers and start another."""
        at = chance.randrange(len(self.workers))
        self.workers[at].kill()
        self.workers[at].wait()
        self.workers[at] = self._start_worker()

    def asset_processes(self) -> list[int]:
        """The processes of Linux that work on assets for the workers."""
        parents = {str(worker.pid) for worker in self.workers}
        found = []
        for folder in Path("/proc").glob("[0-9]*"):
            with contextlib.suppress(OSError):
                state, parent = (folder / "stat").read_text().rsplit(")", 1)[1].split()[:2]
                if parent in parents and state != "Z":
                    found.append(int(folder.name))
        return found

    def stop(self) -> None:
        for process in [self._scheduler, *self.workers]:
            process.kill()
            process.wait()
