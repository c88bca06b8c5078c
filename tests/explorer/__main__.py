# SPDX-License-Identifier: GPL-3.0-or-later
"""Explore, resume exploring, or replay a failure; exit code 1 if anything is wrong."""

from __future__ import annotations

import argparse
import json
import sys
import time
from pathlib import Path

import zoo

from .drive import Explorer, Journal, replay
from .host import SECONDS, Host
from .steps import RULES


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m explorer", description=__doc__)
    parser.add_argument("--steps", type=int, default=2000, help="until so many are done, those in the journal included")
    parser.add_argument("--seed", type=int, default=0, help="of the first session")
    parser.add_argument("--jobs", type=int, default=1, help="sessions at the same time")
    parser.add_argument("--journal", type=Path, metavar="DIR", help="keep what is done there, and go on where it ends")
    parser.add_argument("--size", choices=["small", "large", "all"], default="small", help="of the meshes")
    parser.add_argument("--triangles", type=int, default=0, metavar="N", help="only meshes of so many at most")
    parser.add_argument("--rules", nargs="+", choices=list(RULES), default=list(RULES), metavar="RULE")
    parser.add_argument("--without", nargs="+", choices=list(RULES), default=[], metavar="RULE")
    parser.add_argument("--seconds", type=float, default=SECONDS, help="that a step may take")
    parser.add_argument("--replay", type=Path, metavar="FILE", help="a failure of the journal, step by step")
    asked = parser.parse_args()
    if asked.replay:
        return _replay(asked.replay, asked.seconds)
    return _explore(asked)


def mesh_names(size: str, triangles: int) -> list[str]:
    """triangles: at most so many, or 0 for any number."""
    members = zoo.members(None if size == "all" else size)
    return [one.name for one in members if not triangles or len(one.mesh().triangles) <= triangles]


def _explore(asked: argparse.Namespace) -> int:
    begin = time.perf_counter()
    rules = [rule for rule in asked.rules if rule not in asked.without]
    explorer = Explorer(Journal(asked.journal), mesh_names(asked.size, asked.triangles), rules, asked.seconds)
    before = explorer.journal.steps
    explorer.run(asked.steps, asked.seed, asked.jobs)
    journal = explorer.journal
    for end, count in sorted(journal.ends.items()):
        print(f"{count:8}  {end}")
    seconds = time.perf_counter() - begin
    print(f"{journal.steps} steps in {len(journal.seeds)} sessions, {journal.steps - before} now in {seconds:.0f} s")
    for kind, count in journal.failures.most_common():
        print(f"FAILURE {count:6} times: {kind}")
    return 1 if journal.failures else 0


def _replay(path: Path, seconds: float) -> int:
    found = json.loads(path.read_text())
    failed = False
    with Host(seconds) as host:
        for step, ended in replay(host, found["steps"]):
            print(json.dumps(step), "->", ended.told)
            for fault in ended.faults:
                print("   ", fault)
                failed = True
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
