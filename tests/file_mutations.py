# SPDX-License-Identifier: GPL-3.0-or-later
"""Damage to single fields of files that are otherwise whole: extremes, other types, depth, and what is there twice.

Bytes at random hardly ever leave a document that is read beyond its first check. These changes keep its grammar: values
of a JSON text, with its binary data apart, words of a text, and numbers of a table.
"""

from __future__ import annotations

import base64
import copy
import json
import random
import re
import struct
from collections.abc import Iterator
from typing import Any

MAGIC, JSON_CHUNK, BINARY_CHUNK = b"glTF", 0x4E4F534A, 0x004E4942
DATA = "data:application/octet-stream;base64,"
PLACEHOLDER = "\x1a"  # never in a document

# At and beside the limits of types.
INTEGERS = [-1, 0, 1, 2, 3, 255, 256, 65535, 65536, -(2**31), 2**31 - 1, 2**31, 2**32, 2**53, 2**63 - 1, 2**63, 10**30]
NUMBERS = [-1.0, 0.5, 3.0, 1e-320, 1e30, 1e39, -1e308]
TYPES = [None, True, False, "", "1", "x" * 300, [], {}, [0], [[]], {"bufferView": 0}, {"a": [{}]}]
COMPONENTS, KINDS = [5120, 5121, 5122, 5123, 5124, 5125, 5126], ["SCALAR", "VEC2", "VEC3", "VEC4", "MAT4"]
# Values that no writer of JSON has.
RAW = [
    "NaN",
    "Infinity",
    "-Infinity",
    "1e400",
    "-1e400",
    "1" * 400,
    "1" * 5000,
    "1.0",
    "1e0",
    "-0",
    "[" * 900 + "]" * 900,
]
WORDS = [
    *[str(number).encode() for number in (*INTEGERS, *NUMBERS)],
    *[b"nan", b"inf", b"-inf", b"1e400", b"0x10", b"1_0", b"+1", b"1/1", b"1//1", b"/", b"\\", b"#", b"9" * 400, b"\0"],
    *[b"char", b"uchar", b"short", b"ushort", b"int", b"uint", b"float", b"double", b"list", b"vertex", b"face"],
    *[b"ascii", b"binary_little_endian", b"binary_big_endian", b"x", b"vertex_indices", b"tristrips"],
]


def mutated(data: bytes, rng: random.Random) -> bytes:
    """A file with one to four changes of the kind that it is: glTF, GLB or other JSON, a binary table, or text."""
    times = rng.choice([1, 1, 1, 2, 4])
    if data.startswith(MAGIC):
        return _mutated_glb(data, rng, times)
    try:
        content = json.loads(data)
    except (ValueError, RecursionError):
        content = None
    if isinstance(content, dict | list):
        return _mutated_json(content, rng, times)
    head, end, table = data.partition(b"end_header\n")
    if b"binary" in head and end:
        if rng.random() < 0.5:
            return _mutated_words(head, rng, times) + end + table
        return head + end + _mutated_numbers(table, rng, times)
    if data.startswith(bytes(80)):  # binary STL
        return _mutated_numbers(data, rng, times)
    return _mutated_words(data, rng, times)


def _mutated_json(content: Any, rng: random.Random, times: int) -> bytes:
    raw: list[str] = []
    for _ in range(times):
        _change(content, rng, raw)
    text = json.dumps(content)
    for i, value in enumerate(raw):
        text = text.replace(json.dumps(f"{PLACEHOLDER}{i}"), value)
    return text.replace(json.dumps(PLACEHOLDER)[1:-1], "").encode()


