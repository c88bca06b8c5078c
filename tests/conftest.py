# SPDX-License-Identifier: GPL-3.0-or-later
"""The process state that all tests need."""

import signal
from collections.abc import Iterator

import pytest


@pytest.fixture(scope="session", autouse=True)
def interruptible() -> Iterator[None]:
    """Runs in the background and workers of pytest-xdist begin with interrupts ignored, and so would all they start."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Suites inside Blenders are single tests of minutes: they begin first, so that none is waited for at the end."""
    items.sort(key=lambda item: item.path.name != "test_in_blender.py")
