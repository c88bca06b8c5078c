# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors that concern one object and leave the others alone."""

from __future__ import annotations

from . import native


class Refused(Exception):
    """The object cannot be processed; the message ends with what to do."""


def object_errors() -> tuple[type[Exception], ...]:
    """Everything that can go wrong with one object, for an ``except`` clause."""
    return (native.lsgp.LsgpError, Refused, MemoryError)
