# SPDX-License-Identifier: GPL-3.0-or-later
"""Every Python that tests start with this folder on its path moves its inputs as they do."""

import contextlib

with contextlib.suppress(ImportError):  # one without the library
    import jittered_inputs

    jittered_inputs.move_inputs()
