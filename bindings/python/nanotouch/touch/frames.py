# SPDX-License-Identifier: BSD-3-Clause
"""Watch a running session from this or another process: one frame per tick, and what the session says of itself.

::

    with nanotouch.frames.attach("grating") as session:
        while session.alive:
            for frame in session.read():
                print(frame["time"], frame["tip_force"][2])

An observer that stops, crashes or lags changes nothing for the session. It must be the same user on the same machine.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from nanotouch import _core
from nanotouch._io.closing import Closing
from nanotouch.errors import DeviceError, InvalidValue

#: a frame, in SI units, axes and signs as on the page "Frames and signs"; NaN where a number is not known
FRAME: np.dtype[np.void] = _core.frame_dtype

#: how many frames a session keeps
SLOTS: int = _core.frame_slots


End = TypeVar("End")


def attached(end: Callable[[str], End], name: str) -> End:
    """One end of the session of that name, or what is wrong in words."""
    try:
        return end(name)
    except InvalidValue as error:
        raise InvalidValue(
            f"name = {name!r}: valid are 1 to 64 letters (a-z, A-Z), digits, dots, hyphens and underscores"
        ) from error
    except DeviceError as error:
        raise DeviceError(f"no session {name!r} of this user and this version of nanotouch is running") from error


class Observer(Closing):
    """A reader of one session's frames; made by :func:`attach`. For one thread."""

    def __init__(self, name: str) -> None:
        self._name = name
        self._handle = attached(_core.Observer, name)

    def newest(self) -> np.void | None:
        """The newest frame; None before the first one. Does not change what :meth:`read` gives next."""
        return self._handle.newest()

    def read(self, count: int = SLOTS) -> NDArray[np.void]:
        """Up to `count` frames (``FRAME``) in their order, each once, beginning with the first one after attaching.

        An observer that has fallen behind by more than ``SLOTS`` goes on with newer ones; see :attr:`missed`.
        """
        if count < 0:
            raise InvalidValue(f"count = {count}: valid is 0 or more")
        return self._handle.read(min(count, SLOTS))

    @property
    def missed(self) -> int:
        """Frames that were overwritten before they were read."""
        return self._handle.missed

    @property
    def silence(self) -> float:
        """How long ago the session gave a sign of life [s]; infinite once it has closed."""
        return self._handle.silence

    @property
    def alive(self) -> bool:
        """Has the session given a sign of life within the last second?"""
        return self._handle.alive

    @property
    def description(self) -> str:
        """What the session says of itself; empty before it has said anything."""
        return self._handle.description()[0]

    @property
    def changes(self) -> int:
        """How often the description was set; a frame's ``changes`` says which one holds for it."""
        return self._handle.description()[1]

    def close(self) -> None:
        """Detach. May be repeated."""
        self._handle.close()

    def __repr__(self) -> str:
        return f"Observer({self._name!r})"


def attach(name: str) -> Observer:
    """Attach to the running session of that name; :class:`~nanotouch.errors.DeviceError` if there is none."""
    return Observer(name)
