# SPDX-License-Identifier: BSD-3-Clause
"""What ``with`` closes."""

from __future__ import annotations

from types import TracebackType
from typing import Self


class Closing:
    """A base of what has ``close()``: the end of a ``with`` block calls it, whatever ended the block."""

    def close(self) -> None:
        """Give back what it holds."""
        raise NotImplementedError

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()
