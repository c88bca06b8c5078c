# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line; `main` is the console entry point `lsgp`."""

from .command import main

__all__ = ["main"]
