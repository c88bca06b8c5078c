# SPDX-License-Identifier: GPL-3.0-or-later
"""`lsgp batch`: its options and a run from the list of assets to the summary."""

from __future__ import annotations

import argparse
import contextlib
import os
import shlex
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from ..base.counted import counted
from ..io.mesh_formats import readable_suffixes
from ..io.safe_files import require_inputs_kept, require_no_links
from ..io.side_files import UsageError
from ..io.standard_streams import complain, say
from ..io.whole_files import remove_partials, write_whole
from ..run import exit_codes
from ..run.named_files import Reads, named_files, path_option
from ..run.terminal import ProgressLine
from ..run.unwrap_options import seconds_option
from .assets import (
    Asset,
    find_assets,
    output_name,
    picture_name,
    report_name,
    require_distinct_files,
    shard_option,
    skipped_note,
)
from .contact_sheet import page_names, write_contact_sheet
from .dask_engine import Cluster, run_on_cluster
from .journal import Journal, journal_path, read_records
from .pool import PYTHON_WORKER, Pool
from .progress import RunProgress, duration
from .records import OK, REFUSED, Record, is_whole
from .summary import summary_table
from .tasks import Settings, Task
from .worker_process import WorkersError

EXIT_CODES = exit_codes.listed(exit_codes.OF_A_BATCH)


@dataclass(frozen=True)
class Kind:
    """The differences between the programs that run batches.

    suffixes: of the files in a folder that are assets. output_name: the name of an asset's result.
    worker: the command that starts a worker process.
    """

    suffixes: Sequence[str]
    output_name: Callable[[str], str]
    worker: Sequence[str]


MESH_FILES = Kind(readable_suffixes(), output_name, PYTHON_WORKER)

FURTHER_OPTIONS = "--options"
SUMMARY = "summary.txt"
_TOO_LONG = 1e7
"""A time limit of so many seconds is a mistake."""


def add_batch_options(batch: argparse.ArgumentParser) -> None:
    """The options of a batch beside those of an unwrap."""
    batch.add_argument(
        "source",
        metavar="LIST|FOLDER",
        action=Reads,
        type=Path,
        help="a text file with a path on each line, a folder, searched at any depth, or a single mesh",
    )
    batch.add_argument(
        "--out", metavar="DIR", type=path_option, required=True, help="folder of the results, created if missing"
    )
    batch.add_argument("--jobs", metavar="N", type=_count_option, help="concurrent processes (default: one per core)")
    batch.add_argument("--shard", metavar="i/n", type=shard_option, help="only the i-th of n parts, for array jobs")
    batch.add_argument(
        "--only-missing",
        action="store_true",
        help="resume an earlier run: skip assets that have a result or were refused, retry failed ones",
    )
    batch.add_argument(
        "--timeout", metavar="S", type=partial(seconds_option, below=_TOO_LONG), help="time limit per asset in seconds"
    )
    batch.add_argument("--memory-limit", metavar="MB", type=_count_option, help="memory limit per asset (Linux)")
    batch.add_argument(
        "--exit-zero", action="store_true", help="exit code 0 once all assets are done, for farms that repeat tasks"
    )
    batch.add_argument("--reports", action="store_true", help="write the report of each result beside it")
    batch.add_argument(
        "--no-pictures", dest="pictures", action="store_false", help="draw no pictures and no contact sheet"
    )
    batch.add_argument(
        FURTHER_OPTIONS,
        metavar="TEXT",
        help="further options in one argument, quoted as for a shell: for job templates",
    )


def add_scheduler_options(batch: argparse.ArgumentParser) -> None:
    group = batch.add_argument_group(
        "Dask", "Whoever can reach a scheduler or a worker of Dask can run any code on it: use TLS or a closed network."
    )
    group.add_argument(
        "--scheduler",
        metavar="ADDRESS",
        help="run on the Dask cluster with this scheduler, for instance tls://host:8786",
    )
    for option, text in (
        ("--tls-ca-file", "certificates of the cluster's authorities, PEM"),
        ("--tls-cert", "certificate to show to the scheduler, PEM"),
        ("--tls-key", "key of the certificate, if it is in a separate file, PEM"),
    ):
        group.add_argument(option, metavar="FILE", action=Reads, help=text)


