# SPDX-License-Identifier: GPL-3.0-or-later
"""Operators that compute in the background: Blender continues to draw, progress is shown, Esc stops them."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import partial
from typing import Any

import bpy

from ...core import findings
from ...core.errors import Refused, object_errors
from ...core.region import Region
from ...jobs.tasks.computation import Computation
from ...jobs.tasks.solving import Progress, Task
from ...mesh.region_read import Faces, Groups, read_region
from ...mesh.targets import Target, selects_by_uv, target, target_objects
from . import redo, running
from .conclusion import conclude, for_each
from .polling import ComputingOperator
from .progress import ShownProgress

# Seconds: faster computations show no progress, which would only flicker.
UNNOTICED = 0.2

Solved = list[tuple[bpy.types.Object, Task, Any]]
"""Objects with their tasks and results."""


@dataclass(frozen=True, slots=True)
class _Work:
    """What a computation in the background is for.

    targets: the objects of the tasks. failures: the errors of other objects by name.
    """

    targets: list[Target]
    tasks: list[Task]
    computation: Computation[list[Any | Exception]]
    failures: dict[str, Exception]


class BackgroundOperator(ComputingOperator):
    """Base of operators that read the selected faces of all target objects, compute, and then write.

    Without a window all of it happens in one call. With one, the computation runs in a thread, and nothing else can be
    done in the window meanwhile; stopped, the operator ends at once and changes nothing. Redone with other properties,
    it runs in a thread as well, see `redo`.
    """

    activity: str
    """For the status bar, such as "Placing cones"."""
    nothing_selected: str
    """The error where no face is selected."""
    use_subsurf_data = False
    """Whether meshes are read with their Subdivision Surface modifier; operators may have it as a property."""

    # To be defined by operators

    def sources(self, context: bpy.types.Context) -> tuple[list[bpy.types.Object], Faces]:
        """The objects to work on, and which of their faces."""
        return target_objects(context), Faces.UV_SELECTED if selects_by_uv(context) else Faces.SELECTED

    def plan(self) -> tuple[Groups, Callable[[bpy.types.Object, Region], Task]]:
        """The vertex groups to read, and what makes the task of an object; that may raise LsgpError and Refused."""
        raise NotImplementedError

    def reader(self, faces: Faces) -> Callable[[bpy.types.Object], Task | None]:
        """What reads the task of an object, None where none of its faces is asked for."""
        groups, make_task = self.plan()

        def read(obj: bpy.types.Object) -> Task | None:
            region = read_region(obj, faces, groups, subdivided=self.use_subsurf_data)
            return None if region is None else make_task(obj, region)

        return read

    @staticmethod
    def solve(tasks: list[Task], progress: Progress | None = None) -> list[Any | Exception]:
        """The result of each task, which has ``warnings``, or its error.  Touches nothing in Blender."""
        raise NotImplementedError

    def solver(self, _context: bpy.types.Context) -> Callable[..., list[Any | Exception]]:
        """`solve`, or what computes as that does, with what else is read in Blender for it."""
        return self.solve

    def write(self, solved: Solved) -> list[str]:
        """Change the objects; returns what was done to each.  Raises Refused before anything is changed."""
        raise NotImplementedError

    # Running

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        # Without a window there are no events.
        if bpy.app.background or context.window is None:
            return self.execute(context)
        self._work = self._start(context)
        if self._work.computation.finished(UNNOTICED):
            return self._conclude_work(self._work)
        self._shown = ShownProgress(context, self.activity, self._work.computation)
        context.window_manager.modal_handler_add(self)
        running.began(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if event.type in {"ESC", "RIGHTMOUSE"} and event.value == "PRESS":
            self.cancel(context)
            self.report({"INFO"}, f"{self.activity} was stopped; nothing was changed")
            return {"CANCELLED"}
        if event.type == "TIMER":
            if self._work.computation.finished():
                self._end(context)
                return self._conclude_work(self._work)
            self._shown.update(context)
        return {"RUNNING_MODAL"}

    def cancel(self, context: bpy.types.Context) -> None:
        """Also called by Blender where it ends the operator, for example before another file is opened."""
        self._work.computation.stop()
        self._end(context)

    def _end(self, context: bpy.types.Context) -> None:
        self._shown.end(context)
        running.ended(self)

    def execute(self, context: bpy.types.Context) -> set[str]:
        if redo.is_redone(self):
            return self._redo(context)
        gathered, failures = self._gather(context)
        outcomes = self.solver(context)([task for _, task in gathered])
        found = [(obj, task, outcome) for (obj, task), outcome in zip(gathered, outcomes, strict=True)]
        return self._conclude(found, failures)

    def _redo(self, context: bpy.types.Context) -> set[str]:
        work = redo.take_computed()
        if work is None:
            work = self._start(context)
            if not work.computation.finished(UNNOTICED):
                redo.wait(self, work.computation, work)
                return {"CANCELLED"}
        return self._conclude_work(work)

    def _start(self, context: bpy.types.Context) -> _Work:
        gathered, failures = self._gather(context)
        tasks = [task for _, task in gathered]
        computation = Computation(partial(self.solver(context), tasks))
        return _Work([target(obj) for obj, _ in gathered], tasks, computation, failures)

    def _gather(self, context: bpy.types.Context) -> tuple[list[tuple[bpy.types.Object, Task]], dict[str, Exception]]:
        """What is to be computed for each object with selected faces, and the errors of the others by name."""
        objects, faces = self.sources(context)
        gathered, failures = for_each(objects, self.reader(faces))
        for obj in objects:
            if obj.name in failures:
                findings.keep(obj, None, [failures[obj.name]])
        return [(obj, task) for obj, task in gathered if task is not None], failures

    def _conclude_work(self, work: _Work) -> set[str]:
        """Conclude for the objects that are still as they were."""
        found, failures = [], dict(work.failures)
        for kept, task, outcome in zip(work.targets, work.tasks, work.computation.outcome(), strict=True):
            try:
                found.append((kept.find(), task, outcome))
            except Refused as error:
                failures[kept.name] = error
        return self._conclude(found, failures)

    def _conclude(
        self, outcomes: Iterable[tuple[bpy.types.Object, Task, Any | Exception]], failures: dict[str, Exception]
    ) -> set[str]:
        """Write and report.  failures: by object name, of objects that are not among the outcomes."""
        solved: Solved = []
        warnings: dict[str, list[Any]] = {}
        for obj, task, outcome in outcomes:
            if isinstance(outcome, Exception):
                failures[obj.name] = outcome
                findings.keep(obj, task.region, [outcome])
            else:
                solved.append((obj, task, outcome))
                warnings[obj.name] = findings.relevant(task.region, outcome.warnings)
                findings.keep(obj, task.region, warnings[obj.name])
        if not solved and not failures:
            self.report({"ERROR"}, self.nothing_selected)
            return {"CANCELLED"}
        try:
            done = self.write(solved)
        except object_errors() as error:
            failures |= {obj.name: error for obj, _, _ in solved}
            solved, done, warnings = [], [], {}
        said = [f"{obj.name}: {text}" for (obj, _, _), text in zip(solved, done, strict=True)]
        if solved:
            redo.remember_finished(self)
        return conclude(self, said, warnings, failures)
