# SPDX-License-Identifier: GPL-3.0-or-later
"""Command lines in this process: starting another one takes longer than most commands."""

from __future__ import annotations

import io
import warnings
from contextlib import chdir, redirect_stderr, redirect_stdout
from pathlib import Path
from subprocess import CompletedProcess

from lsgp.cli import main


def run_command(folder: Path, *arguments: object) -> CompletedProcess[str]:
    """`python -m lsgp` with these arguments in a folder.  A warning of Python, which it would print, is an error."""
    command = [str(argument) for argument in arguments]
    out, err = (io.TextIOWrapper(io.BytesIO(), "utf-8", newline="") for _ in range(2))
    with chdir(folder), redirect_stdout(out), redirect_stderr(err), warnings.catch_warnings():
        warnings.simplefilter("error")
        code = main(command)
    return CompletedProcess(command, code, *(stream.buffer.getvalue().decode() for stream in (out, err)))
