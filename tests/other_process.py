# SPDX-License-Identifier: GPL-3.0-or-later
"""Scripts that run in a Python of their own, with the modules of this one."""

from __future__ import annotations

import os
import subprocess
import sys


def in_another_process(script: str, *arguments: object, **environment: str) -> str:
    """The output of a script, which has to succeed.  environment: variables besides those of this process."""
    done = subprocess.run(
        [sys.executable, "-c", script, *map(str, arguments)],
        env=os.environ | {"PYTHONPATH": os.pathsep.join(filter(None, sys.path))} | environment,
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout
