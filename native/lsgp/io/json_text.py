# SPDX-License-Identifier: GPL-3.0-or-later
"""JSON from anywhere: what the grammar allows and programs do not survive is refused here, once for all readers."""

from __future__ import annotations

import json
import math
from typing import Any

# Levels of lists and objects in each other. Files of the formats here have about ten; serde_json reads 128. Python's
# writer takes a call for a level, of the thousand that it allows altogether.
DEEPEST = 128


class JsonError(ValueError):
    """Bytes that are no JSON, or more than is read of it. The message has no full stop."""


def parse_json(data: bytes, *, finite: bool = False) -> Any:
    """The content of a JSON text in UTF-8, or in UTF-16 or UTF-32 as programs of Windows write it.

    Names occur once in an object, and lists and objects are nested up to DEEPEST levels. Integers are `int`, all other
    numbers `float`.
    finite: numbers beyond the range of `float`, NaN and infinity are refused; otherwise they are NaN, infinite or an
    `int` of any size, for the caller to name.
    Raises JsonError.
    """
    hooks: dict[str, Any] = {"parse_float": _finite, "parse_int": _integer, "parse_constant": _no_number}
    try:
        text = data.decode(json.detect_encoding(data), "surrogatepass").removeprefix("\ufeff")
        content = json.loads(text, object_pairs_hook=_object, **(hooks if finite else {}))
    except RecursionError as error:
        raise JsonError(_TOO_DEEP) from error
    except UnicodeError as error:
        raise JsonError("it has bytes that are no text") from error
    except (JsonError, json.JSONDecodeError) as error:
        raise JsonError(str(error)) from error
    except ValueError as error:  # of Python's bound on the digits of an integer
        raise JsonError("an integer has thousands of digits") from error
    if text.count("[") + text.count("{") > DEEPEST:
        _require_shallow(content)
    return content


_TOO_DEEP = f"lists and objects are nested more than {DEEPEST} deep"


def _require_shallow(content: Any) -> None:
    level = [content]
    for _ in range(DEEPEST):
        level = [
            inner
            for outer in level
            for inner in (outer.values() if isinstance(outer, dict) else outer)
            if isinstance(inner, dict | list)
        ]
        if not level:
            return
    raise JsonError(_TOO_DEEP)


def _object(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    out = dict(pairs)
    if len(out) < len(pairs):
        raise JsonError("an object has a name twice")
    return out


def _finite(text: str) -> float:
    number = float(text)
    if math.isinf(number):
        raise JsonError(f"the number {text[:20]} is out of range")
    return number


def _integer(text: str) -> int:
    """Up to the range of `float`, which other programs read all numbers as."""
    _finite(text)
    return int(text)


def _no_number(name: str) -> float:
    raise JsonError(f"{name} is no number of JSON")
