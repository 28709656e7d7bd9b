# SPDX-License-Identifier: BSD-3-Clause
"""What a reader of images says a file holds, and which of it is taken."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..errors import ReadError
from .checks import LENGTHS

#: Names of height channels, best first: a calibrated sensor before the voltage of a piezo.
HEIGHT_NAMES = ("zsensor", "z sensor", "axissensor", "measured", "z height", "height", "topography", "z-axis", "zaxis")
#: In the names of channels that hold no heights, whatever their unit.
OTHER_NAMES = ("amplitude", "phase", "error", "deflection", "friction", "lateral", "potential", "current")
_TOLD = 20  # names in an error
_BACKWARD_NAMES = ("retrace", "backward", "reverse")


@dataclass(frozen=True)
class Channel:
    """One channel of an image file.

    Attributes
    ----------
    name : str
        Unique in its file: repeated names are numbered, ``"Friction#2"``.
    shape : tuple of int or None
        ``(ny, nx)`` [pixel]; None where the file tells only with the data.
    size : tuple of float or None
        Scan size ``(Ly, Lx)`` [m]; None where the file states none, or no unit.
    unit : str or None
        Unit the values are stored in; None where the file states none.
    kind : str
        What it holds: ``"height"``, ``"phase"``, ``"deflection"``, ...
    default : bool
        True for the channel that :func:`read` takes when it is not told.
    """

    name: str
    shape: tuple[int, int] | None
    size: tuple[float, float] | None
    unit: str | None
    kind: str
    default: bool


@dataclass(frozen=True, eq=False)
class Plane:
    """The values of one channel as a reader hands them over, before they are checked.

    Attributes
    ----------
    name : str
        Of the channel.
    values : ndarray, shape (ny, nx), float64
        In `unit`, row 0 at the **lower** edge of the picture; NaN where nothing was measured. May be changed in place.
    unit : str or None
        ``"m"``, ``"um"``, ``"nm"``, ...; None where the file states none.
    pixel_size : tuple of float or None
        ``(dy, dx)`` [m], scan size over the number of pixels; None where the file states no size.
    no_size : str
        Why there is no pixel size, as part of a sentence.
    mask : ndarray, shape (ny, nx), bool, optional
        True where the file says that a value was filled in, which stays as it is.
    source : str
        Reader and format, as ``"nanotouch/asylum-image"``.
    notes : tuple of str
        What was left out or supplied.
    """

    name: str
    values: NDArray[np.float64]
    unit: str | None
    pixel_size: tuple[float, float] | None
    source: str
    no_size: str = "states no scan size"
    mask: NDArray[np.bool_] | None = None
    notes: tuple[str, ...] = ()


def other_kind(name: str) -> str:
    """What a channel of this name holds that is no height; empty where the name does not say so."""
    return next((part for part in OTHER_NAMES if part in name.casefold()), "")


def si_unit(unit: str) -> str:
    """Of a format that keeps to SI, where A is the ampere and no Ångström, as elsewhere."""
    return "ampere" if unit == "A" else unit


def written_unit(unit: str | None) -> str:
    """As a format that keeps to SI has it: metres for every length."""
    return "m" if unit in LENGTHS else "A" if unit == "ampere" else unit or ""


def with_default(listed: Sequence[Channel]) -> list[Channel]:
    """The same with the channel marked that is read if none is named: of the heights, the first of the best name."""

    def rank(channel: Channel) -> tuple[int, bool, bool]:
        name = channel.name.casefold()
        known = [i for i, part in enumerate(HEIGHT_NAMES) if part in name]
        backward = any(part in name for part in _BACKWARD_NAMES)
        return (known[0] if known else len(HEIGHT_NAMES), "interleave" in name, backward)

    best = min((channel for channel in listed if channel.kind == "height"), key=rank, default=None)
    return [replace(channel, default=channel is best) for channel in listed]


def chosen(listed: Sequence[Channel], name: str | None, file: Path) -> int:
    """Number of the channel of this name, whatever its case; without a name, of the default."""
    names = ", ".join(channel.name for channel in listed[:_TOLD]) + (", ..." if len(listed) > _TOLD else "")
    if name is None:
        found = [number for number, channel in enumerate(listed) if channel.default]
        if not found:
            raise ReadError(f"{file}: {_no_height(listed)}")
    else:
        found = [number for number, channel in enumerate(listed) if channel.name.casefold() == name.casefold()]
        if len(found) != 1:
            raise ReadError(f"{file}: no channel {name!r}; it holds {names}")
    return found[0]


def _no_height(listed: Sequence[Channel]) -> str:
    """What there is instead, and what to do."""
    told = [f"{channel.name} ({channel.unit or 'no unit'})" for channel in listed[:_TOLD]]
    names = ", ".join(told) + (", ..." if len(listed) > _TOLD else "")
    usable = [channel for channel in listed if channel.unit is None or channel.unit in LENGTHS]
    if not usable:
        return f"no height channel; it holds {names}, of which none is a length; save the file with its heights"
    unit = " and its height unit (z unit)" if any(channel.unit is None for channel in usable) else ""
    return f"no height channel; it holds {names}; if one of them holds heights, give its name (channel){unit}"
