# SPDX-License-Identifier: BSD-3-Clause
"""Compare a recording with one that is known to be right, channel by channel."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from nanotouch.errors import InvalidValue
from nanotouch.testing._given import TIME, number, recording_of, rows_of
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
        `expected`, so that another compiler passes; whole numbers have to be equal. NaN equals NaN, and nothing else;
        with infinity that is all that is compared.
    """
    rows_of(expected, "expected")  # of nothing that is expected everything would be true
    if expected.incomplete:
        raise InvalidValue(f"expected is incomplete: {expected.incomplete}")
    recording_of(recording)
    given = _checked(tolerances, expected)
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


def _checked(tolerances: Mapping[str, float] | None, expected: Recording) -> dict[str, float]:
    if tolerances is not None and not isinstance(tolerances, Mapping):
        raise InvalidValue(f"tolerances = {tolerances!r}: valid is a mapping of channels to differences")
    given = {}
    for name, value in (tolerances or {}).items():
        if name not in expected:
            raise InvalidValue(f"tolerances: no channel {name!r} is expected; valid are {', '.join(expected.columns)}")
        unit = COLUMNS[name].unit
        given[name] = number(f"tolerances: {name}", value, unit)
        if not given[name] >= 0.0:
            raise InvalidValue(f"tolerances: {name} = {value} {unit}: valid is 0 or more")
    return given


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
    said += f"{recording.time[first]:{TIME}} s: {_told(a[first], unit)}, expected {_told(b[first], unit)}"
    if worst != first:
        said += f"; most at {recording.time[worst]:{TIME}} s: {_told(a[worst], unit)}, expected {_told(b[worst], unit)}"
    return said


def _largest(values: NDArray[Any]) -> float:
    known = np.abs(values[np.isfinite(values)])
    return float(known.max()) if known.size else 0.0


def _told(value: float, unit: str) -> str:
    return in_words(float(value), unit, 6) if unit else f"{value:.10g}"  # all bits of whole numbers


def _ends(recording: Recording) -> str:
    return f"; it ends at {recording.time[-1]:{TIME}} s" if len(recording) else ""