def expand_options(argv: Sequence[str]) -> list[str]:
    """A batch's arguments, with --options replaced by the options it holds.  Raises UsageError."""
    arguments = list(argv)
    end = arguments.index("--") if "--" in arguments else len(arguments)
    at = next((i for i in range(end) if arguments[i].partition("=")[0] == FURTHER_OPTIONS), None)
    if at is None:
        return arguments
    option, is_joined, text = arguments[at].partition("=")
    after = at + 1
    if not is_joined:
        if after == len(arguments):
            return arguments  # which is refused
        text, after = arguments[after], after + 1
    try:
        words = shlex.split(text)
    except ValueError as error:
        raise UsageError(f"{option} is not a list of options: {error}") from error
    return [*arguments[:at], *words, *arguments[after:]]


def main(argv: Sequence[str], kind: Kind, parser: argparse.ArgumentParser) -> int:
    """Run the command line of a batch program and return its exit code."""
    try:
        args = parser.parse_args(expand_options(argv))
    except UsageError as error:
        complain(f"{parser.prog}: error: {error}")
        return exit_codes.USAGE
    except SystemExit as end:  # argparse has said why
        return int(end.code or 0)
    return exit_codes.ended(lambda: run_batch(args, kind))


def run_batch(args: argparse.Namespace, kind: Kind = MESH_FILES) -> int:
    """Run a batch and return its exit code.  Raises OSError, UsageError, KeyboardInterrupt."""
    if args.jobs is not None and args.scheduler is not None:
        raise UsageError("--jobs is for this machine; set the number of processes of a cluster on its workers")
    cluster = Cluster.of(args)
    if args.memory_limit is not None and not sys.platform.startswith("linux"):
        raise UsageError("--memory-limit works on Linux only; leave it out")
    settings = Settings.of(args)
    found = find_assets(args.source, args.out, kind.suffixes, args.shard)
    if found.skipped:
        complain(f"lsgp: warning: {skipped_note(found.skipped)}")
    assets = found.assets
    files = _Files.of(args, assets, settings, kind)
    files.require_others_kept(args)
    args.out.mkdir(parents=True, exist_ok=True)
    begin = time.monotonic()
    is_resumed = journal_path(args.out, args.shard).exists()
    with Journal(args.out, args.shard, keep=args.only_missing) as journal, contextlib.ExitStack() as at_end:
        if args.shard is None or is_resumed:  # of a killed run, whose processes may still have been ending
            files.remove_partials(journal)
            at_end.callback(files.remove_partials, journal)
        ended = _ended_before(args, assets, settings, kind) if args.only_missing else {}
        missing = [asset for asset in assets if asset.name not in ended]
        with ProgressLine(sys.stderr) as line:
            show = RunProgress(line, assets, ended.values())
            for record in _records(args, missing, settings, kind, cluster, show.working):
                journal.write(record)
                ended[record["asset"]] = record
                show(record)
    records = [ended[asset.name] for asset in assets]
    _conclude(args, records, len(missing), time.monotonic() - begin)
    if args.exit_zero or all(map(is_whole, records)):
        return exit_codes.OK
    return exit_codes.SOME if any(record["status"] == OK for record in records) else exit_codes.REFUSED


