# SPDX-License-Identifier: GPL-3.0-or-later
"""The computing library ``lsgp``, or None; then PROBLEM is one sentence for the artist, REASON what Python said.

Everything else takes ``lsgp`` from here, so that the add-on registers and explains itself where the bundled wheel does
not fit this Blender's Python or its file is damaged.
"""

import platform
import sys

try:
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
