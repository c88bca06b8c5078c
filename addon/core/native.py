# SPDX-License-Identifier: GPL-3.0-or-later
"""The computing library ``lsgp``; None where it cannot be loaded.

PROBLEM is then one sentence for the artist and REASON Python's message. All other modules take ``lsgp`` from here, so
that the add-on registers and can say what is wrong where the bundled wheel is for another Python or is damaged.
"""

import os
import platform
import sys
from importlib import import_module, metadata
from types import ModuleType

NATIVE_FILES = (".so", ".dylib", ".pyd")
MOST_THREADS = 1024
"""That the library takes."""


def _leave_one_core() -> None:
    """To Blender while the library computes, unless the artist's environment says how many threads it takes."""
    os.environ.setdefault("LSGP_THREADS", str(max(1, (os.cpu_count() or 1) - 1)))


def thread_count(chosen: int) -> int:
    """The threads that the library takes where `chosen` is passed as their number, 0 being its default."""
    try:
        default = int(os.environ.get("LSGP_THREADS", ""))
    except ValueError:
        default = 0
    return chosen or (default if 1 <= default <= MOST_THREADS else os.cpu_count() or 1)


def _require_whole_native_files() -> None:
    """Raise ImportError where a native file is missing or its size is not the one recorded in its wheel.

    Loading a truncated library would crash Blender instead of raising an error.
    """
    for file in metadata.files("lsgp") or ():
        if file.suffix in NATIVE_FILES and file.size not in (None, file.locate().stat().st_size):
            raise ImportError(f"{file} is damaged: {file.locate().stat().st_size} of {file.size} bytes")


try:
    _require_whole_native_files()
    _leave_one_core()
    import lsgp
except (ImportError, OSError) as error:
    lsgp = None
    REASON = str(error)
    PROBLEM = (
        "Cone Unwrap cannot load its computing library; install the extension built for "
        f"Python {sys.version_info.major}.{sys.version_info.minor} on {platform.system()} {platform.machine()} "
        "and restart Blender"
    )
else:
    REASON = PROBLEM = ""


def part(name: str) -> ModuleType:
    """A module of the library that is imported only where it is used."""
    return import_module(f"lsgp.{name}")


def library_state() -> str:
    """One sentence: the version of the computing library and where it was loaded from, or that it is missing."""
    return PROBLEM or f"Computing library {lsgp.__version__} loaded from {lsgp.__file__}"
