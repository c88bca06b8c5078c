# SPDX-License-Identifier: GPL-3.0-or-later
"""Keeps the map of a session up to date: the newest state is solved in the background, one step at a time."""

from __future__ import annotations

from ...core import native
from ...core.findings import explain
from ..tasks.computation import Computation
from .cone_session import ConeSession, Step

# Seconds: faster steps are waited for, so that they are drawn together with the cursor that caused them.
SOON = 0.1


class Follower:
    """outdated: whether the cones changed since the last step began. problem: why that step failed; else empty."""

    def __init__(self, session: ConeSession) -> None:
        self.outdated = False
        self.problem = ""
        self._dragging = self._is_preview = False
        self._session = session
        self._computation: Computation | None = None
        self._step: Step | None = None

    @property
    def is_busy(self) -> bool:
        return self._computation is not None

    def drag(self, dragging: bool) -> None:
        """Whether a cone is being dragged: meanwhile, large maps are approximate; the exact one follows."""
        self.outdated |= self._is_preview and not dragging
        self._dragging = dragging

    def follow(self) -> bool:
        """Begin the next step where one is due, and show a finished one.  Returns whether one was shown or failed."""
        previews = (
            self._dragging and self.outdated and bool(self._session.cones.touched) and self._session.has_previews()
        )
        if previews and self._computation is not None and not self._is_preview:
            # An exact map that is no longer the one of the cones would only delay the next preview.
            self._abandon()
        if self._computation is not None:
            return self._take()
        if not self.outdated:
            return False
        self.outdated = False
        if not self._session.cones.touched:
            # All steps are undone.
            self._session.show_before()
            self.problem, self._is_preview = "", False
            return True
        step = self._session.preview() if previews else self._session.draft()
        if step is None:
            self.outdated = True
            return False
        self._step, self._is_preview = step, previews
        self._computation = Computation(step.solve)
        return self._take(SOON)

    def stop(self) -> None:
        """Stop computing and wait for the end, since two computations cannot use the same solver."""
        self._abandon()
        self._session.stop()

    def _abandon(self) -> None:
        if self._computation is not None:
            self._computation.stop()
            self._computation.finished(None)
            self._computation = None

    def _take(self, seconds: float = 0.0) -> bool:
        """Show the result of the computation if it ends within so long."""
        if not self._computation.finished(seconds):
            return False
        computation, self._computation = self._computation, None
        try:
            self._session.show(self._step, computation.outcome())
            self.problem = ""
        except (native.lsgp.LsgpError, MemoryError) as error:
            self.problem = explain(error)
        return True
