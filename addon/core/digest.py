# SPDX-License-Identifier: GPL-3.0-or-later
"""Digests of values composed of arrays, dataclasses, lists and anything else with a representation as text."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np


def digest_of(*values: Any) -> bytes:
    """Equal for equal values, and different for different ones."""
    found = hashlib.blake2b(digest_size=20)
    for part in _parts(values):
        found.update(part)
    return found.digest()


def _parts(value: Any) -> Iterator[bytes]:
    """A value in pieces, each with its type and size, so that different values have different pieces."""
    if is_dataclass(value):
        yield type(value).__name__.encode()
        for field in fields(value):
            yield from _parts(getattr(value, field.name))
    elif isinstance(value, np.ndarray):
        yield f"{value.dtype}{value.shape}".encode()
        yield np.ascontiguousarray(value).tobytes()
    elif isinstance(value, (list, tuple)):
        yield f"{len(value)}[".encode()
        for item in value:
            yield from _parts(item)
    else:
        yield f"{value!r};".encode()
