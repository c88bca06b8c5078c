# SPDX-License-Identifier: GPL-3.0-or-later
"""A pool of worker processes, which get chunks of assets and are monitored.

If a worker dies or exceeds the time limit, the asset it was working on fails; the rest of its chunk goes to another
worker.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Sequence
from queue import Empty, SimpleQueue

from .assets import Asset
from .chunks import Queue
from .records import FAILED, Record, ending
from .tasks import Settings, Task
from .worker_process import WorkerProcess, WorkersError

PYTHON_WORKER = (sys.executable, "-P", "-m", "lsgp.batch.worker")
ASSETS_PER_WORKER = 256
MOST_FAILED_STARTS = 3
WANTED_SECONDS = 1.0


class Pool:
    """jobs: processes at a time. task_of: makes the task of an asset. command: starts a worker.

    seconds: time limit of an asset, None for no limit. assets_per_worker: a process is replaced after this many assets,
    which bounds what leaks in long-lived processes. is_wanted: asked every second; the run ends when it says no. tell:
    is told every second, or sooner, which parts of assets are done, by their names.
    """

    def __init__(
        self,
        jobs: int,
        settings: Settings,
        task_of: Callable[[Asset], Task],
        command: Sequence[str] = PYTHON_WORKER,
        seconds: float | None = None,
        assets_per_worker: int = ASSETS_PER_WORKER,
        is_wanted: Callable[[], bool] | None = None,
        tell: Callable[[dict[str, float]], None] | None = None,
    ) -> None:
        self._jobs = jobs
        self._settings = settings
        self._task_of = task_of
        self._command = command
        self._seconds = seconds
        self._assets_per_worker = assets_per_worker
        self._is_wanted, self._tell = is_wanted, tell
        self._workers: list[WorkerProcess] = []
        self._said: SimpleQueue[tuple[WorkerProcess, Record | None]] = SimpleQueue()
        self._failed_starts = 0

    def run(self, assets: Sequence[Asset]) -> Iterator[Record]:
        """The record of each asset, in the order in which they end.  Raises WorkersError.

        All processes have ended when the iterator is exhausted or closed.
        """
        queue = Queue(assets, self._jobs)
        try:
            while True:
                self._hand_out(queue)
                if not self._workers or (self._is_wanted is not None and not self._is_wanted()):
                    return
                yield from self._hear(queue)
                yield from self._end_late_ones(queue)
                if self._tell is not None:
                    self._tell({worker.waiting[0].name: worker.share for worker in self._workers if worker.waiting})
        finally:
            for worker in self._workers:
                worker.end(patience=0)
            self._workers.clear()

    def _hand_out(self, queue: Queue) -> None:
        """Give every idle worker a chunk, start workers, and stop those for which no work is left."""
        for worker in list(self._workers):
            if not worker.waiting and (not queue or worker.answered >= self._assets_per_worker):
                self._workers.remove(worker)
                worker.end()
        idle = [worker for worker in self._workers if not worker.waiting]
        while queue and (idle or len(self._workers) < self._jobs):
            worker = idle.pop() if idle else self._start()
            worker.give(queue.take(), self._task_of)

    def _start(self) -> WorkerProcess:
        worker = WorkerProcess(self._command, self._settings, self._said)
        self._workers.append(worker)
        return worker

    def _hear(self, queue: Queue) -> Iterator[Record]:
        """The records that a worker's next message brings; none when a time limit passes before."""
        left = [worker.seconds_left(self._seconds) for worker in self._workers]
        if self._is_wanted is not None or self._tell is not None:
            left.append(WANTED_SECONDS)
        first = min((seconds for seconds in left if seconds is not None), default=None)
        try:
            worker, said = self._said.get(timeout=None if first is None else max(0.0, first))
        except Empty:
            return
        if worker not in self._workers:
            return  # ended before it was heard
        if said is None:
            yield from self._ended(worker, queue)
        elif (record := worker.take_in(said)) is not None:
            yield record
        else:
            self._failed_starts = 0

    def _end_late_ones(self, queue: Queue) -> Iterator[Record]:
        for worker in list(self._workers):
            left = worker.seconds_left(self._seconds)
            if worker.waiting and left is not None and left <= 0:
                yield from self._ended(worker, queue, late=True)

    def _ended(self, worker: WorkerProcess, queue: Queue, late: bool = False) -> Iterator[Record]:
        """A process has ended, or is ended because it exceeded its time limit: the asset it was working on fails."""
        seconds = worker.seconds()
        self._workers.remove(worker)
        way, printed = worker.end(patience=0) if late else worker.end()
        if worker.name is None:
            self._failed_starts += 1
            if self._failed_starts >= MOST_FAILED_STARTS:
                raise WorkersError(f"no worker process can be started: it {way} at its start: {printed}")
        elif worker.waiting:
            asset = worker.waiting.popleft()
            if late:
                reason = f"It took longer than {self._seconds:g} s and was ended. Allow more time with --timeout."
            else:
                reason = f"The process that worked on it {way}.{f' It printed: {printed}' if printed else ''}"
            yield ending(
                FAILED,
                "TIMED_OUT" if late else "CRASHED",
                reason,
                asset=asset.name,
                input_bytes=asset.size,
                seconds=round(seconds, 6),
                worker=worker.name,
                options=self._settings.digest(),
            )
        queue.put_back(worker.waiting)
