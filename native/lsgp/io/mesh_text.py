# SPDX-License-Identifier: GPL-3.0-or-later
"""What the readers of text formats share: rows of tokens, their numbers, and the refusal that names the line."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..errors import InputError

# Comments are taken off before lines become rows, so that no token is this one.
ROW_END = b"#"
# The byte order mark that some programs put before a text.
BYTE_ORDER_MARK = b"\xef\xbb\xbf"


def malformed(problem: str, line: int | None = None) -> InputError:
    """The refusal of a file that breaks its own format. line: counted from 1."""
    where = "" if line is None else f"Line {line}: "
    return InputError("MALFORMED_FILE", f"{where}{problem} Export the file again.")


def quoted(token: bytes) -> str:
    """A token of a file for a message: short, printable."""
    text = token[:40].decode("ascii", "backslashreplace")
    return "'" + "".join(c if c.isprintable() else "?" for c in text) + "'"


def content_lines(data: bytes) -> tuple[list[bytes], list[int]]:
    """Lines with something in them, without comments, and their numbers, from 1.  Any line ending will do."""
    lines = data.removeprefix(BYTE_ORDER_MARK).splitlines()
    if ROW_END in data:
        lines = [line.partition(ROW_END)[0] for line in lines]
    numbers = [number for number, line in enumerate(lines, 1) if line and not line.isspace()]
    return [lines[number - 1] for number in numbers], numbers


def ranges(begins: NDArray[np.int64], counts: NDArray[np.int64]) -> NDArray[np.int64]:
    """The integers begin, begin + 1, ... of each range, one range after the other."""
    ends = np.cumsum(counts)
    return np.arange(int(counts.sum())) + np.repeat(begins - ends + counts, counts)


@dataclass(frozen=True)
class Rows:
    """Lines split into tokens; one flat list, for a list of lists costs more than all the rest of reading a file.

    tokens: all tokens, row after row. counts: (r,) int64, tokens of each row. lines: the line of each row, from 1.
    """

    tokens: list[bytes]
    counts: NDArray[np.int64]
    lines: list[int]

    @classmethod
    def split(cls, texts: list[bytes], lines: list[int]) -> Rows:
        tokens = (b" " + ROW_END + b" ").join([*texts, b""]).split()
        is_end = np.fromiter(map(ROW_END.__eq__, tokens), bool, len(tokens))
        counts = np.diff(np.flatnonzero(is_end), prepend=-1) - 1
        width = int(counts[0]) + 1 if len(counts) else 1
        if (counts == width - 1).all():
            del tokens[width - 1 :: width]
        else:
            tokens = [token for token in tokens if token != ROW_END]
        return cls(tokens, counts, lines)

    @property
    def starts(self) -> NDArray[np.int64]:
        """(r,) int64, where in `tokens` each row begins."""
        return np.cumsum(self.counts) - self.counts

    def require_tokens(self, least: int, problem: str) -> None:
        """Refuse the first row with fewer tokens. problem: says what is wrong, with {} for how many there are."""
        short = np.flatnonzero(self.counts < least)
        if len(short):
            raise malformed(problem.format(self.counts[short[0]]), self.lines[short[0]])

    def floats(self, picks: NDArray[np.int64]) -> NDArray[np.float64]:
        """The numbers at given places of `tokens`, correctly rounded.  Raises InputError: MALFORMED_FILE."""
        return self._numbers(picks, float, np.float64, "a number")

    def integers(self, picks: NDArray[np.int64]) -> NDArray[np.int64]:
        """The integers at given places of `tokens`.  Raises InputError: MALFORMED_FILE."""
        return self._numbers(picks, int, np.int64, "an integer")

    def line_of(self, token: int) -> int:
        """The line on which a token stands."""
        return self.lines[int(np.searchsorted(np.cumsum(self.counts), token, side="right"))]

    def _numbers(self, picks: NDArray[np.int64], parse: Callable, dtype: type, what: str) -> NDArray:
        everything = len(picks) == len(self.tokens) and bool((np.diff(picks) == 1).all())
        tokens = self.tokens if everything else list(map(self.tokens.__getitem__, picks.tolist()))
        # Python alone takes 1_000 for a number.
        if b"_" not in b" ".join(tokens):
            try:
                return np.fromiter(map(parse, tokens), dtype, len(tokens))
            except (ValueError, OverflowError):
                pass
        bad = next(i for i, token in enumerate(tokens) if not _is_number(token, parse, dtype))
        raise malformed(f"{quoted(tokens[bad])} is not {what}.", self.line_of(int(picks[bad])))


def _is_number(token: bytes, parse: Callable, dtype: type) -> bool:
    try:
        np.array(parse(token), dtype)
    except (ValueError, OverflowError):
        return False
    return b"_" not in token
