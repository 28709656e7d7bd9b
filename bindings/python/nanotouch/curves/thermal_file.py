# SPDX-License-Identifier: BSD-3-Clause
"""Thermal spectra that JPK's software stores, ``.tnd``: text with the calibration in its head, then columns."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from os import PathLike
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from .. import guard
from .._io import worker
from .._io.files import checked_path, guarded
from ..errors import InvalidValue, ReadError
from ..units import parse_quantity

NAME = "nanotouch/thermal-file"
_FIRST = "# thermal noise data"
_MAX_POINTS = 1 << 22


@dataclass(frozen=True, eq=False)
class ThermalSpectrum:
    """What a file says of the thermal motion of a cantilever.

    Attributes
    ----------
    frequency : ndarray, shape (n,)
        [Hz], growing; the value at 0 Hz, which no oscillator has, is left out.
    density : ndarray, shape (n,)
        One-sided power spectral density of the deflection [m^2/Hz]; [V^2/Hz] where no sensitivity is stated.
    sensitivity, spring_constant : float or None
        As the file states them [m/V], [N/m].
    facts : mapping
        The rest of its head, as text.
    """

    frequency: NDArray[np.float64]
    density: NDArray[np.float64]
    sensitivity: float | None
    spring_constant: float | None
    facts: Mapping[str, str]


def thermal_spectrum(path: str | PathLike[str], *, untrusted: bool | None = None) -> ThermalSpectrum:
    """Read a thermal spectrum, for :func:`~nanotouch.curves.thermal_tune`.

    Parameters
    ----------
    path : str or path
        JPK's ``.tnd``.
    untrusted : bool, optional
        As in :func:`nanotouch.curves.read`.

    Raises
    ------
    ReadError
        If it is none, or damaged.
    """
    file = checked_path(path)
    if guard.wanted(untrusted):
        return worker.ask("curves.thermal", file, {}, ThermalSpectrum)
    with guarded(file, NAME):
        return _read(file)


def _read(file: Path) -> ThermalSpectrum:
    with file.open("rb") as stream:
        if not stream.read(len(_FIRST)).decode("latin-1") == _FIRST:
            raise ReadError(f"{file}: no thermal spectrum of JPK's (.tnd)")
    lines = _decoded(file.read_bytes()).splitlines()
    pairs = [line[1:].partition(":") for line in lines if line.startswith("#")]
    facts = {key.strip(): value.strip() for key, colon, value in pairs if colon}
    names, units = (re.findall(r"'([^']*)'", facts.get(key, "").replace("^2", "²")) for key in ("Channels", "Units"))
    if names[:2] != ["Frequency", "Vertical Deflection"] or units[:2] != ["Hz", "V²/Hz"]:
        raise ReadError(
            f"{file}: columns {names} in {units}, expected frequency and vertical deflection in Hz and V²/Hz"
        )
    rows = [line.split() for line in lines if line.strip() and not line.startswith("#")]
    if rows and len(rows[-1]) < len(names):
        rows.pop()  # cut off
    if not 16 <= len(rows) <= _MAX_POINTS or any(len(row) != len(names) for row in rows):
        raise ReadError(f"{file}: {len(rows)} rows, or rows of another length than its {len(names)} columns")
    frequency, volts = np.array([row[:2] for row in rows], np.float64).T
    good = (frequency > 0.0) & (volts > 0.0)
    frequency, volts = frequency[good], volts[good]
    if not np.isfinite(volts).all() or not (np.diff(frequency) > 0.0).all():
        raise ReadError(f"{file}: frequencies that do not grow, or densities that are no numbers")
    sensitivity = _quantity(facts.get("sensitivity"), "m/V")
    return ThermalSpectrum(
        frequency,
        volts if sensitivity is None else volts * sensitivity**2,
        sensitivity,
        _quantity(facts.get("spring constant"), "N/m"),
        {k: v for k, v in facts.items() if k not in ("Channels", "Units", "sensitivity", "spring constant")},
    )


def _decoded(content: bytes) -> str:
    """JPK writes UTF-8, what went through an old editor is Latin-1."""
    try:
        return content.decode("utf-8")
    except UnicodeDecodeError:
        return content.decode("latin-1")


def _quantity(text: str | None, unit: str) -> float | None:
    """Of ``"11.04 nm/V"``; None where it is not stated."""
    if text is None:
        return None
    try:
        return parse_quantity(text.replace(" ", ""), unit)
    except InvalidValue as error:
        raise ReadError(str(error)) from None
