# SPDX-License-Identifier: GPL-3.0-or-later
"""The fuzzers of the Python package on what they begin with, without Atheris: they have to fit the library they are
for. tools/fuzz runs them for long."""

from __future__ import annotations

import contextlib
import importlib
import random
import sys
import types
from collections.abc import Iterator
from pathlib import Path

import pytest

FOLDER = Path(__file__).resolve().parents[1] / "fuzz"


class Numbers:
    """What Atheris makes of bytes, of random numbers with these as the seed."""

    def __init__(self, raw: bytes) -> None:
        self._random = random.Random(raw)

    def ConsumeIntInRange(self, low: int, high: int) -> int:
        return self._random.randint(low, high)

    def ConsumeBool(self) -> bool:
        return self._random.random() < 0.5

    def ConsumeFloat(self) -> float:
        usual = [0.0, -1.0, 1e-320, 1e300, float("inf"), float("nan"), self._random.gauss(0, 1)]
        return self._random.choice(usual)

    def ConsumeIntListInRange(self, count: int, low: int, high: int) -> list[int]:
        return [self.ConsumeIntInRange(low, high) for _ in range(count)]


@contextlib.contextmanager
def _as_they_are(**_: object) -> Iterator[None]:
    yield


@pytest.fixture
def fuzzer(monkeypatch: pytest.MonkeyPatch, request: pytest.FixtureRequest) -> Iterator[types.ModuleType]:
    atheris = types.ModuleType("atheris")
    vars(atheris).update(instrument_imports=_as_they_are, FuzzedDataProvider=Numbers)
    monkeypatch.setitem(sys.modules, "atheris", atheris)
    monkeypatch.syspath_prepend(str(FOLDER))
    pool = importlib.import_module("lsgp.batch.command")
    monkeypatch.setattr(pool, "Pool", pool.Pool)  # which the fuzzer of files replaces
    yield importlib.import_module(request.param)
    del sys.modules[request.param]


@pytest.mark.slow
@pytest.mark.parametrize("fuzzer", ["fuzz_files"], indirect=True)
def test_all_kinds_of_files_end_as_they_have_to(fuzzer: types.ModuleType) -> None:
    seeds = importlib.import_module("seeds")
    for raw in seeds.files():
        fuzzer.one_input(raw)


@pytest.mark.slow
@pytest.mark.parametrize("fuzzer", ["fuzz_arrays"], indirect=True)
def test_every_verb_ends_as_it_has_to(fuzzer: types.ModuleType) -> None:
    for seed in range(100):
        fuzzer.one_input(b"%d" % seed)
