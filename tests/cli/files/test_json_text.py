# SPDX-License-Identifier: GPL-3.0-or-later
"""JSON of any depth and with any numbers is parsed or refused, by one function for all files."""

from __future__ import annotations

import json
import math

import pytest
from lsgp.io.json_text import DEEPEST, JsonError, parse_json


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "utf-16-le", "utf-32-be"])
def test_json_is_read_in_all_its_encodings(encoding: str) -> None:
    assert parse_json('{"a": [1, -2.5e3, true, null, "ü"]}'.encode(encoding)) == {"a": [1, -2500.0, True, None, "ü"]}


def nested(depth: int, form: str) -> bytes:
    begin, end = {"lists": ("[", "]"), "objects": ('{"a":', "}")}[form]
    return (begin * depth + "0" + end * depth).encode()


@pytest.mark.parametrize("form", ["lists", "objects"])
def test_depth_has_a_bound_that_all_programs_survive(form: str) -> None:
    content = parse_json(nested(DEEPEST, form))
    assert json.dumps(content, separators=(",", ":")).encode() == nested(DEEPEST, form)
    for depth in (DEEPEST + 1, 900, 100_000):
        with pytest.raises(JsonError, match="deep"):
            parse_json(nested(depth, form))
    assert parse_json(b'"' + b"[" * 1000 + b'"') == "[" * 1000
    assert parse_json(b"[" + b"[[]]," * 1000 + b"0]")[999] == [[]]


@pytest.mark.parametrize("text", [b"NaN", b"-Infinity", b"1e400", b"-1e400", b"1" * 400, b"-" + b"1" * 400])
def test_numbers_out_of_range_are_refused_or_left_to_be_named(text: bytes) -> None:
    with pytest.raises(JsonError):
        parse_json(b"[%s]" % text, finite=True)
    (number,) = parse_json(b"[%s]" % text)
    assert not isinstance(number, float) or not math.isfinite(number)


@pytest.mark.parametrize(
    "text", [b"", b"{", b"[1,]", b"'a'", b"\xff\xfe\x00", b'"\xff"', b"1" * 5000, b'{"a":1,"a":2}']
)
@pytest.mark.parametrize("finite", [False, True])
def test_what_is_no_json_is_refused_in_a_few_words(text: bytes, finite: bool) -> None:
    with pytest.raises(JsonError) as caught:
        parse_json(text, finite=finite)
    assert 0 < len(str(caught.value)) < 120
