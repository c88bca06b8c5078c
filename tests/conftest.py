# SPDX-License-Identifier: GPL-3.0-or-later
"""The process state that all tests need."""

import importlib
import os
import shlex
import signal
import sys
from collections.abc import Iterator
from itertools import islice
from pathlib import Path

import lsgp
import pytest
from nightly import leave_out_nightly


@pytest.fixture(scope="session", autouse=True)
def interruptible() -> Iterator[None]:
    """Runs in the background and workers of pytest-xdist begin with interrupts ignored, and so would all they start."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


def pytest_configure() -> None:
    """With LSGP_TEST_JITTER, a seed, all inputs are moved by units in the last place, here and in other processes."""
    if os.environ.get("LSGP_TEST_JITTER"):
        folder = str(Path(__file__).with_name("jitter"))
        os.environ["PYTHONPATH"] = os.pathsep.join(filter(None, [folder, os.environ.get("PYTHONPATH")]))
        sys.path.append(folder)
        importlib.import_module("jittered_inputs").move_inputs()


def pytest_unconfigure(config: pytest.Config) -> None:
    """After all else, what failed as one command, where the one that runs tests is named."""
    reporter, command = config.pluginmanager.get_plugin("terminalreporter"), os.environ.get("LSGP_TEST_COMMAND")
    reports = [report for kind in ("failed", "error") for report in (reporter.stats if reporter else {}).get(kind, [])]
    if command and reports:
        failed = dict.fromkeys(report.nodeid for report in reports)
        seed = os.environ.get("LSGP_TEST_JITTER")
        again = [f"LSGP_TEST_JITTER={shlex.quote(seed)}"] if seed else []
        print(f"\n{len(failed)} failed. To run them again:\n{' '.join([*again, command, shlex.join(failed)])}")


@pytest.fixture(autouse=True)
def exact_input(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    """Inputs stay as they are in tests that are so marked."""
    if request.node.get_closest_marker("exact_input"):
        monkeypatch.delenv("LSGP_TEST_JITTER", raising=False)


@pytest.fixture
def few_tries(monkeypatch: pytest.MonkeyPatch) -> None:
    """Tight layouts are looked for with little effort, for tests of what is so after any."""
    monkeypatch.setitem(lsgp.pack_islands.__kwdefaults__, "effort", "quick")
    efforts = lsgp.presets.auto_unwrap._EFFORTS
    for preset in efforts:
        monkeypatch.setitem(efforts, preset, "quick")


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Suites inside Blenders are single tests of minutes: each worker begins with some, so that none is waited for.

    With --dist worksteal a worker gets an equal share of the list, in its order, and takes from others when it is done.
    """
    leave_out_nightly(config, items)
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
