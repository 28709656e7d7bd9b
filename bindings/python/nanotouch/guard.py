# SPDX-License-Identifier: BSD-3-Clause
"""Whether files are read in a guarded process: the ``nanotouch`` command does so unless ``--trusted`` is given; Python
where ``untrusted=True`` asks for it."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

_is_default = False


@contextmanager
def by_default(on: bool) -> Iterator[None]:
    """Within it, whoever says nothing reads guarded, or not. On other systems than Linux there is no guard."""
    global _is_default
    before, _is_default = _is_default, on and is_there()
    try:
        yield
    finally:
        _is_default = before


def is_there() -> bool:
    """Whether this system has a guard."""
    return sys.platform == "linux"


def wanted(untrusted: bool | None) -> bool:
    """Whether this file is read guarded."""
    return _is_default if untrusted is None else untrusted


def forget() -> None:
    """In the guarded process itself."""
    global _is_default
    _is_default = False


@dataclass(frozen=True)
class Limits:
    """What a child may use.

    Attributes
    ----------
    memory : int
        Address space [byte], beside what the process has when it begins.
    time : float
        Of the processor, and of the clock by a factor 3 [s].
    files : int
        Open at a time.
    """

    memory: int = 3 << 29
    time: float = 20.0
    files: int = 32

    def of(self, file: Path) -> Limits:
        """They grow with the file: 12 bytes of memory for each of its bytes, a second for 2 MB."""
        try:
            size = file.stat().st_size
        except OSError:
            size = 0
        return Limits(self.memory + 12 * size, self.time + size / 2e6, self.files)


LIMITS = Limits()
