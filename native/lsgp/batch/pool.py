# SPDX-License-Identifier: GPL-3.0-or-later
"""A pool of worker processes: each gets chunks, and is watched.

A worker that dies, or works on an asset for too long, costs that asset; the others of its chunk go to the next worker.
"""

from __future__ import annotations

import contextlib
import json
import os
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass, field
from queue import Empty, SimpleQueue

from .assets import Asset
from .chunks import Queue
from .records import FAILED, Record, ending
from .tasks import Settings, Task
from .worker import MARK

PYTHON_WORKER = (sys.executable, "-P", "-m", "lsgp.batch.worker")
ASSETS_PER_WORKER = 256
MOST_FAILED_STARTS = 3
START_SECONDS = 120.0
END_SECONDS = 10.0
STDERR_SHOWN = 400


class WorkersError(Exception):
    """Workers cannot be started."""


@dataclass
class _Worker:
    """A worker process. waiting: the assets it was given and has not answered on; it works on the first of them.

    since: when it began with that, or was started, by time.monotonic. deadline seconds after that it is ended.
    """

    process: subprocess.Popen[bytes]
    errors: object
    since: float
    name: str | None = None
    waiting: deque[Asset] = field(default_factory=deque)
    answered: int = 0
    late: bool = False

    def __hash__(self) -> int:
        return id(self)

    def send(self, value: object) -> None:
        with contextlib.suppress(OSError):  # it has died; the end of its output says so too
            self.process.stdin.write(json.dumps(value).encode("ascii") + b"\n")
            self.process.stdin.flush()


