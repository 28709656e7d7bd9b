# SPDX-License-Identifier: BSD-3-Clause
"""Compare a recording with one that is known to be right, channel by channel."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from nanotouch.errors import InvalidValue
from nanotouch.touch.columns import COLUMNS
from nanotouch.touch.record import Recording
from nanotouch.units import in_words

SHARE = 1e-6  # of the largest value of a channel, where no tolerance is given


def assert_same(recording: Recording, expected: Recording, tolerances: Mapping[str, float] | None = None) -> None:
    """Every channel of `expected` is in `recording`, row by row, within its tolerance.

    Parameters
    ----------
    recording, expected : Recording
        What was recorded, and what is right. Channels that only `recording` has are not compared.
    tolerances : mapping of str to float, optional
        Largest difference of a channel, in its SI unit. By default a millionth of the channel's largest value in
        `expected`, so that another compiler passes; whole numbers have to be equal. NaN equals NaN.
    """
    given = dict(tolerances or {})
    for name, value in given.items():
        if name not in expected:
            raise InvalidValue(f"tolerances: no channel {name!r} is expected; valid are {', '.join(expected.columns)}")
        if not value >= 0.0:
            raise InvalidValue(f"tolerances: {name} = {value} {COLUMNS[name].unit}: valid is 0 or more")
    missing = [name for name in expected.columns if name not in recording]
    if missing:
        raise AssertionError(f"not recorded: {', '.join(missing)}")
    if len(recording) != len(expected):
        raise AssertionError(f"{len(recording)} rows were recorded, {len(expected)} are expected{_ends(recording)}")
    lines = [
        line
        for name in expected.columns
        if (line := _difference(recording, expected, name, given.get(name)))
    ]  # fmt: skip
    if lines:
        raise AssertionError("\n".join([f"{len(lines)} of {len(expected.columns)} channels differ:", *lines]))


def _difference(recording: Recording, expected: Recording, name: str, tolerance: float | None) -> str:
    """Where a channel differs, in a line; "" where it does not."""
    found, right = recording.columns[name], expected.columns[name]
    if tolerance is None:
        tolerance = 0.0 if right.dtype.kind in "ui" else SHARE * _largest(right)
    a, b = found.astype(float), right.astype(float)
    with np.errstate(invalid="ignore"):
        apart = np.where(np.isnan(a) & np.isnan(b) | (a == b), 0.0, np.abs(a - b))
    wrong = np.flatnonzero(~(apart <= tolerance))  # NaN beside a number is wrong, too
    if not len(wrong):
        return ""
    first, worst = int(wrong[0]), int(np.argmax(np.where(np.isnan(apart), np.inf, apart)))
    unit = COLUMNS[name].unit
    said = f"  {name}: {len(wrong)} of {len(a)} rows by more than {_told(tolerance, unit)}; first at "
    said += f"{recording.time[first]:.6g} s: {_told(a[first], unit)}, expected {_told(b[first], unit)}"
    if worst != first:
        said += f"; most at {recording.time[worst]:.6g} s: {_told(a[worst], unit)}, expected {_told(b[worst], unit)}"
    return said


def _largest(values: NDArray[Any]) -> float:
    known = np.abs(values[np.isfinite(values)])
    return float(known.max()) if known.size else 0.0


def _told(value: float, unit: str) -> str:
    return in_words(float(value), unit, 6) if unit else f"{value:.6g}"


def _ends(recording: Recording) -> str:
    return f"; it ends at {recording.time[-1]:.6g} s" if len(recording) else ""
