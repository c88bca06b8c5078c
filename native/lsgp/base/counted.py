# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers with their nouns in messages."""

from __future__ import annotations


def counted(number: int, one: str, many: str | None = None) -> str:
    """Number and noun: "1 cone", "8 cones".  many: where it is not that for one with an s."""
    return f"{number} {one}" if number == 1 else f"{number} {many or one + 's'}"
