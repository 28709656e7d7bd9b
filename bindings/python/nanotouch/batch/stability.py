# SPDX-License-Identifier: BSD-3-Clause
"""Does the modulus of many curves depend on how much of them is fitted? E(delta) of each, and their median."""

from __future__ import annotations

import csv
import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from .._io.drawing import BLUE, VERMILION, new_figure, saved
from .._io.words import counted
from .._io.writing import replacing
from ..curves import read
from ..errors import Error
from ..fit import Stability, stability
from ..fit.models import Floats
from ..units import engineering
from .files import WITHOUT, Summary
from .sidecar import Sidecar
from .table import by_hand

_KNOWN = 0.2  # relative sigma up to which a window counts for the median
_SHARE = 0.5  # of the curves that must reach a depth for a median there
_DEPTHS = 40
_DECADE = 10.0


@dataclass(frozen=True)
class Stabilities:
    """E(delta) of many curves.

    Attributes
    ----------
    curves : list of (str, int, Stability)
        File, number of the curve in it, moduli.
    without : list of (str, int, str)
        Fitted curves that have none, and why: the law has no modulus, for example.
    """

    curves: list[tuple[str, int, Stability]]
    without: list[tuple[str, int, str]]

    def median(self) -> tuple[Floats, Floats]:
        """Depths [m] that at least half of the curves reach, and at each the quartiles of E* [Pa], shape (3, n).

        Windows count that know E* to 20 %; between two of them ln E* is interpolated.
        """
        tracks = [track for _, _, found in self.curves if (track := _known(found))[0].size > 1]
        if not tracks:
            return np.empty(0), np.empty((3, 0))
        depths = np.geomspace(min(d[0] for d, _ in tracks), max(d[-1] for d, _ in tracks), _DEPTHS)
        moduli = np.array([np.interp(depths, d, np.log(e), left=np.nan, right=np.nan) for d, e in tracks])
        kept = np.isfinite(moduli).sum(axis=0) >= max(1.0, _SHARE * len(tracks))
        return depths[kept], np.exp(np.nanpercentile(moduli[:, kept], (25, 50, 75), axis=0))

    def to_csv(self, path: str | os.PathLike[str]) -> None:
        """A row for each window of each curve; an empty cell where it tells no modulus."""
        headers = ("file", "curve", "indentation [m]", "effective_modulus [Pa]", "effective_modulus sigma [Pa]")
        options: dict[str, Any] = {"encoding": "utf-8", "errors": "backslashreplace", "newline": ""}
        with replacing(Path(path)) as part, part.open("w", **options) as to:
            table = csv.writer(to)
            table.writerow(headers)
            for file, index, found in self.curves:
                for row in zip(found.indentation, found.modulus, found.sigma, strict=True):
                    table.writerow((file, index, *("" if value != value else float(value) for value in row)))

    def draw(self, save: str | os.PathLike[str] | None = None) -> Any:
        """All curves, their median and quartiles; also written to `save`, whole or not at all."""
        figure = new_figure(6.4, 4.2)
        panel = figure.add_subplot()
        depths, quartiles = self.median()
        tracks = [_known(found) for _, _, found in self.curves]
        wide, scale_d = engineering("m", np.concatenate([d for d, _ in tracks] or [np.ones(1)]))
        stiff, scale_e = engineering("Pa", np.concatenate([e for _, e in tracks] or [np.ones(1)]))
        for d, e in tracks:
            panel.plot(d * scale_d, e * scale_e, color="0.6", lw=0.6, alpha=0.7)
        if depths.size:
            panel.fill_between(depths * scale_d, quartiles[0] * scale_e, quartiles[2] * scale_e, color=BLUE, alpha=0.25,
                               lw=0.0, label="quartiles")  # fmt: skip
            panel.plot(depths * scale_d, quartiles[1] * scale_e, color=VERMILION, lw=1.6, label="median")
            panel.legend(fontsize=8)
        every = np.concatenate([e for _, e in tracks] or [np.ones(1)])
        if every.size and every.max() > _DECADE * every.min():
            panel.set_yscale("log")
        panel.set_xlabel(f"end of the window, indentation $\\delta$ ({wide})")
        panel.set_ylabel(f"effective modulus $E^*$ ({stiff})")
        panel.set_title(counted(len(self.curves), "curve"), fontsize=10)
        return saved(figure, save, dpi=130)

    def __str__(self) -> str:
        depths, quartiles = self.median()
        if not depths.size:
            return "E*(delta): no curve has two windows that know E* to 20 %"
        change = 100.0 * (quartiles[1, -1] / quartiles[1, 0] - 1.0)
        return (f"E*(delta) of {counted(len(self.curves), 'curve')}: from {depths[0] * 1e9:.3g} to "
                f"{depths[-1] * 1e9:.3g} nm the median changes by {change:+.3g} %")  # fmt: skip


def stabilities(
    summary: Summary,
    *,
    sidecar: str | os.PathLike[str] | None = None,
    reading: Mapping[str, Any] | None = None,
    progress: Callable[[float], None] | None = None,
    **settings: Any,
) -> Stabilities:
    """E(delta) of every curve that a run fitted, by the law that it was fitted with.

    Parameters
    ----------
    summary : Summary
        Of :func:`nanotouch.batch.fit_files`.
    sidecar, reading, progress, **settings
        As for :func:`nanotouch.batch.fit_files`, but without ``window``.
    """
    decided = Sidecar() if sidecar is None else Sidecar.from_toml(sidecar)
    fitted = [row for row in summary.rows if row["status"] not in WITHOUT]
    found, without = [], []
    name, curves = "", None
    for number, row in enumerate(fitted):
        file, index = str(row["file"]), int(row["curve"])
        if file != name:
            name, curves = file, read(file, **(reading or {}))
        assert curves is not None
        known = dict(settings) | {"branch": row["branch"]} | by_hand(decided.of(Path(file), index))
        try:
            found.append((file, index, stability(curves[index], row["model"], **known)))
        except Error as error:
            without.append((file, index, str(error)))
        if progress:
            progress((number + 1) / len(fitted))
    return Stabilities(found, without)


def _known(found: Stability) -> tuple[Floats, Floats]:
    """The windows that know E*."""
    good = found.sigma < _KNOWN * found.modulus
    return found.indentation[good], found.modulus[good]