@dataclass(frozen=True)
class _Files:
    """The files of a run. results: the assets and their results. others: names of the further files, in `out`. read:
    files beside the assets."""

    out: Path
    results: list[tuple[Asset, str]]
    others: list[str]
    read: list[Path]

    @classmethod
    def of(cls, args: argparse.Namespace, assets: Sequence[Asset], settings: Settings, kind: Kind) -> _Files:
        results = [(asset, kind.output_name(asset.name)) for asset in assets]
        others = [journal_path(args.out, args.shard).name]
        if args.shard is None:
            others.append(SUMMARY)
            others += page_names(len(assets)) if args.pictures else []
        read = [file.path for file in named_files(args).values()]
        for asset, output in results:
            others += [report_name(output)] if settings.reports else []
            others += [picture_name(asset.name)] if settings.pictures else []
            read += settings.side_files(Task.of(asset, args.out, output))
        return cls(args.out, results, others, read)

    def require_others_kept(self, args: argparse.Namespace) -> None:
        """Raise UsageError where two files of the run are one, or one lies in another, or where something would be
        written over a file that is read, or through a link in the folder of the results."""
        outputs = [output for _, output in self.results]
        require_distinct_files(self.out, ((asset.name, output) for asset, output in self.results), self.others)
        results = [(asset.path, self.out / output) for asset, output in self.results]
        written = [self.out / name for name in self.others]
        require_inputs_kept(results, self.read, written, in_place=args.in_place)
        require_no_links(self.out, [*outputs, *self.others])

    def remove_partials(self, journal: Journal) -> None:
        """Remove what killed processes have left."""
        own = [output for _, output in self.results] + self.others if journal.is_alone else []
        remove_partials(self.out, (self.out / name for name in own))


def _ended_before(
    args: argparse.Namespace, assets: Sequence[Asset], settings: Settings, kind: Kind
) -> dict[str, Record]:
    """The records of these assets that stay valid: refusals, and results whose files still exist."""
    names = {asset.name for asset in assets}
    before = read_records(args.out, args.shard)
    for journal, count in before.damaged.items():
        lines = counted(count, "line is", "lines are")
        complain(f"lsgp: warning: {lines} damaged in '{args.out / journal}'; those assets count as not done")
    stay = {
        name: record
        for name, record in before.records.items()
        if name in names and (record["status"] == REFUSED or _has_result(args.out, record, kind))
    }
    if {record["options"] for record in stay.values()} - {settings.digest()}:
        raise UsageError(
            f"'{args.out}' has results of other options or another version; name another folder, or leave out "
            "--only-missing to make all of them anew"
        )
    return stay


def _has_result(out: Path, record: Record, kind: Kind) -> bool:
    if record["status"] != OK or record["picture"] not in (None, picture_name(record["asset"])):
        return False
    return record["output"] == kind.output_name(record["asset"]) and Path(out, record["output"]).is_file()


def _records(
    args: argparse.Namespace,
    assets: Sequence[Asset],
    settings: Settings,
    kind: Kind,
    cluster: Cluster | None,
    tell: Callable[[dict[str, float]], None],
) -> Iterator[Record]:
    """tell: is told of the parts of assets that are done on this machine, as by `Pool`."""

    def task_of(asset: Asset) -> Task:
        return Task.of(asset, args.out, kind.output_name(asset.name))

    if not assets:
        return
    try:
        if cluster is not None:
            yield from run_on_cluster(cluster, settings, task_of, assets, args.timeout)
        else:
            jobs = min(args.jobs or _cores(), len(assets))
            yield from Pool(jobs, settings, task_of, kind.worker, args.timeout, tell=tell).run(assets)
    except WorkersError as error:
        raise UsageError(str(error)) from error


def _conclude(args: argparse.Namespace, records: Sequence[Record], worked: int, seconds: float) -> None:
    """Print the summary of a run; for a whole run, not a shard, write it into files as well."""
    table = summary_table(records)
    if args.shard is None:
        write_whole(args.out / SUMMARY, f"{table}\n".encode("utf-8", "replace"))
    lines = [table, f"{worked} of them in this run, in {duration(seconds)}"]
    if args.shard is None and args.pictures:
        lines.append(f"contact sheet: {write_contact_sheet(args.out, records)}")
    say(sys.stdout, "\n".join(lines))


def _cores() -> int:
    """The processors this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _count_option(text: str) -> int:
    if not (text.isascii() and text.isdigit() and len(text) < 10 and int(text) > 0):
        raise argparse.ArgumentTypeError(f"'{text}' is not a whole number of at least 1")
    return int(text)
