# SPDX-License-Identifier: GPL-3.0-or-later
"""Short text for dataclasses that hold arrays."""

from __future__ import annotations

from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np

_LONGEST_LIST = 4


class ShortRepr:
    """Shows arrays by type and shape and long lists by their length; leaves out what is None.

    For dataclasses made with repr=False, whose own text would have every element of an array.
    """

    __slots__ = ()

    def __repr__(self) -> str:
        shown = (f"{name}={_short(value)}" for name, value in self._shown().items() if value is not None)
        return f"{type(self).__name__}({', '.join(shown)})"

    def _shown(self) -> dict[str, Any]:
        """The values by the names they are shown with."""
        assert is_dataclass(self)
        return {field.name: getattr(self, field.name) for field in fields(self)}


def _short(value: Any) -> str:
    if isinstance(value, np.ndarray):
        return f"{value.dtype}{value.shape}"
    if isinstance(value, bytes):
        return f"<{len(value)} bytes>"
    if isinstance(value, list | tuple | dict) and len(value) > _LONGEST_LIST:
        return f"<{len(value)} items>"
    return f"{value:.6g}" if isinstance(value, float) else repr(value)
