# SPDX-License-Identifier: GPL-3.0-or-later
"""Frozen dataclasses that convert what they are given."""

from __future__ import annotations


def set_field(instance: object, name: str, value: object) -> None:
    """Set a field of a frozen dataclass during its construction."""
    object.__setattr__(instance, name, value)
