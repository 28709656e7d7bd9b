# SPDX-License-Identifier: BSD-3-Clause
"""How the command ends: a failure is one line on stderr and an exit status, never a traceback."""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Callable
from typing import TextIO

from nanotouch.errors import Error

READER_GONE, REFUSED, BUG = 1, 2, 70
"""exit statuses; 70 is EX_SOFTWARE of sysexits.h; 128 and the number of a signal is what shells give for it"""
DEBUG = "NANOTOUCH_DEBUG"
"""the environment variable that lets failures through, with their traceback"""
LONGEST = 600  # characters of a line


def guarded(name: str, work: Callable[[], int]) -> int:
    """The status of ``work``; of a failure, once a line that begins with ``name`` has told it."""
    try:
        _check_streams()
        try:
            return work()
        finally:
            sys.stdout.flush()  # at exit nobody could tell that it failed
    except SystemExit:
        raise
    except BaseException as failure:
        if os.environ.get(DEBUG):
            raise
        status, words = _answer(failure)
        _tell(f"{name}: {words}" if words else "")
        return status


def one_line(text: str) -> str:
    """The text without line breaks and other control characters, cut in its middle where it is long."""
    shown = "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in text)
    half = LONGEST // 2
    return shown if len(shown) <= LONGEST else f"{shown[:half]} ... {shown[-half:]}"


def _answer(failure: BaseException) -> tuple[int, str]:
    """The exit status, and what is told."""
    match failure:
        case KeyboardInterrupt():
            return 128 + getattr(failure, "number", signal.SIGINT), str(failure) or "stopped"
        case BrokenPipeError():
            return READER_GONE, ""
        case Error():
            return REFUSED, str(failure)
        case MemoryError():
            return REFUSED, "there is not enough memory for this"
        case OSError():
            return REFUSED, f"{_place(failure)}: {failure.strerror or failure}"
    return BUG, (
        f"a bug of nanotouch, please report it: {type(failure).__name__}: {failure} ({DEBUG}=1 shows where it happened)"
    )


def _check_streams() -> None:
    if sys.stderr is None:
        sys.stderr = open(os.devnull, "w")  # noqa: SIM115 for as long as the process lives
    if sys.stdout is None:  # the next file that is opened would be taken for it
        raise Error("standard output is closed; redirect it, to /dev/null if nobody reads it")


def _place(failure: OSError) -> str:
    """Where it failed. An error of standard output names no file: an empty line tells whether it was that."""
    if failure.filename is not None:
        return os.fsdecode(failure.filename)
    return "reading or writing failed" if _takes(sys.stdout, "\n") else "cannot write to standard output"


def _takes(stream: TextIO, text: str) -> bool:
    """Whether the text, and what the stream still holds, can be written."""
    try:
        stream.write(text)
        stream.flush()
    except OSError:
        return False
    return True


def _tell(line: str) -> None:
    for stream, text in ((sys.stdout, ""), (sys.stderr, f"{one_line(line)}\n" if line else "")):
        if stream is not None and not _takes(stream, text):  # what it holds goes nowhere, or the flush at exit fails
            os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())
