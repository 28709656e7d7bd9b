# SPDX-License-Identifier: BSD-3-Clause
"""Temporary folders that do not outlive a process that was killed."""

from __future__ import annotations

import os
import shutil
import tempfile
from pathlib import Path

try:
    import fcntl
except ImportError:  # not Linux: folders are removed by their process alone
    fcntl = None  # type: ignore[assignment]

OWNER = "owner"


class Scratch:
    """A temporary folder of a live view. A process that was killed leaves its own behind: the next one removes it."""

    prefix = "nanotouch-live-"

    def __init__(self) -> None:
        self._remove_left()
        self._folder = tempfile.TemporaryDirectory(prefix=self.prefix)
        self.path = Path(self._folder.name)
        self._owner = open(self.path / OWNER, "wb")  # noqa: SIM115  held as long as this process lives
        _lock(self._owner.fileno())

    def close(self) -> None:
        """Remove it."""
        self._owner.close()
        self._folder.cleanup()

    @classmethod
    def _remove_left(cls) -> None:
        """Folders whose owner's lock nobody holds; of other users, none."""
        for folder in Path(tempfile.gettempdir()).glob(f"{cls.prefix}*"):
            try:
                with open(folder / OWNER, "rb") as owner:
                    if _lock(owner.fileno()) and folder.stat().st_uid == os.getuid():
                        shutil.rmtree(folder, ignore_errors=True)
            except OSError:  # it has just been made, or is not ours
                continue


def _lock(handle: int) -> bool:
    """Take the lock of an open file without waiting; False where another process has it, or there are none."""
    if fcntl is None:
        return False
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        return False
    return True
