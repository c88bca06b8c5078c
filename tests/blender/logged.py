# SPDX-License-Identifier: GPL-3.0-or-later
"""Codes of errors and warnings, which the add-on logs but does not report."""

import logging
from collections.abc import Iterator
from contextlib import contextmanager

import pytest


class _Codes(logging.Handler):
    def __init__(self) -> None:
        super().__init__()
        self.found: list[str] = []

    def emit(self, record: logging.LogRecord) -> None:
        _name, code, _message = record.args
        self.found.append(code)


@contextmanager
def logged() -> Iterator[list[str]]:
    """A list of the codes that are logged meanwhile."""
    logger, handler = logging.getLogger("cone_unwrap"), _Codes()
    before = logger.level
    logger.addHandler(handler)
    logger.setLevel(logging.INFO)
    try:
        yield handler.found
    finally:
        logger.setLevel(before)
        logger.removeHandler(handler)


@contextmanager
def refused(code: str, match: str | None = None) -> Iterator[None]:
    """An operator that fails with this code and a message that matches."""
    with logged() as codes, pytest.raises(RuntimeError, match=match):
        yield
    assert code in codes
