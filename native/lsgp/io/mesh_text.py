# SPDX-License-Identifier: GPL-3.0-or-later
"""Shared by the readers of text formats: rows of tokens, their numbers, and errors that name the line."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from .. import _lsgp
from ..errors import InputError

# The byte order mark that some programs put before a text.
BYTE_ORDER_MARK = b"\xef\xbb\xbf"


def malformed(problem: str, line: int | None = None) -> InputError:
    """The refusal of a file that breaks its own format. line: counted from 1."""
    where = "" if line is None else f"Line {line}: "
    return InputError("MALFORMED_FILE", f"{where}{problem} Export the file again.")


def quoted(token: bytes, most: int = 40) -> str:
    """A token of a file for a message: short, printable."""
    text = token[:most].decode("ascii", "backslashreplace")
    return "'" + "".join(c if c.isprintable() else "?" for c in text) + "'"


def ranges(begins: NDArray[np.int64], counts: NDArray[np.int64]) -> NDArray[np.int64]:
    """The integers begin, begin + 1, ... of each range, one range after the other."""
    ends = np.cumsum(counts)
    return np.arange(int(counts.sum())) + np.repeat(begins - ends + counts, counts)


@dataclass(frozen=True)
class Rows:
    """Lines split into tokens. Those are places in the text: a list of tokens costs more than all the rest of reading.

    data: the text. begins, ends: (t,) int64, where each token is in it.
    starts, counts: (r,) int64, the first token of each row and how many it has. lines: (r,) int64, of each row, from 1.
    """

    data: bytes
    begins: NDArray[np.int64]
    ends: NDArray[np.int64]
    starts: NDArray[np.int64]
    counts: NDArray[np.int64]
    lines: NDArray[np.int64]

    @classmethod
    def split(cls, data: bytes, *, comments: bool = True, continued: bool = False) -> Rows:
        """The lines with something in them, with any line ending.

        comments: what comes after a # is none of it. continued: lines that end in a backslash go on with the next.
        """
        text = data.removeprefix(BYTE_ORDER_MARK)
        begins, ends, counts, lines = _lsgp.split_rows(text, comments, continued)
        return cls(text, begins, ends, np.cumsum(counts) - counts, counts, lines)

    def select(self, rows: NDArray[np.bool_] | slice) -> Rows:
        """A subset of the rows, with the same tokens."""
        return replace(self, starts=self.starts[rows], counts=self.counts[rows], lines=self.lines[rows])

    def without_first(self) -> Rows:
        """The rows without their first tokens."""
        return replace(self, starts=self.starts + 1, counts=self.counts - 1)

    def parts(self, part: int) -> Rows:
        """The rows with the first (0) or second (1) of the parts between slashes in the place of each token; empty
        where a token has none."""
        begins, ends = _lsgp.slash_parts(self.data, self.begins, self.ends, self.tokens(), part)
        return Rows(self.data, begins, ends, np.cumsum(self.counts) - self.counts, self.counts, self.lines)

    def tokens(self) -> NDArray[np.int64]:
        """All tokens of the rows, in order, as indices into `begins`."""
        return ranges(self.starts, self.counts)

    def token(self, index: int) -> bytes:
        return self.data[self.begins[index] : self.ends[index]]

    def keywords(self) -> tuple[list[bytes], NDArray[np.int64]]:
        """The different first tokens of the rows, which have some, in the order in which they first appear, and which
        one each row has."""
        return _lsgp.distinct_tokens(self.data, self.begins, self.ends, self.starts)

    def require_tokens(self, least: int, problem: str) -> None:
        """Refuse the first row with fewer tokens. problem: says what is wrong, with {} for how many there are."""
        short = np.flatnonzero(self.counts < least)
        if len(short):
            raise malformed(problem.format(self.counts[short[0]]), int(self.lines[short[0]]))

    def floats(self, picks: NDArray[np.int64]) -> NDArray[np.float64]:
        """The numbers that given tokens are, correctly rounded.  Raises InputError: MALFORMED_FILE."""
        return self._numbers(_lsgp.parse_floats, picks, "a number")

    def integers(self, picks: NDArray[np.int64]) -> NDArray[np.int64]:
        """The integers that given tokens are.  Raises InputError: MALFORMED_FILE."""
        return self._numbers(_lsgp.parse_integers, picks, "an integer")

    def line_of(self, token: int) -> int:
        """The line on which a token of these rows stands."""
        return int(self.lines[np.searchsorted(self.starts, token, side="right") - 1])

    def _numbers(self, parse: Callable, picks: NDArray[np.int64], what: str) -> NDArray:
        numbers, bad = parse(self.data, self.begins, self.ends, picks)
        if bad >= 0:
            token = int(picks[bad])
            raise malformed(f"{quoted(self.token(token))} is not {what}.", self.line_of(token))
        return numbers
