# SPDX-License-Identifier: GPL-3.0-or-later
"""Standard output and error: unbuffered writing that copes with streams that are closed, full or without a reader."""

from __future__ import annotations

import contextlib
import errno
import os
import sys
from typing import TextIO

# Of ASCII and of what follows it: those that end lines and command terminals.
_CONTROLS = {code: f"\\x{code:02x}" for code in (*range(0x20), *range(0x7F, 0xA0))}


def visible(name: str) -> str:
    """With control characters escaped, by which the name of a file would end a line or command the terminal."""
    return name.translate(_CONTROLS)


def say(stream: TextIO | None, text: str) -> None:
    """Print lines at once; control characters, and those the terminal has not, are escaped.  Raises OSError.

    stream: None where the process was started without it, which is no error; nor is a reader that has closed its end.
    """
    if stream is None:
        return
    encoding = stream.encoding or "utf-8"
    try:
        shown = "\n".join(map(visible, text.split("\n")))
        print(shown.encode(encoding, "backslashreplace").decode(encoding), file=stream, flush=True)
    except OSError as error:
        silence(stream)
        if not has_no_reader(error):  # without one the command goes on, as it still has files to write
            raise _not_written(error.strerror or str(error)) from error


def complain(text: str) -> None:
    """Print a line to standard error, ignoring failures."""
    with contextlib.suppress(OSError):
        say(sys.stderr, text)


def write_to_standard_output(data: bytes) -> None:
    """Raises OSError, also where the reader has closed its end before it received everything."""
    if sys.stdout is None:
        raise _not_written(os.strerror(errno.EBADF))
    try:
        sys.stdout.buffer.write(data)
        sys.stdout.buffer.flush()
    except OSError as error:
        silence(sys.stdout)
        raise _not_written(error.strerror or str(error)) from error


def has_no_reader(error: OSError) -> bool:
    """Whether a stream could not be written because its reader has closed its end; Windows calls that EINVAL."""
    return isinstance(error, BrokenPipeError) or (os.name == "nt" and error.errno == errno.EINVAL)


def silence(stream: TextIO) -> None:
    """Redirect a stream to the null device, so that flushing it at exit cannot fail again."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, stream.fileno())
    os.close(nowhere)


def hold_standard_descriptors() -> None:
    """Open closed ones of standard input, output and error on the null device, or files would get their descriptors."""
    for descriptor in range(3):
        try:
            os.fstat(descriptor)
        except OSError:
            os.open(os.devnull, os.O_RDWR)


def _not_written(reason: str) -> OSError:
    return OSError(errno.EIO, reason, "standard output")