class Pool:
    """jobs: processes at a time. task_of: what a worker is told of an asset. command: that starts a worker.

    seconds: an asset may take, None for any time. assets_per_worker: after so many a process makes room for a new one,
    which keeps whatever piles up in long-lived processes small.
    """

    def __init__(
        self,
        jobs: int,
        settings: Settings,
        task_of: Callable[[Asset], Task],
        command: Sequence[str] = PYTHON_WORKER,
        seconds: float | None = None,
        assets_per_worker: int = ASSETS_PER_WORKER,
    ) -> None:
        self._jobs = jobs
        self._settings = settings
        self._task_of = task_of
        self._command = list(command)
        self._seconds = seconds
        self._assets_per_worker = assets_per_worker
        self._workers: list[_Worker] = []
        self._events: SimpleQueue[tuple[_Worker, Record | None]] = SimpleQueue()
        self._failed_starts = 0

    def run(self, assets: Sequence[Asset]) -> Iterator[Record]:
        """The record of each asset, in the order in which they end.  Raises WorkersError.

        All processes have ended when the iterator is exhausted or closed.
        """
        queue = Queue(assets, self._jobs)
        try:
            while True:
                self._hand_out(queue)
                if not self._workers:
                    return
                event = self._next_event()
                if event is not None:
                    yield from self._answered(*event, queue)
                yield from self._end_late_ones(queue)
        finally:
            self._end_all()

    def _hand_out(self, queue: Queue) -> None:
        """Give every worker without work a chunk, start workers, and let those go for whom there is nothing to do."""
        for worker in list(self._workers):
            if not worker.waiting and (not queue or worker.answered >= self._assets_per_worker):
                self._let_go(worker)
        for _ in range(self._jobs):
            idle = next((worker for worker in self._workers if not worker.waiting), None)
            if not queue or (idle is None and len(self._workers) >= self._jobs):
                return
            worker = self._start() if idle is None else idle
            worker.since = time.monotonic()
            worker.waiting.extend(queue.take())
            for asset in worker.waiting:
                worker.send(asdict(self._task_of(asset)))

    def _start(self) -> _Worker:
        errors = tempfile.TemporaryFile()  # noqa: SIM115 - open as long as the process
        environment = {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"} | os.environ
        try:
            process = subprocess.Popen(
                self._command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=errors, env=environment
            )
        except OSError as error:
            errors.close()
            raise WorkersError(f"no worker process can be started: {self._command[0]}: {error.strerror}") from error
        worker = _Worker(process, errors, time.monotonic())
        self._workers.append(worker)
        worker.send(self._settings.to_plain())
        threading.Thread(target=_listen, args=(worker, self._events), daemon=True).start()
        return worker

    def _next_event(self) -> tuple[_Worker, Record | None] | None:
        """What a worker said, None for its end; nothing where the first deadline has passed before that."""
        deadlines = [self._deadline(worker) for worker in self._workers]
        first = min((deadline for deadline in deadlines if deadline is not None), default=None)
        try:
            return self._events.get(timeout=None if first is None else max(0.0, first - time.monotonic()))
        except Empty:
            return None

    def _deadline(self, worker: _Worker) -> float | None:
        if worker.name is None:
            return worker.since + START_SECONDS
        return None if self._seconds is None else worker.since + self._seconds

    def _answered(self, worker: _Worker, said: Record | None, queue: Queue) -> Iterator[Record]:
        if worker not in self._workers:
            return  # ended before it was heard
        if said is None:
            yield from self._ended(worker, queue)
        elif "ready" in said:
            worker.name = said["ready"]
            worker.since = time.monotonic()
            self._failed_starts = 0
        else:
            worker.waiting.popleft()
            worker.answered += 1
            worker.since = time.monotonic()
            yield said

    def _end_late_ones(self, queue: Queue) -> Iterator[Record]:
        now = time.monotonic()
        for worker in list(self._workers):
            deadline = self._deadline(worker)
            if worker.waiting and deadline is not None and now >= deadline:
                worker.late = True
                worker.process.kill()
                yield from self._ended(worker, queue)

    def _ended(self, worker: _Worker, queue: Queue) -> Iterator[Record]:
        """A process that has ended by itself or was ended: the asset it was working on pays for it."""
        seconds = time.monotonic() - worker.since
        self._workers.remove(worker)
        code = worker.process.wait()
        printed = _end_of(worker.errors)
        _close(worker)
        if worker.name is None:
            self._failed_starts += 1
            if self._failed_starts >= MOST_FAILED_STARTS:
                raise WorkersError(
                    f"no worker process can be started: it {_way_of_ending(code)} at its start: {printed}"
                )
        elif worker.waiting:
            asset = worker.waiting.popleft()
            figures = {"input_bytes": asset.size, "seconds": round(seconds, 6), "worker": worker.name}
            yield self._blame(asset, worker, code, printed) | figures | {"options": self._settings.digest()}
        queue.put_back(worker.waiting)

    def _blame(self, asset: Asset, worker: _Worker, code: int, printed: str) -> Record:
        if worker.late:
            message = f"It took longer than {self._seconds:g} s and was ended. Allow more time with --timeout."
            return ending(FAILED, "TIMED_OUT", message, asset=asset.name)
        hint = " Memory may have run out." if code == -getattr(signal, "SIGKILL", 0) else ""
        detail = f" It printed: {printed}" if printed else ""
        message = f"The process that worked on it {_way_of_ending(code)}.{hint}{detail}"
        return ending(FAILED, "CRASHED", message, asset=asset.name)

    def _let_go(self, worker: _Worker) -> None:
        self._workers.remove(worker)
        worker.process.stdin.close()
        try:
            worker.process.wait(END_SECONDS)
        except subprocess.TimeoutExpired:
            worker.process.kill()
            worker.process.wait()
        _close(worker)

    def _end_all(self) -> None:
        for worker in self._workers:
            worker.process.kill()
            worker.process.wait()
            _close(worker)
        self._workers.clear()


def _listen(worker: _Worker, events: SimpleQueue[tuple[_Worker, Record | None]]) -> None:
    mark = MARK.encode("ascii")
    with worker.process.stdout as lines:
        for line in lines:
            if line.startswith(mark):
                events.put((worker, json.loads(line[len(mark) :])))
    events.put((worker, None))


def _close(worker: _Worker) -> None:
    for pipe in (worker.process.stdin, worker.errors):
        with contextlib.suppress(OSError):  # what was still to be said to it
            pipe.close()


def _end_of(errors: object) -> str:
    """The last of what the process printed, on one line."""
    errors.seek(0)
    text = errors.read().decode("utf-8", "replace")
    return " ".join(text.split())[-STDERR_SHOWN:]


def _way_of_ending(code: int) -> str:
    if code >= 0:
        return f"ended with exit code {code}"
    try:
        return f"was ended by {signal.Signals(-code).name}"
    except ValueError:
        return f"was ended by signal {-code}"
