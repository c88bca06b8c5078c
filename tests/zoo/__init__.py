# SPDX-License-Identifier: GPL-3.0-or-later
"""A zoo of meshes: hundreds of named surfaces of all kinds, well-formed and broken, for tests that want many of them.

    zoo.members("small")            # a few hundred triangles at most
    zoo.member("gear-teeth=12").mesh()

Every member is made anew from formulas and seeds, the same each time.
"""

from __future__ import annotations

from functools import cache

from . import broken, closed, flat, mixed, parts, scaled, swept, tunnels
from .member import Member, Size

__all__ = ["Member", "Size", "families", "member", "members"]

_ROOMS = (flat, closed, swept, tunnels, parts, scaled, broken, mixed)


@cache
def _all() -> dict[str, Member]:
    found: dict[str, Member] = {}
    for room in _ROOMS:
        for one in room.members():
            assert one.name not in found, f"two members are called {one.name}"
            found[one.name] = one
    return found


def members(size: Size | None = None, family: str | None = None) -> list[Member]:
    """All members, or those of a size or a family, in a fixed order."""
    return [one for one in _all().values() if size in (None, one.size) and family in (None, one.family)]


def member(name: str) -> Member:
    """The member of this name; mixtures have any seed."""
    if name.startswith(mixed.PREFIX):
        return mixed.member_of(int(name.removeprefix(mixed.PREFIX)))
    return _all()[name]


def families() -> list[str]:
    return list(dict.fromkeys(one.family for one in _all().values()))
