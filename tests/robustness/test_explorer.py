# SPDX-License-Identifier: GPL-3.0-or-later
"""A machine explores the whole library: whatever it does, what comes back keeps its contract.

The sessions here are short; `python -m explorer` runs as many as wanted.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator

import pytest
from explorer.__main__ import mesh_names
from explorer.choices import HypothesisChoices
from explorer.drive import Explorer, Failure, Journal, kind_of, session_steps, shorten
from explorer.host import Host
from explorer.steps import RULES, Step, draw_step_of
from hypothesis import HealthCheck, settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, rule, run_state_machine_as_test

TRIANGLES = 100
STEPS = 300
SECONDS = 60.0


@pytest.fixture(scope="module")
def meshes() -> list[str]:
    return mesh_names("small", TRIANGLES)


@pytest.fixture(scope="module")
def host() -> Iterator[Host]:
    with Host(SECONDS) as one:
        yield one


@pytest.mark.slow
def test_sessions_from_seeds(meshes: list[str]) -> None:
    explorer = Explorer(Journal(), meshes, list(RULES), SECONDS)
    explorer.run(STEPS, 0, 1)
    assert explorer.journal.steps >= STEPS
    assert {kind: json.dumps(failure.steps) for kind, failure in explorer.found.items()} == {}


def test_sessions_that_hypothesis_shrinks(meshes: list[str], host: Host) -> None:
    """A failure prints the steps that replay it."""

    class Session(RuleBasedStateMachine):
        def __init__(self) -> None:
            super().__init__()
            host.begin()
            self.steps: list[Step] = []

        @initialize(data=st.data())
        def take_mesh_first(self, data: st.DataObject) -> None:
            self.step("take mesh", data)

        def step(self, name: str, data: st.DataObject) -> None:
            step = draw_step_of(name, HypothesisChoices(data), meshes)
            self.steps.append(step)
            assert host.perform(step).faults == [], f"replay: {json.dumps({'steps': self.steps})}"

    def rule_named(name: str) -> Callable[..., None]:
        def perform(self: Session, data: st.DataObject) -> None:
            self.step(name, data)

        perform.__name__ = name.replace(" ", "_")
        return rule(data=st.data())(perform)

    for name in RULES:
        setattr(Session, name.replace(" ", "_"), rule_named(name))
    run_state_machine_as_test(
        Session,
        settings=settings(
            max_examples=12, stateful_step_count=15, deadline=None, suppress_health_check=list(HealthCheck)
        ),
    )


def test_a_seed_is_always_the_same_session(meshes: list[str]) -> None:
    assert session_steps(7, meshes) == session_steps(7, meshes) != session_steps(8, meshes)


def test_every_rule_is_drawn(meshes: list[str]) -> None:
    assert {step["do"] for seed in range(20) for step in session_steps(seed, meshes)} == set(RULES)


def test_a_process_that_dies_or_stops_is_an_end_of_a_step(meshes: list[str]) -> None:
    with Host(0.01) as impatient:
        assert impatient.perform({"do": "take mesh", "mesh": meshes[0]}).told == "hang"
    with Host(SECONDS) as patient:
        assert patient.perform({"do": "no such step"}).faults[0].startswith("raised AttributeError")
        assert patient.perform({"do": "take mesh", "mesh": meshes[0]}).faults == []


def test_a_failure_is_shortened_to_the_steps_it_needs(meshes: list[str]) -> None:
    bad: Step = {"do": "take mesh", "mesh": "no such mesh"}
    steps = [*session_steps(3, meshes, ["choose options", "mark seams"])[:8], bad]
    failure = Failure(kind_of(bad, "raised KeyError: 'no such mesh'"), 3, steps, "raised KeyError: 'no such mesh'")
    shorten(failure, SECONDS)
    assert failure.alone and failure.steps == [bad]


@pytest.mark.slow
def test_exploring_goes_on_where_it_was(tmp_path: object, meshes: list[str]) -> None:
    rules = ["choose options", "find cuts"]
    for steps in (40, 80):
        explorer = Explorer(Journal(tmp_path), meshes, rules, SECONDS)
        assert explorer.journal.steps == 0 or 40 <= explorer.journal.steps < 80
        explorer.run(steps, 0, 1)
    lines = [json.loads(line) for line in (tmp_path / "sessions.jsonl").read_text().splitlines()]
    assert [line["seed"] for line in lines] == list(range(len(lines)))
