# SPDX-License-Identifier: GPL-3.0-or-later
"""Progress of a run: assets done, their rate, and the time that has passed or remains."""

from __future__ import annotations

import time
from collections.abc import Iterable, Mapping, Sequence

from ..run.terminal import ProgressLine
from .assets import Asset
from .records import OK, Record


class RunProgress:
    """Shows the progress of a run as records arrive, and what is told between them.

    The remaining time is estimated from the remaining bytes, because large assets come first. Until anything is done,
    the time that has passed says that the run is alive.
    """

    def __init__(self, line: ProgressLine, assets: Sequence[Asset], done: Iterable[Record]) -> None:
        self._line = line
        self._size = {asset.name: max(asset.size, 1) for asset in assets}
        self._total = max(sum(self._size.values()), 1)
        self._count = len(assets)
        self._begin = time.monotonic()
        self._bytes_before = self._bytes = 0
        self._ended = self._ended_before = self._without = 0
        self._shares: dict[str, float] = {}  # that are done of assets that are worked on
        for record in done:
            self._add(record)
        self._bytes_before, self._ended_before = self._bytes, self._ended
        self._show()

    def __call__(self, record: Record) -> None:
        self._shares.pop(record["asset"], None)
        self._add(record)
        self._show()

    def working(self, shares: Mapping[str, float]) -> None:
        """shares: the parts of assets that are done, by their names."""
        self._shares = dict(shares)
        self._show()

    def _add(self, record: Record) -> None:
        self._bytes += self._size[record["asset"]]
        self._ended += 1
        self._without += record["status"] != OK

    def _show(self) -> None:
        elapsed = time.monotonic() - self._begin
        parts = [f"{self._ended}/{self._count}"]
        if self._without:
            parts.append(f"{self._without} without a result")
        done = self._bytes + sum(self._size[name] * share for name, share in self._shares.items())
        worked = done - self._bytes_before
        if self._ended > self._ended_before and elapsed > 0:
            parts.append(f"{(self._ended - self._ended_before) / elapsed:.3g}/s")
        if worked > 0 and elapsed > 0:
            parts.append(f"{duration((self._total - done) * elapsed / worked)} left")
        else:
            parts.append(f"for {duration(elapsed)}")
        self._line(done / self._total, ", ".join(["", *parts]))


def duration(seconds: float) -> str:
    """Hours, minutes and seconds: "0:05", "2:03:59"."""
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02}:{rest:02}" if hours else f"{minutes}:{rest:02}"
