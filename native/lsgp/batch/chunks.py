# SPDX-License-Identifier: GPL-3.0-or-later
"""Groups assets for workers: large ones first and alone, small ones later and many at a time.

The last chunks are then small, so that all workers end at nearly the same time and dispatch costs little.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable

from .assets import Asset

MOST_ASSETS = 32
ROUNDS = 8


class Queue:
    """Assets to be worked on; largest first.  most_assets: in a chunk."""

    def __init__(self, assets: Iterable[Asset], workers: int, most_assets: int = MOST_ASSETS) -> None:
        self._assets = deque(sorted(assets, key=lambda asset: (-asset.size, asset.name)))
        self._left = sum(map(_weight, self._assets))
        self._workers = workers
        self._most_assets = most_assets

    def __bool__(self) -> bool:
        return bool(self._assets)

    def take(self) -> list[Asset]:
        """The next chunk: one asset, or as many as are a small share of what is left for every worker."""
        most = self._left / (ROUNDS * self._workers)
        chunk = [self._assets.popleft()]
        weight = _weight(chunk[0])
        while self._assets and len(chunk) < self._most_assets and weight + _weight(self._assets[0]) <= most:
            chunk.append(self._assets.popleft())
            weight += _weight(chunk[-1])
        self._left -= weight
        return chunk

    def put_back(self, assets: Iterable[Asset]) -> None:
        """Assets that were taken but not worked on; they are the next."""
        for asset in reversed(list(assets)):
            self._assets.appendleft(asset)
            self._left += _weight(asset)


def _weight(asset: Asset) -> int:
    """The estimated work of an asset; opening even the smallest file costs some."""
    return asset.size + 10_000
