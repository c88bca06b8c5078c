# SPDX-License-Identifier: GPL-3.0-or-later
"""How commands end, and what they say where they cannot be carried out."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable

from .side_files import UsageError
from .terminal import say

OK, USAGE, REFUSED, SOME, INTERRUPTED = 0, 2, 3, 4, 130


def ended(run: Callable[[], int]) -> int:
    """The exit code of a command, which says why where that is wrong usage, an unusable file or an interruption."""
    try:
        return run()
    except UsageError as error:
        say(sys.stderr, f"lsgp: error: {error}")
    except OSError as error:
        say(sys.stderr, f"lsgp: error: {describe(error)}")
    except KeyboardInterrupt:
        say(sys.stderr, "lsgp: interrupted")
        return INTERRUPTED
    return USAGE


def describe(error: OSError) -> str:
    """What the system says, and of which file."""
    where = "" if error.filename is None else f": '{os.fsdecode(error.filename)}'"
    return f"{error.strerror or error}{where}"
