# SPDX-License-Identifier: GPL-3.0-or-later
"""The native tokens, numbers and lines of text files against what Python makes of the same bytes."""

from __future__ import annotations

import random

import numpy as np
import pytest
from lsgp import InputError, _lsgp
from lsgp.io.mesh_text import Rows
from lsgp.io.polygons import PolygonMesh, triangulate

# Tokens of numbers and of what looks like one.
TOKENS = (
    *("0", "-0", "+1", "1.", ".5", "-.5e-3", "007", "1e5", "1E+05", "12345678901234567890", "9007199254740993"),
    *("0.1", "123456.789", "1e-400", "-1e400", "4.9e-324", "2.2250738585072011e-308", "1.7976931348623159e308"),
    *("inf", "-Infinity", "NaN", "+nan", "9223372036854775807", "-9223372036854775808", "9223372036854775808"),
    *("", "+", "-", ".", "e5", "1e", "1e+", "--1", "+-1", "-+1", "1_000", "0x10", "1.2.3", "1,5", "nan(1)", "1\x002"),
    *("infinit", "1f", "٣", "1e5.", "0.1000000000000000055511151231257827021181583404541015625"),
)
PARSERS = {float: _lsgp.parse_floats, int: _lsgp.parse_integers}


def parsed_by_python(token: bytes, kind: type) -> float | int | None:
    try:
        value = kind(token)
        np.array(value, np.float64 if kind is float else np.int64)
    except (ValueError, OverflowError):
        return None
    return None if b"_" in token else value


def numbers_of_all_sizes(count: int) -> np.ndarray:
    """Doubles of random bits, of few decimals, powers of ten, and their neighbors."""
    generator = np.random.default_rng(7)
    bits = generator.integers(0, 2**64, count, np.uint64).view(np.float64)
    decimals = generator.integers(-(10**9), 10**9, count) / 10.0 ** generator.integers(0, 12, count)
    powers = np.array([float(f"1e{exponent}") for exponent in range(-30, 31)])
    found = np.concatenate([bits, decimals, powers, np.nextafter(powers, 0), [0.0, -0.0, 5e-324, 2.0**53, 1.7e308]])
    return found[np.isfinite(found)]


@pytest.mark.parametrize("kind", PARSERS)
@pytest.mark.parametrize("token", [token.encode() for token in TOKENS])
def test_a_token_is_the_number_that_python_makes_of_it(token, kind):
    expected = parsed_by_python(token, kind)
    values, bad = PARSERS[kind](token, np.array([0]), np.array([len(token)]), np.array([0]))
    assert (bad == 0) == (expected is None)
    if expected is not None:
        assert repr(values[0].item()) == repr(expected)


def test_numbers_are_written_as_repr_and_read_back_exactly():
    numbers = numbers_of_all_sizes(20_000)
    text = _lsgp.format_rows(b"v", numbers[:, None], b"\n")
    assert text == b"".join(b"v %r\n" % value for value in numbers.tolist())
    rows = Rows.split(text)
    assert rows.floats(rows.starts + 1).tobytes() == numbers.tobytes()


def test_numbers_of_many_digits_are_correctly_rounded():
    generator = random.Random(3)

    def digits(most: int) -> int:
        return generator.randrange(10 ** generator.randrange(1, most))

    texts = [f"{digits(30)}.{digits(25)}e{generator.randrange(-40, 40)}" for _ in range(20_000)]
    rows = Rows.split(" ".join(texts).encode())
    assert rows.floats(rows.tokens()).tolist() == list(map(float, texts))


@pytest.mark.parametrize("comments", [False, True])
def test_rows_are_the_lines_and_tokens_of_python(comments):
    generator = random.Random(11)
    data = "".join(
        generator.choices(["\n", "\r", "\r\n", " ", "\t", "\v", "\f", "#", "a", "\\", "12", "é"], k=5000)
    ).encode()
    expected = []
    for number, line in enumerate(data.splitlines(), 1):
        content = line.partition(b"#")[0] if comments else line
        if content.split():
            expected.append((number, content.split()))
    rows = Rows.split(data, comments=comments)
    found = [rows.select(slice(row, row + 1)) for row in range(len(rows.lines))]
    assert [(row.lines[0], [row.token(token) for token in row.tokens()]) for row in found] == expected


def test_continued_lines_are_one_row_with_the_number_of_the_first():
    rows = Rows.split(b"\\\nf 1\\\n\n# between\n 2 \\ # more\n3\nv 4 \\\\\n5\n", continued=True)
    tokens = [[row.token(token) for token in row.tokens()] for row in (rows.select(slice(i, i + 1)) for i in range(2))]
    assert tokens == [[b"f", b"1", b"2", b"3"], [b"v", b"4", b"\\", b"5"]]
    assert rows.lines.tolist() == [2, 7]


def test_the_first_wrong_token_of_those_asked_for_is_named():
    rows = Rows.split(b"x 1\n\nx two\nx three\n")
    with pytest.raises(InputError, match=r"^Line 3: 'two' is not a number\."):
        rows.floats(rows.starts + 1)


def test_edges_of_polygons_are_those_of_a_set():
    generator = np.random.default_rng(5)
    sizes = generator.integers(3, 7, 200)
    corners = np.concatenate([generator.choice(60, size, replace=False) for size in sizes]).astype(np.int32)
    polygons = np.split(corners, np.cumsum(sizes)[:-1])
    pairs = {tuple(sorted(pair)) for p in polygons for pair in zip(p.tolist(), np.roll(p, -1).tolist(), strict=True)}
    mesh = PolygonMesh(generator.random((60, 3)), corners, sizes)
    assert triangulate(mesh).edges.tolist() == [list(pair) for pair in sorted(pairs)]


def test_a_table_has_the_shortest_digits_of_each_column():
    numbers = numbers_of_all_sizes(5_000)
    with np.errstate(over="ignore"):
        single = np.asarray(numbers, np.float32)
    integers = np.arange(len(numbers)) * 2_147_483_647 - 5
    text = _lsgp.format_table([numbers, integers, single, single[::-1]])
    rows = [line.split() for line in text.decode().splitlines()]
    assert [row[0] for row in rows] == [repr(value) for value in numbers.tolist()]
    assert [int(row[1]) for row in rows] == integers.tolist()
    finite = np.isfinite(single)
    written = [row[2] for row in rows]
    assert (np.array(written, np.float32)[finite] == single[finite]).all()
    assert [row[3] for row in rows] == written[::-1]
    fewest = [np.format_float_scientific(value, unique=True, trim="-") for value in single[finite]]
    count = [len(digits.split("e")[0].replace("-", "").replace(".", "")) for digits in fewest]
    mantissas = [text.split("e")[0].replace("-", "").replace(".", "").strip("0") for text in np.array(written)[finite]]
    assert all(len(mantissa) <= most for mantissa, most in zip(mantissas, count, strict=True))