def _change(content: Any, rng: random.Random, raw: list[str]) -> None:
    places = list(_places(content))
    if not places:
        return
    holder, key = rng.choice(places)
    value = holder[key]
    match rng.randrange(10):
        case 0 | 1 if isinstance(value, str) and value.startswith(DATA):
            bytes_ = base64.b64decode(value.removeprefix(DATA))
            holder[key] = DATA + base64.b64encode(_mutated_numbers(bytes_, rng, 1)).decode()
        case 0 | 1 | 2 if type(value) is int:
            holder[key] = value + rng.choice([-4, -2, -1, 1, 2, 4])
        case 3 if isinstance(holder, dict):
            if rng.random() < 0.5:
                del holder[key]
            else:
                holder[key + PLACEHOLDER] = value  # a name twice
        case 3 | 4 if isinstance(value, list):
            holder[key] = value * rng.choice([0, 2, 50]) if len(value) < 50 else value[:-1]
        case 4:
            raw.append(rng.choice(RAW))
            holder[key] = f"{PLACEHOLDER}{len(raw) - 1}"
        case 5:
            other, name = rng.choice(places)
            holder[key] = copy.deepcopy(other[name])
        case 6:
            holder[key] = rng.choice([rng.choice(COMPONENTS), rng.choice(KINDS)])
        case 7:
            holder[key] = copy.deepcopy(rng.choice(TYPES))
        case _:
            holder[key] = rng.choice(INTEGERS + NUMBERS)


def _places(content: Any) -> Iterator[tuple[Any, Any]]:
    """Every value of the JSON, by what holds it."""
    waiting = [content]
    while waiting:
        holder = waiting.pop()
        for key in list(holder if isinstance(holder, dict) else range(len(holder))):
            yield holder, key
            if isinstance(holder[key], dict | list):
                waiting.append(holder[key])


def _mutated_glb(data: bytes, rng: random.Random, times: int) -> bytes:
    length = struct.unpack_from("<I", data, 12)[0] if len(data) >= 20 else 0
    text, rest = data[20 : 20 + length], data[28 + length :]
    if rng.random() < 0.3:
        rest = _mutated_numbers(rest, rng, times)
    else:
        try:
            text = _mutated_json(json.loads(text), rng, times)
        except (ValueError, RecursionError, TypeError):
            text = _mutated_words(text, rng, times)
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<II", len(text), JSON_CHUNK) + text + struct.pack("<II", len(rest), BINARY_CHUNK) + rest
    whole = MAGIC + struct.pack("<II", 2, 12 + len(chunks)) + chunks
    return whole if rng.random() < 0.9 else whole[:12] + _mutated_numbers(whole[12:20], rng, 1) + whole[20:]


def _mutated_words(data: bytes, rng: random.Random, times: int) -> bytes:
    parts = re.split(rb"(\s+)", data)  # words, and what is between them
    for _ in range(times):
        at = 2 * rng.randrange((len(parts) + 1) // 2)
        match rng.randrange(6):
            case 0:
                parts[at] = parts[2 * rng.randrange((len(parts) + 1) // 2)]
            case 1:
                parts[at : at + 2] = []
                parts = parts if len(parts) % 2 else [*parts, b""]
            case 2:
                run = parts[at : at + 2 * rng.choice([1, 4, 20])]
                parts[at:at] = run if len(run) % 2 == 0 else run[:-1]
            case _:
                parts[at] = rng.choice(WORDS)
    return b"".join(parts)


def _mutated_numbers(data: bytes, rng: random.Random, times: int) -> bytes:
    """Of a table, of one, two, four or eight bytes each; or the table is longer or shorter."""
    out = bytearray(data)
    for _ in range(times):
        if not out:
            break
        at, size = rng.randrange(len(out)), rng.choice([1, 2, 4, 8])
        match rng.randrange(8):
            case 0:
                del out[at:]
            case 1:
                out[at:at] = out[at : at + size]
            case 2:
                out[at : at + size] = rng.randbytes(size)
            case 3:
                at -= at % 4
                out[at : at + 4] = struct.pack("<f", rng.choice([float("nan"), float("inf"), 1e38, 1e-45, -0.0]))
            case _:
                at -= at % size
                out[at : at + size] = rng.choice([b"\xff", b"\0", b"\x7f", b"\x80", b"\x01"]) * size
    return bytes(out)
