# SPDX-License-Identifier: GPL-3.0-or-later
"""The work on one asset: the same as `lsgp unwrap` does on one file, with a record instead of lines on a terminal."""

from __future__ import annotations

import argparse
import os
from pathlib import Path

from ..base.progress import Progress
from ..errors import LsgpError
from ..io.side_files import UsageError
from ..io.whole_files import write_whole
from ..presets.auto_unwrap import TIME_LIMIT
from ..run import report as reports
from ..run.exit_codes import describe
from ..run.unwrap_file import Run, out_of_memory, unwrap_file
from ..run.unwrap_options import texture_size
from .assets import report_name
from .pictures import write_picture
from .records import FAILED, REFUSED, Record, ending, record_of
from .tasks import Settings, Task


def unwrap_asset(task: Task, settings: Settings, progress: Progress | None = None) -> Record:
    """Unwrap an asset, write its files, and return its record."""
    run = Run()
    try:
        _require_ordinary(Path(task.input))
        return _unwrap(task, settings, run, progress)
    except LsgpError as error:
        return refusal(error, run)
    except MemoryError:
        return refusal(out_of_memory(), run)
    except UsageError as error:
        return ending(REFUSED, "WRONG_USAGE", str(error))
    except OSError as error:
        return ending(FAILED, "FILE_ERROR", describe(error))


def refusal(error: LsgpError, run: Run) -> Record:
    """The record of an error of the library."""
    status = FAILED if error.code in (out_of_memory().code, TIME_LIMIT) else REFUSED
    count = None if run.triangulation is None else len(run.triangulation.triangles)
    message = f"{error.message}{reports.where(error.elements, run.triangulation)}"
    return ending(status, error.code, message, triangles=count)


def _require_ordinary(path: Path) -> None:
    """Refuse a pipe or a device, which would block the process; a missing file is reported when it is read."""
    if path.exists() and not path.is_file():
        raise OSError(None, "This is not a regular file", os.fspath(path))


def _unwrap(task: Task, settings: Settings, run: Run, progress: Progress | None) -> Record:
    output = Path(task.out, task.output)
    args = argparse.Namespace(input=Path(task.input), output=output, threads=0, **settings.options_for(task))
    result = unwrap_file(args, run, progress, makes_folder=True)
    report = reports.unwrap_report(result, run, texture_size(args))
    if settings.reports:
        write_whole(Path(task.out, report_name(task.output)), reports.to_json(report))
    record = record_of(report) | {"output": task.output}
    if settings.pictures:
        write_picture(Path(task.out, task.picture), run.surface, result)
        record["picture"] = task.picture
    return record
