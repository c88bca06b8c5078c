# SPDX-License-Identifier: GPL-3.0-or-later
"""Programs that run in the bpy module."""

from __future__ import annotations

import os
import sys
import traceback
from collections.abc import Callable


def run_as_program(job: Callable[[], None]) -> None:
    """Run the job and end the process with its exit code."""
    status = 0
    try:
        job()
    except SystemExit as ending:
        status = ending.code if isinstance(ending.code, int) else 1
        if isinstance(ending.code, str):
            print(ending.code, file=sys.stderr)
    except Exception:
        traceback.print_exc()
        status = 1
    sys.stdout.flush()
    sys.stderr.flush()
    # The bpy module may hang at a regular exit, as while classes of an add-on are registered.
    os._exit(status)
