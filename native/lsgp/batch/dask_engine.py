# SPDX-License-Identifier: GPL-3.0-or-later
"""A run on the workers of a Dask cluster, which needs the files under the same paths and the same version of lsgp.

A chunk is a task of Dask's, which moves it to another worker where one is lost.  In the task it goes to a process of
its own, as on one machine, so that no mesh can crash a worker of Dask's.  When the batch has ended, also by being
killed, Dask cancels its tasks; the process ends then, so that it writes nothing beside a later run.
"""

from __future__ import annotations

import argparse
import os
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

from ..io.side_files import UsageError
from .assets import Asset
from .chunks import Queue
from .pool import ASSETS_PER_WORKER, Pool
from .records import FAILED, Record, ending
from .tasks import Settings, Task
from .worker_process import WorkersError

CHUNKS_PER_THREAD = 2
CONNECT_SECONDS = 30


@dataclass(frozen=True)
class Cluster:
    """The scheduler's address, and the PEM files of mutual TLS authentication; None: those of Dask's configuration."""

    address: str
    tls_ca_file: str | None = None
    tls_client_cert: str | None = None
    tls_client_key: str | None = None

    @classmethod
    def of(cls, args: argparse.Namespace) -> Cluster | None:
        """None where the batch runs on this machine.  Raises UsageError."""
        if args.scheduler is None:
            if any(vars(args).get(name) for name in ("tls_ca_file", "tls_cert", "tls_key")):
                raise UsageError(
                    "--tls-ca-file, --tls-cert and --tls-key are for a --scheduler; name one or leave them out"
                )
            return None
        files = (args.tls_ca_file, args.tls_cert, args.tls_key)
        if any(files):
            if not args.scheduler.startswith("tls://"):
                raise UsageError(f"'{args.scheduler}' does not use TLS; name the scheduler as tls://host:port")
            if args.tls_ca_file is None or args.tls_cert is None:
                raise UsageError("--tls-ca-file and --tls-cert belong together; give both")
        for path in files:
            if path is not None and not os.path.isfile(path):
                raise UsageError(f"there is no file '{path}' for TLS")
        return cls(args.scheduler, *files)


def run_on_cluster(
    cluster: Cluster,
    settings: Settings,
    task_of: Callable[[Asset], Task],
    assets: Sequence[Asset],
    seconds: float | None,
) -> Iterator[Record]:
    """The record of each asset, once.  seconds: an asset may take.  Raises UsageError, WorkersError."""
    try:
        from distributed import as_completed
    except ImportError as error:
        raise UsageError("--scheduler needs Dask; install it with: pip install lsgp[dask]") from error
    with _connect(cluster) as client:
        queue = Queue(assets, max(1, _threads(client)), ASSETS_PER_WORKER)
        chunk_of = {}
        running = as_completed(loop=client.loop)
        while queue or chunk_of:
            while queue and len(chunk_of) < CHUNKS_PER_THREAD * max(1, _threads(client)):
                chunk = queue.take()
                tasks = [(asset, task_of(asset)) for asset in chunk]
                future = client.submit(work_on_chunk, tasks, settings, seconds, pure=False)
                chunk_of[future] = chunk
                running.add(future)
            future = next(running)
            yield from _records_of(future, chunk_of.pop(future), settings)


def work_on_chunk(tasks: Sequence[tuple[Asset, Task]], settings: Settings, seconds: float | None) -> list[Record]:
    """The task that a Dask worker runs: the chunk, in a process of its own, until nobody waits for it any more."""
    from distributed import get_worker

    task_of = dict(tasks)
    known, key = get_worker().state.tasks, get_worker().get_current_task()

    def is_wanted() -> bool:
        return key in known and known[key].state != "cancelled"

    pool = Pool(1, settings, task_of.__getitem__, seconds=seconds, is_wanted=is_wanted)
    return list(pool.run(list(task_of)))


def _connect(cluster: Cluster):
    """A client of Dask's.  Raises UsageError."""
    from distributed import Client
    from distributed.security import Security

    try:
        files = {name: value for name, value in vars(cluster).items() if name != "address" and value is not None}
        security = Security(require_encryption=True, **files) if files else None
        return Client(cluster.address, timeout=CONNECT_SECONDS, set_as_default=False, security=security)
    except (OSError, ValueError, TypeError, RuntimeError) as error:  # by what is wrong: the network, address, TLS
        raise UsageError(f"no Dask scheduler answers at '{cluster.address}': {error}") from error


def _threads(client) -> int:
    return sum(client.nthreads().values())


def _records_of(future, chunk: Sequence[Asset], settings: Settings) -> Iterator[Record]:
    """Raises WorkersError where the cluster cannot be used at all."""
    from distributed import KilledWorker

    if future.status == "cancelled":
        raise WorkersError("the scheduler is gone; go on with --only-missing once it is back")
    error = future.exception() if future.status == "error" else None
    if isinstance(error, KilledWorker):
        message = "Several workers were lost that had it. See what happened to them, then go on with --only-missing."
        for asset in chunk:
            yield ending(FAILED, "WORKERS_LOST", message, asset=asset.name, options=settings.digest())
        return
    if error is not None:
        raise WorkersError(f"a worker cannot do the work: {type(error).__name__}: {error}") from error
    for record in future.result():
        if record["options"] != settings.digest():
            raise WorkersError("the workers have another version of lsgp; install the same on all")
        yield record
