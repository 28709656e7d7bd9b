# SPDX-License-Identifier: BSD-3-Clause
"""Spring constant and sensitivity of files by a lever of known stiffness: SNAP.

Schillers et al., Sci. Rep. 7 (2017) 5117: the sensitivity, found by pressing on a hard sample, scatters from day to
day; the stiffness of a lever that its vendor measured does not. Thermal noise gives k_th = c k_B T/(s^2 <u^2>) of the
detector's volts u with the file's sensitivity s. That it has to be k of the lever corrects s:

    s' = s sqrt(k_th/k)

k is then known as the vendor knows it, s' to half of what k_th/k is known to, and both are correlated: the force,
k s' u, goes as sqrt(k k_th).
"""

from __future__ import annotations

import csv
from collections.abc import Iterable
from dataclasses import dataclass
from glob import escape
from os import PathLike
from pathlib import Path

import numpy as np

from .._arrays import check_between
from ..errors import InvalidValue, ReadError
from .calibration import PLACEHOLDERS, SPRING_CONSTANT_RANGE
from .reading import read, stream


@dataclass(frozen=True)
class Lever:
    """A lever whose stiffness is known, and what the files' thermal tunes are worth.

    Parameters
    ----------
    spring_constant : float
        k of the vendor [N/m], 1e-4 .. 1e4.
    sigma : float
        Its relative standard uncertainty, below 1; 0.04 for a laser Doppler vibrometer.
    thermal_sigma : float
        Relative standard uncertainty of the spring constants that the files state, without that of their sensitivity:
        the scatter of repeated thermal tunes, temperature and the mode's factor.
    """

    spring_constant: float
    sigma: float
    thermal_sigma: float

    def __post_init__(self) -> None:
        limits = {"spring_constant": (*SPRING_CONSTANT_RANGE, "N/m"), "sigma": (0.0, 0.99, ""),
                  "thermal_sigma": (0.0, 0.99, "")}  # fmt: skip
        for name, (low, high, unit) in limits.items():
            value = getattr(self, name)
            if not low <= value <= high:
                raise InvalidValue(
                    f"{name} = {value:g} {unit}".rstrip() + f": valid is {low:g} to {high:g} {unit}".rstrip()
                )

    def sensitivity(self, stated: float, thermal: float) -> float:
        """The corrected sensitivity [m/V] of a file that states `stated` [m/V] and k_th `thermal` [N/m]."""
        check_between("thermal", thermal, "N/m", above=0.0)
        return stated * float(np.sqrt(thermal / self.spring_constant))

    @property
    def known_to(self) -> dict[str, float]:
        """Arguments of :class:`nanotouch.fit.Uncertainties`: relative uncertainties of s' and k, their correlation."""
        ratio = float(np.hypot(self.sigma, self.thermal_sigma))
        correlation = -self.sigma / ratio if ratio > 0.0 else 0.0
        return {"sensitivity": 0.5 * ratio, "spring_constant": self.sigma, "correlation": correlation}


@dataclass(frozen=True)
class Recalibrated:
    """One file: what it states, and its corrected sensitivity [N/m], [m/V], [m/V]."""

    file: Path
    thermal: float
    stated: float
    sensitivity: float


def recalibrate(files: Iterable[str | PathLike[str]], lever: Lever) -> list[Recalibrated]:
    """The corrected sensitivity of each file, whose stated spring constant is taken as its thermal tune.

    Raises
    ------
    ReadError
        For a file that states no spring constant or sensitivity that anybody measured.
    """
    found = []
    for file in map(Path, files):
        many = stream(file)
        meta = (read(file) if many is None else many)[0].meta
        for key in PLACEHOLDERS:
            if meta.get(key) is None or key in meta.get("placeholders", ()):
                raise ReadError(f"{file}: states no {key} that was measured, so its thermal tune corrects nothing")
        thermal, stated = float(meta["spring constant"]), float(meta["sensitivity"])
        found.append(Recalibrated(file, thermal, stated, lever.sensitivity(stated, thermal)))
    return found


def write_table(path: str | PathLike[str], found: Iterable[Recalibrated], lever: Lever) -> None:
    """As :meth:`CalibrationTable.from_csv` reads it; files by their whole paths, so that none is taken for another."""
    with Path(path).open("w", newline="", encoding="utf-8") as out:
        table = csv.writer(out)
        table.writerow(("file", "spring_constant", "sensitivity"))
        for one in found:
            name = escape(one.file.absolute().as_posix().lstrip("/"))
            table.writerow((name, f"{lever.spring_constant!r} N/m", f"{one.sensitivity!r} m/V"))
