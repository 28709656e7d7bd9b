# SPDX-License-Identifier: BSD-3-Clause
"""Groups of curves: which belong together, and what their values come to."""

from __future__ import annotations

import csv
import fnmatch
import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._io.words import counted
from ..errors import ReadError
from ..fit.result import REJECTED
from ..fit.show import with_sigma

Label = Callable[[Path], str]

FOLDER = "folder"
NO_GROUP = "no group"  # of a file that no line of a table matches
PERCENTILES = (5.0, 25.0, 50.0, 75.0, 95.0)
#: what is summed up: column of the table, its name in words, its unit
QUANTITIES = {
    "E [Pa]": ("E", "Pa"),
    "E* [Pa]": ("E*", "Pa"),
    "pull_off_force [N]": ("pull-off force", "N"),
    "separation_work [J]": ("work of separation", "J"),
    "exponent": ("exponent beta", ""),
    "relaxation_time [s]": ("relaxation time", "s"),
}
_MODULI = ("E [Pa]", "E* [Pa]")  # one of both, as the Poisson ratio is known or not
_OF_SOME = ("exponent", "relaxation_time [s]")  # models: shown where a curve has it
_FEWEST = 8  # values, to judge a distribution by
_CRITICAL = 0.752  # of Anderson and Darling's A^2 at 5 %, mean and variance estimated (Stephens 1986)


@dataclass(frozen=True)
class Spread:
    """What the values of a group come to.

    Attributes
    ----------
    group, quantity, unit : str
        Which; the quantity by its column in the table.
    values : ndarray, shape (n,)
        Those that are determined and above 0 [SI].
    without : int
        Fitted curves of the group that do not determine it, or show none.
    percentiles : tuple of float
        The 5th, 25th, 50th, 75th and 95th; NaN without values.
    geometric_mean, geometric_deviation : float
        exp of mean and standard deviation of the logarithms.
    log_normal : bool or None
        Whether the logarithms pass for normal ones (Anderson and Darling's test at 5 %); None for fewer than 8 values.
    """

    group: str
    quantity: str
    unit: str
    values: NDArray[np.float64]
    without: int
    percentiles: tuple[float, ...]
    geometric_mean: float
    geometric_deviation: float
    log_normal: bool | None

    def __str__(self) -> str:
        name = QUANTITIES[self.quantity][0]
        start = f"{self.group or 'all'}: {name}"
        if not self.values.size:
            return f"{start}: none of {self.without} curves shows it"
        _, low, median, high, _ = self.percentiles
        text = f"{start} {with_sigma(median, 0.0, self.unit)} (median; quartiles {with_sigma(low, 0.0, self.unit)} and "
        text += f"{with_sigma(high, 0.0, self.unit)}; {counted(self.values.size, 'curve')}, {self.without} without)"
        if self.log_normal:
            text += f"; log-normal about {with_sigma(self.geometric_mean, 0.0, self.unit)}, "
            text += f"factor {self.geometric_deviation:.3g}"
        return text


def label_by(groups: str | os.PathLike[str] | None, files: Sequence[Path] = ()) -> Label:
    """The group of a file: ``"folder"``, the name of its folder (with as many of the folders above as tell those of
    `files` apart); or by a CSV table ``file,group`` whose first pattern
    that matches counts, else :data:`NO_GROUP`; None: all are one group. ReadError if the table cannot be used."""
    if groups is None:
        return lambda file: ""
    if groups == FOLDER:
        names = _told_apart({file.parent for file in files})
        return lambda file: names.get(file.parent, file.parent.name)
    rows = _table(Path(groups))

    def of(file: Path) -> str:
        line = _line_of(rows, file)
        return NO_GROUP if line is None else rows[line][1]

    return of


def without_files(groups: str | os.PathLike[str] | None, files: Iterable[Path]) -> list[str]:
    """Patterns of a table of groups that no file gets its group from: misspelt, or earlier lines have them all."""
    if groups is None or groups == FOLDER:
        return []
    rows = _table(Path(groups))
    used = {_line_of(rows, file) for file in files}
    return [name for line, (name, _) in enumerate(rows) if line not in used]


def _line_of(rows: Sequence[tuple[str, str]], file: Path) -> int | None:
    """Whose pattern is the first that is the path, or the end of it, from this folder or from the root."""
    paths = (file.as_posix(), Path(os.path.abspath(file)).as_posix())
    for line, (name, _) in enumerate(rows):
        if any(fnmatch.fnmatchcase(path, pattern) for path in paths for pattern in (name, f"*/{name}")):
            return line
    return None


