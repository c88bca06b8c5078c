# SPDX-License-Identifier: GPL-3.0-or-later
"""One thread for the oracle's linear algebra, and the same examples in every run."""

from __future__ import annotations

import os

# Before numpy is imported: threads waiting for each other make small factorizations slow on a busy machine.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from hypothesis import settings

settings.register_profile("repeatable", derandomize=True, deadline=None)
settings.load_profile("repeatable")
