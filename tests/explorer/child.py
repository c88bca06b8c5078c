# SPDX-License-Identifier: GPL-3.0-or-later
"""The child process: reads one step per line as JSON, and writes its outcome as a line of JSON."""

from __future__ import annotations

import faulthandler
import json
import os
import sys
import traceback

import numpy as np

from .world import World

MEMORY = 6 << 30  # bytes of address space


def main() -> None:
    faulthandler.enable()
    np.seterr(all="ignore")
    if os.name == "posix" and "libasan" not in os.environ.get("LD_PRELOAD", ""):  # which reserves terabytes
        import resource

        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    # What the library or a command prints must not get among the answers.
    answers = os.fdopen(os.dup(1), "w", buffering=1)
    os.dup2(2, 1)
    world = World()
    for line in sys.stdin:
        step = json.loads(line)
        if step["do"] == "begin":
            world = World()
            print(json.dumps(["begun", []]), file=answers)
            continue
        try:
            ended, faults = world.perform(step)
        except Exception as error:  # of the library's where none is caught, or of the checks
            ended, faults = type(error).__name__, [f"raised {type(error).__name__}: {error}\n{traceback.format_exc()}"]
        print(json.dumps([ended, faults]), file=answers)


if __name__ == "__main__":
    main()
