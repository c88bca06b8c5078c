# SPDX-License-Identifier: GPL-3.0-or-later
"""`lsgp batch`: its options and a run from the list of assets to the summary."""

from __future__ import annotations

import argparse
import os
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from .. import exit_codes
from ..mesh_files import remove_old_partials, write_whole
from ..side_files import UsageError
from ..terminal import ProgressLine, say
from .assets import Asset, find_assets, output_name, require_distinct_results, shard_option
from .contact_sheet import write_contact_sheet
from .dask_engine import run_on_cluster
from .journal import Journal, read_records
from .pool import PYTHON_WORKER, Pool
from .progress import RunProgress, duration
from .records import FAILED, OK, Record
from .summary import summary_table
from .tasks import Settings, Task
from .worker_process import WorkersError

EXIT_CODES = (
    "Exit code: 0 all assets have a result, 4 some of them, 3 none; 2 wrong usage or a folder that is missing or not "
    "writable, 130 interrupted."
)


@dataclass(frozen=True)
class Kind:
    """What tells the batches of one program from those of another.

    suffixes: of the files in a folder that are assets. output_name: the name of an asset's result.
    worker: the command that starts a worker process.
    """

    suffixes: Sequence[str]
    output_name: Callable[[str], str]
    worker: Sequence[str]


MESH_FILES = Kind((".obj", ".off", ".ply"), output_name, PYTHON_WORKER)


def add_batch_options(batch: argparse.ArgumentParser) -> None:
    """The options of a batch beside those of an unwrap."""
    batch.add_argument("source", metavar="LIST|FOLDER", type=Path, help="files, one a line, or a folder, at any depth")
    batch.add_argument("--out", metavar="DIR", type=Path, required=True, help="folder of the results; made if missing")
    batch.add_argument("--jobs", metavar="N", type=_count_option, help="processes at a time (default: one each core)")
    batch.add_argument("--shard", metavar="i/n", type=shard_option, help="only the i-th of n parts, for array jobs")
    batch.add_argument(
        "--only-missing",
        action="store_true",
        help="go on with an earlier run: leave out what has a result or was refused, try again what failed",
    )
    batch.add_argument("--timeout", metavar="S", type=_seconds_option, help="seconds an asset may take")
    batch.add_argument("--memory-limit", metavar="MB", type=_count_option, help="memory an asset may take (Linux)")
    batch.add_argument(
        "--exit-zero", action="store_true", help="exit code 0 once all assets have ended, for farms that repeat tasks"
    )
    batch.add_argument("--reports", action="store_true", help="write the report of each result beside it")
    batch.add_argument(
        "--no-pictures", dest="pictures", action="store_false", help="draw no pictures and no contact sheet"
    )


def add_scheduler_option(batch: argparse.ArgumentParser) -> None:
    batch.add_argument(
        "--scheduler", metavar="ADDRESS", help="work on the Dask cluster with this scheduler, tcp://host:8786 for one"
    )


def main(argv: Sequence[str], kind: Kind, parser: argparse.ArgumentParser) -> int:
    """Run the command line of a batch program and return its exit code."""
    try:
        args = parser.parse_args(argv)
    except SystemExit as end:  # argparse has said why
        return int(end.code or 0)
    return exit_codes.ended(lambda: run_batch(args, kind))


def run_batch(args: argparse.Namespace, kind: Kind = MESH_FILES) -> int:
    """Run a batch and return its exit code.  Raises OSError, UsageError, KeyboardInterrupt."""
    if args.jobs is not None and args.scheduler is not None:
        raise UsageError("--jobs is for this machine; how many jobs a cluster does is told to its workers")
    if args.memory_limit is not None and not sys.platform.startswith("linux"):
        raise UsageError("--memory-limit works on Linux only; leave it out")
    settings = Settings.of(args)
    assets = find_assets(args.source, args.out, kind.suffixes, args.shard)
    require_distinct_results(assets, (kind.output_name(asset.name) for asset in assets))
    args.out.mkdir(parents=True, exist_ok=True)
    if args.shard is None:
        remove_old_partials(args.out)
    begin = time.monotonic()
    with Journal(args.out, args.shard, keep=args.only_missing) as journal:
        ended = _ended_before(args, assets, settings) if args.only_missing else {}
        missing = [asset for asset in assets if asset.name not in ended]
        with ProgressLine(sys.stderr) as line:
            show = RunProgress(line, assets, ended.values())
            for record in _records(args, missing, settings, kind):
                journal.write(record)
                ended[record["asset"]] = record
                show(record)
    records = [ended[asset.name] for asset in assets]
    _conclude(args, records, len(missing), time.monotonic() - begin)
    results = sum(record["status"] == OK for record in records)
    if args.exit_zero or results == len(records):
        return exit_codes.OK
    return exit_codes.SOME if results else exit_codes.REFUSED


def _ended_before(args: argparse.Namespace, assets: Sequence[Asset], settings: Settings) -> dict[str, Record]:
    """Of these assets the records that stay: refusals, and results that are still there."""
    names = {asset.name for asset in assets}
    records = read_records(args.out, args.shard)
    stay = {
        name: record
        for name, record in records.items()
        if name in names and record["status"] != FAILED and (record["status"] != OK or _is_there(args.out, record))
    }
    if {record["options"] for record in stay.values()} - {settings.digest()}:
        raise UsageError(
            f"'{args.out}' has results of other options or another version; name another folder, or leave out "
            "--only-missing to make all of them anew"
        )
    return stay


def _is_there(out: Path, record: Record) -> bool:
    return Path(out, record["output"]).is_file()


def _records(args: argparse.Namespace, assets: Sequence[Asset], settings: Settings, kind: Kind) -> Iterator[Record]:
    def task_of(asset: Asset) -> Task:
        return Task.of(asset, args.out, kind.output_name(asset.name))

    if not assets:
        return
    try:
        if args.scheduler is not None:
            yield from run_on_cluster(args.scheduler, settings, task_of, assets, args.timeout)
        else:
            jobs = min(args.jobs or _cores(), len(assets))
            yield from Pool(jobs, settings, task_of, kind.worker, args.timeout).run(assets)
    except WorkersError as error:
        raise UsageError(str(error)) from error


def _conclude(args: argparse.Namespace, records: Sequence[Record], worked: int, seconds: float) -> None:
    """Say what the run came to; of the whole of it, not of a shard, in files as well."""
    table = summary_table(records)
    if args.shard is None:
        write_whole(args.out / "summary.txt", f"{table}\n".encode("utf-8", "replace"))
    say(sys.stdout, f"{table}\n{worked} of them in this run, in {duration(seconds)}")
    if args.shard is None and args.pictures:
        say(sys.stdout, f"contact sheet: {write_contact_sheet(args.out, records)}")


def _cores() -> int:
    """The processors this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _count_option(text: str) -> int:
    if not (text.isascii() and text.isdigit() and len(text) < 10 and int(text) > 0):
        raise argparse.ArgumentTypeError(f"'{text}' is no whole number from 1 up")
    return int(text)


def _seconds_option(text: str) -> float:
    try:
        seconds = float(text)
    except ValueError:
        seconds = 0.0
    if not 0 < seconds < 1e7:
        raise argparse.ArgumentTypeError(f"'{text}' is no number of seconds")
    return seconds
