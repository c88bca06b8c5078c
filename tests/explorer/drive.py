# SPDX-License-Identifier: GPL-3.0-or-later
"""Sessions from seeds, one after the other, with a journal of finished sessions and their failures."""

from __future__ import annotations

import hashlib
import itertools
import json
import re
import threading
from collections import Counter
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path

from .choices import SeededChoices
from .host import Ended, Host
from .steps import RULES, Step, draw_step, draw_step_of

SESSION = 30  # steps on average
TRIES = 150  # of sessions with fewer steps
SHOWN = 1000  # characters of a fault


def session_steps(seed: int, meshes: Sequence[str], rules: Sequence[str] = tuple(RULES)) -> list[Step]:
    """The steps of the session with this seed, a mesh first."""
    choices = SeededChoices(seed)
    first = draw_step_of("take mesh", choices, meshes)
    count = choices.whole(SESSION // 2, 3 * SESSION // 2)
    return [first, *(draw_step(choices, meshes, rules) for _ in range(count))]


def kind_of(step: Step, fault: str) -> str:
    """The same for faults that differ in numbers only: what they are counted by."""
    words = fault
    place = re.search(r"#\d+ 0x\w+ in (lsgp::\w+)", fault) or re.search(
        r'File "[^"]*(lsgp/\w+)\.py", line \d+ in (\w+)', fault
    )
    if place:
        words = f"{fault.splitlines()[0]} in {' '.join(place.groups())}"
    words = re.sub(r"\[[^\]]*\]|\([^)]*\)", "", words.splitlines()[0])
    return f"{step['do']}: " + re.sub(r"[-+]?\d[\d.e+-]*", "#", words)[:120].strip()


@dataclass
class Failure:
    """kind: what it is counted by.  steps: that lead to it.  fault: what was wrong.  alone: whether these steps in a
    process of their own show it again."""

    kind: str
    seed: int
    steps: list[Step]
    fault: str
    alone: bool = True


@dataclass
class Journal:
    """What has been done, in a folder or for this run only: `sessions.jsonl`, and a file for each kind of failure."""

    folder: Path | None = None
    seeds: set[int] = field(default_factory=set)
    steps: int = 0
    ends: Counter[str] = field(default_factory=Counter)
    failures: Counter[str] = field(default_factory=Counter)

    def __post_init__(self) -> None:
        self._lock = threading.Lock()
        if self.folder is None:
            return
        (self.folder / "failures").mkdir(parents=True, exist_ok=True)
        path = self.folder / "sessions.jsonl"
        lines = path.read_text().splitlines() if path.exists() else []
        for line in lines:
            self._count(json.loads(line))

    def _count(self, record: dict) -> None:
        self.seeds.add(record["seed"])
        self.steps += record["steps"]
        self.ends.update(record["ends"])
        self.failures.update(record["failures"])

    def add(self, record: dict, failures: Sequence[Failure]) -> None:
        with self._lock:
            self._count(record)
            if self.folder is None:
                return
            for failure in failures:
                path = self.folder / "failures" / f"{_slug(failure.kind)}.json"
                if not path.exists():
                    path.write_text(json.dumps(vars(failure), indent=1))
            with (self.folder / "sessions.jsonl").open("a") as lines:
                lines.write(json.dumps(record) + "\n")


def _slug(kind: str) -> str:
    words = re.sub(r"[^a-z]+", "-", kind.lower()).strip("-")[:60]
    return f"{words}-{hashlib.sha256(kind.encode()).hexdigest()[:6]}"


class Explorer:
    """Runs sessions until the journal has so many steps."""

    def __init__(self, journal: Journal, meshes: Sequence[str], rules: Sequence[str], seconds: float) -> None:
        self.journal, self._meshes, self._rules, self._seconds = journal, meshes, rules, seconds
        self.found: dict[str, Failure] = {}
        self._lock = threading.Lock()

    def run(self, steps: int, first_seed: int, jobs: int) -> None:
        seeds = (seed for seed in itertools.count(first_seed) if seed not in self.journal.seeds)
        with ThreadPoolExecutor(jobs) as pool:
            list(pool.map(lambda _: self._work(steps, seeds), range(jobs)))

    def _work(self, steps: int, seeds: Iterator[int]) -> None:
        with Host(self._seconds) as host:
            while self.journal.steps < steps:
                with self._lock:
                    seed = next(seeds)
                self._session(host, seed)

    def _session(self, host: Host, seed: int) -> None:
        program = session_steps(seed, self._meshes, self._rules)
        ends: Counter[str] = Counter()
        failures, done = [], 0
        host.begin()
        for done, step in enumerate(program, 1):
            ended = host.perform(step)
            ends[f"{step['do']}: {ended.told}"] += 1
            kinds = {kind_of(step, fault): fault for fault in ended.faults}
            failures += [Failure(kind, seed, program[:done], fault) for kind, fault in kinds.items()]
            if ended.told in ("crash", "hang"):
                break
        new = [failure for failure in failures if self._is_new(failure)]
        for failure in new:
            shorten(failure, self._seconds)
            print(f"\n{failure.kind}\n  seed {failure.seed}: {failure.fault[:SHOWN]}")
            print(f"  to be replayed: {json.dumps({'steps': failure.steps})}", flush=True)
        record = {"seed": seed, "steps": done, "ends": dict(ends), "failures": dict(Counter(f.kind for f in failures))}
        self.journal.add(record, new)

    def _is_new(self, failure: Failure) -> bool:
        with self._lock:
            known = failure.kind in self.found or failure.kind in self.journal.failures
            if not known:
                self.found[failure.kind] = failure
            return not known


def replay(host: Host, steps: Sequence[Step]) -> Iterator[tuple[Step, Ended]]:
    """Each step of a new session and how it ends."""
    host.begin()
    for step in steps:
        ended = host.perform(step)
        yield step, ended
        if ended.told in ("crash", "hang"):
            return


def _shows(host: Host, steps: Sequence[Step], kind: str) -> bool:
    return any(kind_of(step, fault) == kind for step, ended in replay(host, steps) for fault in ended.faults)


def shorten(failure: Failure, seconds: float) -> None:
    """Leave out steps, many at once at first, as long as the failure is shown; its other steps stay as they are."""
    with Host(seconds) as host:
        failure.alone = _shows(host, failure.steps, failure.kind)
        if not failure.alone or failure.fault.startswith("no answer"):
            return
        size, tries = len(failure.steps) // 2, 0
        while size > 0 and tries < TRIES:
            at = 0
            while at < len(failure.steps) - 1 and tries < TRIES:
                fewer = failure.steps[:at] + failure.steps[min(at + size, len(failure.steps) - 1) :]
                tries += 1
                if _shows(host, fewer, failure.kind):
                    failure.steps = fewer
                else:
                    at += size
            size //= 2
