# SPDX-License-Identifier: GPL-3.0-or-later
"""The computing library ``lsgp``, or None; then PROBLEM is one sentence for the artist, REASON what Python said.

Everything else takes ``lsgp`` from here, so that the add-on registers and explains itself where the bundled wheel does
not fit this Blender's Python or its file is damaged.
"""

import platform
import sys
from importlib import import_module, metadata
from types import ModuleType

NATIVE_FILES = (".so", ".dylib", ".pyd")


def _require_whole_native_files() -> None:
    """Raise ImportError where a native file is missing, or shorter or longer than its wheel says.

    The operating system crashes Blender, instead of failing, when it loads a library of which a part is missing.
    """
    for file in metadata.files("lsgp") or ():
        if file.suffix in NATIVE_FILES and file.size not in (None, file.locate().stat().st_size):
            raise ImportError(f"{file} is damaged: {file.locate().stat().st_size} of {file.size} bytes")


try:
    _require_whole_native_files()
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
    """A module of the library that is loaded only where it is used."""
    return import_module(f"lsgp.{name}")
