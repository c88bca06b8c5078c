# SPDX-License-Identifier: GPL-3.0-or-later
"""The process state that all tests need."""

import os
import signal
from collections.abc import Iterator
from itertools import islice

import pytest


@pytest.fixture(scope="session", autouse=True)
def interruptible() -> Iterator[None]:
    """Runs in the background and workers of pytest-xdist begin with interrupts ignored, and so would all they start."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.fixture
def few_tries(monkeypatch: pytest.MonkeyPatch) -> None:
    """Tight layouts are looked for in few ways, for tests of what is so after any number of them."""
    monkeypatch.setattr("lsgp.layouts.layout_search._TRIES", (4, 4))


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Suites inside Blenders are single tests of minutes: each worker begins with some, so that none is waited for.

    With --dist worksteal a worker gets an equal share of the list, in its order, and takes from others when it is done.
    """
    suites = [item for item in items if item.path.name == "test_in_blender.py"]
    others = iter([item for item in items if item not in suites])
    suites.reverse()  # the one with a window comes last, and takes longest
    workers = int(os.environ.get("PYTEST_XDIST_WORKER_COUNT", "1"))
    ordered: list[pytest.Item] = []
    for worker in range(workers):
        own = suites[worker::workers]
        share = (len(items) - len(ordered)) // (workers - worker)
        ordered += [*own, *islice(others, max(share - len(own), 0))]
    items[:] = ordered
