# SPDX-License-Identifier: GPL-3.0-or-later
"""One thread for the checks' linear algebra, and the same examples in every run."""

from __future__ import annotations

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before numpy is imported

from hypothesis import settings

settings.register_profile("repeatable", derandomize=True, deadline=None)
settings.load_profile("repeatable")