def _told_apart(folders: set[Path]) -> dict[Path, str]:
    """Shortest ends of the paths that differ."""
    for depth in range(1, max((len(folder.parts) for folder in folders), default=0) + 1):
        names = {folder: Path(*folder.parts[-depth:]).as_posix() for folder in folders}
        if len(set(names.values())) == len(folders):
            return names
    return {}


def spreads(rows: Iterable[Mapping[str, Any]]) -> list[Spread]:
    """Every quantity of every group, in the order of their first curve."""
    kept: dict[str, list[Mapping[str, Any]]] = {}
    for row in rows:
        if row["status"] not in ("failed", "excluded"):
            kept.setdefault(row.get("group", ""), []).append(row)
    there = {key for members in kept.values() for row in members for key in _OF_SOME if row.get(key, "") != ""}
    there |= {key for members in kept.values() for row in members for key in _MODULI if key in row}
    asked = [quantity for quantity in QUANTITIES if quantity not in (*_MODULI, *_OF_SOME) or quantity in there]
    return [_spread(group, quantity, members) for group, members in kept.items() for quantity in asked]


def _spread(group: str, quantity: str, rows: Sequence[Mapping[str, Any]]) -> Spread:
    values = np.array([_value(row, quantity) for row in rows], dtype=np.float64)
    good = values[np.isfinite(values) & ((values > 0.0) | ((values == 0.0) & (quantity == "exponent")))]
    logs = np.log(good[good > 0.0])
    nothing = (np.nan,) * len(PERCENTILES)
    return Spread(
        group=group,
        quantity=quantity,
        unit=QUANTITIES[quantity][1],
        values=good,
        without=values.size - good.size,
        percentiles=tuple(float(v) for v in np.percentile(good, PERCENTILES)) if good.size else nothing,
        geometric_mean=float(np.exp(logs.mean())) if logs.size else np.nan,
        geometric_deviation=float(np.exp(logs.std(ddof=1))) if logs.size > 1 else np.nan,
        log_normal=bool(anderson_darling(logs) < _CRITICAL) if logs.size >= max(_FEWEST, good.size) else None,
    )


def _value(row: Mapping[str, Any], quantity: str) -> float:
    """NaN where a curve does not determine it: a misfit's modulus is none, nor is the force of what is no curve."""
    if float(row.get("rating") or 0.0) < REJECTED or (
        quantity in (*_MODULI, *_OF_SOME) and row["status"] in ("misfit", "not converged")
    ):
        return np.nan
    value = row.get(quantity, np.nan)
    return float(value) if value not in ("", None) else np.nan


def anderson_darling(values: NDArray[np.float64]) -> float:
    """Anderson and Darling's A^2 against a normal distribution of this mean and variance, corrected for the number of
    values (Stephens 1986); infinite where all are equal."""
    from math import erfc, log

    count, spread = values.size, float(values.std(ddof=1))
    if spread == 0.0:
        return np.inf
    scaled = (np.sort(values) - values.mean()) / spread
    below = [log(max(0.5 * erfc(-float(z) / 2**0.5), 1e-300)) for z in scaled]
    above = [log(max(0.5 * erfc(float(z) / 2**0.5), 1e-300)) for z in scaled]
    weights = 2 * np.arange(1, count + 1) - 1
    squared = -count - float(np.sum(weights * (np.array(below) + np.array(above[::-1])))) / count
    return squared * (1.0 + 0.75 / count + 2.25 / count**2)


def _table(path: Path) -> list[tuple[str, str]]:
    try:
        with path.open(encoding="utf-8-sig", newline="") as stream:
            rows = list(csv.reader(stream))
    except (OSError, UnicodeDecodeError) as error:
        raise ReadError(f"{path}: no table of groups: {error}") from error
    if not rows or [name.strip() for name in rows[0]] != ["file", "group"]:
        raise ReadError(f"{path}: its first line has to be file,group")
    if any(len(row) != 2 or not all(cell.strip() for cell in row) for row in rows[1:] if row):
        raise ReadError(f"{path}: each line needs a pattern of files and a group")
    return [(row[0].strip(), row[1].strip()) for row in rows[1:] if row]
